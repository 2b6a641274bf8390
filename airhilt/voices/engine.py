"""What every engine of speech synthesis does."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from airhilt.audio.pcm import Audio


@dataclass(frozen=True, slots=True)
class VoiceSpec:
    """The voice of one speaker."""

    name: str
    """As the engine calls it."""
    rate: float = 1.0
    """Of speaking; 1 is the engine's own."""
    pitch: float = 1.0
    """1 is the engine's own."""


class TtsEngine(Protocol):
    """Speaks a text. The same text and voice give the same samples every time."""

    @property
    def name(self) -> str:
        """Short name, in logs and keys of the cache."""
        ...

    @property
    def version(self) -> str:
        """Changes when the samples may."""
        ...

    def voice_of(self, speaker: str) -> VoiceSpec:
        """Return the voice of a speaker: the same in every run, and unlike other speakers'."""
        ...

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech.

        Raises
        ------
        airhilt.errors.SpeechError
            The engine has failed.
        """
        ...
