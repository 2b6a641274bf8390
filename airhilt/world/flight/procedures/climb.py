"""Values that the climbs after a takeoff and after a go-around share."""

from __future__ import annotations

from airhilt.units import FOOT

CLEAN_UP_HEIGHT_M = 400.0 * FOOT
"""Least height of turns, acceleration and flap retraction, in m (14 CFR 25.111(c)(4))."""
LEVER_PER_OVERSPEED_S_M = 0.05
"""Reduction of the lever per excess of airspeed, in s/m, where the steepest climb leaves thrust."""
