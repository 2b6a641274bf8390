"""Belief about each aircraft and vehicle at an airport, and how it uses runways.

A mobile, in the words of surface surveillance (ICAO Doc 9830), is an aircraft or a vehicle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from airhilt.assistant.decision.aerodrome import Direction, Strip, Vector
from airhilt.assistant.decision.findings import RunwayUse
from airhilt.messages import AdsbReport
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE, SECOND_NS

SPEED_MEMORY = 0.6
"""Weight of the earlier speed in the exponential mean; about 1 s at two reports a second."""
MEMORY_NS = 2 * SECOND_NS
"""Silence after which the mean begins anew, in ns."""
FINAL_M = 5.0 * NAUTICAL_MILE
"""Length of the final approach that is looked at, in m."""
FINAL_WIDTH_M = 120.0
FINAL_WIDENING = 0.08
"""Largest distance from the centre line on final: a width in m plus a share of the distance to the
threshold."""
STEEPEST = math.tan(5.0 * DEGREE)
HEIGHT_ALLOWANCE_M = 150.0
"""Height above a steep glide path, in m, up to which an aircraft is on final."""
DESCENDING_M_S = 100 * FOOT_PER_MINUTE
LOW_M = 60.0
"""Height, in m, below which an aircraft need not descend to be landing."""
CLIMBING_M_S = 200 * FOOT_PER_MINUTE
CLIMB_OUT_M = 300.0
"""Height, in m, up to which an aircraft that climbs along the runway uses it."""
BEYOND_M = 2.0 * NAUTICAL_MILE
"""Distance before or past the runway, in m, within which a climbing aircraft uses it."""
STANDING_M_S = 1.5
"""Speeds below this, in m/s, are treated as standing."""
ROLLING_M_S = 25.0 * KNOT
"""Speed that nobody reaches in taxiing along a runway, in m/s."""
ACCELERATING_FROM_M_S = 5.0
GAIN_M_S = 3.0
"""Excess of the speed over its slow mean, in m/s, from which a slow mobile is departing."""
SLOWING_M_S = 0.5
"""Deficit of the speed to its slow mean, in m/s, from which a mobile is braking: about 1 kt, the
step of reported speeds."""
SLOW_SPEED_MEMORY = 0.9
"""Weight of the earlier speed in the slow mean; about 5 s."""
BESIDE_M = 25.0
"""Distance from the pavement, in m, within which a mobile is on it: position error and size."""
TOUCHDOWN_M = 400.0
"""Distance past the threshold at which a landing touches down, in m."""
BRAKING_M_S2 = 1.8
"""Deceleration of a normal rollout, in m/s2."""
TAKEOFF_M_S2 = 1.8
"""Acceleration of a normal takeoff, in m/s2."""
OVERRUN_M = 500.0
"""Longest pavement before a displaced threshold or past the end, in m."""
VEHICLE_CATEGORIES = ("C1", "C2")


@dataclass(slots=True)
class Mobile:
    """One aircraft or vehicle, as of ``t_ns``."""

    icao24: str
    callsign: str
    t_ns: int
    point: Vector
    altitude_m: float | None
    """Pressure altitude; None on the ground."""
    speed_m_s: float
    heading_rad: float
    """Heading on the ground, track in flight."""
    vertical_rate_m_s: float
    nacp: int
    is_vehicle: bool
    slow_speed_m_s: float
    """Mean of the speed over some seconds."""
    landed: bool = False
    """True if it has landed and not left the runway since."""

    @property
    def on_ground(self) -> bool:
        """True if it is on the ground."""
        return self.altitude_m is None

    @property
    def is_rolling(self) -> bool:
        """True if it is faster, or accelerates more, than in taxiing."""
        gain_m_s = self.speed_m_s - self.slow_speed_m_s
        gathers = self.speed_m_s >= ACCELERATING_FROM_M_S and gain_m_s >= GAIN_M_S
        return self.speed_m_s >= ROLLING_M_S or (gathers and not self.landed)

    @property
    def is_slowing(self) -> bool:
        """True if it brakes."""
        return self.slow_speed_m_s - self.speed_m_s >= SLOWING_M_S

    def travelled_m(self, t_ns: int) -> float:
        """Return how far it has come since its last report, in m; 0 for one that slows down.

        One that slows down may be about to stop.
        """
        if self.is_slowing:
            return 0.0
        return self.speed_m_s * max(t_ns - self.t_ns, 0) / SECOND_NS

    @classmethod
    def of(cls, report: AdsbReport, point: Vector) -> Mobile:
        """Return the mobile of a first report."""
        return cls(
            report.icao24,
            report.callsign or report.icao24,
            report.t_adsb_in_ns,
            point,
            None if report.altitude_ft is None else report.altitude_ft * FOOT,
            report.ground_speed_kt * KNOT,
            report.track_deg * DEGREE,
            report.vertical_rate_fpm * FOOT_PER_MINUTE,
            report.nacp,
            report.emitter_category in VEHICLE_CATEGORIES,
            report.ground_speed_kt * KNOT,
        )

    def update(self, report: AdsbReport, point: Vector) -> None:
        """Update with a newer report."""
        fresh = Mobile.of(report, point)
        recent = fresh.t_ns - self.t_ns < MEMORY_NS
        keep, keep_slow = (SPEED_MEMORY, SLOW_SPEED_MEMORY) if recent else (0.0, 0.0)
        self.landed = fresh.on_ground and (self.landed or not self.on_ground)
        self.callsign = report.callsign or self.callsign
        self.t_ns, self.point, self.altitude_m = fresh.t_ns, point, fresh.altitude_m
        self.speed_m_s = keep * self.speed_m_s + (1.0 - keep) * fresh.speed_m_s
        self.slow_speed_m_s = keep_slow * self.slow_speed_m_s + (1.0 - keep_slow) * fresh.speed_m_s
        self.heading_rad = fresh.heading_rad
        self.vertical_rate_m_s = fresh.vertical_rate_m_s
        self.nacp = fresh.nacp
        self.is_vehicle = self.is_vehicle or fresh.is_vehicle


class Use(NamedTuple):
    """Use of a runway by an aircraft, as of the last report."""

    mobile: Mobile
    strip: Strip
    direction: Direction
    kind: RunwayUse
    along_m: float

    @property
    def is_climbing(self) -> bool:
        """True if it is a departure that has left the ground."""
        return self.kind == "departure" and not self.mobile.on_ground

    def time_to_threshold_s(self, t_ns: int) -> float:
        """Return the time until it crosses the threshold, in s; 0 once it has."""
        return self._left_s(-self.along_m / max(self.mobile.speed_m_s, 1.0), t_ns)

    def time_to_s(self, along_m: float, t_ns: int) -> float | None:
        """Return the time until it is at a distance past the threshold; None if it will not be.

        An arrival brakes after it has touched down, a departure accelerates, both evenly.
        """
        speed, distance_m = self.mobile.speed_m_s, along_m - self.along_m
        if distance_m < 0.0:
            return None
        if self.kind == "departure":
            root = math.sqrt(speed * speed + 2.0 * TAKEOFF_M_S2 * distance_m)
            return self._left_s((root - speed) / TAKEOFF_M_S2, t_ns)
        flown_m = max(TOUCHDOWN_M - self.along_m, 0.0) if self.kind == "arrival" else 0.0
        if distance_m <= flown_m:
            return self._left_s(distance_m / max(speed, 1.0), t_ns)
        left = speed * speed - 2.0 * BRAKING_M_S2 * (distance_m - flown_m)
        if left < 0.0:
            return None
        braked_s = (speed - math.sqrt(left)) / BRAKING_M_S2
        return self._left_s(flown_m / max(speed, 1.0) + braked_s, t_ns)

    def _left_s(self, time_s: float, t_ns: int) -> float:
        return max(time_s - (t_ns - self.mobile.t_ns) / SECOND_NS, 0.0)


def use_of(mobile: Mobile, strips: tuple[Strip, ...]) -> Use | None:
    """Return how a mobile uses a runway, the one whose centre line is nearest; None if none."""
    found: list[tuple[float, Use]] = []
    for strip in strips:
        for direction in strip.directions:
            kind = _kind(mobile, direction) if direction.points_along(mobile.heading_rad) else None
            if kind is not None:
                use = Use(mobile, strip, direction, kind, direction.along_m(mobile.point))
                found.append((abs(direction.across_m(mobile.point)), use))
    return min(found, key=lambda each: each[0])[1] if found else None


def _kind(mobile: Mobile, direction: Direction) -> RunwayUse | None:
    """Return how an aircraft uses a runway that it points along; None if it does not."""
    along_m, across_m = direction.along_m(mobile.point), abs(direction.across_m(mobile.point))
    if mobile.altitude_m is None:
        if mobile.is_vehicle or not mobile.is_rolling:
            return None
        if not is_on_pavement(direction, along_m, across_m):
            return None
        return "rollout" if mobile.landed else "departure"
    height_m = mobile.altitude_m - direction.elevation_m
    rate = mobile.vertical_rate_m_s
    width_m = FINAL_WIDTH_M + FINAL_WIDENING * max(-along_m, along_m - direction.length_m, 0.0)
    if across_m > width_m or along_m < -FINAL_M:
        return None
    if rate > CLIMBING_M_S:
        near = -BEYOND_M <= along_m <= direction.length_m + BEYOND_M
        return "departure" if near and height_m <= CLIMB_OUT_M else None
    low = height_m <= LOW_M
    lands = along_m <= direction.length_m and (rate < -DESCENDING_M_S or low)
    beneath_m = HEIGHT_ALLOWANCE_M + STEEPEST * max(-along_m, 0.0)
    return "arrival" if lands and height_m <= beneath_m else None


def is_on_pavement(direction: Direction, along_m: float, across_m: float) -> bool:
    """Return whether a position is on a runway's pavement, or would be but for its error."""
    return (
        across_m <= direction.half_width_m + BESIDE_M
        and -direction.displaced_m - OVERRUN_M <= along_m <= direction.length_m + OVERRUN_M
    )


def lined_up_on(mobile: Mobile, strip: Strip) -> Direction | None:
    """Return the direction in which an aircraft stands, or taxies, on a runway's centre line."""
    if mobile.is_vehicle or mobile.landed or not mobile.on_ground:
        return None
    for direction in strip.directions:
        along_m, across_m = direction.along_m(mobile.point), abs(direction.across_m(mobile.point))
        is_aligned = direction.points_along(mobile.heading_rad)
        if is_aligned and is_on_pavement(direction, along_m, across_m):
            return direction
    return None
