"""The triangles of the landscape, of which a picture needs few.

An airport has tens of thousands, and most of what is far is smaller than a pixel. Whole tiles that
lie outside of a picture are passed over; of the others, a triangle is drawn if the middle of a
pixel may lie in it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from airhilt.imaging.view import NEAR_M, View, Window
from airhilt.shapes.mesh import Floats

LEAST_TILE_M = 700.0
SLACK = np.float32(1.0 / 32.0)
"""Margin about a triangle, in samples: OpenGL rounds places."""
Numbers = npt.NDArray[np.intp]


class Shown(NamedTuple):
    """Triangles of the landscape that may show in a window.

    Attributes
    ----------
    places
        Places of the triangles in the order of drawing.
    depth_m
        Lower bound of the depth of these triangles in the window; infinite if there are none.
    """

    places: Numbers
    depth_m: float


@dataclass(frozen=True)
class Tiles:
    """Triangles in the order in which they are drawn, and a ball about those of each tile.

    Attributes
    ----------
    order
        Numbers of the triangles, those of one tile after each other.
    corners
        Corners of the triangles in that order; shape (3, 3, n) for axes, corners and triangles.
    bounds
        Place of the first triangle of each tile in that order, and after the last.
    """

    order: Numbers
    corners: Floats
    bounds: Numbers
    middles: npt.NDArray[np.float64]
    radii_m: npt.NDArray[np.float64]

    @classmethod
    def of(cls, corners: Floats) -> Tiles:
        """Return the tiles of triangles with corners of shape (n, 3, 3).

        Large triangles, which reach over many tiles, are in tiles of their own size.
        """
        low, high = corners.min(axis=1), corners.max(axis=1)
        size = np.max(high - low, axis=1)
        level = np.ceil(np.log2(np.maximum(size, LEAST_TILE_M) / LEAST_TILE_M))
        cells = np.floor((low + high)[:, :2] / 2.0 / (LEAST_TILE_M * 2.0**level)[:, None])
        _, number = np.unique(np.column_stack((level, cells)), axis=0, return_inverse=True)
        order = np.argsort(number.reshape(-1), kind="stable")
        bounds = np.concatenate(([0], np.cumsum(np.bincount(number.reshape(-1)))))
        bottom = np.minimum.reduceat(low[order], bounds[:-1]).astype(np.float64)
        top = np.maximum.reduceat(high[order], bounds[:-1]).astype(np.float64)
        middles = (bottom + top) / 2.0
        by_axis = np.ascontiguousarray(corners[order].transpose(2, 1, 0), dtype=np.float32)
        return cls(order, by_axis, bounds, middles, np.linalg.norm(top - middles, axis=1))

    def shown_in(self, view: View, window: Window, samples: int = 1) -> Shown:
        """Return what may show in a window with ``samples`` along each side of a pixel."""
        ranges = self._near(view, window)
        if not ranges:
            return Shown(np.zeros(0, dtype=np.intp), math.inf)
        offsets = np.concatenate([self.corners[..., part] for part in ranges], axis=2)
        offsets -= np.asarray(view.pose.position_m, dtype=np.float32)[:, None, None]
        to_samples = _to_samples(view, window, samples).astype(np.float32)
        in_window = (to_samples @ offsets.reshape(3, -1)).reshape(offsets.shape)
        across, down, ahead = in_window
        nearest = ahead.min(axis=0)
        size = window.width * samples, window.height * samples
        shown = nearest >= NEAR_M
        crosses = np.flatnonzero(~shown)
        crosses = crosses[_may_reach(in_window.take(crosses, axis=2), size)]
        nearest[crosses] = _least_depths(offsets.take(crosses, axis=2), edges(view, window))
        np.maximum(ahead, np.float32(NEAR_M), out=ahead)
        for along, count in zip((across, down), size, strict=True):
            along /= ahead
            low = np.maximum(along.min(axis=0) - SLACK, np.float32(-1.0))
            high = np.minimum(along.max(axis=0) + SLACK, np.float32(count - 1))
            shown &= np.floor(high) > np.floor(low)
        shown[crosses] = True
        found = np.flatnonzero(shown)
        # From places in the ranges, one after the other, to those in the order.
        ends = np.cumsum([part.stop - part.start for part in ranges])
        passed_over = np.array([part.stop for part in ranges]) - ends
        places = np.asarray(found + passed_over[np.searchsorted(ends, found, side="right")])
        return Shown(places, float(nearest[found].min(initial=np.inf)))

    def _near(self, view: View, window: Window) -> list[slice]:
        """Return the tiles that may reach into a window, those that follow each other as one."""
        x, y, z = view.in_camera(self.middles).T
        left, top, right, bottom = edges(view, window)
        seen = z > -self.radii_m
        for across, low, high in ((x, left, right), (y, top, bottom)):
            seen &= across - high * z <= self.radii_m * math.hypot(1.0, high)
            seen &= low * z - across <= self.radii_m * math.hypot(1.0, low)
        changes = np.flatnonzero(np.diff(np.concatenate(([False], seen, [False]))))
        return [slice(*pair) for pair in self.bounds[changes].reshape(-1, 2).tolist()]


def _to_samples(view: View, window: Window, samples: int) -> npt.NDArray[np.float64]:
    """Return what takes offsets in the world to samples of a window, times their depth, and it.

    The middles of samples are at 0, 1 and so on.
    """
    lens = view.intrinsics
    focal = lens.focal_px * samples
    column = (lens.width_px / 2.0 - window.left) * samples - 0.5
    row = (lens.height_px / 2.0 - window.top) * samples - 0.5
    frame = np.array(((focal, 0.0, column), (0.0, focal, row), (0.0, 0.0, 1.0)))
    return np.asarray(frame @ view.axes.T)


def _may_reach(in_window: Floats, size: tuple[int, int]) -> npt.NDArray[np.bool_]:
    """Return which triangles, not all before the camera, may reach into a window.

    The others lie behind it, or on the far side of one of the window's edges. Corners are samples
    times their depth, and it: (3, 3, n).
    """
    across, down, ahead = in_window
    columns, rows = (np.float32(count) for count in size)
    within = (
        ahead - np.float32(NEAR_M), across + ahead, columns * ahead - across,
        down + ahead, rows * ahead - down,
    )  # fmt: skip
    return np.asarray(np.minimum.reduce([side.max(axis=0) for side in within]) > 0.0)


def _least_depths(offsets: Floats, sides: tuple[float, float, float, float]) -> Floats:
    """Return depths in a window that the planes of triangles do not go below.

    Nothing of a plane is nearer to the camera than the foot of its perpendicular.
    """
    a, b, c = offsets.transpose(1, 0, 2)
    (x, y, z), (u, v, w) = b - a, c - a
    normals = np.stack((y * w - z * v, z * u - x * w, x * v - y * u))
    length = np.maximum(np.sqrt((normals**2).sum(axis=0)), np.finfo(np.float32).tiny)
    away = np.abs((normals * a).sum(axis=0)) / length
    left, top, right, bottom = (abs(side) for side in sides)
    return np.asarray(away / np.float32(math.hypot(1.0, max(left, right), max(top, bottom))))


def edges(view: View, window: Window) -> tuple[float, float, float, float]:
    """Return left, top, right and bottom of a window at a depth of 1."""
    lens = view.intrinsics
    across, down = lens.width_px / 2.0, lens.height_px / 2.0
    focal = lens.focal_px
    return (
        (window.left - across) / focal,
        (window.top - down) / focal,
        (window.right - across) / focal,
        (window.bottom - down) / focal,
    )
