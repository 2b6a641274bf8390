"""The consent of the people at the seats of a run to the use of their voices and typed words."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from airhilt.messages import SeatConsent

NO_VOICE = "Your call was cut: you have not agreed to the use of your voice."
"""Reason for which what is spoken is refused; a page whose call is cut ends it."""
NO_WORDS = "Nothing was said: you have not agreed to the use of what you type."
"""Reason for which what is typed is refused."""


class Consents:
    """Keeps what the person at each seat agrees to, until the seat is left.

    Parameters
    ----------
    agreed
        Use of voice and words, in the words of `SeatConsent`, to which who takes a seat first has
        agreed before, by seat.
    """

    def __init__(self, agreed: Mapping[str, str] = MappingProxyType({})) -> None:
        self._before = dict(agreed)
        self._given: dict[str, set[str]] = {}

    def take(self, seat: str, answer: SeatConsent) -> None:
        """Take in an answer.

        Consent to the use of the voice covers typed words, so who declines the use of words
        declines that of the voice too. What is taken back was not agreed to before either.
        """
        given = self._given.setdefault(seat, set())
        if answer.is_given:
            given.add(answer.what)
        else:
            given -= {answer.what} if answer.what == "voice" else {"words", "voice"}
            if self._before.get(seat) not in given:
                self._before.pop(seat, None)

    def begin(self, seat: str) -> None:
        """Forget the answers at a seat, whose page asks for them: what was agreed before is left.

        The page is that of a person who has taken the seat, or was loaded again.
        """
        self._given[seat] = {self._before[seat]} if seat in self._before else set()

    def end(self, seat: str) -> None:
        """Forget all that the person has agreed to who has left a seat, also before."""
        self._before.pop(seat, None)
        self._given.pop(seat, None)

    def before(self, seat: str) -> SeatConsent | None:
        """Return to what the person at a seat has agreed before, None if to nothing."""
        if seat not in self._before:
            return None
        return SeatConsent.model_validate({"what": self._before[seat], "is_given": True})

    def given_at(self, seat: str | None) -> tuple[str, ...]:
        """Return what the person at a seat agrees to, in the words of `SeatConsent`."""
        return () if seat is None else tuple(sorted(self._given.get(seat, ())))

    def admits_voice(self, seat: str | None) -> bool:
        """Return true if what the person at a seat speaks may be used."""
        return "voice" in self.given_at(seat)

    def admits_words(self, seat: str | None) -> bool:
        """Return true if what the person at a seat types may be used."""
        return bool(self.given_at(seat))
