"""How long a sweep would take: the number of runs that are left, and one of them as a probe."""

from __future__ import annotations

import math
import tempfile
from dataclasses import dataclass
from pathlib import Path

from airhilt.errors import AirhiltError
from airhilt.host.machine import available_cores
from airhilt.record.sweep_folder import SweepFolder
from airhilt.sweep.cases import Case, cases
from airhilt.sweep.engine import by_keys, missing_of, renderer_of
from airhilt.sweep.outcome import Machine, Request
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
    runs
        Number of runs.
    finished
        Number of those that the sweep's folder has already, and that are not run again.
    run_s
        Wall time of the probe, one run alone on this machine; None: no run is left.
    run_mb
        Most memory of the probe; None: no run is left.
    workers
        Number of workers that would be asked for.
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
    folder = SweepFolder(work.out)
    folder.require_usable()
    runner = RunnerProcess(renderer, work.limits)
    try:
        by_key = {case.key(runner.environment): case for case in grid}
        finished = by_keys(folder.finished(part_schema(), None), by_key)
        left = missing_of(by_key, finished, work.retry)
        probe = _probe(left[0], by_key[left[0]], runner) if left else None
    finally:
        runner.close()
    workers = work.workers or default_workers(renderer)
    at_once = min(workers, available_cores()) if work.scheduler == LOCAL else None
    return Estimate(
        runs=len(by_key),
        finished=len(by_key) - len(left),
        run_s=probe.wall_s if probe else None,
        run_mb=probe.peak_memory_mb if probe else None,
        workers=workers,
        at_once=at_once,
        total_s=_total_s(len(left), probe.wall_s if probe else 0.0, at_once),
    )


def _total_s(runs: int, run_s: float, at_once: int | None) -> float | None:
    if not runs:
        return 0.0
    return None if at_once is None else math.ceil(runs / at_once) * run_s


def _probe(key: str, case: Case, runner: RunnerProcess) -> Machine:
    """Return what a run takes.

    Raises
    ------
    AirhiltError
        It failed.
    """
    with tempfile.TemporaryDirectory(prefix="airhilt-probe-") as scratch:
        outcome = runner.run(
            Request(
                key=key,
                scenario=case.document,
                options=case.options | {"seed": case.seed},
                keep="none",
                folder=str(Path(scratch) / "run"),
                files=case.files,
            )
        )
    if outcome.status != "finished":
        raise AirhiltError(f"the first run, a probe, {outcome.status}: {outcome.cause}")
    return outcome.machine
