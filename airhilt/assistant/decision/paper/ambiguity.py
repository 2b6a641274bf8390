"""Calls that name a callsign which may be one of several on the frequency."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from airhilt.assistant.decision.clearances import DISCREPANCY_NS, LIFETIME_S, RESTRICTING
from airhilt.messages import Transcript
from airhilt.phraseology import Call, Instruction


class AmbiguousCall(NamedTuple):
    """An instruction about a runway whose addressee may be one of several.

    Attributes
    ----------
    id
        Id of the transmission.
    callsigns
        Callsigns that may be meant.
    """

    id: str
    callsigns: tuple[str, ...]
    said: Instruction
    t_end_ns: int


class AmbiguousCalls:
    """The calls of which it is not clear whom they are for, until somebody is named in one."""

    def __init__(self) -> None:
        self._open: list[AmbiguousCall] = []

    def take(self, call: Call, transcript: Transcript) -> None:
        """Note a call that may be for several; one that names one of them settles it."""
        if call.callsign is not None:
            self._open = [each for each in self._open if call.callsign not in each.callsigns]
        if not call.match.ambiguous:
            return
        callsigns = tuple(each.callsign for each in call.match.candidates)
        for said in call.instructions:
            if said.action in LIFETIME_S or said.action in RESTRICTING:
                self._open.append(
                    AmbiguousCall(transcript.id, callsigns, said, transcript.t_end_ns)
                )
                return

    def open(self, t_ns: int) -> Iterator[AmbiguousCall]:
        """Yield the calls that nobody has settled."""
        for call in self._open:
            if t_ns - call.t_end_ns <= DISCREPANCY_NS:
                yield call
