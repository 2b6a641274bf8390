"""Tests on how an actor flies: what it has reached, passed or left."""

from __future__ import annotations

import math
from collections.abc import Callable

from airhilt.errors import ScenarioError
from airhilt.geodesy.relative_motion import Kinematics
from airhilt.geodesy.wgs84 import Place, azimuth, distance_m
from airhilt.scenario.models import (
    AirspeedReached,
    AltitudeReached,
    FixPassed,
    HeightAbove,
    HeightBelow,
    InPhase,
    SpeedAbove,
    TrackReached,
)
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE, seconds_to_ns
from airhilt.world.mover import Mover
from airhilt.world.site import ScenarioSite

FlownCondition = (
    InPhase | SpeedAbove | HeightBelow | HeightAbove | AltitudeReached | AirspeedReached
    | TrackReached | FixPassed
)  # fmt: skip
"""Conditions on one actor alone, without regard to runways."""
LEVEL_M = 100.0 * FOOT
SAME_CAS_M_S = 5.0 * KNOT
SAME_TRACK_RAD = 5.0 * DEGREE
OVER_M = 0.5 * NAUTICAL_MILE
ABEAM_M = 3.0 * NAUTICAL_MILE
LEFT_FOR_S = 10.0
"""Time in s after which an aircraft that moves away from an altitude has passed it before."""
LEAST_RATE_M_S = 200.0 * FOOT_PER_MINUTE
"""Least vertical rate of who climbs or descends, in m/s; level flight has less."""

BodyTest = Callable[[Mover, int], bool]
"""Returns whether a body is as a condition says, at a time in ns."""


def flown(condition: FlownCondition, site: ScenarioSite) -> BodyTest:
    """Return the test of a condition; ScenarioError: there is no such fix."""
    match condition:
        case InPhase(phases=phases):
            return lambda body, _: body.phase in phases
        case SpeedAbove(speed_kt=speed_kt):
            return lambda body, _: body.state.ground_speed_m_s > speed_kt * KNOT
        case HeightBelow(height_ft=height_ft):
            return lambda body, _: body.state.height_agl_m < height_ft * FOOT
        case HeightAbove(height_ft=height_ft):
            return lambda body, _: body.state.height_agl_m > height_ft * FOOT
        case AltitudeReached(altitude_ft=altitude_ft):
            return _altitude(altitude_ft * FOOT)
        case AirspeedReached(cas_kt=cas_kt):
            return lambda body, _: abs(_airspeed_m_s(body) - cas_kt * KNOT) < SAME_CAS_M_S
        case TrackReached(track_deg=track_deg):
            track_rad = track_deg * DEGREE
            return lambda body, _: _apart_rad(body.state.track_rad, track_rad) < SAME_TRACK_RAD
        case FixPassed(fix=fix):
            place = site.fix(fix)
            if place is None:
                raise ScenarioError(f"there is no fix {fix}")
            return lambda body, _: has_passed(body.state, place)


def _altitude(altitude_m: float) -> BodyTest:
    left_since_ns: int | None = None

    def reached(body: Mover, now_ns: int) -> bool:
        nonlocal left_since_ns
        above_m = body.state.altitude_m - altitude_m
        away_m_s = math.copysign(1.0, above_m) * body.state.vertical_rate_m_s
        if away_m_s < LEAST_RATE_M_S:
            left_since_ns = None
        elif left_since_ns is None:
            left_since_ns = now_ns
        has_left = left_since_ns is not None and now_ns - left_since_ns >= seconds_to_ns(LEFT_FOR_S)
        return has_left or abs(above_m) < LEVEL_M

    return reached


def has_passed(state: Kinematics, fix: Place) -> bool:
    """Return whether somebody is over a fix, or has it abeam."""
    here = (state.latitude_rad, state.longitude_rad)
    away_m = distance_m(here, fix)
    track_rad = math.atan2(state.velocity_east_m_s, state.velocity_north_m_s)
    is_behind = math.cos(azimuth(here, fix) - track_rad) < 0.0
    return away_m < OVER_M or (away_m < ABEAM_M and is_behind)


def _airspeed_m_s(body: Mover) -> float:
    return float(getattr(body.state, "calibrated_airspeed_m_s", math.inf))


def _apart_rad(one: float, other: float) -> float:
    return abs(math.remainder(one - other, math.tau))
