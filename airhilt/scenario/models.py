"""The models of a scenario file. Unknown fields are refused everywhere."""

from __future__ import annotations

import datetime
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from airhilt.commands import AircraftCommand, Command, VehicleCommand, WildlifeCommand
from airhilt.geodesy.positions import Bearing, GeodeticPosition, Position, RunwayIdent, TaxiwayName
from airhilt.imaging.lenses import FieldOfView, SidePx
from airhilt.scenario import radio_profiles as profiles

Callsign = Annotated[str, Field(pattern=r"^[A-Z0-9]{2,8}$", examples=["AAL123"])]
Identifier = Annotated[str, Field(pattern=r"^[A-Za-z0-9_.-]{1,40}$")]
CameraName = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,39}$")]
"""Files are named after cameras."""


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


# --- where --------------------------------------------------------------------------------


class EnRouteScene(_Model):
    """Airspace away from any airport."""

    type: Literal["en_route"]
    centre: GeodeticPosition
    terrain_elevation_ft: float = Field(default=0.0, ge=-1500.0, le=29_000.0)


class AirportScene(_Model):
    """An airport and the airspace around it; its reference point is the scene's centre.

    The ground is flat, at the airport's elevation.
    """

    type: Literal["airport"]
    airport: str = Field(min_length=1, max_length=10, examples=["KDCA"])


Scene = Annotated[EnRouteScene | AirportScene, Field(discriminator="type")]


# --- who ----------------------------------------------------------------------------------


class Airborne(_Model):
    """In unaccelerated flight."""

    type: Literal["airborne"]
    position: Position
    altitude_ft: float = Field(ge=-1500.0, le=60_000.0)
    cas_kt: float = Field(gt=0.0, le=500.0, description="calibrated airspeed")
    track_deg: Bearing | None = Field(
        default=None, description="true track; null: straight to the first point of the route"
    )


class OnFinal(_Model):
    """On final approach to a runway, on the glide path, configured to land."""

    type: Literal["final"]
    runway: RunwayIdent
    distance_nm: float = Field(ge=1.0, le=15.0, description="to the landing threshold")


class LinedUp(_Model):
    """Standing on a runway, lined up."""

    type: Literal["lined_up"]
    runway: RunwayIdent


class HoldingShort(_Model):
    """Standing at a hold-short position, or so many metres before it."""

    type: Literal["hold_short"]
    runway: RunwayIdent
    taxiway: TaxiwayName
    before_m: float = Field(default=0.0, ge=0.0, le=2000.0)


class Standing(_Model):
    """Standing on the ground."""

    type: Literal["standing"]
    position: Position
    heading_deg: Bearing = Field(default=0.0, description="true")


AircraftStart = Annotated[
    Airborne | OnFinal | LinedUp | HoldingShort | Standing, Field(discriminator="type")
]
GroundStart = Annotated[LinedUp | HoldingShort | Standing, Field(discriminator="type")]


class Reactions(_Model):
    """How a crew or a driver reacts to an advisory; times are drawn lognormally.

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


AircraftAction = Annotated[AircraftCommand, Field(discriminator="action")]
VehicleAction = Annotated[VehicleCommand, Field(discriminator="action")]
WildlifeAction = Annotated[WildlifeCommand, Field(discriminator="action")]


class AircraftSpec(_Model):
    """An aircraft, with its crew."""

    type: Literal["aircraft"]
    callsign: Callsign
    icao24: str = Field(pattern=r"^[0-9a-f]{6}$", description="24-bit address in hexadecimal")
    aircraft: str = Field(description="name of a file in aircraft/, such as 737")
    initial: AircraftStart
    route: tuple[Position, ...] = Field(
        default=(), max_length=100, description="flown in order, then straight on"
    )
    commands: tuple[AircraftAction, ...] = Field(default=(), description="carried out at the start")
    pilot: Reactions = Reactions()
    transponder: Transponder = Transponder()
    on_roster: bool = Field(
        default=True, description="false: nobody expects it, and it is on no frequency"
    )


class VehicleSpec(_Model):
    """A ground vehicle, with its driver."""

    type: Literal["vehicle"]
    callsign: Callsign
    icao24: str = Field(pattern=r"^[0-9a-f]{6}$", description="24-bit address in hexadecimal")
    kind: str = Field(description="such as follow_me", examples=["fire_truck"])
    initial: GroundStart
    commands: tuple[VehicleAction, ...] = Field(default=(), description="carried out at the start")
    driver: Reactions = Reactions(reaction_median_s=2.5)
    transponder: Transponder = Transponder(equipped=False)


class Cue(_Model):
    """What an animal does once a condition is true."""

    when: Condition
    command: WildlifeAction


class WildlifeSpec(_Model):
    """An animal, or a flock; nobody tells it what to do."""

    type: Literal["wildlife"]
    callsign: Callsign = Field(description="its name in this scenario", examples=["DEER1"])
    kind: str = Field(description="such as deer", examples=["flock"])
    initial: Standing
    height_ft: float = Field(
        default=0.0, ge=0.0, le=20_000.0, description="above the ground, for what flies at first"
    )
    plan: tuple[Cue, ...] = Field(default=(), max_length=20)
    startles_within_m: float = Field(
        default=0.0, ge=0.0, le=1000.0, description="flees what comes nearer; 0: never"
    )


ActorSpec = Annotated[AircraftSpec | VehicleSpec | WildlifeSpec, Field(discriminator="type")]


# --- what is said -------------------------------------------------------------------------


class ScriptedCommand(_Model):
    """What a line means for an actor: carried out ``delay_s`` after the line has ended.

    With a condition, once that is true as well: "behind the landing traffic, line up".
    """

    actor: Callsign
    command: Command
    delay_s: float = Field(default=2.0, ge=0.0, le=600.0)
    when: Condition | None = None


class RadioLine(_Model):
    """One call on a frequency. If the frequency is busy, the call waits until it is free."""

    id: Identifier
    at_s: float = Field(default=0.0, ge=0.0, description="not before this time")
    when: Condition | None = Field(default=None, description="and not before this is true")
    speaker: str = Field(min_length=1, max_length=40, description="a callsign, or a unit's name")
    to: str | None = Field(default=None, description="addressed callsign or unit")
    frequency_khz: int = Field(
        ge=117_975, le=137_000, description="name of a channel with 25 or 8.33 kHz spacing"
    )
    text: str = Field(min_length=1, max_length=500)
    commands: tuple[ScriptedCommand, ...] = ()
    answers: Identifier | None = Field(
        default=None,
        description="the line that it answers; null: an actor reads back the line before on the "
        "frequency, if that was from whom this is for and for whom this is from",
    )


Topology = Literal["parallel", "asr_first", "gated_fusion"]


class Radio(_Model):
    """The radio timeline, and how well people hear each other."""

    controller: str = Field(default="Centre", description="name of the unit that listens")
    lines: tuple[RadioLine, ...] = ()
    words_per_minute: float = Field(
        default=160.0, ge=60.0, le=400.0, description="of calls without sound"
    )
    snr_db: float | None = Field(
        default=None, ge=-30.0, le=60.0, description="of what is received; null: nobody mishears"
    )
    squelch_db: float = Field(
        default=-10.0, ge=-30.0, le=60.0, description="SNR below which receivers stay silent"
    )
    profile: Annotated[str, AfterValidator(profiles.checked)] | None = Field(
        default=None,
        description="named settings of the radio channel, or a learned channel, FILE.onnx",
    )
    topology: Topology = Field(
        default="parallel",
        description="parallel: crews hear the radio, as the assistant does; asr_first: crews get "
        "the transcript instead; gated_fusion: as parallel, and the assistant says nothing while "
        "it has not taken in all that was said",
    )
    overhearing: bool = Field(
        default=True,
        description="crews that get transcripts may take one of a call to others for their own",
    )
    phraseology: Literal["faa", "icao"] = Field(
        default="faa", description="of what is not in the script"
    )
    readbacks: Literal["scripted", "generated"] = Field(
        default="scripted",
        description="generated: crews also read back instructions that no line answers",
    )
    controller_checks_readbacks: bool = Field(
        default=False,
        description="controllers correct a wrong readback, and repeat what is not answered even "
        "where a failure is why",
    )


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

    name: CameraName
    mount: Annotated[FixedMount | ActorMount, Field(discriminator="type")]
    horizontal_fov_deg: FieldOfView = 60.0
    width_px: SidePx = 640
    height_px: SidePx = 360
    rate_hz: float = Field(default=16.0, ge=1.0, le=30.0)
    phase_s: float = Field(
        default=0.0, ge=0.0, lt=1.0, description="end of its first exposure after the start"
    )

    @property
    def carrier(self) -> str | None:
        """The actor that carries it; None if it stands."""
        return self.mount.actor if isinstance(self.mount, ActorMount) else None


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
    rain_mm_h: float = Field(default=0.0, ge=0.0, le=150.0, description="rate of rainfall")


class Daylight(_Model):
    """When cameras look; the sun stays where it is then."""

    date: datetime.date = datetime.date(2026, 5, 1)
    solar_time_h: float = Field(
        default=10.0, ge=0.0, lt=24.0, description="local solar time: the sun is highest at 12"
    )


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


class InPhase(_Model):
    """True while an actor is in one of some phases, such as ``takeoff_roll`` or ``standing``."""

    type: Literal["in_phase"]
    actor: Callsign
    phases: tuple[str, ...] = Field(min_length=1)


class BoundForRunway(_Model):
    """True while the runway that a crew really means to land on or take off from is this one."""

    type: Literal["bound_for_runway"]
    actor: Callsign
    runway: RunwayIdent


class OnRunway(_Model):
    """True while an actor is on the ground in the protected area of a runway."""

    type: Literal["on_runway"]
    actor: Callsign
    runway: RunwayIdent


class ThresholdWithin(_Model):
    """True while an airborne aircraft bound for a runway is within a time of its threshold."""

    type: Literal["threshold_within"]
    actor: Callsign
    runway: RunwayIdent
    within_s: float = Field(gt=0.0, le=1200.0)


class SpeedAbove(_Model):
    """True while an actor's ground speed is above a value."""

    type: Literal["speed_above"]
    actor: Callsign
    speed_kt: float = Field(ge=0.0)


class HeightBelow(_Model):
    """True while an actor is lower above the ground than a value."""

    type: Literal["height_below"]
    actor: Callsign
    height_ft: float = Field(gt=0.0)


class DistanceBelow(_Model):
    """True while two actors are nearer to each other over the ground than a distance."""

    type: Literal["distance_below"]
    actors: Pair
    distance_m: float = Field(gt=0.0)


class Collided(_Model):
    """True once two actors have touched."""

    type: Literal["collided"]
    actors: Pair


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
    | InPhase
    | BoundForRunway
    | OnRunway
    | ThresholdWithin
    | SpeedAbove
    | HeightBelow
    | DistanceBelow
    | Collided
    | LineEnded
    | AllOf
    | AnyOf,
    Field(discriminator="type"),
]


UnassistedOutcome = Literal["collision", "nmac", "runway_incursion", "loss_of_separation"]


class Conflict(_Model):
    """The annotation: who is in conflict, and on what condition of the true state it begins."""

    actors: Pair
    opens_when: Condition
    unassisted: UnassistedOutcome = Field(
        default="loss_of_separation", description="what happens at least if nobody is warned"
    )


class Separation(_Model):
    """Separation minima: lost when both are infringed.

    5 NM and 1000 ft are ICAO Doc 4444, 8.7.3.1 and 5.3.2. The tolerance allows for aircraft that
    keep their level within tens of feet.
    """

    horizontal_nm: float = Field(default=5.0, gt=0.0, le=100.0)
    vertical_ft: float = Field(default=1000.0, gt=0.0, le=10_000.0)
    level_tolerance_ft: float = Field(default=100.0, ge=0.0, le=300.0)


# --- what goes wrong ----------------------------------------------------------------------


class ReadbackWrong(_Model):
    """A crew or driver reads back, and does, something else than it was told."""

    type: Literal["readback_wrong"]
    line: Identifier = Field(description="the readback")
    text: str = Field(min_length=1, max_length=500, description="what is said instead")
    commands: tuple[ScriptedCommand, ...] = Field(description="what is done instead")


class NotReceived(_Model):
    """An actor does not hear a line."""

    type: Literal["not_received"]
    line: Identifier
    actor: Callsign


class CallsignConfused(_Model):
    """What a line means for one actor is taken by another."""

    type: Literal["callsign_confused"]
    line: Identifier
    meant: Callsign
    taken_by: Callsign
    text: str | None = Field(default=None, description="what is said, if that is the confusion")


class Delayed(_Model):
    """A line comes late."""

    type: Literal["delayed"]
    line: Identifier
    by_s: float = Field(gt=0.0, le=600.0)


class Dropped(_Model):
    """A line is never said."""

    type: Literal["dropped"]
    line: Identifier


class Ignored(_Model):
    """An actor hears a line and does not do what it says."""

    type: Literal["ignored"]
    line: Identifier
    actor: Callsign


class Blocked(_Model):
    """A line is said without listening first, over whatever is being said."""

    type: Literal["blocked"]
    line: Identifier


class StuckMicrophone(_Model):
    """An actor's transmitter stays on, on all frequencies that it is on: nobody else is heard."""

    type: Literal["stuck_microphone"]
    actor: Callsign
    at_s: float = Field(ge=0.0)
    for_s: float = Field(gt=0.0, le=3600.0)


class EngineFailure(_Model):
    """An engine stops."""

    type: Literal["engine_failure"]
    actor: Callsign
    engine: int = Field(ge=0, le=7, description="from the left, beginning with 0")
    when: Condition


Failure = Annotated[
    ReadbackWrong
    | NotReceived
    | CallsignConfused
    | Delayed
    | Dropped
    | Ignored
    | Blocked
    | StuckMicrophone
    | EngineFailure,
    Field(discriminator="type"),
]


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
    actors: tuple[ActorSpec, ...] = Field(min_length=1, max_length=500)
    radio: Radio = Radio()
    adsb: Adsb = Adsb()
    cameras: tuple[Camera, ...] = ()
    weather: Weather = Weather()
    daylight: Daylight = Daylight()
    separation: Separation = Separation()
    failures: tuple[Failure, ...] = Field(
        default=(), description="all that goes wrong; everything else is as it should be"
    )
    conflict: Conflict | None = Field(
        default=None, description="null in a nominal scenario: any CAUTION is a nuisance there"
    )
    end_when: tuple[Condition, ...] = Field(default=(), description="the run ends when one is true")
    perturbations: tuple[Perturbation, ...] = ()


for _model in (
    AllOf,
    AnyOf,
    Cue,
    WildlifeSpec,
    VehicleSpec,
    AircraftSpec,
    ScriptedCommand,
    RadioLine,
    Radio,
    EngineFailure,
    Scenario,
):
    _model.model_rebuild()
