"""From a place in a picture to a direction, to a place on the ground, or to a place in the air.

Directions are unit vectors towards east, north and up where the camera is, whatever way the
camera is turned: a carrier that banks does not move what it sees.
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
"""Standard deviation of a side of a box, and of what is not known of the lens."""
LEAST_DEPRESSION_RAD = 0.1 * DEGREE
"""Flatter than this, a line of sight meets no ground that a camera tells anything about."""
GREATEST_SHARE_OF_RANGE = 0.5
"""A place is one if the error of its distance is no larger part of it."""
LEAST_PARALLAX_RAD = 1.0 * DEGREE
"""Lines of sight that meet under a smaller angle tell no distance."""
MEETING_SIGMAS = 3.0
SAME_OBJECT_M = 6.0
"""Two cameras see different ends of one thing."""


class Ray(NamedTuple):
    """A direction, of length 1."""

    east: float
    north: float
    up: float

    @classmethod
    def towards(cls, east: float, north: float, up: float) -> Ray:
        """Return the direction of an offset that is not nothing."""
        length = math.sqrt(east * east + north * north + up * up)
        return cls(east / length, north / length, up / length)

    @property
    def elevation_rad(self) -> float:
        """Above the horizon."""
        return math.asin(min(max(self.up, -1.0), 1.0))

    @property
    def azimuth_rad(self) -> float:
        """From north, clockwise."""
        return math.atan2(self.east, self.north)

    def angle_to(self, other: Ray) -> float:
        """Return the angle between two directions (rad)."""
        cross = (
            self.north * other.up - self.up * other.north,
            self.up * other.east - self.east * other.up,
            self.east * other.north - self.north * other.east,
        )
        dot = self.east * other.east + self.north * other.north + self.up * other.up
        return math.atan2(math.hypot(*cross), dot)

    def offset_to(self, other: Ray) -> tuple[float, float]:
        """Return how far another, near one lies to the right of this one, and above it (rad)."""
        turn = math.remainder(other.azimuth_rad - self.azimuth_rad, math.tau)
        middle = 0.5 * (self.elevation_rad + other.elevation_rad)
        return turn * math.cos(middle), other.elevation_rad - self.elevation_rad


class Eye:
    """A camera at the instant of a picture."""

    def __init__(self, view: CameraView) -> None:
        self.view = view
        self._lens = Pinhole(view)
        self.focal_px = self._lens.focal_px
        self.error_rad = BOX_ERROR_PX / self.focal_px

    @cached_property
    def _axes(self) -> tuple[Ray, Ray, Ray]:
        """Its right, down and ahead in the world."""
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
        """Return whether a box may go on outside of the picture."""
        left, top, right, bottom = box
        width, height = self.view.width_px, self.view.height_px
        return left <= 1.0 or top <= 1.0 or right >= width - 1.0 or bottom >= height - 1.0

    def angular_size(self, box: Box) -> tuple[float, float]:
        """Return how wide and how high a box is, in radians."""
        x, y, _ = self._lens.direction(*centre(box))
        shrunk = 1.0 / (1.0 + x * x + y * y) / self.focal_px
        return (box[2] - box[0]) * shrunk, (box[3] - box[1]) * shrunk


class Spot(NamedTuple):
    """A place on the ground and its error: variances and covariance in m2."""

    point: Vector
    east_m2: float
    north_m2: float
    both_m2: float

    def is_same(self, other: Spot, sigmas: float = MEETING_SIGMAS) -> bool:
        """Return whether two may be one place, by their errors."""
        east, north = other.point.east - self.point.east, other.point.north - self.point.north
        a = self.east_m2 + other.east_m2 + SAME_OBJECT_M**2
        b = self.north_m2 + other.north_m2 + SAME_OBJECT_M**2
        c = self.both_m2 + other.both_m2
        squared = (b * east * east - 2.0 * c * east * north + a * north * north) / (a * b - c * c)
        return squared <= sigmas * sigmas

    def merged(self, other: Spot) -> Spot:
        """Return the place that two independent ones give together."""
        mine, its = self._information(), other._information()
        e, n, c = (a + b for a, b in zip(mine, its, strict=True))
        det = e * n - c * c
        weighed = [
            (i[0] * s.point.east + i[2] * s.point.north, i[2] * s.point.east + i[1] * s.point.north)
            for i, s in ((mine, self), (its, other))
        ]
        x, y = (weighed[0][axis] + weighed[1][axis] for axis in (0, 1))
        place = Vector((n * x - c * y) / det, (e * y - c * x) / det)
        return Spot(place, n / det, e / det, -c / det)

    def _information(self) -> tuple[float, float, float]:
        det = self.east_m2 * self.north_m2 - self.both_m2**2
        return self.north_m2 / det, self.east_m2 / det, -self.both_m2 / det

    def chance(self, is_inside: Callable[[npt.NDArray[np.float64]], float]) -> float:
        """Return how probable it is that the place is one that counts.

        Parameters
        ----------
        is_inside
            Returns the share of some places, shape (n, 2), that does.
        """
        spread = np.array(((self.east_m2, self.both_m2), (self.both_m2, self.north_m2)))
        return is_inside(np.asarray(self.point) + _PROBES @ np.linalg.cholesky(spread).T)


def _probes() -> npt.NDArray[np.float64]:
    """Return places of a normal distribution about 0 in the plane, all equally probable."""
    rings, turns = 6, 10
    radii = np.sqrt(-2.0 * np.log1p(-(np.arange(rings) + 0.5) / rings))
    angles = np.arange(turns) * math.tau / turns
    east, north = np.outer(radii, np.sin(angles)), np.outer(radii, np.cos(angles))
    return np.column_stack((east.ravel(), north.ravel()))


_PROBES = _probes()


class Sightline(NamedTuple):
    """A direction from a camera whose place is known; heights are above the ground."""

    place: Vector
    height_m: float
    ray: Ray
    error_rad: float

    def on_ground(self) -> Spot | None:
        """Return where it meets flat ground; None where that is too far to be told.

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
        if level < 1e-6:
            return Spot(self.place, along_m**2, along_m**2, 0.0)
        east, north = self.ray.east / level, self.ray.north / level
        a2, c2 = along_m**2, across_m**2
        return Spot(
            Vector(self.place.east + range_m * east, self.place.north + range_m * north),
            a2 * east * east + c2 * north * north,
            a2 * north * north + c2 * east * east,
            (a2 - c2) * east * north,
        )

    def at(self, range_m: float) -> Fix:
        """Return the place so far along it; its error is that across."""
        return Fix(
            Vector(
                self.place.east + range_m * self.ray.east,
                self.place.north + range_m * self.ray.north,
            ),
            self.height_m + range_m * self.ray.up,
            range_m * self.error_rad,
            range_m * self.error_rad,
        )


class Fix(NamedTuple):
    """A place in the air: its height above the ground, and standard deviations."""

    point: Vector
    height_m: float
    error_m: float
    """Horizontal, in the worst direction."""
    height_error_m: float


def meeting(first: Sightline, second: Sightline, size_m: float) -> Fix | None:
    """Return where two lines of sight meet, None if they do not.

    They do if they pass each other within their errors, and the size of what they lead to.
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
    return Fix(middle, height_m, error_m, math.hypot(errors, error_m * steepest))
