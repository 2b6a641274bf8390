"""Aircraft in flight, as fixtures."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

import flights
from airhilt.geodesy.wgs84 import Place
from airhilt.world.flight import Aircraft, AircraftState
from airhilt.world.surface.runway import RunwayEnd
from breadth import mostly_slow
from flights import CRUISE, make_runway


@pytest.fixture(params=mostly_slow(sorted(CRUISE), "737", "c172p"))
def name(request: pytest.FixtureRequest) -> str:
    """Each type in turn: an airliner and a light aircraft, and the others if asked for."""
    return str(request.param)


@pytest.fixture(name="in_cruise")
def in_cruise_fixture() -> Callable[..., Aircraft]:
    return flights.in_cruise


@pytest.fixture(name="states")
def states_fixture() -> Callable[..., Iterator[AircraftState]]:
    return flights.states


@pytest.fixture(name="on_final")
def on_final_fixture() -> Callable[..., Aircraft]:
    return flights.on_final


@pytest.fixture(name="on_the_ground")
def on_the_ground_fixture() -> Callable[..., Aircraft]:
    return flights.on_the_ground


@pytest.fixture(name="along_runway")
def along_runway_fixture() -> Callable[..., Place]:
    return flights.along_runway


@pytest.fixture
def runway() -> RunwayEnd:
    return make_runway("01")


@pytest.fixture
def parallel_runway() -> RunwayEnd:
    return make_runway("01R", 400.0)
