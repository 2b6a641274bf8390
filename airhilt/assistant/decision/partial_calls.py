"""Instructions that are certain in calls that have not ended yet.

An instruction of a partial transcript is provisional once it is certain in two partial transcripts
in a row. The whole transcript confirms or withdraws it, and so does the next partial one. A call
that corrects itself has no provisional instructions.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import NamedTuple

from airhilt.assistant.decision.fusion import PATIENCE_NS
from airhilt.assistant.decision.guard import ConfidenceGuard, call_of
from airhilt.messages import PartialTranscript, Transcript
from airhilt.phraseology import BESIDES, REPORTS, Call, Instruction

WITHDRAWING = frozenset({"cancel", "correction", "disregard", "negative"})
"""Words by which a speaker takes back what was said before (ICAO Annex 10 volume II, 5.2.1.5.8)."""


class ProvisionalCall(NamedTuple):
    """The instructions of a call that goes on, and the words heard of it."""

    call: Call
    heard: Transcript


@dataclass(slots=True)
class _Partial:
    """State of a call after its newest partial transcript."""

    certain: tuple[Instruction, ...]
    callsign: str | None
    provisional: ProvisionalCall | None
    t_heard_ns: int


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
        heard = _as_heard(partial)
        call = call_of(heard, callsigns)
        certain = self._certain(call, heard)
        before = self._calls.get(partial.id)
        kept: tuple[Instruction, ...] = ()
        if before is not None and before.callsign == call.callsign:
            kept = tuple(each for each in certain if each in before.certain)
        provisional = ProvisionalCall(replace(call, instructions=kept), heard) if kept else None
        self._calls[partial.id] = _Partial(certain, call.callsign, provisional, partial.t_heard_ns)

    def end(self, radio_id: str) -> None:
        """Forget a call, because its whole transcript has come."""
        self._calls.pop(radio_id, None)
        self._ended.add(radio_id)

    def provisional(self, t_ns: int) -> tuple[ProvisionalCall, ...]:
        """Return the calls with provisional instructions, in the order of their beginnings.

        The whole transcript of a call may never come; its instructions are forgotten after the
        longest wait for one.
        """
        self._calls = {
            name: each
            for name, each in self._calls.items()
            if t_ns - each.t_heard_ns <= PATIENCE_NS
        }
        return tuple(each.provisional for each in self._calls.values() if each.provisional)

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


def _as_heard(partial: PartialTranscript) -> Transcript:
    """Return a partial transcript as one of a call that ends with what was heard."""
    return Transcript(
        t_ns=partial.t_ns,
        id=partial.id,
        frequency_khz=partial.frequency_khz,
        t_tx_ns=partial.t_tx_ns,
        t_end_ns=partial.t_heard_ns,
        text=partial.text,
        words=partial.words,
        confidence=partial.confidence,
        engine=partial.engine,
    )
