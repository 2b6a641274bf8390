"""Sweeps: what the engine costs a run, and what a second worker gains."""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import airhilt
from airhilt.sweep.engine import SweepObserver
from airhilt.sweep.engine import sweep as run_sweep
from airhilt.sweep.outcome import Outcome
from airhilt.sweep.runner_process import Limits
from airhilt.sweep.specification import Specification
from airhilt.sweep.work import Work

SCENARIO = "s02a_headon"
RUNS = 30
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
    """Measure runs by one worker, by two, and by direct calls in one process."""
    one, two = _swept(1), _swept(2)
    direct_s = _direct_cpu_s()
    return {
        "wall_s_a_run_one_worker": one.per_run_s(2),
        "wall_s_a_run_two_workers": two.per_run_s(4),
        "gain_of_the_second_worker": one.per_run_s(2) / two.per_run_s(4),
        "engine_overhead_s_a_run": one.per_run_s(2) - one.mean("wall_s", 2),
        "cpu_s_a_run_one_worker": one.mean("cpu_s", 2),
        "cpu_s_a_direct_call": direct_s,
        "cpu_ratio_to_direct": one.mean("cpu_s", 2) / direct_s,
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


def _direct_cpu_s() -> float:
    scenario = airhilt.load(SCENARIO)
    spent: list[float] = []
    for seed in range(RUNS // 2):
        with tempfile.TemporaryDirectory() as scratch:
            begun = time.process_time()
            airhilt.run(scenario, out=Path(scratch) / "run", seed=seed, report=False, **OPTIONS)
            spent.append(time.process_time() - begun)
    return sum(spent[2:]) / len(spent[2:])
