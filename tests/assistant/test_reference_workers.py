"""Which workers a run brings along, and which of their engines ask a program elsewhere."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

import pytest

from airhilt.assistant.language_model import LanguageModelSettings
from airhilt.assistant.reference import (
    Engines,
    decision_worker,
    is_own_engine,
    is_remote,
    reference_worker,
    reference_workers,
    speak_min_level,
)
from airhilt.assistant.vision.shared_looks import SharedLooks
from airhilt.assistant.vision.worker import VisionWorker
from airhilt.errors import LanguageModelError, WorkerError
from airhilt.messages import Modality, Severity, WorkerDescription
from airhilt.phraseology.numbers import Style

SERVICE = "http://127.0.0.1:9"
"""A service, which nobody asks as long as there is nothing to do."""
MODEL = LanguageModelSettings(f"{SERVICE}/v1", "small", deadline_s=5.0)


@dataclass
class Radio:
    """All that workers depend on of the radio of a scenario."""

    topology: str = "parallel"
    phraseology: Style = "faa"


def team(
    assistant: str = "reference",
    topology: str = "parallel",
    taken: Collection[Modality] = (),
    *,
    people_speak: bool = False,
    **engines: Any,
) -> list[WorkerDescription]:
    """Return the workers of a run in which all but the decision are services."""
    services = {"asr": SERVICE, "tts": SERVICE, "detector": SERVICE}
    given = Engines(**(services | engines))
    workers = reference_workers(assistant, Radio(topology), taken, given, people_speak=people_speak)
    return [worker.description for worker in workers]


def does(*args: Any, **given: Any) -> list[str]:
    return [description.modality for description in team(*args, **given)]


ALL = ["asr", "tts", "vision", "decision"]


def test_an_assistant_hears_speaks_looks_and_decides() -> None:
    assert does() == ALL
    assert [description.name for description in team()] == ALL


def test_where_nobody_decides_nobody_needs_to_hear_speak_or_look() -> None:
    assert does("none") == []


@pytest.mark.parametrize(
    ("topology", "people_speak"), [("asr_first", False), ("parallel", True), ("asr_first", True)]
)
def test_speech_is_recognised_for_automata_too(topology: str, people_speak: bool) -> None:
    assert does("none", topology, people_speak=people_speak) == ["asr"]


def test_a_program_of_the_user_that_decides_hears_speaks_and_sees() -> None:
    assert does("external") == ["asr", "tts", "vision"]


@pytest.mark.parametrize("taken", ["asr", "tts", "vision", "decision"])
def test_what_an_attached_worker_does_is_left_to_it(taken: Modality) -> None:
    assert does(taken=(taken,)) == [each for each in ALL if each != taken]


@pytest.mark.parametrize(
    ("engine", "task"), [("asr", "asr"), ("tts", "tts"), ("detector", "vision")]
)
def test_a_run_without_an_engine_has_no_such_worker(engine: str, task: str) -> None:
    assert does(**{engine: None}) == [each for each in ALL if each != task]


@pytest.mark.parametrize(
    ("taken", "enhancer", "tasks", "heard"),
    [
        ((), None, ["asr"], "radio/*/tx"),
        ((), "spectral", ["enhancement", "asr"], "enhanced/*"),
        (("enhancement",), None, ["asr"], "enhanced/*"),
        (("enhancement",), "spectral", ["asr"], "enhanced/*"),
        (("asr",), "spectral", ["enhancement"], None),
    ],
)
def test_a_recogniser_hears_what_is_enhanced_if_somebody_enhances(
    taken: tuple[Modality, ...], enhancer: str | None, tasks: list[str], heard: str | None
) -> None:
    workers = team("none", "asr_first", taken, enhancer=enhancer)
    assert [worker.modality for worker in workers] == tasks
    hearing = [worker.inputs[0].key for worker in workers if worker.modality == "asr"]
    assert hearing == ([] if heard is None else [heard])


@pytest.mark.parametrize("partial", [False, True])
def test_calls_that_go_on_are_recognised_if_that_is_asked_for(partial: bool) -> None:
    asr = team(partial_transcripts=partial)[0]
    assert ("radio/*/audio" in [each.key for each in asr.inputs]) is partial


def test_the_fusion_gate_reads_more_than_the_engine_alone() -> None:
    taken: tuple[Modality, ...] = ("asr", "tts", "vision")
    (alone,), (gated,) = (team("paper", each, taken) for each in ("parallel", "gated_fusion"))
    assert {each.key for each in alone.inputs} < {each.key for each in gated.inputs}


def test_the_least_severity_that_is_spoken_is_that_of_who_decides() -> None:
    def described(modality: Modality, **configuration: Any) -> WorkerDescription:
        description = decision_worker().description
        return description.model_copy(update={"modality": modality, "configuration": configuration})

    usual = speak_min_level([])
    assert usual is Severity.CAUTION
    assert speak_min_level([described("decision", speak_min_level="INFO")]) is Severity.INFO
    assert speak_min_level([described("vision", speak_min_level="INFO")]) is usual
    assert speak_min_level([described("decision")]) is usual


@pytest.mark.parametrize(
    ("name", "is_own"),
    [("reference", True), ("paper", True), ("http", False), ("", False), ("theirs", False)],
)
def test_an_engine_is_our_own_if_it_comes_along_and_asks_no_service(
    name: str, is_own: bool
) -> None:
    assert is_own_engine(name) is is_own


@pytest.mark.parametrize(
    ("task", "engines", "remote"),
    [
        ("asr", {"asr": SERVICE}, True),
        ("asr", {"asr": "embedded"}, False),
        ("asr", {"tts": SERVICE}, False),
        ("tts", {"tts": SERVICE}, True),
        ("tts", {"tts": None}, False),
        ("vision", {"detector": SERVICE}, True),
        ("vision", {"detector": "embedded"}, False),
        ("enhancement", {"enhancer": "spectral"}, False),
        ("decision", {}, False),
        ("decision", {"wording": "llm"}, True),
    ],
)
def test_a_worker_is_remote_if_an_engine_of_it_asks_a_service(
    task: Modality, engines: dict[str, Any], remote: bool
) -> None:
    assert is_remote(task, "reference", Engines(**engines)) is remote


def test_an_assistant_that_asks_a_service_is_remote() -> None:
    assert is_remote("decision", SERVICE, Engines())


def test_a_language_model_needs_somebody_who_asks_it_and_the_other_way_round() -> None:
    with pytest.raises(LanguageModelError, match="'llm' asks a language model; expected --llm"):
        decision_worker(wording="llm")
    with pytest.raises(LanguageModelError, match="nobody asks the language model"):
        decision_worker(llm=MODEL)
    assert decision_worker(wording="llm", llm=MODEL).description.modality == "decision"


@pytest.mark.parametrize("kind", ["decision", "enhancement", "asr", "tts", "vision"])
def test_a_worker_is_called_by_its_task_unless_it_has_a_name(kind: str) -> None:
    engine = SERVICE if kind in ("asr", "tts", "vision") else None
    for name in (None, "mine"):
        description = reference_worker(kind, engine, name).description
        assert (description.modality, description.name) == (kind, name or kind)


def test_there_is_no_other_kind_of_worker() -> None:
    with pytest.raises(WorkerError, match="no reference worker 'radar'"):
        reference_worker("radar")


@pytest.mark.parametrize(
    ("detector", "shares", "is_shared"),
    [("embedded", True, True), ("embedded", False, False), (SERVICE, True, False)],
)
def test_detections_are_shared_if_that_is_asked_for_and_the_detector_repeats_them(
    detector: str, shares: bool, is_shared: bool
) -> None:
    worker = reference_worker("vision", detector, shares_detections=shares)
    assert isinstance(worker, VisionWorker)
    assert isinstance(worker._gate._looks, SharedLooks) is is_shared
