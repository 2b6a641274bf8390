"""A recogniser at an address: it takes WAV and answers ``{text, confidence?, words?}``."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydantic import BaseModel, ConfigDict

from airhilt.assistant.asr.engine import Recognised
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.audio.wav import encode_wav
from airhilt.engines import Engine
from airhilt.errors import SpeechError
from airhilt.host.services import USAGE, HttpService, is_service
from airhilt.messages import Confidence, Word
from airhilt.phraseology.canonical import canonical

TIMEOUT_S = 30.0
MAXIMUM_BYTES = 1_000_000
"""Size of the largest answer."""
WORDS_PER_S = 10.0
"""Largest number of words in a second of audio, and as many more in all: twice fast speech."""
LETTERS_PER_WORD = 20
"""Largest number of letters of a text for each word that it may have."""


class _Answer(BaseModel):
    model_config = ConfigDict(allow_inf_nan=False)
    text: str
    confidence: Confidence | None = None
    words: tuple[Word, ...] = ()


class HttpAsr:
    """Asks a service that answers POST requests with 16 kHz, mono, 16-bit WAV.

    Its ``words``, if it has any, are ``{text, confidence}`` each. Without ``confidence`` it is
    the mean of theirs, and without words it is 1.
    """

    name = "http"

    def __init__(self, url: str, timeout_s: float = TIMEOUT_S) -> None:
        self._service = HttpService("ASR http", url, timeout_s, MAXIMUM_BYTES, SpeechError)

    def recognise(self, audio: Audio, callsigns: Sequence[str]) -> Recognised:  # noqa: ARG002
        """Return what the service makes of the audio; it is not asked about empty audio."""
        if not audio.size:
            return Recognised("", (), 1.0)
        data = self._service.post(encode_wav(audio), "audio/wav")
        expected = 'JSON such as {"text": "...", "confidence": 0.9}'
        answer = self._service.parsed(data, _Answer, expected)
        self._require_sayable(answer, len(audio) / SAMPLE_RATE_HZ)
        given = [(word.text, word.confidence) for word in answer.words]
        words = canonical(given or [(answer.text, 1.0)])
        confidence = answer.confidence
        if confidence is None:
            confidence = float(np.mean([each for _, each in words])) if words else 1.0
        text = " ".join(word for word, _ in words)
        return Recognised(text, words if given else (), confidence)

    def _require_sayable(self, answer: _Answer, duration_s: float) -> None:
        most = int(WORDS_PER_S * (1.0 + duration_s))
        for text in (answer.text, " ".join(word.text for word in answer.words)):
            count = len(text.split())
            if count > most or len(text) > most * LETTERS_PER_WORD:
                raise self._service.error(
                    f"answered {count} words ({len(text)} letters) to {duration_s:.1f} s of audio",
                    f"at most {most} words, more than anybody says in that time",
                )


ENGINE = Engine(
    name="http",
    summary="service that takes WAV and answers JSON",
    create=HttpAsr,
    takes=is_service,
    usage=USAGE,
    is_remote=True,
)
