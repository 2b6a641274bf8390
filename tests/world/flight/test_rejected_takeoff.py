"""A takeoff that is rejected ends standing on the runway."""

from __future__ import annotations

import math

import pytest

from airhilt.units import DEGREE, FOOT, KNOT
from airhilt.world.flight import Atmosphere
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.flight.procedures.final import Final
from airhilt.world.flight.state import AircraftState
from flights import RUNWAY, on_the_ground, states

COURSE = 10.0
REJECTED_AT_KT = {"737": 100, "B747": 100, "c172p": 40, "c310": 70}
CROSSWIND = Atmosphere(
    -15 * KNOT * math.sin(COURSE * DEGREE), 15 * KNOT * math.cos(COURSE * DEGREE)
)


def roll_to(aircraft: Aircraft, airspeed_kt: float) -> AircraftState:
    for state in states(aircraft, 60):
        if state.calibrated_airspeed_m_s >= airspeed_kt * KNOT:
            return state
    raise AssertionError(aircraft.phase)


@pytest.mark.parametrize("air", [Atmosphere(), CROSSWIND], ids=["calm", "crosswind"])
def test_it_stops_within_3000_ft_on_the_centre_line(air: Atmosphere, name: str) -> None:
    aircraft = on_the_ground(name, right_m=1.0, atmosphere=air)
    line = Final(RUNWAY, aircraft.kind)
    aircraft.procedures.take_off(RUNWAY, 500.0)
    rejected_m = line.along_m(roll_to(aircraft, REJECTED_AT_KT[name]))
    aircraft.procedures.reject_takeoff()
    assert aircraft.phase == "rejected_takeoff"
    for state in states(aircraft, 60):
        assert abs(line.cross_track_m(state)) < 20 * FOOT
    assert aircraft.phase == "standing"
    assert aircraft.ended is None
    assert line.along_m(aircraft.state) - rejected_m < 3_000 * FOOT


def test_it_can_take_off_after_all() -> None:
    aircraft = on_the_ground("c172p")
    aircraft.procedures.take_off(RUNWAY, 100.0)
    roll_to(aircraft, 30)
    aircraft.procedures.reject_takeoff()
    for _ in states(aircraft, 30):
        pass
    aircraft.procedures.take_off(RUNWAY, 100.0)
    for _ in states(aircraft, 90):
        pass
    assert aircraft.phase == "en_route"


def test_only_a_takeoff_roll_is_rejected() -> None:
    aircraft = on_the_ground("c172p")
    with pytest.raises(ValueError, match="reject_takeoff in phase lined_up; expected takeoff_roll"):
        aircraft.procedures.reject_takeoff()
    aircraft.procedures.take_off(RUNWAY, 500.0)
    roll_to(aircraft, aircraft.kind.speeds.rotate_kt + 2)
    with pytest.raises(ValueError, match="expected takeoff_roll"):
        aircraft.procedures.reject_takeoff()
