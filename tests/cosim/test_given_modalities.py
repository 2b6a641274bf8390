"""An assistant can be given fewer modalities; crews, equipment and the rest keep theirs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

import airhilt
from airhilt import Input, Scenario, Step
from airhilt.cosim.equipment import equipment_worker
from airhilt.cosim.option_checks import check_options
from airhilt.cosim.participants import limited
from airhilt.errors import AirhiltError, WorkerError
from airhilt.messages import InputSpec, WorkerDescription
from airhilt.options import Options, options_of
from airhilt.record import RunFolder
from airhilt.sweep.cases import cases
from airhilt.sweep.specification import Specification
from airhilt.workers.pool import Participant
from airhilt.workers.protocol import LocalWorker
from nominal import nominal

NO_SENSES: dict[str, Any] = {"cameras": False, "speech": False, "latency": "fixed"}


class Listens:
    """Decides nothing, and keeps the first chunks of the keys that reach it."""

    description = WorkerDescription(
        name="listener",
        modality="decision",
        inputs=tuple(
            InputSpec(key=key, policy="batch")
            for key in ("briefing", "adsb/*", "asr/*", "radio/*/audio", "status/*")
        ),
    )

    def __init__(self) -> None:
        self.heard: set[str] = set()
        self.states: list[bytes] = []

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        """Return nothing."""
        self.heard |= {each.key.partition("/")[0] for each in inputs}
        self.states += [each.payload for each in inputs if each.key == "status/adsb"]
        return Step()


def heard(scenario: Scenario, folder: Path, modalities: str) -> Listens:
    listener = Listens()
    airhilt.run(scenario, out=folder, workers=[listener], modalities=modalities, **NO_SENSES)
    return listener


def talking(duration_s: float = 30.0) -> Scenario:
    return nominal("s01a_bad_readback").model_copy(update={"duration_s": duration_s})


def test_what_is_not_given_does_not_arrive(tmp_path: Path) -> None:
    given_all = heard(talking(), tmp_path / "all", "adsb+asr+vision")
    given_calls = heard(talking(), tmp_path / "calls", "asr")
    given_reports = heard(talking(), tmp_path / "reports", "adsb")
    assert given_all.heard == {"briefing", "status", "adsb", "asr", "radio"}
    assert given_calls.heard == {"briefing", "status", "asr", "radio"}
    assert given_reports.heard == {"briefing", "status", "adsb"}
    assert b'"state":"on"' in given_all.states[0]
    assert b'"state":"off"' in given_calls.states[0]


@pytest.mark.slow
def test_the_world_is_the_same_whatever_the_assistant_is_given(tmp_path: Path) -> None:
    def truth(modalities: str) -> Any:
        out = tmp_path / modalities
        summary = airhilt.run(
            talking(), out=out, assistant="conflict_alert", modalities=modalities, **NO_SENSES
        ).summary
        return summary.closest_approach, summary.radio.transmissions

    assert truth("adsb") == truth("adsb+asr")


def test_workers_that_nobody_needs_do_not_run(tmp_path: Path) -> None:
    def working(**options: Any) -> set[str]:
        folder = airhilt.run(
            talking(1.0), out=tmp_path / "run", overwrite=True, cameras=False, **options
        ).folder
        return {one.description.modality for one in RunFolder(folder).info().workers}

    assert working(modalities="adsb") == {"decision", "tts"}
    assert working(modalities="adsb", topology="asr_first") == {"decision", "tts", "asr"}


def test_evidence_that_was_not_given_has_no_age(encounter: Scenario, tmp_path: Path) -> None:
    short = encounter.model_copy(update={"duration_s": 10.0})
    summary = airhilt.run(short, out=tmp_path / "run", modalities="asr", **NO_SENSES).summary
    assert "adsb" not in summary.evidence
    assert summary.modalities["adsb"] == "off"


def test_equipment_of_the_world_keeps_its_inputs() -> None:
    worker = LocalWorker(equipment_worker("conflict_alert"))
    equipment = Participant(worker.description, worker, "in process")
    assert limited(equipment, {"asr"}) == equipment


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"assistant": "adsb_only", "modalities": "asr"}, "reads adsb, so nothing is left"),
        ({"assistant": "well_clear", "modalities": "vision"}, "reads adsb, so nothing is left"),
        ({"assistant": "none", "modalities": "asr"}, "--modalities 'asr' would do nothing"),
        ({"modalities": "adsb+sonar"}, "expected some of adsb, asr and vision"),
        ({"modalities": ""}, "expected some of adsb, asr and vision"),
    ],
)
def test_what_makes_no_sense_is_refused(
    options: dict[str, Any], words: str, encounter: Scenario
) -> None:
    with pytest.raises(AirhiltError, match=words):
        check_options(options_of(options), encounter)


@pytest.mark.parametrize("assistant", ["tcas", "runway_status_lights"])
def test_what_an_assistant_does_not_read_may_be_withheld(
    assistant: str, encounter: Scenario
) -> None:
    check_options(Options(assistant=assistant, modalities="asr"), encounter)


def test_a_worker_of_the_caller_that_is_left_with_nothing_is_named(
    encounter: Scenario, tmp_path: Path
) -> None:
    with pytest.raises(WorkerError, match=r"assistant .listener. reads adsb\+asr"):
        airhilt.run(
            encounter, out=tmp_path / "run", workers=[Listens()], modalities="vision", **NO_SENSES
        )


def test_modalities_are_an_axis_of_sweeps() -> None:
    found = cases(
        Specification(
            scenarios=("s02a_headon",), axes={"modalities": ("adsb+asr", "asr+adsb", "adsb")}
        )
    )
    assert [case.parameters["modalities"] for case in found] == ["adsb+asr", "adsb+asr", "adsb"]
