"""Radio backends: how the calls of a run sound, or that they have no sound."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

from airhilt.audio.pcm import Audio
from airhilt.errors import SpeechError
from airhilt.messages import Transcript
from airhilt.sensors.radio.on_air import BackgroundNoise, OnAir


class SoundRequest(NamedTuple):
    """Request for the sound that a receiver gives out of a transmission."""

    on_air: OnAir
    mixed_with: tuple[OnAir, ...]
    """Transmissions that are received at the same time."""
    background: BackgroundNoise
    """Noise around the speaker."""
    begin: int
    """First sample that is asked for. The samples before it have been given out already."""
    now_ns: int
    listener: str | None = None
    """Owner of the receiver; None: it is the one at the units' site."""


class RadioBackend(Protocol):
    """The voices of a run and its receivers."""

    @property
    def has_sound(self) -> bool:
        """True if calls have samples, as far as is known by now."""
        ...

    def speak(self, speaker: str, text: str) -> tuple[Audio | None, float]:
        """Return a text as speech, None without sound, and its duration in s.

        A SpeechError says that the voices have failed.
        """
        ...

    def receive(self, request: SoundRequest) -> bytes:
        """Return what a receiver gives out of a transmission, as far as it can be known, as PCM.

        The result is the whole of a transmission whose speech was known when it began, and the
        part that has been on the air by now of any other. It is 16 kHz, mono, 16 bits,
        little-endian; empty without sound. A SpeechError says that the channel has failed.
        """
        ...

    def transcript(self, on_air: OnAir, mixed_with: tuple[OnAir, ...]) -> Transcript | None:
        """Return the words of a transmission that has ended, if no recogniser is needed."""
        ...


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

    def receive(self, request: SoundRequest) -> bytes:  # noqa: ARG002
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


class FallbackRadio:
    """A radio with sound until its voices or its channel fail, and without sound from then on.

    Calls then take the time of their words and arrive without samples. Their words do not arrive
    either: nobody knows what a recogniser would have made of them. ``lost`` is called once when the
    backend fails, with the cause, and true if that is of the machine. ``failed`` is called with the
    cause when the voices have failed with a text and are asked for it again.
    """

    def __init__(
        self,
        backend: RadioBackend,
        words_per_minute: float,
        lost: Callable[[str, bool], None],
        failed: Callable[[str], None],
    ) -> None:
        self._backend = backend
        self._text = TextRadio(words_per_minute)
        self._lost = lost
        self._failed = failed
        self.is_lost = False

    @property
    def has_sound(self) -> bool:
        """True if the backend has sound and has not failed."""
        return not self.is_lost and self._backend.has_sound

    def speak(self, speaker: str, text: str) -> tuple[Audio | None, float]:
        """Return a text as speech, None without sound, and its duration in s."""
        while not self.is_lost:
            try:
                return self._backend.speak(speaker, text)
            except SpeechError as error:
                if error.is_passing:
                    self._failed(str(error))
                else:
                    self._lose(error)
        return self._text.speak(speaker, text)

    def receive(self, request: SoundRequest) -> bytes:
        """Return what the backend receives; no samples once it has failed."""
        if not self.is_lost:
            try:
                return self._backend.receive(request)
            except SpeechError as error:
                self._lose(error)
        return b""

    def transcript(self, on_air: OnAir, mixed_with: tuple[OnAir, ...]) -> Transcript | None:
        """Return what the backend gives; None once it has failed."""
        return None if self.is_lost else self._backend.transcript(on_air, mixed_with)

    def _lose(self, error: SpeechError) -> None:
        self.is_lost = True
        self._lost(str(error), error.is_of_machine)
