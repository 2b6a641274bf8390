"""Sensors that options ask for: where they stand, and that a scenario's own ones stay."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from airhilt import load
from airhilt.cosim.replay import replay
from airhilt.cosim.requested import requested_scenario
from airhilt.cosim.simulation import run
from airhilt.messages import RadarKind
from airhilt.options import Options
from airhilt.record import RunFolder, read_log
from airhilt.scenario import Scenario
from airhilt.surveillance.radar import MAXIMUM_ELEVATION_RAD, RADARS, Antenna
from airhilt.units import FOOT
from airhilt.world.site import FixedSite, ScenarioSite


def requested(name: str, kind: RadarKind) -> tuple[Scenario, ScenarioSite]:
    scenario = requested_scenario(Options(radar=kind), load(name))
    return scenario, ScenarioSite.of(scenario)


def test_without_options_the_scenario_stays_as_it_is() -> None:
    scenario = load("s02a_headon")
    assert requested_scenario(Options(), scenario) == scenario


def test_a_terminal_radar_stands_at_the_airport() -> None:
    scenario, site = requested("s01a_bad_readback", "terminal")
    assert site.place(scenario.radars[0].position) == site.place(site.centre)


@pytest.mark.parametrize("kind", ["terminal", "en_route"])
def test_the_centre_of_an_en_route_scene_is_not_in_the_cone_of_silence(kind: RadarKind) -> None:
    scenario, site = requested("s02a_headon", kind)
    declared = scenario.radars[0]
    antenna = Antenna(*site.place(declared.position), declared.antenna_height_ft * FOOT)
    over_the_centre = FixedSite(*site.place(site.centre), 41_000.0 * FOOT)
    seen = antenna.to(over_the_centre)
    assert seen.elevation_rad < MAXIMUM_ELEVATION_RAD
    assert RADARS[kind].minimum_range_m < seen.range_m < RADARS[kind].primary_range_m


def test_a_radar_of_the_scenario_with_that_name_stays() -> None:
    scenario, _ = requested("s02a_headon", "terminal")
    moved = scenario.radars[0].model_copy(update={"antenna_height_ft": 20.0})
    own = scenario.model_copy(update={"radars": (moved,)})
    assert requested_scenario(Options(radar="terminal"), own).radars == (moved,)
    assert len(requested_scenario(Options(radar="en_route"), own).radars) == 2


def test_a_radar_of_another_kind_with_that_name_does_not_stand_in_for_it() -> None:
    scenario, _ = requested("s02a_headon", "terminal")
    misnamed = scenario.radars[0].model_copy(update={"kind": "en_route"})
    own = scenario.model_copy(update={"radars": (misnamed,)})
    radars = requested_scenario(Options(radar="terminal"), own).radars
    assert [(radar.name, radar.kind) for radar in radars] == [
        ("terminal", "en_route"), ("terminal_2", "terminal"),
    ]  # fmt: skip


def test_all_aircraft_and_nothing_else_show_their_instruments() -> None:
    scenario = requested_scenario(Options(cockpit=True), load("s01c_deer_delayed_warning"))
    assert scenario.cockpits == ("AAL123",)


def test_a_run_with_these_options_has_them_and_a_replay_too(
    encounter: Scenario, tmp_path: Path
) -> None:
    scenario = encounter.model_copy(update={"duration_s": 12.0})
    options = Options(
        out=tmp_path / "run", latency="fixed", speech=False, radar="terminal", cockpit=True
    )
    folder = RunFolder(run(scenario, options).folder)
    log = list(read_log(folder.log_path))
    plots = [json.loads(m.data) for m in log if m.key == "radar/terminal"]
    assert {plot["mode_a"] for plot in plots} >= {"1325"}
    assert {m.key for m in log if m.key.startswith("cockpit/")} == {
        "cockpit/AAL123", "cockpit/DAL456",
    }  # fmt: skip
    assert folder.info().realised["radars"][0]["kind"] == "terminal"
    assert replay(folder.path).identical
