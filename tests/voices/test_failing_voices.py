"""Voices of the radio that fail in the middle of a run: it goes on without them, and says so."""

from __future__ import annotations

import json
from http.server import BaseHTTPRequestHandler
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from airhilt import run
from airhilt.audio.pcm import SAMPLE_RATE_HZ
from airhilt.audio.wav import encode_wav
from airhilt.cosim.observer import Observer
from airhilt.cosim.replay import replay
from airhilt.errors import SpeechError
from airhilt.messages import SpokenTruth, Transmission, TransmissionClosed
from airhilt.metrics.result import Result
from airhilt.record import read_log
from airhilt.scenario import Scenario
from airhilt.sensors.radio.learned_channel import LearnedChannel
from paths import DATA
from services import answering, nobody, service

CHANNEL = DATA / "channels" / "echo.onnx"


class Voices:
    """A service that speaks so often, and then fails so often."""

    def __init__(self, times: int, failures: int = 1_000) -> None:
        self.asked: list[str] = []
        self._fails = range(times, times + failures)

    def __call__(self, handler: BaseHTTPRequestHandler, body: bytes) -> None:
        text = json.loads(body)["text"]
        self.asked.append(text)
        if len(self.asked) - 1 in self._fails:
            answering(b"hoarse", 500)(handler, body)
        else:
            speech = np.sin(np.arange(800 * len(text)) / 9).astype(np.float32) / 2
            answering(encode_wav(speech.astype(np.float32)), kind="audio/wav")(handler, body)


class Notices(Observer):
    def __init__(self) -> None:
        self.texts: list[str] = []

    def notice(self, text: str) -> None:
        self.texts.append(text)


@pytest.fixture(autouse=True)
def _nothing_is_cached(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("in the way of a cache")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))


@pytest.fixture(scope="module")
def short(encounter: Scenario) -> Scenario:
    """The encounter up to its third call and what comes of it."""
    return encounter.model_copy(update={"duration_s": 28.0})


def rows(result: Result, prefix: str, model: Any) -> list[Any]:
    return [
        model.model_validate_json(one.data)
        for one in read_log(result.folder / "log.mcap")
        if one.key.startswith(prefix) and not one.key.endswith("/audio")
    ]


def lost_after(calls: int, scenario: Scenario, out: Path, **options: Any) -> Result:
    """Run with voices that fail after so many calls.

    Each line is spoken once beforehand, and so is the probe.
    """
    voices = Voices(1 + len(scenario.radio.lines) + calls)
    with service(voices) as url:
        return run(scenario, out=out, latency="fixed", tts=url, **options)


def test_the_run_goes_on_when_the_voices_of_the_radio_fail(short: Scenario, tmp_path: Path) -> None:
    observer = Notices()
    result = lost_after(1, short, tmp_path / "run", assistant="none", observer=observer)
    assert result.summary.outcome == "finished"
    assert result.summary.modalities["radio"] == "lost"
    statuses = [
        json.loads(one.data)
        for one in read_log(result.folder / "log.mcap")
        if one.key == "status/radio"
    ]
    assert statuses[-1]["state"] == "lost"
    assert "HTTP status 500: 'hoarse'" in statuses[-1]["cause"]
    (event,) = [
        one
        for one in read_log(result.folder / "log.mcap")
        if one.key == "truth/event" and b"radio_lost" in one.data
    ]
    assert json.loads(event.data)["text"] == statuses[-1]["cause"]
    assert any("hoarse" in text for text in observer.texts)


def test_voices_that_fail_twice_are_asked_again(short: Scenario, tmp_path: Path) -> None:
    observer = Notices()
    voices = Voices(2 + len(short.radio.lines), failures=2)
    with service(voices) as url:
        result = run(
            short,
            out=tmp_path / "run",
            latency="fixed",
            tts=url,
            assistant="none",
            observer=observer,
        )
    assert result.summary.modalities["radio"] == "on"
    assert all(one.samples for one in rows(result, "radio/", Transmission))
    assert len([text for text in observer.texts if "asks the voices again" in text]) == 2


def test_calls_after_that_take_the_time_of_their_words_and_arrive_without_them(
    short: Scenario, tmp_path: Path
) -> None:
    result = lost_after(1, short, tmp_path / "run", assistant="external")
    said = {one.id: one for one in rows(result, "truth/radio/", SpokenTruth)}
    heard = rows(result, "radio/", Transmission)
    first, *others = heard
    assert others
    assert first.samples > 0
    assert [one.samples for one in others] == [0] * len(others)
    for one in others[:-1]:
        words = len(said[one.id].text.split())
        seconds = (said[one.id].t_end_ns - said[one.id].t_tx_ns) / 1e9
        assert seconds == pytest.approx(words * 60 / short.radio.words_per_minute)
    transcribed = {
        json.loads(one.data)["id"]
        for one in read_log(result.folder / "log.mcap")
        if one.key.startswith("asr/")
    }
    assert transcribed <= {first.id}


def test_voices_that_fail_before_the_run_end_the_command(short: Scenario, tmp_path: Path) -> None:
    with pytest.raises(SpeechError, match="is not there"):
        run(short, out=tmp_path / "run", latency="fixed", tts=nobody())
    assert not (tmp_path / "run").exists()


def test_a_channel_that_fails_is_the_loss_of_the_radio_too(
    short: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise SpeechError("learned channel: worn out")

    monkeypatch.setattr(LearnedChannel, "transmit", fail)
    result = run(
        short, out=tmp_path / "run", latency="fixed", radio_profile=str(CHANNEL), assistant="none"
    )
    assert result.summary.modalities["radio"] == "lost"
    assert {one.samples for one in rows(result, "radio/", Transmission)} == {0}


@pytest.mark.parametrize("calls", [5, 100])
def test_a_replay_asks_no_service_again(calls: int, short: Scenario, tmp_path: Path) -> None:
    right = b'{"text": "Washington Center."}'
    given = [right, right, b"nonsense"]  # The first is to the probe.

    def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
        answering(given.pop(0) if given else b"")(handler, body)

    with service(answer) as asr:
        result = lost_after(calls, short, tmp_path / "run", asr=asr)
    sounds = [one.samples > 0 for one in rows(result, "radio/", Transmission)]
    assert sounds[0]
    assert all(sounds) is (calls == 100)
    verdict = replay(result.folder)  # Both services are down now.
    assert verdict.identical, verdict.difference
    assert verdict.notes == ()


def test_a_replay_knows_what_was_heard_of_a_call_in_which_the_voices_failed(
    short: Scenario, tmp_path: Path
) -> None:
    first, second, *others = short.radio.lines
    lines = (first, second.model_copy(update={"at_s": first.at_s + 1.2}), *others)
    radio = short.radio.model_copy(update={"lines": lines})
    scenario = short.model_copy(update={"radio": radio})
    result = lost_after(1, scenario, tmp_path / "run", assistant="none")
    incomplete = [
        closed
        for one in read_log(result.folder / "log.mcap")
        if one.key.endswith("/audio") and b'"closed"' in one.data
        for closed in [TransmissionClosed.model_validate_json(one.data)]
        if not closed.is_complete
    ]
    assert [closed.id for closed in incomplete] == [first.id]
    assert incomplete[0].samples == SAMPLE_RATE_HZ
    assert rows(result, "radio/", Transmission)[0].samples == 0
    verdict = replay(result.folder)
    assert verdict.identical, verdict.difference
