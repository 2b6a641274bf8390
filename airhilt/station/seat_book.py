"""The seats of a run: which browser has each, and for whom it is kept while that is gone."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Generic, Literal, Protocol, TypeVar

from airhilt.text import readable

HOLD_S = 5.0
"""Time for which the seat of a browser that is gone is kept for it, in s."""
Shown = Literal["yours", "taken", "free"]


class Person(Protocol):
    """Person at a browser, with the name that the browser keeps; empty: it has none."""

    identity: str


P = TypeVar("P", bound=Person)


@dataclass(frozen=True, eq=False)
class Hold:
    """A seat that is kept for the browser of an identity, for a time in s."""

    seat: str
    identity: str
    seconds: float


class SeatBook(Generic[P]):
    """Book of who has which seat.

    Parameters
    ----------
    seats
        Names of the seats, each for one person at a time.
    """

    def __init__(self, seats: Collection[str]) -> None:
        self.seats = tuple(seats)
        self._had: dict[str, P] = {}
        self._held: dict[str, Hold] = {}

    def of(self, person: P) -> str | None:
        """Return the seat of a person, None without one."""
        return next((seat for seat, other in self._had.items() if other is person), None)

    def is_free(self, seat: str) -> bool:
        """Return true if nobody has a seat, and it is kept for nobody."""
        return seat not in self._had and seat not in self._held

    def why_not(self, person: P, seat: str) -> str | None:
        """Return why a person cannot have a seat, None if it can."""
        if seat not in self.seats:
            return f"{readable(seat)} is no seat of this run."
        if self._had.get(seat, person) is not person:
            return f"Somebody has the seat {readable(seat)} already."
        hold = self._held.get(seat)
        if hold is not None and (not person.identity or hold.identity != person.identity):
            return f"{readable(seat)} is kept for {hold.seconds:g} s for who had it."
        return None

    def move(self, person: P, seat: str | None) -> str | None:
        """Give a person a seat that it can have, or none; return the seat that it has left."""
        left = self.of(person)
        if left is not None:
            del self._had[left]
        if seat is not None:
            self._held.pop(seat, None)
            self._had[seat] = person
        return left

    def hold(self, person: P) -> Hold | None:
        """Keep the seat of a person who is gone; None if it has none."""
        seat = self.move(person, None)
        if seat is None:
            return None
        self._held[seat] = Hold(seat, person.identity, HOLD_S)
        return self._held[seat]

    def give_back(self, person: P) -> None:
        """Give a person who comes back the seat that is kept for it.

        It has one of several seats, and the others are kept until they expire.
        """
        held = (seat for seat, hold in self._held.items() if hold.identity == person.identity)
        if person.identity and (seat := next(held, None)) is not None:
            self.move(person, seat)

    def expire(self, hold: Hold) -> bool:
        """Free a seat that was kept long enough; return false if it is not kept any more."""
        if self._held.get(hold.seat) is not hold:
            return False
        del self._held[hold.seat]
        return True

    def shown_to(self, person: P) -> dict[str, Shown]:
        """Return what a person is told of each seat."""
        own = self.of(person)
        return {
            seat: "yours" if seat == own else "free" if self.is_free(seat) else "taken"
            for seat in self.seats
        }
