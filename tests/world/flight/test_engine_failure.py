"""An aircraft that lost an engine flies on, drifts down to what it can keep, or comes down fast."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, wrap_angle
from airhilt.world.flight.procedures.en_route import DriftDown
from breadth import mostly_slow
from flights import RUNWAY, in_cruise, on_final, states
from stand_ins import state_at


def test_a_twin_drifts_down_at_its_speed_on_its_heading() -> None:
    aircraft = in_cruise("737")
    heading = aircraft.state.heading_rad
    aircraft.fail_engine(0)
    aircraft.procedures.drift_down()
    assert aircraft.phase == "drift_down"
    flown = list(states(aircraft, 400))
    assert max(abs(wrap_angle(state.heading_rad - heading)) for state in flown) < 1.1 * DEGREE
    settled = flown[60 * 20 :]
    assert max(abs(wrap_angle(state.heading_rad - heading)) for state in settled) < 0.2 * DEGREE
    assert flown[-1].calibrated_airspeed_m_s == pytest.approx(220 * KNOT, abs=3 * KNOT)
    assert -800 < flown[-1].vertical_rate_m_s / FOOT_PER_MINUTE < -300
    assert max(state.altitude_m for state in flown) < 35_000 * FOOT + 15.0


def test_it_levels_where_the_other_engine_keeps_it() -> None:
    aircraft = in_cruise("737", altitude_ft=28_000, airspeed_kt=225)
    aircraft.fail_engine(1)
    aircraft.procedures.drift_down()
    *_, before = states(aircraft, 900)
    assert aircraft.phase == "en_route"
    *_, after = states(aircraft, 60)
    assert after.altitude_m == pytest.approx(before.altitude_m, abs=60 * FOOT)
    assert after.altitude_m > 24_000 * FOOT


@pytest.mark.parametrize("name", ["737", "B747"])
@pytest.mark.parametrize("engine", [0, 1])
def test_cruise_goes_on_under_control(name: str, engine: int) -> None:
    aircraft = in_cruise(name, altitude_ft=15_000, airspeed_kt=260)
    aircraft.fail_engine(engine)
    for state in states(aircraft, 120):
        assert abs(state.roll_rad) < 10 * DEGREE
        assert abs(wrap_angle(state.track_rad - 60 * DEGREE)) < 3 * DEGREE
    assert state.altitude_m == pytest.approx(15_000 * FOOT, abs=50 * FOOT)
    assert state.calibrated_airspeed_m_s == pytest.approx(260 * KNOT, abs=5 * KNOT)


def test_a_go_around_goes_on_with_one_engine() -> None:
    aircraft = on_final("737", distance_nm=1.0)
    aircraft.procedures.land(RUNWAY)
    *_, _ = states(aircraft, 10)
    aircraft.procedures.go_around(900.0)
    *_, _ = states(aircraft, 10)
    aircraft.fail_engine(0)
    low = min(state.height_agl_m for state in states(aircraft, 300))
    assert aircraft.ended is None
    assert low > 20.0
    assert aircraft.state.altitude_m == pytest.approx(900.0, abs=20.0)
    assert abs(wrap_angle(aircraft.state.track_rad - RUNWAY.course_rad)) < 1 * DEGREE


def test_a_single_without_its_engine_glides() -> None:
    aircraft = in_cruise("c172p")
    aircraft.fail_engine(0)
    aircraft.procedures.drift_down()
    *_, state = states(aircraft, 90)
    assert aircraft.phase == "drift_down"
    assert state.calibrated_airspeed_m_s == pytest.approx(65 * KNOT, abs=2 * KNOT)
    assert -1_000 < state.vertical_rate_m_s / FOOT_PER_MINUTE < -500


def test_an_engine_that_is_not_there_is_named() -> None:
    for engine in (-1, 2):
        with pytest.raises(ValueError, match=f"engine is {engine}; expected 0 to 1"):
            in_cruise("737").fail_engine(engine)


@pytest.mark.parametrize("name", mostly_slow(["737", "B747"], "737"))
def test_an_emergency_descent_loses_4000_feet_a_minute_and_levels_off(name: str) -> None:
    aircraft = in_cruise(name)
    aircraft.procedures.emergency_descent(10_000 * FOOT)
    seconds = 0.0
    for _ in states(aircraft, 25_000 / 4_000 * 60):
        seconds += 0.05
        assert aircraft.ended is None
        if aircraft.phase == "en_route":
            break
    assert aircraft.phase == "en_route"
    assert (35_000 * FOOT - aircraft.state.altitude_m) / seconds > 4_000 * FOOT_PER_MINUTE
    *_, state = states(aircraft, 90)
    assert state.altitude_m == pytest.approx(10_000 * FOOT, abs=50 * FOOT)


@pytest.mark.parametrize(
    ("lever", "rate_fpm", "is_kept"),
    [(1.0, -99.0, True), (1.0, -101.0, False), (1.0, 50.0, True), (0.99, -50.0, False)],
)
def test_engines_at_full_thrust_keep_an_altitude_that_costs_less_than_100_ft_min(
    lever: float, rate_fpm: float, is_kept: bool
) -> None:
    state = state_at(speed_m_s=100.0)
    climb = rate_fpm * FOOT_PER_MINUTE / 100.0
    autopilot = SimpleNamespace(lever=lever, potential_climb=climb)
    systems = SimpleNamespace(autopilot=autopilot)
    assert DriftDown(cast(Any, systems), cast(Any, None))._kept(state) is is_kept
