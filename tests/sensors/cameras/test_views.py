"""Poses, pictures and boxes."""

from __future__ import annotations

import datetime
import math

import numpy as np
import pytest

from airhilt.imaging.masks import mask_of, runs_of
from airhilt.imaging.view import Intrinsics, Pose, View
from airhilt.sensors.cameras.scene.illumination import sun_direction
from airhilt.sensors.cameras.scene.projected_box import Outline
from airhilt.sensors.cameras.scene.rain import rain_visibility_m
from airhilt.shapes.mesh import box

LENS = Intrinsics(640, 360, math.radians(60.0))


def test_what_is_ahead_is_in_the_middle_and_what_is_right_of_it_is_right() -> None:
    view = View(LENS, Pose.of((10.0, 20.0, 5.0), heading_rad=math.pi / 2.0))
    points = view.in_camera([(110.0, 20.0, 5.0), (110.0, 10.0, 5.0), (110.0, 20.0, 15.0)])
    middle, south, above = view.pixels(points)
    assert middle == pytest.approx((320.0, 180.0))
    assert south[0] > 320.0
    assert above[1] < 180.0


def test_a_bank_to_the_right_lowers_the_right_side() -> None:
    pose = Pose.of((0.0, 0.0, 0.0), heading_rad=0.0, roll_rad=0.3)
    assert pose.rotation[2, 0] < 0.0
    assert Pose.of((0.0, 0.0, 0.0), 0.0, pitch_rad=0.3).rotation[2, 1] > 0.0


def test_directions_go_through_the_pixels_from_which_they_come() -> None:
    view = View(LENS, Pose.of((1.0, 2.0, 3.0), 0.7, 0.1, -0.2))
    columns, rows = view.sample_places(view.whole, 1)
    towards = view.directions(columns, rows)
    point = np.asarray(view.pose.position_m) + 50.0 * towards[:, 100, 600]
    assert view.pixels(view.in_camera(point)) == pytest.approx((600.5, 100.5), abs=1e-3)


def test_a_box_about_a_body_that_reaches_behind_the_camera_fills_its_side() -> None:
    outline = Outline.of(box((0.5, 0.5, 0.5), 4.0, 60.0, 3.0))
    view = View(LENS, Pose.of((5.0, 0.0, 1.5), 0.0))
    found = outline.seen(Pose.of((0.0, 0.0, 0.0), 0.0), view)
    assert found is not None
    assert found.in_picture.left == 0.0
    assert found.in_picture.right < 320.0
    assert outline.seen(Pose.of((0.0, -100.0, 0.0), 0.0), view) is None


def test_the_sun_is_in_the_south_at_noon_and_as_high_as_the_season_has_it() -> None:
    east, north, up = sun_direction(math.radians(39.0), datetime.date(2026, 6, 21), 12.0)
    assert abs(east) < 1e-3
    assert north < 0.0
    assert math.degrees(math.asin(up)) == pytest.approx(90.0 - 39.0 + 23.44, abs=0.1)


def test_rain_takes_from_the_visibility() -> None:
    assert rain_visibility_m(0.0) == math.inf
    assert rain_visibility_m(25.0) < rain_visibility_m(5.0) < 5000.0


@pytest.mark.parametrize("covered", ["nothing", "the middle", "the first pixel too"])
def test_a_mask_comes_back_from_its_runs(covered: str) -> None:
    mask = np.zeros((5, 7), dtype=bool)
    mask[1:3, 2:7] = covered != "nothing"
    mask[0, 0] = covered == "the first pixel too"
    assert np.array_equal(mask_of(runs_of(mask), 5, 7), mask)


def test_runs_of_another_picture_are_refused() -> None:
    with pytest.raises(ValueError, match="35 pixels; expected the 8 by 5"):
        mask_of((30, 5), 5, 8)
