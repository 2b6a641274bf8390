"""A recogniser at an address: what it is sent, and which answers count."""

from __future__ import annotations

import json
import math
import re
from http.server import BaseHTTPRequestHandler
from typing import Any

import numpy as np
import pytest

from airhilt.assistant.asr.engine import Call, Recognised
from airhilt.assistant.asr.engines.http import HttpAsr
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.audio.wav import encode_wav
from airhilt.errors import SpeechError
from airhilt.host.forms import decoded_form
from services import answering, service

CALL = Call("c/1", 118_300, 2_500_000_000, None, ("AAL123", "N12, Ü"))
OPENAI, WHISPER_CPP, OWN = "v1/audio/transcriptions", "inference", "recognise"


class Asked:
    """Answers always the same, and keeps what it was asked."""

    def __init__(self, answer: Any, status: int = 200) -> None:
        self.data = answer if isinstance(answer, bytes) else json.dumps(answer).encode()
        self.status = status
        self.bodies: list[bytes] = []
        self.headers: list[dict[str, str]] = []

    def __call__(self, handler: BaseHTTPRequestHandler, body: bytes) -> None:
        self.bodies.append(body)
        self.headers.append(dict(handler.headers))
        answering(self.data, self.status)(handler, body)

    @property
    def form(self) -> dict[str, bytes]:
        return decoded_form(self.bodies[-1], self.headers[-1]["Content-Type"])


def audio(seconds: float = 2.0) -> Audio:
    return np.full(round(seconds * SAMPLE_RATE_HZ), 0.1, np.float32)


def hear(asked: Asked, path: str = OPENAI, seconds: float = 2.0) -> Recognised:
    with service(asked) as url:
        return HttpAsr(url.replace("service", path)).recognise_call(audio(seconds), CALL)


def words(*given: tuple[Any, ...]) -> list[dict[str, Any]]:
    names = ("word", "start", "end", "probability")
    return [dict(zip(names, each, strict=False)) for each in given]


def test_a_form_has_the_call_and_the_callsigns_as_whisper_writes_them() -> None:
    for path in (OPENAI, WHISPER_CPP):
        asked = Asked({"text": "climb"})
        hear(asked, f"{path}#large-v3")
        assert asked.form == {
            "file": encode_wav(audio()), "model": b"large-v3", "language": b"en",
            "prompt": "American 123, N12, Ü".encode(), "temperature": b"0.0",
            "response_format": b"verbose_json", "timestamp_granularities[]": b"word",
        }  # fmt: skip


def test_any_other_path_is_given_the_call_alone() -> None:
    asked = Asked({"text": "climb"})
    hear(asked, OWN)
    assert asked.bodies == [encode_wav(audio())]
    assert asked.headers[0]["Content-Type"] == "audio/wav"


@pytest.mark.parametrize("path", [OPENAI, WHISPER_CPP, OWN])
def test_headers_say_which_call_it_is(path: str) -> None:
    asked = Asked({"text": "climb"})
    hear(asked, path)
    told = {name: text for name, text in asked.headers[0].items() if name.startswith("X-")}
    assert told == {
        "X-Ts-Ms": "2500", "X-Turn-Id": "c/1", "X-Frequency-Khz": "118300",
        "X-Callsigns": "AAL123,N12%2C %C3%9C",
    }  # fmt: skip


def test_the_key_of_the_environment_is_sent_and_never_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("AIRHILT_ASR_KEY", "sk-secret")
    asked = Asked({"error": {"message": "no credit for sk-secret"}}, 429)
    with pytest.raises(SpeechError, match=r"HTTP status 429: 'no credit for \*\*\*'"):
        hear(asked)
    assert asked.headers[0]["Authorization"] == "Bearer sk-secret"


def test_words_are_in_the_form_of_transcripts_and_keep_their_confidences() -> None:
    answer = {"text": "Run way 1L.", "words": words(("Run", 0, 0.2, 0.9), ("way", 0.2, 0.4, 0.8),
                                                    ("1L.", 0.5, 0.9, 0.7))}  # fmt: skip
    heard = hear(Asked(answer))
    assert heard.words == (("runway", 0.8), ("one", 0.7), ("left", 0.7))
    assert heard.text == "runway one left"
    assert heard.confidence == pytest.approx((0.8 + 0.7 + 0.7) / 3)
    assert hear(Asked(answer | {"confidence": 0.3})).confidence == 0.3


def test_the_words_of_todays_raw_form_are_taken_too() -> None:
    answer = {"text": "other", "words": [{"text": "climb", "confidence": 0.5}]}
    assert hear(Asked(answer), OWN).words == (("climb", 0.5),)


def test_pieces_of_whisper_cpp_are_joined_to_words() -> None:
    pieces = words((" Cle", 0, 0.1, 0.9), ("ared", 0.1, 0.3, 0.6), (" to", 0.3, 0.4, 0.8))
    answer = {"text": " Cleared to", "segments": [{"text": " Cleared to", "words": pieces}]}
    heard = hear(Asked(answer), WHISPER_CPP)
    assert heard.words == (("cleared", 0.6), ("to", 0.8))


def test_words_without_a_probability_are_as_sure_as_their_segment() -> None:
    segments = [
        {"text": "climb", "start": 0.0, "end": 1.0, "avg_logprob": math.log(0.9)},
        {"text": "now", "start": 1.1, "end": 2.0, "avg_logprob": math.log(0.4)},
    ]
    answer = {"text": "climb now", "segments": segments,
              "words": words(("climb", 0.1, 0.6), ("now", 1.2, 1.5))}  # fmt: skip
    heard = hear(Asked(answer))
    assert [(word, round(sure, 6)) for word, sure in heard.words] == [("climb", 0.9), ("now", 0.4)]
    assert heard.confidence == pytest.approx(0.4), "as sure as the least sure segment"


def test_what_a_service_does_not_tell_is_sure() -> None:
    assert hear(Asked({"text": "Climb, flight level 350."})) == Recognised(
        "climb flight level 350", (), 1.0
    )
    none = {"text": "", "words": None, "segments": None, "confidence": None}
    assert hear(Asked(none)) == Recognised("", (), 1.0)


def test_a_byte_order_mark_does_no_harm() -> None:
    assert hear(Asked(b'\xef\xbb\xbf{"text": "climb"}')).text == "climb"


@pytest.mark.parametrize(
    ("answer", "problem"),
    [
        (None, "Input should be an object"),
        ({"text": None}, "text: Input should be a valid string"),
        ({"text": "a", "words": words(("a", 0, 1, 1.5))}, "words/0/"),
        ({"text": "a", "words": words(("a", 0, 1, math.nan))}, "words/0/"),
        ({"text": "a", "words": words(("a", -1, 1, 0.5))}, "words/0/start"),
        ({"text": "a", "words": words(("a", 1, 0.5, 0.5))}, "'a' ends before it begins"),
        ({"text": "a b", "words": words(("a", 1, 1.5, 1), ("b", 0.5, 0.7, 1))},
         "a word begins at 0.5 s, after one at 1 s"),
        ({"text": "a", "segments": [{"text": "a", "avg_logprob": 0.1}]}, "segments/0/avg_logprob"),
    ],
)  # fmt: skip
def test_a_lie_is_refused_by_name(answer: Any, problem: str) -> None:
    with pytest.raises(SpeechError, match=re.escape(problem)) as refused:
        hear(Asked(answer))
    assert "expected JSON such as" in str(refused.value)


def test_it_is_not_asked_about_no_audio() -> None:
    asked = Asked({"text": "climb"})
    assert hear(asked, seconds=0.0) == Recognised("", (), 1.0)
    assert asked.bodies == []


def test_the_first_two_failures_in_a_row_are_passing_and_the_third_is_not() -> None:
    asked = Asked({"text": "climb"})
    passing = []
    with service(asked) as url:
        engine = HttpAsr(url)
        for status in (503, 503, 200, 503, 503, 503):
            asked.status = status
            try:
                engine.recognise_call(audio(), CALL)
            except SpeechError as error:
                passing.append(error.is_passing)
                last = str(error)
    assert passing == [True, True, True, True, False]
    assert last.endswith("(3 times in a row)")
