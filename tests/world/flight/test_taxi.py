"""On the ground an aircraft follows its path, stops where it shall, and stays there."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from shapely import LineString, Point

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.units import DEGREE, KNOT
from airhilt.world.flight import Atmosphere
from airhilt.world.flight.state import AircraftState
from flights import along_runway, in_cruise, on_the_ground, states

COURSE = 10.0
RADIUS_M = 30.0
BEND_AT_M = 120.0
END = (BEND_AT_M + RADIUS_M, 150.0)
"""Along and to the right of the runway."""


def wind_from(degrees: float, kt: float = 15.0) -> Atmosphere:
    to = (degrees + 180.0) * DEGREE
    return Atmosphere(kt * KNOT * math.cos(to), kt * KNOT * math.sin(to))


def corner(place: Callable[..., Any]) -> list[tuple[float, float]]:
    """Return a path ahead, around a bend to the right, and on."""
    bend = [math.pi / 2.0 * step / 12 for step in range(13)]
    points = [
        (0.0, 0.0),
        *((BEND_AT_M + RADIUS_M * math.sin(a), RADIUS_M * (1.0 - math.cos(a))) for a in bend),
        END,
    ]
    return [place(*point) for point in points]


def distances_to(path: list[tuple[float, float]], flown: Any) -> list[float]:
    """Return how far from the path each of the places is (m)."""
    local_frame = LocalFrame(path[0], 0.0)
    line = LineString([local_frame.to_local(place) for place in path])
    return [line.distance(Point(local_frame.to_local(place))) for place in flown]


def place_of(state: AircraftState) -> tuple[float, float]:
    return state.latitude_rad, state.longitude_rad


@pytest.mark.parametrize(
    "wind", [Atmosphere(), wind_from(COURSE + 90.0)], ids=["calm", "crosswind"]
)
def test_it_follows_the_path_and_stops_at_its_end(wind: Atmosphere, name: str) -> None:
    aircraft = on_the_ground(name, along_m=0.0, atmosphere=wind)
    path = corner(along_runway)
    aircraft.procedures.taxi(path)
    assert aircraft.phase == "taxi"
    flown = []
    for state in states(aircraft, 120):
        flown.append(state)
        if aircraft.phase == "standing":
            break
    assert aircraft.phase == "standing"
    assert aircraft.ended is None
    assert distances_to([path[-1]] * 2, [place_of(aircraft.state)])[0] < 0.5
    off = distances_to(path, map(place_of, flown))
    assert max(off) < 3.5
    local_frame = LocalFrame(path[0], 0.0)
    before_bend = [
        distance
        for distance, state in zip(off, flown, strict=True)
        if math.hypot(*local_frame.to_local(place_of(state))) < BEND_AT_M
    ]
    assert max(before_bend) < 2.0
    assert max(off[-20:]) < 2.0


def test_it_holds_its_position_and_goes_on(name: str) -> None:
    aircraft = on_the_ground(name, along_m=0.0)
    aircraft.procedures.taxi([along_runway(0.0), along_runway(200.0)])
    *_, moving = states(aircraft, 20)
    aircraft.procedures.hold_position()
    *_, held = states(aircraft, 15)
    needed = distances_to([place_of(moving)] * 2, [place_of(held)])[0]
    assert needed < 0.5 * moving.ground_speed_m_s**2 / 1.0
    *_, later = states(aircraft, 60)
    assert distances_to([place_of(held)] * 2, [place_of(later)])[0] < 0.01
    assert aircraft.phase == "standing"
    aircraft.procedures.resume_taxi()
    for _ in states(aircraft, 10):
        pass
    assert aircraft.phase == "taxi"
    for _ in states(aircraft, 90):
        pass
    end = [along_runway(200.0)] * 2
    assert distances_to(end, [place_of(aircraft.state)])[0] < 0.5


@pytest.mark.parametrize("from_deg", [0.0, 90.0, 180.0, 270.0])
def test_it_stands_still_in_any_wind(from_deg: float, name: str) -> None:
    aircraft = on_the_ground(name, lined_up=False, atmosphere=wind_from(COURSE + from_deg, 30.0))
    _, *later = states(aircraft, 60)
    assert set(later) == {aircraft.state}
    assert aircraft.state.ground_speed_m_s == 0.0
    assert aircraft.phase == "standing"
    assert aircraft.on_ground


@pytest.mark.parametrize("from_deg", [90.0, 180.0])
def test_no_wind_tips_it_over(from_deg: float, name: str) -> None:
    aircraft = on_the_ground(name, along_m=0.0, atmosphere=wind_from(COURSE + from_deg, 25.0))
    standing = aircraft.state.pitch_rad
    aircraft.procedures.taxi(corner(along_runway))
    for state in states(aircraft, 60):
        assert abs(state.pitch_rad - standing) < 3.0 * DEGREE
        assert abs(state.roll_rad) < 3.0 * DEGREE
    assert aircraft.ended is None


def test_what_belongs_to_the_ground_is_refused_in_the_air() -> None:
    aircraft = in_cruise("c172p")
    with pytest.raises(ValueError, match="taxi in phase en_route in the air"):
        aircraft.procedures.taxi([along_runway(0.0), along_runway(100.0)])
    with pytest.raises(ValueError, match="hold_position in phase en_route; expected taxi"):
        aircraft.procedures.hold_position()


def test_what_belongs_to_the_air_is_refused_on_the_ground() -> None:
    aircraft = on_the_ground("c172p")
    commands: tuple[Callable[[], object], ...] = (
        lambda: aircraft.en_route.hold_altitude(1_000.0),
        lambda: aircraft.en_route.hold_track(0.0),
        lambda: aircraft.en_route.turn_by(1.0),
        lambda: aircraft.en_route.hold_speed(40.0),
    )
    for command in commands:
        with pytest.raises(ValueError, match="on the ground"):
            command()
    assert aircraft.phase == "lined_up"


def test_who_taxies_has_speed_brakes_and_spoilers_in() -> None:
    aircraft = on_the_ground("737")
    fdm = aircraft._airframe._fdm
    aircraft._airframe.set_speed_brakes(1.0)
    aircraft._airframe.set_ground_spoilers(1.0)
    aircraft.procedures.taxi([along_runway(along_m) for along_m in (60.0, 200.0)])
    assert (fdm["fcs/speedbrake-cmd-norm"], fdm["fcs/spoiler-cmd-norm"]) == (0.0, 0.0)
