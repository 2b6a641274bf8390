"""The workers that a run brings along, and their engines that ask a program elsewhere."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import pytest

from airhilt.cosim.engines_in_use import is_own_engine, is_remote
from airhilt.cosim.participants import Participants
from airhilt.cosim.reference_workers import reference_workers, speak_min_level
from airhilt.errors import LanguageModelError
from airhilt.messages import Advisory, Evidence, Modality, Severity, WorkerDescription
from airhilt.options import Options
from airhilt.sim.worker import Input
from airhilt.workers import LocalWorker
from airhilt.workers.pool import Participant
from airhilt.world.loading import load
from decisions import reference

SERVICE = "http://127.0.0.1:9"
"""A service, which nobody asks as long as there is nothing to do."""
CAUTION = Advisory(
    t_ns=5_000, id="decision-1", revision=2, recipient="ATC", recipients=("ATC",),
    kind="runway_conflict", severity=Severity.CAUTION, traffic=("AAL123",), message="Go around",
    evidence=Evidence(sources=("adsb",)), t_ready_ns=4_000,
)  # fmt: skip
SERVICES = {"asr": SERVICE, "tts": SERVICE}


def team(
    assistant: str = "reference",
    topology: str = "parallel",
    taken: Collection[Modality] = (),
    **options: Any,
) -> list[WorkerDescription]:
    """Return the workers of a run in which recogniser and voice are services."""
    given = Options(assistant=assistant, **{**SERVICES, **options})
    scenario = load("s01b_nominal")
    radio = scenario.radio.model_copy(update={"topology": topology})
    workers = reference_workers(given, scenario.model_copy(update={"radio": radio}), taken)
    return [worker.description for worker in workers]


def does(*args: Any, **options: Any) -> list[str]:
    return [description.modality for description in team(*args, **options)]


ALL = ["asr", "tts", "vision", "decision"]


def test_an_assistant_hears_speaks_looks_and_decides() -> None:
    assert does() == ALL
    assert [description.name for description in team()] == ALL


def test_where_nobody_decides_nobody_needs_to_hear_speak_or_look() -> None:
    assert does("none") == []


@pytest.mark.parametrize(("topology", "seat"), [("asr_first", ()), ("parallel", ("tower",))])
def test_speech_is_recognised_for_automata_and_people_too(
    topology: str, seat: tuple[str, ...]
) -> None:
    assert does("none", topology, seat=seat) == ["asr"]


def test_a_program_of_the_user_that_decides_hears_speaks_and_sees() -> None:
    assert does("external") == ["asr", "tts", "vision"]


@pytest.mark.parametrize(
    ("asr", "where", "told"),
    [
        ("embedded", ["in process"], "embedded"),
        ("embedded", ["attached"], "other"),
        (SERVICE, ["in process"], "other"),
        ("embedded", [], "none"),
    ],
)
def test_a_seat_is_told_what_recognises_its_calls(asr: str, where: list[Any], told: str) -> None:
    taken: tuple[Modality, ...] = ("tts", "vision", "decision")
    (worker,) = reference_workers(Options(asr=SERVICE), load("s01b_nominal"), taken)
    endpoint = LocalWorker(worker)
    there = tuple(Participant(worker.description, endpoint, each) for each in where)
    assert Participants("reference", there, ()).recogniser(Options(asr=asr)) == told


@pytest.mark.parametrize("taken", ALL)
def test_what_an_attached_worker_does_is_left_to_it(taken: Modality) -> None:
    assert does(taken=(taken,)) == [each for each in ALL if each != taken]


@pytest.mark.parametrize(
    ("options", "left"),
    [
        ({"speech": False}, ["vision", "decision"]),
        ({"cameras": False}, ["asr", "tts", "decision"]),
        ({"detector": "none"}, ["asr", "tts", "decision"]),
        ({"modalities": "adsb+vision"}, ["tts", "vision", "decision"]),
        ({"modalities": "adsb+asr"}, ["asr", "tts", "decision"]),
    ],
)
def test_nobody_does_what_the_options_leave_out(options: dict[str, Any], left: list[str]) -> None:
    assert does(**options) == left


@pytest.mark.parametrize(
    ("taken", "enhancer", "tasks", "heard"),
    [
        ((), "none", ["asr"], "radio/*/tx"),
        ((), "spectral", ["enhancement", "asr"], "enhanced/*"),
        (("enhancement",), "none", ["asr"], "enhanced/*"),
        (("enhancement",), "spectral", ["asr"], "enhanced/*"),
        (("asr",), "spectral", ["enhancement"], None),
    ],
)
def test_a_recogniser_hears_what_is_enhanced_if_somebody_enhances(
    taken: tuple[Modality, ...], enhancer: str, tasks: list[str], heard: str | None
) -> None:
    workers = team("none", "asr_first", taken, enhancer=enhancer)
    assert [worker.modality for worker in workers] == tasks
    hearing = [worker.inputs[0].key for worker in workers if worker.modality == "asr"]
    assert hearing == ([] if heard is None else [heard])


def test_the_fusion_gate_reads_more_than_the_engine_alone() -> None:
    taken: tuple[Modality, ...] = ("asr", "tts", "vision")
    (alone,), (gated,) = (team("paper", each, taken) for each in ("parallel", "gated_fusion"))
    assert {each.key for each in alone.inputs} < {each.key for each in gated.inputs}


def test_the_least_severity_that_is_spoken_is_that_of_who_decides() -> None:
    def described(modality: Modality, **configuration: Any) -> WorkerDescription:
        description = reference().description
        return description.model_copy(update={"modality": modality, "configuration": configuration})

    usual = speak_min_level([])
    assert usual is Severity.CAUTION
    assert speak_min_level([described("decision", speak_min_level="INFO")]) is Severity.INFO
    assert speak_min_level([described("vision", speak_min_level="INFO")]) is usual
    assert speak_min_level([described("decision")]) is usual


@pytest.mark.parametrize("given", [None, {"speak_min_level": "WARNING"}])
@pytest.mark.parametrize("assistant", ["paper", "reference"])
def test_the_voice_speaks_from_the_severity_on_that_the_assistant_is_given(
    assistant: str, given: dict[str, str] | None
) -> None:
    options = Options(assistant=assistant, tts="espeak", assistant_config=given)
    taken: tuple[Modality, ...] = ("asr", "vision")
    voice, _ = reference_workers(options, load("s02a_headon"), taken)
    warning = CAUTION.model_copy(update={"severity": Severity.WARNING})
    for advisory, is_spoken in ((CAUTION, given is None), (warning, True)):
        told = Input("advisory/AAL123", 0, advisory.model_dump_json().encode())
        assert bool(voice.step(0, [told]).outputs) is is_spoken


@pytest.mark.parametrize(
    ("name", "is_own"),
    [("reference", True), ("paper", True), ("http", False), ("", False), ("theirs", False)],
)
def test_an_engine_is_our_own_if_it_comes_along_and_asks_no_service(
    name: str, is_own: bool
) -> None:
    assert is_own_engine(name) is is_own


@pytest.mark.parametrize(
    ("task", "options", "remote"),
    [
        ("asr", {"asr": SERVICE}, True),
        ("asr", {"tts": SERVICE}, False),
        ("tts", {"tts": SERVICE}, True),
        ("vision", {"detector": SERVICE}, True),
        ("vision", {"detector": "embedded"}, False),
        ("enhancement", {"enhancer": "spectral"}, False),
        ("decision", {}, False),
        ("decision", {"wording": "llm"}, True),
        ("decision", {"assistant": SERVICE}, True),
    ],
)
def test_a_worker_is_remote_if_an_engine_of_it_asks_a_service(
    task: Modality, options: dict[str, Any], remote: bool
) -> None:
    assert is_remote(Options(**{"assistant": "reference"} | options), task) is remote


def test_a_language_model_needs_somebody_who_asks_it_and_the_other_way_round() -> None:
    with pytest.raises(LanguageModelError, match="'llm' asks a language model; expected --llm"):
        team(wording="llm")
    with pytest.raises(LanguageModelError, match="nobody asks the language model"):
        team(llm=f"{SERVICE}/v1")
    assert does(wording="llm", llm=f"{SERVICE}/v1") == ALL
