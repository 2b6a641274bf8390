"""A flight that cannot go on ends with a named cause, and stays ended."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT
from airhilt.world.flight import load_aircraft_type
from airhilt.world.flight.guard import (
    BANK_LIMIT,
    OVERSPEED_FACTOR,
    OVERSPEED_MACH,
    PITCH_LIMIT,
    SINK_FACTOR,
    STALL_FACTOR,
    FlightGuard,
)
from stand_ins import state_at


def test_flying_into_the_ground_ends_with_ground_contact(
    in_cruise: Callable[..., Any], states: Callable[..., Any]
) -> None:
    aircraft = in_cruise("c172p", altitude_ft=2_000, terrain_elevation_m=500.0)
    aircraft.en_route.hold_altitude(0.0, 1_000 * FOOT_PER_MINUTE)
    for state in states(aircraft, 60):
        assert state.height_agl_m > 0.0
    assert aircraft.ended == "ground_contact"
    last = aircraft.state
    assert last.height_agl_m < 1.0
    aircraft.advance()
    assert aircraft.state is last


def test_the_guard_names_the_cause(
    subtests: pytest.Subtests, in_cruise: Callable[..., Any]
) -> None:
    for change, cause in [
        ({"altitude_m": math.nan}, "state_not_finite"),
        ({"ecef_z_m": -math.inf}, "state_not_finite"),
        ({"height_agl_m": -0.1}, "ground_contact"),
        ({"roll_rad": -80 * DEGREE}, "envelope_exceeded: bank -80 deg"),
        ({"pitch_rad": 50 * DEGREE}, "envelope_exceeded: pitch 50 deg"),
        ({"calibrated_airspeed_m_s": 80 * KNOT}, "envelope_exceeded: stall at 80 kt"),
        ({"calibrated_airspeed_m_s": 420 * KNOT}, "envelope_exceeded: airspeed 420 kt"),
        ({"mach": 0.95}, "envelope_exceeded: Mach 0.95"),
        (
            {"velocity_down_m_s": 15_000 * FOOT_PER_MINUTE},
            "envelope_exceeded: sink rate 15000 fpm",
        ),
        ({"roll_rad": 40 * DEGREE, "altitude_m": 100 * FOOT}, None),
    ]:
        with subtests.test(str((change, cause))):
            aircraft = in_cruise("737")
            assert FlightGuard(aircraft.kind).check(aircraft.state._replace(**change)) == cause


def test_only_the_wheels_may_touch_the_ground_and_softly(
    subtests: pytest.Subtests, on_the_ground: Callable[..., Any]
) -> None:
    for change, cause in [
        ({}, None),
        ({"calibrated_airspeed_m_s": 20 * KNOT, "true_airspeed_m_s": 20 * KNOT}, None),
        ({"velocity_down_m_s": 13 * FOOT}, "ground_contact"),
        ({"pitch_rad": 15 * DEGREE}, "ground_contact"),
        ({"roll_rad": -14 * DEGREE}, "ground_contact"),
        ({"height_agl_m": -1.2}, "ground_contact"),
    ]:
        with subtests.test(str((change, cause))):
            aircraft = on_the_ground("737")
            state = aircraft.state._replace(**change)
            assert FlightGuard(aircraft.kind).check(state, may_touch=True, on_ground=True) == cause


def test_a_hop_on_the_takeoff_roll_is_no_stall(on_the_ground: Callable[..., Any]) -> None:
    aircraft = on_the_ground("737")
    hop = aircraft.state._replace(height_agl_m=0.5, calibrated_airspeed_m_s=70 * KNOT)
    guard = FlightGuard(aircraft.kind)
    assert guard.check(hop, may_touch=True, on_ground=False) is None
    assert guard.check(hop, may_touch=False, on_ground=True) == "ground_contact"


def test_a_state_that_is_not_finite_ends_the_flight(
    in_cruise: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    aircraft = in_cruise("737")
    good = aircraft.state
    monkeypatch.setattr(
        type(aircraft._airframe), "state", lambda _: good._replace(altitude_m=math.nan)
    )
    aircraft.advance()
    assert aircraft.ended == "state_not_finite"
    assert aircraft.state is good


def test_a_flight_that_has_just_reached_a_limit_ends_with_the_name_of_that_limit(
    subtests: pytest.Subtests,
) -> None:
    for limit, named in [
        ({"roll_rad": BANK_LIMIT}, "bank"),
        ({"pitch_rad": -PITCH_LIMIT}, "pitch"),
        ({"calibrated_airspeed_m_s": STALL_FACTOR * 143 * KNOT}, "stall"),
        ({"calibrated_airspeed_m_s": OVERSPEED_FACTOR * 340 * KNOT}, "airspeed"),
        ({"mach": 0.82 + OVERSPEED_MACH}, "Mach"),
        ({"velocity_down_m_s": SINK_FACTOR * 4_000 * FOOT_PER_MINUTE}, "sink rate"),
    ]:
        with subtests.test(named):
            state = state_at(altitude_m=3_000.0, speed_m_s=250 * KNOT)._replace(**limit)
            cause = FlightGuard(load_aircraft_type("737")).check(state)
            assert str(cause).startswith(f"envelope_exceeded: {named}")
