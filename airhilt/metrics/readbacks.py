"""Readbacks that change what was said, by and to the people at seats."""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

from airhilt.messages import Message, SpokenTruth, Transcript
from airhilt.phraseology import parse_call
from airhilt.phraseology.call import Call, Instruction
from airhilt.phraseology.readbacks import differences

ANSWERED_WITHIN_NS = 30_000_000_000
"""Time after a call in which another one may be its answer, in ns: an assumption."""


class ReadbackError(NamedTuple):
    """A readback that differs from the instruction that it answers."""

    giver: str
    reader: str


class _Given(NamedTuple):
    giver: str
    instructions: tuple[Instruction, ...]
    t_end_ns: int


class Readbacks:
    """Compares each readback with the last instruction to its speaker on the frequency.

    What somebody spoke into a microphone is known as it was recognised.
    """

    def __init__(self, callsigns: Collection[str]) -> None:
        self._callsigns = tuple(callsigns)
        self._given: dict[tuple[int, str], _Given] = {}
        """Last instruction by frequency and callsign."""
        self._unrecognised: dict[str, SpokenTruth] = {}

    def take(self, message: Message) -> ReadbackError | None:
        """Receive a message; return the error of a readback that has one."""
        match message:
            case SpokenTruth(blocked_by=blocked) if blocked:
                return None
            case SpokenTruth(is_from_microphone=True, id=name):
                self._unrecognised[name] = message
            case SpokenTruth(text=text):
                return self._said(message, text)
            case Transcript(id=name, text=text) if name in self._unrecognised:
                return self._said(self._unrecognised.pop(name), text)
        return None

    def _said(self, call: SpokenTruth, text: str) -> ReadbackError | None:
        meant = parse_call(text, self._callsigns)
        if not meant.instructions:
            return None
        if call.speaker not in self._callsigns:
            callsign = call.addressed or meant.callsign
            if callsign is not None:
                given = _Given(call.speaker, meant.instructions, call.t_end_ns)
                self._given[call.frequency_khz, callsign] = given
            return None
        return self._read_back(call, meant)

    def _read_back(self, call: SpokenTruth, meant: Call) -> ReadbackError | None:
        given = self._given.pop((call.frequency_khz, call.speaker), None)
        if given is None or call.t_tx_ns - given.t_end_ns > ANSWERED_WITHIN_NS:
            return None
        for read in meant.instructions:
            told = [one for one in given.instructions if one.action == read.action]
            if told and all(differences(one, read) for one in told):
                return ReadbackError(given.giver, call.speaker)
        return None
