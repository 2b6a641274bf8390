"""The box around a body in a picture, by projecting it: masks would lose thin wings."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from airhilt.imaging import boxes
from airhilt.imaging.view import NEAR_M, Pose, View, Window
from airhilt.shapes.mesh import Mesh

ROUNDING_M = 0.01
"""Margin of the sphere about a body, in m."""


class Box(NamedTuple):
    """A rectangle in a picture, in pixels."""

    left: float
    top: float
    right: float
    bottom: float

    @property
    def area(self) -> float:
        """Area in square pixels; 0 where it is empty."""
        return boxes.area(self)

    def within(self, view: View) -> Box:
        """Return what of it is in the picture."""
        lens = view.intrinsics
        return Box(*boxes.within(self, float(lens.width_px), float(lens.height_px)))

    def window(self, view: View, margin_px: int = 1) -> Window:
        """Return the whole pixels of the picture that it touches, and some more."""
        lens = view.intrinsics
        return Window(
            max(math.floor(self.left) - margin_px, 0),
            max(math.floor(self.top) - margin_px, 0),
            min(math.ceil(self.right) + margin_px, lens.width_px),
            min(math.ceil(self.bottom) + margin_px, lens.height_px),
        )


@dataclass(frozen=True)
class Outline:
    """The corners and edges of a mesh.

    Attributes
    ----------
    radius_m
        Radius of a sphere about the origin that holds all of it.
    """

    points: npt.NDArray[np.float64]
    edges: npt.NDArray[np.int64]
    radius_m: float

    @classmethod
    def of(cls, mesh: Mesh) -> Outline:
        """Return the outline of a mesh."""
        points, number = np.unique(mesh.corners.reshape(-1, 3), axis=0, return_inverse=True)
        faces = number.reshape(-1, 3)
        edges = np.sort(np.vstack((faces[:, :2], faces[:, 1:], faces[:, ::2])), axis=1)
        radius_m = float(np.linalg.norm(points, axis=1).max(initial=0.0)) + ROUNDING_M
        return cls(points.astype(np.float64), np.unique(edges, axis=0), radius_m)

    def box(self, pose: Pose, view: View) -> Box | None:
        """Return the box about the body, which may lie beside the picture.

        None if no part of the body can be in the picture.
        """
        if not view.may_show(pose.position_m, self.radius_m):
            return None
        return self._box(self.points @ pose.rotation.T + np.asarray(pose.position_m), view)

    def shadow_box(self, pose: Pose, view: View, sun: npt.NDArray[np.float64]) -> Box | None:
        """Return the box about the body's shadow on flat ground; None as `box`."""
        centre = np.asarray(pose.position_m)
        on_ground = centre - sun * (max(float(centre[2]), 0.0) / sun[2])
        if not view.may_show(on_ground, self.radius_m * (1.0 + 1.0 / float(sun[2]))):
            return None
        world = self.points @ pose.rotation.T + centre
        return self._box(world - np.outer(np.maximum(world[:, 2], 0.0) / sun[2], sun), view)

    def _box(self, world: npt.NDArray[np.float64], view: View) -> Box | None:
        points = view.in_camera(world)
        ahead = points[:, 2] >= NEAR_M
        if not ahead.any():
            return None
        if not ahead.all():
            start, end = points[self.edges[:, 0]], points[self.edges[:, 1]]
            crossing = ahead[self.edges[:, 0]] != ahead[self.edges[:, 1]]
            start, end = start[crossing], end[crossing]
            part = (NEAR_M - start[:, 2]) / (end[:, 2] - start[:, 2])
            points = np.vstack((points[ahead], start + part[:, None] * (end - start)))
        pixels = view.pixels(points)
        low, high = pixels.min(axis=0), pixels.max(axis=0)
        return Box(float(low[0]), float(low[1]), float(high[0]), float(high[1]))
