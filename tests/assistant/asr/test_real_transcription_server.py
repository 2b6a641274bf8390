"""faster-whisper behind OpenAI's API, in a process of its own: what it hears is what is heard."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import urlsplit

import httpx
import pytest

from airhilt import Scenario, run
from airhilt.assistant.asr.engine import Call
from airhilt.assistant.asr.engines.http import HttpAsr
from airhilt.audio.wav import encode_wav
from airhilt.errors import SpeechError
from airhilt.messages import Transcript
from airhilt.record import read_log
from airhilt.voices.engines.espeak import Espeak
from paths import DATA
from served_engines import served
from services import nobody

NEEDED = ("faster_whisper", "multipart", "openai")
PATIENCE_S = 120.0
SAID = "American one two three, runway zero one left, cleared to land."
HEARD = "tower runway zero one left cleared to land"
CALL = Call("c-1", 118_300, 2_500_000_000, "TOWER", ("AAL123", "DAL456"))

pytestmark = [
    pytest.mark.whisper,
    pytest.mark.slow,
    pytest.mark.skipif(
        not all(importlib.util.find_spec(each) for each in NEEDED),
        reason="no server: pip install airhilt[whisper] python-multipart openai",
    ),
]


class Server(NamedTuple):
    base: str
    log: Path

    @property
    def url(self) -> str:
        return f"{self.base}/audio/transcriptions"

    def asked(self) -> list[dict[str, Any]]:
        lines = self.log.read_text().splitlines()
        return [json.loads(line) for line in lines if line.startswith("{")]


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    port = urlsplit(nobody()).port
    program = Path(__file__).parents[2] / "support" / "whisper_server.py"
    command = [sys.executable, str(program), str(port), str(DATA / "tiny_whisper")]
    log = tmp_path_factory.mktemp("whisper") / "log"
    with log.open("wb") as stream, subprocess.Popen(command, stdout=stream, stderr=stream) as child:
        until = time.monotonic() + PATIENCE_S
        while time.monotonic() < until and child.poll() is None:
            try:
                httpx.get(f"http://127.0.0.1:{port}/openapi.json")
                break
            except httpx.TransportError:
                time.sleep(0.1)
        yield Server(f"http://127.0.0.1:{port}/v1", log)
        child.terminate()


def speech() -> Any:
    voice = Espeak()
    return voice.synthesise(SAID, voice.voice_of("TOWER"))


def test_a_call_is_heard_with_words_and_a_confidence(server: Server) -> None:
    heard = HttpAsr(f"{server.url}#tiny").recognise_call(speech(), CALL)
    assert heard.text == HEARD
    assert [word for word, _ in heard.words] == HEARD.split()
    assert 0.1 < heard.confidence < 1.0
    asked = server.asked()[-1]
    assert asked["form"] == {
        "model": "tiny", "language": "en", "prompt": "American 123, Delta 456",
        "temperature": "0.0", "response_format": "verbose_json",
        "timestamp_granularities[]": "word",
    }  # fmt: skip
    told = {name: asked["headers"][name] for name in asked["headers"] if name.startswith("x-")}
    assert told == {
        "x-ts-ms": "2500", "x-turn-id": "c-1", "x-frequency-khz": "118300", "x-speaker": "TOWER",
        "x-callsigns": "AAL123,DAL456",
    }  # fmt: skip


def test_the_client_library_of_openai_hears_the_same_of_that_server(server: Server) -> None:
    from openai import OpenAI

    with OpenAI(base_url=server.base, api_key="none", max_retries=0) as client:
        found = client.audio.transcriptions.create(
            file=("call.wav", encode_wav(speech()), "audio/wav"),
            model="tiny",
            language="en",
            prompt="American 123, Delta 456",
            temperature=0.0,
            response_format="verbose_json",
            timestamp_granularities=["word"],
        )
    by_library, by_airhilt = server.asked()[-1]["form"], server.asked()[0]["form"]
    assert by_library == by_airhilt
    assert found.words is not None
    assert "cleared to land" in found.text.lower()


def test_the_client_library_of_openai_speaks_with_airhilts_own_services() -> None:
    from openai import OpenAI

    voice = Espeak()
    with served("asr", "embedded") as asr, served("tts", "espeak") as tts:
        with OpenAI(base_url=asr.removesuffix("/audio/transcriptions"), api_key="none") as client:
            found = client.audio.transcriptions.create(
                file=("call.wav", encode_wav(speech()), "audio/wav"),
                model="embedded",
                response_format="verbose_json",
                timestamp_granularities=["word"],
                extra_headers={"X-Callsigns": "AAL123,DAL456"},
            )
        with OpenAI(base_url=tts.removesuffix("/audio/speech"), api_key="none") as client:
            spoken = client.audio.speech.create(
                model="espeak", input=SAID, voice="TOWER", response_format="wav"
            )
    assert "american one two three" in found.text
    assert found.words
    assert spoken.content == encode_wav(voice.synthesise(SAID, voice.voice_of("TOWER")))


def test_a_model_that_is_not_there_is_told_in_the_words_of_the_server(server: Server) -> None:
    with pytest.raises(SpeechError, match=r"status 404: .The model .huge. does not exist"):
        HttpAsr(f"{server.url}#huge").probe()


def test_a_run_has_transcripts_of_it(server: Server, encounter: Scenario, tmp_path: Path) -> None:
    result = run(
        encounter.model_copy(update={"duration_s": 15.0}),
        out=tmp_path / "run",
        latency="fixed",
        asr=f"{server.url}#tiny",
    )
    assert result.summary.modalities["asr"] == "on"
    heard = [
        Transcript.model_validate_json(one.data)
        for one in read_log(result.folder / "log.mcap")
        if one.key.startswith("asr/")
    ]
    assert heard
    assert {one.engine for one in heard} == {"http"}
