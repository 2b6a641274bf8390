"""Notices about seats: to the log, to the user, and to the person who cannot have what is asked."""

from __future__ import annotations

from airhilt.cosim.events import EventPublisher
from airhilt.cosim.observer import Observer
from airhilt.messages import (
    AgreeToUses,
    Event,
    LeaveSeat,
    Message,
    SeatAct,
    SeatAction,
    SeatState,
    TakeSeat,
    TuneFrequencies,
)
from airhilt.seats import Seats
from airhilt.sim.payload import Payload


class SeatNotices:
    """Logs what changes at seats, and tells a person that a command cannot be done.

    Parameters
    ----------
    observer
        Is told of a person who leaves; None in a replay.
    """

    def __init__(self, seats: Seats, event: EventPublisher, observer: Observer | None) -> None:
        self._seats = seats
        self._event = event
        self._observer = observer

    def take(self, key: str, message: Message, data: Payload) -> None:  # noqa: ARG002
        """Receive a message of the run."""
        if isinstance(message, Event) and message.kind == "unable":
            why = message.text.removeprefix("unable").lstrip(" ,:")
            self._seats.notify(message.subject, f"Unable: {why}")
        if not isinstance(message, SeatAction) or (state := self._seats.at(key)) is None:
            return
        if text := _text_of(message.act, state):
            self._event("seat", state.seat, text)
        if isinstance(message.act, LeaveSeat) and self._observer is not None:
            self._observer.notice(f"seat {state.seat}: its person has left, and its script goes on")


def _text_of(act: SeatAct, state: SeatState) -> str:
    """Return what an act changes at a seat, in words; empty if nothing."""
    match act:
        case TakeSeat():
            return "a person has it"
        case LeaveSeat():
            return "nobody is there: its script goes on"
        case AgreeToUses(uses=uses) if "voice" in uses:
            kept = "is" if state.voice_is_recorded else "is not"
            return f"agrees to speak and type; the voice {kept} recorded"
        case AgreeToUses(uses=uses):
            return "agrees to type; the words are recorded" if uses else "agrees to nothing"
        case TuneFrequencies(frequencies_khz=tuned):
            listed = [f"{khz / 1000:.3f} MHz" for khz in sorted(tuned)]
            return f"listens to {' and '.join(listed) or 'no frequency'}"
    return ""
