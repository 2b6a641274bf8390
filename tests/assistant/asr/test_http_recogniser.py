"""A recogniser at an address, without one: what it is sent, and which answers count."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from airhilt.assistant.asr.engines import http
from airhilt.assistant.asr.engines.http import HttpAsr
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.audio.wav import encode_wav
from airhilt.errors import AirhiltError, SpeechError
from airhilt.host.services import HttpService


class Scripted:
    """Stands for the service: it keeps what it is sent, and always answers the same."""

    parsed = HttpService.parsed

    def __init__(self, answer: Any) -> None:
        self.answer = answer if isinstance(answer, bytes) else json.dumps(answer).encode()
        self.sent: list[bytes] = []

    def __call__(
        self, subject: str, url: str, timeout_s: float, maximum_bytes: int, failure: Any
    ) -> Scripted:
        assert (subject, maximum_bytes, failure) == ("ASR http", 1_000_000, SpeechError)
        return self

    def post(self, body: bytes, content_type: str) -> bytes:
        assert content_type == "audio/wav"
        self.sent.append(body)
        return self.answer

    def error(self, what: str, expected: str) -> AirhiltError:
        return SpeechError(f"{what}; expected {expected}")


def audio(seconds: float) -> Audio:
    return np.full(round(seconds * SAMPLE_RATE_HZ), 0.1, np.float32)


def recognised(
    monkeypatch: pytest.MonkeyPatch, answer: Any, seconds: float = 2.0
) -> tuple[str, tuple[tuple[str, float], ...], float]:
    scripted = Scripted(answer)
    monkeypatch.setattr(http, "HttpService", scripted)
    found = HttpAsr("http://localhost").recognise(audio(seconds), ["AAL123"])
    assert scripted.sent == ([encode_wav(audio(seconds))] if seconds else [])
    return found.text, tuple(found.words), found.confidence


def test_a_text_alone_is_sure_and_has_no_words(monkeypatch: pytest.MonkeyPatch) -> None:
    assert recognised(monkeypatch, {"text": "Climb, flight level 350."}) == (
        "climb flight level 350", (), 1.0,
    )  # fmt: skip
    assert recognised(monkeypatch, {"text": "climb", "confidence": 0.4})[2] == 0.4


def test_words_are_plain_and_keep_their_confidences(monkeypatch: pytest.MonkeyPatch) -> None:
    """The confidence of the whole is the mean of theirs unless it is given."""
    words = [{"text": "Climb,", "confidence": 0.5}, {"text": "Delta", "confidence": 0.9}]
    answer = {"text": "other", "words": words}
    text, found, confidence = recognised(monkeypatch, answer)
    assert (text, found) == ("climb delta", (("climb", 0.5), ("delta", 0.9)))
    assert confidence == pytest.approx(0.7)
    assert recognised(monkeypatch, answer | {"confidence": 0.3})[2] == 0.3


def test_it_is_not_asked_about_no_audio(monkeypatch: pytest.MonkeyPatch) -> None:
    assert recognised(monkeypatch, {"text": "climb"}, 0.0) == ("", (), 1.0)
