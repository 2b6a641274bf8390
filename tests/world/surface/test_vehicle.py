"""A vehicle follows its path within its limits, and stops exactly at the end."""

from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, Point

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place
from airhilt.units import wrap_angle
from airhilt.world.mover import SurfaceState
from airhilt.world.surface.alignment import CORNER_CUT_M
from airhilt.world.surface.kinds import load_kind
from airhilt.world.surface.vehicle import Vehicle, VehicleKind
from breadth import examples

HERE: Place = (math.radians(38.8521), math.radians(-77.0377))
GROUND_M = 4.6
LOCAL_FRAME = LocalFrame(HERE, GROUND_M)
TICK_S = 0.05
Local = tuple[float, float]

kinds = st.sampled_from(["follow_me", "fire_truck", "snow_plough", "tug_with_aircraft"])
headings = st.floats(-math.pi, math.pi)
legs = st.tuples(st.floats(0.5, 250.0), st.floats(-math.pi, math.pi))


def vehicle(kind: str = "follow_me", heading_rad: float = 0.0) -> Vehicle:
    made = load_kind(kind, "vehicle").create(HERE, heading_rad, ground_m=GROUND_M, tick_s=TICK_S)
    assert isinstance(made, Vehicle)
    return made


def path(*points: Local) -> list[Place]:
    return [LOCAL_FRAME.to_place(*point) for point in points]


def where(state: SurfaceState) -> Local:
    return LOCAL_FRAME.to_local((state.latitude_rad, state.longitude_rad))


def chain(steps: list[tuple[float, float]]) -> list[Local]:
    points = list(
        itertools.accumulate(
            steps,
            lambda at, leg: (at[0] + leg[0] * math.sin(leg[1]), at[1] + leg[0] * math.cos(leg[1])),
            initial=(0.0, 0.0),
        )
    )
    return points[1:]


def until_it_stands(body: Vehicle) -> list[SurfaceState]:
    states = [body.state]
    while body.phase != "standing":
        body.advance()
        states.append(body.state)
        assert len(states) < 500_000
    return states


def assert_within_limits(kind: VehicleKind, states: list[SurfaceState]) -> None:
    for before, after in itertools.pairwise(states):
        old, new = before.ground_speed_m_s, after.ground_speed_m_s
        assert -kind.braking_m_s2 <= (new - old) / TICK_S + 1e-6
        assert (new - old) / TICK_S <= kind.acceleration_m_s2 + 1e-6
        assert new <= kind.maximum_m_s + 1e-9
        turned = abs(wrap_angle(after.heading_rad - before.heading_rad))
        way = math.dist(where(before), where(after))
        # A chord is shorter than its arc, by less than a thousandth at these speeds and radii.
        assert turned <= way / kind.turning_radius_m * 1.001 + 1e-7
        assert turned / TICK_S * 0.5 * (old + new) <= kind.lateral_m_s2 * 1.001 + 1e-6
        assert way <= 0.5 * (old + new) * TICK_S * 1.001 + 1e-5 + old * old * TICK_S


@examples(60)
@given(kind=kinds, heading=headings, steps=st.lists(legs, min_size=1, max_size=7))
def test_any_path_is_driven_within_the_limits_to_its_very_end(
    kind: str, heading: float, steps: list[tuple[float, float]]
) -> None:
    body = vehicle(kind, heading)
    points = chain(steps)
    body.drive(path(*points))
    states = until_it_stands(body)
    assert_within_limits(body.kind, states)
    # Ends nearer to the start or to each other than 1 cm are one place.
    assert math.dist(where(body.state), points[-1]) < 0.011
    assert body.state.ground_speed_m_s == 0.0


@examples(60)
@given(
    kind=kinds,
    first=st.lists(legs, min_size=1, max_size=4),
    second=st.lists(legs, min_size=1, max_size=4),
    after=st.integers(1, 600),
)
def test_a_new_path_underway_is_taken_within_the_limits(
    kind: str, first: list[tuple[float, float]], second: list[tuple[float, float]], after: int
) -> None:
    body = vehicle(kind)
    body.drive(path(*chain(first)), body.kind.maximum_m_s)
    states = [body.state]
    for _ in range(after):
        body.advance()
        states.append(body.state)
    start = where(body.state)
    points = [(start[0] + east, start[1] + north) for east, north in chain(second)]
    body.drive(path(*points))
    states += until_it_stands(body)
    assert_within_limits(body.kind, states)
    assert math.dist(where(body.state), points[-1]) < 0.011


@examples(40)
@given(
    kind=kinds,
    turns=st.lists(st.floats(-math.pi / 2.0, math.pi / 2.0), min_size=1, max_size=5),
)
def test_corners_with_room_are_cut_by_no_more_than_the_radius_needs(
    kind: str, turns: list[float]
) -> None:
    body = vehicle(kind)
    courses = itertools.accumulate(turns, initial=0.0)
    points = chain([(4.0 * body.kind.turning_radius_m, course) for course in courses])
    body.drive(path(*points))
    line = LineString([(0.0, 0.0), *points])
    needed = body.kind.turning_radius_m * (1.0 / math.cos(math.pi / 4.0) - 1.0)
    for state in until_it_stands(body)[::5]:
        assert line.distance(Point(where(state))) <= max(CORNER_CUT_M, needed) + 0.01


def test_a_curve_given_as_many_points_is_driven_as_the_curve_that_it_is() -> None:
    radius = 60.0
    bend = [
        (radius - radius * math.cos(angle), 100.0 + radius * math.sin(angle))
        for angle in (0.05 * step for step in range(32))
    ]
    body = vehicle()
    body.drive(path(*bend, (200.0, 160.0)), 14.0)
    on_the_bend = [state for state in until_it_stands(body) if 5.0 < where(state)[0] < 50.0]
    slowest = min(state.ground_speed_m_s for state in on_the_bend)
    assert slowest == pytest.approx(math.sqrt(body.kind.lateral_m_s2 * radius), rel=0.02)


def test_it_slows_down_for_a_corner_and_speeds_up_again() -> None:
    body = vehicle()
    body.drive(path((0.0, 200.0), (200.0, 200.0)))
    states = until_it_stands(body)
    corner = min(states, key=lambda state: math.dist(where(state), (0.0, 200.0)))
    assert corner.ground_speed_m_s < 5.5
    for place in ((0.0, 100.0), (100.0, 200.0)):
        midway = min(states, key=lambda state: math.dist(where(state), place))
        assert midway.ground_speed_m_s == pytest.approx(body.kind.cruise_m_s)


def test_it_turns_round_on_its_least_radius_to_go_back() -> None:
    body = vehicle("fire_truck")
    body.drive(path((0.0, -200.0)))
    widest = max(abs(where(state)[0]) for state in until_it_stands(body))
    assert widest < 2.0 * body.kind.turning_radius_m + 1.0
    assert where(body.state)[1] == pytest.approx(-200.0, abs=1e-3)


def test_points_too_near_for_its_radius_are_left_out_instead_of_looped_around() -> None:
    body = vehicle("tug_with_aircraft")
    body.drive(path((0.0, 60.0), (3.0, 61.0), (6.0, 60.0), (60.0, 20.0)))
    places = [where(state) for state in until_it_stands(body)]
    driven = sum(math.dist(a, b) for a, b in itertools.pairwise(places))
    assert driven < 60.0 + 6.0 + 68.0 + 40.0
    assert math.dist(where(body.state), (60.0, 20.0)) < 1e-3


def test_told_to_stop_it_brakes_on_the_path_and_told_to_go_on_it_reaches_the_end() -> None:
    body = vehicle()
    body.drive(path((0.0, 300.0)))
    for _ in range(300):
        body.advance()
    speed, north = body.state.ground_speed_m_s, where(body.state)[1]
    body.stop()
    assert body.phase == "stopping"
    until_it_stands(body)
    braked = where(body.state)[1] - north
    assert braked == pytest.approx(speed**2 / (2.0 * body.kind.braking_m_s2), rel=1e-3)
    for _ in range(100):
        body.advance()
    assert where(body.state)[1] == pytest.approx(north + braked, abs=1e-6)
    body.resume()
    assert body.phase == "driving"
    until_it_stands(body)
    assert where(body.state)[1] == pytest.approx(300.0, abs=1e-3)


@examples(30)
@given(stops=st.lists(st.integers(1, 200), min_size=1, max_size=6))
def test_stopping_and_going_on_at_any_time_keeps_the_limits_and_the_end(stops: list[int]) -> None:
    body = vehicle("snow_plough")
    body.drive(path((0.0, 60.0), (60.0, 60.0), (60.0, 0.0)))
    states = [body.state]
    for ticks in stops:
        for _ in range(ticks):
            body.advance()
            states.append(body.state)
        body.stop()
        for _ in range(ticks):
            body.advance()
            states.append(body.state)
        if math.dist(where(body.state), (60.0, 0.0)) > 1e-3:
            body.resume()
    states += until_it_stands(body)
    assert_within_limits(body.kind, states)
    assert math.dist(where(body.state), (60.0, 0.0)) < 1e-3


def test_the_speed_asked_for_is_kept_and_the_greatest_of_the_kind_is_never_passed() -> None:
    for asked, driven in ((5.0, 5.0), (1000.0, 6.9)):
        body = vehicle("tug_with_aircraft")
        body.drive(path((0.0, 400.0)), asked)
        fastest = max(state.ground_speed_m_s for state in until_it_stands(body))
        assert fastest == pytest.approx(driven)


def test_the_velocity_is_that_of_the_change_of_place() -> None:
    body = vehicle(heading_rad=0.6)
    body.drive(path((200.0, 300.0), (400.0, 100.0)))
    for before, after in itertools.pairwise(until_it_stands(body)):
        (east_0, north_0), (east_1, north_1) = where(before), where(after)
        east = 0.5 * (before.velocity_east_m_s + after.velocity_east_m_s)
        north = 0.5 * (before.velocity_north_m_s + after.velocity_north_m_s)
        assert (east_1 - east_0) / TICK_S == pytest.approx(east, abs=0.02)
        assert (north_1 - north_0) / TICK_S == pytest.approx(north, abs=0.02)


def test_it_stands_where_it_was_put_until_it_is_told_to_drive() -> None:
    body = vehicle(heading_rad=-0.5)
    before = body.state
    for _ in range(10):
        body.advance()
    assert body.state is before
    assert body.phase == "standing"
    assert body.on_ground
    assert before.altitude_m == GROUND_M
    assert before.heading_rad == pytest.approx(math.tau - 0.5)


def test_what_has_ended_moves_no_more() -> None:
    body = vehicle()
    body.drive(path((0.0, 100.0)))
    body.advance()
    body.ended = "collision"
    before = body.state
    body.advance()
    assert body.state is before


def test_a_path_to_where_it_stands_leaves_it_there() -> None:
    body = vehicle()
    body.drive([HERE])
    assert body.phase == "standing"


def test_paths_that_cannot_be_driven_are_refused(subtests: pytest.Subtests) -> None:
    for places, speed, says in [
        ([], None, "at least its end"),
        ([HERE], 0.0, "more than 0"),
        ([HERE], math.nan, "more than 0"),
        ([(math.nan, 0.0)], None, "not within"),
        ([(0.0, 0.0)], None, "not within 50 km"),
    ]:
        with subtests.test(str((places, speed, says))):
            body = vehicle()
            with pytest.raises(ValueError, match=says):
                body.drive(places, speed)
            assert body.phase == "standing"


def test_nothing_is_left_to_go_on_with_at_the_end() -> None:
    body = vehicle()
    body.drive(path((0.0, 20.0)))
    until_it_stands(body)
    with pytest.raises(ValueError, match="no path"):
        body.resume()
