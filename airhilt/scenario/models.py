"""The models of a scenario file. Unknown fields are refused everywhere."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from airhilt.commands import Command

Callsign = Annotated[str, Field(pattern=r"^[A-Z0-9]{2,8}$", examples=["AAL123"])]
Identifier = Annotated[str, Field(pattern=r"^[A-Za-z0-9_.-]{1,40}$")]
Latitude = Annotated[float, Field(ge=-90.0, le=90.0)]
Longitude = Annotated[float, Field(ge=-180.0, le=180.0)]
Bearing = Annotated[float, Field(ge=0.0, le=360.0, description="degrees from true north")]


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


# --- where --------------------------------------------------------------------------------


class GeodeticPosition(_Model):
    """A WGS84 latitude and longitude."""

    type: Literal["geodetic"]
    lat_deg: Latitude
    lon_deg: Longitude


class RelativePosition(_Model):
    """A bearing and a distance from the scene's centre, then an offset to the right of it.

    ``offset_nm`` is across the line from the centre: positive is clockwise, seen from the centre.
    """

    type: Literal["from_centre"]
    bearing_deg: Bearing
    distance_nm: float = Field(ge=0.0, le=500.0)
    offset_nm: float = Field(default=0.0, ge=-100.0, le=100.0)


Position = Annotated[GeodeticPosition | RelativePosition, Field(discriminator="type")]


class EnRouteScene(_Model):
    """Airspace away from any airport."""

    type: Literal["en_route"]
    centre: GeodeticPosition
    terrain_elevation_ft: float = Field(default=0.0, ge=-1500.0, le=29_000.0)


Scene = Annotated[EnRouteScene, Field()]


# --- who ----------------------------------------------------------------------------------


class InitialState(_Model):
    """Where and how an aircraft begins. It begins in unaccelerated flight."""

    position: Position
    altitude_ft: float = Field(ge=-1500.0, le=60_000.0)
    cas_kt: float = Field(gt=0.0, le=500.0, description="calibrated airspeed")
    track_deg: Bearing | None = Field(
        default=None, description="true track; null: straight to the first point of the route"
    )


class Pilot(_Model):
    """How the crew reacts to an advisory; times are drawn from a lognormal distribution.

    The default median of 5 s is the response to a first resolution advisory in the standard pilot
    model of ICAO Annex 10, volume IV.
    """

    reaction_median_s: float = Field(default=5.0, ge=0.0, le=120.0)
    reaction_sigma: float = Field(default=0.3, ge=0.0, le=2.0)
    compliance: float = Field(
        default=1.0, ge=0.0, le=1.0, description="probability of following an advisory at all"
    )


class Transponder(_Model):
    """What the aircraft says of itself by ADS-B."""

    equipped: bool = True
    nacp: int = Field(default=9, ge=0, le=11)
    nacv: int = Field(default=2, ge=0, le=4)


class AircraftActor(_Model):
    """An aircraft, with its crew."""

    type: Literal["aircraft"]
    callsign: Callsign
    icao24: str = Field(pattern=r"^[0-9a-f]{6}$", description="24-bit address in hexadecimal")
    aircraft: str = Field(description="name of a file in aircraft/, such as 737")
    initial: InitialState
    route: tuple[Position, ...] = Field(
        default=(), max_length=100, description="flown in order, then straight on"
    )
    commands: tuple[Command, ...] = Field(default=(), description="carried out at the start")
    pilot: Pilot = Pilot()
    transponder: Transponder = Transponder()


Actor = Annotated[AircraftActor, Field()]


# --- what is said -------------------------------------------------------------------------


class ScriptedCommand(_Model):
    """What an actor does because of a line, ``delay_s`` after the line has ended."""

    actor: Callsign
    command: Command
    delay_s: float = Field(default=2.0, ge=0.0, le=600.0)


class RadioLine(_Model):
    """One call on a frequency. If the frequency is busy, the call waits until it is free."""

    id: Identifier
    at_s: float = Field(ge=0.0)
    speaker: str = Field(min_length=1, max_length=40, description="a callsign, or a unit's name")
    to: str | None = Field(default=None, description="addressed callsign or unit")
    frequency_khz: int = Field(ge=117_975, le=137_000)
    text: str = Field(min_length=1, max_length=500)
    commands: tuple[ScriptedCommand, ...] = ()


class Radio(_Model):
    """The radio timeline."""

    controller: str = Field(default="Centre", description="name of the unit that listens")
    lines: tuple[RadioLine, ...] = ()
    words_per_minute: float = Field(default=160.0, ge=60.0, le=400.0)


# --- what is sensed -----------------------------------------------------------------------


class AdsbReceiver(_Model):
    """A receiver; it hears what is above its radio horizon and within its range."""

    name: Identifier
    position: Position
    antenna_height_ft: float = Field(default=50.0, ge=-1500.0, le=60_000.0)
    range_nm: float = Field(default=200.0, gt=0.0, le=500.0)


class Adsb(_Model):
    """ADS-B reception. Without a receiver in the list, one stands at the scene's centre."""

    receivers: tuple[AdsbReceiver, ...] = ()
    loss_probability: float = Field(default=0.05, ge=0.0, le=1.0, description="of each squitter")
    outages_s: tuple[tuple[float, float], ...] = Field(
        default=(), description="[from, to] in which nothing at all is received"
    )


class FixedMount(_Model):
    """A camera that stands on the ground."""

    type: Literal["fixed"]
    position: Position
    height_ft: float
    azimuth_deg: Bearing
    elevation_deg: float = Field(default=0.0, ge=-90.0, le=90.0)


class ActorMount(_Model):
    """A camera on an aircraft."""

    type: Literal["actor"]
    actor: Callsign
    station: Literal["nose", "tail"] = "nose"


class Camera(_Model):
    """A camera."""

    name: Identifier
    mount: Annotated[FixedMount | ActorMount, Field(discriminator="type")]
    horizontal_fov_deg: float = Field(default=60.0, gt=0.0, lt=180.0)
    width_px: int = Field(default=640, ge=16, le=4096)
    height_px: int = Field(default=360, ge=16, le=4096)
    rate_hz: float = Field(default=16.0, ge=1.0, le=30.0)


class Wind(_Model):
    """A steady wind, the same everywhere."""

    from_deg: Bearing = 0.0
    speed_kt: float = Field(default=0.0, ge=0.0, le=250.0)


class Turbulence(_Model):
    """MIL-F-8785C turbulence: severity 0 is none, 3 light, 4 moderate, 6 severe."""

    severity: int = Field(default=0, ge=0, le=7)
    wind_at_20ft_kt: float = Field(default=15.0, ge=0.0, le=100.0)


class Weather(_Model):
    """The air."""

    wind: Wind = Wind()
    turbulence: Turbulence = Turbulence()
    visibility_m: float = Field(default=10_000.0, gt=0.0, le=100_000.0)


# --- what makes it a conflict -------------------------------------------------------------

Pair = tuple[Callsign, Callsign]


class TimeReached(_Model):
    """True from a time on."""

    type: Literal["time"]
    at_s: float = Field(ge=0.0)


class PredictedLossOfSeparation(_Model):
    """True while the pair, each flying on as it does, will lose separation within a time.

    True states are extrapolated: horizontally straight on, vertically at the present rate until
    the altitude that the aircraft is really flying to.
    """

    type: Literal["predicted_loss_of_separation"]
    actors: Pair
    within_s: float = Field(gt=0.0, le=1200.0)


class SeparationBelow(_Model):
    """True while the pair is closer than both distances."""

    type: Literal["separation_below"]
    actors: Pair
    horizontal_nm: float = Field(gt=0.0)
    vertical_ft: float = Field(gt=0.0)


class ClosestApproachPassed(_Model):
    """True once the pair's distance has grown for a time without a break."""

    type: Literal["closest_approach_passed"]
    actors: Pair
    for_s: float = Field(default=20.0, gt=0.0, le=600.0)


class BoundForAltitude(_Model):
    """True while the altitude that an actor really flies to, or holds, is this one."""

    type: Literal["bound_for_altitude"]
    actor: Callsign
    altitude_ft: float
    within_ft: float = Field(default=50.0, gt=0.0)


class LineEnded(_Model):
    """True once a radio line has ended."""

    type: Literal["line_ended"]
    line: Identifier


class AllOf(_Model):
    """True when all are."""

    type: Literal["all_of"]
    conditions: tuple[Condition, ...] = Field(min_length=1)


class AnyOf(_Model):
    """True when one is."""

    type: Literal["any_of"]
    conditions: tuple[Condition, ...] = Field(min_length=1)


Condition = Annotated[
    TimeReached
    | PredictedLossOfSeparation
    | SeparationBelow
    | ClosestApproachPassed
    | BoundForAltitude
    | LineEnded
    | AllOf
    | AnyOf,
    Field(discriminator="type"),
]


class Conflict(_Model):
    """The annotation: who is in conflict, and on what condition of the true state it begins."""

    actors: Pair
    opens_when: Condition


class Separation(_Model):
    """Separation minima: lost when both are infringed.

    5 NM and 1000 ft are ICAO Doc 4444, 8.7.3.1 and 5.3.2. The tolerance allows for aircraft that
    keep their level within tens of feet.
    """

    horizontal_nm: float = Field(default=5.0, gt=0.0, le=100.0)
    vertical_ft: float = Field(default=1000.0, gt=0.0, le=10_000.0)
    level_tolerance_ft: float = Field(default=100.0, ge=0.0, le=300.0)


# --- what varies --------------------------------------------------------------------------


class Normal(_Model):
    """A normal distribution, cut off at ``limit`` either side of the mean."""

    type: Literal["normal"]
    sigma: float = Field(gt=0.0)
    limit: float = Field(gt=0.0)


class Uniform(_Model):
    """Anything between ``-limit`` and ``limit`` alike."""

    type: Literal["uniform"]
    limit: float = Field(gt=0.0)


class Perturbation(_Model):
    """A number in this file to which a seeded draw is added.

    ``path`` names it from the top, list entries by their callsign, id or name, or by index:
    ``actors/AAL123/initial/cas_kt``.
    """

    path: str = Field(min_length=1)
    distribution: Annotated[Normal | Uniform, Field(discriminator="type")]


# --- all of it ----------------------------------------------------------------------------


class Scenario(_Model):
    """One scenario file."""

    name: Identifier
    title: str = Field(min_length=1, max_length=120)
    description: str = Field(default="", max_length=4000)
    family: Literal["S01A", "S01B", "S01C", "S02A", "S02B", "S02C"]
    scene: Scene
    duration_s: float = Field(gt=0.0, le=86_400.0, description="the run ends at the latest then")
    actors: tuple[Actor, ...] = Field(min_length=1, max_length=500)
    radio: Radio = Radio()
    adsb: Adsb = Adsb()
    cameras: tuple[Camera, ...] = ()
    weather: Weather = Weather()
    separation: Separation = Separation()
    conflict: Conflict | None = Field(
        default=None, description="null in a nominal scenario: any CAUTION is a nuisance there"
    )
    end_when: tuple[Condition, ...] = Field(default=(), description="the run ends when one is true")
    perturbations: tuple[Perturbation, ...] = ()


AllOf.model_rebuild()
AnyOf.model_rebuild()
