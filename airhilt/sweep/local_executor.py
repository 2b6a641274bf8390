"""Runners on this machine, each asked by a thread of this process."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from types import TracebackType
from typing import Self

from airhilt.sweep.environment import Environment, require_same
from airhilt.sweep.outcome import Outcome, Request
from airhilt.sweep.runner_process import Limits, RunnerProcess

ENDING_S = 0.2
"""Period at which runners are killed until all have ended, in s."""


class LocalExecutor:
    """Does runs in processes of this machine, which start when they are needed.

    Parameters
    ----------
    expected
        Environment of the runs; a runner that finds another one, because files have changed since,
        is refused.
    workers
        Number of runners.
    """

    def __init__(self, renderer: str, limits: Limits, expected: Environment, workers: int) -> None:
        self.size = workers
        self._renderer = renderer
        self._limits = limits
        self._expected = expected
        self._threads = ThreadPoolExecutor(workers)
        self._runners: list[RunnerProcess] = []
        self._idle: list[RunnerProcess] = []
        self._in_hand: set[Future[Outcome]] = set()

    def ready(self, stops: Callable[[], bool]) -> str:  # noqa: ARG002
        """Return the runners in words; they need no waiting."""
        return f"{self.size} worker{'s' * (self.size != 1)}"

    def outcomes(self, requests: Sequence[Request], stops: Callable[[], bool]) -> Iterator[Outcome]:
        """Yield outcomes as they come; no more runs are begun once ``stops`` is true.

        Raises
        ------
        AirhiltError
            A runner cannot be started, or its software differs.
        """
        waiting = iter(requests)
        while True:
            while (
                not stops() and len(self._in_hand) < self.size and (request := next(waiting, None))
            ):
                self._in_hand.add(self._threads.submit(self._run, request))
            if not self._in_hand:
                return
            done, self._in_hand = wait(self._in_hand, return_when=FIRST_COMPLETED)
            for each in done:
                yield each.result()

    def _run(self, request: Request) -> Outcome:
        if self._idle:
            runner = self._idle.pop()
        else:
            runner = RunnerProcess(self._renderer, self._limits)
            self._runners.append(runner)
        try:
            require_same(self._expected, runner.environment, "of this machine")
            return runner.run(request)
        finally:
            self._idle.append(runner)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End the runners; a run in hand is lost."""
        self._threads.shutdown(wait=False, cancel_futures=True)
        while self._in_hand:  # A runner that starts meanwhile is killed the next time.
            for runner in self._runners:
                runner.kill()
            self._in_hand = wait(self._in_hand, timeout=ENDING_S).not_done
        for runner in self._runners:
            runner.close()
