"""A flight that never lands takes fewer steps and sets its controls less often; it stays itself."""

from __future__ import annotations

import itertools
import math
import statistics
from collections.abc import Iterator

import pytest

from airhilt.units import DEGREE, KNOT, wrap_angle
from airhilt.world.flight import Aircraft, AircraftState, Atmosphere, load_aircraft_type
from airhilt.world.flight.airframe import Airframe
from airhilt.world.flight.state import InitialCondition
from flights import in_cruise, states


@pytest.mark.parametrize("steps_hz", [60, 120])
def test_the_gear_of_a_737_takes_five_seconds_in_a_hundred_moves(steps_hz: int) -> None:
    kind = load_aircraft_type("737")
    airframe = Airframe(kind, step_s=1 / steps_hz, seed=1, terrain_elevation_m=0.0)
    airframe.start(InitialCondition(0.8, 0.1, 3000.0, 0.0, 250 * KNOT), 0.0)
    airframe.set_gear(1.0)
    positions = [airframe.gear()]
    while positions[-1] < 1.0:
        airframe.step()
        positions.append(airframe.gear())
    assert len(positions) / steps_hz == pytest.approx(5.0, abs=0.1)
    assert len(set(positions)) == pytest.approx(100, abs=2)


@pytest.mark.parametrize("law_hz", [10, 20])
def test_it_flies_where_it_flies_at_an_airport(name: str, law_hz: int) -> None:
    kind = load_aircraft_type(name)
    if law_hz < kind.rates.law_hz:
        pytest.skip("the type is not stable at that rate")
    rates = kind.rates.model_copy(update={"law_hz": law_hz})
    kind = kind.model_copy(update={"rates": rates})
    farthest_m, greatest_angle = (1.0, 0.07 * DEGREE) if law_hz == 20 else (15.0, 0.35 * DEGREE)
    at_airport, in_the_air = (in_cruise(name, kind=kind, may_land=each) for each in (True, False))
    for one, other in zip(manoeuvre(at_airport), manoeuvre(in_the_air), strict=True):
        assert math.dist(one[-3:], other[-3:]) < farthest_m
        for angle in ("roll_rad", "pitch_rad", "heading_rad"):
            error = wrap_angle(getattr(one, angle) - getattr(other, angle))
            assert abs(error) < greatest_angle


def manoeuvre(aircraft: Aircraft) -> Iterator[AircraftState]:
    control = aircraft.en_route
    control.turn_by(70 * DEGREE)
    control.hold_altitude(aircraft.state.altitude_m - 600.0)
    control.hold_speed(aircraft.target_speed_m_s + 5.0)
    return states(aircraft, 150)


@pytest.mark.parametrize("altitude_ft", [3_000, 8_000])
def test_it_does_not_pitch_up_and_down_at_its_slowest(name: str, altitude_ft: int) -> None:
    slowest_kt = load_aircraft_type(name).speeds.minimum_clean_kt + 3
    aircraft = in_cruise(name, altitude_ft=altitude_ft, airspeed_kt=slowest_kt, may_land=False)
    *_, _ = states(aircraft, 15)
    pitches = [state.pitch_rad for state in states(aircraft, 5)]
    assert max(pitches) - min(pitches) < 0.1 * DEGREE


def test_turbulence_shakes_it_as_it_does_at_an_airport(name: str) -> None:
    air = Atmosphere(turbulence_wind_at_20ft_m_s=15.0, turbulence_severity=5)
    shaken = []
    for may_land in (True, False):
        aircraft = in_cruise(name, atmosphere=air, may_land=may_land)
        flown = list(states(aircraft, 90))
        assert aircraft.ended is None
        altitude_m = aircraft.target_altitude_m
        assert max(abs(state.altitude_m - altitude_m) for state in flown) < 150.0
        turns = [after.pitch_rad - before.pitch_rad for before, after in itertools.pairwise(flown)]
        shaken.append(statistics.fmean(map(abs, turns)))
    at_airport, in_the_air = shaken
    assert in_the_air < 1.3 * at_airport


def test_a_command_acts_within_a_fifth_of_a_second() -> None:
    early, late, never = (in_cruise("737", may_land=False) for _ in range(3))
    for ticks_before, aircraft in ((1, early), (4, late), (8, never)):
        for tick in range(8):
            if tick == ticks_before:
                aircraft.en_route.turn_by(1.0)
            aircraft.advance()
    assert early.state == late.state
    assert early.state.roll_rad > never.state.roll_rad
