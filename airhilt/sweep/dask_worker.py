"""AIRHILT in each worker of Dask: runners, and the task that gives them a case."""

from __future__ import annotations

import os
import threading
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from distributed import Reschedule, Worker, WorkerPlugin, get_worker
from tornado.ioloop import PeriodicCallback

from airhilt.errors import AirhiltError
from airhilt.record.sweep_folder import SweepFolderError
from airhilt.sweep.environment import Environment, require_same
from airhilt.sweep.outcome import Request
from airhilt.sweep.runner_process import Limits, RunnerProcess, RunnerStopped

IDLE_S = 600.0
"""Time after which a runner that nobody asks is ended, in s: its sweep may have been killed."""
GRACE_S = 5.0
"""Time after the crash of a run in which its worker may be ended, in s.

A queue that ends a job kills all of its processes, and the runner may be the first of them.
"""
LOOK_MS = 60_000.0
"""Period at which such runners are looked for, in ms."""


class RunnerPlugin(WorkerPlugin):
    """Keeps the runners of one worker, as many as it has threads; they live until it ends.

    Each sweep has a plugin with a name of its own, so that several sweeps can share a scheduler.

    Parameters
    ----------
    renderer
        Renderer that the runs ask for; empty without cameras.
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
        """Get ready; runners are started when they are needed.

        Raises
        ------
        AirhiltError
            The worker does not see the folder in which runs are kept.
        """
        self._lock = threading.Lock()
        self._idle: list[tuple[RunnerProcess, float]] = []
        self._busy: list[RunnerProcess] = []
        self._over = threading.Event()
        self._where = worker.address
        look = PeriodicCallback(self._end_idle, LOOK_MS)
        worker.periodic_callbacks[self.name] = look
        look.start()
        self._require_seen()

    def teardown(self, worker: Worker) -> None:
        """End the runners; a run in hand is for another worker."""
        worker.periodic_callbacks.pop(self.name).stop()
        with self._lock:
            self._over.set()
            idle = [runner for runner, _ in self._idle]
            self._idle.clear()
            for runner in self._busy:
                runner.stop()
        for runner in idle:
            runner.close()

    def run(self, request: Request) -> str:
        """Return the `Outcome` of a run as JSON.

        Raises
        ------
        AirhiltError
            No runner can be started here, its software differs, or the folder is not seen.
        Reschedule
            The worker has been ended meanwhile.
        """
        self._require_seen()
        with self._runner() as runner:
            try:
                outcome = runner.run(request)
            except RunnerStopped:
                raise Reschedule from None
        if outcome.status == "crashed" and self._over.wait(GRACE_S):
            raise Reschedule
        return outcome.model_dump_json()

    @contextmanager
    def _runner(self) -> Iterator[RunnerProcess]:
        """Lend a runner whose environment is that of the sweep."""
        with self._lock:
            runner = self._idle.pop()[0] if self._idle else None
        runner = runner or RunnerProcess(self.renderer, self._limits)
        with self._lock:
            self._busy.append(runner)
            if self._over.is_set():
                runner.stop()
        try:
            require_same(self._expected, runner.environment, self._where)
            yield runner
        finally:
            with self._lock:
                self._busy.remove(runner)
                if not self._over.is_set():
                    self._idle.append((runner, time.monotonic()))
            if self._over.is_set():
                runner.close()

    def _end_idle(self) -> None:
        until = time.monotonic() - IDLE_S
        with self._lock:
            old = [runner for runner, since in self._idle if since < until]
            self._idle = [each for each in self._idle if each[1] >= until]
        for runner in old:
            runner.close()

    def _require_seen(self) -> None:
        """Complain about a worker that could not leave run folders where the sweep is."""
        probe = self._probe
        if probe is not None and not (probe.exists() and os.access(probe.parent, os.W_OK)):
            raise AirhiltError(
                f"worker {self._where}: does not see {probe.parent}, or cannot write there; "
                "expected --out on a file system that all workers share, or --keep none"
            )


def run_case(request: str, plugin: str) -> str:
    """Return the `Outcome` of a `Request`, both as JSON; a task of Dask.

    Parameters
    ----------
    plugin
        Name of the sweep's `RunnerPlugin`.

    Raises
    ------
    AirhiltError
        The worker cannot run anything.
    Reschedule
        The worker has been ended meanwhile.
    """
    found = get_worker().plugins[plugin]
    assert isinstance(found, RunnerPlugin)
    return found.run(Request.model_validate_json(request))


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
