"""Times and places on a runway, each against the laws of uniform motion."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airfield import BRIEFING, NORTH, SOUTH, Axis, degrees
from airhilt.assistant.decision.aerodrome import Vector, Way
from airhilt.assistant.decision.assessment import worst_threats
from airhilt.assistant.decision.findings import RunwayUse
from airhilt.assistant.decision.mobiles import Mobile, Use, is_on_pavement, lined_up_on, use_of
from airhilt.assistant.decision.situation import Obstacle, RunwaySituation
from airhilt.assistant.decision.threats import RunwayConfig, Threat
from airhilt.messages import Severity
from airhilt.units import DEGREE, KNOT, SECOND_NS
from instants import AERODROME, runway

ACCELERATION_M_S2 = BRAKING_M_S2 = 1.8
TOUCHDOWN_M = 400.0


def mobile(
    along_m: float = 0.0, across_m: float = 0.0, axis: Axis = NORTH, off_deg: float = 0.0,
    height_m: float | None = None, **given: Any,
) -> Mobile:  # fmt: skip
    place = AERODROME.locate(*degrees(axis.local(along_m, across_m)))
    usual = Mobile(
        "a1b2c3", "AAL123", 0, place, None, 0.0, (axis.course_deg + off_deg) * DEGREE, 0.0, 9,
        False, given.get("speed_m_s", 0.0),
    )  # fmt: skip
    altitude_m = None if height_m is None else AERODROME.ground_m + height_m
    return replace(usual, altitude_m=altitude_m, **given)


def use(kind: RunwayUse, along_m: float, speed_m_s: float, ident: str = "01", t_ns: int = 0) -> Use:
    height_m = 50.0 if kind == "arrival" else None
    who = mobile(along_m, height_m=height_m, speed_m_s=speed_m_s, t_ns=t_ns)
    return Use(who, *runway(ident), kind, along_m)


# --- where somebody is, and when ------------------------------------------------------------

speeds = st.floats(2.0, 90.0)
times = st.floats(0.0, 30.0)


@given(speeds, times)
def test_a_departure_is_where_even_acceleration_takes_it(speed: float, time_s: float) -> None:
    along_m = 100.0 + speed * time_s + 0.5 * ACCELERATION_M_S2 * time_s**2
    left_s = use("departure", 100.0, speed).time_to_s(along_m, 0)
    assert left_s == pytest.approx(time_s, abs=1e-6)


@given(speeds, st.floats(0.0, 1.0))
def test_a_landing_is_where_even_braking_takes_it(speed: float, share: float) -> None:
    time_s = share * speed / BRAKING_M_S2
    along_m = 900.0 + speed * time_s - 0.5 * BRAKING_M_S2 * time_s**2
    left_s = use("rollout", 900.0, speed).time_to_s(along_m, 0)
    assert left_s is None or left_s == pytest.approx(time_s, abs=1e-3)
    assert left_s is not None or share > 0.999


@given(speeds, st.floats(0.0, 0.99))
def test_an_arrival_flies_on_evenly_to_its_touchdown_and_brakes_then(
    speed: float, share: float
) -> None:
    arrival = use("arrival", -600.0, speed)
    down_s = (TOUCHDOWN_M + 600.0) / speed
    assert arrival.time_to_s(-600.0 + share * (TOUCHDOWN_M + 600.0), 0) == pytest.approx(
        share * down_s
    )
    braked_s = share * speed / BRAKING_M_S2
    along_m = TOUCHDOWN_M + speed * braked_s - 0.5 * BRAKING_M_S2 * braked_s**2
    assert arrival.time_to_s(along_m, 0) == pytest.approx(down_s + braked_s, abs=1e-3)


@pytest.mark.parametrize("kind", ["arrival", "departure", "rollout"])
def test_nobody_comes_to_what_is_behind(kind: RunwayUse) -> None:
    assert use(kind, 500.0, 60.0).time_to_s(499.0, 0) is None
    assert use(kind, 500.0, 60.0).time_to_s(500.0, 0) == 0.0


def test_who_brakes_does_not_come_beyond_where_it_stops() -> None:
    stops_m = 500.0 + 60.0**2 / (2.0 * BRAKING_M_S2)
    assert use("rollout", 500.0, 60.0).time_to_s(stops_m - 1.0, 0) is not None
    assert use("rollout", 500.0, 60.0).time_to_s(stops_m + 1.0, 0) is None


@pytest.mark.parametrize(
    ("t_s", "left_s"), [(0.0, 40.0), (1.0, 39.0), (39.5, 0.5), (40.0, 0.0), (50.0, 0.0)]
)
def test_the_age_of_a_report_is_taken_from_the_time_that_is_left(t_s: float, left_s: float) -> None:
    arrival = use("arrival", -2800.0, 70.0)
    assert arrival.time_to_threshold_s(round(t_s * SECOND_NS)) == pytest.approx(left_s)
    assert arrival.time_to_s(0.0, round(t_s * SECOND_NS)) == pytest.approx(left_s)


# --- who leaves the runway ------------------------------------------------------------------


def leaves_s(who: Mobile, exit_m: float, own: Use | None = None, ident: str = "01") -> float | None:
    return Obstacle(who, Way(0.0, exit_m)).leaving_s(own, use("arrival", -2000.0, 70.0, ident))


@pytest.mark.parametrize(("speed_m_s", "exit_m", "left_s"), [(8.0, 120.0, 15.0), (3.0, 6.0, 2.0)])
def test_who_drives_across_has_left_at_the_end_of_the_way(
    speed_m_s: float, exit_m: float, left_s: float
) -> None:
    assert leaves_s(mobile(800.0, speed_m_s=speed_m_s), exit_m) == pytest.approx(left_s)


@pytest.mark.parametrize(("speed_m_s", "stays"), [(0.0, True), (1.49, True), (1.5, False)])
def test_who_stands_does_not_leave(speed_m_s: float, stays: bool) -> None:
    assert (leaves_s(mobile(800.0, speed_m_s=speed_m_s), 50.0) is None) is stays


@pytest.mark.parametrize(("speed_m_s", "left_s"), [(62.0, 42.0), (26.0, 22.0), (8.0, 12.0)])
def test_a_landing_turns_off_12_s_after_it_has_braked_to_8_m_s(
    speed_m_s: float, left_s: float
) -> None:
    landed = mobile(800.0, speed_m_s=speed_m_s, landed=True)
    assert leaves_s(landed, 5000.0) == pytest.approx(left_s)
    assert leaves_s(landed, speed_m_s * 5.0) == pytest.approx(5.0)  # The end comes before.


@pytest.mark.parametrize(("speed_m_s", "left_s"), [(0.0, 75.0 / 1.8), (39.0, 20.0), (80.0, 0.0)])
def test_a_departure_ahead_is_out_of_the_way_once_it_has_75_m_s(
    speed_m_s: float, left_s: float
) -> None:
    own = use("departure", 50.0, speed_m_s)
    assert leaves_s(own.mobile, 2000.0, own) == pytest.approx(left_s)


def test_a_departure_towards_somebody_stays_in_the_way() -> None:
    own = use("departure", 50.0, 40.0, "19")
    assert leaves_s(own.mobile, 2000.0, own) is None


def test_a_departure_on_the_other_runway_is_as_one_that_drives_across() -> None:
    own = use("departure", 50.0, 40.0, "15")
    assert leaves_s(own.mobile, 200.0, own) == pytest.approx(5.0)


# --- who rolls, and who is on the runway ----------------------------------------------------


@pytest.mark.parametrize(
    ("speed_m_s", "mean_m_s", "landed", "rolls"),
    [
        (25.0 * KNOT, 25.0 * KNOT, False, True),  # Faster than anybody taxies.
        (25.0 * KNOT - 0.01, 25.0 * KNOT, False, False),
        (25.0 * KNOT, 40.0, True, True),
        (8.0, 5.0, False, True),  # 3 m/s more than in the last seconds.
        (8.0, 5.01, False, False),
        (8.0, 5.0, True, False),  # Who has landed does not take off.
        (5.0, 2.0, False, True),
        (4.99, 0.0, False, False),  # Setting out at walking pace.
    ],
)
def test_who_is_faster_or_accelerates_more_than_in_taxiing_takes_off(
    speed_m_s: float, mean_m_s: float, landed: bool, rolls: bool
) -> None:
    who = mobile(speed_m_s=speed_m_s, slow_speed_m_s=mean_m_s, landed=landed)
    assert who.is_rolling is rolls


@pytest.mark.parametrize(
    ("speed_m_s", "mean_m_s", "way_m"),
    [(6.0, 6.0, 12.0), (6.0, 4.0, 12.0), (6.0, 6.49, 12.0), (6.0, 6.5, 0.0)],
)
def test_who_slows_down_may_be_about_to_stop_and_has_travelled_no_further(
    speed_m_s: float, mean_m_s: float, way_m: float
) -> None:
    who = mobile(speed_m_s=speed_m_s, slow_speed_m_s=mean_m_s, t_ns=SECOND_NS)
    assert who.travelled_m(3 * SECOND_NS) == pytest.approx(way_m)
    assert who.travelled_m(0) == 0.0


@pytest.mark.parametrize(
    ("along_m", "across_m", "displaced_m", "is_on"),
    [
        (1000.0, 47.5, 0.0, True),  # Half of 45 m, and 25 m for the error.
        (1000.0, 47.6, 0.0, False),
        (-500.0, 0.0, 0.0, True),  # There may be pavement before the threshold and past the end.
        (-501.0, 0.0, 0.0, False),
        (-799.0, 0.0, 300.0, True),
        (-801.0, 0.0, 300.0, False),
        (2600.0, 0.0, 0.0, True),
        (2601.0, 0.0, 0.0, False),
    ],
)
def test_a_runway_reaches_to_the_sides_and_beyond_its_ends(
    along_m: float, across_m: float, displaced_m: float, is_on: bool
) -> None:
    direction = replace(
        runway("01")[1], length_m=2100.0, half_width_m=22.5, displaced_m=displaced_m
    )
    assert is_on_pavement(direction, along_m, across_m) is is_on


@pytest.mark.parametrize(
    ("off_deg", "ident"),
    [(0.0, "01"), (14.9, "01"), (-14.9, "01"), (15.1, None), (90.0, None), (165.5, "19")],
)
def test_who_stands_along_the_centre_line_is_lined_up(off_deg: float, ident: str | None) -> None:
    found = lined_up_on(mobile(300.0, 5.0, off_deg=off_deg), runway("01")[0])
    assert (found and found.ident) == ident


@pytest.mark.parametrize(
    "how", [{"is_vehicle": True}, {"landed": True}, {"height_m": 20.0}, {"across_m": 80.0}]
)
def test_who_does_not_wait_to_take_off_is_not_lined_up(how: dict[str, Any]) -> None:
    assert lined_up_on(mobile(300.0, **how), runway("01")[0]) is None


@pytest.mark.parametrize(
    ("axis", "how", "expected"),
    [
        (NORTH, {"speed_m_s": 40.0}, ("01", "departure")),
        (SOUTH, {"speed_m_s": 40.0}, ("19", "departure")),
        (NORTH, {"speed_m_s": 40.0, "landed": True}, ("01", "rollout")),
        (NORTH, {"speed_m_s": 40.0, "is_vehicle": True}, None),
        (NORTH, {"speed_m_s": 10.0}, None),
    ],
)  # fmt: skip
def test_a_runway_is_used_on_the_ground_by_aircraft_that_roll(
    axis: Axis, how: dict[str, Any], expected: tuple[str, str] | None
) -> None:
    found = use_of(mobile(300.0, axis=axis, **how), AERODROME.strips)
    assert (found and (found.direction.ident, found.kind)) == expected


def test_courses_and_sides_are_those_of_a_map() -> None:
    """East of a runway to the north is its right side, and the left one of the way back."""
    for ident, sign in (("01", 1.0), ("19", -1.0)):
        direction = runway(ident)[1]
        middle = direction.point(direction.length_m / 2.0)
        assert direction.across_m(Vector(middle.east + 10.0, middle.north)) == pytest.approx(
            sign * 10.0 * math.cos(4.0 * DEGREE), abs=0.01
        )
        assert direction.along_m(middle) == pytest.approx(1050.0, abs=0.5)
        assert math.cos(direction.course_rad - (4.0 if sign > 0 else 184.0) * DEGREE) > 0.99999


# --- two that meet --------------------------------------------------------------------------


def meeting(first: Use, second: Use) -> list[Threat]:
    """Return what is told of two uses, at the time of their reports."""
    assert BRIEFING.airport is not None
    situation = RunwaySituation(BRIEFING.airport, BRIEFING)
    situation.uses = {"a": first, "b": second}
    return list(worst_threats(RunwayConfig(rules=("meeting",)), situation, 0).values())


def opposite(kind: RunwayUse, gap_m: float, speed_m_s: float) -> Use:
    """Return a use of the other end, so far from 500 m past the threshold of runway 01."""
    who = mobile(500.0 + gap_m, axis=NORTH, off_deg=180.0, speed_m_s=speed_m_s)
    strip, direction = runway("19")
    return Use(who, strip, direction, kind, direction.along_m(who.point))


@pytest.mark.parametrize(
    ("gap_m", "own_m_s", "other_m_s", "time_s"),
    [(900.0, 40.0, 20.0, 15.0), (900.0, 5.0, 2.0, 900.0 / (25 * KNOT))],
)
def test_two_that_roll_towards_each_other_are_a_warning_at_once(
    gap_m: float, own_m_s: float, other_m_s: float, time_s: float
) -> None:
    """The time is that of their speeds together, 25 kt at least."""
    (threat,) = meeting(use("departure", 500.0, own_m_s), opposite("departure", gap_m, other_m_s))
    assert threat.severity is Severity.WARNING
    assert threat.finding.statement() == "AAL123 opposite on runway 01/19"
    assert threat.time_to_go_s == pytest.approx(time_s, rel=1e-3)


def test_two_that_have_passed_each_other_or_go_the_same_way_do_not_meet() -> None:
    own = use("departure", 500.0, 40.0)
    assert meeting(own, opposite("departure", -20.0, 40.0)) == []
    assert meeting(own, use("departure", 900.0, 40.0)) == []
    assert meeting(use("rollout", 500.0, 40.0), opposite("arrival", 900.0, 70.0)) == []


@pytest.mark.parametrize(
    ("time_s", "severity"),
    [(34.0, Severity.WARNING), (36.0, Severity.CAUTION), (59.0, Severity.CAUTION), (61.0, None)],
)
def test_two_arrivals_from_both_ends_are_as_grave_as_the_sooner_one(
    time_s: float, severity: Severity | None
) -> None:
    later = opposite("arrival", 500.0, 70.0)
    later = later._replace(along_m=-70.0 * (time_s + 10.0))
    found = meeting(use("arrival", -70.0 * time_s, 70.0), later)
    assert [threat.severity for threat in found] == ([severity] if severity else [])


def test_crossings_are_where_the_centre_lines_meet() -> None:
    point = AERODROME.crossing(runway("01")[0], runway("15")[0])
    assert point is not None
    assert AERODROME.crossing(runway("15")[0], runway("01")[0]) == point
    for ident in ("01", "15", "19", "33"):
        assert runway(ident)[1].across_m(point) == pytest.approx(0.0, abs=0.01)
    assert AERODROME.crossing(runway("01")[0], runway("01")[0]) is None
