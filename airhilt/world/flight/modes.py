"""Guidance modes with the gains and within the limits of one aircraft type."""

from __future__ import annotations

from dataclasses import dataclass

from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT
from airhilt.world.flight import standard_atmosphere
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.guidance import (
    Airspeed,
    Altitude,
    AltitudeClearance,
    Route,
    Track,
)
from airhilt.world.flight.route import Leg
from airhilt.world.flight.state import InitialCondition


@dataclass(frozen=True, slots=True)
class GuidanceModes:
    """Makes the guidance modes of one aircraft type."""

    kind: AircraftType

    def track(self, track_rad: float, turn_rad: float | None = None) -> Track:
        """Return the mode that turns to a track, by the shorter side or through an angle."""
        return Track(track_rad, self.kind.gains.guidance.course_per_s, turn_rad)

    def route(self, legs: tuple[Leg, ...]) -> Route:
        """Return the mode that flies legs."""
        gains = self.kind.gains
        return Route(legs, gains.guidance.course_per_s, gains.roll.bank_limit_deg * DEGREE)

    def airspeed(self, calibrated_airspeed_m_s: float) -> Airspeed:
        """Return the mode that holds an airspeed, up to the type's greatest Mach number."""
        return Airspeed(calibrated_airspeed_m_s, self.kind.speeds.maximum_mach)

    def altitude(self, clearance: AltitudeClearance) -> Altitude:
        """Return the mode that flies to an altitude and holds it."""
        return Altitude(clearance, self.kind.gains.guidance.altitude_per_s)

    def altitude_at_usual_rate(self, altitude_m: float) -> Altitude:
        """Return the mode that flies to an altitude at the rate for which none was asked."""
        rate = self.kind.speeds.climb_rate_fpm * FOOT_PER_MINUTE
        return self.altitude(AltitudeClearance(altitude_m, rate))

    def steepest_climb(self, altitude_m: float) -> Altitude:
        """Return the mode that climbs to an altitude, the ceiling at most, at the greatest rate."""
        rate = self.kind.speeds.maximum_climb_rate_fpm * FOOT_PER_MINUTE
        return self.altitude(AltitudeClearance(self._below_ceiling(altitude_m), rate))

    def steepest_descent(self, altitude_m: float) -> Altitude:
        """Return the mode that descends to an altitude at the greatest rate."""
        rate = self.kind.speeds.maximum_descent_rate_fpm * FOOT_PER_MINUTE
        return self.altitude(AltitudeClearance(altitude_m, rate))

    def initial_altitude(self, initial: InitialCondition, terrain_elevation_m: float) -> Altitude:
        """Return the vertical mode in which a flight begins.

        A climb goes to the service ceiling and a descent to the ground, until there is a clearance.
        """
        speeds = self.kind.speeds
        rate, altitude = initial.vertical_rate_m_s, initial.altitude_m
        if rate > 0.0:
            altitude = speeds.service_ceiling_ft * FOOT
        elif rate < 0.0:
            altitude = terrain_elevation_m
        usual_rate = speeds.climb_rate_fpm * FOOT_PER_MINUTE
        return self.altitude(AltitudeClearance(altitude, abs(rate) or usual_rate))

    def clean_climb_speed(self) -> Airspeed:
        """Return the mode that holds the slowest clean airspeed of a climb."""
        speeds = self.kind.speeds
        return self.airspeed(max(speeds.minimum_clean_kt, speeds.climb_safety_kt) * KNOT)

    def accepted_clearance(
        self, altitude_m: float, vertical_rate_m_s: float, *, is_climb: bool
    ) -> AltitudeClearance:
        """Return a clearance with its altitude and rate brought within the type's limits."""
        speeds = self.kind.speeds
        greatest_fpm = (
            speeds.maximum_climb_rate_fpm if is_climb else speeds.maximum_descent_rate_fpm
        )
        return AltitudeClearance(
            self._below_ceiling(altitude_m),
            min(vertical_rate_m_s, greatest_fpm * FOOT_PER_MINUTE),
        )

    def speed_limits_m_s(self, altitude_m: float) -> tuple[float, float]:
        """Return the slowest clean and the greatest calibrated airspeed at an altitude, in m/s."""
        speeds = self.kind.speeds
        greatest = min(
            speeds.maximum_kt * KNOT,
            standard_atmosphere.calibrated_airspeed(speeds.maximum_mach, altitude_m),
        )
        return speeds.minimum_clean_kt * KNOT, greatest

    def _below_ceiling(self, altitude_m: float) -> float:
        return min(altitude_m, self.kind.speeds.service_ceiling_ft * FOOT)
