"""The protocol of speech synthesis engines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from airhilt.audio.pcm import Audio


@dataclass(frozen=True, slots=True)
class VoiceSpec:
    """The voice of one speaker."""

    name: str
    """Name of the voice in the engine."""
    rate: float = 1.0
    """Rate of speaking; 1 is the engine's own."""
    pitch: float = 1.0
    """Pitch of the voice; 1 is the engine's own."""


@runtime_checkable
class TtsEngine(Protocol):
    """Turns text into speech. The same text and voice give the same samples every time."""

    @property
    def name(self) -> str:
        """Short name, for logs and the cache."""

    @property
    def version(self) -> str:
        """Version; it changes whenever the samples may change."""

    def voice_of(self, speaker: str) -> VoiceSpec:
        """Return the voice of a speaker, the same in every run."""

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech.

        Raises
        ------
        airhilt.errors.SpeechError
            The engine has failed.
        """
