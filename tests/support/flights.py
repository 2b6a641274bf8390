"""Aircraft in cruise, on final approach and on the ground, and flying them for a while."""

from __future__ import annotations

import math
from collections.abc import Iterator

from geographiclib.geodesic import Geodesic

from airhilt.geodesy.wgs84 import Place
from airhilt.units import DEGREE, FOOT, KNOT, NAUTICAL_MILE
from airhilt.world.flight import (
    Aircraft,
    AircraftState,
    AircraftType,
    Atmosphere,
    InitialCondition,
    load_aircraft_type,
)
from airhilt.world.flight.state import OnGround
from airhilt.world.surface.runway import RunwayEnd

CRUISE = {"737": (35_000, 260), "B747": (35_000, 270), "c172p": (5_000, 95), "c310": (6_000, 150)}
"""Altitude (ft) and calibrated airspeed (kt)."""


def in_cruise(
    name: str,
    *,
    altitude_ft: float | None = None,
    airspeed_kt: float | None = None,
    track_deg: float = 60.0,
    vertical_rate_m_s: float = 0.0,
    seed: int = 1,
    atmosphere: Atmosphere | None = None,
    terrain_elevation_m: float = 0.0,
    may_land: bool = True,
    kind: AircraftType | None = None,
) -> Aircraft:
    """Return an aircraft of a type at 47 N 8 E, in its typical cruise where not told otherwise."""
    altitude, airspeed = CRUISE[name]
    initial = InitialCondition(
        latitude_rad=47.0 * DEGREE,
        longitude_rad=8.0 * DEGREE,
        altitude_m=(altitude_ft or altitude) * FOOT,
        track_rad=track_deg * DEGREE,
        calibrated_airspeed_m_s=(airspeed_kt or airspeed) * KNOT,
        vertical_rate_m_s=vertical_rate_m_s,
    )
    return Aircraft(
        kind or load_aircraft_type(name),
        initial,
        seed=seed,
        atmosphere=atmosphere or Atmosphere(),
        terrain_elevation_m=terrain_elevation_m,
        may_land=may_land,
    )


LATITUDE, LONGITUDE, COURSE = 38.85, -77.04, 10.0
"""Threshold of a runway and its true course, in degrees."""
RUNWAY_LENGTH_M = 2_200.0
RUNWAY_ELEVATION_M = 4.0


def along_runway(along_m: float, right_m: float = 0.0) -> Place:
    """Return the place so far beyond the threshold and to the right of the centre line."""
    on_line = Geodesic.WGS84.Direct(LATITUDE, LONGITUDE, COURSE, along_m)
    there = Geodesic.WGS84.Direct(on_line["lat2"], on_line["lon2"], COURSE + 90.0, right_m)
    return there["lat2"] * DEGREE, there["lon2"] * DEGREE


def make_runway(ident: str, right_m: float = 0.0) -> RunwayEnd:
    """Return the runway, or a parallel one to the right of it."""
    threshold = along_runway(0.0, right_m)
    return RunwayEnd(
        ident=ident,
        start=threshold,
        threshold=threshold,
        end=along_runway(RUNWAY_LENGTH_M, right_m),
        elevation_m=RUNWAY_ELEVATION_M,
        width_m=45.0,
        length_m=RUNWAY_LENGTH_M,
        displaced_m=0.0,
        course_rad=COURSE * DEGREE,
    )


RUNWAY = make_runway("01")


def on_final(
    name: str,
    *,
    distance_nm: float = 2.0,
    offset_m: float = 0.0,
    altitude_m: float | None = None,
    airspeed_kt: float | None = None,
    track_deg: float = COURSE,
    on_approach: bool = True,
    seed: int = 1,
    atmosphere: Atmosphere | None = None,
) -> Aircraft:
    """Return an aircraft on the final approach of the runway, where not told otherwise."""
    kind = load_aircraft_type(name)
    slope = math.tan(3.0 * DEGREE)
    glide_path_m = (distance_nm * NAUTICAL_MILE + kind.landing.aim_m) * slope
    height = RUNWAY_ELEVATION_M + kind.dimensions.wheel_height_offset_m + glide_path_m
    airspeed = (airspeed_kt or kind.speeds.approach_kt) * KNOT
    initial = InitialCondition(
        *along_runway(-distance_nm * NAUTICAL_MILE, offset_m),
        altitude_m=height if altitude_m is None else altitude_m,
        track_rad=track_deg * DEGREE,
        calibrated_airspeed_m_s=airspeed,
        vertical_rate_m_s=-airspeed * slope if altitude_m is None else 0.0,
        on_approach=on_approach,
    )
    return Aircraft(
        kind,
        initial,
        seed=seed,
        atmosphere=atmosphere or Atmosphere(),
        terrain_elevation_m=RUNWAY_ELEVATION_M,
    )


def on_the_ground(
    name: str,
    *,
    along_m: float = 60.0,
    right_m: float = 0.0,
    heading_deg: float = COURSE,
    lined_up: bool = True,
    seed: int = 1,
    atmosphere: Atmosphere | None = None,
) -> Aircraft:
    """Return an aircraft on its wheels, lined up on the runway where not told otherwise."""
    return Aircraft(
        load_aircraft_type(name),
        OnGround(*along_runway(along_m, right_m), heading_deg * DEGREE, lined_up),
        seed=seed,
        atmosphere=atmosphere or Atmosphere(),
        terrain_elevation_m=RUNWAY_ELEVATION_M,
    )


def states(aircraft: Aircraft, seconds: float) -> Iterator[AircraftState]:
    """Fly on, and yield the state after every tick."""
    for _ in range(round(seconds * 20)):
        aircraft.advance()
        yield aircraft.state
