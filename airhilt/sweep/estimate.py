"""How long a sweep would take: the number of runs that are left, and one of them as a probe."""

from __future__ import annotations

import math
import tempfile
from dataclasses import dataclass
from pathlib import Path

from airhilt.errors import AirhiltError
from airhilt.host.machine import available_cores
from airhilt.record.sweep_folder import SweepFolder
from airhilt.sweep.cases import cases
from airhilt.sweep.engine import by_keys, missing_of, renderer_of, request_of
from airhilt.sweep.runner_process import RunnerProcess
from airhilt.sweep.scheduler import LOCAL, require_scheduler
from airhilt.sweep.specification import Specification
from airhilt.sweep.tables import part_schema
from airhilt.sweep.work import Work, default_workers


@dataclass(frozen=True)
class Estimate:
    """Size of a sweep.

    Attributes
    ----------
    finished
        Number of those that the sweep's folder has already, and that are not run again.
    run_s
        Wall time of the probe, one run alone on this machine; None: no run is left.
    run_mb
        Most memory of the probe; None: no run is left.
    at_once
        Number of runs that would go on at a time; None: only the scheduler knows.
    total_s
        Wall time of the runs that are left, if all were like the probe and the workers as fast as
        this machine; None if it is not known how many go on at a time.
    """

    runs: int
    finished: int
    run_s: float | None
    run_mb: float | None
    workers: int
    at_once: int | None
    total_s: float | None


def estimate(specification: Specification, work: Work) -> Estimate:
    """Return the size of a sweep; the first run that is left is run, and nothing is kept of it.

    The folder of the sweep stays as it is.

    Raises
    ------
    AirhiltError
        Something that was given is wrong, or the probe failed.
    """
    require_scheduler(work.scheduler)
    grid = cases(specification, work.allowed)
    renderer = renderer_of(grid)
    store = SweepFolder(work.out)
    store.require_usable()
    runner = RunnerProcess(renderer, work.limits)
    try:
        by_key = {case.key(runner.environment): case for case in grid}
        finished = by_keys(store.finished(part_schema(), None), by_key)
        left = missing_of(by_key, finished, work.retry)
        probe = None
        if left:
            with tempfile.TemporaryDirectory(prefix="airhilt-probe-") as scratch:
                key, folder = left[0], Path(scratch) / "run"
                probe = runner.run(request_of(key, by_key[key], folder))
    finally:
        runner.close()
    if probe is not None and probe.status != "finished":
        raise AirhiltError(f"the first run, a probe, {probe.status}: {probe.cause}")
    run_s = None if probe is None else probe.machine.wall_s
    workers = work.workers or default_workers(renderer)
    at_once = min(workers, available_cores()) if work.scheduler == LOCAL else None
    total_s = None if at_once is None else math.ceil(len(left) / at_once) * (run_s or 0.0)
    return Estimate(
        runs=len(by_key),
        finished=len(by_key) - len(left),
        run_s=run_s,
        run_mb=None if probe is None else probe.machine.peak_memory_mb,
        workers=workers,
        at_once=at_once,
        total_s=total_s if left else 0.0,
    )
