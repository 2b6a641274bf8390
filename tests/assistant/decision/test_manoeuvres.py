"""Paths of aircraft that turn, climb and descend after they were told to."""

from __future__ import annotations

import math

import numpy as np
import pytest

from airhilt.assistant.decision.manoeuvres import (
    NONE,
    RESPONSE_S,
    SOON_STEPS,
    TIMES_S,
    Manoeuvre,
    Paths,
    paths,
    separations,
    straight_paths,
)
from airhilt.geodesy.relative_motion import Minima, Relative, VerticalProfile
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE

SPEED_M_S = 240.0
NORTHBOUND = Relative(0.0, 0.0, SPEED_M_S, 0.0)
LEVEL = VerticalProfile(10_000.0, 0.0)


def test_a_turn_takes_the_time_of_its_bank_and_begins_after_the_response() -> None:
    rate_rad_s = 9.80665 * math.tan(math.radians(25.0)) / SPEED_M_S
    flown = paths(NORTHBOUND, LEVEL, [Manoeuvre(turn_rad=90 * DEGREE)])
    before = TIMES_S <= RESPONSE_S
    assert flown.east_m[0, before] == pytest.approx(0.0)
    assert flown.north_m[0, before] == pytest.approx(SPEED_M_S * TIMES_S[before])
    is_over = RESPONSE_S + 0.5 * math.pi / rate_rad_s < TIMES_S
    radius_m = SPEED_M_S / rate_rad_s
    assert flown.north_m[0, is_over] == pytest.approx(SPEED_M_S * RESPONSE_S + radius_m)
    assert np.diff(flown.east_m[0, is_over]) == pytest.approx(SPEED_M_S * TIMES_S[1])


def test_who_is_told_to_descend_flies_on_for_the_response_and_levels_off() -> None:
    down = Manoeuvre(9_000.0, 1500 * FOOT_PER_MINUTE)
    climbing = VerticalProfile(10_000.0, 1000 * FOOT_PER_MINUTE, 10_000.0 + 2000 * FOOT)
    told, left = paths(NORTHBOUND, climbing, [down, NONE]).altitude_m
    before = TIMES_S <= RESPONSE_S
    assert told[before] == pytest.approx(left[before])
    assert told[-1] == pytest.approx(9_000.0)
    assert left[-1] == pytest.approx(10_000.0 + 2000 * FOOT)


def test_who_is_told_nothing_flies_straight_on_and_levels_off() -> None:
    climbing = VerticalProfile(3000.0, 10.0, 3500.0)
    descending = VerticalProfile(5000.0, -8.0)
    there, here = Relative(1000.0, -2000.0, 60.0, -80.0), Relative(0.0, 0.0, 0.0, 50.0)
    flown = straight_paths([there, here], [climbing, descending])
    for at, time_s in enumerate(TIMES_S[:SOON_STEPS]):
        assert [flown.north_m[0, at], flown.east_m[0, at], flown.altitude_m[0, at]] == (
            pytest.approx([1000.0 + 60 * time_s, -2000.0 - 80 * time_s, climbing.at(time_s)])
        )
        assert [flown.north_m[1, at], flown.east_m[1, at], flown.altitude_m[1, at]] == (
            pytest.approx([0.0, 50.0 * time_s, 5000.0 - 8.0 * time_s])
        )
    assert TIMES_S[SOON_STEPS - 1] == pytest.approx(178.0)


@pytest.mark.parametrize(
    ("north_m", "east_m", "up_m", "least"),
    [
        (6000.0, 8000.0, 0.0, 2.0),
        (-3000.0, 0.0, 0.0, 0.6),
        (0.0, 0.0, 300.0, 1.0),
        (0.0, 0.0, -150.0, 0.5),
        (3000.0, 4000.0, 240.0, 1.0),  # The greater one of the two counts.
        (3000.0, 4000.0, -360.0, 1.2),
    ],
)
def test_separation_is_that_of_the_minimum_that_is_kept_better(
    north_m: float, east_m: float, up_m: float, least: float
) -> None:
    here = Paths(*(np.full((1, 3), value) for value in (500.0, -700.0, 900.0)))
    farther = np.array([[40_000.0, 0.0, 40_000.0]])
    there = Paths(500.0 + north_m + farther, -700.0 + east_m + farther, np.full((1, 3), 900 + up_m))
    minima = Minima(5000.0, 300.0)
    assert separations(here, there, minima) == pytest.approx([least])
    assert separations(there, here, minima) == pytest.approx([least])
