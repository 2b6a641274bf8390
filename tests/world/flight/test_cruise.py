"""An aircraft begins in steady flight, and stays in it, whatever the air does."""

from __future__ import annotations

import math

import pytest

from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, wrap_angle
from airhilt.world.flight import Atmosphere
from flights import in_cruise, states

GALE = Atmosphere(wind_north_m_s=20.0, wind_east_m_s=-16.0)
"""50 kt."""


@pytest.mark.parametrize("air", [Atmosphere(), GALE], ids=["calm", "wind"])
def test_it_holds_altitude_speed_and_track_from_the_first_instant(
    name: str, air: Atmosphere
) -> None:
    aircraft = in_cruise(name, atmosphere=air)
    altitude = aircraft.target_altitude_m
    speed = aircraft.target_speed_m_s
    for state in states(aircraft, 120):
        assert state.altitude_m == pytest.approx(altitude, abs=10 * FOOT)
        assert state.calibrated_airspeed_m_s == pytest.approx(speed, abs=1 * KNOT)
        assert abs(wrap_angle(state.track_rad - 60 * DEGREE)) < 0.1 * DEGREE
        assert abs(state.vertical_rate_m_s) < 100 * FOOT_PER_MINUTE


@pytest.mark.parametrize(
    ("name", "altitude_ft", "airspeed_kt"),
    [
        ("737", 20_000, 250),
        ("737", 39_000, 240),
        ("B747", 20_000, 320),
        ("B747", 39_000, 250),
        ("c172p", 3_000, 75),
        ("c172p", 8_000, 105),
        ("c310", 3_000, 120),
        ("c310", 8_000, 165),
    ],
)
def test_it_begins_without_a_bump_all_over_its_envelope(
    name: str, altitude_ft: int, airspeed_kt: int
) -> None:
    aircraft = in_cruise(name, altitude_ft=altitude_ft, airspeed_kt=airspeed_kt, atmosphere=GALE)
    for state in states(aircraft, 10):
        assert state.altitude_m == pytest.approx(altitude_ft * FOOT, abs=20 * FOOT)
        assert state.calibrated_airspeed_m_s == pytest.approx(airspeed_kt * KNOT, abs=3 * KNOT)


def test_it_can_begin_in_a_climb(name: str) -> None:
    rate = 300 * FOOT_PER_MINUTE
    aircraft = in_cruise(name, altitude_ft=4_000, airspeed_kt=None, vertical_rate_m_s=rate)
    for state in states(aircraft, 20):
        assert state.vertical_rate_m_s == pytest.approx(rate, abs=40 * FOOT_PER_MINUTE)


def test_wind_moves_it_over_the_ground_only() -> None:
    calm, gale = in_cruise("737").state, in_cruise("737", atmosphere=GALE).state
    assert gale.true_airspeed_m_s == pytest.approx(calm.true_airspeed_m_s, abs=0.1)
    along = 20.0 * math.cos(60 * DEGREE) - 16.0 * math.sin(60 * DEGREE)
    across = -16.0 * math.cos(60 * DEGREE) - 20.0 * math.sin(60 * DEGREE)
    expected = along + math.sqrt(calm.true_airspeed_m_s**2 - across**2)
    assert gale.ground_speed_m_s == pytest.approx(expected, abs=0.1)


def test_moderate_turbulence_keeps_it_within_150_ft(name: str) -> None:
    air = Atmosphere(turbulence_wind_at_20ft_m_s=15.0, turbulence_severity=3)
    aircraft = in_cruise(name, atmosphere=air)
    altitude = aircraft.target_altitude_m
    errors = [abs(state.altitude_m - altitude) for state in states(aircraft, 120)]
    assert aircraft.ended is None
    assert max(errors) < 150 * FOOT
    assert max(errors) > 1 * FOOT


def test_the_state_is_consistent_with_itself() -> None:
    aircraft = in_cruise("737", terrain_elevation_m=400.0)
    before = aircraft.state
    *_, after = states(aircraft, 10)
    path = math.dist(before[-3:], after[-3:])
    geodetic = 1.0 + after.altitude_m / 6_371_000
    assert path == pytest.approx(after.ground_speed_m_s * 10 * geodetic, rel=2e-3)
    wheels = aircraft.kind.dimensions.wheel_height_offset_m
    assert after.height_agl_m == pytest.approx(after.altitude_m - 400.0 - wheels)
