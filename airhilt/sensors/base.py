"""Sensors: their protocol, what a run gives to each, and how a run finds them all.

A sensor measures the true world and publishes what can be perceived of it. One file is one type of
sensor: a module of this package, or an object in another package that an entry point of the group
``airhilt.sensors`` names, such as ``lidar = "my_package.lidar:SENSOR"``. The name of a type is the
first chunk of the keys that its sensors publish on: ``adsb`` publishes on ``adsb/<icao24>``.

Cameras and the radio are a `Sensor` too, but no `SensorType`: the run makes these two itself,
because they need a renderer, voices, and what crews and workers say.

`SensorType` is what to write; a run calls `load_sensor_types`, then `starting.start_sensors`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

from airhilt.errors import ScenarioError, SensorError
from airhilt.host.library import nearest
from airhilt.messages import BUS_MESSAGES, WORKER_OUTPUTS, Message
from airhilt.plugins import Family
from airhilt.scenario.models import Scenario
from airhilt.sim import LatencySpec, Scheduler, StepRecord
from airhilt.units import SECOND_NS
from airhilt.world.actors.actor import Actor
from airhilt.world.mover import Motion, Mover, carried_on
from airhilt.world.site import ScenarioSite


class Publish(Protocol):
    """Publishes a message; ``raw`` is the payload of a key whose message is only its header."""

    def __call__(self, key: str, message: Message, *, raw: bytes | None = None) -> None: ...  # noqa: D102


@dataclass(frozen=True)
class SensorContext:
    """Everything that a run gives to each of its sensors.

    Attributes
    ----------
    director
        Schedules the measurements, at ``Priority.SENSOR``.
    scenario
        The scenario after its perturbations were drawn and the run's options were applied.
    site
        The place of the scenario: its centre, its ground and its airport.
    actors
        Everything that can be sensed, by callsign.
    latency
        Source of the latencies of the run.
    seed
        The run's seed; draw from ``sim.streams.stream(seed, "<name of the sensor>/<target>")``.
    state_at_ns
        Returns the time of the actors' states, which is that of the last physics tick.
    publish
        Publishes a message on a key below the sensor type's name, now.
    step_done
        Called with the latency record of each finished measurement, for sensors that have any.
    subscribed
        First chunks of the keys that workers of the run subscribe to. A sensor that is not in every
        run is in this one if its name is among them.
    settings
        Settings of this sensor type in the scenario's ``sensors``; None if it has none there.
    """

    director: Scheduler
    scenario: Scenario
    site: ScenarioSite
    actors: Mapping[str, Actor]
    latency: LatencySpec
    seed: int
    state_at_ns: Callable[[], int]
    publish: Publish
    step_done: Callable[[StepRecord], None]
    subscribed: frozenset[str] = frozenset()
    settings: Mapping[str, Any] | None = None

    def state_of(self, body: Mover, before_s: float = 0.0) -> Motion:
        """Return the motion of a body now, or a time in s before, carried on from its state."""
        age_s = (self.director.now_ns - self.state_at_ns()) / SECOND_NS
        return carried_on(body.state, age_s - before_s)


class Sensor(Protocol):
    """A part of a run that measures the true world and publishes what it finds."""

    def start(self) -> None:
        """Schedule the first measurements; the run begins."""

    def unfinished(self) -> Sequence[StepRecord]:
        """Return latency records of measurements that are not published when the run ends.

        There are none unless a sensor has a latency of its own in the latency log.
        """
        return ()


class SensorGroup(Sensor):
    """Several sensors of one type, such as all radars of a scenario."""

    def __init__(self, sensors: Sequence[Sensor]) -> None:
        self._sensors = sensors

    def start(self) -> None:
        """Start all sensors."""
        for sensor in self._sensors:
            sensor.start()


@runtime_checkable
class SensorType(Protocol):
    """One type of sensor: the ``SENSOR`` of a module."""

    @property
    def name(self) -> str:
        """First chunk of the keys that its sensors publish on; also the name of its module."""

    @property
    def messages(self) -> Mapping[str, type[Message]]:
        """Message of each key that its sensors publish on, such as ``adsb/{icao24}``."""

    def create(self, context: SensorContext) -> Sensor | None:
        """Return the sensor for a run; None if there is nothing for it to do.

        An AirhiltError says that the scenario asks for a sensor that cannot exist.
        """


FAMILY = Family(
    "sensor",
    "airhilt.sensors",
    "airhilt.sensors",
    "SENSOR",
    SensorType,
    SensorError,
    frozenset({"base", "cameras", "radio", "starting"}),
)


def sensor_messages(types: Iterable[SensorType]) -> dict[str, type[Message]]:
    """Return the message of each key that sensors of some types publish on."""
    return {key: model for each in types for key, model in each.messages.items()}


def load_sensor_types(asked: Collection[str] = ()) -> tuple[list[SensorType], list[str]]:
    """Return all installed sensor types in the order of their names, and what is wrong with others.

    Types of AIRHILT and requested types must be there: a ScenarioError says that one is not
    installed, and a SensorError what else is wrong. A broken type of another package that nobody
    asked for is left out, with a sentence on it.
    """
    names = FAMILY.names()
    for name in asked:
        if name not in names:
            raise ScenarioError(f"sensors: no sensor named {name!r}{nearest(name, names)}")
    needed = {*asked, *(point.name for point in FAMILY.own())}
    types: list[SensorType] = []
    problems: list[str] = []
    for name in names:
        try:
            types.append(load_sensor_type(name))
        except SensorError as error:
            if name in needed:
                raise
            problems.append(f"{error}; there is no such sensor in a run")
    return types, problems


def load_sensor_type(name: str) -> SensorType:
    """Return a sensor type.

    A SensorError says that it cannot be loaded, or that its name or its keys are not a sensor's.
    """
    sensor_type: SensorType = FAMILY.load(name)
    taken = {key.split("/")[0] for key in BUS_MESSAGES} | {"worker", *WORKER_OUTPUTS}
    if name in taken - {point.name for point in FAMILY.own()}:
        raise SensorError(f"a sensor is named {name!r}, and those keys are not a sensor's")
    try:
        declared = dict(sensor_type.messages)
    except Exception as error:
        raise SensorError(
            f"sensor {name!r} does not say what it publishes: {type(error).__name__}: {error}"
        ) from error
    for key, model in declared.items():
        if not str(key).startswith(f"{name}/"):
            raise SensorError(f"sensor {name!r} declares the key {key!r}; expected {name}/...")
        if not (isinstance(model, type) and issubclass(model, Message)):
            raise SensorError(f"sensor {name!r} declares {model!r} on {key!r}; expected a Message")
    return sensor_type
