"""The final approach of a runway, in the airport's plane."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from airhilt.geodesy.wgs84 import Place
from airhilt.units import wrap_angle
from airhilt.world.flight.curves import Pose
from airhilt.world.surface.runway import RunwayEnd

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Layout


class FinalApproach:
    """Final approach of a runway, in the airport's plane."""

    def __init__(self, airport: Layout, runway: RunwayEnd) -> None:
        self.runway = runway
        self._frame = airport.local_frame
        self._east, self._north = airport.local_frame.to_local(runway.threshold)
        self._sin, self._cos = math.sin(runway.course_rad), math.cos(runway.course_rad)

    def before_m(self, here: Place) -> float:
        """Return the distance to the threshold along the approach, negative beyond it."""
        east, north = self._off_threshold(here)
        return -(east * self._sin + north * self._cos)

    def right_m(self, here: Place) -> float:
        """Return the distance to the right of the approach."""
        east, north = self._off_threshold(here)
        return east * self._cos - north * self._sin

    def angle_rad(self, track_rad: float) -> float:
        """Return the angle between a track and the approach, positive to the right."""
        return wrap_angle(track_rad - self.runway.course_rad)

    def pose(self, before_m: float, right_m: float = 0.0, angle_rad: float = 0.0) -> Pose:
        """Return the pose so far before the threshold, to the right, and off the course."""
        return Pose(
            self._east - before_m * self._sin + right_m * self._cos,
            self._north - before_m * self._cos - right_m * self._sin,
            self.runway.course_rad + angle_rad,
        )

    def _off_threshold(self, here: Place) -> tuple[float, float]:
        east, north = self._frame.to_local(here)
        return east - self._east, north - self._north
