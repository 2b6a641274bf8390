"""One direction of a runway, as those who take off and land on it need it."""

from __future__ import annotations

import math
from dataclasses import dataclass

Place = tuple[float, float]
"""Geodetic latitude and longitude, WGS84, in radians."""

GLIDE_PATH_RAD = math.radians(3.0)
"""ICAO Annex 14 volume I, 5.3.5.36, and Annex 10 volume I, 3.1.5.1.2.1, recommend 3 degrees."""


@dataclass(frozen=True, slots=True)
class RunwayEnd:
    """One direction of a runway.

    Attributes
    ----------
    ident
        Such as ``01`` or ``18C``.
    start
        Where the pavement begins on the centre line: a takeoff may begin here.
    threshold
        Where landings may begin: ``start``, or ``displaced_m`` beyond it.
    end
        Where the pavement ends.
    elevation_m
        Of the threshold.
    width_m, length_m
        Of the pavement.
    displaced_m
        From ``start`` to ``threshold``.
    course_rad
        True, from ``start`` to ``end``, in [0, 2 pi).
    """

    ident: str
    start: Place
    threshold: Place
    end: Place
    elevation_m: float
    width_m: float
    length_m: float
    displaced_m: float
    course_rad: float
    glide_path_rad: float = GLIDE_PATH_RAD
