"""Runs one after the other in one process: CPU of each, and what the process keeps of them."""

from __future__ import annotations

import gc
import re
import tempfile
import time
from pathlib import Path
from typing import Any

from airhilt import load, run
from airhilt.scenario import Scenario
from benchmarks.rounds import ROUNDS, best

RUNS = 300
"""Number of short runs between the two looks at the process."""
WARM_UP = 20
"""Number of runs before the first look."""
PROCESS = Path("/proc/self")


def many() -> dict[str, float]:
    """Measure s02a_headon in a warm process, and what runs of one second of it leave behind."""
    whole = load("s02a_headon")
    short = whole.model_copy(update={"duration_s": 1.0})
    for _ in range(WARM_UP):
        _cpu_s(short)
    _cpu_s(short, speech=True)
    before = _held()
    for _ in range(RUNS):
        _cpu_s(short)
    after = _held()
    without_report_s = best(lambda: _cpu_s(whole, report=False))
    return {
        "fixed_cpu_s": best(lambda: _cpu_s(short, report=False), 4 * ROUNDS),
        "run_cpu_s": without_report_s,
        "report_cpu_s": best(lambda: _cpu_s(whole)) - without_report_s,
        "run_with_speech_cpu_s": best(lambda: _cpu_s(whole, report=False, speech=True)),
        **{f"{name}_before": value for name, value in before.items()},
        **{f"{name}_after_{RUNS}_runs": value for name, value in after.items()},
    }


def _cpu_s(scenario: Scenario, *, speech: bool = False, **options: Any) -> float:
    """Return the CPU time of a run without cameras."""
    with tempfile.TemporaryDirectory() as scratch:
        begun = time.process_time()
        run(
            scenario,
            out=Path(scratch) / "run",
            cameras=False,
            speech=speech,
            latency="fixed",
            **options,
        )
        return time.process_time() - begun


def _held() -> dict[str, float]:
    """Return what this process holds, as Linux counts it."""
    gc.collect()
    resident_kb = re.findall(r"VmRSS:\s+(\d+) kB", (PROCESS / "status").read_text())[0]
    shared = re.findall(r"/dev/shm/\S+", (PROCESS / "maps").read_text())  # noqa: S108
    return {
        "memory_mb": int(resident_kb) / 1000.0,
        "descriptors": float(sum(1 for _ in (PROCESS / "fd").iterdir())),
        "shared_memory_files": float(len(set(shared))),
    }
