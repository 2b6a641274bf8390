"""The radio horizon: how far a wave travels before the round Earth is in its way."""

from __future__ import annotations

import math

from airhilt.geodesy.wgs84 import SEMI_MAJOR_AXIS_M

EFFECTIVE_EARTH_RADIUS = 4.0 / 3.0
"""Factor on the Earth's radius for refraction in a standard atmosphere (ITU-R P.310)."""
LEAST_ANTENNA_HEIGHT_M = 2.0
"""Height of a transponder's antenna on the roof of a vehicle, above the ground in m."""


def radio_horizon_m(*heights_m: float) -> float:
    """Return the longest distance at which two antennas at these heights are in line of sight.

    With heights in feet this is 1.23 nautical miles times the sum of their square roots.
    """
    radius_m = EFFECTIVE_EARTH_RADIUS * SEMI_MAJOR_AXIS_M
    return sum(math.sqrt(2.0 * radius_m * height) for height in heights_m)
