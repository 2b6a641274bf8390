"""A plane for what moves: metres from places and back, at the cost of a few multiplications."""

from __future__ import annotations

import math

from airhilt.geodesy.wgs84 import Place, curvature_radii_m
from airhilt.units import wrap_angle

REACH_M = 50_000.0
"""From its origin, nobody is told to go farther in one go."""


class Plane:
    """East and north in metres, by the ellipsoid's radii of curvature at the origin.

    An equirectangular projection: north is up everywhere, so that headings are true. Places go
    in and come out again exactly; distances along a parallel are off by the fraction
    tan(latitude) * north / R: 0.06 % at 5 km north or south of an origin at latitude 39.
    `airhilt.geodesy.local_frame.LocalFrame` keeps distances better, and takes longer.

    Parameters
    ----------
    origin
        Latitude and longitude in radians.
    height_m
        Of the plane above WGS84.

    Raises
    ------
    ValueError
        The origin is no place on Earth, or is a pole.
    """

    def __init__(self, origin: Place, height_m: float) -> None:
        latitude, longitude = origin
        if not (abs(latitude) < math.radians(89.9) and math.isfinite(longitude)):
            raise ValueError(f"{origin} is no latitude and longitude in radians off the poles")
        meridional, prime_vertical = curvature_radii_m(latitude)
        self._latitude = latitude
        self._longitude = longitude
        self._north_radius_m = meridional + height_m
        self._east_radius_m = (prime_vertical + height_m) * math.cos(latitude)

    def to_local(self, place: Place) -> tuple[float, float]:
        """Return east and north of the origin in metres.

        Raises
        ------
        ValueError
            It is farther away than `REACH_M`, or no place.
        """
        east = wrap_angle(place[1] - self._longitude) * self._east_radius_m
        north = (place[0] - self._latitude) * self._north_radius_m
        if not math.hypot(east, north) <= REACH_M:
            raise ValueError(
                f"({math.degrees(place[0]):.4f}, {math.degrees(place[1]):.4f}) degrees is not "
                f"within {REACH_M / 1000.0:.0f} km"
            )
        return east, north

    def to_place(self, east_m: float, north_m: float) -> Place:
        """Return the place whose east and north these are."""
        longitude = self._longitude + east_m / self._east_radius_m
        if abs(longitude) > math.pi:
            longitude = wrap_angle(longitude)
        return self._latitude + north_m / self._north_radius_m, longitude
