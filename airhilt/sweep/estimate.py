"""Estimate of the time of a sweep: how many runs are left, and one of each kind as a probe."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean

from airhilt.errors import AirhiltError
from airhilt.host.machine import available_cores
from airhilt.options import Options
from airhilt.record.sweep_folder import SweepFolder
from airhilt.sweep.cases import Case, cases
from airhilt.sweep.engine import by_keys, missing_of, renderer_of, request_of
from airhilt.sweep.outcome import Machine
from airhilt.sweep.runner_process import Limits, RunnerProcess
from airhilt.sweep.specification import Specification
from airhilt.sweep.tables import part_schema
from airhilt.sweep.work import LOCAL, Work, default_workers, require_scheduler


@dataclass(frozen=True)
class Estimate:
    """Size of a sweep.

    Attributes
    ----------
    finished
        Number of those that the sweep's folder has already, and that are not run again.
    run_s
        Mean wall time of the runs that are left if all were like the probe of their kind, which ran
        alone on this machine; None: no run is left.
    run_mb
        Most memory of a probe; None: no run is left.
    at_once
        Number of runs that would go on at a time; None: only the scheduler knows.
    total_s
        Wall time of the runs that are left, if the workers are as fast as this machine; None if it
        is not known how many go on at a time.
    """

    runs: int
    finished: int
    run_s: float | None
    run_mb: float | None
    workers: int
    at_once: int | None
    total_s: float | None


def estimate(specification: Specification, work: Work) -> Estimate:
    """Return the size of a sweep; a run of each kind that is left is run, and nothing is kept.

    The folder of the sweep stays as it is.

    Raises
    ------
    AirhiltError
        Something that was given is wrong, or the probe failed.
    """
    require_scheduler(work.scheduler)
    grid = cases(specification, work.allowed)
    with closing(Probes(work.limits)) as probes:
        return estimate_of(grid, work, probes)


class Probes:
    """Tries runs: one of each kind, with pictures to look at or without, and with speech or not."""

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self._runners: dict[str, RunnerProcess] = {}
        self._tried: dict[tuple[bool, bool], Machine] = {}

    def runner(self, renderer: str) -> RunnerProcess:
        """Return the process that tries runs with a renderer; see `RunnerProcess` for errors."""
        if renderer not in self._runners:
            self._runners[renderer] = RunnerProcess(renderer, self._limits)
        return self._runners[renderer]

    def of(self, key: str, case: Case) -> Machine:
        """Return what a run of the kind of a case took.

        Raises
        ------
        AirhiltError
            It has not finished.
        """
        options = Options(**case.options)
        kind = case.has_cameras and options.asks_for_detections, options.speech
        if kind not in self._tried:
            with tempfile.TemporaryDirectory(prefix="airhilt-probe-") as scratch:
                request = request_of(key, case, Path(scratch) / "run")
                probe = self.runner(renderer_of([case])).run(request)
            if probe.status != "finished":
                raise AirhiltError(
                    f"a probe, {case.scenario} with {case.assistant}, {probe.status}: {probe.cause}"
                )
            self._tried[kind] = probe.machine
        return self._tried[kind]

    def close(self) -> None:
        """End the processes."""
        for runner in self._runners.values():
            runner.close()


def estimate_of(grid: Sequence[Case], work: Work, probes: Probes) -> Estimate:
    """Return the size of a sweep of checked runs; see `estimate`."""
    renderer = renderer_of(grid)
    store = SweepFolder(work.out)
    store.require_usable()
    own = probes.runner(renderer).environment
    by_key = {case.key(own): case for case in grid}
    finished = by_keys(store.finished(part_schema(), None), by_key)
    left = missing_of(by_key, finished, work.retry)
    tried = [probes.of(key, by_key[key]) for key in left]
    run_s = fmean(probe.wall_s for probe in tried) if tried else None
    workers = work.workers or default_workers(renderer)
    at_once = min(workers, available_cores()) if work.scheduler == LOCAL else None
    total_s = None if at_once is None else math.ceil(len(left) / at_once) * (run_s or 0.0)
    return Estimate(
        runs=len(by_key),
        finished=len(by_key) - len(left),
        run_s=run_s,
        run_mb=max((probe.peak_memory_mb for probe in tried), default=None),
        workers=workers,
        at_once=at_once,
        total_s=total_s if left else 0.0,
    )
