"""What AIRHILT puts into each worker of Dask: runners, and the task that gives them a case."""

from __future__ import annotations

import queue
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from distributed import Worker, WorkerPlugin, get_worker

from airhilt.sweep.environment import Environment, require_same
from airhilt.sweep.outcome import Request
from airhilt.sweep.runner_process import Limits, RunnerProcess

PLUGIN = "airhilt"


class RunnerPlugin(WorkerPlugin):
    """Keeps the runners of one worker, as many as it has threads; they live until it ends.

    Parameters
    ----------
    renderer
        Renderer that the runs ask for; empty without cameras.
    expected
        Environment of the sweep; a worker with another one refuses to run anything.
    """

    name = PLUGIN

    def __init__(self, renderer: str, limits: Limits, expected: Environment) -> None:
        self.renderer = renderer
        self._limits = limits
        self._expected = expected

    def setup(self, worker: Worker) -> None:
        """Get ready; runners are started when they are needed."""
        self._idle: queue.LifoQueue[RunnerProcess] = queue.LifoQueue()
        self._where = worker.address
        if threading.current_thread() is threading.main_thread():
            # Ctrl-C is for the sweep, which lets runs in hand finish.
            signal.signal(signal.SIGINT, signal.SIG_IGN)

    def teardown(self, worker: Worker) -> None:  # noqa: ARG002
        """End the runners."""
        with suppress(queue.Empty):
            while True:
                self._idle.get_nowait().close()

    @contextmanager
    def runner(self) -> Iterator[RunnerProcess]:
        """Lend a runner whose environment is that of the sweep.

        Raises
        ------
        AirhiltError
            It cannot be started, or its software differs.
        """
        try:
            runner = self._idle.get_nowait()
        except queue.Empty:
            runner = RunnerProcess(self.renderer, self._limits)
        try:
            require_same(self._expected, runner.environment, self._where)
            yield runner
        finally:
            self._idle.put(runner)


def run_case(request: str) -> str:
    """Return the `Outcome` of a `Request`, both as JSON; a task of Dask.

    Raises
    ------
    AirhiltError
        No runner can be started here, or its software differs.
    """
    plugin = get_worker().plugins[PLUGIN]
    assert isinstance(plugin, RunnerPlugin)
    with plugin.runner() as runner:
        return runner.run(Request.model_validate_json(request)).model_dump_json()
