"""Routes by themselves: when the next leg begins, and when the last one has ended."""

from __future__ import annotations

import math

import pytest
from geographiclib.geodesic import Geodesic

from airhilt.geodesy.wgs84 import Place
from airhilt.units import DEGREE, STANDARD_GRAVITY
from airhilt.world.flight.guidance import ARC_BANK_PART, ROLL_LEAD_S, Route
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
    assert flown.finished == is_finished


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
