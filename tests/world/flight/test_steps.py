"""A flight that never lands takes fewer steps, and is the same flight."""

from __future__ import annotations

import math

import pytest

from airhilt.units import DEGREE, KNOT, wrap_angle
from airhilt.world.flight import load_aircraft_type
from airhilt.world.flight.airframe import Airframe
from airhilt.world.flight.state import InitialCondition
from flights import in_cruise, states


@pytest.mark.parametrize("steps_hz", [60, 120])
def test_the_gear_of_a_737_takes_five_seconds_whatever_the_step(steps_hz: int) -> None:
    kind = load_aircraft_type("737")
    airframe = Airframe(kind, step_s=1 / steps_hz, seed=1, terrain_elevation_m=0.0)
    airframe.start(InitialCondition(0.8, 0.1, 3000.0, 0.0, 250 * KNOT), 0.0)
    airframe.set_gear(1.0)
    steps = 0
    while airframe.gear() < 1.0:
        airframe.step()
        steps += 1
    assert steps / steps_hz == pytest.approx(5.0, abs=0.1)


def test_it_flies_where_it_flies_at_an_airport(name: str) -> None:
    often, seldom = (in_cruise(name, may_land=may_land) for may_land in (True, False))
    for aircraft in (often, seldom):
        control = aircraft.en_route
        control.turn_by(70 * DEGREE)
        control.hold_altitude(aircraft.state.altitude_m - 600.0)
        control.hold_speed(aircraft.target_speed_m_s + 5.0)
    for one, other in zip(states(often, 150), states(seldom, 150), strict=True):
        assert math.dist(one[-3:], other[-3:]) < 1.0
        for angle in ("roll_rad", "pitch_rad", "heading_rad"):
            error = wrap_angle(getattr(one, angle) - getattr(other, angle))
            assert abs(error) < 0.07 * DEGREE


@pytest.mark.parametrize("altitude_ft", [3_000, 9_000])
def test_it_does_not_pitch_up_and_down_at_its_slowest(name: str, altitude_ft: int) -> None:
    slowest_kt = load_aircraft_type(name).speeds.minimum_clean_kt + 3
    aircraft = in_cruise(
        name, altitude_ft=altitude_ft, airspeed_kt=slowest_kt, track_deg=90.0, may_land=False
    )
    *_, _ = states(aircraft, 15)
    pitches = [state.pitch_rad for state in states(aircraft, 5)]
    assert max(pitches) - min(pitches) < 0.1 * DEGREE
