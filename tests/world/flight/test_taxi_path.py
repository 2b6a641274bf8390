"""The path of a taxiing aircraft by itself: where it is on it, where it steers, and how fast."""

from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place
from airhilt.units import DEGREE
from airhilt.world.flight.state import AircraftState
from airhilt.world.flight.taxi_path import TaxiPath
from stand_ins import state_at

START = (38.85 * DEGREE, -77.04 * DEGREE)
FRAME = LocalFrame(START)
Point = tuple[float, float]
"""East and north of the start, in m."""


def place(point: Point) -> Place:
    return FRAME.to_place(*point)


def path(*points: Point, speed_m_s: float = 10.0, look_ahead_m: float = 8.0) -> TaxiPath:
    return TaxiPath([place(point) for point in points], speed_m_s, look_ahead_m)


def at(point: Point, heading_deg: float = 0.0, speed_m_s: float = 5.0) -> AircraftState:
    return state_at(place(point), track_rad=heading_deg * DEGREE, speed_m_s=speed_m_s)


# --- where it is ----------------------------------------------------------------------------


def test_it_is_as_far_along_as_the_nearest_point_of_the_path(subtests: pytest.Subtests) -> None:
    for point, along_m in [
        ((0.0, 0.0), 0.0),
        ((0.0, -3.0), -3.0),  # Before its beginning.
        ((0.0, 4.0), 4.0),
        ((2.0, 7.0), 7.0),
        ((-2.0, 12.5), 12.5),
    ]:
        with subtests.test(str((point, along_m))):
            assert path((0.0, 0.0), (0.0, 100.0)).along_m(at(point)) == pytest.approx(
                along_m, abs=1e-3
            )


def test_it_goes_along_every_leg_and_beyond_the_end() -> None:
    bent = path((0.0, 0.0), (0.0, 20.0), (30.0, 20.0))
    assert bent.length_m == pytest.approx(50.0, abs=1e-3)
    points = [(0.0, float(north)) for north in range(0, 20, 2)]
    points += [(float(east), 20.0) for east in range(0, 34, 2)]
    for step, point in enumerate(points):
        assert bent.along_m(at(point)) == pytest.approx(2.0 * step, abs=1e-3)


def test_a_round_trip_begins_at_its_beginning() -> None:
    """Its end is at the same place."""
    round_trip = path((0.0, 0.0), (0.0, 40.0), (40.0, 40.0), (40.0, 0.0), (0.0, 0.0))
    assert round_trip.length_m == pytest.approx(160.0, abs=1e-3)
    assert round_trip.along_m(at((0.0, 0.0))) == pytest.approx(0.0, abs=1e-3)


def test_places_that_are_one_are_no_leg() -> None:
    assert path((0.0, 0.0), (0.0, 0.0), (0.0, 30.0), (0.0, 30.0)).length_m == (
        pytest.approx(30.0, abs=1e-3)
    )


# --- where it steers ------------------------------------------------------------------------


def test_the_point_at_a_distance_is_on_the_path_and_straight_on_beyond_its_ends() -> None:
    bent = path((0.0, 0.0), (0.0, 5.0), (30.0, 5.0))
    for along_m, point in [
        (-4.0, (0.0, -4.0)), (0.0, (0.0, 0.0)), (2.0, (0.0, 2.0)), (5.0, (0.0, 5.0)),
        (6.0, (1.0, 5.0)), (35.0, (30.0, 5.0)), (45.0, (40.0, 5.0)),
    ]:  # fmt: skip
        assert bent._at(along_m) == pytest.approx(point, abs=1e-3)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("speed_m_s", [2.0, 4.0, 12.0])
def test_it_yaws_along_the_circle_through_the_point_ahead(side: float, speed_m_s: float) -> None:
    """The circle that is tangent to the heading, through a point 8 m ahead, or 1.5 s at speed."""
    straight = path((0.0, 0.0), (0.0, 100.0))
    reach_m, aside_m = max(8.0, 1.5 * speed_m_s), 1.0
    chord_m = math.hypot(reach_m, aside_m)
    radius_m = chord_m / (2.0 * aside_m / chord_m)
    yaw_rate = straight.yaw_rate(at((-side * aside_m, 20.0), 0.0, speed_m_s), 20.0)
    assert yaw_rate == pytest.approx(side * speed_m_s / radius_m, rel=1e-3)


def test_on_the_path_it_does_not_yaw_and_away_from_it_not_by_more_than_a_quarter_turn() -> None:
    straight = path((0.0, 0.0), (0.0, 100.0))
    assert straight.yaw_rate(at((0.0, 20.0)), 20.0) == pytest.approx(0.0, abs=1e-5)
    backward = straight.yaw_rate(at((0.0, 20.0), 179.0), 20.0)
    assert backward == pytest.approx(-2.0 * 5.0 / 8.0, rel=1e-3)
    assert straight.yaw_rate(at((1.0, 20.0), speed_m_s=0.0), 20.0) < 0.0


# --- how fast -------------------------------------------------------------------------------


def test_towards_the_end_it_slows_down_evenly_by_0_8_m_s2(subtests: pytest.Subtests) -> None:
    for to_go_m in [0.5, 4.0, 7.3, 20.0, 62.0, 63.0, 80.0]:
        with subtests.test(str(to_go_m)):
            straight = path((0.0, 0.0), (0.0, 100.0))
            expected = min(math.sqrt(2.0 * 0.8 * to_go_m), 10.0)
            assert straight.speed_m_s(100.0 - to_go_m) == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("along_m", [100.001, 101.0, 500.0])
def test_at_the_end_it_stands(along_m: float) -> None:
    assert path((0.0, 0.0), (0.0, 100.0)).speed_m_s(along_m) == 0.0


@pytest.mark.parametrize(("turn_deg", "slowest_m_s"), [(90.0, 2.0), (30.0, 2.716), (10.0, 4.778)])
def test_a_turn_is_taken_at_0_8_m_s2_to_the_side_but_not_slower_than_2_m_s(
    turn_deg: float, slowest_m_s: float
) -> None:
    """The chord over two pieces of 5 m, halved, over the angle is the radius of the arc."""
    east, north = math.sin(turn_deg * DEGREE), math.cos(turn_deg * DEGREE)
    for side in (1.0, -1.0):
        bent = path((0.0, 0.0), (0.0, 49.99), (side * 49.99 * east, 49.99 + 49.99 * north))
        assert bent.speed_m_s(49.989) == pytest.approx(slowest_m_s, rel=0.02)
        before_m_s = math.sqrt(slowest_m_s**2 + 2.0 * 0.8 * 10.0)
        assert bent.speed_m_s(39.99) == pytest.approx(before_m_s, rel=0.02)


def test_on_a_straight_way_it_has_its_greatest_speed_everywhere_and_never_more() -> None:
    straight = path((0.0, 0.0), (0.0, 50.0), (0.0, 200.0))
    assert [straight.speed_m_s(0.7 * step) for step in range(180)] == pytest.approx([10.0] * 180)


@settings(max_examples=30, deadline=None)
@given(st.lists(st.tuples(st.floats(-200.0, 200.0), st.floats(-200.0, 200.0)),
                min_size=2, max_size=6), st.floats(3.0, 15.0))  # fmt: skip
def test_it_never_has_to_brake_harder_than_that(corners: list[Point], speed_m_s: float) -> None:
    points = [(0.0, 0.0), *corners, (250.0, 250.0)]
    taxied = path(*points, speed_m_s=speed_m_s)
    steps = [taxied.length_m * step / 400.0 for step in range(401)]
    speeds = [taxied.speed_m_s(along_m) for along_m in steps]
    for step, (faster, slower) in enumerate(itertools.pairwise(speeds)):
        braking = (faster**2 - slower**2) / 2.0 / (steps[step + 1] - steps[step])
        assert braking <= 0.8 + 1e-3
    assert max(speeds) <= speed_m_s
    assert speeds[-1] == pytest.approx(0.0, abs=1e-3)
