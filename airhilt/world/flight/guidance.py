"""Outer loops: they turn commands into a turn rate, a vertical rate and an airspeed.

Each direction has its modes, small objects that are replaced when a command comes: `Track`
and `Route` for the lateral one, `Altitude` for the vertical one, `Airspeed`. Procedures
(takeoff, approach, flare) are further modes.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol

from airhilt.geodesy.wgs84 import MEAN_RADIUS_M
from airhilt.units import DEGREE, STANDARD_GRAVITY, wrap_angle
from airhilt.world.flight.autopilot import within
from airhilt.world.flight.route import SHARPEST_TURN_RAD, Arc, Guide, Leg, turn_between
from airhilt.world.flight.state import AircraftState

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
        self._cross_track_gain = CROSS_TRACK_PART * gain
        self._arc_acceleration = STANDARD_GRAVITY * math.tan(ARC_BANK_PART * bank_limit_rad)
        self._index = 0
        self._arc: Arc | None = None
        self._end: Track | None = None
        self._look_ahead()

    @property
    def finished(self) -> bool:
        """True if the last waypoint is passed."""
        return self._end is not None

    @property
    def leg(self) -> Leg:
        """Leg that is flown, or that the present arc leads to."""
        return self._legs[self._index]

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
            return turn_rate + self._correction(guide, state, speed)
        return self._correction(self.leg.guide(state), state, speed)

    def rejoin(self) -> None:
        """Intercept the present leg, not the arc into it."""
        self._arc = None

    def _correction(self, guide: Guide, state: AircraftState, speed: float) -> float:
        offset = -within(self._cross_track_gain * guide.cross_track_m / speed, INTERCEPT_ANGLE)
        return self._gain * wrap_angle(guide.course_rad + offset - state.track_rad)

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
