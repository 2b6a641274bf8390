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

MARGIN_PX = 1
"""Margin of the pixels that a body is drawn in."""
ROUNDING_M = 0.01
"""Margin of the sphere about a body, in m."""


class Box(NamedTuple):
    """A rectangle in a picture, in pixels."""

    left: float
    top: float
    right: float
    bottom: float

    @classmethod
    def around(cls, pixels: npt.NDArray[np.float64]) -> Box:
        """Return the box around places in a picture; it is empty if there are none."""
        if not len(pixels):
            return cls(0.0, 0.0, 0.0, 0.0)
        (left, top), (right, bottom) = pixels.min(axis=0).tolist(), pixels.max(axis=0).tolist()
        return cls(left, top, right, bottom)

    @property
    def area(self) -> float:
        """Area in square pixels; 0 where it is empty."""
        return boxes.area(self)

    @property
    def pixels(self) -> Window:
        """The whole pixels that it touches, and `MARGIN_PX` more; they may lie beside a picture."""
        return Window(
            math.floor(self.left) - MARGIN_PX,
            math.floor(self.top) - MARGIN_PX,
            math.ceil(self.right) + MARGIN_PX,
            math.ceil(self.bottom) + MARGIN_PX,
        )

    def within(self, view: View) -> Box:
        """Return what of it is in the picture."""
        lens = view.intrinsics
        return Box(*boxes.within(self, float(lens.width_px), float(lens.height_px)))

    def window(self, view: View) -> Window:
        """Return those of its `pixels` that are in the picture."""
        lens, each = view.intrinsics, self.pixels
        return Window(
            max(each.left, 0),
            max(each.top, 0),
            min(each.right, lens.width_px),
            min(each.bottom, lens.height_px),
        )


class Projection(NamedTuple):
    """A mesh as a camera sees it.

    Attributes
    ----------
    whole
        Box about all of it, in the picture or not.
    points
        Its corners in the camera's axes.
    """

    outline: Outline
    view: View
    whole: Box
    points: npt.NDArray[np.float64]

    @property
    def in_picture(self) -> Box:
        """Box about the parts of its triangles that are in the picture; empty if none are."""
        whole = self.whole.within(self.view)
        if whole == self.whole or whole.area <= 0.0:
            return whole
        return Box.around(self.view.pixels(self._corners_in_picture())).within(self.view)

    def _corners_in_picture(self) -> npt.NDArray[np.float64]:
        """Return the corners of what is left of the triangles in the pyramid of the picture.

        They are the mesh's own inside it, the places where edges of the mesh go through its planes
        (M. Cyrus and J. Beck, Computers and Graphics 3, 1978), and those where its edges go through
        triangles. Edges and triangles beyond one plane are left out.
        """
        outline, points = self.outline, self.points
        normals, offsets = _pyramid(self.view)
        depth = points @ normals.T - offsets
        beyond = np.packbits(depth < 0.0, axis=1)[:, 0]
        start, end = _cut(beyond, outline.edges).T
        before, after = depth[start], depth[end]
        with np.errstate(divide="ignore", invalid="ignore"):
            part = before / (before - after)
        enters = np.where(before < 0.0, part, 0.0).max(axis=1, initial=0.0)
        leaves = np.where(after < 0.0, part, 1.0).min(axis=1, initial=1.0)
        crosses = enters <= leaves
        first, along = points[start[crosses]], (points[end] - points[start])[crosses]
        return np.vstack((
            points[beyond == 0],
            first + enters[crosses, None] * along,
            first + leaves[crosses, None] * along,
            _through(points[_cut(beyond, outline.faces)], self.view),
        ))  # fmt: skip


def _pyramid(view: View) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Return the inward normals and the offsets of the planes that bound what a camera sees."""
    lens = view.intrinsics
    across, down = (side / 2.0 / lens.focal_px for side in (lens.width_px, lens.height_px))
    normals = ((1, 0, across), (-1, 0, across), (0, 1, down), (0, -1, down), (0, 0, 1))
    return np.array(normals, dtype=float), np.array((0.0, 0.0, 0.0, 0.0, NEAR_M))


def _cut(beyond: npt.NDArray[np.uint8], corners: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Return the edges or triangles that planes may cut; ``beyond`` has the planes of a corner."""
    of_each = [beyond[column] for column in corners.T]
    every, some = np.bitwise_and.reduce(of_each), np.bitwise_or.reduce(of_each)
    return np.asarray(corners[(every == 0) & (some != 0)])


def _through(triangles: npt.NDArray[np.float64], view: View) -> npt.NDArray[np.float64]:
    """Return where the edges of the picture's pyramid go through triangles, shape (n, 3, 3).

    T. Möller and B. Trumbore, Journal of Graphics Tools 2 (1), 1997.
    """
    lens = view.intrinsics
    across, down = (side / 2.0 / lens.focal_px for side in (lens.width_px, lens.height_px))
    corners = np.array(
        [(-across, -down, 1.0), (across, -down, 1.0), (across, down, 1.0), (-across, down, 1.0)]
    )
    near = NEAR_M * corners
    origin = np.vstack((near, near))[:, None]
    along = np.vstack((corners, np.roll(near, -1, axis=0) - near))[:, None]
    longest = np.repeat((np.inf, 1.0), len(corners))[:, None]
    one = triangles[:, 0]
    beside, above = triangles[:, 1] - one, triangles[:, 2] - one
    normal = np.cross(along, above)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = 1.0 / (normal * beside).sum(axis=2)
        u = ((origin - one) * normal).sum(axis=2) * scale
        other = np.cross(origin - one, beside)
        v = (along * other).sum(axis=2) * scale
        away = (other * above).sum(axis=2) * scale
        hits = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (away >= 0.0) & (away <= longest)
    edge, triangle = np.nonzero(hits)
    return np.asarray(origin[edge, 0] + away[edge, triangle, None] * along[edge, 0])


@dataclass(frozen=True)
class Outline:
    """The corners, edges and triangles of a mesh.

    Attributes
    ----------
    radius_m
        Radius of a sphere about the origin that holds all of it.
    """

    points: npt.NDArray[np.float64]
    edges: npt.NDArray[np.int64]
    faces: npt.NDArray[np.int64]
    radius_m: float

    @classmethod
    def of(cls, mesh: Mesh) -> Outline:
        """Return the outline of a mesh."""
        points, number = np.unique(mesh.corners.reshape(-1, 3), axis=0, return_inverse=True)
        faces = number.reshape(-1, 3)
        edges = np.sort(np.vstack((faces[:, :2], faces[:, 1:], faces[:, ::2])), axis=1)
        radius_m = float(np.linalg.norm(points, axis=1).max(initial=0.0)) + ROUNDING_M
        return cls(points.astype(np.float64), np.unique(edges, axis=0), faces, radius_m)

    def seen(self, pose: Pose, view: View) -> Projection | None:
        """Return the body as a camera sees it, which may be beside the picture.

        None if no part of the body can be in the picture.
        """
        if not view.may_show(pose.position_m, self.radius_m):
            return None
        return self._projected(self.points @ pose.rotation.T + np.asarray(pose.position_m), view)

    def shadow(self, pose: Pose, view: View, sun: npt.NDArray[np.float64]) -> Projection | None:
        """Return the body's shadow on flat ground as a camera sees it; None as `seen`."""
        centre = np.asarray(pose.position_m)
        on_ground = centre - sun * (max(float(centre[2]), 0.0) / sun[2])
        if not view.may_show(on_ground, self.radius_m * (1.0 + 1.0 / float(sun[2]))):
            return None
        world = self.points @ pose.rotation.T + centre
        flat = world - np.outer(np.maximum(world[:, 2], 0.0) / sun[2], sun)
        return self._projected(flat, view)

    def _projected(self, world: npt.NDArray[np.float64], view: View) -> Projection | None:
        points = drawn = view.in_camera(world)
        ahead = points[:, 2] >= NEAR_M
        if not ahead.any():
            return None
        if not ahead.all():
            start, end = points[self.edges[:, 0]], points[self.edges[:, 1]]
            crossing = ahead[self.edges[:, 0]] != ahead[self.edges[:, 1]]
            start, end = start[crossing], end[crossing]
            part = (NEAR_M - start[:, 2]) / (end[:, 2] - start[:, 2])
            drawn = np.vstack((points[ahead], start + part[:, None] * (end - start)))
        return Projection(self, view, Box.around(view.pixels(drawn)), points)
