"""Distances between bodies, by their outlines and heights."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from airhilt.geodesy.relative_motion import relative
from airhilt.shapes.outline import Points, aircraft_outline, turned
from airhilt.units import FOOT
from airhilt.world.flight import AircraftType
from airhilt.world.mover import Mover

NARROW_M = 100.0 * FOOT
"""Distance between two outlines, in m, below which only chance has avoided a collision: the FAA's
degree of hazard "critical" of near midair collisions."""


class Gap(NamedTuple):
    """Distance between the surfaces of two bodies (m); both are 0 where they touch."""

    horizontal_m: float
    vertical_m: float

    @property
    def touches(self) -> bool:
        """True if they touch."""
        return self.horizontal_m <= 0.0 and self.vertical_m <= 0.0

    @property
    def slant_m(self) -> float:
        """Distance in three dimensions."""
        return math.hypot(self.horizontal_m, self.vertical_m)


def gap(first: Mover, second: Mover, at_s: float = 0.0) -> Gap:
    """Return how far two bodies are apart.

    Both are upright prisms: an aircraft's outline is its fuselage, its swept wing and its
    tailplane; that of everything else is a rectangle.

    ``at_s`` is a time from now, in s, in straight movement; negative for the past.
    """
    import shapely

    motion = relative(first.state, second.state).at(at_s)
    own = shapely.polygons(turned(_outline(first), first.state.heading_rad))
    there = np.array((motion.east_m, motion.north_m))
    other = shapely.polygons(turned(_outline(second), second.state.heading_rad) + there)
    low = first.state.height_agl_m + first.state.vertical_rate_m_s * at_s
    high = second.state.height_agl_m + second.state.vertical_rate_m_s * at_s
    return Gap(
        float(shapely.distance(own, other)),
        max(high - low - first.dimensions.height_m, low - high - second.dimensions.height_m, 0.0),
    )


def radius_m(body: Mover) -> float:
    """Return the radius of the circle around a body."""
    return math.hypot(body.dimensions.length_m, body.dimensions.span_m) / 2.0


def corners(body: Mover) -> Points:
    """Return nose, tail, sides and centre of a body: east and north of its centre, shape (5, 2)."""
    size = body.dimensions
    ahead, aside = size.length_m / 2.0, size.span_m / 2.0
    points = np.array([(0.0, ahead), (0.0, -ahead), (aside, 0.0), (-aside, 0.0), (0.0, 0.0)])
    return turned(points, body.state.heading_rad)


def _outline(body: Mover) -> Points:
    """Return the corners of an outline, right of and ahead of the centre."""
    kind = getattr(body, "kind", None)
    if isinstance(kind, AircraftType):
        return aircraft_outline(kind)
    aside, ahead = body.dimensions.span_m / 2.0, body.dimensions.length_m / 2.0
    return np.array([(aside, ahead), (aside, -ahead), (-aside, -ahead), (-aside, ahead)])
