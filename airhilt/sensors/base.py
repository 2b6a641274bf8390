"""What a sensor of a run is: the protocol, and what a run gives to each.

A sensor turns the true world into what can be perceived of it, and publishes that.
a module in `airhilt.sensors.members`, or an entry point of the group ``airhilt.sensors``, whose
``SENSOR`` makes it for a run, or says that the run has no use for it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from airhilt.messages import Message
from airhilt.scenario.models import Scenario
from airhilt.sim import Director, LatencySpec, StepRecord
from airhilt.world.actors.actor import Actor
from airhilt.world.site import ScenarioSite


class Publish(Protocol):
    """Publishes a message; ``raw`` is the payload of a key whose message is only its header."""

    def __call__(self, key: str, message: Message, *, raw: bytes | None = None) -> None: ...  # noqa: D102


@dataclass(frozen=True)
class SensorContext:
    """What a run gives to each of its sensors.

    Attributes
    ----------
    scenario
        With its perturbations drawn.
    state_at_ns
        Returns the time of the actors' states: that of the last physics tick.
    step_done
        Called with the latency record of each finished measurement.
    """

    director: Director
    scenario: Scenario
    site: ScenarioSite
    actors: Mapping[str, Actor]
    latency: LatencySpec
    seed: int
    state_at_ns: Callable[[], int]
    publish: Publish
    step_done: Callable[[StepRecord], None]


class Sensor(Protocol):
    """A part of a run that measures the true world and publishes what it finds."""

    def start(self) -> None:
        """Schedule the first measurements; the run begins."""

    def unfinished(self) -> Sequence[StepRecord]:
        """Return the measurements that were begun and are not published yet; the run ends."""
