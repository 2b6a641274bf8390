"""An aircraft takes off along the runway and climbs out, whatever the air does."""

from __future__ import annotations

import math
from typing import Any

import pytest

from airhilt.units import DEGREE, FOOT, KNOT
from airhilt.world.flight import Atmosphere
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.flight.procedures.final import Final
from airhilt.world.surface.runway import RunwayEnd
from flights import RUNWAY, along_runway, on_the_ground, states

COURSE = 10.0
CLIMB_TO_M = 300.0
TURBULENCE = Atmosphere(turbulence_wind_at_20ft_m_s=15 * KNOT, turbulence_severity=3)


def crosswind(from_left_kt: Any) -> Any:
    return Atmosphere(
        -from_left_kt * KNOT * math.sin(COURSE * DEGREE),
        from_left_kt * KNOT * math.cos(COURSE * DEGREE),
    )


class Takeoff:
    """What a takeoff was like."""

    def __init__(self, aircraft: Aircraft, runway: RunwayEnd) -> None:
        line = Final(runway, aircraft.kind)
        self.phases = [aircraft.phase]
        self.off_centre_m = self.pitch_on_ground_rad = self.lost_m = 0.0
        highest = 0.0
        for state in states(aircraft, 200):
            if aircraft.phase != self.phases[-1]:
                self.phases.append(aircraft.phase)
            if aircraft.on_ground:
                self.off_centre_m = max(self.off_centre_m, abs(line.cross_track_m(state)))
                self.pitch_on_ground_rad = max(self.pitch_on_ground_rad, state.pitch_rad)
            highest = max(highest, state.height_agl_m)
            self.lost_m = max(self.lost_m, highest - state.height_agl_m)
            if aircraft.phase == "en_route" or aircraft.ended:
                break


@pytest.mark.parametrize(
    "air", [crosswind(15), crosswind(-15), TURBULENCE], ids=["left", "right", "turbulence"]
)
def test_it_keeps_to_the_centre_line_and_strikes_nothing(air: Atmosphere, name: str) -> None:
    aircraft = on_the_ground(name, right_m=1.0, atmosphere=air)
    aircraft.procedures.take_off(RUNWAY, CLIMB_TO_M)
    takeoff = Takeoff(aircraft, RUNWAY)
    assert takeoff.phases == ["takeoff_roll", "rotate", "climb_out", "en_route"]
    assert takeoff.off_centre_m < 20 * FOOT
    assert takeoff.pitch_on_ground_rad < aircraft.kind.ground.tail_contact_deg * DEGREE
    assert takeoff.lost_m < 3.0


def test_it_levels_off_clean_on_the_runway_track(name: str) -> None:
    aircraft = on_the_ground(name)
    aircraft.procedures.take_off(RUNWAY, CLIMB_TO_M)
    speeds = aircraft.kind.speeds
    *_, state = states(aircraft, 240)
    assert aircraft.phase == "en_route"
    assert abs(state.altitude_m - CLIMB_TO_M) < 10.0
    assert abs(state.track_rad - COURSE * DEGREE) < 1.0 * DEGREE
    assert state.calibrated_airspeed_m_s > (speeds.minimum_clean_kt - 5) * KNOT
    assert aircraft._airframe._fdm["fcs/flap-cmd-norm"] == 0.0
    assert aircraft._airframe._fdm["gear/gear-cmd-norm"] == 0.0


def test_it_takes_off_after_lining_up() -> None:
    aircraft = on_the_ground("737", along_m=30.0, right_m=80.0, heading_deg=COURSE - 90.0)
    bend = [
        (30.0 + 40.0 * (1.0 - math.cos(a)), 40.0 - 40.0 * math.sin(a))
        for a in (math.pi / 2.0 * step / 12 for step in range(13))
    ]
    points = [(30.0, 80.0), *bend, (110.0, 0.0)]
    aircraft.procedures.taxi([along_runway(*point) for point in points], then="lined_up")
    with pytest.raises(ValueError, match="expected lined up"):
        aircraft.procedures.take_off(RUNWAY, CLIMB_TO_M)
    for _ in states(aircraft, 90):
        if aircraft.phase == "lined_up":
            break
    aircraft.procedures.take_off(RUNWAY, CLIMB_TO_M)
    takeoff = Takeoff(aircraft, RUNWAY)
    assert takeoff.phases[-1] == "en_route"
    assert takeoff.off_centre_m < 20 * FOOT


def test_it_takes_off_rolling() -> None:
    aircraft = on_the_ground("737")
    aircraft.procedures.taxi([along_runway(60.0), along_runway(400.0)], then="lined_up")
    *_, state = states(aircraft, 20)
    assert state.ground_speed_m_s > 5.0
    aircraft.procedures.take_off(RUNWAY, CLIMB_TO_M)
    slowest = min(state.ground_speed_m_s for state in states(aircraft, 10))
    assert slowest > 5.0
    assert Takeoff(aircraft, RUNWAY).phases[-1] == "en_route"


def test_commands_in_the_climb_are_flown_above_400_ft() -> None:
    aircraft = on_the_ground("737")
    aircraft.procedures.take_off(RUNWAY, 1_500.0)
    for _ in states(aircraft, 60):
        if aircraft.phase == "climb_out":
            break
    aircraft.en_route.hold_track((COURSE + 40.0) * DEGREE)
    aircraft.en_route.hold_altitude(600.0)
    for state in states(aircraft, 120):
        if state.height_agl_m < 350 * FOOT:
            assert abs(state.roll_rad) < 5.0 * DEGREE
    assert aircraft.phase == "en_route"
    assert abs(state.altitude_m - 600.0) < 10.0
    assert abs(state.track_rad - (COURSE + 40.0) * DEGREE) < 1.0 * DEGREE
