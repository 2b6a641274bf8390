"""Engines of AIRHILT behind addresses, asked by the clients that a run has."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest

from airhilt import Scenario, run
from airhilt.assistant.asr.engine import Call
from airhilt.assistant.asr.engines.http import HttpAsr
from airhilt.assistant.service_check import check_service
from airhilt.assistant.service_kinds import KINDS, PATHS, ServiceKind
from airhilt.assistant.services_document import services_document
from airhilt.assistant.vision.detectors.http import HttpDetector
from airhilt.audio.pcm import from_pcm, to_pcm
from airhilt.engine_families import RECOGNISERS, VOICES
from airhilt.errors import VisionError
from airhilt.voices.engines.http import HttpTts
from served_engines import served

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


@pytest.mark.parametrize(
    ("kind", "body", "said"),
    [
        ("asr", b"RIFF", "file: Field required"),
        ("tts", b"{}", "input: Field required"),
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


def test_a_served_assistant_warns_in_a_run_as_soon_as_it_is_asked(
    encounter: Scenario, tmp_path: Path
) -> None:
    options: dict[str, Any] = {"latency": "fixed", "speech": False, "cameras": False}
    alone = run(encounter, out=tmp_path / "alone", **options).summary
    with served("decision", "reference") as url:
        for name in ("once", "again"):
            asked = run(encounter, out=tmp_path / name, assistant=url, **options).summary
            assert asked.conflict_outcome == alone.conflict_outcome
            assert [each.severity for each in asked.advisories] == [
                each.severity for each in alone.advisories
            ]
            assert alone.t_first_warning_s is not None
            assert asked.t_first_warning_s == pytest.approx(alone.t_first_warning_s, abs=1.5)
