"""Executors of the runs of sweeps: runners on this machine, or the workers of a Dask scheduler."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from types import TracebackType
from typing import Protocol, Self

from airhilt.sweep.environment import Environment
from airhilt.sweep.local_executor import LocalExecutor
from airhilt.sweep.outcome import Outcome, Request
from airhilt.sweep.work import LOCAL, Work, default_workers


class Executor(Protocol):
    """Does runs, several at a time."""

    def ready(self, stops: Callable[[], bool]) -> str:
        """Wait until something can be run, or the user stops; return who does it in words."""

    @property
    def size(self) -> int:
        """Number of runs that it does at a time."""

    def outcomes(self, requests: Sequence[Request], stops: Callable[[], bool]) -> Iterator[Outcome]:
        """Yield outcomes as they come; no more runs are begun once ``stops`` is true.

        Raises
        ------
        AirhiltError
            Nothing can be run.
        """


class Executors:
    """Executor of one sweep after another; what was started for it ends with this.

    Runners stay from sweep to sweep while the renderer is the same.
    """

    def __init__(self, work: Work) -> None:
        self._work = work
        self._stack = ExitStack()
        self._last: tuple[str, Environment] | None = None
        self._executor: Executor

    def of(self, renderer: str, expected: Environment, notice: Callable[[str], None]) -> Executor:
        """Return who does runs with a renderer.

        Parameters
        ----------
        expected
            Environment that runners must have.

        Raises
        ------
        AirhiltError
            The scheduler cannot be reached.
        """
        if self._last != (renderer, expected):
            self._stack.close()
            self._executor = self._begun(renderer, expected, notice)
            self._last = renderer, expected
        return self._executor

    def _begun(
        self, renderer: str, expected: Environment, notice: Callable[[str], None]
    ) -> Executor:
        work = self._work
        if work.scheduler == LOCAL:
            workers = work.workers or default_workers(renderer)
            return self._stack.enter_context(
                LocalExecutor(renderer, work.limits, expected, workers)
            )
        from airhilt.sweep.dask_executor import DaskExecutor

        return self._stack.enter_context(
            DaskExecutor(work.scheduler, renderer, work.limits, expected, notice)
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._stack.close()
