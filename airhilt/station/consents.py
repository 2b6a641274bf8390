"""The consent of the people at the seats of a run to the use of their voices and typed words."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from airhilt.messages import SeatConsent, Use

NO_VOICE = "Your call was cut: you have not agreed to the use of your voice."
"""Reason for which what is spoken is refused; a page whose call is cut ends it."""
NO_WORDS = "Nothing was said: you have not agreed to the use of what you type."
"""Reason for which what is typed is refused."""


class Consents:
    """Keeps what the person at each seat agrees to, until the seat is left.

    Parameters
    ----------
    agreed
        Use to which who takes a seat first has agreed before, by seat.
    """

    def __init__(self, agreed: Mapping[str, Use] = MappingProxyType({})) -> None:
        self._before = dict(agreed)
        self._given: dict[str, frozenset[Use]] = {}

    def take(self, seat: str, answer: SeatConsent) -> None:
        """Take in an answer. What is taken back counts as not agreed to before either."""
        given = answer.applied_to(self._given.get(seat, frozenset()))
        self._given[seat] = given
        if self._before.get(seat) not in given:
            self._before.pop(seat, None)

    def begin(self, seat: str) -> None:
        """Forget the answers at a seat, whose page asks for them: what was agreed before is left.

        The page is that of a person who has taken the seat, or was loaded again.
        """
        before = self._before.get(seat)
        self._given[seat] = frozenset() if before is None else frozenset({before})

    def end(self, seat: str) -> None:
        """Forget all that was agreed to at a seat, also before: another person may have it next."""
        self._before.pop(seat, None)
        self._given.pop(seat, None)

    def before(self, seat: str) -> SeatConsent | None:
        """Return to what the person at a seat has agreed before, None if to nothing."""
        before = self._before.get(seat)
        return None if before is None else SeatConsent(what=before, is_given=True)

    def given_at(self, seat: str | None) -> tuple[Use, ...]:
        """Return the uses to which the person at a seat agrees."""
        return () if seat is None else tuple(sorted(self._given.get(seat, ())))

    def admits_voice(self, seat: str | None) -> bool:
        """Return true if what the person at a seat speaks may be used."""
        return "voice" in self.given_at(seat)

    def admits_words(self, seat: str | None) -> bool:
        """Return true if what the person at a seat types may be used."""
        return bool(self.given_at(seat))
