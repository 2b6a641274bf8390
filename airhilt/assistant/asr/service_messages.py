"""Form and answer of a recogniser at an address.

The form and ``verbose_json`` are those of OpenAI's API (Create transcription, 2024-11) and of the
server of whisper.cpp (``examples/server``), which also give words a probability.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import AliasChoices, BaseModel, ConfigDict, Field, model_validator

from airhilt.messages import Confidence

Seconds = Annotated[float, Field(ge=0.0)]


class TranscriptionForm(BaseModel):
    """Fields of a form (``multipart/form-data``) with one call."""

    file: bytes = Field(description="the call: WAV, 16 kHz, mono, 16 bits")
    model: str
    language: str = "en"
    prompt: str = Field(
        default="", description="callsigns of the roster as Whisper writes them: American 123"
    )
    temperature: float = 0.0
    response_format: Literal["verbose_json", "json"] = "verbose_json"
    timestamp_granularities: Literal["word"] = Field(
        default="word", alias="timestamp_granularities[]"
    )

    def fields(self) -> dict[str, str | bytes]:
        """Return the fields as they are sent."""
        values = self.model_dump(by_alias=True)
        return {
            name: value if isinstance(value, bytes) else str(value)
            for name, value in values.items()
        }


class _Answer(BaseModel):
    model_config = ConfigDict(extra="ignore", allow_inf_nan=False, frozen=True)


class TranscribedWord(_Answer):
    """One word, or a piece of one as whisper.cpp has it: a piece begins without a blank."""

    word: str = Field(validation_alias=AliasChoices("word", "text"))
    start: Seconds | None = Field(default=None, description="in s from the start of the call")
    end: Seconds | None = None
    probability: Confidence | None = Field(
        default=None, validation_alias=AliasChoices("probability", "confidence")
    )

    @model_validator(mode="after")
    def _ends_after_its_start(self) -> Self:
        if self.start is not None and self.end is not None and self.end < self.start:
            raise ValueError(f"the word {self.word!r} ends before it begins")
        return self


class TranscribedSegment(_Answer):
    """A part of the call that was recognised in one piece."""

    text: str
    start: Seconds | None = None
    end: Seconds | None = None
    avg_logprob: Annotated[float, Field(le=0.0)] | None = Field(
        default=None, description="mean of the logarithms of the probabilities of its tokens"
    )
    words: tuple[TranscribedWord, ...] | None = None


class Transcription(_Answer):
    """Answer to a call. Only ``text`` is needed."""

    text: str
    confidence: Confidence | None = Field(
        default=None, description="of the whole; null: that of its words and segments"
    )
    words: tuple[TranscribedWord, ...] | None = None
    segments: tuple[TranscribedSegment, ...] | None = None

    @model_validator(mode="after")
    def _has_words_in_order(self) -> Self:
        starts = [word.start for word in self.all_words() if word.start is not None]
        for before, after in pairwise(starts):
            if after < before:
                raise ValueError(f"a word begins at {after:g} s, after one at {before:g} s")
        return self

    def all_words(self) -> tuple[TranscribedWord, ...]:
        """Return its words, which are in the segments if not beside them."""
        return self.words or tuple(
            word for each in self.segments or () for word in each.words or ()
        )
