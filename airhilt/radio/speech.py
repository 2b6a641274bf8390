"""Where sound comes into the radio: what is spoken, and what a receiver gives out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from airhilt.messages import Message, Transcript, Transmission
from airhilt.radio.bus import OnAir
from airhilt.radio.voices.engine import Audio

if TYPE_CHECKING:
    from airhilt.radio.channel import Background


@dataclass(frozen=True, slots=True)
class Reception:
    """What the units' receiver gives out of one transmission."""

    header: Transmission
    pcm: bytes
    """16 kHz mono, 16 bits, little-endian; empty without sound."""
    transcript: Transcript | None = None
    """Its words where there is no sound to recognise them from."""


class Sound(Protocol):
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
        background: Background,
    ) -> Reception:
        """Return a transmission that has ended, as it is received.

        Parameters
        ----------
        heard_over
            The transmissions that it was mixed with. A stuck microphone among them, or the
            transmission itself if it is one, has no speech.
        background
            Where its speaker sits.
        """
        ...


class Publish(Protocol):
    """Publishes a message; ``raw`` is the payload of a key whose message is only the header."""

    def __call__(self, key: str, message: Message, *, raw: bytes | None = None) -> None: ...  # noqa: D102


class Text:
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
        background: Background,  # noqa: ARG002
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
