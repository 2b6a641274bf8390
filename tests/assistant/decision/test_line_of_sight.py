"""From pixels to directions and places, and back."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from airhilt.assistant.decision.aerodrome import Vector
from airhilt.assistant.decision.line_of_sight import (
    BOX_ERROR_PX,
    GroundFix,
    LineOfSight,
    PictureGeometry,
    Ray,
    meeting,
)
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.units import DEGREE
from projected import Body, Camera, standing, still

FRAME = LocalFrame((38.85 * DEGREE, -77.04 * DEGREE))
CUBE = (2.0, 2.0, 2.0)
angles = st.floats(-180.0, 180.0)


def line_to(camera: Camera, box: tuple[float, ...], at: str) -> LineOfSight:
    geometry = PictureGeometry(camera.view(0.0))
    (east, north, up), _ = camera.look(0.0)
    return LineOfSight(Vector(east, north), up, getattr(geometry, at)(box), geometry.error_rad)


def camera_at(
    place: tuple[float, float, float], heading_deg: float, pitch_deg: float, body: Body, **how: Any
) -> Camera:
    return Camera("c", FRAME, standing(place, heading_deg, pitch_deg), [body], error_px=0.0, **how)


@given(
    heading=angles, pitch=st.floats(-30.0, 10.0), roll=st.floats(-60.0, 60.0),
    fov=st.floats(10.0, 90.0), x=st.floats(0.0, 640.0), y=st.floats(0.0, 360.0),
)  # fmt: skip
def test_a_direction_goes_back_to_the_pixel_that_it_came_from(
    heading: float, pitch: float, roll: float, fov: float, x: float, y: float
) -> None:
    look = ((0.0, 0.0, 10.0), (heading * DEGREE, pitch * DEGREE, roll * DEGREE))
    geometry = PictureGeometry(Camera("c", FRAME, lambda _: look, [], fov_deg=fov).view(0.0))
    assert geometry.pixel(geometry.ray(x, y)) == pytest.approx((x, y), abs=1e-6)


def test_a_direction_has_the_heading_the_pitch_and_the_roll_of_its_camera() -> None:
    """By hand: sine and cosine are 0.6, 0.8 of heading, 0.28, 0.96 of pitch, 0.8, 0.6 of roll.

    Ahead is (0.576, 0.768, 0.28); right and up before the roll are (0.8, -0.6, 0) and (-0.168,
    -0.224, 0.96), and after it (0.6144, -0.1808, -0.768) and (0.5392, -0.6144, 0.576). The place
    is half a focal length to the right and as much up.
    """
    look = ((0.0, 0.0, 10.0), (math.asin(0.6), math.asin(0.28), math.asin(0.8)))
    geometry = PictureGeometry(Camera("c", FRAME, lambda _: look, [], fov_deg=90.0).view(0.0))
    towards = (1.1528, 0.3704, 0.184)
    assert geometry.ray(480.0, 20.0) == pytest.approx(
        [one / math.hypot(*towards) for one in towards]
    )


@given(
    heading=angles, bearing=st.floats(-15.0, 15.0), distance=st.floats(60.0, 900.0),
    height=st.floats(3.0, 80.0), off_px=st.floats(-BOX_ERROR_PX, BOX_ERROR_PX),
)  # fmt: skip
def test_the_foot_of_a_box_leads_to_where_it_stands_within_the_error(
    heading: float, bearing: float, distance: float, height: float, off_px: float
) -> None:
    azimuth = (heading + bearing) * DEGREE
    place = (distance * math.sin(azimuth), distance * math.cos(azimuth), 0.0)
    # A thin post: the foot of its box is where it stands.
    camera = camera_at((0.0, 0.0, height), heading, -5.0, still("truck", place, (0.01, 0.01, 2.0)))
    box = camera.box(camera.bodies[0], 0.0)
    assume(box is not None and box[3] < 355.0)
    shifted = (box[0] + off_px, box[1], box[2] + off_px, box[3] + off_px)
    fix = line_to(camera, shifted, "foot").on_ground()
    assume(fix is not None)
    true = GroundFix(Vector(*place[:2]), 1e-6, 1e-6, 0.0)
    far = GroundFix(Vector(place[0] * 2.5, place[1] * 2.5), 1e-6, 1e-6, 0.0)
    assert fix.is_same(true, sigmas=2.0)
    assert not fix.is_same(far, sigmas=1.0)


@pytest.mark.parametrize("azimuth_deg", [0.0, 30.0, 135.0, 250.0])
def test_the_ellipse_of_the_error_turns_with_the_line_of_sight(azimuth_deg: float) -> None:
    east, north = math.sin(azimuth_deg * DEGREE), math.cos(azimuth_deg * DEGREE)
    ray = Ray.towards(200.0 * east, 200.0 * north, -10.0)
    fix = LineOfSight(Vector(0.0, 0.0), 10.0, ray, 1e-3).on_ground()
    assert fix is not None
    assert fix.point == pytest.approx((200.0 * east, 200.0 * north))
    spread = np.array([[fix.east_m2, fix.both_m2], [fix.both_m2, fix.north_m2]])
    along, across = np.array([east, north]), np.array([north, -east])
    slant2 = 200.0**2 + 10.0**2
    assert along @ spread @ along == pytest.approx((slant2 / 10.0 * 1e-3) ** 2)
    assert across @ spread @ across == pytest.approx(slant2 * 1e-6)


def test_a_position_counts_while_its_error_is_less_than_half_of_its_distance() -> None:
    """At 100 m from a height of 10 m a line of sight errs by 1,010 m for each radian."""

    def fix(error_m: float) -> GroundFix | None:
        ray = Ray.towards(100.0, 0.0, -10.0)
        return LineOfSight(Vector(0.0, 0.0), 10.0, ray, error_m / 1010.0).on_ground()

    assert fix(49.9) is not None
    assert fix(50.1) is None


@pytest.mark.parametrize("up", [0.0, 0.1, -0.001])
def test_a_line_of_sight_to_the_horizon_or_above_meets_no_ground(up: float) -> None:
    assert LineOfSight(Vector(0.0, 0.0), 10.0, Ray.towards(0.0, 1.0, up), 1e-3).on_ground() is None


@given(
    heading=st.floats(-12.0, 12.0), pitch=st.floats(-6.0, 6.0), roll=st.floats(-60.0, 60.0),
)  # fmt: skip
def test_turning_the_carrier_does_not_turn_what_is_seen(
    heading: float, pitch: float, roll: float
) -> None:
    other = still("airplane", (100.0, 3000.0, 1010.0), CUBE)
    level = Camera("c", FRAME, standing((0.0, 0.0, 1000.0), 0.0), [other], fov_deg=40.0)
    look = ((0.0, 0.0, 1000.0), (heading * DEGREE, pitch * DEGREE, roll * DEGREE))
    turned = Camera("c", FRAME, lambda _: look, [other], fov_deg=40.0)
    box = turned.box(other, 0.0)
    assume(box is not None and turned.width_px - 2 > box[2] and box[0] > 2)
    assume(box[1] > 2 and box[3] < turned.height_px - 2)
    straight = PictureGeometry(level.view(0.0)).middle(level.box(other, 0.0))
    assert PictureGeometry(turned.view(0.0)).middle(box).angle_to(straight) < 5e-5


def test_the_chance_of_being_inside_is_that_of_the_error() -> None:
    fix = GroundFix(Vector(0.0, 0.0), 100.0, 100.0, 0.0)
    assert fix.chance(lambda points: float((points[:, 0] > 0.0).mean())) == pytest.approx(
        0.5, abs=0.1
    )
    assert fix.chance(lambda points: float((points[:, 0] > 10.0).mean())) == pytest.approx(
        0.16, abs=0.06
    )
    within = fix.chance(lambda points: float((np.hypot(*points.T) < 10.0).mean()))
    assert within == pytest.approx(1.0 - math.exp(-0.5), abs=0.1)


@pytest.mark.parametrize("seed", range(4))
def test_two_positions_may_be_one_within_three_standard_deviations_and_6_m(seed: int) -> None:
    """By the distance of Mahalanobis, with 6 m between the ends of one thing."""
    rng = np.random.default_rng(seed)
    spreads = [axes @ axes.T for axes in rng.normal(size=(2, 2, 2)) * 8.0]
    here = rng.normal(size=2) * 50.0
    together = spreads[0] + spreads[1] + 36.0 * np.eye(2)
    for azimuth in np.linspace(0.0, math.tau, 7):
        way = np.array([math.sin(azimuth), math.cos(azimuth)])
        one_sigma_m = 1.0 / math.sqrt(way @ np.linalg.inv(together) @ way)
        for sigmas, is_same in ((2.99, True), (3.01, False)):
            there = here + sigmas * one_sigma_m * way
            first, second = (
                GroundFix(Vector(*point), spread[0, 0], spread[1, 1], spread[0, 1])
                for point, spread in zip((here, there), spreads, strict=True)
            )
            assert bool(first.is_same(second)) is is_same
            assert bool(second.is_same(first)) is is_same


def line(place: tuple[float, float, float], ray: Ray, error_rad: float) -> LineOfSight:
    return LineOfSight(Vector(*place[:2]), place[2], ray, error_rad)


@pytest.mark.parametrize(("apart_m", "size_m", "meets"), [(4.2, 0.0, True), (4.3, 0.0, False),
                                                          (4.3, 0.1, True)])  # fmt: skip
def test_lines_of_sight_that_pass_each_other_meet_halfway(
    apart_m: float, size_m: float, meets: bool
) -> None:
    """100 m along one and 50 m along the other, at right angles, with 1 m of error on each."""
    first = line((0.0, 0.0, 7.0), Ray(1.0, 0.0, 0.0), 0.01)
    second = line((100.0, -50.0, 7.0 + apart_m), Ray(0.0, 1.0, 0.0), 0.02)
    for pair in ((first, second), (second, first)):
        found = meeting(*pair, size_m)
        assert (found is not None) is meets
        if found is not None:
            assert found.point == pytest.approx((100.0, 0.0))
            assert found.height_m == pytest.approx(7.0 + apart_m / 2.0)
            assert found.error_m == found.height_error_m == pytest.approx(math.sqrt(2.0))


def test_the_error_of_a_meeting_grows_the_flatter_the_angle_and_the_steeper_the_lines() -> None:
    """Errors of 1 m each at 30 degrees are sqrt(2) / sin 30; a slope of 0.6 makes height of it."""
    slant = line((0.0, 0.0, 0.0), Ray(0.8, 0.0, 0.6), 0.01)
    found = meeting(slant, line((80.0, -50.0, 60.0), Ray(0.0, 1.0, 0.0), 0.02), 0.0)
    assert found is not None
    assert (found.error_m, found.height_error_m) == pytest.approx(
        (math.sqrt(2.0), math.hypot(math.sqrt(2.0), 0.6 * math.sqrt(2.0)))
    )
    angle = 30.0 * DEGREE
    ray = Ray(math.cos(angle), math.sin(angle), 0.0)
    other = line((100.0 - 50.0 * ray.east, -50.0 * ray.north, 0.0), ray, 0.02)
    found = meeting(line((0.0, 0.0, 0.0), Ray(1.0, 0.0, 0.0), 0.01), other, 0.0)
    assert found is not None
    assert found.point == pytest.approx((100.0, 0.0))
    assert found.error_m == pytest.approx(2.0 * math.sqrt(2.0))


@pytest.mark.parametrize(
    ("angle_deg", "meets"), [(0.9, False), (1.1, True), (178.9, True), (179.1, False)]
)
def test_nearly_parallel_lines_of_sight_give_no_place(angle_deg: float, meets: bool) -> None:
    ray = Ray(math.cos(angle_deg * DEGREE), math.sin(angle_deg * DEGREE), 0.0)
    other = line((100.0 - 50.0 * ray.east, -50.0 * ray.north, 0.0), ray, 1e-4)
    found = meeting(line((0.0, 0.0, 0.0), Ray(1.0, 0.0, 0.0), 1e-4), other, 0.0)
    assert (found is not None) is meets


@given(
    east=st.floats(-200.0, 200.0), north=st.floats(300.0, 900.0), up=st.floats(0.0, 150.0),
)  # fmt: skip
def test_two_lines_of_sight_meet_where_both_lead(east: float, north: float, up: float) -> None:
    def line(place: Vector) -> LineOfSight:
        ray = Ray.towards(east - place.east, north - place.north, up - 3.0)
        return LineOfSight(place, 3.0, ray, 1e-3)

    fix = meeting(line(Vector(-120.0, 0.0)), line(Vector(120.0, 0.0)), 1.0)
    assert fix is not None
    assert (*fix.point, fix.height_m) == pytest.approx((east, north, up), abs=0.01)
    assert fix.error_m < 30.0
