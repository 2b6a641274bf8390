"""Only the tiles of the still world that may show in a picture are drawn."""

from __future__ import annotations

import math

import numpy as np
import pytest

from airhilt.imaging.view import NEAR_M, Intrinsics, Pose, View, Window
from airhilt.sensors.cameras.opengl.tiles import Tiles
from airhilt.shapes.mesh import Floats

VIEW = View(Intrinsics(160, 90, math.radians(60.0)), Pose.of((5.0, -3.0, 40.0), 0.4, -0.1, 0.05))


def triangles(count: int, size_m: float, reach_m: float) -> Floats:
    """Return triangles strewn over some ground, as the numbers of a seed have it."""
    draws = np.random.default_rng(7)
    middles = draws.uniform(-reach_m, reach_m, size=(count, 1, 3)) * (1.0, 1.0, 0.01)
    return (middles + draws.normal(scale=size_m, size=(count, 3, 3))).astype(np.float32)


def shown(corners: Floats, window: Window = VIEW.whole, samples: int = 1) -> set[int]:
    tiles = Tiles.of(corners)
    return set(tiles.order[tiles.shown_in(VIEW, window, samples).places].tolist())


def holding_a_middle(corners: Floats, window: Window, samples: int) -> set[int]:
    """Return which triangles before the camera hold the middle of a sample, one by one."""
    columns, rows = VIEW.sample_places(window, samples)
    found = set()
    for number, triangle in enumerate(corners):
        if VIEW.in_camera(triangle)[:, 2].min() < 0.5:
            continue
        a, b, c = VIEW.pixels(VIEW.in_camera(triangle))
        side = [
            (q[0] - p[0]) * (rows - p[1]) - (q[1] - p[1]) * (columns - p[0])
            for p, q in ((a, b), (b, c), (c, a))
        ]
        inside = np.minimum.reduce(side) > 0.0, np.maximum.reduce(side) < 0.0
        if inside[0].any() or inside[1].any():
            found.add(number)
    return found


@pytest.mark.parametrize("samples", [1, 2])
@pytest.mark.parametrize("window", [VIEW.whole, Window(20, 30, 100, 75)])
def test_whatever_holds_the_middle_of_a_sample_is_drawn(window: Window, samples: int) -> None:
    corners = triangles(400, 20.0, 1000.0)
    seen = holding_a_middle(corners, window, samples)
    assert len(seen) > 10
    assert seen <= shown(corners, window=window, samples=samples)


def test_what_lies_between_the_middles_of_pixels_is_left_out() -> None:
    corners = triangles(400, 0.5, 4000.0)
    drawn = shown(corners)
    assert len(holding_a_middle(corners, VIEW.whole, 1)) <= len(drawn) < 100


def test_what_crosses_the_plane_of_the_camera_is_drawn_and_what_is_behind_it_is_not() -> None:
    below = [(0.0, -500.0, 0.0), (400.0, 900.0, 0.0), (-400.0, 900.0, 0.0)]
    behind = [(0.0, -500.0, 0.0), (90.0, -400.0, 0.0), (-90.0, -400.0, 0.0)]
    assert shown(np.array([below, behind], dtype=np.float32)) == {0}
    depth_m = Tiles.of(np.array([below], dtype=np.float32)).shown_in(VIEW, VIEW.whole).depth_m
    assert depth_m == pytest.approx(40.0, rel=0.3), "the ground below is not near"


def test_nothing_in_the_window_is_nearer_than_what_is_told() -> None:
    window = Window(20, 30, 100, 75)
    corners = np.concatenate((triangles(400, 20.0, 1000.0), triangles(20, 900.0, 1000.0)))
    corners = corners[VIEW.in_camera(corners)[..., 2].max(axis=1) > 0.0]
    weights = np.random.default_rng(8).dirichlet((1.0, 1.0, 1.0), size=2000).astype(np.float32)
    compared = 0
    for triangle in corners:
        points = VIEW.in_camera(weights @ triangle)
        points = points[points[:, 2] > NEAR_M]
        column, row = VIEW.pixels(points).T
        inside = (column > window.left) & (column < window.right)
        inside &= (row > window.top) & (row < window.bottom)
        seen = Tiles.of(triangle[None]).shown_in(VIEW, window)
        if len(seen.places):
            assert (points[inside, 2] >= 0.999 * seen.depth_m).all()
            compared += int(inside.sum())
    assert compared > 1000
