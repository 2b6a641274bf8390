"""Runways, holds, taxi routes, entries and exits of the airports that ship."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely import LineString, Point

from airhilt.errors import ScenarioError
from airhilt.geodesy.wgs84 import Place, distance_and_azimuth, onward
from airhilt.world.surface.airport import Airport, load_airport
from airhilt.world.surface.layout import CLEAR_OF_HOLD_M, Hold, Layout
from airhilt.world.surface.path import length, turn
from airhilt.world.surface.runway import RunwayEnd
from breadth import mostly_slow

SHIPPED = ("EHAM", "KDCA", "KSFO", "LSZH", "RJTT")
NOSE_WHEEL_RADIUS_M = 25.0
"""Wider than the 21 m that a 737-800 needs (Boeing D6-58325-6, section 4.2)."""


@pytest.fixture(scope="module", params=mostly_slow(SHIPPED, "KDCA", "LSZH"))
def layout(request: pytest.FixtureRequest) -> Layout:
    return Layout(load_airport(request.param))


@pytest.fixture(scope="module")
def washington() -> Layout:
    return Layout(load_airport("KDCA"))


def local(layout: Layout, places: Sequence[Place]) -> list[tuple[float, float]]:
    return [layout.local_frame.to_local(place) for place in places]


def midway(layout: Layout, first: str, second: str) -> tuple[float, float]:
    a, b = local(layout, [layout.node(first), layout.node(second)])
    return (a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0


def smallest_radius(layout: Layout, places: Sequence[Place]) -> float:
    points = local(layout, places)
    radii = [math.inf]
    for before, corner, after in zip(points, points[1:], points[2:], strict=False):
        angle = abs(turn(before, corner, after))
        if angle > 1e-3:
            radii.append((math.dist(before, corner) + math.dist(corner, after)) / 2.0 / angle)
    return min(radii)


def entries(layout: Layout) -> Iterator[tuple[Hold, RunwayEnd]]:
    """Every hold with the directions of its runway that have some runway ahead of it."""
    for hold in layout.holds.values():
        for end in layout.strips[hold.runway].ends:
            apart, azimuth = distance_and_azimuth(hold.place, end.end)
            if apart * math.cos(azimuth - end.course_rad) > 200.0:
                yield hold, end


def all_ends(layout: Layout) -> list[str]:
    return [end.ident for strip in layout.strips.values() for end in strip.ends]


# --- runways ----------------------------------------------------------------------------------


def test_the_three_runways_of_washington_cross_each_other(washington: Layout) -> None:
    crossings = {(first, second): at for first, second, at in washington.intersections}
    assert set(crossings) == {("01/19", "04/22"), ("01/19", "15/33"), ("04/22", "15/33")}
    threshold = washington.local_frame.to_local(washington.runway("01").threshold)
    assert math.dist(threshold, crossings["01/19", "04/22"]) == pytest.approx(609.0, abs=2.0)
    assert math.dist(threshold, crossings["01/19", "15/33"]) == pytest.approx(1504.5, abs=2.0)


def test_a_displaced_threshold_lies_beyond_the_start() -> None:
    end = Layout(load_airport("LSZH")).runway("34")
    assert end.displaced_m == pytest.approx(470.0, abs=1.0)
    ahead, azimuth = distance_and_azimuth(end.start, end.threshold)
    assert ahead == pytest.approx(end.displaced_m, abs=0.01)
    assert azimuth == pytest.approx(end.course_rad, abs=1e-6)


@given(along=st.floats(-0.2, 1.2), aside_m=st.floats(-300.0, 300.0), margin_m=st.floats(0.0, 80.0))
def test_a_point_is_protected_where_the_drawn_area_has_it(
    washington: Layout, along: float, aside_m: float, margin_m: float
) -> None:
    for strip in washington.strips.values():
        start, end = (Point(each) for each in strip.centreline.coords)
        ahead = (end.x - start.x) / strip.pavement_m, (end.y - start.y) / strip.pavement_m
        at = (
            start.x + along * (end.x - start.x) + aside_m * ahead[1],
            start.y + along * (end.y - start.y) - aside_m * ahead[0],
        )
        area = strip.protected_area.buffer(margin_m, join_style="mitre")
        assume(area.exterior.distance(Point(at)) > 1e-6)
        assert strip.protects(at, margin_m) == area.contains(Point(at))


# --- holds ------------------------------------------------------------------------------------


def test_hold_lines_lie_on_the_edge_of_the_area_that_they_protect(layout: Layout) -> None:
    for hold in layout.holds.values():
        strip = layout.strips[hold.runway]
        at = Point(layout.local_frame.to_local(hold.place))
        assert strip.protected_area.exterior.distance(at) < 0.02, hold.name
        assert strip.centreline.distance(at) >= strip.hold_distance_m - 0.02, hold.name


def test_holds_are_clear_of_every_pavement_and_of_other_protected_areas(layout: Layout) -> None:
    for hold in layout.holds.values():
        at = Point(layout.local_frame.to_local(hold.place))
        for strip in layout.strips.values():
            assert strip.pavement.distance(at) > 25.0, hold.name
            if strip.name != hold.runway:
                assert not strip.protected_area.contains(at), hold.name


def test_holds_face_the_runway(layout: Layout) -> None:
    for hold in layout.holds.values():
        strip = layout.strips[hold.runway]
        east, north = layout.local_frame.to_local(hold.place)
        ahead = Point(
            east + 30.0 * math.sin(hold.heading_rad), north + 30.0 * math.cos(hold.heading_rad)
        )
        assert strip.centreline.distance(ahead) < strip.centreline.distance(Point(east, north))


def test_every_runway_direction_can_be_entered_near_its_start(layout: Layout) -> None:
    for ident in all_ends(layout):
        end, strip = layout.runway(ident), layout.strip_of(ident)
        start = layout.local_frame.to_local(end.start)
        along = [
            math.dist(start, layout.local_frame.to_local(hold.place))
            for hold in layout.holds.values()
            if hold.runway == strip.name
        ]
        assert min(along) < 350.0, ident


def test_a_hold_is_found_by_runway_and_taxiway(washington: Layout) -> None:
    assert washington.hold("01", "A").name == "01/19 A"
    assert washington.hold("19", "A") is washington.hold("1", "A")


def test_a_taxiway_that_crosses_has_a_hold_on_each_side(washington: Layout) -> None:
    south, north = washington.hold("15", "J_south"), washington.hold("15", "J_north")
    assert math.cos(south.heading_rad - north.heading_rad) == pytest.approx(-1.0, abs=1e-3)
    with pytest.raises(ScenarioError, match=r"2 holds short of runway 15/33 .* J_south or J_north"):
        washington.hold("15", "J")


# --- taxi routes ------------------------------------------------------------------------------


def test_every_hold_is_reached_from_every_stand(layout: Layout) -> None:
    for stand in layout.stands:
        for name, hold in layout.holds.items():
            route = layout.taxi_route(stand, name)
            assert route[0] == pytest.approx(layout.node(stand))
            assert route[-1] == pytest.approx(hold.place)


def test_taxi_corners_are_wide_enough_for_a_737(washington: Layout) -> None:
    for stand in washington.stands:
        for name in washington.holds:
            radius = smallest_radius(washington, washington.taxi_route(stand, name))
            assert radius > NOSE_WHEEL_RADIUS_M, (stand, name)


def test_a_way_crosses_no_runway_but_those_in_between(
    washington: Layout, subtests: pytest.Subtests
) -> None:
    for stand, hold, expected in [
        ("gate_b12", "01/19 A", {"04/22"}),
        ("gate_e50", "01/19 N", {"15/33"}),
        ("gate_c28", "15/33 P", set()),
        ("gate_c28", "04/22 C", set()),
    ]:
        with subtests.test(hold):
            route = LineString(local(washington, washington.taxi_route(stand, hold)))
            strips = washington.strips.items()
            crossed = {name for name, strip in strips if route.crosses(strip.pavement)}
            assert crossed == expected


def test_via_leads_over_the_taxiways_that_it_names(washington: Layout) -> None:
    direct = washington.taxi_route("gate_b12", "01/19 E")
    detour = washington.taxi_route("gate_b12", "01/19 E", via=("F", "J"))
    junction = Point(washington.local_frame.to_local(washington.node("J/F")))
    assert LineString(local(washington, direct)).distance(junction) > 200.0
    assert LineString(local(washington, detour)).distance(junction) < 15.0


def test_a_route_from_a_place_begins_there(washington: Layout) -> None:
    place = washington.local_frame.to_place(-125.0, -100.0)
    route = washington.taxi_route(place, "gate_b12")
    assert route[0] == pytest.approx(place)
    assert route[-1] == pytest.approx(washington.node("gate_b12"))


def test_a_route_between_two_places_on_one_leg_is_straight(washington: Layout) -> None:
    a, b = (washington.local_frame.to_place(-128.6 - 0.0786 * n, n) for n in (-150.0, -50.0))
    route = local(washington, washington.taxi_route(a, b))
    assert length(route) == pytest.approx(100.3, abs=0.5)


def test_a_route_to_where_one_stands_is_that_place(washington: Layout) -> None:
    assert washington.taxi_route("gate_b12", "gate_b12") == [washington.node("gate_b12")]


def test_a_route_to_a_place_on_a_runway_enters_it_by_a_taxiway(washington: Layout) -> None:
    runway = washington.runway("01")
    place = onward(runway.threshold, runway.course_rad, 920.0)
    route = local(washington, washington.taxi_route("fire_station", place))
    strip, way = washington.strips["01/19"], LineString(route)
    assert math.dist(route[-1], washington.local_frame.to_local(place)) < 0.01
    hold = Point(washington.local_frame.to_local(washington.hold("01", "D").place))
    assert way.distance(hold) < 0.1
    assert way.intersection(strip.centreline.buffer(0.5)).length == pytest.approx(90.0, abs=5.0)


def test_two_places_on_one_runway_are_joined_along_it(washington: Layout) -> None:
    runway = washington.runway("01")
    a, b = (onward(runway.threshold, runway.course_rad, along) for along in (300.0, 500.0))
    assert length(local(washington, washington.taxi_route(a, b))) == pytest.approx(200.0, abs=0.1)


def test_a_heading_makes_the_way_go_on_rather_than_turn_round(washington: Layout) -> None:
    place = washington.local_frame.to_place(*midway(washington, "J/E", "J/F"))
    south, north = math.radians(175.5), math.radians(355.5)
    straight, round_about = (
        length(local(washington, washington.taxi_route(place, "gate_b12", heading_rad=heading)))
        for heading in (south, north)
    )
    assert straight < round_about
    route = local(washington, washington.taxi_route(place, "gate_b12", heading_rad=north))
    assert route[1][1] > route[0][1]


def test_where_no_taxiway_leads_there_is_no_route(washington: Layout) -> None:
    taxiways = washington.airport.taxiways
    kept = tuple(edge for edge in taxiways.edges if "K/gate_b12" not in edge.nodes)
    cut_off: Airport = washington.airport.model_copy(
        update={"taxiways": taxiways.model_copy(update={"edges": kept})}
    )
    with pytest.raises(ScenarioError, match="no taxi route from 'gate_b12' to '01/19 A' at KDCA"):
        Layout(cut_off).taxi_route("gate_b12", "01/19 A")


def test_what_does_not_exist_is_answered_with_what_does(
    washington: Layout, subtests: pytest.Subtests
) -> None:
    far = washington.local_frame.to_place(3000.0, 0.0)
    enter, route = washington.entry_path, washington.taxi_route
    asked: list[tuple[Callable[[], Any], str]] = [
        (lambda: washington.runway("27"), "KDCA has no runway '27'; it has 01, 19, 04, 22, 15, 33"),
        (lambda: washington.hold("33", "A"), "no hold .* runway 33 on taxiway 'A'; there is: G, H"),
        (lambda: route(far, "gate_b12"), r"start of the taxi route is \d+ m from the nearest"),
        (lambda: route("gate_b13", "01/19 A"), "no taxiway node 'gate_b13'; did you mean 'gate_b1"),
        (lambda: route("gate_b12", "01/19 A", ("Q",)), "no taxiway 'Q'; known: A, B, C"),
        (lambda: enter(washington.hold("15", "P"), "01"), "short of runway 15/33, not of 01"),
        (lambda: enter(washington.hold("01", "N"), "01"), "'01/19 N' is at the far end of runway"),
    ]
    for ask, told in asked:
        with subtests.test(told), pytest.raises(ScenarioError, match=told):
            ask()


# --- entries and exits ------------------------------------------------------------------------


def test_entry_paths_end_lined_up_on_the_centre_line(layout: Layout) -> None:
    for hold, end in entries(layout):
        path = layout.entry_path(hold, end.ident)
        assert path[0] == pytest.approx(hold.place)
        ahead, azimuth = distance_and_azimuth(path[-2], path[-1])
        assert 0.0 < ahead <= 4.1
        assert math.cos(azimuth - end.course_rad) > math.cos(math.radians(0.1))
        centreline = layout.strips[hold.runway].centreline
        for place in path[-8:]:
            assert centreline.distance(Point(layout.local_frame.to_local(place))) < 0.1


def test_entry_paths_can_be_steered_and_are_dense(layout: Layout) -> None:
    for hold, end in entries(layout):
        path = layout.entry_path(hold, end.ident)
        assert smallest_radius(layout, path) > NOSE_WHEEL_RADIUS_M, (hold.name, end.ident)
        assert max(math.dist(a, b) for a, b in pairwise(local(layout, path))) < 4.1


def test_an_entry_from_the_end_is_lined_up_within_a_hundred_metres(washington: Layout) -> None:
    path = washington.entry_path(washington.hold("01", "A"), "01")
    start = washington.local_frame.to_local(washington.runway("01").start)
    assert math.dist(start, washington.local_frame.to_local(path[-1])) == pytest.approx(
        100.0, abs=1.0
    )


def test_exits_come_in_the_order_in_which_a_landing_meets_them(layout: Layout) -> None:
    for ident in all_ends(layout):
        along = [way.along_m for way in layout.exits(ident)]
        assert along == sorted(along)
        assert along
        assert along[0] > 0.0
        assert along[-1] < layout.runway(ident).length_m


def test_exits_of_runway_01_are_those_on_the_map(washington: Layout) -> None:
    exits = washington.exits("01")
    west = [way.position for way in exits if way.position != "B_east" and way.position != "M_east"]
    assert west == ["B_west", "D", "E", "F", "M_west", "N"]
    assert next(way for way in exits if way.taxiway == "D").along_m == pytest.approx(755.0, abs=1.0)


def test_exits_begin_on_the_centre_line_and_end_clear_of_the_runway(washington: Layout) -> None:
    for ident in all_ends(washington):
        strip = washington.strip_of(ident)
        for way in washington.exits(ident):
            path = local(washington, way.path)
            assert strip.centreline.distance(Point(path[0])) < 0.1
            assert not strip.protected_area.contains(Point(path[-1])), way.hold
            past = LineString(path)
            hold = past.project(
                Point(washington.local_frame.to_local(washington.holds[way.hold].place))
            )
            assert past.length - hold == pytest.approx(CLEAR_OF_HOLD_M, abs=0.5), way.hold


def test_exits_do_not_end_in_the_protected_area_of_another_runway(layout: Layout) -> None:
    for ident in all_ends(layout):
        for way in layout.exits(ident):
            end = Point(layout.local_frame.to_local(way.path[-1]))
            for strip in layout.strips.values():
                assert strip.protected_area.buffer(-0.1).disjoint(end), (ident, way.hold)


def test_exits_can_be_steered_and_acute_ones_are_wide(washington: Layout) -> None:
    for ident in all_ends(washington):
        for way in washington.exits(ident):
            radius = smallest_radius(washington, way.path)
            assert radius > (120.0 if abs(way.turn_rad) < 0.6 else NOSE_WHEEL_RADIUS_M), way.hold
