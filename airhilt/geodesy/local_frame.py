"""East and north in metres around a place on the ellipsoid.

`LocalFrame` is the one planar projection of AIRHILT. It is orthographic: the east and north axes of
the plane that touches the WGS84 ellipsoid at the origin. It takes about 1 us for a place.
"""

from __future__ import annotations

import math

from airhilt.geodesy.wgs84 import (
    ECCENTRICITY_SQUARED,
    SEMI_MAJOR_AXIS_M,
    Place,
    curvature_radii_m,
    dot,
    earth_centred,
    horizontal_axes,
    vertical,
)

REACH_M = 100_000.0
"""Greatest distance of a place from the origin, in m."""


class LocalFrame:
    """East and north in metres from an origin on the ellipsoid that is no pole.

    ``to_place`` undoes ``to_local`` to less than a micrometre within 10 km of the origin. The
    projection leaves out the Earth's curvature, so the distance between two places comes out
    short of the geodesic by at most the fraction r2 / (2 R2), r their distance from the origin
    and R the Earth's radius: 3e-7 within 5 km (1 mm in 3 km), 1.3e-6 within 10 km. North is
    that of the origin: a bearing in the frame differs from a true azimuth by the convergence of
    the meridians, at most 0.03 degrees for each kilometre east at latitude 72, 0.007 at 39.

    Distances are true at ``height_m`` above the ellipsoid: those on the ellipsoid are stretched by
    its share in the mean radius of curvature at the origin.
    """

    def __init__(self, origin: Place, height_m: float = 0.0) -> None:
        latitude, longitude = origin
        if not (abs(latitude) < math.pi / 2.0 and math.isfinite(longitude)):
            raise ValueError(f"{origin} is no latitude and longitude in radians off the poles")
        self.origin = origin
        meridional, prime_vertical = curvature_radii_m(latitude)
        self._scale = 1.0 + height_m / math.sqrt(meridional * prime_vertical)
        self._centre = earth_centred(origin)
        self._east, self._north = horizontal_axes(origin)
        self._up = vertical(origin)

    def to_local(self, place: Place) -> tuple[float, float]:
        """Return east and north of the origin in metres."""
        there = earth_centred(place)
        offset = (
            there[0] - self._centre[0],
            there[1] - self._centre[1],
            there[2] - self._centre[2],
        )
        scale = self._scale
        return scale * dot(self._east, offset), scale * dot(self._north, offset)

    def to_place(self, east_m: float, north_m: float) -> Place:
        """Return the place whose east and north these are; a ValueError if it is beyond 100 km."""
        if not math.hypot(east_m, north_m) <= REACH_M:
            raise ValueError(
                f"east {east_m:.0f} m, north {north_m:.0f} m is beyond the local frame's 100 km"
            )
        east, north = east_m / self._scale, north_m / self._scale
        (cx, cy, cz), (ex, ey, _), (nx, ny, nz) = self._centre, self._east, self._north
        x, y, z = cx + ex * east + nx * north, cy + ey * east + ny * north, cz + nz * north
        # From the point in the plane, go along the vertical to the ellipsoid x2 + y2 + z2/k = a2.
        ux, uy, uz = self._up
        k = 1.0 - ECCENTRICITY_SQUARED
        a = ux * ux + uy * uy + uz * uz / k
        b = ux * x + uy * y + uz * z / k
        c = x * x + y * y + z * z / k - SEMI_MAJOR_AXIS_M**2
        rise = -c / (b + math.sqrt(b * b - a * c))
        x, y, z = x + ux * rise, y + uy * rise, z + uz * rise
        return math.atan2(z, k * math.hypot(x, y)), math.atan2(y, x)
