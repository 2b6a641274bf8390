"""A radio without sound: calls arrive as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from airhilt.messages import Transcript
from airhilt.sensors.radio.on_air import OnAir

if TYPE_CHECKING:
    from airhilt.sensors.radio.channel import BackgroundNoise


class TextRadio:
    """A radio without sound: a call takes the time of its words, and arrives as text.

    The text of a blocked call does not arrive.
    """

    has_sound = False

    def __init__(self, words_per_minute: float) -> None:
        self._seconds_per_word = 60.0 / words_per_minute

    def speak(self, speaker: str, text: str) -> tuple[None, float]:  # noqa: ARG002
        """Return no speech, and the time in s that the words take."""
        return None, len(text.split()) * self._seconds_per_word

    def receive(
        self,
        on_air: OnAir,  # noqa: ARG002
        mixed_with: tuple[OnAir, ...],  # noqa: ARG002
        background: BackgroundNoise,  # noqa: ARG002
        begin: int,  # noqa: ARG002
        now_ns: int,  # noqa: ARG002
        listener: str | None = None,  # noqa: ARG002
    ) -> bytes:
        """Return no samples."""
        return b""

    def transcript(self, on_air: OnAir, mixed_with: tuple[OnAir, ...]) -> Transcript | None:
        """Return the words of a transmission; None if it was blocked or has no words."""
        said = on_air.utterance
        if mixed_with or not said.text:
            return None
        return Transcript(
            t_ns=on_air.t_end_ns,
            id=said.id,
            frequency_khz=said.frequency_khz,
            t_tx_ns=on_air.t_tx_ns,
            t_end_ns=on_air.t_end_ns,
            text=said.text,
            confidence=1.0,
            engine="text",
        )
