"""Intervals of time: when something went on."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from typing import Any, Generic, NamedTuple, TypeVar

from airhilt.units import SECOND_NS

T = TypeVar("T", bound=Hashable)

BRIDGED_NS = SECOND_NS // 2
"""Pauses up to this, in ns, are left out of `BridgedIntervals` at least."""
MOST_INTERVALS = 200
"""Largest number of intervals in one `BridgedIntervals`."""


class Interval(NamedTuple, Generic[T]):
    """Something that went on from one time to another."""

    what: T
    from_ns: int
    to_ns: int

    def times_as_json(self) -> dict[str, Any]:
        """Return begin and end in s."""
        return {"from": seconds(self.from_ns), "to": seconds(self.to_ns)}


class Intervals(Generic[T]):
    """Finds intervals in reports of what goes on, which come at rising times."""

    def __init__(self) -> None:
        self._ended: list[Interval[T]] = []
        self._begun_ns: dict[T, int] = {}

    def update(self, t_ns: int, now: Iterable[T]) -> None:
        """Set what goes on from this time on; everything else has ended."""
        going_on = dict.fromkeys(now)
        for what in [what for what in self._begun_ns if what not in going_on]:
            self._ended.append(Interval(what, self._begun_ns.pop(what), t_ns))
        for what in going_on:
            self._begun_ns.setdefault(what, t_ns)

    def until(self, end_ns: int) -> list[Interval[T]]:
        """Return all intervals in the order of their begins; those that go on end here."""
        going_on = [Interval(what, begun_ns, end_ns) for what, begun_ns in self._begun_ns.items()]
        return sorted([*self._ended, *going_on], key=lambda interval: interval.from_ns)


def seconds(t_ns: int) -> float:
    """Return a time in s, to hundredths."""
    return round(t_ns / SECOND_NS, 2)


class BridgedIntervals:
    """Finds intervals in instants at which something was so, without short pauses.

    Once there are too many intervals, pauses of over half a second are bridged too.
    """

    def __init__(self) -> None:
        self._bridged_ns = BRIDGED_NS
        self._intervals: list[tuple[int, int]] = []

    def add(self, t_ns: int) -> None:
        """Add an instant; times rise."""
        self._append(t_ns, t_ns)
        while len(self._intervals) > MOST_INTERVALS:
            self._bridged_ns *= 2
            shorter, self._intervals = self._intervals, []
            for begin, end in shorter:
                self._append(begin, end)

    def _append(self, begin_ns: int, end_ns: int) -> None:
        if self._intervals and begin_ns - self._intervals[-1][1] <= self._bridged_ns:
            begin_ns = self._intervals.pop()[0]
        self._intervals.append((begin_ns, end_ns))

    def as_json(self) -> list[tuple[float, float]]:
        """Return begin and end of each interval, in s."""
        return [(seconds(begin), seconds(end)) for begin, end in self._intervals]
