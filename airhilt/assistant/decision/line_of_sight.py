"""Directions, and positions on the ground and in the air, of what is at a place in a picture.

Directions are unit vectors towards east, north and up at the camera, whatever its attitude: what a
camera sees does not move when its carrier banks.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from airhilt.assistant.decision.aerodrome import Vector
from airhilt.imaging.boxes import centre
from airhilt.imaging.pinhole import Pinhole
from airhilt.messages import Box, CameraView
from airhilt.units import DEGREE

BOX_ERROR_PX = 1.5
"""Standard deviation of a side of a box, in pixels, with what is not known of the lens."""
LEAST_DEPRESSION_RAD = 0.1 * DEGREE
"""A line of sight flatter than this, in rad, gives no position on the ground."""
GREATEST_SHARE_OF_RANGE = 0.5
"""Largest error of a distance, as a share of it, with which a position counts."""
LEAST_PARALLAX_RAD = 1.0 * DEGREE
"""Lines of sight that meet under a smaller angle, in rad, give no distance."""
MEETING_SIGMAS = 3.0
SAME_OBJECT_M = 6.0
"""Distance between the ends of one thing that two cameras see, in m."""


class Ray(NamedTuple):
    """A direction, as a unit vector."""

    east: float
    north: float
    up: float

    @classmethod
    def towards(cls, east: float, north: float, up: float) -> Ray:
        """Return the direction of an offset other than 0."""
        length = math.sqrt(east * east + north * north + up * up)
        return cls(east / length, north / length, up / length)

    @property
    def elevation_rad(self) -> float:
        """Angle above the horizon, in rad."""
        return math.asin(min(max(self.up, -1.0), 1.0))

    @property
    def azimuth_rad(self) -> float:
        """Angle from north, clockwise, in rad."""
        return math.atan2(self.east, self.north)

    def angle_to(self, other: Ray) -> float:
        """Return the angle between two directions, in rad."""
        cross = (
            self.north * other.up - self.up * other.north,
            self.up * other.east - self.east * other.up,
            self.east * other.north - self.north * other.east,
        )
        dot = self.east * other.east + self.north * other.north + self.up * other.up
        return math.atan2(math.hypot(*cross), dot)

    def offset_to(self, other: Ray) -> tuple[float, float]:
        """Return the angles by which a near direction lies to the right and above, in rad."""
        turn = math.remainder(other.azimuth_rad - self.azimuth_rad, math.tau)
        middle = 0.5 * (self.elevation_rad + other.elevation_rad)
        return turn * math.cos(middle), other.elevation_rad - self.elevation_rad


class PictureGeometry:
    """Position, attitude and lens of a camera at the instant of a picture."""

    def __init__(self, view: CameraView) -> None:
        self.view = view
        self._lens = Pinhole(view)
        self.focal_px = self._lens.focal_px
        self.error_rad = BOX_ERROR_PX / self.focal_px

    @cached_property
    def _axes(self) -> tuple[Ray, Ray, Ray]:
        """Directions in the world of the camera's right, down and ahead."""
        right, down, ahead = (Ray(*axis) for axis in self._lens.axes.T.tolist())
        return right, down, ahead

    def ray(self, x_px: float, y_px: float) -> Ray:
        """Return the direction towards a place in the picture."""
        x, y, _ = self._lens.direction(x_px, y_px)
        right, down, ahead = self._axes
        return Ray.towards(*(a + x * r + y * d for r, d, a in zip(right, down, ahead, strict=True)))

    def pixel(self, ray: Ray) -> tuple[float, float] | None:
        """Return where a direction is in the picture, or beyond its edges; None if behind."""
        x, y, z = (sum(a * b for a, b in zip(axis, ray, strict=True)) for axis in self._axes)
        return self._lens.pixel(x, y, z)

    def middle(self, box: Box) -> Ray:
        """Return the direction towards the middle of a box."""
        return self.ray(*centre(box))

    def foot(self, box: Box) -> Ray:
        """Return the direction towards the middle of the lower side of a box."""
        return self.ray((box[0] + box[2]) / 2.0, box[3])

    def touches_edge(self, box: Box) -> bool:
        """Return whether a box reaches the edge of the picture, and may go on beyond it."""
        left, top, right, bottom = box
        width, height = self.view.width_px, self.view.height_px
        return left <= 1.0 or top <= 1.0 or right >= width - 1.0 or bottom >= height - 1.0

    def angular_size(self, box: Box) -> tuple[float, float]:
        """Return width and height of a box, in rad."""
        x, y, _ = self._lens.direction(*centre(box))
        shrunk = 1.0 / (1.0 + x * x + y * y) / self.focal_px
        return (box[2] - box[0]) * shrunk, (box[3] - box[1]) * shrunk


class GroundFix(NamedTuple):
    """A position on the ground, with the variances and the covariance of its error in m2."""

    point: Vector
    east_m2: float
    north_m2: float
    both_m2: float

    def is_same(self, other: GroundFix, sigmas: float = MEETING_SIGMAS) -> bool:
        """Return whether two positions may be one, by their errors."""
        east, north = other.point.east - self.point.east, other.point.north - self.point.north
        a = self.east_m2 + other.east_m2 + SAME_OBJECT_M**2
        b = self.north_m2 + other.north_m2 + SAME_OBJECT_M**2
        c = self.both_m2 + other.both_m2
        squared = (b * east * east - 2.0 * c * east * north + a * north * north) / (a * b - c * c)
        return squared <= sigmas * sigmas

    def merged(self, other: GroundFix) -> GroundFix:
        """Return the position that two independent ones give together."""
        mine, its = self._information(), other._information()
        e, n, c = (a + b for a, b in zip(mine, its, strict=True))
        det = e * n - c * c
        weighed = [
            (i[0] * s.point.east + i[2] * s.point.north, i[2] * s.point.east + i[1] * s.point.north)
            for i, s in ((mine, self), (its, other))
        ]
        x, y = (weighed[0][axis] + weighed[1][axis] for axis in (0, 1))
        place = Vector((n * x - c * y) / det, (e * y - c * x) / det)
        return GroundFix(place, n / det, e / det, -c / det)

    def _information(self) -> tuple[float, float, float]:
        det = self.east_m2 * self.north_m2 - self.both_m2**2
        return self.north_m2 / det, self.east_m2 / det, -self.both_m2 / det

    def chance(self, is_inside: Callable[[npt.NDArray[np.float64]], float]) -> float:
        """Return the probability that the position is in an area.

        ``is_inside`` returns the share of some positions, shape (n, 2), that is in it.
        """
        spread = np.array(((self.east_m2, self.both_m2), (self.both_m2, self.north_m2)))
        return is_inside(np.asarray(self.point) + _PROBES @ np.linalg.cholesky(spread).T)


_RADII = np.sqrt(-2.0 * np.log1p(-(np.arange(6) + 0.5) / 6))
_ANGLES = np.arange(10) * math.tau / 10
_PROBES = np.column_stack([np.outer(_RADII, f(_ANGLES)).ravel() for f in (np.sin, np.cos)])
"""Equally probable points of a normal distribution about 0 in the plane."""


class LineOfSight(NamedTuple):
    """A direction from a camera whose position is known; heights are above the ground."""

    place: Vector
    height_m: float
    ray: Ray
    error_rad: float

    def on_ground(self) -> GroundFix | None:
        """Return where it meets flat ground; None where that is too far away.

        The error along it grows with the square of the distance over the height, the error
        across it with the distance.
        """
        level = math.hypot(self.ray.east, self.ray.north)
        depression = math.atan2(-self.ray.up, level)
        if self.height_m <= 0.0 or depression < LEAST_DEPRESSION_RAD:
            return None
        range_m = self.height_m / math.tan(depression)
        slant2_m2 = range_m**2 + self.height_m**2
        along_m = slant2_m2 / self.height_m * self.error_rad
        across_m = math.sqrt(slant2_m2) * self.error_rad
        if along_m > GREATEST_SHARE_OF_RANGE * range_m:
            return None
        east, north = self.ray.east / level, self.ray.north / level
        a2, c2 = along_m**2, across_m**2
        return GroundFix(
            Vector(self.place.east + range_m * east, self.place.north + range_m * north),
            a2 * east * east + c2 * north * north,
            a2 * north * north + c2 * east * east,
            (a2 - c2) * east * north,
        )

    def at(self, range_m: float) -> AirFix:
        """Return the position at a range along it; its error is that across the line."""
        return AirFix(
            Vector(
                self.place.east + range_m * self.ray.east,
                self.place.north + range_m * self.ray.north,
            ),
            self.height_m + range_m * self.ray.up,
            range_m * self.error_rad,
            range_m * self.error_rad,
        )


class AirFix(NamedTuple):
    """A position in the air with its height above the ground, and standard deviations."""

    point: Vector
    height_m: float
    error_m: float
    """Horizontal standard deviation in the worst direction, in m."""
    height_error_m: float


def meeting(first: LineOfSight, second: LineOfSight, size_m: float) -> AirFix | None:
    """Return where two lines of sight meet, None if they do not.

    They do if they pass each other within their errors and the size of what they lead to.
    """
    angle = first.ray.angle_to(second.ray)
    if not LEAST_PARALLAX_RAD <= angle <= math.pi - LEAST_PARALLAX_RAD:
        return None
    offset = (
        second.place.east - first.place.east,
        second.place.north - first.place.north,
        second.height_m - first.height_m,
    )
    along_first = sum(a * b for a, b in zip(offset, first.ray, strict=True))
    along_second = sum(a * b for a, b in zip(offset, second.ray, strict=True))
    cos, sin2 = math.cos(angle), math.sin(angle) ** 2
    ranges = (
        (along_first - cos * along_second) / sin2,
        (cos * along_first - along_second) / sin2,
    )
    if min(ranges) <= 0.0:
        return None
    ends = first.at(ranges[0]), second.at(ranges[1])
    errors = math.hypot(ends[0].error_m, ends[1].error_m)
    gap_m = math.dist((*ends[0].point, ends[0].height_m), (*ends[1].point, ends[1].height_m))
    if gap_m > MEETING_SIGMAS * errors + size_m:
        return None
    middle = Vector(*((a + b) / 2.0 for a, b in zip(ends[0].point, ends[1].point, strict=True)))
    height_m = (ends[0].height_m + ends[1].height_m) / 2.0
    error_m = errors / math.sin(angle)
    steepest = max(abs(first.ray.up), abs(second.ray.up))
    return AirFix(middle, height_m, error_m, math.hypot(errors, error_m * steepest))
