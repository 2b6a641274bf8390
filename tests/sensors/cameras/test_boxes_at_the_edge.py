"""The box of a body that the picture's border cuts is that of the pixels that show it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from airhilt.imaging.view import NEAR_M, Intrinsics, Pose, View
from airhilt.sensors.cameras.renderers import Part, open_renderer
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.layers import by_sample
from airhilt.sensors.cameras.scene.projected_box import Box, Outline
from airhilt.shapes.aircraft import aircraft_meshes
from airhilt.shapes.mesh import box
from airhilt.world.flight.aircraft_type import load_aircraft_type
from breadth import examples

SAMPLES = 6
"""Samples along each side of a pixel."""
POINTS = 400
"""Points along each edge of a body."""
SHAPES = {
    kind: next(iter(aircraft_meshes(load_aircraft_type(kind), coarse=True).values()))
    for kind in ("c172p", "737")
}
OUTLINES = {kind: Outline.of(mesh) for kind, mesh in SHAPES.items()}
NOON = Illumination(np.array((0.0, 0.0, 1.0)), visibility_m=10_000.0, overcast=0.0)
_, RENDERER = open_renderer("embree", box((0.5, 0.5, 0.5), 0.1, 0.1, 0.1), SHAPES, NOON)
LENS = Intrinsics(96, 54, math.radians(50.0))
VIEW = View(LENS, Pose.of((0.0, 0.0, 10.0), 0.0))
angles = st.floats(-3.1, 3.1)


def shown(kind: str, pose: Pose) -> Box:
    """Return the box about the pixels that show the body, or in which a point of an edge lies.

    Pixels show the faces and lose what is thinner than lies between two samples, as tips of wings
    from the side are; points along the edges have those.
    """
    (drawn,) = RENDERER.parts(VIEW, [Part(kind, pose, VIEW.whole, SAMPLES)])
    covered = np.asarray(np.isfinite(by_sample(drawn.distance_m, SAMPLES)).any(axis=0))
    outline = OUTLINES[kind]
    corners = VIEW.in_camera(outline.points @ pose.rotation.T + np.asarray(pose.position_m))
    start, end = corners[outline.edges[:, 0]], corners[outline.edges[:, 1]]
    along = np.linspace(0.0, 1.0, POINTS)[:, None, None]
    points = (start + along * (end - start)).reshape(-1, 3)
    columns, rows = np.floor(VIEW.pixels(points[points[:, 2] >= NEAR_M])).astype(int).T
    inside = (columns >= 0) & (columns < LENS.width_px) & (rows >= 0) & (rows < LENS.height_px)
    covered[rows[inside], columns[inside]] = True
    rows, columns = np.nonzero(covered)
    if not len(rows):
        return Box(0.0, 0.0, 0.0, 0.0)
    left, top, right, bottom = columns.min(), rows.min(), columns.max() + 1, rows.max() + 1
    return Box(float(left), float(top), float(right), float(bottom))


@examples(150)
@given(
    kind=st.sampled_from(sorted(SHAPES)),
    away=st.floats(0.55, 1.2),
    column=st.one_of(st.floats(-0.1, 0.1), st.floats(0.9, 1.1)),
    row=st.floats(-0.1, 1.1),
    heading=angles,
    pitch=st.floats(-0.4, 0.4),
    roll=angles,
)
def test_a_body_at_the_border_has_the_box_of_its_pixels(
    kind: str, away: float, column: float, row: float, heading: float, pitch: float, roll: float
) -> None:
    towards = VIEW.directions(
        np.array([column * LENS.width_px], np.float32), np.array([row * LENS.height_px], np.float32)
    )[:, 0]
    metres = away * 2.0 * OUTLINES[kind].radius_m
    east, north, up = (float(metres * part) for part in towards)
    pose = Pose.of((east, north, up + 10.0), heading, pitch, roll)
    projected = OUTLINES[kind].seen(pose, VIEW)
    drawn = shown(kind, pose)
    if projected is None:
        assert drawn.area == 0.0
        return
    told = projected.in_picture
    assume(min(told.right - told.left, told.bottom - told.top) > 2.0)
    for told_px, drawn_px in zip(told, drawn, strict=True):
        assert abs(told_px - drawn_px) <= 1.5


def test_a_wall_that_fills_the_picture_has_a_box_as_large_as_it() -> None:
    wall = Outline.of(box((0.5, 0.5, 0.5), 900.0, 1.0, 900.0))
    ahead = wall.seen(Pose.of((0.0, 40.0, -400.0), 0.0), VIEW)
    about_the_camera = wall.seen(Pose.of((0.0, 0.0, -400.0), 0.0), VIEW)
    for projected in (ahead, about_the_camera):
        assert projected is not None
        assert projected.in_picture == pytest.approx((0.0, 0.0, 96.0, 54.0))


def test_a_body_whose_wing_alone_is_in_the_picture_has_the_box_of_the_wing() -> None:
    outline = OUTLINES["737"]
    pose = Pose.of((-42.0, 60.0, 10.0), 0.0, roll_rad=0.3)
    projected = outline.seen(pose, VIEW)
    assert projected is not None
    told, rectangle = projected.in_picture, projected.whole.within(VIEW)
    assert 0.0 < told.area < 0.5 * rectangle.area
