"""A radio that goes on without sound when its voices or its channel fail."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from airhilt.audio.pcm import Audio
from airhilt.errors import SpeechError
from airhilt.messages import Transcript
from airhilt.sensors.radio.backends.base import RadioBackend
from airhilt.sensors.radio.backends.text import TextRadio
from airhilt.sensors.radio.on_air import OnAir

if TYPE_CHECKING:
    from airhilt.sensors.radio.channel import BackgroundNoise


class FallbackRadio:
    """A radio with sound until its voices or its channel fail, and without sound from then on.

    Calls then take the time of their words and arrive without samples. Their words do not arrive
    either: nobody knows what a recogniser would have made of them.

    Parameters
    ----------
    backend
        Radio that is used until it fails.
    words_per_minute
        Rate of speaking without sound.
    lost
        Called once when the backend fails, with the cause, and true if that is of the machine.
    """

    def __init__(
        self, backend: RadioBackend, words_per_minute: float, lost: Callable[[str, bool], None]
    ) -> None:
        self._backend = backend
        self._text = TextRadio(words_per_minute)
        self._lost = lost
        self.is_lost = False

    @property
    def has_sound(self) -> bool:
        """True if the backend has sound and has not failed."""
        return not self.is_lost and self._backend.has_sound

    def speak(self, speaker: str, text: str) -> tuple[Audio | None, float]:
        """Return a text as speech, None without sound, and its duration in s."""
        if not self.is_lost:
            try:
                return self._backend.speak(speaker, text)
            except SpeechError as error:
                self._lose(error)
        return self._text.speak(speaker, text)

    def receive(
        self,
        on_air: OnAir,
        mixed_with: tuple[OnAir, ...],
        background: BackgroundNoise,
        begin: int,
        now_ns: int,
        listener: str | None = None,
    ) -> bytes:
        """Return what the backend receives; no samples once it has failed."""
        if not self.is_lost:
            try:
                return self._backend.receive(
                    on_air, mixed_with, background, begin, now_ns, listener
                )
            except SpeechError as error:
                self._lose(error)
        return b""

    def transcript(self, on_air: OnAir, mixed_with: tuple[OnAir, ...]) -> Transcript | None:
        """Return what the backend gives; None once it has failed."""
        return None if self.is_lost else self._backend.transcript(on_air, mixed_with)

    def _lose(self, error: SpeechError) -> None:
        self.is_lost = True
        self._lost(str(error), error.is_of_machine)
