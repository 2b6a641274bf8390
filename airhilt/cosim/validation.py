"""Checks that a scenario can be run."""

from __future__ import annotations

from airhilt.cosim.option_checks import require_known_equipment
from airhilt.cosim.setup import TICK_S
from airhilt.scenario import Scenario
from airhilt.world.actors import build_actors
from airhilt.world.loading import draw
from airhilt.world.site import ScenarioSite


def require_runnable(scenario: Scenario) -> None:
    """Check that a run of a loaded scenario can begin: put all its actors where they begin.

    Raises
    ------
    AirhiltError
        There is no such equipment, or an actor cannot be where it begins.
    """
    require_known_equipment(scenario.equipment)
    realised, _ = draw(scenario, 0)
    build_actors(realised, ScenarioSite.of(realised), 0, TICK_S)
