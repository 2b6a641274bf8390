"""Things far away that lie just before each other are told apart, whatever is near."""

from __future__ import annotations

import numpy as np
import pytest

from airhilt.imaging.view import Intrinsics, Pose, View
from airhilt.sensors.cameras.renderers import Samples, open_renderer
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.shapes.mesh import Colour, Mesh, box, join

pytest.importorskip("moderngl")

EAST_M, NORTH_M, UP_M = 40.0, 30.0, 1500.0
HEADING_RAD, PITCH_RAD = 0.3, -0.1
REACH_M = 9000.0
GREEN, RED, WHITE = (0.02, 0.4, 0.02), (0.4, 0.02, 0.02), (0.8, 0.8, 0.8)
NOON = Illumination(np.array((0.3, 0.2, 0.93)), visibility_m=90_000.0, overcast=0.0)


def squares(up_m: float, side_m: float, colour: Colour) -> Mesh:
    """Return level ground in squares."""
    lines = np.arange(-REACH_M, REACH_M + 1.0, side_m)
    count = len(lines)
    east, north = (places.ravel() for places in np.meshgrid(lines, lines))
    corner = np.arange(count**2).reshape(count, count)[:-1, :-1].ravel()
    faces = [
        np.column_stack((corner, corner + right, corner + ahead))
        for right, ahead in ((1, count + 1), (count + 1, count))
    ]
    vertices = np.column_stack((east, north, np.full_like(east, up_m)))
    return Mesh.of(vertices, np.concatenate(faces), colour)


def drawn(renderer: str, thing: Mesh) -> Samples:
    """Return what is seen from above: a thing, fields, and a floor 4 m below them."""
    world = join([squares(0.0, 600.0, GREEN), squares(-4.0, 9000.0, RED), thing])
    _, opened = open_renderer(renderer, world, {}, NOON)
    pose = Pose.of((EAST_M, NORTH_M, UP_M), HEADING_RAD, PITCH_RAD)
    view = View(Intrinsics(320, 180, 1.2), pose)
    try:
        return opened.landscape(view, view.whole)
    finally:
        opened.close()


def cloud(ahead_m: float, right_m: float, size_m: float) -> Mesh:
    """Return something at the height of the camera, seen from it."""
    sin, cos = np.sin(HEADING_RAD), np.cos(HEADING_RAD)
    there = ahead_m * sin + right_m * cos, ahead_m * cos - right_m * sin
    block = box(WHITE, size_m, size_m, size_m)
    return block.moved(EAST_M + there[0], NORTH_M + there[1], UP_M - 0.5 * size_m)


@pytest.mark.parametrize(
    "thing", [cloud(4000.0, 0.0, 500.0), cloud(0.0, 2500.0, 500.0), cloud(20.0, 5.0, 4.0)]
)
def test_no_floor_shows_through_far_fields(thing: Mesh) -> None:
    drawing, ray_by_ray = drawn("moderngl", thing), drawn("embree", thing)
    apart = np.abs(drawing.colour.astype(int) - ray_by_ray.colour).max(axis=2)
    assert (apart > 24).mean() < 0.001
    red, green, _ = drawing.colour.astype(int).transpose(2, 0, 1)
    assert not (red > green + 20).any()
    assert (green > red + 20).mean() > 0.3
