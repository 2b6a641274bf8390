"""What the flight tests share: aircraft in a typical cruise, and flying them for a while."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from airhilt.flight import (
    Aircraft,
    AircraftState,
    Atmosphere,
    InitialCondition,
    load_aircraft_type,
)
from airhilt.units import DEGREE, FOOT, KNOT

CRUISE = {"737": (35_000, 260), "B747": (35_000, 270), "c172p": (5_000, 95), "c310": (6_000, 150)}
"""Altitude (ft) and calibrated airspeed (kt)."""


def in_cruise(
    name: str,
    *,
    altitude_ft: float | None = None,
    airspeed_kt: float | None = None,
    track_deg: float = 60.0,
    vertical_rate_m_s: float = 0.0,
    seed: int = 1,
    atmosphere: Atmosphere | None = None,
    terrain_elevation_m: float = 0.0,
) -> Aircraft:
    """Return an aircraft of a type at 47 N 8 E, in its typical cruise where not told otherwise."""
    altitude, airspeed = CRUISE[name]
    initial = InitialCondition(
        latitude_rad=47.0 * DEGREE,
        longitude_rad=8.0 * DEGREE,
        altitude_m=(altitude_ft or altitude) * FOOT,
        track_rad=track_deg * DEGREE,
        calibrated_airspeed_m_s=(airspeed_kt or airspeed) * KNOT,
        vertical_rate_m_s=vertical_rate_m_s,
    )
    return Aircraft(
        load_aircraft_type(name),
        initial,
        seed=seed,
        atmosphere=atmosphere or Atmosphere(),
        terrain_elevation_m=terrain_elevation_m,
    )


def states(aircraft: Aircraft, seconds: float) -> Iterator[AircraftState]:
    """Fly on, and yield the state after every tick."""
    for _ in range(round(seconds * 20)):
        aircraft.advance()
        yield aircraft.state


@pytest.fixture(params=sorted(CRUISE))
def name(request: pytest.FixtureRequest) -> str:
    """Each type in turn."""
    return str(request.param)


@pytest.fixture(name="in_cruise")
def in_cruise_fixture() -> Callable[..., Aircraft]:
    return in_cruise


@pytest.fixture(name="states")
def states_fixture() -> Callable[..., Iterator[AircraftState]]:
    return states
