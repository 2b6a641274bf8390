"""Actors of a scenario: aircraft, ground vehicles and wildlife."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from airhilt.commands import AircraftCommand, Command
from airhilt.geodesy.positions import (
    Bearing,
    Latitude,
    Longitude,
    Position,
    RunwayIdent,
    TaxiwayName,
)
from airhilt.messages import EmergencyState, TransponderMode
from airhilt.quantities import AltitudeFt, Count, FileName, Flag, Name, Number, Share, TimeS
from airhilt.scenario.models.base import MOST_COMMANDS, Callsign, Model
from airhilt.scenario.models.conditions import Condition


class Airborne(Model):
    """Start in unaccelerated flight."""

    type: Literal["airborne"]
    position: Position
    altitude_ft: AltitudeFt
    cas_kt: Number = Field(gt=0.0, le=500.0, description="calibrated airspeed")
    track_deg: Bearing | None = Field(
        default=None, description="true track; null: straight to the first point of the route"
    )


class OnFinal(Model):
    """Start on final approach to a runway, on the glide path, configured to land."""

    type: Literal["final"]
    runway: RunwayIdent
    distance_nm: Number = Field(ge=1.0, le=15.0, description="to the landing threshold")


class LinedUp(Model):
    """Start on a runway, lined up and standing."""

    type: Literal["lined_up"]
    runway: RunwayIdent


class HoldingShort(Model):
    """Start at a hold-short position, or ``before_m`` metres before it, standing."""

    type: Literal["hold_short"]
    runway: RunwayIdent
    taxiway: TaxiwayName
    before_m: Number = Field(default=0.0, ge=0.0, le=2000.0)


class Standing(Model):
    """Start on the ground, standing."""

    type: Literal["standing"]
    position: Position
    heading_deg: Bearing = Field(default=0.0, description="true")


MOST_POINTS = 20_000
"""Greatest number of points of a track."""
Point = Annotated[
    tuple[TimeS, Latitude, Longitude, AltitudeFt | None],
    Field(
        description="seconds since the start of the run, latitude and longitude in degrees, and "
        "altitude in ft in the standard atmosphere; null: on the ground"
    ),
]


class OnTrack(Model):
    """Follow a recorded track until a command, or an advisory that the crew follows.

    The aircraft is in the world from the first point to the last; one that ends on the ground
    stays there.
    """

    type: Literal["track"]
    points: tuple[Point, ...] = Field(
        min_length=2, max_length=MOST_POINTS, description="in order of time"
    )


AircraftStart = Annotated[
    Airborne | OnFinal | LinedUp | HoldingShort | Standing | OnTrack, Field(discriminator="type")
]
GroundStart = Annotated[LinedUp | HoldingShort | Standing, Field(discriminator="type")]


class Reactions(Model):
    """Reaction of one crew or driver, in place of what the response model of the scenario says.

    The reaction time is lognormal; null: as the response model has it.
    """

    reaction_median_s: Number | None = Field(default=None, ge=0.0, le=120.0)
    reaction_sigma: Number | None = Field(default=None, ge=0.0, le=2.0)
    compliance: Share | None = Field(
        default=None, description="probability of responding at all, on every channel"
    )


class Transponder(Model):
    """Transponder of an actor: it answers radars and TCAS, and it transmits ADS-B."""

    equipped: Flag = True
    mode: TransponderMode = Field(
        default="S", description="S: with ADS-B; C: Modes A and C alone, which transmit no ADS-B"
    )
    nacp: Count = Field(default=9, ge=0, le=11, description="ADS-B accuracy category for position")
    nacv: Count = Field(default=2, ge=0, le=4, description="ADS-B accuracy category for velocity")
    nic: Count = Field(default=8, ge=0, le=11, description="ADS-B integrity category of positions")
    sil: Count = Field(default=3, ge=0, le=3, description="ADS-B source integrity level")
    squawk: str | None = Field(
        default=None,
        pattern=r"^[0-7]{4}$",
        description="Mode A code, octal; null: a discrete code made from the icao24; "
        "a crew that begins a drift-down or an emergency descent sets 7700",
    )
    emergency: EmergencyState | None = Field(
        default=None,
        description="ADS-B emergency or priority status; null: what the squawk says, if it is "
        "7500, 7600 or 7700",
    )

    @property
    def has_adsb(self) -> bool:
        """True if it transmits ADS-B."""
        return self.equipped and self.mode == "S"


AircraftAction = Annotated[AircraftCommand, Field(discriminator="action")]


class AircraftSpec(Model):
    """An aircraft, with its crew."""

    type: Literal["aircraft"]
    callsign: Callsign
    icao24: str = Field(pattern=r"^[0-9a-f]{6}$", description="24-bit address in hexadecimal")
    aircraft: FileName = Field(
        description="name of a file in aircraft/, such as 737, or a file beside the scenario"
    )
    initial: AircraftStart
    load: Number = Field(
        default=0.0,
        ge=-0.1,
        le=0.1,
        description="mass above that of the model of the type, as a part of its empty mass",
    )
    route: tuple[Position, ...] = Field(
        default=(), max_length=100, description="waypoints flown in order; then straight on"
    )
    commands: tuple[AircraftAction, ...] = Field(
        default=(), max_length=MOST_COMMANDS, description="carried out at the start"
    )
    pilot: Reactions = Reactions()
    transponder: Transponder = Transponder()
    adsb_in: Flag = Field(
        default=True, description="a person at its controls is shown the ADS-B of others"
    )
    on_roster: Flag = Field(
        default=True, description="false: no controller expects it, and it is on no frequency"
    )


class VehicleSpec(Model):
    """A ground vehicle, with its driver."""

    type: Literal["vehicle"]
    callsign: Callsign
    icao24: str = Field(pattern=r"^[0-9a-f]{6}$", description="24-bit address in hexadecimal")
    kind: Name = Field(description="such as follow_me", examples=["fire_truck"])
    initial: GroundStart
    commands: tuple[Command, ...] = Field(
        default=(),
        max_length=MOST_COMMANDS,
        description="carried out at the start; the kind says which it understands",
    )
    driver: Reactions = Reactions()
    transponder: Transponder = Transponder(equipped=False)
    adsb_in: Flag = Field(
        default=False,
        description="the driver is shown the ADS-B of others on the moving map; a vehicle has no "
        "receiver unless it is fitted with one",
    )


class PlannedAction(Model):
    """Action of an animal, carried out once a condition is true."""

    when: Condition
    command: Command


class WildlifeSpec(Model):
    """An animal, or a flock. It follows its plan; it takes no commands from people."""

    type: Literal["wildlife"]
    callsign: Callsign = Field(description="its name in this scenario", examples=["DEER1"])
    kind: Name = Field(description="such as deer", examples=["flock"])
    initial: Standing
    height_ft: Number = Field(
        default=0.0,
        ge=0.0,
        le=20_000.0,
        description="above the ground, of an animal that is flying at the start",
    )
    plan: tuple[PlannedAction, ...] = Field(default=(), max_length=20)
    startles_within_m: Number = Field(
        default=0.0,
        ge=0.0,
        le=1000.0,
        description="flees from what comes nearer than this; 0: never",
    )


ActorSpec = Annotated[AircraftSpec | VehicleSpec | WildlifeSpec, Field(discriminator="type")]
