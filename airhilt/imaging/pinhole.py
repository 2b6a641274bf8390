"""The pinhole camera that messages describe: from directions of the world to its picture.

`airhilt.imaging.view` is for drawing; this is for workers, which have the messages alone.
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
import numpy.typing as npt

from airhilt.imaging.view import attitude
from airhilt.messages import CameraView
from airhilt.units import DEGREE

LEAST_AHEAD = 1e-3
"""Least part of a direction's length that points ahead; less is beside or behind the camera."""


class Pinhole:
    """A camera without distortion, with square pixels, its axis through the middle of the picture.

    Its own axes are x to the right, y down and z ahead, as in `airhilt.imaging.view`.

    Attributes
    ----------
    focal_px
        Focal length in pixels.
    centre_px
        The middle of the picture: column and row.
    """

    def __init__(self, view: CameraView) -> None:
        self._view = view
        self.focal_px = view.width_px / 2.0 / math.tan(view.horizontal_fov_deg * DEGREE / 2.0)
        self.centre_px = (view.width_px / 2.0, view.height_px / 2.0)

    @cached_property
    def axes(self) -> npt.NDArray[np.float64]:
        """Axes of the camera in east, north and up, as columns."""
        view = self._view
        right, ahead, up = attitude(
            view.heading_deg * DEGREE, view.pitch_deg * DEGREE, view.roll_deg * DEGREE
        ).T
        return np.column_stack((right, -up, ahead))

    def direction(self, column: float, row: float) -> tuple[float, float, float]:
        """Return, in its axes and of depth 1, what is at a place in the picture."""
        x, y = self.centre_px
        return (column - x) / self.focal_px, (row - y) / self.focal_px, 1.0

    def pixel(self, x: float, y: float, z: float) -> tuple[float, float] | None:
        """Return where a direction in its axes is in the picture, or beyond; None if behind."""
        if z <= LEAST_AHEAD:
            return None
        column, row = self.centre_px
        scale = self.focal_px / z
        return column + x * scale, row + y * scale
