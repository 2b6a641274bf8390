"""The scenario file as a whole, with its conflict and its perturbations."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from airhilt.geodesy.positions import Position
from airhilt.quantities import LONGEST_RUN_S, FileName, Name, Number
from airhilt.scenario.models.actors import ActorSpec, AircraftSpec, WildlifeSpec
from airhilt.scenario.models.base import Callsign, Identifier, Model
from airhilt.scenario.models.conditions import Collided, Condition, Pair, parts
from airhilt.scenario.models.controllers import Controller
from airhilt.scenario.models.failures import Failure
from airhilt.scenario.models.radio import Radio
from airhilt.scenario.models.responses import (
    RESPONSE_MODELS,
    NamedOrOwnModel,
    ResponseModel,
)
from airhilt.scenario.models.scene import Appearance, Daylight, Scene, Weather
from airhilt.scenario.models.sensors import Adsb, Camera, Radar, SurfaceSurveillance

UnassistedOutcome = Literal["collision", "nmac", "runway_incursion", "loss_of_separation"]
GREATEST_DRAW = 1e6
"""Greatest standard deviation and greatest limit of a draw, in the unit of the number."""


class Conflict(Model):
    """Annotated conflict: its actors, the event that begins it, and its window.

    ``begins`` is t_conflict, from which the time to first warning counts. It is the event by which
    the conflict comes about, spoken (`LineBegun`) or physical, and no threshold of an assistant.
    """

    actors: Pair
    begins: Condition | None = Field(
        default=None,
        description="event by which the conflict comes about; null: the opening of its window",
    )
    opens_when: Condition = Field(
        description="opens the window in which the closest approach is taken"
    )
    unassisted: UnassistedOutcome = Field(
        default="loss_of_separation", description="least severe outcome if nobody is warned"
    )


class Separation(Model):
    """Separation minima: lost when both are infringed.

    5 NM and 1000 ft are ICAO Doc 4444, 8.7.3.1 and 5.3.2. The tolerance allows for aircraft that
    keep their level within tens of feet.
    """

    horizontal_nm: Number = Field(default=5.0, gt=0.0, le=100.0)
    vertical_ft: Number = Field(default=1000.0, gt=0.0, le=10_000.0)
    level_tolerance_ft: Number = Field(default=100.0, ge=0.0, le=300.0)


class Normal(Model):
    """Normal distribution around zero; draws beyond ``limit`` either side are set to the limit."""

    type: Literal["normal"]
    sigma: Number = Field(gt=0.0, le=GREATEST_DRAW)
    limit: Number = Field(gt=0.0, le=GREATEST_DRAW)


class Uniform(Model):
    """Uniform distribution between ``least`` and ``limit``."""

    type: Literal["uniform"]
    limit: Number = Field(gt=0.0, le=GREATEST_DRAW)
    least: Number | None = Field(
        default=None, ge=-GREATEST_DRAW, le=0.0, description="null: -limit"
    )


Distribution = Annotated[Normal | Uniform, Field(discriminator="type")]


class Perturbation(Model):
    """Number in this file to which a seeded draw is added, or several numbers, each with its own.

    ``path`` leads to it from the top; list entries are named by callsign, id or name, or by index:
    ``actors/AAL123/initial/cas_kt``. ``*`` stands for every name: ``actors/*/initial/cas_kt``. Of
    two entries for a number the later one counts.
    """

    path: str = Field(min_length=1, max_length=200)
    distribution: Distribution | None = Field(
        default=None, description="null: the usual one of this kind of number"
    )


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
    crews: NamedOrOwnModel = Field(
        default="icao",
        description="response model of crews, drivers and controllers: its name, or a model of "
        "your own",
    )
    fixes: dict[Name, Position] = Field(
        default={},
        max_length=200,
        description="fixes and navigation aids that crews know, by name; they know the airport and "
        "the thresholds of its runways besides",
        examples=[{"LAM": {"type": "geodetic", "lat_deg": 51.65, "lon_deg": 0.15}}],
    )
    radio: Radio = Radio()
    controllers: dict[Name, Controller] = Field(
        default={},
        max_length=100,
        description="simulated controllers by the names of their units; the unit of "
        "`radio.controller`, and every other unit of the script, has the default one",
    )
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
    appearance: Appearance = Appearance()
    separation: Separation = Separation()
    failures: tuple[Failure, ...] = Field(
        default=(),
        max_length=500,
        description="failures of people and equipment; everything else goes as it should",
    )
    conflict: Conflict | None = Field(
        default=None, description="null: nominal scenario, in which every CAUTION is a nuisance"
    )
    nominal_twin: dict[str, JsonValue] | None = Field(
        default=None,
        max_length=50,
        description="values by path (as in ``perturbations``) that, with the failures left out, "
        "make of a scenario with a conflict the same traffic without one; null: it has no twin",
        examples=[{"actors/DAL456/initial/altitude_ft": 36000}],
    )
    end_when: tuple[Condition, ...] = Field(
        default=(), max_length=20, description="the run ends when one is true"
    )
    perturbations: tuple[Perturbation, ...] = Field(default=(), max_length=500)

    @property
    def response_model(self) -> ResponseModel:
        """Response model of crews, drivers and controllers."""
        return RESPONSE_MODELS[self.crews] if isinstance(self.crews, str) else self.crews

    @property
    def pair(self) -> Pair | None:
        """The actors of the conflict, in the order in which the actors are listed."""
        if self.conflict is None:
            return None
        order = [actor.callsign for actor in self.actors]
        first, second = sorted(self.conflict.actors, key=order.index)
        return first, second

    @property
    def causes(self) -> list[Pair]:
        """The pairs whose collision begins the conflict, such as an aircraft and a flock."""
        begins = None if self.conflict is None else self.conflict.begins
        found = () if begins is None else parts(begins)
        return [each.actors for each in found if isinstance(each, Collided)]

    @property
    def roster(self) -> tuple[str, ...]:
        """Callsigns on the roster of the briefing."""
        return tuple(
            actor.callsign
            for actor in self.actors
            if not isinstance(actor, WildlifeSpec)
            and (not isinstance(actor, AircraftSpec) or actor.on_roster)
        )

    @property
    def callsigns(self) -> dict[str, str]:
        """Callsign of each actor by its callsign and by its 24-bit address."""
        return {actor.callsign: actor.callsign for actor in self.actors} | {
            actor.icao24: actor.callsign
            for actor in self.actors
            if not isinstance(actor, WildlifeSpec)
        }
