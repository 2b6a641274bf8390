"""Time until somebody has left a runway."""

from __future__ import annotations

from airhilt.assistant.decision.mobiles import BRAKING_M_S2, STANDING_M_S, TAKEOFF_M_S2, Use
from airhilt.assistant.decision.situation import Obstacle

LIFT_OFF_M_S = 75.0
"""Speed at which a departure has left the ground, in m/s."""
TURN_OFF_M_S = 8.0
"""Speed to which a landing brakes before it turns off, in m/s."""
TURN_OFF_S = 12.0
"""Time from then until it has left the runway, in s."""


def leaving_s(obstacle: Obstacle, own: Use | None, use: Use) -> float | None:
    """Return the time until a mobile is off the runway or in the air, in s; None if it stays.

    Parameters
    ----------
    own
        Use of a runway by the mobile itself; None if it does not use one.
    use
        Use of the runway by somebody else, who comes.
    """
    mobile, speed = obstacle.mobile, obstacle.mobile.speed_m_s
    if own is not None and own.kind == "departure" and own.strip is use.strip:
        follows = own.direction is use.direction
        return max(LIFT_OFF_M_S - speed, 0.0) / TAKEOFF_M_S2 if follows else None
    if speed < STANDING_M_S:
        return None
    straight_s = obstacle.way.exit_m / speed
    if not mobile.landed:
        return straight_s
    return min(straight_s, max(speed - TURN_OFF_M_S, 0.0) / BRAKING_M_S2 + TURN_OFF_S)
