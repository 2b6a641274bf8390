"""Checks of what no field of a scenario can know of another, or of the world."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.errors import AirhiltError
from airhilt.scenario.models import Scenario
from airhilt.scenario.problems import Problem, error_for
from airhilt.world.checks.actors import surface_wind, unfit_actors
from airhilt.world.checks.commands import misdirected_commands
from airhilt.world.checks.duplicates import shared_names
from airhilt.world.checks.failures import idle_failures
from airhilt.world.checks.perturbations import misplaced_perturbations
from airhilt.world.checks.places import missing_airport, unknown_places
from airhilt.world.checks.radio_lines import impossible_lines
from airhilt.world.checks.references import dangling_references
from airhilt.world.checks.taxi_ways import missing_ways
from airhilt.world.site import ScenarioSite

__all__ = ["check"]


def check(scenario: Scenario, origin: str) -> None:
    """Check that the world can hold a scenario.

    Parameters
    ----------
    origin
        Name of the scenario in errors.

    Raises
    ------
    ScenarioError
        Something refers to nothing, or is outside what an aircraft flies.
    """
    problems = list(_problems(scenario))
    if problems:
        raise error_for(origin, problems)


def _problems(scenario: Scenario) -> Iterator[Problem]:
    """Yield all problems; while two things share a name, only that."""
    shared = list(shared_names(scenario))
    if shared:
        yield from shared
        return
    try:
        site = ScenarioSite.of(scenario)
    except AirhiltError as error:
        yield Problem("scene/airport", str(error))
        return
    yield from unfit_actors(scenario, site)
    yield from unknown_places(scenario, site)
    yield from missing_airport(scenario, site)
    yield from dangling_references(scenario)
    yield from impossible_lines(scenario)
    yield from misdirected_commands(scenario)
    if site.layout is not None:
        yield from surface_wind(scenario)
        yield from missing_ways(scenario, site, site.layout)
    yield from idle_failures(scenario)
    yield from misplaced_perturbations(scenario)
