"""Outer loops: they turn commands into a turn rate, a vertical rate and an airspeed.

Each direction has its modes, small objects that are replaced when a command comes: `Track`
and `Route` for the lateral one, `Altitude` for the vertical one, `Airspeed`. `GuidanceModes` makes
them with the gains and within the limits of a type. Procedures (takeoff, approach, flare) are
further modes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from airhilt.geodesy.wgs84 import MEAN_RADIUS_M, Place
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, STANDARD_GRAVITY, wrap_angle
from airhilt.world.flight import standard_atmosphere
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.autopilot import within
from airhilt.world.flight.curves import Curve
from airhilt.world.flight.route import SHARPEST_TURN_RAD, Arc, Guide, Leg, turn_between
from airhilt.world.flight.state import AircraftState, InitialCondition

CROSS_TRACK_PART = 0.4
"""Cross-track gain, as a part of the course gain: a damping ratio of 0.8."""
INTERCEPT_ANGLE = 30.0 * DEGREE
"""Angle at which a distant leg is joined, in rad."""
ARC_BANK_PART = 0.8
"""Part of the bank limit that an arc of the route takes; the rest corrects."""
ROLL_LEAD_S = 2.5
"""Time before an arc at which the roll into it begins, in s: half its duration, and its lag."""


class AltitudeClearance(NamedTuple):
    """Altitude, and the positive rate at which it is reached."""

    altitude_m: float
    vertical_rate_m_s: float


class LateralMode(Protocol):
    """Mode of the lateral guidance."""

    def turn_rate(self, state: AircraftState) -> float:
        """Return the commanded rate of turn of the track (rad/s, positive to the right)."""


class Track:
    """Turns to a true track over the ground and holds it.

    The gain is the turn rate per course error, in 1/s. ``turn_rad`` is the angle to turn through on
    the way, positive to the right; None for the shorter side.
    """

    def __init__(self, track_rad: float, gain: float, turn_rad: float | None = None) -> None:
        self._track = track_rad
        self._gain = gain
        self._remaining = turn_rad

    def turn_rate(self, state: AircraftState) -> float:
        """Return the commanded rate of turn."""
        # A constant track is no geodesic: meridians converge.
        convergence = state.velocity_east_m_s * math.tan(state.latitude_rad) / MEAN_RADIUS_M
        return self._gain * self._error(state.track_rad) - convergence

    def _error(self, angle: float) -> float:
        error = wrap_angle(self._track - angle)
        if self._remaining is None:
            return error
        # While a turn of a given side is flown, the error is what is left of it, which may be
        # more than half a circle.
        self._remaining += wrap_angle(error - self._remaining)
        remaining = self._remaining
        if abs(remaining) < math.pi / 2.0:
            self._remaining = None
        return remaining


class Route:
    """Flies legs one after the other, cutting the corners, then holds the last one's track.

    The gain is the turn rate per course error, in 1/s.
    """

    def __init__(self, legs: tuple[Leg, ...], gain: float, bank_limit_rad: float) -> None:
        self._legs = legs
        self._gain = gain
        self._arc_acceleration = STANDARD_GRAVITY * math.tan(ARC_BANK_PART * bank_limit_rad)
        self._index = 0
        self._arc: Arc | None = None
        self._end: Track | None = None
        self._look_ahead()

    @property
    def leg(self) -> Leg:
        """Leg that is flown, or that the present arc leads to."""
        return self._legs[self._index]

    @property
    def ends_ahead(self) -> tuple[Place, ...]:
        """Ends of the present leg and of those behind it; none after the last."""
        return () if self._end is not None else tuple(leg.end for leg in self._legs[self._index :])

    def turn_rate(self, state: AircraftState) -> float:
        """Return the commanded rate of turn."""
        ground_speed = state.ground_speed_m_s
        if self._end is None:
            self._sequence(state, ground_speed)
        if self._end is not None:
            return self._end.turn_rate(state)
        speed = max(ground_speed, 1.0)
        if self._arc is not None:
            guide = self._arc.guide(state)
            turn_rate = guide.turn_rate
            if self._arc.to_go_m(state) < ROLL_LEAD_S * speed:
                turn_rate = 0.0
            return turn_rate + _correction(guide, state, self._gain)
        return _correction(self.leg.guide(state), state, self._gain)

    def rejoin(self) -> None:
        """Intercept the present leg, not the arc into it."""
        self._arc = None

    def _sequence(self, state: AircraftState, speed: float) -> None:
        """Switch to the next arc or leg if it is due at this ground speed."""
        if self._arc is not None:
            if self._arc.to_go_m(state) <= 0.0:
                self._arc = None
            return
        while True:
            leg = self.leg
            to_go = leg.to_go_m(state)
            lead = min(self._lead_factor * speed * speed, self._longest_lead)
            if to_go > lead + (ROLL_LEAD_S * speed if lead > 0.0 else 0.0):
                return
            if self._index == len(self._legs) - 1:
                self._end = Track(leg.course_rad(*leg.end), self._gain)
                return
            self._index += 1
            if 0.0 < lead <= to_go:
                self._arc = Arc(leg, self.leg, lead)
                self._look_ahead()
                return
            self._look_ahead()

    def _look_ahead(self) -> None:
        """Find how far before the end of the leg the turn into the next one begins."""
        self._lead_factor = 0.0
        self._longest_lead = 0.0
        if self._index == len(self._legs) - 1:
            return
        leg, after = self._legs[self._index : self._index + 2]
        turn = abs(turn_between(leg, after))
        if 1.0 * DEGREE < turn < SHARPEST_TURN_RAD:
            self._lead_factor = math.tan(turn / 2.0) / self._arc_acceleration
            self._longest_lead = 0.45 * min(leg.length_m, after.length_m)


class CurvedPath:
    """Flies a curve, then what follows it; without that, straight on. The gain is as of `Route`."""

    def __init__(self, curve: Curve, gain: float, then: LateralMode | None = None) -> None:
        self.curve = curve
        self._gain = gain
        self._then = then
        self._is_over = False

    def turn_rate(self, state: AircraftState) -> float:
        """Return the commanded rate of turn."""
        if self._then is not None and self._is_over:
            return self._then.turn_rate(state)
        guide = self.curve.guide(state, ROLL_LEAD_S)
        self._is_over = self.curve.to_go_m <= 0.0
        return guide.turn_rate + _correction(guide, state, self._gain)

    def after(self) -> LateralMode:
        """Return what is flown once the curve is over."""
        return self if self._then is None else self._then


def _correction(guide: Guide, state: AircraftState, gain: float) -> float:
    """Return the turn rate that leads back to a path, by a gain in 1/s."""
    speed = max(state.ground_speed_m_s, 1.0)
    offset = within(CROSS_TRACK_PART * gain * guide.cross_track_m / speed, INTERCEPT_ANGLE)
    return gain * wrap_angle(guide.course_rad - offset - state.track_rad)


class Altitude:
    """Climbs or descends at a rate, then levels off and holds.

    The gain is the vertical rate per altitude error, in 1/s.
    """

    def __init__(self, clearance: AltitudeClearance, gain: float) -> None:
        self.clearance = clearance
        self._altitude, self._rate = clearance
        self._gain = gain

    def vertical_rate(self, state: AircraftState) -> float:
        """Return the commanded vertical rate (m/s, positive up)."""
        return within(self._gain * (self._altitude - state.altitude_m), self._rate)

    def captures(self, state: AircraftState) -> bool:
        """Return whether the aircraft must level off now, at its present rate."""
        wanted = self._gain * (self._altitude - state.altitude_m)
        rate = state.vertical_rate_m_s
        return wanted <= rate if wanted > 0.0 else wanted >= rate


class Airspeed:
    """Holds a calibrated airspeed, up to a Mach number: the lower of the two in a climb."""

    def __init__(self, airspeed_m_s: float, maximum_mach: float) -> None:
        self.target_m_s = airspeed_m_s
        self._maximum_mach = maximum_mach

    def airspeed(self, state: AircraftState) -> float:
        """Return the commanded calibrated airspeed (m/s)."""
        # Exact at the maximum Mach number, which is where it matters.
        limit = state.calibrated_airspeed_m_s * self._maximum_mach / state.mach
        return self.target_m_s if self.target_m_s < limit else limit


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

    def curve(self, curve: Curve, then: LateralMode | None = None) -> CurvedPath:
        """Return the mode that flies a curve, and what follows it."""
        return CurvedPath(curve, self.kind.gains.guidance.course_per_s, then)

    def airspeed(self, calibrated_airspeed_m_s: float) -> Airspeed:
        """Return the mode that holds an airspeed, up to the type's greatest Mach number."""
        return Airspeed(calibrated_airspeed_m_s, self.kind.speeds.maximum_mach)

    def altitude(self, clearance: AltitudeClearance) -> Altitude:
        """Return the mode that flies to an altitude and holds it."""
        return Altitude(clearance, self.kind.gains.guidance.altitude_per_s)

    def altitude_at_usual_rate(self, altitude_m: float) -> Altitude:
        """Return the mode that flies to an altitude, the ceiling at most, at the usual rate."""
        rate = self.kind.speeds.climb_rate_fpm * FOOT_PER_MINUTE
        return self.altitude(AltitudeClearance(self._below_ceiling(altitude_m), rate))

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
