"""The logic of the runway status lights by itself, at both sides of each number of the AIM."""

from __future__ import annotations

import math
from typing import Any, cast

import pytest

from airfield import ELEVATION_M, HOLD_M, NORTH, SOUTHEAST, WIDTH_M, Axis, degrees
from airhilt.assistant.decision.status_lights import RedLights, StatusLightConfig, StatusLights
from airhilt.assistant.decision.surface_traffic import Target
from airhilt.units import DEGREE, FOOT, KNOT, NAUTICAL_MILE, SECOND_NS
from instants import AERODROME, crossing_m

EDGE_M = HOLD_M - AERODROME.strips[0].margin_m()
"""Distance from the centre line at which the area of a runway begins."""
FAST_M_S = 130.0 * KNOT


def target(
    along_m: float, across_m: float = 0.0, speed_m_s: float = 0.0, *, axis: Axis = NORTH,
    turned_deg: float | None = 0.0, height_m: float | None = None, number: int = 1, **state: Any,
) -> Target:  # fmt: skip
    """Return a target beside a threshold, which moves at an angle to the runway."""
    place = AERODROME.locate(*degrees(axis.local(along_m, across_m)))
    course = None if turned_deg is None else (axis.course_deg + turned_deg) * DEGREE
    altitude_m = None if height_m is None else ELEVATION_M + height_m
    found = Target(
        number, place, speed_m_s=speed_m_s, heading_rad=course, altitude_m=altitude_m, **state
    )
    found._speeds.append((0, speed_m_s))
    return found


def waits(along_m: float, entry_m: float = 5.0, speed_m_s: float = 0.0, **how: Any) -> Target:
    """Return somebody right of the runway who looks at it, so far before its area."""
    return target(
        along_m, EDGE_M + entry_m, speed_m_s, **({"turned_deg": -90.0, "number": 9} | how)
    )


def arrival(along_m: float, speed_m_s: float = FAST_M_S, **how: Any) -> Target:
    return target(along_m, how.pop("across_m", 0.0), speed_m_s, **({"height_m": 50.0} | how))


def lights(*targets: Target, logic: StatusLights | None = None, t_ns: int = 0) -> list[RedLights]:
    logic = logic or StatusLights(AERODROME, StatusLightConfig())
    return list(logic.lit(cast(Any, targets), t_ns))


def entrance(*targets: Target, logic: StatusLights | None = None) -> bool:
    """Return whether somebody has red entrance lights before the eyes."""
    return any(each.lights == "entrance" for each in lights(*targets, logic=logic))


# --- entrance lights for who lands ---------------------------------------------------------


@pytest.mark.parametrize(
    ("speed_kt", "from_m"),
    [(130.0, NAUTICAL_MILE), (110.0, NAUTICAL_MILE), (109.9, 0.75 * NAUTICAL_MILE)],
)
def test_an_arrival_lights_the_entrances_from_a_mile_and_a_slow_one_from_three_quarters(
    speed_kt: float, from_m: float
) -> None:
    assert entrance(waits(800.0), arrival(1.0 - from_m, speed_kt * KNOT))
    assert not entrance(waits(800.0), arrival(-1.0 - from_m, speed_kt * KNOT))


@pytest.mark.parametrize(
    ("how", "is_lit"),
    [
        ({"turned_deg": 14.9}, True), ({"turned_deg": 15.1}, False), ({"turned_deg": -15.1}, False),
        ({"turned_deg": None}, False),
        ({"across_m": 199.0}, True), ({"across_m": 201.0}, False), ({"across_m": -201.0}, False),
        ({"height_m": 237.0}, True), ({"height_m": 238.0}, False),
        ({"has_taken_off": True}, False),
        ({"_lowest_m": ELEVATION_M + 50.0 - 99.0 * FOOT}, True),
        ({"_lowest_m": ELEVATION_M + 50.0 - 101.0 * FOOT}, False),
    ],
)  # fmt: skip
def test_an_arrival_is_aligned_near_the_centre_line_not_too_high_and_does_not_climb(
    how: dict[str, Any], is_lit: bool
) -> None:
    """1 km out: within 120 m and 8 % of that, and below 150 m and 5 degrees."""
    assert entrance(waits(800.0), arrival(-1000.0, **how)) is is_lit


def test_over_the_runway_an_arrival_lights_the_entrances_ahead() -> None:
    assert entrance(waits(800.0), arrival(300.0, across_m=119.0, height_m=149.0))
    assert not entrance(waits(800.0), arrival(300.0, across_m=121.0))
    assert not entrance(waits(800.0), arrival(300.0, height_m=151.0))
    assert not entrance(waits(800.0), arrival(900.0))


def test_a_landing_above_80_kt_lights_all_and_a_slower_one_what_it_reaches_in_30_s() -> None:
    for speed_kt, reach_s in ((79.9, 30.0), (34.1, 30.0), (80.0, math.inf)):
        speed_m_s = speed_kt * KNOT
        rolls = target(10.0, 0.0, speed_m_s, has_landed=True)
        for waits_s in (29.8, 30.2):
            assert entrance(waits(10.0 + speed_m_s * waits_s), rolls) is (waits_s < reach_s)
    assert not entrance(waits(300.0), target(10.0, 0.0, 33.9 * KNOT, has_landed=True))


# --- entrance lights for who takes off -----------------------------------------------------


@pytest.mark.parametrize(("speed_kt", "is_lit"), [(30.1, True), (29.9, False)])
def test_a_departure_lights_them_from_30_kt(speed_kt: float, is_lit: bool) -> None:
    assert entrance(waits(800.0), target(100.0, 0.0, speed_kt * KNOT)) is is_lit


@pytest.mark.parametrize(("ahead_s", "is_lit"), [(3.02, True), (2.98, False), (-1.0, False)])
def test_they_go_out_3_s_before_the_crossing(ahead_s: float, is_lit: bool) -> None:
    assert entrance(waits(100.0 + 40.0 * ahead_s), target(100.0, 0.0, 40.0)) is is_lit


def test_a_rejected_take_off_puts_them_out_below_34_kt() -> None:
    for speeds_kt, is_lit in (
        ((33.0, 31.0), True),  # It has not been faster than 34 kt.
        ((40.0, 34.1), True),
        ((40.0, 33.9), False),
        ((40.0, 33.9, 35.0), True),
        ((40.0, 35.0, 33.9), False),
    ):
        logic = StatusLights(AERODROME, StatusLightConfig())
        lit = [
            entrance(waits(800.0), target(100.0, 0.0, speed_kt * KNOT), logic=logic)
            for speed_kt in speeds_kt
        ]
        assert lit[-1] is is_lit


@pytest.mark.parametrize(
    ("how", "is_lit"),
    [
        ({"turned_deg": 14.9}, True), ({"turned_deg": 15.1}, False), ({"turned_deg": -15.1}, False),
        ({"across_m": WIDTH_M / 2.0 + 9.9}, True), ({"across_m": WIDTH_M / 2.0 + 10.1}, False),
        ({"along_m": -499.0}, True), ({"along_m": -501.0}, False),
    ],
)  # fmt: skip
def test_who_uses_a_runway_is_on_its_pavement_and_points_along_it(
    how: dict[str, Any], is_lit: bool
) -> None:
    place = {"along_m": 100.0, "across_m": 0.0} | how
    assert entrance(waits(800.0), target(**place, speed_m_s=30.0)) is is_lit


# --- before whose eyes, and who goes on ----------------------------------------------------


@pytest.mark.parametrize(("entry_m", "sees"), [(99.0, True), (101.0, False)])
def test_they_are_seen_from_100_m(entry_m: float, sees: bool) -> None:
    assert entrance(waits(800.0, entry_m), arrival(-1000.0)) is sees


@pytest.mark.parametrize(("beside_m", "sees"), [(0.5, True), (-0.5, False)])
def test_who_is_right_beside_the_pavement_still_has_them_ahead(beside_m: float, sees: bool) -> None:
    viewer = target(800.0, WIDTH_M / 2.0 + beside_m, turned_deg=-90.0, number=9)
    assert entrance(viewer, arrival(-1000.0)) is sees


def test_who_is_on_the_runway_looks_away_or_has_not_moved_has_none_ahead() -> None:
    for viewer in (
        target(800.0, 0.0, turned_deg=-90.0, number=9),
        waits(800.0, turned_deg=90.0),
        waits(800.0, turned_deg=None),
        waits(800.0, height_m=3.0),
    ):
        assert not entrance(viewer, arrival(-1000.0))


@pytest.mark.parametrize(
    ("entry_m", "speed_m_s", "disregards"),
    [(31.0, 5.0, True), (31.5, 5.0, False), (5.0, 1.9, False), (5.0, 2.0, True)],
)
def test_who_moves_and_cannot_stop_before_the_area_disregards_them(
    entry_m: float, speed_m_s: float, disregards: bool
) -> None:
    """5 m/s for 5 s are 25 m, and at 2 m/s2 it takes 6.25 m more to stop."""
    (red,) = lights(waits(800.0, entry_m, speed_m_s), arrival(-1000.0))
    assert (red.viewer.number, red.because.number, red.runway) == (9, 1, "01")
    assert red.is_disregarded is disregards
    assert red.can_stop


@pytest.mark.parametrize(("short_m", "can_stop"), [(31.5, True), (31.0, False)])
def test_who_cannot_stop_before_the_pavement_is_left_to_their_judgement(
    short_m: float, can_stop: bool
) -> None:
    viewer = target(800.0, WIDTH_M / 2.0 + short_m, 5.0, turned_deg=-90.0, number=9)
    (red,) = lights(viewer, arrival(-1000.0))
    assert (red.is_disregarded, red.can_stop) == (True, can_stop)


# --- take-off hold lights ------------------------------------------------------------------


def hold(in_position: Target, other: Target) -> list[bool]:
    """Return whether each red hold light is disregarded."""
    found = [each for each in lights(in_position, other) if each.lights == "take-off hold"]
    assert all((each.viewer, each.because) == (in_position, other) for each in found)
    return [each.is_disregarded for each in found]


@pytest.mark.parametrize(("past_ft", "is_lit"), [(1874.0, True), (1876.0, False)])
def test_hold_lights_reach_375_and_1500_ft_past_the_threshold(past_ft: float, is_lit: bool) -> None:
    other = target(1500.0, number=2, turned_deg=90.0)
    assert hold(target(past_ft * FOOT), other) == ([False] if is_lit else [])
    assert hold(target(past_ft * FOOT, turned_deg=None), other) == ([False] if is_lit else [])


def test_whoever_rolls_against_them_disregards_them() -> None:
    assert hold(target(300.0, 0.0, 40.0), target(1500.0, number=2, turned_deg=90.0)) == [True]


@pytest.mark.parametrize(
    ("other", "is_lit"),
    [
        (target(49.0, number=2, turned_deg=90.0), False),  # Behind.
        (target(51.0, number=2, turned_deg=90.0), True),
        (target(900.0, number=2, turned_deg=None), True),
        (target(900.0, number=2, height_m=10.0), False),
        (target(900.0, 0.0, 1.9, number=2, turned_deg=90.0), True),
        (target(900.0, WIDTH_M / 2.0 - 30.2, 10.0, number=2, turned_deg=90.0), True),
        (target(900.0, WIDTH_M / 2.0 - 29.8, 10.0, number=2, turned_deg=90.0), False),
        (waits(900.0, 24.8, 10.0), True),
        (waits(900.0, 25.2, 10.0), False),
        (waits(900.0, 0.5, 1.9), False),
        (waits(900.0, 1.0, 10.0, turned_deg=None), False),
        (waits(900.0, -30.0, 10.0, turned_deg=90.0), False),
    ],
)
def test_they_are_red_while_somebody_is_ahead_for_more_than_3_s_or_cannot_but_enter(
    other: Target, is_lit: bool
) -> None:
    """At 10 m/s: 30 m of pavement are left behind in 3 s, and braking at 2 m/s2 takes 25 m."""
    assert hold(target(50.0), other) == ([False] if is_lit else [])


# --- intersection lights -------------------------------------------------------------------


def intersection(user: Target, other: Target) -> list[bool]:
    found = [
        each
        for each in lights(user, other)
        if each.lights == "intersection" and each.viewer is user
    ]
    assert all((each.because, each.runway) == (other, "01") for each in found)
    return [each.is_disregarded for each in found]


OWN_M, ITS_M = crossing_m(NORTH), crossing_m(SOUTHEAST)
LANDS = arrival(-500.0, axis=SOUTHEAST, number=2)


@pytest.mark.parametrize(
    ("user", "expected"),
    [
        (target(50.0), [False]),
        (target(300.0, 0.0, 40.0), [True]),
        (target(OWN_M - 1.0), [False]),
        (target(OWN_M + 1.0), []),
        (arrival(-500.0), []),
    ],
)
def test_who_takes_off_towards_an_intersection_sees_them_while_somebody_lands_across(
    user: Target, expected: list[bool]
) -> None:
    assert intersection(user, LANDS) == expected


def test_past_the_intersection_nobody_crosses_any_more() -> None:
    for along_m, expected in ((ITS_M - 1.0, [False]), (ITS_M + 1.0, [])):
        other = target(along_m, 0.0, 40.0, axis=SOUTHEAST, number=2, has_landed=True)
        assert intersection(target(50.0), other) == expected


@pytest.mark.parametrize(
    ("apart_s", "speed_m_s", "expected"),
    [(4.9, 40.0, [True]), (5.1, 40.0, []), (-4.9, 40.0, [True]), (-5.1, 40.0, []),
     (0.0, 33.9 * KNOT, [])],
)  # fmt: skip
def test_a_landing_sees_them_if_the_two_meet_within_5_s(
    apart_s: float, speed_m_s: float, expected: list[bool]
) -> None:
    user = target(OWN_M - 10.0 * speed_m_s, 0.0, speed_m_s, has_landed=True)
    other_m = ITS_M - (10.0 + apart_s) * 40.0
    other = target(other_m, 0.0, 40.0, axis=SOUTHEAST, number=2, has_landed=True)
    assert intersection(user, other) == expected


def test_all_are_where_they_are_now() -> None:
    """The tracks are of half a second ago, in which the one that takes off comes 20 m nearer."""
    logic = StatusLights(AERODROME, StatusLightConfig())
    viewer, rolls = waits(230.0), target(100.0, 0.0, 40.0)
    assert lights(viewer, rolls, logic=logic)
    assert not lights(viewer, rolls, logic=logic, t_ns=SECOND_NS // 2)
