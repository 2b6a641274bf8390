"""Instructions that are certain in calls that have not ended yet.

An instruction of a partial transcript is provisional once it is certain in two partial transcripts
in a row. The whole transcript confirms or withdraws it, and so does the next partial one. A call
that corrects itself has no provisional instructions.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

from airhilt.assistant.decision.fusion import PATIENCE_NS
from airhilt.assistant.decision.guard import ConfidenceGuard, call_of
from airhilt.messages import PartialTranscript, Transcript
from airhilt.phraseology import BESIDES, REPORTS, Call, Instruction

WITHDRAWING = frozenset({"cancel", "correction", "disregard", "negative"})
"""Words by which a speaker takes back what was said before (ICAO Annex 10 volume II, 5.2.1.5.8)."""


class _Partial(NamedTuple):
    """A call after its newest partial transcript."""

    call: Call
    heard: Transcript
    """The words heard of it, as a call that ends with them."""
    certain: tuple[Instruction, ...]
    provisional: tuple[Instruction, ...]


class PartialCalls:
    """The calls of which partial transcripts have come, and no whole one yet."""

    def __init__(self, guard: ConfidenceGuard) -> None:
        self._guard = guard
        self._calls: dict[str, _Partial] = {}
        self._ended: set[str] = set()

    def take(self, partial: PartialTranscript, callsigns: Iterable[str]) -> None:
        """Update the instructions of a call with what was heard of it so far."""
        if partial.id in self._ended:
            return
        given = partial.model_dump(exclude={"t_heard_ns", "stable_words"})
        heard = Transcript(t_end_ns=partial.t_heard_ns, **given)
        call = call_of(heard, callsigns)
        certain = self._certain(call, heard)
        before = self._calls.get(partial.id)
        known: tuple[Instruction, ...] = ()
        if before is not None and before.call.callsign == call.callsign:
            known = before.certain
        provisional = tuple(each for each in certain if each in known)
        self._calls[partial.id] = _Partial(call, heard, certain, provisional)

    def end(self, radio_id: str) -> None:
        """Forget a call, because its whole transcript has come."""
        self._calls.pop(radio_id, None)
        self._ended.add(radio_id)

    def provisional(self, t_ns: int) -> list[tuple[Call, Transcript]]:
        """Return the calls with provisional instructions, and what was heard of each.

        They come in the order of their beginnings. The whole transcript of a call may never come;
        its instructions count no more after the longest wait for one.
        """
        return [
            (replace(each.call, instructions=each.provisional), each.heard)
            for each in self._calls.values()
            if each.provisional and t_ns - each.heard.t_end_ns <= PATIENCE_NS
        ]

    def _certain(self, call: Call, heard: Transcript) -> tuple[Instruction, ...]:
        """Return the instructions of a call that are certain as far as it was heard."""
        words = re.findall("[a-z]+", heard.text.lower())
        if call.callsign is None or not WITHDRAWING.isdisjoint(words):
            return ()
        return tuple(
            each
            for each in call.instructions
            if each.action not in REPORTS | BESIDES and self._guard.doubt(call, each, heard) is None
        )
