"""The final approach course and the glide path, and the way back to both."""

from __future__ import annotations

from dataclasses import replace

import pytest

from airhilt.units import DEGREE
from airhilt.world.flight import load_aircraft_type
from airhilt.world.flight.procedures.final import Final
from flights import COURSE, along_runway, make_runway
from stand_ins import state_at

B737 = load_aircraft_type("737")
FINAL = Final(make_runway("01"), B737)


@pytest.mark.parametrize("raised_m", [-50.0, 700.0, 1_655.0])
def test_the_glide_path_is_as_much_higher_as_the_runway(raised_m: float) -> None:
    runway = make_runway("01")
    high = Final(replace(runway, elevation_m=runway.elevation_m + raised_m), B737)
    place = along_runway(-5_000.0)
    below_m = FINAL.above_glide_path_m(state_at(place, altitude_m=200.0))
    raised = state_at(place, altitude_m=200.0 + raised_m)
    assert high.above_glide_path_m(raised) == pytest.approx(below_m, abs=0.1)


def test_over_the_aim_the_wheels_on_the_glide_path_are_on_the_runway() -> None:
    landing, size = B737.landing, B737.dimensions
    on_runway_m = make_runway("01").elevation_m + size.wheel_height_offset_m
    state = state_at(along_runway(landing.aim_m), altitude_m=on_runway_m)
    assert FINAL.above_glide_path_m(state) == pytest.approx(0.0, abs=0.05)


def turn_rate(right_m: float) -> float:
    place = along_runway(-5_000.0, right_m)
    return FINAL.turn_rate(state_at(place, track_rad=COURSE * DEGREE))


@pytest.mark.parametrize("right_m", [0.5, 3.0, 20.0])
def test_it_turns_back_to_the_centre_line_the_more_the_farther_it_is(right_m: float) -> None:
    from_right, from_left, middle = turn_rate(right_m), turn_rate(-right_m), turn_rate(0.0)
    assert from_right < middle < from_left
    assert from_left - middle == pytest.approx(middle - from_right, rel=0.01)
    assert turn_rate(-2.0 * right_m) - middle == pytest.approx(2.0 * (from_left - middle), rel=0.01)
