"""The airframe in SI: pressures, the height of its wheels, and what it retracts."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from airhilt.units import DEGREE
from airhilt.world.flight import standard_atmosphere
from airhilt.world.flight.airframe import Airframe
from airhilt.world.surface.runway import RunwayEnd


def test_the_dynamic_pressure_is_that_of_its_mach_number(in_cruise: Callable[..., Any]) -> None:
    aircraft = in_cruise("737")
    pressure_pa = standard_atmosphere.pressure(aircraft.state.altitude_m)
    expected_pa = 0.7 * pressure_pa * aircraft.state.mach**2
    assert aircraft._airframe.dynamic_pressure_pa() == pytest.approx(expected_pa, rel=5e-3)


@pytest.mark.parametrize("name", ["c172p", "737"])
def test_the_main_wheels_are_on_the_ground_while_the_nose_is_lifted(
    name: str, on_the_ground: Callable[..., Any], runway: RunwayEnd, states: Callable[..., Any]
) -> None:
    aircraft = on_the_ground(name)
    aircraft.procedures.take_off(runway, 300.0)
    lifted = []
    for state in states(aircraft, 60):
        if aircraft.phase == "rotate" and not aircraft.on_ground:
            break
        if state.pitch_rad > 3.0 * DEGREE:
            lifted.append(aircraft.main_wheel_height_m)
    assert lifted
    assert -0.7 < min(lifted) <= max(lifted) < 0.1


def test_cleaned_up_it_has_gear_flaps_and_speed_brakes_in(on_final: Callable[..., Any]) -> None:
    aircraft = on_final("737", distance_nm=8.0)
    airframe: Airframe = aircraft._airframe
    airframe.set_speed_brakes(1.0)
    aircraft.advance()
    assert (aircraft.gear, aircraft.flaps) != (0.0, 0.0)
    airframe.clean_up()
    for _ in range(20 * 120):
        airframe.step()
    assert (aircraft.gear, aircraft.flaps) == (0.0, 0.0)
    assert airframe._fdm["fcs/speedbrake-pos-norm"] == 0.0
