"""Commands and recommendations that a crew refuses because its aircraft cannot fly them."""

from __future__ import annotations

from dataclasses import dataclass

from airhilt.commands import (
    AltitudeCommand,
    Command,
    CrossFixCommand,
    EmergencyDescentCommand,
    GoAroundCommand,
    SpeedCommand,
    TakeOffCommand,
)
from airhilt.units import FOOT, KNOT
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.flight.guidance import GuidanceModes
from airhilt.world.flight.procedures.preparation import flaps_limit_m_s

LOWEST_HEIGHT_FT = 500
"""Lowest height to fly level at, in ft: 14 CFR 91.119(c), but for takeoff and landing."""


@dataclass(frozen=True)
class Envelope:
    """Levels, speeds and rates that an aircraft can fly over ground at an elevation in m."""

    aircraft: Aircraft
    ground_m: float

    def unflyable(self, command: Command) -> str | None:
        """Return why the aircraft cannot fly a command; None if it can."""
        match command:
            case SpeedCommand(cas_kt=cas_kt):
                return self._speed(cas_kt)
            case AltitudeCommand(altitude_ft=altitude_ft, vertical_rate_fpm=rate_fpm):
                is_climb = altitude_ft * FOOT >= self.aircraft.state.altitude_m
                return self._altitude(altitude_ft) or self.rate(rate_fpm, is_climb)
            case (
                EmergencyDescentCommand(altitude_ft=altitude_ft)
                | TakeOffCommand(climb_to_ft=altitude_ft)
                | CrossFixCommand(altitude_ft=altitude_ft)
            ):
                return self._altitude(altitude_ft)
            case GoAroundCommand(climb_to_ft=altitude_ft) if (
                altitude_ft * FOOT > self.aircraft.state.altitude_m
            ):
                return self._altitude(altitude_ft)
        return None

    @property
    def lowest_ft(self) -> int:
        """Lowest altitude to fly level at, in ft."""
        return round(self.ground_m / FOOT) + LOWEST_HEIGHT_FT

    def too_low(self, altitude_ft: float) -> str | None:
        """Return why the aircraft cannot go to a level that an advisory recommends; None if it can.

        A level above its ceiling is no reason: it climbs as high as it can.
        """
        is_climb = altitude_ft * FOOT >= self.aircraft.state.altitude_m
        return None if is_climb else self._altitude(altitude_ft)

    def _speed(self, cas_kt: float) -> str | None:
        kind = self.aircraft.kind
        limits_m_s = GuidanceModes(kind).speed_limits_m_s(self.aircraft.state.altitude_m)
        slowest_kt, greatest_kt = (round(limit / KNOT) for limit in limits_m_s)
        preparation = self.aircraft.procedures.preparation
        if preparation is not None:
            slowest_kt = min(slowest_kt, round(kind.speeds.approach_kt))
            if preparation.is_configured:
                greatest_kt = round(flaps_limit_m_s(kind) / KNOT)
        if slowest_kt <= cas_kt <= greatest_kt:
            return None
        limit = f"minimum {slowest_kt}" if cas_kt < slowest_kt else f"maximum {greatest_kt}"
        return f"{cas_kt:g} kt, {limit} kt"

    def _altitude(self, altitude_ft: float) -> str | None:
        kind = self.aircraft.kind
        lowest_ft = self.lowest_ft
        ceiling_ft = round(kind.speeds.service_ceiling_ft)
        if lowest_ft <= altitude_ft <= ceiling_ft:
            return None
        return f"{altitude_ft:g} ft: a {kind.name} flies at {lowest_ft} to {ceiling_ft} ft here"

    def rate(self, rate_fpm: float | None, is_climb: bool) -> str | None:
        """Return why the aircraft cannot climb or descend at a rate; None if it can."""
        kind, speeds = self.aircraft.kind, self.aircraft.kind.speeds
        greatest_fpm = (
            speeds.maximum_climb_rate_fpm if is_climb else speeds.maximum_descent_rate_fpm
        )
        if rate_fpm is None or rate_fpm <= greatest_fpm:
            return None
        way = "climbs" if is_climb else "descends"
        return f"{rate_fpm:g} ft/min: a {kind.name} {way} at {greatest_fpm:.0f} ft/min at most"
