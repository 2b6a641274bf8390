"""Actors as sensors read them, and runs of one sensor alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, cast

from airhilt.scenario import Scenario
from airhilt.scenario.models import AircraftSpec
from airhilt.sensors.base import Publish, Sensor, SensorContext, SensorType
from airhilt.shapes.sizes import Dimensions
from airhilt.sim import Director, Priority, Virtual, parse_latency
from airhilt.surveillance.radar import discrete_code
from airhilt.units import SECOND_NS
from airhilt.world.site import ScenarioSite

AIRLINER = Dimensions(length_m=39.5, span_m=34.0, height_m=12.5)


@dataclass
class Body:
    """All that sensors read of what moves."""

    state: Any
    ended: str | None = None
    on_ground: bool = False
    dimensions: Dimensions = AIRLINER


@dataclass
class Acting:
    """All that sensors read of an actor."""

    spec: Any
    body: Body
    emitter_category: str = "A3"
    emergency: str = "none"
    squawks: str | None = None
    """Code that it has set; None: that of the scenario."""

    @property
    def squawk(self) -> str | None:
        """The code of an aircraft with a transponder; the others answer no radar."""
        if self.squawks is not None:
            return self.squawks
        if not (isinstance(self.spec, AircraftSpec) and self.spec.transponder.equipped):
            return None
        return self.spec.transponder.squawk or discrete_code(self.spec.icao24)


def sense(
    sensor_type: SensorType,
    scenario: Scenario,
    site: ScenarioSite,
    actors: Mapping[str, Acting],
    publish: Publish | Callable[..., None],
    seconds: float,
    *,
    seed: int = 1,
    age_ns: int = 0,
    subscribed: frozenset[str] = frozenset(),
    director: Director | None = None,
    state_at_ns: Callable[[], int] | None = None,
) -> Sensor | None:
    """Run a sensor for some seconds and return it; None if there is nothing for it to do.

    Parameters
    ----------
    age_ns
        Age of the actors' states, if ``state_at_ns`` does not tell their time.
    """
    now = director or Director(Virtual())
    context = SensorContext(
        director=now,
        scenario=scenario,
        site=site,
        actors=cast(Any, actors),
        latency=parse_latency("fixed"),
        seed=seed,
        state_at_ns=state_at_ns or (lambda: now.now_ns - age_ns),
        publish=cast(Publish, publish),
        step_done=lambda _: None,
        subscribed=subscribed,
    )
    sensor = sensor_type.create(context)
    if sensor is not None:
        sensor.start()
    now.at(round(seconds * SECOND_NS), now.stop, Priority.OBSERVE)
    now.run()
    return sensor
