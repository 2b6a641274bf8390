"""The outlines of what moves, from above, and how near two of them are."""

from __future__ import annotations

import functools
import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from airhilt.geodesy.relative_motion import relative
from airhilt.world.flight import AircraftType
from airhilt.world.mover import Mover

FUSELAGE_NOSE_PART = 0.5
"""Of the length, that lies before the reference point."""
WING_ROOT_AT = 0.1
"""Of the length, before the reference point, where the wing's leading edge meets the fuselage."""
TAIL_ROOT_AT = -0.38
TAIL_CHORD_PART = 0.1
"""Of the length."""


class Gap(NamedTuple):
    """Distance between the surfaces of two bodies (m); both are 0 where they touch."""

    horizontal_m: float
    vertical_m: float

    @property
    def touches(self) -> bool:
        """Whether they do."""
        return self.horizontal_m <= 0.0 and self.vertical_m <= 0.0

    @property
    def slant_m(self) -> float:
        """Distance in three dimensions."""
        return math.hypot(self.horizontal_m, self.vertical_m)


def gap(first: Mover, second: Mover, at_s: float = 0.0) -> Gap:
    """Return how far two bodies are apart, by their outlines and heights.

    Both are upright prisms: an aircraft's outline is its fuselage, its swept wing and its
    tailplane; that of everything else is a rectangle.

    Parameters
    ----------
    at_s
        How long from now, both moving straight on; negative for the past.
    """
    import shapely

    motion = relative(first.state, second.state).at(at_s)
    own = shapely.polygons(_turned(_outline(first), first.state.heading_rad))
    there = np.array((motion.east_m, motion.north_m))
    other = shapely.polygons(_turned(_outline(second), second.state.heading_rad) + there)
    low = first.state.height_agl_m + first.state.vertical_rate_m_s * at_s
    high = second.state.height_agl_m + second.state.vertical_rate_m_s * at_s
    return Gap(
        float(shapely.distance(own, other)),
        max(high - low - first.dimensions.height_m, low - high - second.dimensions.height_m, 0.0),
    )


def radius_m(body: Mover) -> float:
    """Return the radius of the circle around a body."""
    return math.hypot(body.dimensions.length_m, body.dimensions.span_m) / 2.0


def corners(body: Mover) -> npt.NDArray[np.float64]:
    """Return nose, tail, sides and centre of a body: east and north of its centre, shape (5, 2)."""
    size = body.dimensions
    ahead, aside = size.length_m / 2.0, size.span_m / 2.0
    points = np.array([(0.0, ahead), (0.0, -ahead), (aside, 0.0), (-aside, 0.0), (0.0, 0.0)])
    return _turned(points, body.state.heading_rad)


def _turned(points: npt.NDArray[np.float64], heading_rad: float) -> npt.NDArray[np.float64]:
    """Return points (right, ahead) as (east, north)."""
    sin, cos = math.sin(heading_rad), math.cos(heading_rad)
    right, ahead = points[:, 0], points[:, 1]
    return np.column_stack((right * cos + ahead * sin, ahead * cos - right * sin))


def _outline(body: Mover) -> npt.NDArray[np.float64]:
    """Return the corners of an outline, right of and ahead of the centre, shape (n, 2)."""
    kind = getattr(body, "kind", None)
    if isinstance(kind, AircraftType):
        return _aircraft_outline(kind)
    size = body.dimensions
    return _rectangle(size.span_m / 2.0, size.length_m / 2.0)


def _rectangle(aside: float, ahead: float) -> npt.NDArray[np.float64]:
    return np.array([(aside, ahead), (aside, -ahead), (-aside, -ahead), (-aside, ahead)])


@functools.lru_cache(maxsize=64)
def _aircraft_outline(kind: AircraftType) -> npt.NDArray[np.float64]:
    """Return the outline of a type: the right half, and its mirror image."""
    length, half_span = kind.dimensions.length_m, kind.dimensions.span_m / 2.0
    mesh = kind.mesh
    half_width = mesh.fuselage_diameter_m / 2.0
    nose = FUSELAGE_NOSE_PART * length
    swept = math.tan(math.radians(mesh.wing_sweep_deg)) * (half_span - half_width)
    wing = WING_ROOT_AT * length
    tail, chord = TAIL_ROOT_AT * length, TAIL_CHORD_PART * length
    right = [
        (half_width, nose - half_width),
        (half_width, wing),
        (half_span, wing - swept),
        (half_span, wing - swept - mesh.wing_tip_chord_m),
        (half_width, wing - mesh.wing_root_chord_m),
        (half_width, tail),
        (mesh.tail_span_m / 2.0, tail - chord / 2.0),
        (mesh.tail_span_m / 2.0, tail - chord),
        (half_width, tail - chord),
        (half_width, nose - length),
    ]
    left = [(-aside, ahead) for aside, ahead in reversed(right)]
    return np.array([(0.0, nose), *right, *left])
