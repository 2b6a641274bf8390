"""The final approach course and the glide path of a runway, and the ways to both."""

from __future__ import annotations

import math

from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE, wrap_angle
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.autopilot import within
from airhilt.world.flight.guidance import CROSS_TRACK_PART, INTERCEPT_ANGLE
from airhilt.world.flight.route import Leg
from airhilt.world.flight.state import AircraftState
from airhilt.world.surface.runway import RunwayEnd

WIDEST_INTERCEPT = 45.0 * DEGREE
"""Greatest angle off the course, seen from the threshold, at which an intercept is flown, in rad.

Radar vectors keep to 30 degrees (FAA Order JO 7110.65, 5-9-2); this leaves margin for a visual
circuit."""
FARTHEST_M = 25.0 * NAUTICAL_MILE
"""Greatest distance from the threshold along the course, in m. The service volume of an ILS
localizer reaches 18 NM (FAA Aeronautical Information Manual, 1-1-9); part of the intercept lies
before it."""
GREATEST_CORRECTION_M_S = 15.0 * FOOT
"""Greatest vertical rate that is added to return to the glide path, in m/s (15 ft/s)."""
LOWEST_M = 300.0 * FOOT
"""Least height above the threshold at which a side-step begins, in m."""
STEEPEST_RAD = 20.0 * DEGREE
"""Greatest angle to the place where the other course must have been joined, in rad."""
JOINED_M = 200.0 * FOOT / math.tan(3.0 * DEGREE)
"""Distance from the threshold at which it must be joined, in m: 200 ft on the usual glide path."""


class Final:
    """The final approach course and the glide path to a runway, for one type of aircraft."""

    def __init__(self, runway: RunwayEnd, kind: AircraftType) -> None:
        self.runway = runway
        landing = kind.landing
        self._line = Leg(runway.threshold, runway.end)
        self._aim = landing.aim_m
        self._slope = math.tan(runway.glide_path_rad)
        self._wheels_at_threshold_m = runway.elevation_m + kind.dimensions.wheel_height_offset_m
        self._course_gain = landing.course_per_s
        self._cross_track_gain = CROSS_TRACK_PART * landing.course_per_s
        self._glide_gain = landing.glide_per_s

    def along_m(self, state: AircraftState) -> float:
        """Return how far beyond the threshold the aircraft is, negative before it."""
        return self._line.length_m - self._line.to_go_m(state)

    def cross_track_m(self, state: AircraftState) -> float:
        """Return how far to the right of the centre line the aircraft is."""
        return self._line.cross_track_m(state)

    def course_rad(self, state: AircraftState) -> float:
        """Return the true course along the runway, beside the aircraft."""
        return self._line.course_rad(state.latitude_rad, state.longitude_rad)

    def crab_rad(self, state: AircraftState) -> float:
        """Return how far the nose points to the right of the course."""
        return wrap_angle(state.heading_rad - self.course_rad(state))

    def turn_rate(self, state: AircraftState) -> float:
        """Return the turn rate (rad/s) that leads to the centre line and along it."""
        speed = max(state.ground_speed_m_s, 1.0)
        offset = within(self._cross_track_gain * self.cross_track_m(state) / speed, INTERCEPT_ANGLE)
        return self._course_gain * wrap_angle(self.course_rad(state) - offset - state.track_rad)

    def above_glide_path_m(self, state: AircraftState, to_go_m: float | None = None) -> float:
        """Return how far above the glide path the wheels are.

        The distance to the threshold is that along the final approach, or ``to_go_m`` along another
        way.
        """
        path = (self._aim - (self.along_m(state) if to_go_m is None else -to_go_m)) * self._slope
        return state.altitude_m - self._wheels_at_threshold_m - path

    def glide_rate(self, state: AircraftState) -> float:
        """Return the vertical rate (m/s) of the glide path at the present ground speed."""
        return -self._slope * state.ground_speed_m_s

    def vertical_rate(self, state: AircraftState, to_go_m: float | None = None) -> float:
        """Return the vertical rate (m/s) that leads to the glide path and along it.

        The distance to the threshold is as of `above_glide_path_m`.
        """
        correction = self._glide_gain * self.above_glide_path_m(state, to_go_m)
        return self.glide_rate(state) - within(correction, GREATEST_CORRECTION_M_S)

    def require_reachable(self, state: AircraftState) -> None:
        """Raise ValueError unless the approach can be flown from here."""
        ident = self.runway.ident
        to_go = -self.along_m(state)
        if to_go <= 0.0:
            raise ValueError(
                f"the threshold of runway {ident} is {-to_go:.0f} m behind; expected it ahead"
            )
        if to_go > FARTHEST_M:
            raise ValueError(
                f"runway {ident} is {to_go / NAUTICAL_MILE:.0f} NM away; expected at most "
                f"{FARTHEST_M / NAUTICAL_MILE:.0f} NM"
            )
        aside = math.atan2(self.cross_track_m(state), to_go)
        if abs(aside) > WIDEST_INTERCEPT:
            raise ValueError(
                f"the aircraft is {math.degrees(abs(aside)):.0f} degrees off the final approach "
                f"course of runway {ident}; expected at most "
                f"{math.degrees(WIDEST_INTERCEPT):.0f} degrees"
            )
        turn = wrap_angle(self.course_rad(state) - state.track_rad)
        if abs(turn) > math.pi / 2.0:
            raise ValueError(
                f"the aircraft flies away from runway {ident}, {math.degrees(abs(turn)):.0f} "
                "degrees off its course; expected at most 90 degrees"
            )


def require_side_step(state: AircraftState, final: Final) -> None:
    """Raise ValueError unless another runway's final approach can still be joined."""
    final.require_reachable(state)
    ident = final.runway.ident
    height = state.altitude_m - final.runway.elevation_m
    if height < LOWEST_M:
        raise ValueError(
            f"side_step to runway {ident} at {height / FOOT:.0f} ft above it; expected at least "
            f"{LOWEST_M / FOOT:.0f} ft"
        )
    aside = abs(final.cross_track_m(state))
    remaining = -final.along_m(state) - JOINED_M
    if aside > remaining * math.tan(STEEPEST_RAD):
        raise ValueError(
            f"side_step to runway {ident}, {aside:.0f} m aside with {remaining:.0f} m left to join "
            f"it; expected at most {math.degrees(STEEPEST_RAD):.0f} degrees to the side"
        )
