"""A client of Dask without a scheduler: its tasks end as soon as they are submitted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from airhilt.sweep.dask_worker import RunnerPlugin
from airhilt.sweep.outcome import Outcome, Request
from made_up_runs import outcome


@dataclass(eq=False)
class FakeFuture:
    """A task that has ended with an outcome or with an error, or was lost with the scheduler."""

    ended: Outcome | BaseException
    status: str = "finished"

    def result(self) -> Outcome:
        """Return the outcome, or raise."""
        if isinstance(self.ended, BaseException):
            raise self.ended
        return self.ended

    def add_done_callback(self, done: Callable[[FakeFuture], None]) -> None:
        """Call at once."""
        done(self)


@dataclass
class FakeClient:
    """A client of a scheduler with some workers.

    ``threads`` are the numbers of threads of its worker, one after the other; the last one stays.
    """

    threads: list[int] = field(default_factory=lambda: [1])
    ends: Callable[[Request], Outcome | FakeFuture] = lambda request: outcome(request.key)

    def __post_init__(self) -> None:
        self.status = "running"
        self.scheduler = type("Scheduler", (), {"address": "tcp://head:8786"})
        self.plugins: list[str] = []
        self.submitted: list[Request] = []

    def nthreads(self) -> dict[str, int]:
        """Return the threads of the worker; fewer than none: the scheduler is gone."""
        count = self.threads.pop(0) if len(self.threads) > 1 else self.threads[0]
        if count < 0:
            raise OSError("gone")
        return {"tcp://w:1": count} if count else {}

    def scheduler_info(self) -> dict[str, str]:
        """Return where it is, with TLS."""
        return {"address": "tls://head:8786"}

    def register_plugin(self, plugin: RunnerPlugin) -> None:
        """Keep its name."""
        self.plugins.append(plugin.name)

    def unregister_worker_plugin(self, name: str) -> None:
        """Forget it."""
        self.plugins.remove(name)

    def submit(self, _task: object, request: Request, *_: object, **__: object) -> FakeFuture:
        """Return the task, which has ended."""
        self.submitted.append(request)
        ended = self.ends(request)
        return ended if isinstance(ended, FakeFuture) else FakeFuture(ended)
