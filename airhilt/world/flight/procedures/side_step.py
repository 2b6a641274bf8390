"""Side-step: a visual change from the final approach of one runway to that of another."""

from __future__ import annotations

import math

from airhilt.units import DEGREE, FOOT
from airhilt.world.flight.procedures.final import Final
from airhilt.world.flight.state import AircraftState

LOWEST_M = 300.0 * FOOT
"""Least height above the threshold at which a side-step begins, in m."""
STEEPEST_RAD = 20.0 * DEGREE
"""Greatest angle to the place where the other course must have been joined, in rad."""
JOINED_M = 200.0 * FOOT / math.tan(3.0 * DEGREE)
"""Distance from the threshold at which it must be joined, in m: 200 ft on the usual glide path."""


def require_side_step(state: AircraftState, final: Final) -> None:
    """Check that another runway's final approach can still be joined.

    Raises
    ------
    ValueError
        The aircraft is too low, or too far aside, or that approach cannot be flown from here.
    """
    final.require_reachable(state)
    ident = final.runway.ident
    height = state.altitude_m - final.runway.elevation_m
    if height < LOWEST_M:
        raise ValueError(
            f"side_step to runway {ident} at {height / FOOT:.0f} ft above it; expected at least "
            f"{LOWEST_M / FOOT:.0f} ft"
        )
    aside = abs(final.cross_track_m(state))
    remaining = -final.along_m(state) - JOINED_M
    if aside > remaining * math.tan(STEEPEST_RAD):
        raise ValueError(
            f"side_step to runway {ident}, {aside:.0f} m aside with {remaining:.0f} m left to join "
            f"it; expected at most {math.degrees(STEEPEST_RAD):.0f} degrees to the side"
        )
