"""A sweep, from its specification to its tables. The main path begins at `sweep`.

The runs that the folder does not have yet are given to runners on this machine or to the workers
of a Dask scheduler. Each outcome is on the disk before the next one is asked for.
"""

from __future__ import annotations

import json
from collections.abc import Container, Iterable, Mapping, Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import JsonValue

from airhilt.errors import AirhiltError
from airhilt.host.notebook import NotebookLine
from airhilt.host.text import counted
from airhilt.record.sweep_folder import GRID, SweepFolder, SweepFolderError
from airhilt.sensors.cameras import UNSEEN_FIELDS
from airhilt.sweep.cases import Case, cases
from airhilt.sweep.environment import Environment, environment
from airhilt.sweep.executors import Executor, Executors
from airhilt.sweep.outcome import OF_THE_MACHINE, Keep, Outcome, Request
from airhilt.sweep.runner_process import Limits, RunnerProcess
from airhilt.sweep.specification import Specification
from airhilt.sweep.tables import folder_name, grid_sha256, part_of, part_schema, tables_of
from airhilt.sweep.work import Work, require_scheduler

if TYPE_CHECKING:
    import pyarrow as pa

SEEN_OPTIONS = ("seed", "visibility_m")
"""Options that cameras see, besides those that all runs of a sweep have in common."""
MOST_CRASHES = 20
"""Crashes in a row after which a sweep ends: a full disk crashes every run, within seconds."""


class SweepObserver:
    """Is told how a sweep is doing; this one ignores it, and never wants to stop."""

    def begun(self, total: int, finished: int, workers: str) -> None:
        """Take note of the number of runs, of those that are finished, and of the workers."""

    def ended(self, outcome: Outcome) -> None:
        """Take note of a run that has ended."""

    def notice(self, text: str) -> None:
        """Take note of something that the user should know at once."""

    @property
    def stops(self) -> bool:
        """True if only the runs in hand are to be finished."""
        return False


class NotebookSweepProgress(SweepObserver):
    """Shows how many runs have ended in the notebook that has begun the sweep."""

    def __init__(self) -> None:
        self._line = NotebookLine()
        self._total = self._done = self._failed = 0

    def begun(self, total: int, finished: int, workers: str) -> None:  # noqa: ARG002
        """Show how many runs there are."""
        self._total, self._done = total, finished
        self._show()

    def ended(self, outcome: Outcome) -> None:
        """Count a run."""
        self._done += 1
        self._failed += outcome.status != "finished"
        self._show()

    def notice(self, text: str) -> None:
        """Show a line that stays."""
        self._line.notice(text)

    def _show(self) -> None:
        failed = f", {self._failed} failed" if self._failed else ""
        done = f"{self._done} of {counted(self._total, 'run')}{failed}"
        self._line.show(done, is_last=self._done == self._total)


@dataclass(frozen=True)
class SweepResult:
    """Result of a sweep: its folder, and numbers of runs, rows, failures and missing runs."""

    folder: SweepFolder
    runs: int
    rows: int
    failed: int
    missing: int

    @property
    def is_complete(self) -> bool:
        """True if every run has a row, and some finished."""
        return self.rows == self.runs and self.failed + self.missing < self.runs


def sweep(
    specification: Specification,
    work: Work,
    observer: SweepObserver | None = None,
    grid: Sequence[Case] | None = None,
    executors: Executors | None = None,
) -> SweepResult:
    """Run what a sweep's folder does not have yet, and write its tables.

    Parameters
    ----------
    grid
        The checked runs of the specification; None: they are yet to be checked.
    executors
        Who does the runs, if several sweeps share them.

    Raises
    ------
    AirhiltError
        Something that was given is wrong; nothing was run. Or the scheduler was lost; what was
        finished before is kept.
    """
    observer = observer or SweepObserver()
    require_scheduler(work.scheduler)
    grid = cases(specification, work.allowed) if grid is None else grid
    renderer = renderer_of(grid)
    own = _own_environment(renderer, work.limits)
    by_key = {case.key(own): case for case in grid}
    folder = SweepFolder(work.out)
    folder.create()
    info = {
        "format": specification.format,
        "specification": specification.model_dump(mode="json", by_alias=True, exclude_none=True),
        "environment": own.model_dump(),
        "runs": len(by_key),
        GRID: grid_sha256(by_key),
    }
    with folder.locked():
        _tell_replaced(folder, info, observer)
        finished = by_keys(folder.finished(part_schema(), observer.notice), by_key)
        missing = missing_of(by_key, finished, work.retry)
        if missing:
            requests = _requests(missing, by_key, work)
            with nullcontext(executors) if executors else Executors(work) as found:
                executor = found.of(renderer, own, observer.notice)
                _run_missing(requests, info, folder, executor, observer)
            finished = by_keys(folder.finished(part_schema(), observer.notice), by_key)
        table, machine = tables_of(by_key, finished)
        folder.write_tables(table, machine, info)
    ended = sum(row["status"] in OF_THE_MACHINE for row in finished.values())
    if ended:
        observer.notice(
            f"{ended} run{'s' * (ended != 1)} ended by a crash or a limit, which is no result: "
            "the same command with --retry and the same --out does them again"
        )
    left = sum(key not in finished for key in by_key)
    failed = sum(row["status"] != "finished" for row in finished.values())
    return SweepResult(folder, len(by_key), table.num_rows, failed, left)


def renderer_of(grid: Sequence[Case]) -> str:
    """Return the renderer that the runs ask for, empty if none has cameras.

    Raises
    ------
    AirhiltError
        They ask for more than one.
    """
    asked = {str(case.options.get("renderer", "auto")) for case in grid if case.has_cameras}
    if len(asked) > 1:
        raise AirhiltError(
            f"renderers {', '.join(sorted(asked))}: expected one for all runs of a sweep"
        )
    return asked.pop() if asked else ""


def _own_environment(renderer: str, limits: Limits) -> Environment:
    """Return the environment of runs on this machine; a renderer is tried in another process."""
    if not renderer:
        return environment("")
    runner = RunnerProcess(renderer, limits)
    runner.close()
    return runner.environment


def _tell_replaced(folder: SweepFolder, info: Mapping[str, Any], observer: SweepObserver) -> None:
    """Say that the tables in a folder will be of another sweep than they were."""
    if not folder.info_path.is_file():
        return
    with suppress(SweepFolderError):  # What is damaged is written anew.
        before = folder.info()
        if before.get(GRID) != info[GRID]:
            is_same = before.get("specification") == info["specification"]
            which = "this sweep with other software or files" if is_same else "another sweep"
            observer.notice(
                f"{folder.path} holds {which}, of {before.get('runs')} runs: its tables make "
                f"room for those of this one, of {info['runs']}; what finished stays in parts"
            )


def by_keys(store: pa.Table, keys: Container[str]) -> dict[str, dict[str, Any]]:
    """Return the rows of a store that have some keys.

    What a limit has ended counts only as long as the run has not been done.
    """
    rows: list[dict[str, Any]] = store.to_pylist()
    rows.sort(key=lambda row: row["status"] not in OF_THE_MACHINE)
    return {row["key"]: row for row in rows if row["key"] in keys}


def missing_of(
    keys: Iterable[str], finished: Mapping[str, Mapping[str, Any]], retry: bool
) -> list[str]:
    """Return the keys of the runs that are to be done.

    Parameters
    ----------
    retry
        True: runs that a limit ended are among them.
    """
    again = OF_THE_MACHINE if retry else ()
    return [key for key in keys if key not in finished or finished[key]["status"] in again]


def _requests(missing: Sequence[str], by_key: Mapping[str, Case], work: Work) -> list[Request]:
    """Return what the workers are asked for."""
    sampled = set(sorted(by_key)[: work.sample])
    runs = (work.out / "runs").absolute()
    return [
        request_of(
            key,
            by_key[key],
            runs / folder_name(key),
            keep="all" if key in sampled else work.keep,
            # Sharing is no parameter: it changes no run.
            **({"share_pictures": True} if by_key[key].may_share_pictures else {}),
        )
        for key in missing
    ]


def request_of(
    key: str, case: Case, folder: Path, keep: Keep = "none", **options: JsonValue
) -> Request:
    """Return the request for a run.

    Parameters
    ----------
    options
        Options besides those of the case.
    """
    return Request(
        key=key,
        scenario=case.document,
        options=case.options | {"seed": case.seed} | options,
        keep=keep,
        folder=str(folder),
        files=case.files,
    )


def _run_missing(
    requests: Sequence[Request],
    info: Mapping[str, Any],
    folder: SweepFolder,
    executor: Executor,
    observer: SweepObserver,
) -> None:
    """Have what is missing run; keep each outcome as it comes.

    After many crashes in a row no more is begun.
    """
    total, crashes = int(info["runs"]), 0

    def stops() -> bool:
        return observer.stops or crashes >= MOST_CRASHES

    workers = executor.ready(stops)
    folder.write_next_info(info)
    observer.begun(total, total - len(requests), workers)
    for outcome in executor.outcomes(apart(requests, max(executor.size, 1)), stops):
        folder.keep(part_of([outcome]))
        observer.ended(outcome)
        crashes = crashes + 1 if outcome.status == "crashed" else 0
    if crashes >= MOST_CRASHES:
        observer.notice(f"ended after {MOST_CRASHES} crashes in a row, whose cause is to be mended")


def apart(requests: Sequence[Request], workers: int) -> list[Request]:
    """Return runs in an order in which no two workers draw the same pictures at once.

    The first of the runs that share pictures draws them. A second one at the same time would draw
    them too. So each worker begins with other pictures, and runs that share follow one another.
    """
    sharing: dict[str, list[Request]] = {}
    for request in requests:
        sharing.setdefault(_pictures_of(request), []).append(request)
    groups = list(sharing.values())
    return [
        request
        for first in range(0, len(groups), workers)
        for abreast in zip_longest(*groups[first : first + workers])
        for request in abreast
        if request is not None
    ]


def _pictures_of(request: Request) -> str:
    """Return what is the same for runs that share pictures, and for no others."""
    if not request.options.get("share_pictures"):
        return request.key
    scenario = {
        name: value for name, value in request.scenario.items() if name not in UNSEEN_FIELDS
    }
    options = [request.options.get(name) for name in SEEN_OPTIONS]
    return json.dumps([scenario, options], sort_keys=True)
