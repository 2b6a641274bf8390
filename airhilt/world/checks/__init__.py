"""Checks of a scenario across its fields and against the world."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.errors import ScenarioError
from airhilt.scenario.models import Scenario
from airhilt.scenario.problems import Problem, error_for
from airhilt.scenario.twin import twin_of
from airhilt.world.checks.actors import (
    altitudes_below_ground,
    misdirected_commands,
    surface_wind,
    unfit_actors,
)
from airhilt.world.checks.instructions import (
    unknown_fixes,
    unknown_phases,
    unknown_units,
)
from airhilt.world.checks.names import (
    dangling_references,
    misplaced_perturbations,
    shared_names,
)
from airhilt.world.checks.places import missing_ways, unknown_places
from airhilt.world.checks.radio import (
    idle_failures,
    impossible_controllers,
    impossible_lines,
    unsaid_lines,
)
from airhilt.world.checks.responses import meaningless_shares
from airhilt.world.site import ScenarioSite

__all__ = ["check"]


def check(scenario: Scenario, origin: str, *, is_whole: bool = False) -> None:
    """Check that the world can hold a scenario.

    Parameters
    ----------
    origin
        Name of the scenario in errors.
    is_whole
        True to check that all lines are said as well: a draw or a caller may shorten a scenario,
        so that lines are left out; a file may not.

    Raises
    ------
    ScenarioError
        A reference leads to nothing, a value is outside the envelope of an aircraft, or a line is
        never said.
    """
    problems = list(_problems(scenario)) or list(_problems_of_twin(scenario))
    if is_whole:
        problems += unsaid_lines(scenario)
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
    except ScenarioError as error:
        yield from (Problem("scene/airport", text) for text in error.problems)
        return
    yield from meaningless_shares(scenario)
    yield from unfit_actors(scenario, site)
    yield from altitudes_below_ground(scenario, site)
    yield from unknown_places(scenario, site)
    yield from unknown_fixes(scenario, site)
    yield from dangling_references(scenario)
    yield from unknown_phases(scenario)
    yield from unknown_units(scenario)
    yield from impossible_lines(scenario)
    yield from impossible_controllers(scenario)
    yield from misdirected_commands(scenario)
    if site.layout is not None:
        yield from surface_wind(scenario)
        yield from missing_ways(scenario, site, site.layout)
        # Not at the top: scenarios without an airport start without the libraries behind it.
        from airhilt.world.checks.taxiways import unknown_taxiways

        yield from unknown_taxiways(scenario, site.layout)
    yield from idle_failures(scenario)
    yield from misplaced_perturbations(scenario)


def _problems_of_twin(scenario: Scenario) -> Iterator[Problem]:
    """Yield what is wrong with the nominal twin, if there is one."""
    if scenario.nominal_twin is None:
        return
    try:
        twin = twin_of(scenario)
    except ScenarioError as error:
        yield Problem("nominal_twin", str(error))
        return
    for problem in _problems(twin):
        yield Problem("nominal_twin", f"in the twin, {problem}")
