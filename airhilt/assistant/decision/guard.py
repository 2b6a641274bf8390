"""The guard of the AIRHILT paper's ladder: it finds slots heard with too little confidence.

Each slot of an instruction that the engine acts on has the recogniser's least confidence in its
words. The value of a slot has the parser's confidence too: "descend and maintain five thousand five
hundred ten" may have been heard well, and makes no sense. Below tau_ASR the slot is in doubt: the
engine neither believes nor ignores it, and asks for it (arXiv 2511.18718).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Literal

from airhilt.messages import Transcript
from airhilt.phraseology import TAU_ASR, Call, Instruction, parse_call

Slot = Literal["callsign", "action", "runway", "altitude"]
AMBIGUOUS = 0.5
"""Confidence in a callsign that may be either of two, as in docs/phraseology.md."""


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
    """An instruction, or its readback, of which one slot is in doubt.

    Attributes
    ----------
    callsign
        Callsign that was heard, or the likeliest one.
    is_answered
        True if no readback that may settle it is expected any more.
    """

    callsign: str
    slot: Slot
    confidence: float
    said: Instruction
    transcript: Transcript
    is_answered: bool

    @classmethod
    def of(
        cls, call: Call, said: Instruction, transcript: Transcript, slot: Slot, confidence: float
    ) -> Doubt | None:
        """Return the doubt about a slot of a call; None if the call names no known callsign."""
        callsign = call.match.callsign
        if callsign is None:
            return None
        return cls(callsign, slot, confidence, said, transcript, not call.addressed_first)


def slots(call: Call, said: Instruction) -> dict[Slot, float]:
    """Return the slots of an instruction with their confidences, in the order of questions.

    The last slot is its runway or its level.
    """
    return {
        "callsign": AMBIGUOUS if call.match.ambiguous else call.match.score,
        "action": said.action_heard,
        value_slot(said): _value(said),
    }


def value_slot(said: Instruction) -> Slot:
    """Return the slot of the value of an instruction: its runway, or its level."""
    return "runway" if said.altitude_ft is None else "altitude"


def _value(said: Instruction) -> float:
    """Return the confidence in the runway or the level of an instruction.

    Where neither is named, the confidence is that of the words alone.
    """
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
        for slot, confidence in slots(call, said).items():
            if confidence < self.tau_asr:
                return Doubt.of(call, said, transcript, slot, confidence)
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
