"""What the baselines for runways make of whole runs, without cameras and speech."""

from __future__ import annotations

from pathlib import Path

import pytest

from airhilt import run
from airhilt.cosim.replay import replay
from airhilt.metrics.summary import Summary
from airhilt.record import read_log
from nominal import nominal


def go(scenario: str, assistant: str, folder: Path, equipment: tuple[str, ...] = ()) -> Summary:
    return run(
        nominal(scenario), out=folder, latency="fixed", cameras=False, speech=False,
        assistant=assistant, equipment=equipment,
    ).summary  # fmt: skip


def recipients(folder: Path) -> set[str]:
    keys = {message.key for message in read_log(folder / "log.mcap")}
    return {key.partition("/")[2] for key in keys if key.startswith("advisory/")}


def test_surf_a_lets_a_crew_go_around_before_a_driver_who_drives_on(tmp_path: Path) -> None:
    summary = go("s01b_noncompliance", "surf_a", tmp_path / "run")
    assert not summary.collision
    assert recipients(tmp_path / "run") == {"AAL123"}
    assert replay(tmp_path / "run").identical


@pytest.mark.slow
def test_intersection_lights_stop_a_crew_that_takes_off_across_a_landing(tmp_path: Path) -> None:
    summary = go("s01a_intersecting", "runway_status_lights", tmp_path / "run")
    assert summary.avoided
    assert recipients(tmp_path / "run") == {"DAL456"}
    assert replay(tmp_path / "run").identical


def test_the_lights_of_the_airport_stop_it_without_an_assistant_too(tmp_path: Path) -> None:
    lights = ("runway_status_lights",)
    assert not go("s01a_intersecting", "none", tmp_path / "run", lights).collision


@pytest.mark.slow
@pytest.mark.parametrize("assistant", ["surf_a", "runway_status_lights"])
def test_where_everybody_holds_short_nobody_is_disturbed(assistant: str, tmp_path: Path) -> None:
    assert go("s01b_nominal", assistant, tmp_path / "run").nuisance_alerts == 0
