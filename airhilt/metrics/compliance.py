"""Commands of people compared with what an advisory recommends."""

from __future__ import annotations

import math

from airhilt.commands import (
    AltitudeCommand,
    CancelTakeoffCommand,
    Command,
    EmergencyDescentCommand,
    GoAroundCommand,
    HoldPositionCommand,
    TrackCommand,
    TurnCommand,
)
from airhilt.messages import (
    CancelTakeoff,
    Climb,
    Confirm,
    GoAround,
    HoldPosition,
    MaintainLevel,
    Recommendation,
    Turn,
)

LEVEL_TOLERANCE_FT = 50.0
"""Difference from the recommended level that still complies: selectors have steps of 100 ft."""


def complies(
    recommendation: Recommendation, command: Command | None, track_deg: float | None
) -> bool:
    """Return whether an action does what is recommended, in its sense.

    Without a command the action is a call. Without a true track, in degrees, a track has no side.
    """
    match recommendation:
        case Confirm():
            return command is None
        case GoAround():
            return isinstance(command, GoAroundCommand)
        case HoldPosition() | CancelTakeoff():
            return isinstance(command, HoldPositionCommand | CancelTakeoffCommand)
        case Turn(degrees=degrees):
            turned_deg = _turn_deg(command, track_deg)
            return turned_deg is not None and degrees * turned_deg > 0.0
        case Climb() | MaintainLevel():
            return isinstance(command, AltitudeCommand | EmergencyDescentCommand) and _is_level(
                recommendation, command.altitude_ft
            )


def _is_level(recommendation: Climb | MaintainLevel, selected_ft: float) -> bool:
    above_ft = selected_ft - recommendation.altitude_ft
    if isinstance(recommendation, MaintainLevel):
        return abs(above_ft) <= LEVEL_TOLERANCE_FT
    beyond_ft = above_ft if recommendation.sense == "climb" else -above_ft
    return beyond_ft >= -LEVEL_TOLERANCE_FT


def _turn_deg(command: Command | None, track_deg: float | None) -> float | None:
    match command:
        case TurnCommand(degrees=degrees):
            return degrees
        case TrackCommand(track_deg=new_deg) if track_deg is not None:
            return math.remainder(new_deg - track_deg, 360.0)
        case _:
            return None
