"""Equipment of the world: it warns its own recipients, and never counts for the assistant."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import airhilt
from airhilt import Input, Output, Step
from airhilt.cosim.replay import replay
from airhilt.errors import AirhiltError, WorkerError
from airhilt.messages import (
    EquipmentAlert,
    InputSpec,
    Modality,
    WorkerDescription,
)
from airhilt.record import Logged, RunFolder, read_log
from airhilt.units import SECOND_NS
from meetings import meeting

QUIET: dict[str, Any] = {"latency": "fixed", "speech": False, "cameras": False}


def alerts(log: list[Logged]) -> list[tuple[Logged, EquipmentAlert]]:
    return [
        (logged, EquipmentAlert.model_validate_json(logged.data))
        for logged in log
        if logged.key.startswith("equipment/")
    ]


@pytest.fixture(scope="module")
def equipped(tmp_path_factory: pytest.TempPathFactory) -> airhilt.Result:
    """A run without an assistant, with TCAS II aboard of both and the controller's alert."""
    return airhilt.run(
        meeting(equipment=["tcas", "conflict_alert"], tcas=["AAL123", "DAL456"]),
        out=tmp_path_factory.mktemp("equipment") / "run", assistant="none", **QUIET,
    )  # fmt: skip


def test_without_equipment_the_two_collide(tmp_path: Path) -> None:
    summary = airhilt.run(meeting(), out=tmp_path / "run", assistant="none", **QUIET).summary
    assert summary.collision
    assert summary.equipment == []


def test_tcas_keeps_the_two_from_a_near_collision_without_any_assistant(
    equipped: airhilt.Result,
) -> None:
    summary = equipped.summary
    assert (summary.nmac, summary.collision) == (False, False)
    assert summary.closest_approach is not None
    assert summary.closest_approach.vertical_m > 150.0
    assert summary.modalities["equipment"] == "on"


def test_it_tells_its_own_recipients_on_keys_of_its_own(equipped: airhilt.Result) -> None:
    log = list(read_log(equipped.folder / "log.mcap"))
    assert not [logged for logged in log if logged.key.startswith(("advisory/", "tts/"))]
    found = {(logged.key, logged.publisher) for logged, _ in alerts(log)}
    assert found == {
        ("equipment/tcas/AAL123", "equipment-tcas"),
        ("equipment/tcas/DAL456", "equipment-tcas"),
        ("equipment/conflict_alert/ATC", "equipment-conflict_alert"),
    }


def test_the_summary_says_what_equipment_warned_when(equipped: airhilt.Result) -> None:
    summary = equipped.summary
    tcas, conflict_alert = summary.equipment
    assert (tcas.equipment, conflict_alert.equipment) == ("tcas", "conflict_alert")
    assert tcas.t_first_warning_s is not None
    assert tcas.t_first_action_s is not None
    assert tcas.t_first_warning_s < tcas.t_first_action_s
    assert conflict_alert.t_first_warning_s is not None
    assert conflict_alert.t_first_warning_s < tcas.t_first_warning_s
    assert conflict_alert.t_first_action_s is None


def test_nothing_of_it_counts_for_the_assistant(equipped: airhilt.Result) -> None:
    summary = equipped.summary
    assert summary.t_first_warning_s is None
    assert summary.advisories == []
    assert summary.nuisance_alerts == 0
    assert summary.avoided is not True


@pytest.mark.slow
def test_a_collision_that_equipment_has_averted_does_not_make_the_scenario_a_bad_one(
    tmp_path: Path,
) -> None:
    conflict = meeting().model_dump(mode="json")["conflict"] | {"unassisted": "collision"}
    summary = airhilt.run(
        meeting(conflict=conflict), out=tmp_path / "run", assistant="none", equipment=("tcas",),
        **QUIET,
    ).summary  # fmt: skip
    assert not summary.collision
    assert summary.unassisted_as_declared is None


def test_a_scenario_with_unknown_equipment_is_not_valid(
    airhilt_command: Any, tmp_path: Path
) -> None:
    path = tmp_path / "unknown.json"
    path.write_text(meeting(equipment=["radar_lights"]).model_dump_json())
    done = airhilt_command("validate", path)
    assert done.returncode == 2
    assert "radar_lights" in done.stderr
    assert "Traceback" not in done.stderr


def test_the_report_has_its_alerts(equipped: airhilt.Result) -> None:
    page = (equipped.folder / "report.html").read_text()
    assert "tcas: climb, climb" in page or "tcas: descend, descend" in page


@pytest.fixture(scope="module")
def slow(tmp_path_factory: pytest.TempPathFactory) -> airhilt.Result:
    """A run whose assistant is 20 s late, with equipment that the options ask for."""
    return airhilt.run(
        meeting(), out=tmp_path_factory.mktemp("slow") / "run", assistant="adsb_only",
        equipment=("tcas",), **QUIET | {"latency": "fixed,decision=fixed:20"},
    )  # fmt: skip


@pytest.mark.slow
def test_equipment_is_no_later_if_the_assistant_is(slow: airhilt.Result) -> None:
    log = list(read_log(slow.folder / "log.mcap"))
    assert all(logged.t_ns - alert.advisory.t_ready_ns < SECOND_NS for logged, alert in alerts(log))
    assert RunFolder(slow.folder).info().realised["equipment"] == ["tcas"]
    assert replay(slow.folder).identical


@pytest.mark.slow
def test_the_margin_is_from_the_warning_of_the_assistant_to_that_of_the_equipment(
    slow: airhilt.Result,
) -> None:
    summary = slow.summary
    (tcas,) = summary.equipment
    assert summary.t_first_warning_s is not None
    assert tcas.t_first_warning_s is not None
    assert tcas.margin_s == pytest.approx(tcas.t_first_warning_s - summary.t_first_warning_s)
    assert tcas.margin_s < 0.0


@pytest.mark.parametrize(
    ("equipment", "problem"),
    [
        (("radar_lights",), "equipment 'radar_lights': there is none of that name"),
        (("tcas", "tcas:hmd"), "is there twice"),
        (("tcas:all",), "expected tcas or tcas:hmd"),
    ],
)
def test_equipment_that_cannot_be_is_refused_before_the_run(
    equipment: tuple[str, ...], problem: str, tmp_path: Path
) -> None:
    with pytest.raises(AirhiltError, match=problem):
        airhilt.run(meeting(), out=tmp_path / "run", equipment=equipment, **QUIET)
    assert not (tmp_path / "run").exists()


class Poses:
    """A worker that publishes on the key of equipment."""

    def __init__(self, modality: Modality) -> None:
        self.description = WorkerDescription(
            name="poses", modality=modality, inputs=(InputSpec(key="adsb/*", policy="batch"),)
        )  # fmt: skip

    def step(self, t_ns: int, inputs: Any) -> Step:
        """Publish an alert."""
        alert: Any = {
            "equipment": "tcas",
            "advisory": {
                "id": "poses-1", "revision": 0, "recipient": "AAL123", "recipients": ["AAL123"],
                "kind": "loss_of_separation", "severity": "WARNING", "traffic": ["AAL123"],
                "message": "climb", "evidence": {"sources": ["adsb"]}, "t_ready_ns": t_ns,
            },
        }  # fmt: skip
        payload = EquipmentAlert.model_validate(alert).model_dump_json().encode()
        assert all(isinstance(each, Input) for each in inputs)
        return Step((Output("equipment/tcas/AAL123", payload),))


def test_no_worker_of_the_user_poses_as_equipment(tmp_path: Path) -> None:
    with pytest.raises(WorkerError, match="has the modality 'equipment'"):
        airhilt.run(meeting(), out=tmp_path / "a", workers=[Poses("equipment")], **QUIET)
    with pytest.raises(WorkerError, match="only equipment of the world publishes there"):
        airhilt.run(meeting(), out=tmp_path / "b", workers=[Poses("decision")], **QUIET)
