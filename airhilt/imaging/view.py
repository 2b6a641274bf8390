"""Pose of a camera, and how it maps the world to pixels.

The world's axes are east, north and up, in metres. A camera's are those of the pinhole model:
x to the right, y down, z along the optical axis (R. Hartley and A. Zisserman, Multiple View
Geometry, 2nd ed., section 6.1). Pixel (0, 0) is the upper left one and its centre is at (0.5, 0.5).
"""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from airhilt.errors import CameraError

Floats = npt.NDArray[np.float32]
Matrix = npt.NDArray[np.float64]
NEAR_M = 0.3
"""Least depth that is drawn, in m."""


@dataclass(frozen=True)
class Intrinsics:
    """A pinhole with square pixels whose axis goes through the middle of the picture."""

    width_px: int
    height_px: int
    horizontal_fov_rad: float

    @property
    def focal_px(self) -> float:
        """Focal length in pixels."""
        return self.width_px / 2.0 / math.tan(self.horizontal_fov_rad / 2.0)


@dataclass(frozen=True)
class Pose:
    """A place in the world, and the attitude of what is there.

    ``rotation`` takes body axes (right, ahead, up) to east, north and up.
    """

    position_m: tuple[float, float, float]
    rotation: Matrix

    @classmethod
    def of(
        cls,
        position_m: tuple[float, float, float],
        heading_rad: float,
        pitch_rad: float = 0.0,
        roll_rad: float = 0.0,
    ) -> Pose:
        """Return a pose from the angles of aviation: roll to the right, pitch up.

        Raises
        ------
        CameraError
            A number is not finite.
        """
        numbers = (*position_m, heading_rad, pitch_rad, roll_rad)
        if not all(math.isfinite(number) for number in numbers):
            raise CameraError(
                f"a pose has {numbers}; expected finite metres and radians: east, north, up, "
                "heading, pitch, roll"
            )
        return cls(position_m, attitude(heading_rad, pitch_rad, roll_rad))

    def on(self, other: Pose) -> Pose:
        """Return this pose, given in the axes of another, in those of the world."""
        place = np.asarray(other.position_m) + other.rotation @ np.asarray(self.position_m)
        east, north, up = (float(value) for value in place)
        return Pose((east, north, up), other.rotation @ self.rotation)


def attitude(heading_rad: float, pitch_rad: float = 0.0, roll_rad: float = 0.0) -> Matrix:
    """Return the matrix from right, ahead and up to east, north and up."""
    sin_h, cos_h = math.sin(heading_rad), math.cos(heading_rad)
    sin_p, cos_p = math.sin(pitch_rad), math.cos(pitch_rad)
    sin_r, cos_r = math.sin(roll_rad), math.cos(roll_rad)
    turn = np.array(((cos_h, sin_h, 0.0), (-sin_h, cos_h, 0.0), (0.0, 0.0, 1.0)))
    pitch = np.array(((1.0, 0.0, 0.0), (0.0, cos_p, -sin_p), (0.0, sin_p, cos_p)))
    roll = np.array(((cos_r, 0.0, sin_r), (0.0, 1.0, 0.0), (-sin_r, 0.0, cos_r)))
    return np.asarray(turn @ pitch @ roll)


@dataclass(frozen=True)
class Window:
    """A part of a picture in whole pixels; ``right`` and ``bottom`` are the first ones outside."""

    left: int
    top: int
    right: int
    bottom: int

    @property
    def width(self) -> int:
        """Width in pixels."""
        return self.right - self.left

    @property
    def height(self) -> int:
        """Height in pixels."""
        return self.bottom - self.top

    @property
    def area(self) -> int:
        """Area in pixels; 0 where it is empty."""
        return max(self.width, 0) * max(self.height, 0)

    @property
    def slices(self) -> tuple[slice, slice]:
        """Rows and columns."""
        return slice(self.top, self.bottom), slice(self.left, self.right)


@dataclass(frozen=True)
class View:
    """A camera at an instant."""

    intrinsics: Intrinsics
    pose: Pose

    @cached_property
    def axes(self) -> Matrix:
        """The camera's x, y and z in the world, as columns."""
        right, ahead, up = self.pose.rotation.T
        return np.column_stack((right, -up, ahead))

    @property
    def key(self) -> list[float]:
        """Numbers of lens and pose, which tell it from other views."""
        pose = self.pose
        return [*astuple(self.intrinsics), *pose.position_m, *pose.rotation.ravel().tolist()]

    @property
    def whole(self) -> Window:
        """All pixels."""
        return Window(0, 0, self.intrinsics.width_px, self.intrinsics.height_px)

    def in_camera(self, points: npt.ArrayLike) -> Matrix:
        """Return points of the world in the camera's axes."""
        offset = np.asarray(points, dtype=np.float64) - np.asarray(self.pose.position_m)
        return np.asarray(offset @ self.axes)

    def may_show(self, centre_m: npt.ArrayLike, radius_m: float) -> bool:
        """Return false if a sphere is behind the camera, or on one side of the picture."""
        lens = self.intrinsics
        x, y, z = self.in_camera(centre_m).tolist()
        if z + radius_m < NEAR_M:
            return False
        for across, side_px in ((abs(x), lens.width_px), (abs(y), lens.height_px)):
            slope = side_px / (2.0 * lens.focal_px)
            if across - z * slope > radius_m * math.hypot(1.0, slope):
                return False
        return True

    def pixels(self, in_camera: Matrix) -> Matrix:
        """Return where points before the camera, in its axes, are in the picture."""
        lens = self.intrinsics
        scale = lens.focal_px / in_camera[..., 2:]
        centre = (lens.width_px / 2.0, lens.height_px / 2.0)
        return np.asarray(in_camera[..., :2] * scale + centre)

    def on_focal_plane(self, columns: Floats, rows: Floats) -> tuple[Floats, Floats]:
        """Return places in the picture as they are at a depth of 1, right of the axis and below."""
        lens = self.intrinsics
        focal = np.float32(lens.focal_px)
        x = (columns - np.float32(lens.width_px / 2.0)) / focal
        return x, (rows - np.float32(lens.height_px / 2.0)) / focal

    def directions(self, columns: Floats, rows: Floats) -> Floats:
        """Return unit vectors of the world towards places in the picture, shape (3, ...)."""
        x, y = self.on_focal_plane(columns, rows)
        scale = np.float32(1.0) / np.sqrt(x * x + y * y + np.float32(1.0))
        axes = self.axes.astype(np.float32)
        towards = np.empty((3, *scale.shape), dtype=np.float32)
        for axis, direction in enumerate(towards):
            np.add(x * axes[axis, 0], y * axes[axis, 1] + axes[axis, 2], out=direction)
            direction *= scale
        return towards

    def sample_places(self, window: Window, samples: int) -> tuple[Floats, Floats]:
        """Return columns and rows of the samples of a window, ``samples`` squared a pixel."""
        step = 1.0 / samples
        columns = window.left + step * (np.arange(window.width * samples) + 0.5)
        rows = window.top + step * (np.arange(window.height * samples) + 0.5)
        return columns.astype(np.float32)[None, :], rows.astype(np.float32)[:, None]
