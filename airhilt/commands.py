"""Commands to actors, in scenarios and on ``command/<actor>``.

A command is the meaning of an instruction, without its words and without its addressee.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from airhilt.geodesy.positions import Bearing, Position, RunwayIdent, TaxiwayName
from airhilt.quantities import AltitudeFt, Flag, FrequencyKhz, Name, Number, VerticalRateFpm

Side = Literal["left", "right"]
CircuitLeg = Literal["upwind", "crosswind", "downwind", "base", "final"]


class _Command(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


# --- en route -------------------------------------------------------------------------------


class AltitudeCommand(_Command):
    """Climb or descend to an altitude."""

    action: Literal["altitude"]
    altitude_ft: AltitudeFt
    vertical_rate_fpm: VerticalRateFpm | None = Field(
        default=None, description="null: the usual rate of the aircraft type"
    )


class TrackCommand(_Command):
    """Turn to a true track by the shorter side."""

    action: Literal["track"]
    track_deg: Bearing


class TurnCommand(_Command):
    """Turn by an angle from the present track."""

    action: Literal["turn"]
    degrees: Number = Field(ge=-180.0, le=180.0, description="positive to the right")


class SpeedCommand(_Command):
    """Fly a calibrated airspeed."""

    action: Literal["speed"]
    cas_kt: Number = Field(gt=0.0, le=1000.0)


class MachCommand(_Command):
    """Fly a Mach number."""

    action: Literal["mach"]
    mach: Number = Field(gt=0.0, le=5.0)


class ResumeSpeedCommand(_Command):
    """Fly the usual airspeed of the aircraft type again."""

    action: Literal["resume_speed"]


class VerticalRateCommand(_Command):
    """Climb or descend to the altitude that was told before at another rate."""

    action: Literal["vertical_rate"]
    vertical_rate_fpm: VerticalRateFpm


class CrossFixCommand(_Command):
    """Pass a fix at an altitude, and go on to the altitude that was told before from there."""

    action: Literal["cross_fix"]
    fix: Name
    altitude_ft: AltitudeFt
    bound: Literal["or_more", "or_less"] | None = Field(
        default=None, description="side on which it may be passed too; null: at that altitude"
    )


class RouteCommand(_Command):
    """Fly a route from here, such as a diversion."""

    action: Literal["route"]
    route: tuple[Position, ...] = Field(min_length=1, max_length=100)


class ResumeRouteCommand(_Command):
    """Go back to the route after a turn or a track."""

    action: Literal["resume_route"]


class DirectCommand(_Command):
    """Fly straight to a fix or a navigation aid, and on as before from there."""

    action: Literal["direct"]
    to: Name = Field(description="its name in the scenario")


class OrbitCommand(_Command):
    """Fly a full turn, and go on as before."""

    action: Literal["orbit"]
    turn: Side = "right"


class HoldAtCommand(_Command):
    """Fly to a fix and hold there, in turns to the right unless told otherwise."""

    action: Literal["hold_at"]
    fix: Name
    turn: Side = "right"


class DriftDownCommand(_Command):
    """Descend at drift-down speed after an engine failure, to where the altitude can be kept."""

    action: Literal["drift_down"]


class EmergencyDescentCommand(_Command):
    """Descend as fast as the type can, and level off at an altitude."""

    action: Literal["emergency_descent"]
    altitude_ft: AltitudeFt


# --- to and from a runway -------------------------------------------------------------------

_LEVEL: AltitudeFt | None = Field(
    default=None, description="altitude on the way to the final approach; null: the usual one"
)


class LineUpCommand(_Command):
    """Line up on a runway and wait there."""

    action: Literal["line_up"]
    runway: RunwayIdent


class TakeOffCommand(_Command):
    """Take off, after lining up if necessary, and climb straight out."""

    action: Literal["take_off"]
    runway: RunwayIdent
    climb_to_ft: AltitudeFt = 5000.0
    track_deg: Bearing | None = Field(
        default=None, description="true track after the takeoff; null: that of the runway"
    )


class CancelTakeoffCommand(_Command):
    """Hold the position, or reject a takeoff roll below the decision speed."""

    action: Literal["cancel_takeoff"]


class LandCommand(_Command):
    """Fly to the final approach, through ``via`` if given, land, and vacate the runway."""

    action: Literal["land"]
    runway: RunwayIdent
    via: tuple[Position, ...] = Field(default=(), max_length=20)
    exit: TaxiwayName | None = Field(
        default=None, description="null: the first exit that a normal rollout can take"
    )
    vacate: Flag = Field(default=True, description="false: the aircraft stops on the runway")
    then: Literal["full_stop", "touch_and_go", "stop_and_go", "low_approach"] = "full_stop"
    hold_short: RunwayIdent | None = Field(
        default=None, description="runway that crosses this one, to stop before"
    )
    not_below_ft: AltitudeFt | None = Field(
        default=None, description="of a low approach; null: about 100 ft above the runway"
    )
    level_ft: AltitudeFt | None = _LEVEL


class CancelLandingCommand(_Command):
    """Go on with the approach, without the clearance to land."""

    action: Literal["cancel_landing"]


class GoAroundCommand(_Command):
    """Break off the approach and climb straight out."""

    action: Literal["go_around"]
    climb_to_ft: AltitudeFt = 3000.0


class SideStepCommand(_Command):
    """Change from the final approach of one runway to that of another."""

    action: Literal["side_step"]
    runway: RunwayIdent


class ApproachCommand(_Command):
    """Fly the approach to a runway; this is no clearance to land."""

    action: Literal["approach"]
    runway: RunwayIdent
    kind: Literal["straight_in", "visual", "circling"] = "straight_in"
    level_ft: AltitudeFt | None = _LEVEL


class JoinCommand(_Command):
    """Join the traffic circuit of a runway on one of its legs."""

    action: Literal["join"]
    leg: CircuitLeg
    runway: RunwayIdent
    side: Side | None = Field(
        default=None, description="null: as the circuit is flown already, or left"
    )
    level_ft: AltitudeFt | None = _LEVEL


class ExtendCommand(_Command):
    """Fly on along a leg of the circuit until told to turn."""

    action: Literal["extend"]
    leg: CircuitLeg = "downwind"


class ShortApproachCommand(_Command):
    """Turn from downwind to a final approach as short as is safe."""

    action: Literal["short_approach"]


class ReturnToFieldCommand(_Command):
    """Fly back to the airport, and approach the runway in use there."""

    action: Literal["return_to_field"]


# --- on the ground --------------------------------------------------------------------------


class TaxiCommand(_Command):
    """Taxi, or drive, along the taxiways, and stop at the end.

    The end may be a hold-short position, a node, a place on a runway, or any other place.
    """

    action: Literal["taxi"]
    to: Position
    via: tuple[TaxiwayName, ...] = Field(default=(), max_length=40)
    speed_kt: Number | None = Field(default=None, gt=0.0, le=80.0)
    off_taxiways: Flag = Field(default=False, description="true: in a straight line from here")


class HoldPositionCommand(_Command):
    """Stop at the present place."""

    action: Literal["hold_position"]


class ContinueCommand(_Command):
    """Go on after `HoldPositionCommand`."""

    action: Literal["continue"]


class TaxiToCommand(_Command):
    """Taxi, or drive, to where a controller says, and hold short of each runway on the way.

    The end of the way to a runway is its holding position.
    """

    action: Literal["taxi_to"]
    runway: RunwayIdent | None = None
    place: Name | None = Field(default=None, description="a stand, a holding point or a taxiway")
    via: tuple[TaxiwayName, ...] = Field(default=(), max_length=40)
    cross: tuple[RunwayIdent, ...] = Field(
        default=(), max_length=10, description="runways on the way that may be crossed"
    )
    hold_short: tuple[TaxiwayName, ...] = Field(
        default=(), max_length=10, description="runways and taxiways on the way to stop before"
    )


class HoldShortCommand(_Command):
    """Taxi on as before, and stop before a runway or a taxiway."""

    action: Literal["hold_short"]
    runway: RunwayIdent | None = None
    taxiway: TaxiwayName | None = None


class CrossCommand(_Command):
    """Cross a runway, and go on as before beyond it."""

    action: Literal["cross"]
    runway: RunwayIdent | None = Field(default=None, description="null: the next one ahead")
    at: TaxiwayName | None = None


class EnterCommand(_Command):
    """Drive on to a runway, and stay there until told to leave it."""

    action: Literal["enter"]
    runway: RunwayIdent
    at: TaxiwayName | None = Field(default=None, description="null: where it holds short")


class VacateCommand(_Command):
    """Leave the runway."""

    action: Literal["vacate"]
    exit: TaxiwayName | None = Field(default=None, description="null: the next one")
    side: Side | None = None


class TurnAtCommand(_Command):
    """Turn onto a taxiway: off the runway, or on the way over the taxiways."""

    action: Literal["turn_at"]
    taxiway: TaxiwayName
    side: Side


class BacktrackCommand(_Command):
    """Enter the runway, taxi along it against its direction of use, and line up."""

    action: Literal["backtrack"]
    runway: RunwayIdent


class FollowCommand(_Command):
    """Taxi or fly behind another aircraft or vehicle."""

    action: Literal["follow"]
    whom: Name = Field(description="its callsign, or words for its type")
    hold_short: tuple[TaxiwayName, ...] = Field(
        default=(), max_length=10, description="runways and taxiways on the ground to stop before"
    )


class GiveWayCommand(_Command):
    """Let another aircraft or vehicle pass before going on."""

    action: Literal["give_way"]
    to: Name = Field(description="its callsign, or words for its type")


class PushBackCommand(_Command):
    """Push back from the stand."""

    action: Literal["push_back"]


class BehindCommand(_Command):
    """Carry out another command once other traffic has passed."""

    action: Literal["behind"]
    whom: Name = Field(description="its callsign, or words for its type")
    traffic: Literal["landing", "departing", "passing"] = Field(
        default="passing", description="what it does when it passes"
    )
    command: (
        LineUpCommand
        | TakeOffCommand
        | TaxiToCommand
        | CrossCommand
        | EnterCommand
        | BacktrackCommand
        | ContinueCommand
        | PushBackCommand
        | VacateCommand
    ) = Field(discriminator="action")


# --- on the radio ---------------------------------------------------------------------------


class ContactCommand(_Command):
    """Leave the frequency for that of another unit, and call there."""

    action: Literal["contact"]
    unit: Name | None = Field(default=None, description="null: whoever is on the frequency")
    frequency_khz: FrequencyKhz | None = Field(default=None, description="null: that of the unit")
    calls: Flag = Field(default=True, description="false: it only listens there")


class ReportCommand(_Command):
    """Call the unit and say something, such as "vacated"."""

    action: Literal["report"]
    words: Name


# --- wildlife -------------------------------------------------------------------------------


class MoveCommand(_Command):
    """Move an animal to a place."""

    action: Literal["move"]
    gait: Literal["walk", "run", "fly"]
    to: Position
    height_ft: Number = Field(
        default=60.0, ge=0.0, le=20_000.0, description="of a flight, above the ground"
    )


class StandCommand(_Command):
    """Let an animal stand still."""

    action: Literal["stand"]


AircraftCommand = (
    AltitudeCommand
    | TrackCommand
    | TurnCommand
    | SpeedCommand
    | MachCommand
    | ResumeSpeedCommand
    | VerticalRateCommand
    | CrossFixCommand
    | RouteCommand
    | ResumeRouteCommand
    | DriftDownCommand
    | EmergencyDescentCommand
    | LineUpCommand
    | TakeOffCommand
    | CancelTakeoffCommand
    | LandCommand
    | CancelLandingCommand
    | GoAroundCommand
    | SideStepCommand
    | TaxiCommand
    | HoldPositionCommand
    | ContinueCommand
    | DirectCommand
    | OrbitCommand
    | HoldAtCommand
    | ApproachCommand
    | JoinCommand
    | ExtendCommand
    | ShortApproachCommand
    | ReturnToFieldCommand
    | TaxiToCommand
    | HoldShortCommand
    | CrossCommand
    | EnterCommand
    | VacateCommand
    | TurnAtCommand
    | BacktrackCommand
    | FollowCommand
    | GiveWayCommand
    | PushBackCommand
    | BehindCommand
    | ReportCommand
    | ContactCommand
)
WildlifeCommand = MoveCommand | StandCommand

Command = Annotated[AircraftCommand | WildlifeCommand, Field(discriminator="action")]
