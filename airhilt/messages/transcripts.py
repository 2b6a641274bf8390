"""Messages of speech recognisers: what was said on a frequency."""

from __future__ import annotations

from pydantic import Field

from airhilt.messages.base import Confidence, Limit, Message, Nanoseconds, Part


class Word(Part):
    """Word of a transcript."""

    text: str
    confidence: Confidence


class Transcript(Message):
    """``asr/<freq_khz>``: the words of one transmission; ``t_ns`` is the paper's t_asr."""

    limit = Limit(size_bytes=32_000, rate_hz=20)
    id: str = Field(description="id of the transmission")
    frequency_khz: int
    t_tx_ns: Nanoseconds
    t_end_ns: Nanoseconds
    text: str
    words: tuple[Word, ...] = Field(
        default=(), description="the words of `text` one by one; empty if the engine has none"
    )
    confidence: Confidence
    engine: str
    speaker: str | None = Field(
        default=None,
        description="who spoke, as far as a receiver can know: the unit whose transmitter was "
        "keyed, or the callsign in the words of what came over the air; null if that is not known",
    )
    addressee: str | None = Field(
        default=None,
        description="whom the call is for: the callsign that a unit calls, or the controller for "
        "what came over the air; null if that is not known",
    )
    overheard: bool | None = Field(
        default=None,
        description="neither by nor for the controller of the briefing, nor the assistant's own "
        "voice; null if that is not known",
    )


class PartialTranscript(Message):
    """``asr/<freq_khz>/partial``: the words of a transmission so far, while it lasts.

    It is published for each 0.5 s of audio, if the run asks for it. The `Transcript` of the whole
    transmission replaces it.
    """

    limit = Limit(size_bytes=32_000, rate_hz=100)
    id: str = Field(description="id of the transmission")
    frequency_khz: int
    t_tx_ns: Nanoseconds
    t_heard_ns: Nanoseconds = Field(description="end of the audio that the words are of")
    text: str
    words: tuple[Word, ...] = Field(
        default=(), description="the words of `text` one by one; empty if the engine has none"
    )
    confidence: Confidence
    stable_words: int = Field(
        ge=0,
        description="number of words of `text`, from the first, that the partial transcript before "
        "has too; the others may change, because little audio follows them",
    )
    engine: str
