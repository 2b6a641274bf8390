"""The protocol of speech enhancers."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from airhilt.audio.pcm import Audio


@runtime_checkable
class Enhancer(Protocol):
    """Reduces the noise in the audio of one transmission."""

    @property
    def name(self) -> str:
        """Short name, in messages and tables."""

    def enhance(self, audio: Audio) -> Audio:
        """Return the audio with less noise, of the same length, 16 kHz.

        Raises
        ------
        airhilt.errors.SpeechError
            The engine has failed.
        """
