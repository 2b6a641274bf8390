"""Bodies that a sphere about them puts out of a picture: they are projected no further."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from airhilt.imaging.view import Intrinsics, Pose, View
from airhilt.sensors.cameras.scene.projected_box import Outline
from airhilt.shapes.aircraft import aircraft_meshes
from airhilt.world.flight.aircraft_type import load_aircraft_type
from breadth import examples

OUTLINE = Outline.of(next(iter(aircraft_meshes(load_aircraft_type("c172p"), coarse=True).values())))
PROJECTED = replace(OUTLINE, radius_m=1e6)
SUN = np.array((0.3, -0.5, math.sqrt(0.66)))
angles = st.floats(-3.2, 3.2)
metres = st.floats(-60.0, 60.0)
poses = st.builds(Pose.of, st.tuples(metres, metres, st.floats(-3.0, 60.0)), angles, angles, angles)
views = st.builds(
    View, st.builds(Intrinsics, st.just(64), st.integers(16, 90), st.floats(0.05, 2.5)), poses
)


@examples(80)
@given(view=views, pose=poses)
def test_a_body_that_is_left_out_has_no_box_in_the_picture(view: View, pose: Pose) -> None:
    for all_of_it, found in (
        (PROJECTED.seen(pose, view), OUTLINE.seen(pose, view)),
        (PROJECTED.shadow(pose, view, SUN), OUTLINE.shadow(pose, view, SUN)),
    ):
        if all_of_it is not None and all_of_it.in_picture.area > 0.0:
            assert found is not None
            assert found.in_picture == all_of_it.in_picture


def test_a_body_beside_and_behind_the_camera_is_left_out() -> None:
    view = View(Intrinsics(640, 360, 1.0), Pose.of((0.0, 0.0, 2.0), 0.0))
    for place in ((0.0, -50.0, 2.0), (80.0, 60.0, 2.0), (-80.0, 60.0, 2.0), (0.0, 60.0, 70.0)):
        assert OUTLINE.seen(Pose.of(place, 0.3), view) is None
    assert OUTLINE.seen(Pose.of((0.0, 60.0, 2.0), 0.3), view)
