"""The standard atmosphere (ICAO Doc 7488/3) up to 20 km, and the airspeeds in it. SI."""

from __future__ import annotations

import math

from airhilt.units import STANDARD_GRAVITY

SEA_LEVEL_PRESSURE_PA = 101_325.0
SEA_LEVEL_TEMPERATURE_K = 288.15
LAPSE_RATE_K_M = 0.0065
TROPOPAUSE_M = 11_000.0
GAS_CONSTANT = 287.05287
"""J/(kg K), of dry air."""
HEAT_RATIO = 1.4
NOMINAL_EARTH_RADIUS_M = 6_356_766.0
"""Turns geometric into geopotential height."""


def temperature(altitude_m: float) -> float:
    """Return the temperature (K) at a geometric altitude (m)."""
    return SEA_LEVEL_TEMPERATURE_K - LAPSE_RATE_K_M * min(_geopotential(altitude_m), TROPOPAUSE_M)


def pressure(altitude_m: float) -> float:
    """Return the pressure (Pa) at a geometric altitude (m)."""
    height = _geopotential(altitude_m)
    ratio = temperature(altitude_m) / SEA_LEVEL_TEMPERATURE_K
    exponent = STANDARD_GRAVITY / (GAS_CONSTANT * LAPSE_RATE_K_M)
    troposphere = SEA_LEVEL_PRESSURE_PA * math.pow(ratio, exponent)
    if height <= TROPOPAUSE_M:
        return troposphere
    scale = GAS_CONSTANT * temperature(altitude_m) / STANDARD_GRAVITY
    return troposphere * math.exp((TROPOPAUSE_M - height) / scale)


def speed_of_sound(altitude_m: float) -> float:
    """Return the speed of sound (m/s) at a geometric altitude (m)."""
    return math.sqrt(HEAT_RATIO * GAS_CONSTANT * temperature(altitude_m))


def mach(calibrated_airspeed_m_s: float, altitude_m: float) -> float:
    """Return the (subsonic) Mach number at a calibrated airspeed (m/s) and an altitude (m)."""
    impact = SEA_LEVEL_PRESSURE_PA * _impact_ratio(calibrated_airspeed_m_s / speed_of_sound(0.0))
    return _mach_of_impact_ratio(impact / pressure(altitude_m))


def true_airspeed(calibrated_airspeed_m_s: float, altitude_m: float) -> float:
    """Return the true airspeed (m/s) at a calibrated airspeed (m/s) and an altitude (m)."""
    return mach(calibrated_airspeed_m_s, altitude_m) * speed_of_sound(altitude_m)


def calibrated_airspeed(mach_number: float, altitude_m: float) -> float:
    """Return the calibrated airspeed (m/s) at a (subsonic) Mach number and an altitude (m)."""
    impact = pressure(altitude_m) * _impact_ratio(mach_number)
    return _mach_of_impact_ratio(impact / SEA_LEVEL_PRESSURE_PA) * speed_of_sound(0.0)


def _geopotential(altitude_m: float) -> float:
    return NOMINAL_EARTH_RADIUS_M * altitude_m / (NOMINAL_EARTH_RADIUS_M + altitude_m)


def _impact_ratio(mach_number: float) -> float:
    return math.pow(1.0 + 0.2 * mach_number**2, 3.5) - 1.0


def _mach_of_impact_ratio(ratio: float) -> float:
    return math.sqrt(5.0 * ((ratio + 1.0) ** (2.0 / 7.0) - 1.0))
