"""Views of a run, one for each seat of a person, and changes that only the person there sees."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from airhilt.host.text import readable
from airhilt.messages import SeatState
from airhilt.station.audiences import EVERYBODY, NOBODY, Audience, sees
from airhilt.station.changes import Newest
from airhilt.units import SECOND_NS


class SeatViews:
    """Views of the seats of a run, each known once the run has told of the seat.

    A unit sees what receivers, radars and cameras of the ground give. A crew or a driver sees
    ADS-B with a receiver of its own, else its own position alone, and the cameras that it carries.
    Each hears its frequencies, and gets advisories to itself.

    Parameters
    ----------
    seats
        Names of the seats; without any, everything is seen.

    Attributes
    ----------
    own
        What only the person at a seat sees, by seat.
    """

    def __init__(self, seats: Iterable[str] = ()) -> None:
        self.own = {seat: Newest() for seat in seats}
        self._states: dict[str, SeatState] = {}
        self._cameras: dict[str, Audience] = {}

    def learn(self, state: SeatState) -> None:
        """Take in what a run says of a seat, and let the person there know."""
        self._states[state.seat] = state
        self.own[state.seat].put("seat", _as_json(state))

    def learn_camera(self, name: str, audience: Audience) -> None:
        """Take in who may see the pictures of a camera."""
        self._cameras[name] = audience

    def holder(self, seat: str) -> str | None:
        """Return the name of the holder's token of a seat, None if nobody has it."""
        return self._states[seat].holder if seat in self._states else None

    def records_voices(self, seat: str) -> bool:
        """Return whether what is spoken at a seat is recorded; true if it is not known yet."""
        return seat not in self._states or self._states[seat].voice_is_recorded

    def tuned_khz(self, seat: str | None) -> tuple[int, ...]:
        """Return the frequencies to which the person at a seat listens; None: without a seat."""
        state = self._states.get(seat or "")
        return () if state is None else state.tuned_khz

    def hears(self, seat: str | None, audience: Audience) -> bool:
        """Return true if a piece of a transmission with this audience is heard at a seat.

        It comes from the own receiver of the seat, or where it has none from the units' site.
        """
        state = self._states.get(seat or "")
        if state is None:
            return False
        if state.has_own_receiver:
            return audience == Audience("receiver", state.seat)
        return audience.way == "frequency" and sees(state, audience)

    def sees(self, seat: str | None, audience: Audience) -> bool:
        """Return true if something with this audience is seen at a seat; None: without one."""
        if not self.own or audience == EVERYBODY:
            return True
        state = self._states.get(seat or "")
        return state is not None and sees(state, audience)

    def shows_camera(self, seat: str | None, name: str) -> bool:
        """Return true if the pictures of a camera are seen at a seat."""
        return self.sees(seat, self._cameras.get(name, NOBODY))


def _as_json(state: SeatState) -> dict[str, Any]:
    """Return the state of a seat as its own page shows it."""
    shown = state.model_dump(mode="json", exclude={"t_ns", "holder"})
    shown["tasks"] = [
        {"line": readable(card.line), "t": _seconds(card.due_ns), "text": readable(card.text)}
        | {"addressed": None if card.addressed is None else readable(card.addressed)}
        for card in state.tasks
    ]
    if (asked := state.question) is not None:
        shown["question"] |= {"t": _seconds(asked.asked_ns)}
    if (told := state.notice) is not None:
        shown["notice"] = {"t": _seconds(told.told_ns), "text": readable(told.text)}
    return shown


def _seconds(t_ns: int) -> float:
    return round(t_ns / SECOND_NS, 3)
