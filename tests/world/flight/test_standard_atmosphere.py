"""The standard atmosphere is that of the tables of ICAO Doc 7488/3."""

from __future__ import annotations

import pytest

from airhilt.world.flight.standard_atmosphere import (
    NOMINAL_EARTH_RADIUS_M,
    pressure,
    speed_of_sound,
    temperature,
)


@pytest.mark.parametrize(
    ("height_m", "temperature_k", "pressure_pa", "sound_m_s"),
    [
        (0.0, 288.150, 101_325.0, 340.294),
        (5_000.0, 255.650, 54_019.9, 320.529),
        (11_000.0, 216.650, 22_632.1, 295.070),
        (15_000.0, 216.650, 12_044.6, 295.070),
        (20_000.0, 216.650, 5_474.9, 295.070),
    ],
)
def test_temperature_pressure_and_sound_are_those_of_the_tables(
    height_m: float, temperature_k: float, pressure_pa: float, sound_m_s: float
) -> None:
    """The tables go by geopotential height."""
    altitude_m = NOMINAL_EARTH_RADIUS_M * height_m / (NOMINAL_EARTH_RADIUS_M - height_m)
    assert temperature(altitude_m) == pytest.approx(temperature_k, abs=1e-3)
    assert pressure(altitude_m) == pytest.approx(pressure_pa, rel=1e-5)
    assert speed_of_sound(altitude_m) == pytest.approx(sound_m_s, abs=1e-3)
