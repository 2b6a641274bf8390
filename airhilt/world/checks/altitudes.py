"""Checks of altitudes to fly to, or to wait for: whether they are above the ground."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.commands import (
    AltitudeCommand,
    EmergencyDescentCommand,
    GoAroundCommand,
    TakeOffCommand,
)
from airhilt.scenario.models import BoundForAltitude, Scenario
from airhilt.scenario.problems import Problem
from airhilt.units import FOOT
from airhilt.world.checks.walk import models_of
from airhilt.world.site import ScenarioSite


def altitudes_below_ground(scenario: Scenario, site: ScenarioSite) -> Iterator[Problem]:
    """Yield altitudes of commands and conditions that are not above the ground."""
    ground_ft = site.ground_m / FOOT
    for path, model in models_of(scenario, ""):
        match model:
            case (
                AltitudeCommand(altitude_ft=altitude_ft)
                | EmergencyDescentCommand(altitude_ft=altitude_ft)
                | BoundForAltitude(altitude_ft=altitude_ft)
            ):
                field = "altitude_ft"
            case TakeOffCommand(climb_to_ft=altitude_ft) | GoAroundCommand(climb_to_ft=altitude_ft):
                field = "climb_to_ft"
            case _:
                continue
        if altitude_ft <= ground_ft:
            yield not_above_ground(f"{path}/{field}", altitude_ft, site)


def not_above_ground(path: str, altitude_ft: float, site: ScenarioSite) -> Problem:
    """Return the problem of an altitude that is not above the ground."""
    where = "the airport" if site.layout else "scene/terrain_elevation_ft"
    return Problem(
        path,
        f"found {altitude_ft:g}, which is not above the ground; expected more than {where}, "
        f"{site.ground_m / FOOT:g}",
    )
