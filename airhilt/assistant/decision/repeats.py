"""Confidence in words that two calls repeat.

A crew that is asked to confirm says the same words again. The words are wrong only if both calls
were recognised wrongly. The errors of two calls of one voice are taken to be independent, which is
nearly true: see docs/decision.md, "Words in doubt". At most two calls are joined, because no more
were measured.
"""

from __future__ import annotations

from typing import NamedTuple

from airhilt.assistant.decision.guard import ConfidenceGuard, Doubt, Slot, slots, value_slot
from airhilt.messages import Transcript
from airhilt.phraseology import Action, Call, Instruction
from airhilt.units import SECOND_NS

REMEMBERED_NS = 120 * SECOND_NS
"""Greatest time between two calls that are joined, in ns: as long as a doubt matters."""
_Key = tuple[str, bool, Action, Slot]
"""Callsign, whether it came first (a controller's call), action and slot."""


class _Heard(NamedTuple):
    """Confidence with which a slot was heard in a call."""

    value: tuple[str | None, float | None]
    """Runway, and level in ft, of the instruction."""
    confidence: float
    is_of_hearing: bool
    """True if it has that confidence for its words, not because it makes no sense."""
    transcript_id: str
    t_end_ns: int


class RememberingGuard:
    """A guard that joins the confidences of a slot with the same value in two calls.

    Each slot is joined separately, and only with calls of the same side: whether a readback agrees
    with its instruction is another question. Callsigns are not joined, because their confidence is
    that of a choice among those on the frequency. Values that made no sense in both calls are not
    joined either, however well they were heard. A different value in between starts anew.
    """

    def __init__(self, guard: ConfidenceGuard) -> None:
        self._guard = guard
        self._heard: dict[_Key, list[_Heard]] = {}
        """Calls with the same value, the oldest first."""

    def doubt(self, call: Call, said: Instruction, transcript: Transcript) -> Doubt | None:
        """Return the first slot of an instruction that is in doubt, None if there is none."""
        callsign, *rest = slots(call, said)
        if (doubt := self._doubt_in(callsign, call, said, transcript)) is not None:
            return doubt
        doubts = [self._doubt_in(slot, call, said, transcript) for slot in rest]
        return next((each for each in doubts if each is not None), None)

    def doubt_of_value(self, call: Call, said: Instruction, transcript: Transcript) -> Doubt | None:
        """Return the doubt about the runway or the level of an instruction, None if there is none.

        An instruction and its readback that agree in the callsign and the action settle these.
        """
        return self._doubt_in(value_slot(said), call, said, transcript)

    def doubt_of_rest(
        self, callsign: str, missing: Instruction, transcript: Transcript
    ) -> Doubt | None:
        """Return the doubt that a call had an instruction that was not heard, as the guard does."""
        return self._guard.doubt_of_rest(callsign, missing, transcript)

    def _doubt_in(
        self, slot: Slot, call: Call, said: Instruction, transcript: Transcript
    ) -> Doubt | None:
        confidence = slots(call, said)[slot]
        if slot != "callsign" and call.match.callsign is not None:
            key = (call.match.callsign, call.addressed_first, said.action, slot)
            is_of_hearing = slot == "action" or said.details_heard <= confidence
            confidence = self._joined(
                key,
                _Heard(
                    (said.runway, said.altitude_ft),
                    confidence,
                    is_of_hearing,
                    transcript.id,
                    transcript.t_end_ns,
                ),
            )
        if confidence >= self._guard.tau_asr:
            return None
        return Doubt.of(call, said, transcript, slot, confidence)

    def _joined(self, key: _Key, heard: _Heard) -> float:
        """Remember what was heard, and return the confidence in it and an earlier call together."""
        before = [each for each in self._heard.get(key, ()) if _is_repeated(each, heard)]
        self._heard[key] = [*before, heard]
        by_words = (e.confidence for e in before if e.is_of_hearing or heard.is_of_hearing)
        return 1.0 - (1.0 - max(by_words, default=0.0)) * (1.0 - heard.confidence)


def _is_repeated(one: _Heard, other: _Heard) -> bool:
    """Return whether another call, not long before or after, had the same value."""
    return (
        one.transcript_id != other.transcript_id
        and one.value == other.value
        and abs(one.t_end_ns - other.t_end_ns) <= REMEMBERED_NS
    )
