"""What an actor can be told to do, in scenarios and on ``command/<actor>``.

A command is the meaning of an instruction, without its words: the callsign is that of the actor
that gets it, everything else stands here.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from airhilt.geodesy.positions import Position, RunwayIdent, TaxiwayName


class _Command(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


# --- en route -------------------------------------------------------------------------------


class AltitudeCommand(_Command):
    """Climb or descend to an altitude."""

    action: Literal["altitude"]
    altitude_ft: float
    vertical_rate_fpm: float | None = Field(
        default=None, gt=0.0, description="null: what the aircraft type climbs or descends at"
    )


class TrackCommand(_Command):
    """Turn the shorter way to a true track."""

    action: Literal["track"]
    track_deg: float = Field(ge=0.0, le=360.0)


class TurnCommand(_Command):
    """Turn by an angle from the present track."""

    action: Literal["turn"]
    degrees: float = Field(ge=-180.0, le=180.0, description="positive to the right")


class SpeedCommand(_Command):
    """Fly a calibrated airspeed."""

    action: Literal["speed"]
    cas_kt: float = Field(gt=0.0)


class RouteCommand(_Command):
    """Fly a route from here, such as a diversion."""

    action: Literal["route"]
    route: tuple[Position, ...] = Field(min_length=1, max_length=100)


class ResumeRouteCommand(_Command):
    """Go back to the route that a turn left."""

    action: Literal["resume_route"]


class DriftDownCommand(_Command):
    """After an engine failure: hold the drift-down speed, and level where that can be kept."""

    action: Literal["drift_down"]


class EmergencyDescentCommand(_Command):
    """Descend as fast as the type can, and level off."""

    action: Literal["emergency_descent"]
    altitude_ft: float


# --- to and from a runway -------------------------------------------------------------------


class LineUpCommand(_Command):
    """Line up on a runway and wait there."""

    action: Literal["line_up"]
    runway: RunwayIdent


class TakeOffCommand(_Command):
    """Take off, lining up first where that is not done yet; climb straight out."""

    action: Literal["take_off"]
    runway: RunwayIdent
    climb_to_ft: float = 5000.0


class CancelTakeoffCommand(_Command):
    """Hold the position, or, rolling below the decision speed, reject the takeoff."""

    action: Literal["cancel_takeoff"]


class LandCommand(_Command):
    """Fly to the final approach, over ``via`` if need be, land, and vacate."""

    action: Literal["land"]
    runway: RunwayIdent
    via: tuple[Position, ...] = Field(default=(), max_length=20)
    exit: TaxiwayName | None = Field(
        default=None, description="null: the first that can be made in a normal rollout"
    )
    vacate: bool = Field(default=True, description="false: it comes to a stand on the runway")


class GoAroundCommand(_Command):
    """Break the approach off and climb straight out."""

    action: Literal["go_around"]
    climb_to_ft: float = 3000.0


class SideStepCommand(_Command):
    """On final, change over to another runway."""

    action: Literal["side_step"]
    runway: RunwayIdent


# --- on the ground --------------------------------------------------------------------------


class TaxiCommand(_Command):
    """Taxi, or drive, along the taxiways; stop at the end.

    The end may be a hold-short position, a node, a place on a runway, or any other.
    """

    action: Literal["taxi"]
    to: Position
    via: tuple[TaxiwayName, ...] = ()
    speed_kt: float | None = Field(default=None, gt=0.0, le=80.0)
    off_taxiways: bool = Field(default=False, description="in a straight line from here")


class HoldPositionCommand(_Command):
    """Stop where you are."""

    action: Literal["hold_position"]


class ContinueCommand(_Command):
    """Go on after holding the position."""

    action: Literal["continue"]


# --- wildlife -------------------------------------------------------------------------------


class MoveCommand(_Command):
    """An animal moves to a place."""

    action: Literal["move"]
    gait: Literal["walk", "run", "fly"]
    to: Position
    height_ft: float = Field(default=60.0, ge=0.0, le=20_000.0, description="of a flight")


class StandCommand(_Command):
    """An animal stands still."""

    action: Literal["stand"]


AircraftCommand = (
    AltitudeCommand
    | TrackCommand
    | TurnCommand
    | SpeedCommand
    | RouteCommand
    | ResumeRouteCommand
    | DriftDownCommand
    | EmergencyDescentCommand
    | LineUpCommand
    | TakeOffCommand
    | CancelTakeoffCommand
    | LandCommand
    | GoAroundCommand
    | SideStepCommand
    | TaxiCommand
    | HoldPositionCommand
    | ContinueCommand
)
VehicleCommand = TaxiCommand | HoldPositionCommand | ContinueCommand
WildlifeCommand = MoveCommand | StandCommand

Command = Annotated[AircraftCommand | WildlifeCommand, Field(discriminator="action")]
