"""Cockpit instruments: what an aircraft shows its own crew, in runs that ask for it."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest

from airhilt import load
from airhilt.cosim.replay import replay
from airhilt.cosim.simulation import run
from airhilt.errors import ScenarioError
from airhilt.messages import ActorTruth, CockpitInstruments
from airhilt.options import Options
from airhilt.record import read_log
from airhilt.scenario import Scenario
from airhilt.sensors.cockpit import instruments_of
from airhilt.units import DEGREE, FOOT, KNOT, SECOND_NS
from airhilt.world.flight import (
    Aircraft,
    AircraftState,
    InitialCondition,
    load_aircraft_type,
)
from airhilt.world.flight.state import Atmosphere
from airhilt.world.loading import load_text
from shortened import shortened


def asking(scenario: Scenario, *callsigns: str, seconds: float = 10.0) -> Scenario:
    document = shortened(scenario.model_dump(mode="json"), seconds) | {"cameras": []}
    document["cockpits"] = callsigns
    return load_text(json.dumps(document), scenario.name)


def go(scenario: Scenario, folder: Path) -> list[CockpitInstruments]:
    run(scenario, Options(out=folder, latency="fixed", speech=False, cameras=False))
    return read(folder)


@pytest.fixture(scope="module")
def flown(encounter: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("cockpit") / "run"
    assert go(asking(encounter, "AAL123"), folder)
    return folder


def read(folder: Path) -> list[CockpitInstruments]:
    log = read_log(folder / "log.mcap")
    return [
        CockpitInstruments.model_validate_json(m.data) for m in log if m.key == "cockpit/AAL123"
    ]


def test_instruments_are_published_five_times_a_second(flown: Path) -> None:
    times = [shown.t_ns for shown in read(flown)]
    assert len(times) >= 50
    assert {b - a for a, b in itertools.pairwise(times)} == {SECOND_NS // 5}


def test_they_show_the_state_of_their_own_aircraft(flown: Path) -> None:
    truth = {
        m.t_ns: ActorTruth.model_validate_json(m.data)
        for m in read_log(flown / "log.mcap")
        if m.key == "truth/state/AAL123"
    }
    for shown in read(flown):
        true = truth[shown.t_ns]
        assert shown.altitude_ft == pytest.approx(true.altitude_m / FOOT, abs=0.51)
        assert true.calibrated_airspeed_m_s is not None
        assert shown.airspeed_kt == pytest.approx(true.calibrated_airspeed_m_s / KNOT, abs=0.051)
        assert shown.heading_deg == pytest.approx(true.heading_deg, abs=0.051)
        assert shown.mode == true.phase
        assert (shown.gear, shown.flaps, shown.on_ground) == (0.0, 0.0, False)


def test_no_other_aircraft_shows_its_instruments(flown: Path) -> None:
    keys = {m.key for m in read_log(flown / "log.mcap") if m.key.startswith("cockpit/")}
    assert keys == {"cockpit/AAL123"}


def test_a_replay_shows_the_same(flown: Path) -> None:
    assert replay(flown).identical


def test_there_are_none_unless_the_scenario_asks(encounter: Scenario, tmp_path: Path) -> None:
    assert go(asking(encounter, seconds=2.0), tmp_path / "run") == []


def test_at_an_airport_the_compass_is_magnetic(tmp_path: Path) -> None:
    shown = go(asking(load("s01a_bad_readback"), "AAL123", seconds=3.0), tmp_path / "run")
    truth = next(
        ActorTruth.model_validate_json(m.data)
        for m in read_log(tmp_path / "run" / "log.mcap")
        if m.key == "truth/state/AAL123"
    )
    assert {one.north for one in shown} == {"magnetic"}
    # Washington's variation is about 10 degrees west.
    assert (shown[0].heading_deg - truth.heading_deg) % 360.0 == pytest.approx(10.5, abs=1.5)


@pytest.mark.parametrize("callsign", ["AAL999", "DEER1"])
def test_only_aircraft_of_the_scenario_have_a_cockpit(callsign: str) -> None:
    with pytest.raises(ScenarioError, match=f"no aircraft '{callsign}'"):
        asking(load("s01c_deer_delayed_warning"), callsign)


def test_every_type_of_aircraft_shows_gear_and_flaps(subtests: pytest.Subtests) -> None:
    for name in ["737", "B747", "c172p", "c310"]:
        with subtests.test(name):
            kind = load_aircraft_type(name)
            aircraft = Aircraft(
                kind,
                InitialCondition(
                    38.9 * DEGREE, -77.0 * DEGREE, 900.0, 0.0, kind.speeds.approach_kt * KNOT,
                    on_approach=True,
                ),
                seed=1,
                atmosphere=Atmosphere(),
            )  # fmt: skip
            for _ in range(20):
                aircraft.advance()
            shown = instruments_of("N1", aircraft, None)
            assert shown.north == "true"
            assert shown.gear == 1.0
            assert shown.radio_height_ft is None
            assert shown.selected_airspeed_kt == pytest.approx(kind.speeds.approach_kt, abs=1.0)
            assert shown.flaps == pytest.approx(kind.landing.flaps, abs=0.05)


def shown_at(**state: float) -> CockpitInstruments:
    """Return the instruments of an aircraft in a state, which is to climb to FL 101."""
    still = dict.fromkeys(AircraftState._fields, 0.0)
    aircraft = SimpleNamespace(
        state=AircraftState(**{**still, **state}), gear=0.254, flaps=1 / 3,
        on_ground=False, phase="en_route",
        target_altitude_m=10_100 * FOOT, target_speed_m_s=251 * KNOT,
    )  # fmt: skip
    return instruments_of("N1", cast(Aircraft, aircraft), None)


def test_a_radio_altimeter_shows_heights_up_to_2500_ft(subtests: pytest.Subtests) -> None:
    """The range of ARINC 707 ends there: 762 m."""
    for height_ft, shown_ft in [(0, 0), (50, 50), (2499, 2499), (2500, 2500), (2501, None)]:
        with subtests.test(str((height_ft, shown_ft))):
            assert shown_at(height_agl_m=height_ft * 762.0 / 2500.0).radio_height_ft == shown_ft


def test_an_attitude_is_shown_to_a_tenth_of_a_degree() -> None:
    shown = shown_at(pitch_rad=math.radians(1.26), roll_rad=math.radians(-3.14))
    assert (shown.pitch_deg, shown.roll_deg) == (1.3, -3.1)


@pytest.mark.parametrize(("degrees", "shown_deg"), [(359.94, 359.9), (359.96, 0.0), (0.04, 0.0)])
def test_a_heading_is_less_than_360_degrees(degrees: float, shown_deg: float) -> None:
    assert shown_at(heading_rad=math.radians(degrees)).heading_deg == shown_deg


def test_instruments_show_the_units_of_a_cockpit_to_the_step_that_their_names_say() -> None:
    shown = shown_at(
        velocity_north_m_s=30.0, velocity_east_m_s=-40.0, velocity_down_m_s=-5.0,
        calibrated_airspeed_m_s=70.0, mach=0.78549, altitude_m=3_000.0,
        heading_rad=math.radians(271.26),
    )  # fmt: skip
    assert shown.ground_speed_kt == 97.2  # 50 m/s
    assert shown.airspeed_kt == 136.1
    assert shown.mach == 0.785
    assert shown.altitude_ft == 9843
    assert shown.vertical_speed_fpm == 984
    assert shown.track_deg == pytest.approx(306.87, abs=0.1)
    assert shown.heading_deg == pytest.approx(271.26, abs=0.1)
    assert (shown.selected_altitude_ft, shown.selected_airspeed_kt) == (10_100, 251)
    assert (shown.gear, shown.flaps) == (0.25, 0.33)


def test_a_vehicle_shows_its_driver_where_it_is(tmp_path: Path) -> None:
    scenario = load("s01b_nominal").model_copy(update={"duration_s": 3.0, "cameras": ()})
    run(scenario, Options(out=tmp_path / "run", latency="fixed", speech=False, cockpit=True))
    log = list(read_log(tmp_path / "run" / "log.mcap"))
    shown = [json.loads(m.data) for m in log if m.key == "cockpit/OPS1/position"]
    true = {m.t_ns: json.loads(m.data) for m in log if m.key == "truth/state/OPS1"}
    assert len(shown) >= 15
    for one in shown:
        there = true[one["t_ns"]]
        assert one["latitude_deg"] == pytest.approx(there["latitude_deg"], abs=1e-6)
        assert one["heading_deg"] == pytest.approx(there["heading_deg"], abs=0.1)
