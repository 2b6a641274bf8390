"""A side-step by itself: from where the final approach of another runway can still be joined."""

from __future__ import annotations

import math

import pytest

from airhilt.units import DEGREE, FOOT
from airhilt.world.flight import load_aircraft_type
from airhilt.world.flight.procedures.final import Final, require_side_step
from airhilt.world.flight.state import AircraftState
from flights import COURSE, RUNWAY_ELEVATION_M, along_runway, make_runway
from stand_ins import state_at

FINAL = Final(make_runway("01"), load_aircraft_type("737"))


def at(before_m: float, right_m: float, height_m: float) -> AircraftState:
    place = along_runway(-before_m, right_m)
    return state_at(place, altitude_m=RUNWAY_ELEVATION_M + height_m, track_rad=COURSE * DEGREE)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("before_m", [1_800.0, 2_500.0])
def test_it_is_joined_by_20_degrees_before_200_ft_on_a_glide_path_of_3_degrees(
    side: float, before_m: float
) -> None:
    joined_m = 200.0 * 0.3048 / math.tan(3.0 * DEGREE)
    about_m = (before_m - joined_m) * math.tan(20.0 * DEGREE)
    refused = 0
    for step in range(-10, 11):
        state = at(before_m, side * (about_m + 0.02 * step), 150.0)
        left_m = -FINAL.along_m(state) - joined_m
        if abs(FINAL.cross_track_m(state)) <= left_m * math.tan(20.0 * DEGREE):
            require_side_step(state, FINAL)
            continue
        refused += 1
        with pytest.raises(ValueError, match="expected at most 20 degrees to the side"):
            require_side_step(state, FINAL)
    assert 5 < refused < 15


def test_it_begins_300_ft_above_the_runway_at_least() -> None:
    require_side_step(at(2_500.0, 100.0, 300.5 * FOOT), FINAL)
    with pytest.raises(ValueError, match="at 300 ft above it; expected at least 300 ft"):
        require_side_step(at(2_500.0, 100.0, 299.5 * FOOT), FINAL)


def test_what_cannot_be_flown_to_is_no_side_step_either() -> None:
    with pytest.raises(ValueError, match="threshold of runway 01 is 500 m behind"):
        require_side_step(at(-500.0, 0.0, 150.0), FINAL)
