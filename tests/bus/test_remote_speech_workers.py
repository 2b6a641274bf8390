"""Recognisers and voices in other processes: raw audio over real Zenoh, both ways."""

from __future__ import annotations

import json
import math
import re
import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from airhilt import run
from airhilt.audio.wav import decode_wav, write_wav
from airhilt.bus import free_endpoint
from airhilt.cosim.replay import replay
from airhilt.errors import RunFolderError
from airhilt.messages import AdvisoryAudio, Message, Transcript, Transmission
from airhilt.record import RunFolder, read_log
from airhilt.scenario import Scenario
from paths import EXAMPLES
from processes import ActsAt, process

HASHING_RECOGNISER = """
import hashlib, sys
from airhilt.workers import serve
from airhilt.assistant.asr.engine import Recognised
from airhilt.audio.pcm import to_pcm
from airhilt.assistant.asr.worker import AsrWorker
class Hashing:
    name = "hashing"
    def recognise(self, audio, callsigns):
        said = f"{hashlib.sha256(to_pcm(audio)).hexdigest()} {' '.join(callsigns)}"
        return Recognised(said, (), 1.0)
serve(AsrWorker(Hashing()), sys.argv[1])
"""


@pytest.fixture(scope="module")
def short(encounter: Scenario) -> Scenario:
    """The encounter up to its two calls and the warning."""
    return encounter.model_copy(update={"duration_s": 20.0})


@contextmanager
def reference_worker(kind: str, endpoint: str) -> Iterator[subprocess.Popen[bytes]]:
    with process("-m", "airhilt", "worker", kind, "--connect", endpoint) as started:
        yield started


@contextmanager
def hashing_recogniser(endpoint: str) -> Iterator[subprocess.Popen[bytes]]:
    with process("-c", HASHING_RECOGNISER, endpoint) as started:
        yield started


def logged(folder: Path, prefix: str, model: type[Message]) -> list[Any]:
    return [
        model.model_validate_json(one.data)
        for one in read_log(folder / "log.mcap")
        if one.key.startswith(prefix) and not one.key.endswith("/audio")
    ]


def test_speech_workers_in_other_processes_give_the_same_log(
    short: Scenario, tmp_path: Path
) -> None:
    inside = run(short, out=tmp_path / "inside", latency="fixed").folder
    endpoint = free_endpoint()
    with reference_worker("asr", endpoint), reference_worker("tts", endpoint):
        outside = run(
            short, out=tmp_path / "outside", latency="fixed", endpoint=endpoint,
            attach=("asr", "tts"),
        ).folder  # fmt: skip
    assert logged(inside, "asr/", Transcript)
    assert logged(inside, "tts/", AdvisoryAudio)
    assert (outside / "log.mcap").read_bytes() == (inside / "log.mcap").read_bytes()
    sounds = {path.name: path.read_bytes() for path in (inside / "audio").iterdir()}
    assert {path.name: path.read_bytes() for path in (outside / "audio").iterdir()} == sounds


def test_an_attached_recogniser_gets_every_sample_and_speaks_for_the_run(
    short: Scenario, tmp_path: Path
) -> None:
    endpoint = free_endpoint()
    with hashing_recogniser(endpoint) as recogniser:
        result = run(short, out=tmp_path / "run", endpoint=endpoint, attach=("asr",))
        assert recogniser.wait(timeout=10.0) == 0
    sent = logged(result.folder, "radio/", Transmission)
    heard = logged(result.folder, "asr/", Transcript)
    assert len(sent) >= 2
    assert [(one.id, one.engine) for one in heard] == [(one.id, "hashing") for one in sent]
    assert [one.text for one in heard] == [f"{one.sha256} AAL123 DAL456" for one in sent]
    assert result.summary.modalities["asr"] == "on"
    assert replay(result.folder).identical


@pytest.mark.slow
def test_a_recogniser_may_take_a_call_chunk_by_chunk_while_it_lasts(
    short: Scenario, tmp_path: Path
) -> None:
    endpoint = free_endpoint()
    with process(EXAMPLES / "streaming_asr_worker.py", endpoint):
        result = run(
            short, out=tmp_path / "run", latency="fixed:0.1", endpoint=endpoint,
            attach=("streaming",),
        )  # fmt: skip
    sent = logged(result.folder, "radio/", Transmission)
    heard = logged(result.folder, "asr/", Transcript)
    assert len(sent) == 2
    for call, transcript in zip(sent, heard, strict=True):
        assert isinstance(call, Transmission)
        assert isinstance(transcript, Transcript)
        seconds = call.samples / call.sample_rate_hz
        chunks = math.ceil((call.t_end_ns - call.t_tx_ns) / 500_000_000)
        assert transcript.id == call.id
        assert transcript.engine == "streaming"
        assert re.fullmatch(
            rf"about {seconds:.0f} seconds in ({chunks}|{chunks + 1}) chunks", transcript.text
        )
        assert transcript.t_ns - call.t_end_ns <= 200_000_000
    steps = [
        json.loads(line)
        for line in (result.folder / "latency.jsonl").read_text().splitlines()
        if '"streaming"' in line
    ]
    first, second = (call.t_tx_ns for call in sent if isinstance(call, Transmission))
    begun = [step["t_in_ns"] for step in steps]
    assert {first, first + 500_000_000, second, second + 500_000_000} <= set(begun)
    assert replay(result.folder).identical


@pytest.fixture(scope="module")
def voiced(short: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run in which the voice was that of another process."""
    out = tmp_path_factory.mktemp("voiced") / "run"
    endpoint = free_endpoint()
    with reference_worker("tts", endpoint):
        run(short, out=out, endpoint=endpoint, attach=("tts",))
    return out


def test_a_replay_speaks_with_the_recorded_voice(voiced: Path) -> None:
    where = {one.description.name: one.where for one in RunFolder(voiced).info().workers}
    assert where["tts"] == "attached"
    assert replay(voiced).identical


def test_a_replay_needs_the_recorded_voice(voiced: Path) -> None:
    path = next((voiced / "audio").glob("advisory-*.wav"))
    kept = path.read_bytes()
    try:
        path.unlink()
        with pytest.raises(RunFolderError, match=rf"{path.name}: cannot be read: No such file"):
            replay(voiced)
        write_wav(path, -decode_wav(kept, "kept"))
        with pytest.raises(RunFolderError, match=rf"{path.name}: not the sound that the log"):
            replay(voiced)
        path.write_bytes(kept[:100])
        with pytest.raises(RunFolderError, match=rf"{path.name}: truncated.*as the run wrote it"):
            replay(voiced)
    finally:
        path.write_bytes(kept)


@pytest.mark.slow
def test_without_the_voice_that_died_advisories_are_read(short: Scenario, tmp_path: Path) -> None:
    endpoint = free_endpoint()
    with reference_worker("tts", endpoint) as voice:
        result = run(
            short, out=tmp_path / "run", latency="fixed", endpoint=endpoint, attach=("tts",),
            step_timeout_s=1.0, observer=ActsAt(1.0, voice, signal.SIGKILL),
        )  # fmt: skip
    assert result.summary.modalities["tts"] == "lost"
    assert result.summary.outcome == "finished"
    assert not logged(result.folder, "tts/", AdvisoryAudio)
    events = [one.data for one in read_log(result.folder / "log.mcap") if one.key == "truth/event"]
    assert any(json.loads(event)["kind"] == "pilot_reacts" for event in events)
    assert replay(result.folder).identical
