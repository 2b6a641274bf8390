"""The guard of the AIRHILT paper's ladder: it finds slots heard with too little confidence.

Each slot of an instruction that the engine acts on has the recogniser's least confidence in its
words. The value of a slot has the parser's confidence too: "descend and maintain five thousand five
hundred ten" may have been heard well, and makes no sense. Below tau_ASR the slot is in doubt: the
engine neither believes nor ignores it, and asks for it (arXiv 2511.18718).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from airhilt.messages import Transcript
from airhilt.phraseology import TAU_ASR, Action, Call, Instruction, parse_call
from airhilt.units import SECOND_NS

Slot = Literal["callsign", "action", "runway", "altitude"]
AMBIGUOUS = 0.5
"""Confidence in a callsign that may be either of two, as in docs/parser-accuracy.md."""
REPEATED_NS = 120 * SECOND_NS
"""Greatest time between two calls that are joined, in ns: as long as a doubt matters."""


def call_of(
    transcript: Transcript,
    callsigns: Iterable[str],
    ceilings_ft: Mapping[str, float] | None = None,
) -> Call:
    """Return the meaning of a transcript, with the confidences of its words.

    Without a confidence for each word, each word has that of the whole. A level above the ceiling
    of an aircraft is in doubt.
    """
    words = _by_word(transcript)
    return parse_call(transcript.text, callsigns, words, ceilings_ft=ceilings_ft)


def _by_word(transcript: Transcript) -> list[float]:
    size = len(transcript.text.split())
    by_word = [word.confidence for word in transcript.words]
    return by_word if len(by_word) == size else [transcript.confidence] * size


@dataclass(frozen=True, slots=True)
class Doubt:
    """An instruction, or its readback, of which one slot is in doubt."""

    callsign: str
    """Callsign that was heard, or the likeliest one."""
    slot: Slot
    confidence: float
    said: Instruction
    transcript: Transcript
    is_answered: bool
    """True if no readback that may settle it is expected any more."""


def _slots(call: Call, said: Instruction) -> dict[Slot, float]:
    """Return the slots of an instruction with their confidences, in the order of questions.

    The last slot is its runway or its level.
    """
    return {
        "callsign": AMBIGUOUS if call.match.ambiguous else call.match.score,
        "action": said.action_heard,
        _value_slot(said): _value(said),
    }


def _value_slot(said: Instruction) -> Slot:
    return "runway" if said.altitude_ft is None else "altitude"


def _value(said: Instruction) -> float:
    """Return the confidence in the runway or the level; that of the words if neither is named."""
    is_named = said.runway is not None or said.altitude_ft is not None
    return said.details_confidence if is_named else said.details_heard


@dataclass(frozen=True, slots=True)
class ConfidenceGuard:
    """Tells which slot of an instruction is in doubt; with a threshold of 0 it tells nothing."""

    tau_asr: float = TAU_ASR

    def is_certain(self, said: Instruction) -> bool:
        """Return whether the words of an instruction or a report are certain, whoever said them."""
        return min(said.action_heard, said.details_heard, _value(said)) >= self.tau_asr

    def doubt(self, call: Call, said: Instruction, transcript: Transcript) -> Doubt | None:
        """Return the first slot of an instruction that is in doubt, None if there is none."""
        for slot, confidence in _slots(call, said).items():
            if confidence < self.tau_asr:
                return self._doubt(call, said, transcript, slot, confidence)
        return None

    def doubt_of_rest(
        self, callsign: str, missing: Instruction, transcript: Transcript
    ) -> Doubt | None:
        """Return the doubt whether a call had an instruction that was not recognised.

        It may have had it if any of its words is in doubt; None if none is.
        """
        least = min(_by_word(transcript), default=0.0)
        if least >= self.tau_asr:
            return None
        return Doubt(callsign, "action", least, missing, transcript, is_answered=True)

    def _doubt(
        self, call: Call, said: Instruction, transcript: Transcript, slot: Slot, confidence: float
    ) -> Doubt | None:
        """Return the doubt if the confidence is too low, and the call names a known callsign."""
        callsign = call.match.callsign
        if callsign is None or confidence >= self.tau_asr:
            return None
        return Doubt(callsign, slot, confidence, said, transcript, not call.addressed_first)


_Key = tuple[str, bool, Action, Slot]
"""Callsign, whether it came first (a controller's call), action and slot."""


class _Heard(NamedTuple):
    """Confidence with which a slot was heard in a call."""

    value: tuple[str | None, float | None]
    """Runway, and level in ft, of the instruction."""
    confidence: float
    is_of_hearing: bool
    """True if it has that confidence for its words, not because it makes no sense."""
    transcript: Transcript

    def repeats(self, other: _Heard) -> bool:
        """Return whether another call, not long before or after, had the same value."""
        one_ns, other_ns = self.transcript.t_end_ns, other.transcript.t_end_ns
        is_other = self.transcript.id != other.transcript.id
        return is_other and self.value == other.value and abs(one_ns - other_ns) <= REPEATED_NS


@dataclass(frozen=True, slots=True)
class RememberingGuard(ConfidenceGuard):
    """A guard that joins the confidences of a slot with the same value in two calls.

    A crew that is asked to confirm says the same words again. They are wrong only if both calls
    were recognised wrongly, and the errors of two calls of one voice are taken to be independent:
    see docs/reference-assistant.md, "Words in doubt". No more than two calls are joined, because no
    more were measured.

    Each slot is joined separately, and only with calls of the same side: whether a readback agrees
    with its instruction is another question. Callsigns are not joined, because their confidence is
    that of a choice among those on the frequency. Values that made no sense in both calls are not
    joined either, however well they were heard. A different value in between starts anew.
    """

    _heard: dict[_Key, list[_Heard]] = field(default_factory=dict)
    """Calls with the same value, the oldest first."""

    def doubt(self, call: Call, said: Instruction, transcript: Transcript) -> Doubt | None:
        """Return the first slot of an instruction that is in doubt, None if there is none."""
        callsign, *rest = _slots(call, said)
        if (doubt := self._doubt_in(callsign, call, said, transcript)) is not None:
            return doubt
        doubts = [self._doubt_in(slot, call, said, transcript) for slot in rest]
        return next((each for each in doubts if each is not None), None)

    def doubt_of_value(self, call: Call, said: Instruction, transcript: Transcript) -> Doubt | None:
        """Return the doubt about the runway or the level of an instruction, None if there is none.

        An instruction and its readback that agree in the callsign and the action settle these.
        """
        return self._doubt_in(_value_slot(said), call, said, transcript)

    def _doubt_in(
        self, slot: Slot, call: Call, said: Instruction, transcript: Transcript
    ) -> Doubt | None:
        confidence = _slots(call, said)[slot]
        if slot != "callsign" and call.match.callsign is not None:
            value = (said.runway, said.altitude_ft)
            is_of_hearing = slot == "action" or said.details_heard <= confidence
            confidence = self._joined(
                (call.match.callsign, call.addressed_first, said.action, slot),
                _Heard(value, confidence, is_of_hearing, transcript),
            )
        return self._doubt(call, said, transcript, slot, confidence)

    def _joined(self, key: _Key, heard: _Heard) -> float:
        """Remember what was heard, and return the confidence in it and an earlier call together."""
        before = [each for each in self._heard.get(key, ()) if each.repeats(heard)]
        self._heard[key] = [*before, heard]
        by_words = (e.confidence for e in before if e.is_of_hearing or heard.is_of_hearing)
        return 1.0 - (1.0 - max(by_words, default=0.0)) * (1.0 - heard.confidence)
