"""How far two bodies are apart, by their outlines seen from above and by their heights."""

from __future__ import annotations

import math

import pytest
from fakes import Straight
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from airhilt.metrics.outline import gap, radius_m
from airhilt.units import FOOT

LENGTH_M, SPAN_M, HEIGHT_M = 33.63, 34.32, 12.57


def plane(
    east_m: float = 0.0, north_m: float = 0.0, heading_deg: float = 0.0, height_m: float = 0.0
):
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


def test_a_moment_ago_they_touched() -> None:
    first, second = plane(heading_deg=90.0), plane(east_m=-60.0, heading_deg=270.0)
    assert not gap(first, second).touches
    assert gap(first, second, at_s=-0.6).touches


poses = st.tuples(st.floats(-80.0, 80.0), st.floats(-80.0, 80.0), st.floats(0.0, 359.0))


@settings(deadline=None, max_examples=60)
@given(poses, poses, st.floats(0.0, 30.0))
def test_it_does_not_matter_who_is_asked(first, second, height) -> None:
    a, b = plane(*first), plane(*second, height)
    assert gap(a, b).horizontal_m == pytest.approx(gap(b, a).horizontal_m, abs=1e-3)
    assert gap(a, b).vertical_m == pytest.approx(gap(b, a).vertical_m, abs=1e-9)


@settings(deadline=None, max_examples=60)
@given(poses, st.floats(0.0, 359.0))
def test_turning_the_whole_scene_changes_nothing(second, turn) -> None:
    east, north, heading = second
    sin, cos = math.sin(math.radians(turn)), math.cos(math.radians(turn))
    turned = (east * cos + north * sin, north * cos - east * sin, (heading + turn) % 360.0)
    before = gap(plane(), plane(*second)).horizontal_m
    after = gap(plane(heading_deg=turn), plane(*turned)).horizontal_m
    assert after == pytest.approx(before, abs=0.05)


@settings(deadline=None, max_examples=60)
@given(poses)
def test_the_circles_around_them_bound_the_distance(second) -> None:
    a, b = plane(), plane(*second)
    between = math.hypot(*second[:2])
    assume(between > 1.0)
    found = gap(a, b).horizontal_m
    assert between - radius_m(a) - radius_m(b) - 0.1 <= found <= between
