"""Commands and recommendations that a crew refuses because its aircraft cannot fly them."""

from __future__ import annotations

from airhilt.commands import (
    AltitudeCommand,
    Command,
    EmergencyDescentCommand,
    GoAroundCommand,
    SpeedCommand,
    TakeOffCommand,
)
from airhilt.units import FOOT, KNOT
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.modes import GuidanceModes

LOWEST_HEIGHT_FT = 500
"""Lowest height to fly level at, in ft: 14 CFR 91.119(c), but for takeoff and landing."""


def unflyable(
    command: Command, kind: AircraftType, altitude_m: float, ground_m: float
) -> str | None:
    """Return why an aircraft cannot fly a command; None if it can.

    Parameters
    ----------
    altitude_m
        Its altitude now.
    ground_m
        Elevation of the ground below it.
    """
    match command:
        case SpeedCommand(cas_kt=cas_kt):
            return _speed(cas_kt, kind, altitude_m)
        case AltitudeCommand(altitude_ft=altitude_ft, vertical_rate_fpm=rate_fpm):
            is_climb = altitude_ft * FOOT >= altitude_m
            return _altitude(altitude_ft, kind, ground_m) or _rate(rate_fpm, kind, is_climb)
        case (
            EmergencyDescentCommand(altitude_ft=altitude_ft)
            | TakeOffCommand(climb_to_ft=altitude_ft)
            | GoAroundCommand(climb_to_ft=altitude_ft)
        ):
            return _altitude(altitude_ft, kind, ground_m)
        case _:
            return None


def too_low(
    altitude_ft: float, kind: AircraftType, altitude_m: float, ground_m: float
) -> str | None:
    """Return why an aircraft cannot go to a level that an advisory recommends; None if it can.

    A level above its ceiling is no reason: it climbs as high as it can.

    Parameters
    ----------
    altitude_m
        Its altitude now.
    ground_m
        Elevation of the ground below it.
    """
    if altitude_ft * FOOT >= altitude_m:
        return None
    return _altitude(altitude_ft, kind, ground_m)


def _speed(cas_kt: float, kind: AircraftType, altitude_m: float) -> str | None:
    limits_m_s = GuidanceModes(kind).speed_limits_m_s(altitude_m)
    slowest_kt, greatest_kt = (round(limit / KNOT) for limit in limits_m_s)
    if slowest_kt <= cas_kt <= greatest_kt:
        return None
    return f"{cas_kt:g} kt: a {kind.name} flies {slowest_kt} to {greatest_kt} kt here"


def _altitude(altitude_ft: float, kind: AircraftType, ground_m: float) -> str | None:
    lowest_ft = round(ground_m / FOOT) + LOWEST_HEIGHT_FT
    ceiling_ft = round(kind.speeds.service_ceiling_ft)
    if lowest_ft <= altitude_ft <= ceiling_ft:
        return None
    return f"{altitude_ft:g} ft: a {kind.name} flies at {lowest_ft} to {ceiling_ft} ft here"


def _rate(rate_fpm: float | None, kind: AircraftType, is_climb: bool) -> str | None:
    speeds = kind.speeds
    greatest_fpm = speeds.maximum_climb_rate_fpm if is_climb else speeds.maximum_descent_rate_fpm
    if rate_fpm is None or rate_fpm <= greatest_fpm:
        return None
    way = "climbs" if is_climb else "descends"
    return f"{rate_fpm:g} ft/min: a {kind.name} {way} at {greatest_fpm:.0f} ft/min at most"
