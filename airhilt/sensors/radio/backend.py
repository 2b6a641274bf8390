"""Where sound comes into the radio: what is spoken, and what a receiver gives out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from airhilt.errors import SpeechError
from airhilt.messages import Message, Transcript, Transmission
from airhilt.sensors.radio.frequency_arbiter import OnAir
from airhilt.voices.engine import Audio

if TYPE_CHECKING:
    from airhilt.sensors.radio.channel import BackgroundNoise


@dataclass(frozen=True, slots=True)
class Reception:
    """What the units' receiver gives out of one transmission."""

    header: Transmission
    pcm: bytes
    """16 kHz mono, 16 bits, little-endian; empty without sound."""
    transcript: Transcript | None = None
    """Its words where there is no sound to recognise them from."""


class RadioBackend(Protocol):
    """The voices of a run and its receiver."""

    def speak(self, speaker: str, text: str) -> tuple[Audio | None, float]:
        """Return a text as speech, None without sound, and how long it takes in seconds.

        Raises
        ------
        airhilt.errors.SpeechError
            The voices have failed.
        """
        ...

    def receive(
        self,
        on_air: OnAir,
        heard_over: tuple[OnAir, ...],
        snr_db: float | None,
        background: BackgroundNoise,
    ) -> Reception:
        """Return a transmission that has ended, as it is received.

        Parameters
        ----------
        heard_over
            The transmissions that it was mixed with. A stuck microphone among them, or the
            transmission itself if it is one, has no speech.
        background
            Where its speaker sits.

        Raises
        ------
        airhilt.errors.SpeechError
            The channel has failed.
        """
        ...


class Publish(Protocol):
    """Publishes a message; ``raw`` is the payload of a key whose message is only the header."""

    def __call__(self, key: str, message: Message, *, raw: bytes | None = None) -> None: ...  # noqa: D102


class TextRadio:
    """A radio without sound: calls take the time of their words, and arrive as text.

    What was blocked arrives as nothing.
    """

    def __init__(self, words_per_minute: float) -> None:
        self._seconds_per_word = 60.0 / words_per_minute

    def speak(self, speaker: str, text: str) -> tuple[None, float]:  # noqa: ARG002
        """Return how long the words take."""
        return None, len(text.split()) * self._seconds_per_word

    def receive(
        self,
        on_air: OnAir,
        heard_over: tuple[OnAir, ...],
        snr_db: float | None,
        background: BackgroundNoise,  # noqa: ARG002
    ) -> Reception:
        """Return the transmission without sound, and its words as a transcript at once."""
        said = on_air.utterance
        end_ns = on_air.t_end_ns
        times = {"t_ns": end_ns, "t_tx_ns": on_air.t_tx_ns, "t_end_ns": end_ns}
        identity = {"id": said.id, "frequency_khz": said.frequency_khz}
        header = Transmission(**times, **identity, snr_db=snr_db)
        if heard_over or on_air.is_carrier:
            return Reception(header, b"")
        transcript = Transcript(**times, **identity, text=said.text, confidence=1.0, engine="text")
        return Reception(header, b"", transcript)


class FallbackRadio:
    """A radio with sound until its voices or its channel fail, and without from then on.

    Calls then take the time of their words and arrive without samples. Nor do their words arrive:
    nobody can tell what a recogniser would have made of them.

    Parameters
    ----------
    sound
        While it lasts.
    words_per_minute
        Of calls without it.
    lost
        Called once with the cause when it fails.
    """

    def __init__(
        self, sound: RadioBackend, words_per_minute: float, lost: Callable[[str], None]
    ) -> None:
        self._backend = sound
        self._text = TextRadio(words_per_minute)
        self._lost = lost
        self.is_lost = False

    def speak(self, speaker: str, text: str) -> tuple[Audio | None, float]:
        """Return a text as speech, None without sound, and how long it takes."""
        if not self.is_lost:
            try:
                return self._backend.speak(speaker, text)
            except SpeechError as error:
                self._lose(error)
        return self._text.speak(speaker, text)

    def receive(
        self,
        on_air: OnAir,
        heard_over: tuple[OnAir, ...],
        snr_db: float | None,
        background: BackgroundNoise,
    ) -> Reception:
        """Return the transmission with the sound that it has."""
        if not self.is_lost:
            try:
                return self._backend.receive(on_air, heard_over, snr_db, background)
            except SpeechError as error:
                self._lose(error)
        return Reception(self._text.receive(on_air, heard_over, snr_db, background).header, b"")

    def _lose(self, error: SpeechError) -> None:
        self.is_lost = True
        self._lost(str(error))
