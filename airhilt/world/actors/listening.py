"""A listener's understanding of a call: whether it is addressed, and what it commands."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from airhilt.phraseology import TAU_ASR, Call, Instruction, agree, parse_call
from airhilt.phraseology.call import STOPS
from airhilt.world.actors.orders import Order, orders_of

WORDLESS = Call()
TAU_SAID = 0.7
"""Confidence below which an instruction lacks something or makes no sense, although every word of
it was heard: a number of one digit may not be part of another one then."""


@dataclass(frozen=True, slots=True)
class Understanding:
    """Understanding of a call by one listener."""

    kind: Literal["as_said", "otherwise", "unclear", "not_for_me"]
    call: Call = WORDLESS
    """Call as it was heard; empty where nothing of it was."""


@dataclass(frozen=True, slots=True)
class Listener:
    """Understands calls, with the callsigns that are on a frequency."""

    callsigns: tuple[str, ...]
    variation_deg: float = 0.0
    """Magnetic variation of the headings that are said, in degrees, positive east."""

    def parse(self, text: str, word_confidences: Sequence[float] | None = None) -> Call:
        """Return the meaning of a call."""
        return parse_call(text, self.callsigns, word_confidences)

    def orders_of(
        self, instructions: Iterable[Instruction], bound_runway: str | None, callsign: str
    ) -> tuple[Order, ...]:
        """Return the orders that instructions give, one for each, as of `orders.orders_of`."""
        return orders_of(instructions, bound_runway, self.variation_deg, callsign)

    def understand(
        self,
        heard: str,
        said: str,
        known_by: tuple[str, ...],
        word_confidences: Sequence[float] | None = None,
    ) -> Understanding:
        """Return the understanding of a call by its addressee.

        A listener by ear who heard the words that were said is certain of them. A reader of a
        transcript does not know what was said, and goes by the confidence of each word.

        The callsigns ``known_by``, its own or the caller's, show the listener that the call is
        addressed; without any it takes it as addressed.
        """
        is_the_same = words(heard) == words(said)
        if is_the_same and word_confidences is None:
            return self.as_said(said)
        taken = self.parse(heard, word_confidences)
        doubt = self._is_not_for(taken, known_by)
        if doubt == "not_for_me" and not is_the_same:
            return Understanding(doubt, taken)
        meant = self.parse(said)
        if _leaves_open(taken):
            return Understanding("unclear", taken)
        is_in_doubt = doubt == "unclear" or taken.confidence < TAU_ASR
        if is_in_doubt and (_wants_something(taken) or _wants_something(meant)):
            return Understanding("unclear", taken)
        if is_the_same or mean_the_same(taken.instructions, meant.instructions):
            return Understanding("as_said", taken)
        if not taken.instructions:
            return Understanding("unclear", taken)
        return Understanding("otherwise", taken)

    def as_said(self, said: str) -> Understanding:
        """Return the understanding of a call by who has heard every word of it."""
        taken = self.parse(said)
        return Understanding("unclear" if _leaves_open(taken) else "as_said", taken)

    def overhear(
        self,
        heard: str,
        said: str,
        callsign: str,
        word_confidences: Sequence[float] | None = None,
    ) -> Understanding:
        """Return the understanding of a call by somebody else than its addressee."""
        if words(heard) == words(said):
            return Understanding("not_for_me")
        taken = self.parse(heard, word_confidences)
        is_mine = self._is_not_for(taken, (callsign,)) is None and taken.kind in (
            "instruction",
            "correction",
        )
        if not is_mine or not taken.instructions or taken.confidence < TAU_ASR:
            return Understanding("not_for_me", taken)
        return Understanding("otherwise", taken)

    def differs(self, read_back: str, said: str) -> bool:
        """Return whether a readback contradicts the call; a shorter readback does not."""
        meant = self.parse(said).instructions
        return not all(
            any(agree(instruction, other) for other in meant)
            for instruction in self.parse(read_back).instructions
        )

    @staticmethod
    def _is_not_for(
        taken: Call, known_by: tuple[str, ...]
    ) -> Literal["unclear", "not_for_me"] | None:
        """Return why a call may not be for a listener with these callsigns; None if it is."""
        match = taken.match
        if match.ambiguous and any(one.callsign in known_by for one in match.candidates):
            return "unclear"
        return None if not known_by or taken.callsign in known_by else "not_for_me"


def _wants_something(call: Call) -> bool:
    """Return whether a call instructs or asks, so that its words matter."""
    return bool(call.instructions or call.asked) or call.kind in (
        "request", "say_again", "disregard", "radio_check", "question",
    )  # fmt: skip


def _leaves_open(call: Call) -> bool:
    """Return whether the words of an order leave open what is to be done.

    What stops somebody is done all the same.
    """
    if not call.addressed_first or any(each.action in STOPS for each in call.instructions):
        return False
    is_instruction = call.kind in ("instruction", "correction", "disregard")
    least = min((each.confidence for each in call.instructions), default=1.0)
    return call.unread or (is_instruction and least < TAU_SAID)


def mean_the_same(heard: Sequence[Instruction], said: Sequence[Instruction]) -> bool:
    """Return whether instructions mean the same, however their conditions are worded."""
    return len(heard) == len(said) and all(
        agree(one, other) and _numbers(one) == _numbers(other)
        for one, other in zip(heard, said, strict=True)
    )


def _numbers(instruction: Instruction) -> tuple[float | None, ...]:
    return (
        instruction.altitude_ft,
        instruction.heading_deg,
        instruction.speed_kt,
        instruction.mach,
        instruction.rate_fpm,
        instruction.turn_deg,
        instruction.frequency_khz,
    )


def words(text: str) -> list[str]:
    """Return the words of a call without case and punctuation."""
    return re.findall(r"[a-z0-9]+", text.lower())
