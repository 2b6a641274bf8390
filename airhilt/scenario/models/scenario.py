"""The scenario file as a whole."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, JsonValue

from airhilt.quantities import LONGEST_RUN_S, FileName, Name, Number
from airhilt.scenario.models.actors import ActorSpec
from airhilt.scenario.models.adsb import Adsb
from airhilt.scenario.models.base import Callsign, Identifier, Model
from airhilt.scenario.models.cameras import Camera
from airhilt.scenario.models.conditions import Condition
from airhilt.scenario.models.conflict import Conflict, Separation
from airhilt.scenario.models.failures import Failure
from airhilt.scenario.models.perturbations import Perturbation
from airhilt.scenario.models.radar import Radar
from airhilt.scenario.models.radio import Radio
from airhilt.scenario.models.scene import Scene
from airhilt.scenario.models.surface import SurfaceSurveillance
from airhilt.scenario.models.weather import Daylight, Weather


class Scenario(Model):
    """A scenario file."""

    schema_reference: str | None = Field(
        default=None,
        max_length=500,
        alias="$schema",
        exclude=True,
        description="path or URL of this schema, for editors; a run ignores it",
    )
    name: Identifier
    title: str = Field(min_length=1, max_length=120)
    description: str = Field(default="", max_length=4000)
    family: Literal["S01A", "S01B", "S01C", "S02A", "S02B", "S02C"]
    scene: Scene
    duration_s: Number = Field(gt=0.0, le=LONGEST_RUN_S, description="latest end of the run")
    actors: tuple[ActorSpec, ...] = Field(min_length=1, max_length=500)
    radio: Radio = Radio()
    adsb: Adsb = Adsb()
    cameras: tuple[Camera, ...] = Field(default=(), max_length=100)
    radars: tuple[Radar, ...] = Field(default=(), max_length=20)
    surface_surveillance: SurfaceSurveillance | None = Field(
        default=None,
        description="radar and multilateration of the airport's surface; null: only if an "
        "assistant needs them",
    )
    cockpits: tuple[Callsign, ...] = Field(
        default=(), max_length=500, description="aircraft whose instruments are published"
    )
    tcas: tuple[Callsign, ...] = Field(
        default=(),
        max_length=500,
        description="aircraft whose TCAS II interrogates others; the replies are published",
    )
    equipment: tuple[Name, ...] = Field(
        default=(),
        max_length=20,
        description="decision engines that are in the world besides the assistant under test",
        examples=[["tcas", "conflict_alert"]],
    )
    sensors: dict[Identifier, dict[str, JsonValue]] = Field(
        default={},
        max_length=50,
        description="settings of sensors from other packages, by the sensor's name",
    )
    files: dict[FileName, dict[str, JsonValue]] = Field(
        default={},
        max_length=50,
        description="airports and types of aircraft that this scenario brings along, by the name "
        "that it has for each, such as kaus.json; those beside its file are read by themselves",
    )
    weather: Weather = Weather()
    daylight: Daylight = Daylight()
    separation: Separation = Separation()
    failures: tuple[Failure, ...] = Field(
        default=(),
        max_length=500,
        description="failures of people and equipment; everything else goes as it should",
    )
    conflict: Conflict | None = Field(
        default=None, description="null: nominal scenario, in which every CAUTION is a nuisance"
    )
    end_when: tuple[Condition, ...] = Field(
        default=(), max_length=20, description="the run ends when one is true"
    )
    perturbations: tuple[Perturbation, ...] = Field(default=(), max_length=500)
