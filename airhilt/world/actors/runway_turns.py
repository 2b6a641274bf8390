"""Ways along a runway against its direction of use, and turns on it."""

from __future__ import annotations

import math

from airhilt.geodesy.wgs84 import Place, beside, onward
from airhilt.world.actors.actor import Unable
from airhilt.world.surface.runway import RunwayEnd

EDGE_M = 6.0
"""Distance of the middle of a turning aircraft from the edge of the runway, in m; assumed."""
LEAST_RADIUS_M = 6.0
"""Least radius of a turn on a runway, in m; assumed."""
FROM_START_M = 45.0
"""Distance from the beginning of a runway at which a backtracking aircraft turns, in m; assumed."""
ASIDE_M = 60.0
"""Length of the way from the centre line of a runway to its side before a turn, in m; assumed."""
ALIGNED_M = 40.0
"""Length of the straight on the centre line at the end of a turn, in m."""
STEPS = 12
"""Number of straight pieces of a turn."""


class RunwayTurns:
    """Turns on the pavement of a runway, in one direction of use."""

    def __init__(self, end: RunwayEnd) -> None:
        self._end = end
        self._radius_m = max(end.width_m / 2.0 - EDGE_M, LEAST_RADIUS_M)

    def back_from(self, along_m: float) -> list[Place]:
        """Return the way round, from on the centre line in the direction of use to against it.

        ``along_m`` is the distance from the beginning of the runway.
        """
        turn = self._half_circle(along_m + ASIDE_M, -1.0)
        return [*turn, self._at(along_m - ASIDE_M, 0.0)]

    def to_beginning(self, along_m: float) -> list[Place]:
        """Return the way back along the runway to its beginning, and round to its direction of use.

        `Unable` says that it begins there already.
        """
        turn_m = FROM_START_M + self._radius_m
        if along_m < turn_m + ASIDE_M:
            raise Unable(f"unable, already at the beginning of runway {self._end.ident}")
        aside_m = min(along_m - 1.0, turn_m + 2.0 * ASIDE_M)
        ahead_m = turn_m + ASIDE_M
        return [
            self._at(aside_m, -self._radius_m),
            *self._half_circle(turn_m, 1.0),
            self._at(ahead_m, 0.0),
            self._at(ahead_m + ALIGNED_M, 0.0),
        ]

    def _at(self, along_m: float, right_m: float) -> Place:
        end = self._end
        return beside(onward(end.start, end.course_rad, along_m), end.course_rad, right_m)

    def _half_circle(self, middle_m: float, side: float) -> list[Place]:
        """Return a half circle that begins on one side of the centre line, ahead or back."""
        radius_m = side * self._radius_m
        return [
            self._at(middle_m - radius_m * math.sin(angle), -radius_m * math.cos(angle))
            for angle in (math.pi * step / STEPS for step in range(STEPS + 1))
        ]
