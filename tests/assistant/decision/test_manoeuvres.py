"""Paths of aircraft that turn, climb and descend after they were told to."""

from __future__ import annotations

import math

import numpy as np
import pytest

from airhilt.assistant.decision.manoeuvres import (
    NONE,
    RESPONSE_S,
    TIMES_S,
    Manoeuvre,
    paths,
    turn_rate_rad_s,
)
from airhilt.geodesy.relative_motion import Relative, VerticalProfile
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


def test_left_is_the_mirror_of_right() -> None:
    flown = paths(
        NORTHBOUND, LEVEL, [Manoeuvre(turn_rad=60 * DEGREE), Manoeuvre(turn_rad=-60 * DEGREE)]
    )
    assert flown.north_m[0] == pytest.approx(flown.north_m[1])
    assert flown.east_m[0] == pytest.approx(-flown.east_m[1])
    assert flown.east_m[0, -1] > 0.0


def test_a_slow_aircraft_turns_at_rate_one() -> None:
    assert turn_rate_rad_s(50.0) == pytest.approx(3.0 * DEGREE)
    assert turn_rate_rad_s(SPEED_M_S) < 1.2 * DEGREE


def test_who_is_told_to_descend_flies_on_for_the_response_and_levels_off() -> None:
    down = Manoeuvre(9_000.0, 1500 * FOOT_PER_MINUTE)
    climbing = VerticalProfile(10_000.0, 1000 * FOOT_PER_MINUTE, 10_000.0 + 2000 * FOOT)
    told, left = paths(NORTHBOUND, climbing, [down, NONE]).altitude_m
    before = TIMES_S <= RESPONSE_S
    assert told[before] == pytest.approx(left[before])
    assert told[-1] == pytest.approx(9_000.0)
    assert left[-1] == pytest.approx(10_000.0 + 2000 * FOOT)
