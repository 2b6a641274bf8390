"""The calls of people at seats one by one, from the button to the answer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any, Literal

from airhilt.messages import Message, SpokenTruth, Transcript
from airhilt.metrics.calls import TEXT
from airhilt.metrics.summary import PersonCall
from airhilt.units import SECOND_NS

HeardAfter = Callable[[str, int], Sequence[float | None]]
"""Times in s after which others heard a call since a time in ns; None: not as on the clock."""
NextCall = Callable[[SpokenTruth], SpokenTruth | None]
"""Returns the call of another person that came next, perhaps as an answer."""


@dataclass
class _Call:
    way: Literal["spoken", "typed"]
    since_ns: int
    """Time at which the button was pressed, or the words came."""
    told_ns: int
    """Time at which the run was told."""
    text: str | None = None
    """Words that were typed."""
    said: SpokenTruth | None = None
    """The call on the air; None if it was not there, or has not ended."""
    transcript: Transcript | None = None
    answer: SpokenTruth | None = None


class PersonCalls:
    """Follows the calls of the people at one seat, a unit or a callsign."""

    def __init__(self, seat: str) -> None:
        self._seat = seat
        self._calls: list[_Call] = []

    def type(self, t_ns: int, text: str) -> None:
        """Take in that a person has typed a call."""
        self._calls.append(_Call("typed", t_ns, t_ns, text))

    def press(self, pressed_ns: int, told_ns: int) -> None:
        """Take in that a person has pressed the button to speak, and when the run was told."""
        self._calls.append(_Call("spoken", pressed_ns, told_ns))

    def take(self, message: Message) -> None:
        """Receive a published message, which may be about one of the calls."""
        match message:
            case SpokenTruth(speaker=speaker) if speaker == self._seat:
                if (call := self._begun_by(message)) is not None:
                    call.said = message
            case SpokenTruth(in_reply_to=str(name)):
                if (call := self._on_air(name)) is not None and call.answer is None:
                    call.answer = message
            case Transcript(id=name, engine=engine) if engine != TEXT:
                if (call := self._on_air(name)) is not None and call.transcript is None:
                    call.transcript = message

    def made(self, name: str) -> bool:
        """Return true if a person made the call that was on the air as a transmission."""
        return self._on_air(name) is not None

    def rows(self, heard: HeardAfter, next_call: NextCall) -> list[PersonCall]:
        """Return what is known of each call, in the order in which they were begun."""
        in_order = sorted(self._calls, key=lambda call: call.since_ns)
        return [_row(call, heard, next_call) for call in in_order]

    def _begun_by(self, said: SpokenTruth) -> _Call | None:
        """Return the call that a transmission of the seat is, None if no person made it."""
        begun = [
            call
            for call in self._calls
            if call.said is None
            and (call.way == "spoken") is said.is_from_microphone
            and call.told_ns <= said.t_tx_ns
        ]
        if said.is_from_microphone:
            return begun[-1] if begun else None  # A press before it did not come on the air.
        return next((call for call in begun if call.text == said.text), None)

    def _on_air(self, name: str) -> _Call | None:
        return next((call for call in self._calls if call.said and call.said.id == name), None)


def _row(call: _Call, heard: HeardAfter, next_call: NextCall) -> PersonCall:
    said, transcript, answer = call.said, call.transcript, call.answer
    known: dict[str, Any] = {}
    if said is not None:
        after_s = heard(said.id, call.since_ns)
        measured = [one for one in after_s if one is not None]
        known = {
            "call": said.id,
            "frequency_khz": said.frequency_khz,
            "t_tx_s": said.t_tx_ns / SECOND_NS,
            "to_air_s": (said.t_tx_ns - call.since_ns) / SECOND_NS,
            "to_loudspeaker_s": median(measured) if measured else None,
            "heard_at": len(after_s),
            "length_s": (said.t_end_ns - said.t_tx_ns) / SECOND_NS,
            "blocked": bool(said.blocked_by),
        }
        if answer is not None:
            known["answered_after_s"] = (answer.t_tx_ns - said.t_end_ns) / SECOND_NS
        if (then := next_call(said)) is not None:
            known["next_call"] = then.id
            known["next_call_after_s"] = (then.t_tx_ns - said.t_end_ns) / SECOND_NS
    return PersonCall(
        way=call.way,
        t_s=call.since_ns / SECOND_NS,
        said=call.text,
        recognised=None if transcript is None else transcript.text,
        confidence=None if transcript is None else transcript.confidence,
        answer=None if answer is None else answer.text,
        **known,
    )
