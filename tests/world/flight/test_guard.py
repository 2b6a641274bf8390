"""A flight that cannot go on ends with a named cause, and stays ended."""

from __future__ import annotations

import math

import pytest

from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT
from airhilt.world.flight.guard import (
    FlightGuard,
)
from flights import in_cruise, states


def test_flying_into_the_ground_ends_with_ground_contact() -> None:
    aircraft = in_cruise("c172p", altitude_ft=2_000, terrain_elevation_m=500.0)
    aircraft.en_route.hold_altitude(0.0, 1_000 * FOOT_PER_MINUTE)
    for state in states(aircraft, 60):
        assert state.height_agl_m > 0.0
    assert aircraft.ended == "ground_contact"
    last = aircraft.state
    assert last.height_agl_m < 1.0
    aircraft.advance()
    assert aircraft.state is last


def test_the_guard_names_the_cause(subtests: pytest.Subtests) -> None:
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


def test_a_state_that_is_not_finite_ends_the_flight(monkeypatch: pytest.MonkeyPatch) -> None:
    aircraft = in_cruise("737")
    good = aircraft.state
    monkeypatch.setattr(
        type(aircraft._airframe), "state", lambda _: good._replace(altitude_m=math.nan)
    )
    aircraft.advance()
    assert aircraft.ended == "state_not_finite"
    assert aircraft.state is good
