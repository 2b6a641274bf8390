"""One direction of a runway, for takeoffs and landings."""

from __future__ import annotations

import math
from dataclasses import dataclass

from airhilt.geodesy.wgs84 import Place

GLIDE_PATH_RAD = math.radians(3.0)
"""Glide path angle, in rad: 3 degrees (ICAO Annex 14 volume I, 5.3.5.36, and Annex 10 volume I,
3.1.5.1.2.1)."""


@dataclass(frozen=True, slots=True)
class RunwayEnd:
    """One direction of a runway."""

    ident: str
    """Designator such as ``01`` or ``18C``."""
    start: Place
    """Beginning of the pavement on the centre line: a takeoff may begin here."""
    threshold: Place
    """Beginning of the part for landings: ``start``, or ``displaced_m`` beyond it."""
    end: Place
    """End of the pavement on the centre line."""
    elevation_m: float
    """Elevation of the threshold."""
    width_m: float
    length_m: float
    """Width and length of the pavement."""
    displaced_m: float
    """Distance from ``start`` to ``threshold``."""
    course_rad: float
    """True course from ``start`` to ``end``, in [0, 2 pi)."""
    glide_path_rad: float = GLIDE_PATH_RAD
