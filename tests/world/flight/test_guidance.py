"""Routes by themselves: when the next leg begins, and when the last one has ended."""

from __future__ import annotations

import math

import pytest
from geographiclib.geodesic import Geodesic

from airhilt.geodesy.wgs84 import Place
from airhilt.units import DEGREE, STANDARD_GRAVITY
from airhilt.world.flight.guidance import (
    ARC_BANK_PART,
    ROLL_LEAD_S,
    Airspeed,
    Altitude,
    AltitudeClearance,
    Route,
    Track,
)
from airhilt.world.flight.route import legs_through
from stand_ins import state_at

SPEED_M_S = 120.0
BANK = 25.0 * DEGREE


def place(start: Place, course_deg: float, distance_m: float) -> Place:
    start_deg = (start[0] / DEGREE, start[1] / DEGREE)
    there = Geodesic.WGS84.Direct(*start_deg, course_deg, distance_m)
    return there["lat2"] * DEGREE, there["lon2"] * DEGREE


START = (47.0 * DEGREE, 8.0 * DEGREE)
CORNER = place(START, 0.0, 30_000.0)


def route(*waypoints: Place) -> Route:
    return Route(legs_through(START, waypoints), 0.12, BANK)


@pytest.mark.parametrize(("beyond_m", "is_finished"), [(-0.3, False), (0.3, True)])
def test_a_route_is_finished_once_its_last_waypoint_is_passed(
    beyond_m: float, is_finished: bool
) -> None:
    flown = route(CORNER)
    flown.turn_rate(state_at(place(CORNER, 0.0, beyond_m), altitude_m=0.0, speed_m_s=SPEED_M_S))
    assert (flown._end is not None) == is_finished


@pytest.mark.parametrize("turn_deg", [30.0, 90.0, -120.0])
@pytest.mark.parametrize(("later_m", "turns"), [(-20.0, False), (20.0, True)])
def test_a_corner_is_cut_by_the_circle_of_four_fifths_of_the_bank(
    turn_deg: float, later_m: float, turns: bool
) -> None:
    """The roll into it takes 2.5 s more."""
    radius_m = SPEED_M_S**2 / (STANDARD_GRAVITY * math.tan(ARC_BANK_PART * BANK))
    lead_m = radius_m * math.tan(abs(turn_deg) * DEGREE / 2.0)
    flown = route(CORNER, place(CORNER, turn_deg, 30_000.0))
    first = flown.leg
    before_m = lead_m + ROLL_LEAD_S * SPEED_M_S - later_m
    flown.turn_rate(state_at(place(CORNER, 180.0, before_m), altitude_m=0.0, speed_m_s=SPEED_M_S))
    assert (flown.leg is not first) == turns


def test_corners_from_1_to_150_degrees_are_cut(subtests: pytest.Subtests) -> None:
    for turn_deg, is_cut in [
        (0.9, False),
        (1.2, True),
        (149.5, True),
        (-149.5, True),
        (150.5, False),
        (-151.0, False),
    ]:
        with subtests.test(str((turn_deg, is_cut))):
            flown = route(CORNER, place(CORNER, turn_deg, 30_000.0))
            first = flown.leg
            flown.turn_rate(
                state_at(place(CORNER, 180.0, 1.0), altitude_m=0.0, speed_m_s=SPEED_M_S)
            )
            assert (flown.leg is not first) == is_cut
            flown.turn_rate(state_at(place(CORNER, 0.0, 1.0), altitude_m=0.0, speed_m_s=SPEED_M_S))
            assert flown.leg is not first


@pytest.mark.parametrize("turn_deg", [40.0, -90.0, 135.0])
def test_who_flies_what_is_asked_cuts_the_corner_on_a_circle_and_comes_out_on_the_next_leg(
    turn_deg: float,
) -> None:
    """A point that turns at once as it is told: it need not lead the roll."""
    flown = route(CORNER, place(CORNER, turn_deg, 30_000.0))
    here, track, flights = place(CORNER, 180.0, 12_000.0), 0.0, []
    for _ in range(1000):
        state = state_at(here, altitude_m=0.0, speed_m_s=SPEED_M_S, track_rad=track)
        rate = flown.turn_rate(state)
        flights.append((abs(track), math.copysign(1.0, turn_deg) * rate))
        track += rate * 0.2
        here = place(here, track / DEGREE, SPEED_M_S * 0.2)
    greatest = STANDARD_GRAVITY * math.tan(ARC_BANK_PART * BANK) / SPEED_M_S
    inside = [rate for at, rate in flights if 0.4 < at / abs(turn_deg * DEGREE) < 0.6]
    assert inside == pytest.approx([greatest] * len(inside), rel=0.1)
    assert max(rate for _, rate in flights) < 1.25 * greatest
    assert min(rate for _, rate in flights) > -0.25 * greatest
    assert track / DEGREE == pytest.approx(turn_deg, abs=0.5)
    half = len([None for at, _ in flights if at < abs(turn_deg * DEGREE) / 2.0])
    rolls_out = next(at for at, rate in flights[half:] if rate < 0.5 * greatest)
    assert (abs(turn_deg * DEGREE) - rolls_out) / greatest == pytest.approx(ROLL_LEAD_S, abs=0.5)


def test_the_rate_to_an_altitude_is_a_fifth_of_what_is_left_a_second_and_the_cleared_one_at_most(
    subtests: pytest.Subtests,
) -> None:
    table = [(900.0, 5.0, 5.0), (1100.0, 5.0, -5.0), (990.0, 5.0, 2.0), (1010.0, 5.0, -2.0),
     (1000.0, 5.0, 0.0), (975.0, 5.0, 5.0)]  # fmt: skip
    for altitude_m, rate_m_s, expected in table:
        with subtests.test(str((altitude_m, rate_m_s, expected))):
            mode = Altitude(AltitudeClearance(1000.0, rate_m_s), 0.2)
            assert mode.vertical_rate(state_at(altitude_m=altitude_m)) == pytest.approx(expected)


def test_it_levels_off_once_its_rate_is_more_than_what_is_left_asks_for(
    subtests: pytest.Subtests,
) -> None:
    table = [(990.0, 1.9, False), (990.0, 2.1, True), (1010.0, -1.9, False), (1010.0, -2.1, True),
     (990.0, -1.0, False), (1010.0, 1.0, False), (1000.0, 0.0, True)]  # fmt: skip
    for altitude_m, rate_m_s, captures in table:
        with subtests.test(str((altitude_m, rate_m_s, captures))):
            mode = Altitude(AltitudeClearance(1000.0, 5.0), 0.2)
            assert mode.captures(state_at(altitude_m=altitude_m, rate_m_s=rate_m_s)) is captures


@pytest.mark.parametrize(("at_mach", "expected"), [(0.7, 130.0), (0.8, 120.0), (0.9, 106.667)])
def test_an_airspeed_is_held_up_to_the_greatest_mach_number(
    at_mach: float, expected: float
) -> None:
    mode = Airspeed(130.0, 0.8)
    state = state_at(speed_m_s=120.0, mach=at_mach)
    assert mode.airspeed(state) == pytest.approx(expected, abs=0.001)


def test_a_turn_is_by_the_shorter_side_unless_the_other_one_was_asked_for(
    subtests: pytest.Subtests,
) -> None:
    table = [(90.0, None, 1.0), (-90.0, None, -1.0), (170.0, None, 1.0), (190.0, None, -1.0),
     (90.0, -270.0, -1.0), (-90.0, 270.0, 1.0), (10.0, 370.0, 1.0)]  # fmt: skip
    for track_deg, turn_deg, sign in table:
        with subtests.test(str((track_deg, turn_deg, sign))):
            mode = Track(track_deg * DEGREE, 0.1, None if turn_deg is None else turn_deg * DEGREE)
            expected = (
                0.1 * (math.remainder(track_deg, 360.0) if turn_deg is None else turn_deg) * DEGREE
            )
            assert mode.turn_rate(state_at(track_rad=0.0)) == pytest.approx(expected, rel=1e-6)
            assert math.copysign(1.0, expected) == sign


def test_a_constant_track_is_no_geodesic_away_from_the_equator() -> None:
    """Eastward at 60 degrees north the meridians turn by the tangent of that over the radius."""
    north = state_at((60.0 * DEGREE, 0.0), track_rad=math.pi / 2.0, speed_m_s=100.0)
    south = state_at((-60.0 * DEGREE, 0.0), track_rad=math.pi / 2.0, speed_m_s=100.0)
    east = Track(math.pi / 2.0, 0.1)
    expected = -100.0 * math.tan(60.0 * DEGREE) / 6.371e6
    assert east.turn_rate(north) == pytest.approx(expected, rel=1e-3)
    assert east.turn_rate(south) == pytest.approx(-expected, rel=1e-3)
