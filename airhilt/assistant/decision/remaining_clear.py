"""Turns by which an aircraft remains well clear: the free part of its track bands.

DO-365B asks a system for bands of tracks that lead to a violation, and leaves the choice among the
others to the pilot. The choice here is an assumption: the smallest turn that stays well clear for
the look-ahead, to the right rather than to the left, as both turn that meet head-on (ICAO Annex 2,
3.2.2.2). The other one is taken to fly straight on. The turn is begun after the response time, and
its duration is part of that.
"""

from __future__ import annotations

import math

from airhilt.geodesy.relative_motion import Relative
from airhilt.messages import Turn
from airhilt.surveillance.well_clear import (
    CORRECTIVE,
    LOOK_AHEAD_S,
    Gap,
    Volume,
    time_to_violation_s,
)
from airhilt.units import DEGREE

TURNS_DEG = tuple(sign * degrees for degrees in range(10, 100, 10) for sign in (1, -1))
"""Turns that are tried, to the right if positive, the smallest first; steps are an assumption."""
RESPONSE_S = 15.0
"""Time for the pilot's decision and the turn, in s; an assumption."""

Velocity = tuple[float, float]
"""North and east, in m/s."""


def smallest_turn(motion: Relative, own: Velocity, gap: Gap) -> Turn | None:
    """Return the smallest turn of the own aircraft that remains well clear; None if none does.

    There is none either if the two are past each other before a turn is made.

    Parameters
    ----------
    motion
        The other one relative to the own aircraft.
    own
        Own velocity over the ground.
    """
    if motion.time_to_closest_approach_s() <= RESPONSE_S:
        return None
    for degrees in TURNS_DEG:
        if _stays_clear(motion, own, gap, degrees * DEGREE):
            return Turn(degrees=degrees)
    return None


def _stays_clear(motion: Relative, own: Velocity, gap: Gap, turn_rad: float) -> bool:
    """Return whether nothing is violated after a turn, within the look-ahead."""
    cosine, sine = math.cos(turn_rad), math.sin(turn_rad)
    north, east = own
    later = motion.at(RESPONSE_S)
    turned = Relative(
        later.north_m,
        later.east_m,
        later.velocity_north_m_s + north - (north * cosine - east * sine),
        later.velocity_east_m_s + east - (north * sine + east * cosine),
    )
    gap_later = Gap(gap.gap_m + gap.rate_m_s * RESPONSE_S, gap.rate_m_s)
    volume: Volume = CORRECTIVE.volume
    violation_s = time_to_violation_s(turned, gap_later, volume)
    return violation_s is None or violation_s > LOOK_AHEAD_S
