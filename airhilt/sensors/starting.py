"""Start of a run's sensors, and the error of one that fails.

A sensor may be the code of another package. Wherever it fails, the run stops with an error that
names the sensor and the line of its code, and the run folder is complete up to that instant.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from airhilt.errors import AirhiltError, SensorError, blaming, failure_in
from airhilt.messages import Message
from airhilt.plugins import missing
from airhilt.sensors.base import Publish, Sensor, SensorContext, SensorType
from airhilt.sim import Priority, Scheduler, StepRecord
from airhilt.sim.director import Action
from airhilt.units import SECOND_NS


def start_sensors(types: Iterable[SensorType], context: SensorContext) -> list[Sensor]:
    """Start a sensor of each type that has something to do in a run.

    An AirhiltError says that a sensor cannot exist or does not start.
    """
    sensors: list[Sensor] = []
    for sensor_type in types:
        sensor = _create(sensor_type, context)
        if sensor is not None:
            guarded = _GuardedSensor(sensor_type.name, sensor)
            guarded.start()
            sensors.append(guarded)
    return sensors


def _create(sensor_type: SensorType, context: SensorContext) -> Sensor | None:
    name = sensor_type.name
    settings = context.scenario.sensors.get(name)
    given = replace(
        context,
        director=_GuardedDirector(name, context.director),
        publish=_publish_below(name, context.publish),
        settings=settings,
    )
    try:
        sensor = sensor_type.create(given)
    except AirhiltError:
        raise
    except Exception as error:
        raise SensorError(
            f"sensor {name!r} cannot be made with the settings {settings!r}: "
            f"{failure_in(error)}; see sensors/{name} in the scenario"
        ) from error
    if sensor is not None and (lacks := missing(sensor, Sensor)):
        raise SensorError(
            f"sensor {name!r}: what it makes, {sensor!r}, has no {', '.join(lacks)}; expected a "
            "Sensor (airhilt.sensors.base), or None"
        )
    return sensor


@dataclass(frozen=True)
class _GuardedSensor:
    """A sensor whose failures name it."""

    name: str
    sensor: Sensor

    def start(self) -> None:
        with blaming(f"sensor {self.name!r} does not start", SensorError):
            self.sensor.start()

    def unfinished(self) -> Sequence[StepRecord]:
        with blaming(f"sensor {self.name!r} cannot say what is unfinished", SensorError):
            return list(self.sensor.unfinished())


@dataclass(frozen=True)
class _GuardedDirector:
    """The run's director for one sensor: what fails of the actions it schedules names it."""

    name: str
    director: Scheduler

    @property
    def now_ns(self) -> int:
        return self.director.now_ns

    def at(self, t_ns: int, action: Action, priority: Priority) -> None:
        self.director.at(t_ns, self._guarded(action), priority)

    def every(self, period_ns: int, action: Action, priority: Priority, first_ns: int = 0) -> None:
        self.director.every(period_ns, self._guarded(action), priority, first_ns)

    def post(self, action: Action) -> None:
        self.director.post(self._guarded(action))

    def _guarded(self, action: Action) -> Action:
        def guarded() -> None:
            now_s = self.now_ns / SECOND_NS
            with blaming(f"sensor {self.name!r} failed at {now_s:.1f} s", SensorError):
                action()

        return guarded


def _publish_below(name: str, publish: Publish) -> Publish:
    """Return a function that publishes on keys below a name only."""

    def publish_below(key: str, message: Message, *, raw: bytes | None = None) -> None:
        if not key.startswith(f"{name}/"):
            raise SensorError(f"sensor {name!r} published on {key!r}; expected {name}/...")
        publish(key, message, raw=raw)

    return publish_below
