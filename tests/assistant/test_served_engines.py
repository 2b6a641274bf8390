"""Engines of AIRHILT behind addresses, asked by the clients that a run has."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any, get_args

import httpx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from prometheus_client.parser import text_string_to_metric_families
from pydantic import TypeAdapter

from airhilt import Scenario, __version__, run
from airhilt.assistant.asr.engine import Call
from airhilt.assistant.asr.engines.http import HttpAsr
from airhilt.assistant.decision.engines.http import assistant_at
from airhilt.assistant.decision.findings import Finding
from airhilt.assistant.service_check import check_service
from airhilt.assistant.service_kinds import KINDS, PATHS, ServiceKind
from airhilt.assistant.services_document import services_document
from airhilt.assistant.vision.detectors.http import HttpDetector
from airhilt.audio.pcm import from_pcm, to_pcm
from airhilt.cosim.replay import replay
from airhilt.engine_families import RECOGNISERS, VOICES
from airhilt.errors import VisionError, WorkerError
from airhilt.record import read_log
from airhilt.voices.engines.http import HttpTts
from camera_run import passing
from served_engines import served, serving

CALL = Call("c-1", 118_300, 0, None, ("AAL123", "DAL456"))
ENGINES: Mapping[ServiceKind, str] = {
    "asr": "embedded",
    "tts": "espeak",
    "vision": "embedded",
    "decision": "reference",
}


def test_voices_and_recognisers_say_and_hear_the_same_as_in_process() -> None:
    voices, ears = VOICES.create("espeak"), RECOGNISERS.create("embedded")
    text = "American one two three, descend and maintain flight level three three zero."
    with served("tts", "espeak") as tts, served("asr", "embedded") as asr:
        own = HttpTts(tts)
        for speaker in ("TOWER", "AAL123"):
            spoken = voices.synthesise(text, voices.voice_of(speaker))
            assert to_pcm(own.synthesise(text, own.voice_of(speaker))) == to_pcm(spoken)
        received = from_pcm(to_pcm(spoken))
        heard = HttpAsr(asr).recognise_call(received, CALL)
    assert heard == ears.recognise(received, CALL.callsigns)
    assert heard.words


@pytest.mark.parametrize("kind", KINDS)
def test_each_passes_the_check_and_describes_itself(kind: ServiceKind) -> None:
    with served(kind, ENGINES[kind]) as url:
        assert check_service(kind, url)
        base = url.removesuffix(PATHS[kind])
        health = httpx.get(f"{base}/health").json()
        assert health == {"status": "ok", "kind": kind, "engine": ENGINES[kind]}
        assert httpx.get(f"{base}/openapi.json").json() == services_document()
        assert httpx.post(url, content=b"").status_code == 422
        measured = {
            (each.name, *each.labels.values()): each.value
            for family in text_string_to_metric_families(httpx.get(f"{base}/metrics").text)
            for each in family.samples
        }
        assert measured["airhilt_service_info", ENGINES[kind], kind, __version__] == 1.0
        assert measured["airhilt_answers_total", "422"] == 1.0
        answers = measured["airhilt_answers_total", "200"] + 1.0
        assert measured[("airhilt_engine_seconds_count",)] == answers > 1.0
        assert measured[("airhilt_requests_in_progress",)] == 0.0


@pytest.mark.parametrize(
    ("kind", "body", "said"),
    [
        ("asr", b"RIFF", "file: Field required"),
        ("tts", b"{}", "input, voice: Field required"),
        ("vision", b'{"image": "%%", "ts_ms": 0, "camera_id": "a"}', "expected PNG in base64"),
        ("decision", b"null", "Input should be an object"),
    ],
)
def test_a_bad_request_is_answered_in_words(kind: ServiceKind, body: bytes, said: str) -> None:
    with served(kind, ENGINES[kind]) as url:
        answer = httpx.post(url, content=body)
    assert answer.status_code == 422
    assert said in answer.json()["detail"]


def test_the_words_of_an_engine_that_fails_reach_the_client() -> None:
    with served("vision", "embedded") as url:
        answer = httpx.post(url, json={"image": "UE5H", "ts_ms": -1, "camera_id": "a"})
        assert "ts_ms: Input should be greater than or equal to 0" in answer.json()["detail"]
        with pytest.raises(VisionError, match="HTTP status 404: 'Not Found'"):
            HttpDetector(f"{url}/no/detections").detect(np.zeros((48, 64, 3), np.uint8))


def own_messages(folder: Path) -> list[tuple[str, int, str, dict[str, Any]]]:
    """Return what a run has logged, without the names of its engines."""
    return [
        (each.key, each.t_ns, each.publisher, json.loads(each.data) | {"engine": ""})
        for each in read_log(folder / "log.mcap")
    ]


def test_a_run_with_its_own_four_services_is_the_run_alone(tmp_path: Path) -> None:
    options: dict[str, Any] = {"latency": "fixed"}
    alone = run(passing(), out=tmp_path / "alone", **options)
    with ExitStack() as services:
        at = {kind: services.enter_context(serving(kind)) for kind in KINDS}
        asked = run(
            passing(), out=tmp_path / "asked", asr=at["asr"], tts=at["tts"],
            detector=at["vision"], assistant=at["decision"], **options,
        )  # fmt: skip
    told = own_messages(alone.folder)
    assert own_messages(asked.folder) == told
    families = {key.partition("/")[0] for key, *_ in told}
    assert {"asr", "vision", "advisory", "tts"} <= families
    assert any(each["detections"] for key, _, _, each in told if key.startswith("vision/"))
    assert replay(asked.folder).identical


@pytest.mark.parametrize("engine", ["reference", "paper", "tcas"])
def test_a_served_assistant_keeps_runs_apart_and_decides_as_in_process(
    engine: str, encounter: Scenario, tmp_path: Path
) -> None:
    """Two runs, one after the other, are each as the run alone."""
    options: dict[str, Any] = {"latency": "fixed", "speech": False, "cameras": False}
    alone = run(encounter, out=tmp_path / "alone", assistant=engine, **options)
    with served("decision", engine) as url:
        for name in ("once", "again"):
            asked = run(encounter, out=tmp_path / name, assistant=url, **options)
            assert own_messages(asked.folder) == own_messages(alone.folder)


def test_a_service_that_has_forgotten_a_run_says_so() -> None:
    with served("decision", "reference") as url:
        engine = assistant_at(url)
    with (
        served("decision", "reference", port=httpx.URL(url).port) as url,
        pytest.raises(WorkerError, match="no such run is known here"),
    ):
        engine.decide(0)


def is_finite(finding: Finding) -> bool:
    return not re.search(r"\b(inf|nan)\b", repr(finding))


@settings(max_examples=50)
@given(st.one_of(*map(st.from_type, get_args(Finding))).filter(is_finite))
def test_a_finding_arrives_as_it_was_sent(finding: Finding) -> None:
    """Whatever was found: the wording of the run makes the message of it."""
    adapter: TypeAdapter[Finding] = TypeAdapter(Finding)
    assert adapter.validate_json(adapter.dump_json(finding)) == finding
