"""What went on for how long: the phases of each actor, and who used each runway."""

from __future__ import annotations

import json
import re
from collections.abc import Hashable, Iterable
from typing import Any, Generic, NamedTuple, TypeVar

Json = dict[str, Any]
T = TypeVar("T", bound=Hashable)

PHASE = re.compile(rb'"phase":\s*("(?:[^"\\]|\\.)*")')
"""In the bytes of a state: to parse each only to see that nothing has changed takes too long."""


class Interval(NamedTuple, Generic[T]):
    """Something that went on from one time to another."""

    what: T
    from_ns: int
    to_ns: int


class Intervals(Generic[T]):
    """Makes spells of what goes on at rising times."""

    def __init__(self) -> None:
        self._ended: list[Interval[T]] = []
        self._begun_ns: dict[T, int] = {}

    def go_on(self, t_ns: int, now: Iterable[T]) -> None:
        """Take in what goes on from this time on; all else has ended."""
        going_on = dict.fromkeys(now)
        for what in [what for what in self._begun_ns if what not in going_on]:
            self._ended.append(Interval(what, self._begun_ns.pop(what), t_ns))
        for what in going_on:
            self._begun_ns.setdefault(what, t_ns)

    def until(self, end_ns: int) -> list[Interval[T]]:
        """Return all spells in the order in which they began; those that go on end here."""
        going_on = [Interval(what, begun_ns, end_ns) for what, begun_ns in self._begun_ns.items()]
        return sorted([*self._ended, *going_on], key=lambda interval: interval.from_ns)


class PhaseLane:
    """The phases of one actor."""

    def __init__(self) -> None:
        self._spells: Intervals[str] = Intervals()
        self._phase = b""
        self._last_ns = 0

    def take(self, t_ns: int, state: bytes) -> None:
        """Take in a true state, as it was logged."""
        self._last_ns = t_ns
        found = PHASE.search(state)
        if found is not None and found[1] != self._phase:
            self._phase = found[1]
            self._spells.go_on(t_ns, [json.loads(self._phase)])

    def intervals(self) -> list[Interval[str]]:
        """Return its phases, the last until its last state."""
        return self._spells.until(self._last_ns)


class Approach(NamedTuple):
    """An aircraft on its way to a runway, by the direction in which it lands."""

    actor: str
    runway: str


class RunwayLane:
    """Who was in the protected area of one runway, and who was about to land on it."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._occupants: Intervals[str] = Intervals()
        self._approaches: Intervals[Approach] = Intervals()

    def take(self, t_ns: int, truth: Json) -> None:
        """Take in a `RunwayTruth`."""
        self._occupants.go_on(t_ns, truth["occupants"])
        self._approaches.go_on(
            t_ns, (Approach(arrival["actor"], arrival["runway"]) for arrival in truth["arrivals"])
        )

    def occupants(self, end_ns: int) -> list[Interval[str]]:
        """Return when each actor was in the protected area."""
        return self._occupants.until(end_ns)

    def approaches(self, end_ns: int) -> list[Interval[Approach]]:
        """Return when each aircraft was known to come, until it was down or went around."""
        return self._approaches.until(end_ns)
