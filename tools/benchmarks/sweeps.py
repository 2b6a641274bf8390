"""Sweeps: what the engine costs a run, and what a second worker gains."""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from airhilt.sweep.engine import SweepObserver
from airhilt.sweep.engine import sweep as run_sweep
from airhilt.sweep.outcome import Outcome
from airhilt.sweep.runner_process import Limits
from airhilt.sweep.specification import Specification
from airhilt.sweep.work import Work
from benchmarks.process_tree import cpu_s

SCENARIO = "s02a_headon"
RUNS = 30
FEW = 3
"""Runs of the command from which another one with more runs is told apart."""
MANY = 1000
"""Runs for which the CPU time of sweep and direct calls is extrapolated."""
OPTIONS: dict[str, Any] = {"cameras": False, "speech": False, "latency": "fixed"}
LIMITS = Limits(wall_s=600.0, memory_mb=4000.0)


@dataclass
class Times(SweepObserver):
    """When each run ended, on the clock, and what it took on its worker."""

    at_s: list[float] = field(default_factory=list)
    outcomes: list[Outcome] = field(default_factory=list)

    def ended(self, outcome: Outcome) -> None:
        """Note the time."""
        self.at_s.append(time.perf_counter())
        self.outcomes.append(outcome)

    def per_run_s(self, warm_up: int) -> float:
        """Return the wall time of a run, without the first ones of each worker."""
        return (self.at_s[-1] - self.at_s[warm_up - 1]) / (len(self.at_s) - warm_up)

    def mean(self, name: str, warm_up: int) -> float:
        """Return the mean of a field of `Machine`."""
        values = [getattr(each.machine, name) for each in self.outcomes[warm_up:]]
        return float(sum(values) / len(values))


def sweep() -> dict[str, float]:
    """Measure runs by one worker and by two, and all of their CPU time beside direct calls."""
    one, two = _swept(1), _swept(2)
    swept, direct = _cpu_of(_sweep_command), _cpu_of(_direct_command)
    return {
        "wall_s_a_run_one_worker": one.per_run_s(2),
        "wall_s_a_run_two_workers": two.per_run_s(4),
        "gain_of_the_second_worker": one.per_run_s(2) / two.per_run_s(4),
        "engine_overhead_s_a_run": one.per_run_s(2) - one.mean("wall_s", 2),
        "cpu_s_of_a_sweep_alone": swept.alone_s,
        "cpu_s_a_run_of_a_sweep": swept.run_s,
        "cpu_s_a_direct_call": direct.run_s,
        "cpu_ratio_to_direct_calls": swept.run_s / direct.run_s,
        f"cpu_ratio_of_{MANY}_runs": swept.of(MANY) / direct.of(MANY),
        "peak_memory_mb": one.mean("peak_memory_mb", 2),
    }


def _swept(workers: int) -> Times:
    times = Times()
    specification = Specification(
        scenarios=(SCENARIO,), seeds=tuple(range(RUNS)), options=dict(OPTIONS)
    )
    with tempfile.TemporaryDirectory() as scratch:
        run_sweep(specification, Work(Path(scratch) / "sweep", LIMITS, workers=workers), times)
    return times


@dataclass(frozen=True)
class Cpu:
    """CPU time of a command and of every process that it starts, in s.

    Attributes
    ----------
    alone_s
        What it takes however many runs it does: imports, workers, tables.
    run_s
        What each run takes.
    """

    alone_s: float
    run_s: float

    def of(self, runs: int) -> float:
        """Return the time for a number of runs."""
        return self.alone_s + runs * self.run_s


def _cpu_of(command: Callable[[int, Path], list[str]]) -> Cpu:
    """Return the CPU time of a command by two numbers of runs.

    Parameters
    ----------
    command
        Returns the command for a number of runs, with a folder that it may write to.
    """

    def measured(runs: int) -> float:
        with tempfile.TemporaryDirectory() as scratch:
            return cpu_s(command(runs, Path(scratch)))

    few_s = measured(FEW)
    run_s = (measured(FEW + RUNS) - few_s) / RUNS
    return Cpu(few_s - FEW * run_s, run_s)


def _sweep_command(runs: int, scratch: Path) -> list[str]:
    flags = ["--no-cameras", "--no-speech", "--latency", "fixed", "--workers", "1", "--quiet"]
    asked = ["--scenario", SCENARIO, "--seeds", str(runs), "--out", str(scratch / "sweep")]
    return [sys.executable, "-m", "airhilt", "sweep", *asked, *flags]


def _direct_command(runs: int, scratch: Path) -> list[str]:
    program = (
        "import airhilt\n"
        f"for seed in range({runs}):\n"
        f"    out = f'{scratch}/{{seed}}'\n"
        f"    airhilt.run({SCENARIO!r}, out=out, seed=seed, report=False, **{OPTIONS!r})\n"
    )
    return [sys.executable, "-c", program]
