"""What an aircraft is told to do, it does: climbs, turns, speeds, avoidance."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, wrap_angle
from flights import in_cruise, states

CLIMBS = {"737": (2_000, 1_500), "B747": (2_000, 1_500), "c172p": (500, 500), "c310": (500, 1_000)}
"""Feet, and feet per minute."""


@pytest.mark.parametrize("sign", [1, -1], ids=["climb", "descent"])
def test_it_changes_level_and_levels_off_without_overshoot(name: str, sign: int) -> None:
    feet, rate_fpm = CLIMBS[name]
    aircraft = in_cruise(name)
    start = aircraft.state.altitude_m
    target = start + sign * feet * FOOT
    aircraft.en_route.hold_altitude(target, rate_fpm * FOOT_PER_MINUTE)
    assert aircraft.target_altitude_m == target
    flown = list(states(aircraft, feet / rate_fpm * 60 + 45))
    assert max(sign * (state.altitude_m - target) for state in flown) < 50 * FOOT
    assert flown[-1].altitude_m == pytest.approx(target, abs=20 * FOOT)
    halfway = flown[round(feet / rate_fpm * 60 * 20 / 2)]
    assert sign * halfway.vertical_rate_m_s == pytest.approx(rate_fpm * FOOT_PER_MINUTE, rel=0.15)
    assert aircraft.target_vertical_rate_m_s == pytest.approx(0.0, abs=1.0)


@pytest.mark.parametrize("name", ["737", "B747"])
@pytest.mark.parametrize("sign", [1, -1])
def test_an_avoidance_climb_is_established_within_7_seconds(name: str, sign: int) -> None:
    aircraft = in_cruise(name)
    rate = 1_500 * FOOT_PER_MINUTE
    aircraft.en_route.hold_altitude(aircraft.state.altitude_m + sign * 1_000 * FOOT, rate)
    reached = next(
        tick / 20
        for tick, state in enumerate(states(aircraft, 20))
        if sign * state.vertical_rate_m_s > 0.9 * rate
    )
    assert reached < 7.0


@pytest.mark.parametrize("angle_deg", [30, -30])
def test_it_turns_by_an_angle(name: str, angle_deg: int) -> None:
    aircraft = in_cruise(name)
    altitude = aircraft.state.altitude_m
    aircraft.en_route.turn_by(angle_deg * DEGREE)
    flown = list(states(aircraft, 60))
    target = (60 + angle_deg) * DEGREE
    assert abs(wrap_angle(flown[-1].track_rad - target)) < 0.3 * DEGREE
    side = math.copysign(1.0, angle_deg)
    assert max(side * wrap_angle(state.track_rad - target) for state in flown) < 1 * DEGREE
    assert max(abs(state.roll_rad) for state in flown) < 32 * DEGREE
    assert max(abs(state.altitude_m - altitude) for state in flown) < 50 * FOOT


@pytest.mark.parametrize("change_kt", [20, -20])
def test_it_changes_speed(name: str, change_kt: int) -> None:
    aircraft = in_cruise(name, airspeed_kt={"c310": 140}.get(name))
    altitude = aircraft.state.altitude_m
    target = aircraft.target_speed_m_s + change_kt * KNOT
    aircraft.en_route.hold_speed(target)
    flown = list(states(aircraft, 120))
    assert flown[-1].calibrated_airspeed_m_s == pytest.approx(target, abs=2 * KNOT)
    side = math.copysign(1.0, change_kt)
    overshoot = max(side * (state.calibrated_airspeed_m_s - target) for state in flown)
    assert overshoot < 5 * KNOT
    assert max(abs(state.altitude_m - altitude) for state in flown) < 50 * FOOT


def test_a_climb_that_the_engines_cannot_keep_gives_way_before_the_airspeed() -> None:
    aircraft = in_cruise("737")
    aircraft.en_route.hold_altitude(40_000 * FOOT, 4_000 * FOOT_PER_MINUTE)
    flown = list(states(aircraft, 200))
    assert aircraft.ended is None
    assert min(state.calibrated_airspeed_m_s for state in flown) > 220 * KNOT
    assert flown[-1].altitude_m > 38_000 * FOOT


@pytest.mark.parametrize(("name", "speed_kt"), [("737", 325), ("B747", 350)])
def test_in_a_long_climb_the_mach_limit_takes_over_from_the_airspeed(
    name: str, speed_kt: int
) -> None:
    aircraft = in_cruise(name, altitude_ft=22_000, airspeed_kt=speed_kt)
    aircraft.en_route.hold_altitude(33_000 * FOOT, 2_500 * FOOT_PER_MINUTE)
    flown = list(states(aircraft, 330))
    assert aircraft.ended is None
    assert max(state.mach for state in flown) < aircraft.kind.speeds.maximum_mach + 0.02
    assert flown[-1].altitude_m == pytest.approx(33_000 * FOOT, abs=30 * FOOT)


@settings(max_examples=12, deadline=None, derandomize=True)
@given(
    altitude_m=st.floats(1_000.0, 4_500.0),
    rate_m_s=st.floats(0.1, 20.0),
    speed_m_s=st.floats(1.0, 300.0),
    turn_rad=st.floats(-6.28, 6.28),
)
def test_no_sequence_of_commands_throws_it_out_of_the_air(
    altitude_m: float, rate_m_s: float, speed_m_s: float, turn_rad: float
) -> None:
    aircraft = in_cruise("c172p")
    aircraft.en_route.hold_altitude(altitude_m, rate_m_s)
    aircraft.en_route.hold_speed(speed_m_s)
    aircraft.en_route.turn_by(turn_rad)
    for _ in states(aircraft, 30):
        assert aircraft.ended is None
