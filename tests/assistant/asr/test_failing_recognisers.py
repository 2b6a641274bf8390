"""Recognisers that fail in the middle of a run: the run goes on without them, and says so."""

from __future__ import annotations

import dataclasses
import functools
import json
import subprocess
from collections.abc import Callable
from contextlib import nullcontext
from http.server import BaseHTTPRequestHandler
from pathlib import Path

import pytest

import airhilt.assistant.asr.engines.http
from airhilt import run
from airhilt.cosim.observer import Observer
from airhilt.cosim.replay import replay
from airhilt.messages import Transcript
from airhilt.metrics.result import Result
from airhilt.record import read_log
from airhilt.scenario import Scenario
from services import Answer, Slow, answering, endless, nobody, redirecting, service

Cli = Callable[..., subprocess.CompletedProcess[str]]
RIGHT = json.dumps({"text": "Washington Center.", "confidence": 0.9}).encode()


@pytest.fixture(scope="module")
def short(encounter: Scenario) -> Scenario:
    """The encounter up to its third call and what comes of it."""
    return encounter.model_copy(update={"duration_s": 28.0})


def at_a_time(answers: str) -> Answer:
    """Return an answer that is right (``+``) or fails, by the letters of `FAILURES`.

    The first is to the probe before the run. The last one goes on for ever.
    """
    given = iter(answers)

    def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
        FAILURES[next(given, answers[-1])](handler, body)

    return answer


FAILURES: dict[str, Answer] = {
    "+": answering(RIGHT),
    "s": Slow("silent", RIGHT),
    "b": answering(b"out of memory", 503),
    "n": answering(b"null"),
    "h": answering(b"<html>hello</html>"),
    "w": answering(b'{"text": "a", "confidence": 7}'),
    "r": redirecting("http://127.0.0.1:1/"),
    "e": endless,
}
SAID = {
    "s": "has not answered for 0.3 s", "b": "HTTP status 503: 'out of memory'",
    "n": "expected JSON such as", "h": "expected JSON such as", "w": "confidence",
    "r": "HTTP status 303", "e": "more than 1000000 bytes",
}  # fmt: skip


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


@pytest.mark.parametrize("kind", SAID)
def test_a_service_that_fails_three_times_in_a_row_is_the_loss_of_speech_and_of_nothing_else(
    kind: str, short: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    impatient = functools.partial(airhilt.assistant.asr.engines.http.HttpAsr, timeout_s=0.3)
    http = airhilt.assistant.asr.engines.http
    monkeypatch.setattr(http, "ENGINE", dataclasses.replace(http.ENGINE, create=impatient))
    observer = Notices()
    with service(at_a_time(f"+{kind}")) as url:
        result = run(short, out=tmp_path / "run", latency="fixed", asr=url, observer=observer)
    assert result.summary.outcome == "finished"
    assert result.summary.duration_s == pytest.approx(short.duration_s)
    assert result.summary.modalities["asr"] == "lost"
    assert {"adsb", "radio", "decision", "tts"} <= {
        name for name, state in result.summary.modalities.items() if state == "on"
    }
    last = rows(result, "status/asr")[-1]
    assert last["state"] == "lost"
    assert SAID[kind] in last["cause"]
    assert url in last["cause"]
    events = rows(result, "truth/event")
    (event,) = [one for one in events if one["kind"] == "worker_lost"]
    assert (event["subject"], event["text"]) == ("asr", last["cause"])
    missed = [one for one in events if one["kind"] == "step_missed"]
    assert [SAID[kind] in one["text"] for one in missed] == [True, True]
    assert result.summary.steps_missed == {"asr": 2}
    assert len([text for text in observer.texts if SAID[kind] in text]) == 3
    assert transcripts(result) == []
    assert result.summary.advisories, "what does not need speech is still there"


def test_one_bad_answer_costs_one_transcript_and_the_replay_has_the_same(
    short: Scenario, tmp_path: Path
) -> None:
    with service(at_a_time("+b+n+")) as url:
        result = run(short, out=tmp_path / "run", latency="fixed", asr=url, topology="asr_first")
    assert result.summary.modalities["asr"] == "on"
    assert result.summary.steps_missed == {"asr": 2}
    assert {one.text for one in transcripts(result)} == {"washington center"}
    verdict = replay(result.folder)  # The service is down now.
    assert verdict.identical, verdict.difference


def test_crews_that_read_the_radio_go_on_without_transcripts(
    short: Scenario, tmp_path: Path
) -> None:
    with service(at_a_time("+b")) as url:
        result = run(short, out=tmp_path / "run", latency="fixed", asr=url, topology="asr_first")
    assert result.summary.outcome == "finished"
    assert result.summary.modalities["asr"] == "lost"


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (None, "is not there"),
        (answering(b'{"detail": "Not Found"}', 404), "HTTP status 404: 'Not Found'"),
        (answering(b"<html>hello</html>"), "expected JSON such as"),
    ],
)
def test_a_dead_or_wrong_address_ends_the_command_before_the_run(
    answer: Answer | None, said: str, encounter_file: Path, tmp_path: Path, airhilt_command: Cli
) -> None:
    with nullcontext(nobody()) if answer is None else service(answer) as url:
        out = tmp_path / "run"
        arguments = ("--scenario", encounter_file, "--out", out, "--asr", url)
        done = airhilt_command("cosim", *arguments)
    assert done.returncode == 2
    assert [said in line for line in done.stderr.splitlines() if url in line] == [True]
    assert not out.exists()
