"""What shipped scenarios come to without an assistant, with their perturbations."""

from __future__ import annotations

import pytest

from airhilt.cosim.dry_flight import fly_dry
from airhilt.host import library
from airhilt.world.loading import load

pytestmark = pytest.mark.slow
SEEDS = range(3, 6)


@pytest.mark.parametrize(
    "name", [name for name in library.names("scenarios") if load(name).conflict]
)
def test_a_shipped_conflict_comes_about_in_most_seeds(name: str) -> None:
    flights = list(fly_dry(load(name), SEEDS))
    assert sum(flight.came_about for flight in flights) >= len(SEEDS) - 1


@pytest.mark.parametrize(
    "name", [name for name in library.names("scenarios") if not load(name).conflict]
)
def test_in_a_shipped_nominal_scenario_nobody_comes_to_harm(name: str) -> None:
    assert {flight.outcome for flight in fly_dry(load(name), SEEDS)} == {"none"}
