"""The protocol of a radio backend: the voices of a run, and its receivers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from airhilt.audio.pcm import Audio
from airhilt.messages import Transcript
from airhilt.sensors.radio.on_air import OnAir

if TYPE_CHECKING:
    from airhilt.sensors.radio.channel import BackgroundNoise


class RadioBackend(Protocol):
    """The voices of a run and its receivers."""

    @property
    def has_sound(self) -> bool:
        """True if calls have samples, as far as is known by now."""
        ...

    def speak(self, speaker: str, text: str) -> tuple[Audio | None, float]:
        """Return a text as speech, None without sound, and its duration in s.

        Raises
        ------
        airhilt.errors.SpeechError
            The voices have failed.
        """
        ...

    def receive(
        self,
        on_air: OnAir,
        mixed_with: tuple[OnAir, ...],
        background: BackgroundNoise,
        begin: int,
        now_ns: int,
        listener: str | None = None,
    ) -> bytes:
        """Return what a receiver gives out of a transmission, as far as it can be known.

        The result is the whole of a transmission whose speech was known when it began, and the
        part that has been on the air by now of any other.

        Parameters
        ----------
        mixed_with
            Transmissions that are received at the same time.
        background
            Noise around the speaker.
        begin
            First sample that is asked for. The samples before it have been given out already.
        listener
            Owner of the receiver; None: it is the one at the units' site.

        Returns
        -------
        bytes
            PCM, 16 kHz, mono, 16 bits, little-endian; empty without sound.

        Raises
        ------
        airhilt.errors.SpeechError
            The channel has failed.
        """
        ...

    def transcript(self, on_air: OnAir, mixed_with: tuple[OnAir, ...]) -> Transcript | None:
        """Return the words of a transmission that has ended, if no recogniser is needed."""
        ...
