"""Checks of a scenario across its fields and against the world."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from airhilt.errors import AirhiltError
from airhilt.scenario.models import Scenario
from airhilt.scenario.problems import Problem, error_for
from airhilt.world.checks.actors import surface_wind, unfit_actors
from airhilt.world.checks.altitudes import altitudes_below_ground
from airhilt.world.checks.commands import misdirected_commands
from airhilt.world.checks.duplicates import shared_names
from airhilt.world.checks.failures import idle_failures
from airhilt.world.checks.perturbations import misplaced_perturbations
from airhilt.world.checks.places import missing_airport, unknown_places
from airhilt.world.checks.radio_lines import impossible_lines, unsaid_lines
from airhilt.world.checks.references import dangling_references
from airhilt.world.checks.taxi_ways import missing_ways
from airhilt.world.site import ScenarioSite

__all__ = ["check", "check_file"]


def check(scenario: Scenario, origin: str) -> None:
    """Check that the world can hold a scenario.

    Parameters
    ----------
    origin
        Name of the scenario in errors.

    Raises
    ------
    ScenarioError
        A reference leads to nothing, or a value is outside the envelope of an aircraft.
    """
    _require_none(origin, list(_problems(scenario)))


def check_file(scenario: Scenario, origin: str) -> None:
    """Check that the world can hold the scenario of a file, and that all its lines can be said.

    A draw or a caller may shorten a scenario, so that lines are left out; a file may not.

    Parameters
    ----------
    origin
        Name of the scenario in errors.

    Raises
    ------
    ScenarioError
        As `check` raises, or a line is never said.
    """
    _require_none(origin, [*_problems(scenario), *unsaid_lines(scenario)])


def _require_none(origin: str, problems: Sequence[Problem]) -> None:
    if problems:
        raise error_for(origin, problems)


def _problems(scenario: Scenario) -> Iterator[Problem]:
    """Yield all problems; only the shared names if there are any."""
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
    yield from altitudes_below_ground(scenario, site)
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
