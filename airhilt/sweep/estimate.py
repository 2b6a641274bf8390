"""How long a sweep would take: the number of its runs, and one of them run as a probe."""

from __future__ import annotations

import os
import tempfile
from dataclasses import dataclass
from pathlib import Path

from airhilt.errors import AirhiltError
from airhilt.sweep.cases import Case, cases
from airhilt.sweep.clusters import FAMILY
from airhilt.sweep.engine import renderer_of
from airhilt.sweep.outcome import Outcome, Request
from airhilt.sweep.runner_process import RunnerProcess
from airhilt.sweep.specification import Specification
from airhilt.sweep.work import Work, default_workers


@dataclass(frozen=True)
class Estimate:
    """Size of a sweep.

    Attributes
    ----------
    runs
        Number of runs.
    run_s
        Wall time of the probe, one run alone on this machine.
    run_mb
        Most memory of the probe.
    workers
        Number of workers that this machine would have.
    total_s
        Wall time of all runs with these workers, if all were like the probe.
    """

    runs: int
    run_s: float
    run_mb: float
    workers: int
    total_s: float


def estimate(specification: Specification, work: Work) -> Estimate:
    """Return the size of a sweep; its first run is run, and nothing is kept of it.

    Raises
    ------
    AirhiltError
        Something that was given is wrong, or the probe failed.
    """
    FAMILY.create(work.scheduler, configuration=work.scheduler_config)
    grid = cases(specification)
    renderer = renderer_of(grid)
    outcome = _probe(grid[0], renderer, work)
    if outcome.status != "finished":
        raise AirhiltError(f"the first run, a probe, {outcome.status}: {outcome.cause}")
    workers = work.workers or default_workers(renderer)
    run_s = outcome.machine.wall_s
    return Estimate(
        runs=len(grid),
        run_s=run_s,
        run_mb=outcome.machine.peak_memory_mb,
        workers=workers,
        total_s=len(grid) * run_s / min(workers, os.cpu_count() or workers),
    )


def _probe(case: Case, renderer: str, work: Work) -> Outcome:
    runner = RunnerProcess(renderer, work.limits)
    try:
        with tempfile.TemporaryDirectory(prefix="airhilt-probe-") as scratch:
            return runner.run(
                Request(
                    key=case.key(runner.environment),
                    scenario=case.document,
                    options=case.options | {"seed": case.seed},
                    keep="none",
                    folder=str(Path(scratch) / "run"),
                )
            )
    finally:
        runner.close()
