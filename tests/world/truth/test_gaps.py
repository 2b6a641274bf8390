"""How far two bodies are apart, by their outlines seen from above and by their heights."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.units import FOOT
from airhilt.world.flight import load_aircraft_type
from airhilt.world.truth.gaps import corners, gap
from breadth import examples
from straight import Rolling, Straight

LENGTH_M, SPAN_M, HEIGHT_M = 33.63, 34.32, 12.57


def plane(
    east_m: float = 0.0, north_m: float = 0.0, heading_deg: float = 0.0, height_m: float = 0.0
) -> Any:
    heading = math.radians(heading_deg)
    return Straight(
        east_m,
        north_m,
        altitude_ft=height_m / FOOT,
        east_m_s=50.0 * math.sin(heading),
        north_m_s=50.0 * math.cos(heading),
    )


def test_nose_to_nose_is_the_distance_less_a_length() -> None:
    between = gap(plane(heading_deg=0.0), plane(north_m=100.0, heading_deg=180.0))
    assert between.horizontal_m == pytest.approx(100.0 - LENGTH_M, abs=0.1)
    assert between.vertical_m == 0.0
    assert not between.touches


def test_wing_tip_to_wing_tip_is_the_distance_less_a_span() -> None:
    between = gap(plane(), plane(east_m=60.0))
    assert between.horizontal_m == pytest.approx(60.0 - SPAN_M, abs=0.1)


def test_a_nose_may_lie_before_a_wing_where_a_box_would_touch() -> None:
    """Side by side, the second's tail before the first's swept wing: both boxes overlap."""
    between = gap(plane(), plane(east_m=16.0, north_m=30.0))
    assert between.horizontal_m > 0.5


def test_above_each_other_they_touch_only_within_their_height() -> None:
    assert gap(plane(), plane(height_m=HEIGHT_M - 0.1)).touches
    above = gap(plane(), plane(height_m=HEIGHT_M + 10.0))
    assert above.horizontal_m == 0.0
    assert above.vertical_m == pytest.approx(10.0, abs=1e-6)
    assert above.slant_m == pytest.approx(10.0, abs=1e-6)


def test_between_a_car_and_an_aircraft_above_it_is_the_height_of_the_car() -> None:
    car: Any = Rolling(north_m_s=1.0)
    above = plane(height_m=10.0)
    for between in (gap(car, above), gap(above, car)):
        assert between.vertical_m == pytest.approx(10.0 - car.dimensions.height_m, abs=1e-6)


def test_a_moment_ago_they_touched() -> None:
    first, second = plane(heading_deg=90.0), plane(east_m=-60.0, heading_deg=270.0)
    assert not gap(first, second).touches
    assert gap(first, second, at_s=-0.6).touches


@pytest.mark.parametrize("heading_deg", [0.0, 90.0, 225.0])
def test_the_corners_are_nose_tail_sides_and_centre(heading_deg: float) -> None:
    heading = math.radians(heading_deg)
    ahead = math.sin(heading), math.cos(heading)
    right = math.cos(heading), -math.sin(heading)
    nose, tail, starboard, port, centre = corners(plane(heading_deg=heading_deg)).tolist()
    assert nose == pytest.approx([part * LENGTH_M / 2.0 for part in ahead], abs=0.01)
    assert tail == pytest.approx([-part * LENGTH_M / 2.0 for part in ahead], abs=0.01)
    assert starboard == pytest.approx([part * SPAN_M / 2.0 for part in right], abs=0.01)
    assert port == pytest.approx([-part * SPAN_M / 2.0 for part in right], abs=0.01)
    assert centre == [0.0, 0.0]


poses = st.tuples(st.floats(-80.0, 80.0), st.floats(-80.0, 80.0), st.floats(0.0, 359.0))


@examples(60)
@given(poses, poses, st.floats(0.0, 30.0))
def test_it_does_not_matter_who_is_asked(
    first: tuple[float, float, float], second: tuple[float, float, float], height: float
) -> None:
    a, b = plane(*first), plane(*second, height)
    assert gap(a, b).horizontal_m == pytest.approx(gap(b, a).horizontal_m, abs=1e-3)
    assert gap(a, b).vertical_m == pytest.approx(gap(b, a).vertical_m, abs=1e-9)


@examples(60)
@given(poses, st.floats(0.0, 359.0))
def test_turning_the_whole_scene_changes_nothing(
    second: tuple[float, float, float], turn: float
) -> None:
    east, north, heading = second
    sin, cos = math.sin(math.radians(turn)), math.cos(math.radians(turn))
    turned = (east * cos + north * sin, north * cos - east * sin, (heading + turn) % 360.0)
    before = gap(plane(), plane(*second)).horizontal_m
    after = gap(plane(heading_deg=turn), plane(*turned)).horizontal_m
    assert after == pytest.approx(before, abs=0.05)


TYPES = [load_aircraft_type(name) for name in ("737", "B747", "c172p", "c310")]


def test_an_outline_is_as_long_and_as_wide_as_the_aircraft(subtests: pytest.Subtests) -> None:
    for kind in TYPES:
        with subtests.test(str(kind)):
            size = kind.dimensions
            middle: Any = Straight(altitude_ft=0.0, north_m_s=1.0, kind=kind)
            for east, north, short in ((0.0, 200.0, size.length_m), (200.0, 0.0, size.span_m)):
                post: Any = Rolling(east, north, north_m_s=1.0)
                half = post.dimensions.length_m / 2.0 if north else post.dimensions.span_m / 2.0
                expected = 200.0 - short / 2.0 - half
                found = gap(middle, post).horizontal_m
                # A wing tip that is swept back lies aside of the middle: at a slant, it is farther.
                assert found == pytest.approx(expected, rel=0.01)
                assert found >= expected - 0.1
