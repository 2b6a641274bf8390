"""Places and conditions in which the actors of a scenario begin."""

from __future__ import annotations

import math

from airhilt.geodesy.positions import RunwayPosition
from airhilt.geodesy.wgs84 import Place, azimuth, onward
from airhilt.scenario.models import Airborne, GroundStart, HoldingShort, LinedUp, OnFinal, Standing
from airhilt.units import DEGREE, FOOT, KNOT, NAUTICAL_MILE
from airhilt.world.flight.state import InitialCondition
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.ways import NOSE_MARGIN_M

AIM_POINT_M = 300.0
"""Distance from the threshold to where the glide path meets the runway, in m (ICAO Annex 14
volume I, 5.2.5)."""
LINED_UP_M = 30.0
"""Distance from the beginning of the runway to the tail of a lined-up aircraft, in m."""


def airborne(initial: Airborne, site: ScenarioSite, route: list[Place]) -> InitialCondition:
    """Return the condition in which a flight begins in the air."""
    place = site.place(initial.position)
    track = azimuth(place, route[0]) if initial.track_deg is None else initial.track_deg * DEGREE
    return InitialCondition(
        *place,
        altitude_m=initial.altitude_ft * FOOT,
        track_rad=track,
        calibrated_airspeed_m_s=initial.cas_kt * KNOT,
    )


def on_final(initial: OnFinal, site: ScenarioSite, speed_m_s: float) -> InitialCondition:
    """Return the condition in which a flight begins on the glide path, at approach speed."""
    runway = site.runway(initial.runway)
    distance_m = initial.distance_nm * NAUTICAL_MILE
    place = site.place(RunwayPosition(type="runway", runway=initial.runway, along_m=-distance_m))
    slope = math.tan(runway.glide_path_rad)
    return InitialCondition(
        *place,
        altitude_m=site.ground_m + (distance_m + AIM_POINT_M) * slope,
        track_rad=azimuth(place, runway.end),
        calibrated_airspeed_m_s=speed_m_s,
        vertical_rate_m_s=-speed_m_s * slope,
        on_approach=True,
    )


def on_ground(initial: GroundStart, site: ScenarioSite, length_m: float) -> tuple[Place, float]:
    """Return the place of the centre of an actor of some length, and its heading."""
    match initial:
        case LinedUp(runway=ident):
            runway = site.runway(ident)
            return (
                onward(runway.start, runway.course_rad, LINED_UP_M + length_m / 2.0),
                runway.course_rad,
            )
        case HoldingShort(runway=ident, taxiway=taxiway, before_m=before_m):
            hold = site.airport.hold(ident, taxiway)
            back_m = length_m / 2.0 + NOSE_MARGIN_M + before_m
            return onward(hold.place, hold.heading_rad, -back_m), hold.heading_rad
        case Standing(position=position, heading_deg=heading_deg):
            return site.place(position), heading_deg * DEGREE
