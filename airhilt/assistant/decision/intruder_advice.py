"""Recommendations to stay clear of what only cameras of an aircraft in flight show."""

from __future__ import annotations

import math

from airhilt.assistant.decision.approach import Approach
from airhilt.assistant.decision.resolution import (
    BUFFER_FT,
    STRONG_VERTICAL_RATE_FPM,
    TURN_DEG,
)
from airhilt.assistant.decision.visual_tracks import VisualTrack
from airhilt.messages import AdsbReport, Climb, Turn
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE

LEVEL_STEP_FT = 100.0
LEAST_HEIGHT_M = 600.0
"""Height, in m, below which nobody is recommended to descend."""
LEVEL_RAD = 0.5 * DEGREE
"""Angle from the horizon, in rad, within which an aircraft is at about the same level."""
ABOVE_SIZES = 1.0
"""Height in its own sizes from which an aircraft passes above."""


def evasion(
    track: VisualTrack, approach: Approach, report: AdsbReport | None, vertical_m: float
) -> Climb | Turn:
    """Return how to stay clear of something: climb or descend away from it, or turn right.

    Within half a minute more distance is gained vertically, and less of it is needed: the vertical
    minimum. `BUFFER_FT` beyond it is what a direction that is wrong by `LEVEL_RAD` makes of 7 km,
    from where no light aircraft is seen. Aircraft that meet head-on, and one that overtakes, turn
    right (14 CFR 91.113).

    Parameters
    ----------
    report
        Last report of the aircraft that the camera is on; None if there is none.
    vertical_m
        Vertical distance to keep, in m.
    """
    if report is None or report.altitude_ft is None:
        return Turn(degrees=TURN_DEG)
    sense = _sense(track, approach, report.vertical_rate_fpm * FOOT_PER_MINUTE)
    climb_ft = vertical_m / FOOT + BUFFER_FT
    if sense < 0 and track.last.geometry.view.height_m - climb_ft * FOOT < LEAST_HEIGHT_M:
        return Turn(degrees=TURN_DEG)
    level = (report.altitude_ft + sense * climb_ft) / LEVEL_STEP_FT
    rounded = math.ceil(level) if sense > 0 else math.floor(level)
    return Climb(
        sense="climb" if sense > 0 else "descend",
        altitude_ft=rounded * LEVEL_STEP_FT,
        vertical_rate_fpm=STRONG_VERTICAL_RATE_FPM,
    )


def _sense(track: VisualTrack, approach: Approach, vertical_rate_m_s: float) -> int:
    """Return 1 to climb and -1 to descend, away from where it is or will be."""
    above = approach.passes_above()
    turns = abs(approach.turning_rad_s[1]) > 2.0 * approach.turning_error
    if abs(above) > ABOVE_SIZES and turns:
        return -1 if above > 0.0 else 1
    if track.label == "bird":
        return 1  # Birds that take fright dive.
    elevation_rad = track.last.ray.elevation_rad
    if abs(elevation_rad) > LEVEL_RAD:
        return -1 if elevation_rad > 0.0 else 1
    return -1 if vertical_rate_m_s < 0.0 else 1
