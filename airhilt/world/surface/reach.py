"""The greatest distance that a vehicle or an animal can go at once."""

from __future__ import annotations

import math

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place

REACH_M = 50_000.0
"""Greatest distance of a place to go to, in m."""


def within_reach(local_frame: LocalFrame, place: Place) -> tuple[float, float]:
    """Return east and north of a place to go to, from the origin of a local frame.

    Raises
    ------
    ValueError
        The place is farther away than `REACH_M`, or is none.
    """
    east, north = local_frame.to_local(place)
    if not math.hypot(east, north) <= REACH_M:
        raise ValueError(
            f"({math.degrees(place[0]):.4f}, {math.degrees(place[1]):.4f}) degrees is not "
            f"within {REACH_M / 1000.0:.0f} km"
        )
    return east, north
