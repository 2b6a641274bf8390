"""The standard atmosphere is that of the tables of ICAO Doc 7488/3."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.world.flight.standard_atmosphere import (
    NOMINAL_EARTH_RADIUS_M,
    calibrated_airspeed,
    mach,
    pressure,
    speed_of_sound,
    temperature,
    true_airspeed,
)


def test_temperature_pressure_and_sound_are_those_of_the_tables(subtests: pytest.Subtests) -> None:
    """The tables go by geopotential height."""
    for height_m, temperature_k, pressure_pa, sound_m_s in [
        (0.0, 288.150, 101_325.0, 340.294),
        (5_000.0, 255.650, 54_019.9, 320.529),
        (11_000.0, 216.650, 22_632.1, 295.070),
        (15_000.0, 216.650, 12_044.6, 295.070),
        (20_000.0, 216.650, 5_474.9, 295.070),
    ]:
        with subtests.test(str((height_m, temperature_k, pressure_pa, sound_m_s))):
            altitude_m = NOMINAL_EARTH_RADIUS_M * height_m / (NOMINAL_EARTH_RADIUS_M - height_m)
            assert temperature(altitude_m) == pytest.approx(temperature_k, abs=1e-3)
            assert pressure(altitude_m) == pytest.approx(pressure_pa, rel=1e-5)
            assert speed_of_sound(altitude_m) == pytest.approx(sound_m_s, abs=1e-3)


@given(st.floats(1.0, 330.0))
def test_at_sea_level_the_calibrated_airspeed_is_the_true_one(speed_m_s: float) -> None:
    assert true_airspeed(speed_m_s, 0.0) == pytest.approx(speed_m_s, rel=1e-9)
    assert mach(speed_m_s, 0.0) == pytest.approx(speed_m_s / 340.294, rel=1e-6)


@given(st.floats(0.05, 0.95), st.floats(-300.0, 20_000.0))
def test_a_mach_number_comes_back_from_its_calibrated_airspeed(
    mach_number: float, altitude_m: float
) -> None:
    airspeed_m_s = calibrated_airspeed(mach_number, altitude_m)
    assert mach(airspeed_m_s, altitude_m) == pytest.approx(mach_number, rel=1e-9)
    sound_m_s = speed_of_sound(altitude_m)
    assert true_airspeed(airspeed_m_s, altitude_m) == pytest.approx(mach_number * sound_m_s)


def test_slow_flight_is_faster_by_the_root_of_the_density_of_the_tables(
    subtests: pytest.Subtests,
) -> None:
    """Air is hardly compressed at 5 m/s. The densities are those of the US Standard Atmosphere
    1976 by geometric altitude."""
    for altitude_m, density_kg_m3 in [
        (0.0, 1.22500),
        (5_000.0, 0.736429),
        (11_000.0, 0.364801),
        (20_000.0, 0.0889097),
    ]:
        with subtests.test(str((altitude_m, density_kg_m3))):
            expected = 5.0 * math.sqrt(1.225 / density_kg_m3)
            assert true_airspeed(5.0, altitude_m) == pytest.approx(expected, rel=1e-3)
