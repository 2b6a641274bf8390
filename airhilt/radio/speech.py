"""Where sound comes into the radio: what is spoken, and what a receiver gives out."""

from __future__ import annotations

from typing import Protocol

from airhilt.messages import Message, Transcript, Transmission
from airhilt.radio.bus import OnAir
from airhilt.radio.voices.engine import Audio


class Sound(Protocol):
    """The voices of a run and its receiver."""

    def speak(self, speaker: str, text: str) -> tuple[Audio | None, float]:
        """Return a text as speech, None without sound, and how long it takes in seconds."""
        ...

    def receive(self, on_air: OnAir, heard_over: tuple[OnAir, ...], snr_db: float | None) -> None:
        """Publish a transmission that has ended, as the units' receiver gives it out.

        Parameters
        ----------
        heard_over
            The transmissions that it was mixed with. A stuck microphone among them, or the
            transmission itself if it is one, has no speech.
        """
        ...


class Publish(Protocol):
    """Publishes a message; ``raw`` is the payload of a key whose message is only the header."""

    def __call__(self, key: str, message: Message, *, raw: bytes | None = None) -> None: ...  # noqa: D102


class Text:
    """A radio without sound: calls take the time of their words, and arrive as text.

    What was blocked arrives as nothing.
    """

    def __init__(self, words_per_minute: float, publish: Publish) -> None:
        self._seconds_per_word = 60.0 / words_per_minute
        self._publish = publish

    def speak(self, speaker: str, text: str) -> tuple[None, float]:  # noqa: ARG002
        """Return how long the words take."""
        return None, len(text.split()) * self._seconds_per_word

    def receive(self, on_air: OnAir, heard_over: tuple[OnAir, ...], snr_db: float | None) -> None:
        """Publish the transmission without sound, and its words as a transcript at once."""
        said = on_air.utterance
        end_ns = on_air.t_end_ns
        times = {"t_ns": end_ns, "t_tx_ns": on_air.t_tx_ns, "t_end_ns": end_ns}
        identity = {"id": said.id, "frequency_khz": said.frequency_khz}
        self._publish(
            f"radio/{said.frequency_khz}/tx",
            Transmission(**times, **identity, snr_db=snr_db),
            raw=b"",
        )
        if not heard_over and not on_air.is_carrier:
            self._publish(
                f"asr/{said.frequency_khz}",
                Transcript(**times, **identity, text=said.text, confidence=1.0, engine="text"),
            )
