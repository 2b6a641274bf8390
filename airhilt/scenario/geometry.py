"""Positions of a scenario on the WGS84 ellipsoid."""

from __future__ import annotations

import math
from dataclasses import dataclass

from geographiclib.geodesic import Geodesic

from airhilt.scenario.models import GeodeticPosition, Position
from airhilt.units import DEGREE, NAUTICAL_MILE


@dataclass(frozen=True)
class Site:
    """A place on the ground or in the air that does not move."""

    latitude_rad: float
    longitude_rad: float
    altitude_m: float = 0.0
    velocity_north_m_s: float = 0.0
    velocity_east_m_s: float = 0.0


def resolve(position: Position, centre: GeodeticPosition) -> tuple[float, float]:
    """Return a position as latitude and longitude in radians."""
    if isinstance(position, GeodeticPosition):
        return position.lat_deg * DEGREE, position.lon_deg * DEGREE
    out = Geodesic.WGS84.Direct(
        centre.lat_deg,
        centre.lon_deg,
        position.bearing_deg,
        position.distance_nm * NAUTICAL_MILE,
    )
    if position.offset_nm:
        out = Geodesic.WGS84.Direct(
            out["lat2"],
            out["lon2"],
            out["azi2"] + math.copysign(90.0, position.offset_nm),
            abs(position.offset_nm) * NAUTICAL_MILE,
        )
    return out["lat2"] * DEGREE, out["lon2"] * DEGREE


def azimuth(start: tuple[float, float], end: tuple[float, float]) -> float:
    """Return the azimuth (rad) at which the geodesic between two positions (rad) begins."""
    line = Geodesic.WGS84.Inverse(
        start[0] / DEGREE, start[1] / DEGREE, end[0] / DEGREE, end[1] / DEGREE
    )
    return float(line["azi1"]) * DEGREE
