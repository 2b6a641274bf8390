"""Runs that nobody runs: each ends at once, as a test says."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, cast

from airhilt.sweep.executors import Executors
from airhilt.sweep.outcome import Machine, Outcome, Request, Status

Ends = Callable[[Request], Outcome]
MACHINE = Machine(wall_s=0.0, cpu_s=0.0, peak_memory_mb=0.0, host="h", process=1)


def outcome(key: str, status: Status = "finished", cause: str = "") -> Outcome:
    """Return an outcome without metrics."""
    return Outcome(key=key, status=status, cause=cause, machine=MACHINE)


class MadeUpRuns:
    """An executor that keeps what it was asked for."""

    size = 2

    def __init__(self, ends: Ends) -> None:
        self._ends = ends
        self.asked: list[Request] = []

    def ready(self, _: object) -> str:
        """Return the workers in words."""
        return "2 workers"

    def outcomes(self, requests: Sequence[Request], stops: Callable[[], bool]) -> Iterator[Outcome]:
        """End one run after the other."""
        for request in requests:
            if stops():
                return
            self.asked.append(request)
            yield self._ends(request)

    def executors(self) -> Executors:
        """Return what gives this one for all runs."""
        return cast(Executors, _Only(self))


class _Only:
    def __init__(self, executor: MadeUpRuns) -> None:
        self._executor = executor

    def of(self, *_: Any) -> MadeUpRuns:
        return self._executor
