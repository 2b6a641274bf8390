"""The checker of services tells good ones from bad ones."""

from __future__ import annotations

import json
from http.server import BaseHTTPRequestHandler

import pytest

from airhilt.assistant.service_check import check_service
from airhilt.assistant.service_kinds import PATHS, ServiceKind
from airhilt.audio.wav import decode_wav, encode_wav
from airhilt.errors import AirhiltError
from airhilt.host.forms import decoded_form
from airhilt.voices.engines.espeak import Espeak
from services import Answer, answering, nobody, service

FINDS = {"detections": [{"label": "bird", "confidence": 0.9, "box": [1, 1, 9, 9]}]}


def hints(kind: ServiceKind, answer: Answer) -> str:
    with service(answer) as url:
        return "\n".join(check_service(kind, url.removesuffix("/service") + PATHS[kind]))


def hears(text: str, **more: object) -> Answer:
    """Return a recogniser that hears a text unless there is silence."""

    def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
        form = decoded_form(body, handler.headers["Content-Type"])
        is_silent = not decode_wav(form["file"], "file").any()
        answering(json.dumps({"text": "" if is_silent else text, **more}).encode())(handler, body)

    return answer


def speaks(handler: BaseHTTPRequestHandler, body: bytes) -> None:
    voice = Espeak()
    speech = voice.synthesise(json.loads(body)["input"], voice.voice_of("TOWER"))
    answering(encode_wav(speech))(handler, body)


def test_a_good_recogniser_is_told_what_it_heard() -> None:
    words = [{"word": "climb", "probability": 0.8}]
    told = hints("asr", hears("climb", words=words))
    assert "heard 'climb' of 'American one two three, climb and maintain" in told
    assert "with confidence 0.80" in told


def test_a_recogniser_that_is_always_sure_gets_a_hint() -> None:
    told = hints("asr", hears("climb"))
    assert "no word has a confidence" in told
    assert "never asks again" in told


def test_a_recogniser_that_hears_words_in_silence_gets_a_hint() -> None:
    assert "heard 'thank you' in silence" in hints("asr", answering(b'{"text": "Thank you."}'))


def test_good_voices_are_told_how_long_they_spoke() -> None:
    told = hints("tts", speaks)
    assert "spoke 12 words in" in told
    assert "no speech" not in told


def test_a_beep_is_no_speech() -> None:
    voice = Espeak()
    beep = voice.synthesise("a", voice.voice_of("TOWER"))[:4_000]
    assert "that is no speech" in hints("tts", answering(encode_wav(beep)))


def test_a_detector_that_finds_something_in_a_grey_picture_gets_a_hint() -> None:
    assert "found bird in a grey picture" in hints("vision", answering(json.dumps(FINDS).encode()))


def test_an_assistant_that_warns_nobody_gets_the_hint_of_workers() -> None:
    advisory = {
        "id": "x", "kind": "loss_of_separation", "severity": "WARNING",
        "recipients": ["NOBODY9"], "traffic": ["AAL123", "DAL456"],
    }  # fmt: skip
    told = hints("decision", answering(json.dumps({"advisories": [advisory]}).encode()))
    assert "its WARNING to NOBODY9: nobody has that name" in told


@pytest.mark.parametrize("kind", PATHS)
def test_what_a_run_would_not_take_is_an_error(kind: ServiceKind) -> None:
    with pytest.raises(AirhiltError, match="is not there"):
        check_service(kind, nobody())
    with pytest.raises(AirhiltError, match="is no address"):
        check_service(kind, "whisper:tiny")
    with pytest.raises(AirhiltError, match="status 404: 'Not Found'"):
        hints(kind, answering(b'{"detail": "Not Found"}', 404))


def test_an_answer_that_goes_wrong_later_is_named_with_its_input() -> None:
    given = iter([b'{"text": ""}'])

    def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
        answering(next(given, b"null"))(handler, body)

    with pytest.raises(AirhiltError, match=r"worker 'asr' has no result of an input: .*'null'"):
        hints("asr", answer)
