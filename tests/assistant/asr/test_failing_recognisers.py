"""Recognisers that fail in the middle of a run: the run goes on without them, and says so."""

from __future__ import annotations

import dataclasses
import functools
import json
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler
from pathlib import Path

import pytest

import airhilt.assistant.asr.engines.http
from airhilt import run
from airhilt.audio.wav import decode_wav
from airhilt.cosim.observer import Observer, Result
from airhilt.messages import Transcript
from airhilt.record import read_log
from airhilt.scenario import Scenario
from services import Slow, answering, nobody, service

RIGHT = json.dumps({"text": "Washington Center.", "confidence": 0.9}).encode()


@pytest.fixture(scope="module")
def short(encounter: Scenario) -> Scenario:
    """The encounter up to its second call and what comes of it."""
    return encounter.model_copy(update={"duration_s": 25.0})


@contextmanager
def slow() -> Iterator[str]:
    answer = Slow("silent", RIGHT)
    with service(answer) as url:
        yield url
        answer.released.set()


@contextmanager
def down() -> Iterator[str]:
    yield nobody()


FAILING = {
    "down": (down, "is not there"),
    "slow": (slow, "has not answered for 0.3 s"),
    "broken": (lambda: service(answering(b"out of memory", 500)), "HTTP status 500"),
    "nonsense": (lambda: service(answering(b"<html>hello</html>")), "expected JSON such as"),
    "wrong": (lambda: service(answering(b'{"text": "a", "confidence": 7}')), "confidence"),
}


class Notices(Observer):
    def __init__(self) -> None:
        self.texts: list[str] = []

    def notice(self, text: str) -> None:
        self.texts.append(text)


def rows(result: Result, key: str) -> list[dict[str, str]]:
    return [json.loads(one.data) for one in read_log(result.folder / "log.mcap") if one.key == key]


def transcripts(result: Result) -> list[Transcript]:
    return [
        Transcript.model_validate_json(one.data)
        for one in read_log(result.folder / "log.mcap")
        if one.key.startswith("asr/")
    ]


@pytest.mark.parametrize("kind", FAILING)
def test_a_service_that_fails_is_the_loss_of_speech_and_of_nothing_else(
    kind: str, short: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    impatient = functools.partial(airhilt.assistant.asr.engines.http.HttpAsr, timeout_s=0.3)
    http = airhilt.assistant.asr.engines.http
    monkeypatch.setattr(http, "ENGINE", dataclasses.replace(http.ENGINE, create=impatient))
    failing, said = FAILING[kind]
    observer = Notices()
    with failing() as url:
        result = run(short, out=tmp_path / "run", latency="fixed", asr=url, observer=observer)
    assert result.summary.outcome == "finished"
    assert result.summary.duration_s == pytest.approx(25.0)
    assert result.summary.modalities["asr"] == "lost"
    assert {"adsb", "radio", "decision", "tts"} <= {
        name for name, state in result.summary.modalities.items() if state == "on"
    }
    last = rows(result, "status/asr")[-1]
    assert last["state"] == "lost"
    assert said in last["cause"]
    assert url in last["cause"]
    (event,) = [one for one in rows(result, "truth/event") if one["kind"] == "worker_lost"]
    assert (event["subject"], event["text"]) == ("asr", last["cause"])
    assert any(said in text for text in observer.texts)
    assert transcripts(result) == []
    assert result.summary.advisories, "what does not need speech is still there"


def test_what_was_recognised_before_a_service_failed_stays(short: Scenario, tmp_path: Path) -> None:
    given: list[int] = []

    def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
        given.append(len(decode_wav(body, "the request")))
        answering(RIGHT if len(given) == 1 else b"")(handler, body)

    with service(answer) as url:
        result = run(short, out=tmp_path / "run", latency="fixed", asr=url)
    assert len(given) == 2, "it is not asked again"
    (transcript,) = transcripts(result)
    assert (transcript.id, transcript.text) == ("check-in-aal", "washington center")
    assert transcript.engine == "http"
    assert result.summary.modalities["asr"] == "lost"


def test_crews_that_read_the_radio_go_on_without_transcripts(
    short: Scenario, tmp_path: Path
) -> None:
    result = run(
        short, out=tmp_path / "run", latency="fixed", asr=nobody(), topology="asr_first"
    )  # fmt: skip
    assert result.summary.outcome == "finished"
    assert result.summary.modalities["asr"] == "lost"
