"""Where the bodies of a scenario are when it begins."""

from __future__ import annotations

from airhilt.scenario import Scenario
from airhilt.sensors.cameras.body_states import states_of
from airhilt.sensors.cameras.mounts import local_frame_of
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.snapshot import TICK_S
from airhilt.world.actors import build_actors
from airhilt.world.site import ScenarioSite


def bodies_of(scenario: Scenario) -> list[BodyState]:
    """Return the states of all actors at the start."""
    site = ScenarioSite.of(scenario)
    cast = build_actors(scenario, site, 0, TICK_S)
    frame = local_frame_of(site)
    return states_of(cast.values(), frame, site.ground_m, 0, 0)
