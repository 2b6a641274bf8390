"""The calls that people speak: their words are known once a recogniser has found them."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from airhilt.messages import Transcript
from airhilt.phraseology import TAU_ASR
from airhilt.sensors.radio.on_air import OnAir, Utterance
from airhilt.sensors.radio.person_calls import PersonCalls
from airhilt.sensors.radio.radio_call import RadioCall
from airhilt.sensors.radio.transmissions import EndedTransmission


class RecognisedCall(NamedTuple):
    """A call that a person spoke, as it was recognised."""

    call: RadioCall
    said: Utterance
    on_air: OnAir
    is_clear: bool
    """True if its words are certain."""


class SpokenCalls:
    """Waits for the words of the calls that people speak.

    Automata know of such a call what the recogniser under test gives. Below `TAU_ASR`, without
    words, or without a callsign in the call of a unit, they are not sure of it.
    """

    def __init__(self, calls: PersonCalls) -> None:
        self._calls = calls
        self._waiting: dict[str, OnAir] = {}
        """Transmissions whose words are not known yet, by id."""

    def ended(self, ended: EndedTransmission) -> None:
        """Wait for the words of a transmission; nobody understands one that was blocked."""
        if not ended.is_blocked:
            self._waiting[ended.on_air.utterance.id] = ended.on_air

    def recognised(self, transcript: Transcript) -> RecognisedCall | None:
        """Return the call of a transcript, the first time that its words come."""
        on_air = self._waiting.pop(transcript.id, None)
        if on_air is None:
            return None
        said = on_air.utterance
        speaker, frequency_khz = said.speaker, said.frequency_khz
        confidences = tuple(word.confidence for word in transcript.words) or None
        meant = self._calls.meant(frequency_khz, transcript.text, confidences)
        is_clear = meant.confidence >= TAU_ASR and self._calls.addresses(speaker, meant)
        if is_clear:
            call = self._calls.make(speaker, frequency_khz, transcript.text)
        else:
            call = self._calls.unclear(speaker, frequency_khz, transcript.text)
        words = replace(said, text=transcript.text, addressed=call.addressed)
        return RecognisedCall(call, words, on_air, is_clear)
