"""AIRHILT in each worker of Dask: runners, and the task that gives them a case."""

from __future__ import annotations

import os
import threading
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from distributed import Reschedule, Worker, WorkerPlugin, get_worker

from airhilt.errors import AirhiltError
from airhilt.record.sweep_folder import SweepFolderError
from airhilt.sweep.environment import Environment, require_same
from airhilt.sweep.outcome import Outcome, Request
from airhilt.sweep.runner_process import Limits, RunnerProcess

GRACE_S = 5.0
"""Time after the crash of a run in which its worker may be ended, in s.

A queue that ends a job kills all of its processes, and the runner may be the first of them.
"""


class RunnerPlugin(WorkerPlugin):
    """Keeps the runners of one worker, as many as it has threads, until the sweep ends.

    Each sweep has a plugin with a name of its own, so that several sweeps can share a scheduler.

    Parameters
    ----------
    expected
        Environment of the sweep; a worker with another one refuses to run anything.
    probe
        File in the sweep's folder that a worker must see; None: nothing is kept there.
    """

    def __init__(
        self, renderer: str, limits: Limits, expected: Environment, probe: Path | None = None
    ) -> None:
        self.name = f"airhilt-{uuid.uuid4().hex}"
        self.renderer = renderer
        self._limits = limits
        self._expected = expected
        self._probe = probe

    def setup(self, worker: Worker) -> None:
        """Get ready; runners are started when they are needed."""
        self._runners: list[RunnerProcess] = []
        self._idle: list[RunnerProcess] = []
        self._over = threading.Event()
        self._where = worker.address

    def teardown(self, worker: Worker) -> None:  # noqa: ARG002
        """End the runners; a run in hand is for another worker."""
        self._over.set()
        for runner in self._runners:
            if runner in self._idle:
                runner.close()
            else:
                runner.kill()

    def run(self, request: Request) -> Outcome:
        """Return the outcome of a run.

        Raises
        ------
        AirhiltError
            No runner can be started here, its software differs, or the folder is not seen.
        Reschedule
            The worker has been ended meanwhile.
        """
        self._require_seen()
        if self._idle:
            runner = self._idle.pop()
        else:
            runner = RunnerProcess(self.renderer, self._limits)
            self._runners.append(runner)
        try:
            require_same(self._expected, runner.environment, self._where)
            outcome = runner.run(request)
        finally:
            self._idle.append(runner)
        if outcome.status == "crashed" and self._over.wait(GRACE_S):
            raise Reschedule
        return outcome

    def _require_seen(self) -> None:
        """Complain about a worker that could not leave run folders where the sweep is."""
        probe = self._probe
        if probe is not None and not (probe.exists() and os.access(probe.parent, os.W_OK)):
            raise AirhiltError(
                f"worker {self._where}: does not see {probe.parent}, or cannot write there; "
                "expected --out on a file system that all workers share, or --keep none"
            )


def run_case(request: Request, plugin: str) -> Outcome:
    """Return what `RunnerPlugin.run` does; a task of Dask."""
    found = get_worker().plugins[plugin]
    assert isinstance(found, RunnerPlugin)
    return found.run(request)


@contextmanager
def probe_in(folder: Path) -> Iterator[Path]:
    """Put a file into a folder for the workers to look for; it goes with the context.

    Raises
    ------
    SweepFolderError
        It cannot be written.
    """
    probe = folder.absolute() / f".probe-{uuid.uuid4().hex}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe.touch()
    except OSError as error:
        raise SweepFolderError(f"{folder}: cannot be written: {error.strerror}") from None
    try:
        yield probe
    finally:
        probe.unlink(missing_ok=True)
