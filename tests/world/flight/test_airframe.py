"""The airframe in SI: pressures, the height of its wheels, and what it retracts."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.units import DEGREE
from airhilt.world.flight import (
    Atmosphere,
    InitialCondition,
    load_aircraft_type,
    standard_atmosphere,
)
from airhilt.world.flight.airframe import Airframe
from airhilt.world.flight.starting import heading_to_track
from flights import RUNWAY, in_cruise, on_final, on_the_ground, states


def test_the_dynamic_pressure_is_that_of_its_mach_number() -> None:
    aircraft = in_cruise("737")
    pressure_pa = standard_atmosphere.pressure(aircraft.state.altitude_m)
    expected_pa = 0.7 * pressure_pa * aircraft.state.mach**2
    assert aircraft._airframe.dynamic_pressure_pa() == pytest.approx(expected_pa, rel=5e-3)


@pytest.mark.parametrize("name", ["c172p", "737"])
def test_the_main_wheels_are_on_the_ground_while_the_nose_is_lifted(name: str) -> None:
    aircraft = on_the_ground(name)
    aircraft.procedures.take_off(RUNWAY, 300.0)
    lifted = []
    for state in states(aircraft, 60):
        if aircraft.phase == "rotate" and not aircraft.on_ground:
            break
        if state.pitch_rad > 3.0 * DEGREE:
            lifted.append(aircraft.main_wheel_height_m)
    assert lifted
    assert -0.7 < min(lifted) <= max(lifted) < 0.1


def test_cleaned_up_it_has_gear_flaps_and_speed_brakes_in() -> None:
    aircraft = on_final("737", distance_nm=8.0)
    airframe: Airframe = aircraft.en_route.systems.airframe
    airframe.set_speed_brakes(1.0)
    aircraft.advance()
    assert (aircraft.gear, aircraft.flaps) != (0.0, 0.0)
    airframe.clean_up()
    for _ in range(20 * 120):
        airframe.step()
    assert (aircraft.gear, aircraft.flaps) == (0.0, 0.0)
    assert airframe._fdm["fcs/speedbrake-pos-norm"] == 0.0


# --- the wind -------------------------------------------------------------------------------

WINDY = Atmosphere(wind_north_m_s=6.3, wind_east_m_s=-4.1, turbulence_wind_at_20ft_m_s=2.7)


def wind_of(airframe: Airframe) -> list[float]:
    fdm = airframe._fdm
    return [
        fdm[f"atmosphere/{name}-fps"] * 0.3048
        for name in ("wind-north", "wind-east", "turbulence/milspec/windspeed_at_20ft_AGL")
    ]


def test_an_aircraft_that_stands_feels_no_wind_and_one_at_15_m_s_all_of_it() -> None:
    airframe: Airframe = on_the_ground("737", atmosphere=WINDY).en_route.systems.airframe
    whole = [6.3, -4.1, 2.7]
    assert wind_of(airframe) == [0.0, 0.0, 0.0]
    for speed_m_s, part in ((3.0, 0.2), (7.5, 0.5), (15.0, 1.0), (60.0, 1.0), (0.0, 0.0)):
        airframe.set_wind_for_ground_speed(speed_m_s)
        assert wind_of(airframe) == pytest.approx([part * each for each in whole], abs=1e-9)


def test_an_aircraft_in_flight_has_the_whole_wind_from_the_beginning() -> None:
    aircraft = in_cruise("737", atmosphere=Atmosphere(wind_north_m_s=20.0, wind_east_m_s=-12.0))
    assert wind_of(aircraft.en_route.systems.airframe)[:2] == pytest.approx([20.0, -12.0], abs=1e-6)
    state = aircraft.state
    heading = state.heading_rad
    airspeed = state.true_airspeed_m_s
    assert state.velocity_north_m_s == pytest.approx(airspeed * math.cos(heading) + 20.0, abs=0.3)
    assert state.velocity_east_m_s == pytest.approx(airspeed * math.sin(heading) - 12.0, abs=0.3)


@given(st.floats(-180.0, 180.0), st.floats(-25.0, 25.0), st.floats(-25.0, 25.0),
       st.floats(-10.0, 10.0))  # fmt: skip
def test_the_heading_and_the_wind_together_make_good_the_track(
    track_deg: float, north_m_s: float, east_m_s: float, rate_m_s: float
) -> None:
    initial = InitialCondition(0.8, 0.1, 0.0, track_deg * DEGREE, 90.0, rate_m_s)
    wind = Atmosphere(wind_north_m_s=north_m_s, wind_east_m_s=east_m_s)
    heading = heading_to_track(initial, wind)
    level_m_s = math.sqrt(90.0**2 - rate_m_s**2)
    north = level_m_s * math.cos(heading) + north_m_s
    east = level_m_s * math.sin(heading) + east_m_s
    off = math.remainder(math.atan2(east, north) - track_deg * DEGREE, math.tau)
    assert off == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("wind_m_s", "is_refused"), [(89.9, False), (90.1, True)])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_wind_across_that_is_stronger_than_the_airspeed_is_refused(
    side: float, wind_m_s: float, is_refused: bool
) -> None:
    initial = InitialCondition(0.8, 0.1, 0.0, 0.0, 90.0)
    across = Atmosphere(wind_east_m_s=side * wind_m_s)
    if is_refused:
        with pytest.raises(ValueError, match=r"across the track is 90\.1 m/s"):
            heading_to_track(initial, across)
    else:
        assert heading_to_track(initial, across) * side < -80.0 * DEGREE


# --- its engines and wheels -----------------------------------------------------------------


def test_it_is_on_the_ground_and_stands_there_with_its_nose_wheel() -> None:
    standing: Airframe = on_the_ground("737").en_route.systems.airframe
    assert standing.on_ground()
    assert standing.nose_on_ground()
    assert standing.gear() == 1.0
    assert standing.flaps() == pytest.approx(load_aircraft_type("737").takeoff.flaps, abs=0.01)
    flying: Airframe = in_cruise("737").en_route.systems.airframe
    assert not flying.on_ground()
    assert not flying.nose_on_ground()
    assert (flying.gear(), flying.flaps()) == (0.0, 0.0)


def test_the_wheelbase_is_that_of_the_aircraft() -> None:
    """15.6 m of the 737-800 (Boeing D6-58325-6), 1.65 m of the 172 (its flight manual)."""
    assert on_the_ground("737")._airframe.wheelbase_m == pytest.approx(15.6, rel=0.25)
    assert on_the_ground("c172p")._airframe.wheelbase_m == pytest.approx(1.65, rel=0.25)
