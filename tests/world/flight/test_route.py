"""Routes follow the geodesics of the ellipsoid, and turn from one to the next."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import cast

import pytest
from geographiclib.geodesic import Geodesic

from airhilt.units import DEGREE, wrap_angle
from airhilt.world.flight import Atmosphere
from airhilt.world.flight.route import legs_through
from airhilt.world.flight.state import AircraftState
from flights import in_cruise, states

EARTH = Geodesic.WGS84


def place(
    start_deg: tuple[float, float], course_deg: float, distance_m: float
) -> tuple[float, float]:
    there = EARTH.Direct(*start_deg, course_deg, distance_m)
    return there["lat2"], there["lon2"]


def radians(position_deg: tuple[float, float]) -> tuple[float, float]:
    return position_deg[0] * DEGREE, position_deg[1] * DEGREE


def cross_track_m(
    position_deg: tuple[float, float], start_deg: tuple[float, float], end_deg: tuple[float, float]
) -> float:
    """Return the distance to the right of the geodesic, found on the geodesic itself."""
    line = EARTH.InverseLine(*start_deg, *end_deg)
    along = 0.0
    for _ in range(8):
        foot = line.Position(along)
        offset = EARTH.Inverse(foot["lat2"], foot["lon2"], *position_deg)
        angle = (offset["azi1"] - foot["azi2"]) * DEGREE
        along += offset["s12"] * math.cos(angle)
    return float(offset["s12"] * math.sin(angle))


def ecef(position_deg: tuple[float, float], height_m: float) -> SimpleNamespace:
    latitude, longitude = radians(position_deg)
    e2 = EARTH.f * (2.0 - EARTH.f)
    radius = EARTH.a / math.sqrt(1.0 - e2 * math.sin(latitude) ** 2)
    return SimpleNamespace(
        latitude_rad=latitude,
        longitude_rad=longitude,
        ecef_x_m=(radius + height_m) * math.cos(latitude) * math.cos(longitude),
        ecef_y_m=(radius + height_m) * math.cos(latitude) * math.sin(longitude),
        ecef_z_m=(radius * (1.0 - e2) + height_m) * math.sin(latitude),
    )


@pytest.mark.parametrize("start", [(0.0, 10.0), (47.0, 8.0), (-65.0, 179.5)])
@pytest.mark.parametrize("course", [0.0, 35.0, 90.0, 215.0, 310.0])
def test_a_leg_of_200_km_is_the_geodesic_within_two_metres(
    start: tuple[float, float], course: float
) -> None:
    end = place(start, course, 199_998.0)  # two legs of 99,999 m
    legs = legs_through(radians(start), [radians(end)])
    line = EARTH.InverseLine(*start, *end)
    for kilometre in range(5, 200, 15):
        on_line = line.Position(kilometre * 1000.0)
        leg = legs[int(kilometre >= 100)]
        for offset in (-500.0, 0.0, 500.0):
            at = place((on_line["lat2"], on_line["lon2"]), on_line["azi2"] + 90.0, offset)
            state = ecef(at, 10_000.0)
            scale = 1.0 + 10_000.0 / EARTH.a
            assert leg.cross_track_m(cast(AircraftState, state)) == pytest.approx(
                offset * scale, abs=2.0
            )
            to_go = 99_999.0 * (1 + int(kilometre >= 100)) - kilometre * 1000.0
            assert leg.to_go_m(cast(AircraftState, state)) == pytest.approx(to_go * scale, rel=2e-3)
            course_here = math.radians(on_line["azi2"])
            error = wrap_angle(
                leg.course_rad(state.latitude_rad, state.longitude_rad) - course_here
            )
            assert abs(error) < 0.01 * DEGREE


@pytest.mark.parametrize(
    "air",
    [Atmosphere(), Atmosphere(wind_north_m_s=-15.0, wind_east_m_s=15.0)],
    ids=["calm", "wind"],
)
@pytest.mark.parametrize("name", ["737", "c172p"])
def test_it_follows_a_route_with_a_turn(name: str, air: Atmosphere) -> None:
    aircraft = in_cruise(name, atmosphere=air)
    length = aircraft.state.true_airspeed_m_s * 150.0
    start = (47.0, 8.0)
    corner = place(start, 60.0, length)
    end = place(corner, 130.0, length)
    aircraft.en_route.fly_route([radians(corner), radians(end)])
    worst, bank = {"before": 0.0, "after": 0.0}, 0.0
    for tick, state in enumerate(states(aircraft, 300)):
        bank = max(bank, abs(state.roll_rad))
        position = (state.latitude_rad / DEGREE, state.longitude_rad / DEGREE)
        if tick % 100 == 0 and 5 < tick / 20 < 80:
            error = abs(cross_track_m(position, start, corner))
            worst["before"] = max(worst["before"], error)
        if tick % 100 == 0 and 240 < tick / 20 < 260:
            worst["after"] = max(worst["after"], abs(cross_track_m(position, corner, end)))
    assert worst["before"] < 10.0
    assert worst["after"] < 10.0
    assert bank < 32 * DEGREE


def test_beyond_the_last_waypoint_it_holds_the_last_track() -> None:
    aircraft = in_cruise("c172p")
    end = place((47.0, 8.0), 60.0, 1_500.0)
    aircraft.en_route.fly_route([radians(end)])
    *_, state = states(aircraft, 60)
    course = EARTH.Inverse(47.0, 8.0, *end)["azi2"]
    assert abs(wrap_angle(state.track_rad - course * DEGREE)) < 0.1 * DEGREE


def test_it_resumes_a_route_that_it_left() -> None:
    aircraft = in_cruise("737")
    end = place((47.0, 8.0), 60.0, 120_000.0)
    aircraft.en_route.fly_route([radians(end)])
    *_, _ = states(aircraft, 20)
    aircraft.en_route.turn_by(30 * DEGREE)
    *_, away = states(aircraft, 40)
    position = (away.latitude_rad / DEGREE, away.longitude_rad / DEGREE)
    assert cross_track_m(position, (47.0, 8.0), end) > 1_500.0
    aircraft.en_route.resume_route()
    *_, back = states(aircraft, 150)
    position = (back.latitude_rad / DEGREE, back.longitude_rad / DEGREE)
    assert abs(cross_track_m(position, (47.0, 8.0), end)) < 15.0
