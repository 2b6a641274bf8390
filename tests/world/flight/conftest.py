"""Aircraft in flight, as fixtures."""

from __future__ import annotations

import pytest

from airhilt.world.surface.runway import RunwayEnd
from breadth import mostly_slow
from flights import CRUISE, make_runway


@pytest.fixture(params=mostly_slow(sorted(CRUISE), "737", "c172p"))
def name(request: pytest.FixtureRequest) -> str:
    """Each type in turn: an airliner and a light aircraft, and the others if asked for."""
    return str(request.param)


@pytest.fixture
def parallel_runway() -> RunwayEnd:
    return make_runway("01R", 400.0)
