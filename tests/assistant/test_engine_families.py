"""Engines are chosen by name, path or address, and other packages add theirs."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TypeVar

import pytest

from airhilt import run
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.reference import reference_worker
from airhilt.assistant.wording.engines.template import Template
from airhilt.bus import free_endpoint
from airhilt.cli.commands.doctor import examine
from airhilt.cosim.replay import replay
from airhilt.engine_families import DETECTORS, RECOGNISERS
from airhilt.engines import Package
from airhilt.errors import AirhiltError, SpeechError, VisionError, WorkerError
from airhilt.messages import (
    ActorTruth,
    Advisory,
    Evidence,
    GoAround,
    Message,
    Severity,
)
from airhilt.metrics.result import Result
from airhilt.record import read_log
from airhilt.scenario import Scenario
from engine_package import installed
from paths import DOCS
from processes import process

M = TypeVar("M", bound=Message)
HEAD = """
import numpy as np
from airhilt.engines import Engine, Package
"""
RECOGNISER = (
    HEAD
    + """
from airhilt.assistant.asr.engine import Recognised


class Parrot:
    name = "parrot"

    def __init__(self, words):
        self.words = words or "say again"

    def recognise(self, audio, callsigns):
        return Recognised(self.words, (), 0.5)


ENGINE = Engine("parrot", "hears the same in everything", Parrot, argument="WORDS")
"""
)
VOICE = (
    HEAD
    + """
from airhilt.voices.engine import VoiceSpec


class Beep:
    name, version = "beep", "1"

    def voice_of(self, speaker):
        return VoiceSpec(speaker)

    def synthesise(self, text, voice):
        return np.full(8_000, 0.1, np.float32)


ENGINE = Engine("beep", "beeps", lambda _: Beep())
"""
)
DETECTOR = (
    HEAD
    + """
from airhilt.assistant.vision.detector import Found


class Deer:
    name, threshold = "deer", 0.0

    def detect(self, picture):
        return [Found("deer", 0.9, (10.0, 10.0, 40.0, 40.0))]


ENGINE = Engine("everything_is_a_deer", "finds a deer in every picture", lambda _: Deer())
"""
)
BLOCKS = re.findall(
    r"```python\n(.*?)```", (DOCS / "your-assistant.md").read_text(), flags=re.DOTALL
)
ASSISTANT, WORDING = (
    next(block for block in BLOCKS if f"class {name}:" in block) for name in ("Nervous", "Shouting")
)
"""The examples of the guide."""


@pytest.fixture
def added(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Packages outside of AIRHILT with a recogniser, a voice and a detector."""
    with (
        installed(tmp_path, monkeypatch, "airhilt.asr", "parrot", RECOGNISER),
        installed(tmp_path, monkeypatch, "airhilt.tts", "beep", VOICE),
        installed(tmp_path, monkeypatch, "airhilt.detectors", "everything_is_a_deer", DETECTOR),
    ):
        yield


def messages(result: Result, prefix: str, model: type[M]) -> list[M]:
    log = read_log(result.folder / "log.mcap")
    return [model.model_validate_json(one.data) for one in log if one.key.startswith(prefix)]


def test_a_run_decides_and_words_with_engines_of_other_packages(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with (
        installed(tmp_path, monkeypatch, "airhilt.assistants", "nervous", ASSISTANT),
        installed(tmp_path, monkeypatch, "airhilt.wording", "shouting", WORDING),
    ):
        result = run(
            encounter,
            out=tmp_path / "run",
            latency="fixed",
            speech=False,
            assistant="nervous",
            wording="shouting",
        )
    assert result.summary.assistant == "nervous"
    told = messages(result, "advisory/", Advisory)
    assert {one.id for one in told} <= {"decision-AAL123-DAL456", "decision-DAL456-AAL123"}
    assert {(one.recipient, one.message) for one in told} == {
        ("AAL123", "AAL123! CAUTION! SAME LEVEL"),
        ("DAL456", "DAL456! CAUTION! SAME LEVEL"),
        ("ATC", "ATC! CAUTION! SAME LEVEL"),
    }
    with (
        installed(tmp_path, monkeypatch, "airhilt.assistants", "nervous", ASSISTANT),
        installed(tmp_path, monkeypatch, "airhilt.wording", "shouting", WORDING),
    ):
        assert replay(result.folder).identical


def test_a_worker_of_its_own_process_takes_engines_of_other_packages(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    endpoint = free_endpoint()
    with installed(tmp_path, monkeypatch, "airhilt.assistants", "nervous", ASSISTANT):
        monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), *sys.path]))
        command = ("worker", "decision", "--engine", "nervous", "--name", "mine")
        with process("-m", "airhilt", *command, "--connect", endpoint):
            result = run(
                encounter.model_copy(update={"duration_s": 5.0}),
                out=tmp_path / "run",
                latency="fixed",
                speech=False,
                endpoint=endpoint,
                attach=("mine",),
            )
    told = messages(result, "advisory/", Advisory)
    assert len(told) == 3
    assert {one.id for one in told} <= {"mine-AAL123-DAL456", "mine-DAL456-AAL123"}


def test_the_template_says_what_an_assistant_notes_that_has_no_finding() -> None:
    alert = Alert(
        id="a",
        revision=0,
        kind="runway_conflict",
        severity=Severity.WARNING,
        recipients=("AAL123", "ATC"),
        traffic=("AAL123",),
        evidence=Evidence(sources=("vision",), note="deer on runway 01", time_to_go_s=12.0),
        recommendations={"AAL123": GoAround(runway="01")},
    )
    words = [Template().message(alert, recipient) for recipient in alert.recipients]
    assert words == [
        "AAL123 go around. Deer on runway 01, 12 s to go",
        "AAL123, deer on runway 01, 12 s to go; AAL123 go around",
    ]


def test_an_assistant_that_reads_truth_is_refused() -> None:
    class Cheat:
        name = "cheat"
        reads = (ActorTruth,)

        def receive(self, received: ReceivedMessage) -> None: ...

        def decide(self, t_ns: int) -> Decision:
            return Decision()

    with pytest.raises(WorkerError, match="assistant 'cheat' reads ActorTruth; expected some of"):
        DecisionWorker(Cheat(), Template())


REMOTE = """
import pathlib
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision
from airhilt.engines import Engine
from airhilt.messages import AdsbReport, Evidence, Severity

ANSWERS = pathlib.Path(__file__).with_name("answers")


class Asking:
    name, reads = "asking", (AdsbReport,)

    def receive(self, received): ...

    def decide(self, t_ns):
        with ANSWERS.open("a") as answers:  # A service that never answers the same.
            answers.write("x")
        note = str(ANSWERS.stat().st_size)
        return Decision([Alert(
            id=note, revision=0, kind="runway_conflict", severity=Severity.ADVISORY,
            recipients=("ATC",), traffic=(), evidence=Evidence(sources=(), note=note),
        )])


ENGINE = Engine("asking", "asks a service", lambda _: Asking(), is_remote=True)
"""


def test_a_replay_takes_from_the_record_what_an_engine_asked_elsewhere(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    short = encounter.model_copy(update={"duration_s": 3.0})
    with installed(tmp_path, monkeypatch, "airhilt.assistants", "asking", REMOTE):
        result = run(short, out=tmp_path / "run", latency="fixed", speech=False, assistant="asking")
        asked = (tmp_path / "answers").read_text()
        assert messages(result, "advisory/", Advisory)
        verdict = replay(result.folder)
    assert verdict.identical, verdict.difference
    assert (tmp_path / "answers").read_text() == asked


@pytest.mark.usefixtures("added")
def test_doctor_lists_the_engines_of_all_families(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("airhilt.cli.commands.doctor._renderers", list)
    found = {one.name: one for one in examine()}
    assert found["recogniser embedded"].needed
    assert found["recogniser parrot"].found == "(hears the same in everything)"
    assert found["voice espeak"].needed
    assert found["assistant reference"].found
    assert found["wording template"].found
    assert not found["voice beep"].needed
    assert "everything_is_a_deer" in " ".join(found)


def faulty(create: str = "lambda _: 42", more: str = "") -> str:
    """Return the source of an engine that does not do what it must."""
    return f"""
from airhilt.engines import Engine


def fail(*_):
    raise LookupError("no model")


class Need:
    found = remedy = fail


ENGINE = Engine("faulty", "fails", {create}{more})
"""


def test_an_engine_that_cannot_be_made_is_named_with_the_cause(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with (
        installed(tmp_path, monkeypatch, "airhilt.asr", "faulty", faulty("fail")),
        pytest.raises(SpeechError, match="'faulty' cannot be made: LookupError: no model"),
    ):
        RECOGNISERS.create("faulty")


@pytest.mark.parametrize(
    ("source", "cause"),
    [
        (faulty("fail"), "LookupError: no model"),
        (faulty(), "42, has no name, recognise"),
        (faulty(more=", requires=(Need(),)"), "cannot be looked up: LookupError: no model"),
        ("raise SystemExit('it ends')", "SystemExit: it ends"),
    ],
)
def test_doctor_survives_a_broken_engine_and_gives_the_cause(
    source: str, cause: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("airhilt.cli.commands.doctor._renderers", list)
    with installed(tmp_path, monkeypatch, "airhilt.asr", "faulty", source):
        found = {one.name: one for one in examine()}
    broken = found["recogniser faulty"]
    assert (broken.found, broken.needed) == ("", False)
    assert cause in broken.remedy
    assert found["recogniser embedded"].found


def test_two_engines_of_one_name_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with (
        installed(tmp_path, monkeypatch, "airhilt.asr", "whisper", RECOGNISER),
        pytest.raises(SpeechError, match="more than one recogniser named 'whisper'"),
    ):
        RECOGNISERS.create("whisper:base.en")


@pytest.mark.parametrize(
    ("file", "name"), [("ctc.onnx", "embedded"), ("model.bin", "whisper"), ("other.bin", None)]
)
def test_a_folder_goes_to_the_recogniser_whose_model_is_in_it(
    tmp_path: Path, file: str, name: str | None
) -> None:
    (tmp_path / file).touch()
    if name is None:
        with pytest.raises(SpeechError, match="no recogniser knows such files; expected embedded,"):
            RECOGNISERS.choose(str(tmp_path))
    else:
        assert RECOGNISERS.choose(str(tmp_path))[0].name == name


def test_a_folder_with_two_models_is_ambiguous(tmp_path: Path) -> None:
    for file in ("ctc.onnx", "model.bin"):
        (tmp_path / file).touch()
    expected = f"more than one can take it; expected embedded:{tmp_path} or whisper:{tmp_path}"
    with pytest.raises(SpeechError, match=expected):
        RECOGNISERS.choose(str(tmp_path))


def test_an_error_says_what_is_not_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Package, "found", lambda _: "")
    with pytest.raises(
        VisionError, match=r"yolo:FILE \(needs pip install 'airhilt\[yolo\]'\), or the"
    ):
        DETECTORS.create("nobody")


def test_an_error_names_all_forms_and_the_nearest_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Package, "found", lambda package: f"{package.name} 1")
    with pytest.raises(VisionError) as caught:
        DETECTORS.create("embeded")
    assert str(caught.value) == (
        "detector 'embeded': there is none of that name; expected embedded, embedded:FILE.onnx, "
        "onnx:FILE, yolo:FILE, or the address of a service; did you mean 'embedded'?"
    )


def test_only_a_run_takes_a_word_in_the_place_of_an_engine(tmp_path: Path) -> None:
    for kind in ("decision", "vision"):
        with pytest.raises(AirhiltError, match="'none': there is none of that name") as caught:
            reference_worker(kind, "none")
        assert str(caught.value).count("none") == 2
    with pytest.raises(AirhiltError, match="external; did you mean 'external'"):
        run("s02a_headon", assistant="externl", out=tmp_path / "run")
    with pytest.raises(VisionError, match="or none; did you mean 'none'"):
        run("s01b_nominal", detector="non", out=tmp_path / "run")
