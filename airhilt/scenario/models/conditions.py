"""Conditions on the true state, by which a scenario says when something happens."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from airhilt.commands import CircuitLeg
from airhilt.geodesy.positions import Bearing, RunwayIdent
from airhilt.quantities import AltitudeFt, Flag, Name, Number, SpeedKt, TimeS
from airhilt.scenario.models.base import Callsign, Identifier, Model

Pair = tuple[Callsign, Callsign]


class TimeReached(Model):
    """True from a time onwards."""

    type: Literal["time"]
    at_s: TimeS


class PredictedLossOfSeparation(Model):
    """True while a pair that flies on as it does will lose separation, if given within a time.

    The true states are extrapolated: horizontally straight on, vertically at the present rate
    until the altitude that the aircraft is really flying to.
    """

    type: Literal["predicted_loss_of_separation"]
    actors: Pair
    within_s: Number | None = Field(
        default=None, gt=0.0, le=1200.0, description="null: however far ahead"
    )


class SeparationBelow(Model):
    """True while the pair is closer than both distances."""

    type: Literal["separation_below"]
    actors: Pair
    horizontal_nm: Number = Field(gt=0.0, le=500.0)
    vertical_ft: Number = Field(gt=0.0, le=60_000.0)


class ClosestApproachPassed(Model):
    """True once the pair's distance has grown for a time without a break."""

    type: Literal["closest_approach_passed"]
    actors: Pair
    for_s: Number = Field(default=20.0, gt=0.0, le=600.0)


class BoundForAltitude(Model):
    """True while the altitude that an actor really flies to, or holds, is this one."""

    type: Literal["bound_for_altitude"]
    actor: Callsign
    altitude_ft: AltitudeFt
    within_ft: Number = Field(default=50.0, gt=0.0, le=60_000.0)


class InPhase(Model):
    """True while an actor is in one of some phases, such as ``takeoff_roll`` or ``standing``."""

    type: Literal["in_phase"]
    actor: Callsign
    phases: tuple[Name, ...] = Field(min_length=1, max_length=20)


class BoundForRunway(Model):
    """True while the runway that a crew really means to land on or take off from is this one."""

    type: Literal["bound_for_runway"]
    actor: Callsign
    runway: RunwayIdent


class OnRunway(Model):
    """True while an actor is on the ground in the protected area of a runway."""

    type: Literal["on_runway"]
    actor: Callsign
    runway: RunwayIdent


class ThresholdWithin(Model):
    """True while an airborne aircraft bound for a runway is within a time of its threshold."""

    type: Literal["threshold_within"]
    actor: Callsign
    runway: RunwayIdent
    within_s: Number = Field(gt=0.0, le=1200.0)


class SpeedAbove(Model):
    """True while an actor's ground speed is above a value."""

    type: Literal["speed_above"]
    actor: Callsign
    speed_kt: SpeedKt


class HeightBelow(Model):
    """True while an actor is lower above the ground than a value."""

    type: Literal["height_below"]
    actor: Callsign
    height_ft: Number = Field(gt=0.0, le=60_000.0)


class HeightAbove(Model):
    """True while an actor is higher above the ground than a value."""

    type: Literal["height_above"]
    actor: Callsign
    height_ft: Number = Field(ge=0.0, le=60_000.0)


class AltitudeReached(Model):
    """True once an aircraft is within 100 ft of an altitude, or has long moved away from it."""

    type: Literal["altitude_reached"]
    actor: Callsign
    altitude_ft: AltitudeFt


class AirspeedReached(Model):
    """True while the calibrated airspeed of an aircraft is within 5 knots of a value."""

    type: Literal["airspeed_reached"]
    actor: Callsign
    cas_kt: SpeedKt


class TrackReached(Model):
    """True while the track of an aircraft is within 5 degrees of a true one."""

    type: Literal["track_reached"]
    actor: Callsign
    track_deg: Bearing


class FixPassed(Model):
    """True once an aircraft passes a fix: within half a mile, or abeam within three."""

    type: Literal["fix_passed"]
    actor: Callsign
    fix: Name = Field(description="its name in the scenario")


class OnLeg(Model):
    """True while an aircraft flies a leg of the circuit of the runway that it is bound for."""

    type: Literal["on_leg"]
    actor: Callsign
    leg: CircuitLeg
    within_nm: Number | None = Field(
        default=None, gt=0.0, le=100.0, description="greatest distance of the threshold on final"
    )


class OffRunways(Model):
    """True while an actor is on the ground, and in the protected area of no runway."""

    type: Literal["off_runways"]
    actor: Callsign
    has_been_on: Flag = Field(default=False, description="true: only after it was on one")


class DistanceBelow(Model):
    """True while two actors are nearer to each other over the ground than a distance."""

    type: Literal["distance_below"]
    actors: Pair
    distance_m: Number = Field(gt=0.0, le=1_000_000.0)


class Collided(Model):
    """True once two actors have touched."""

    type: Literal["collided"]
    actors: Pair


class LineBegun(Model):
    """True once a radio line has begun: from its t_tx on."""

    type: Literal["line_begun"]
    line: Identifier


class LineEnded(Model):
    """True once a radio line has ended."""

    type: Literal["line_ended"]
    line: Identifier


class AllOf(Model):
    """True while all conditions are true."""

    type: Literal["all_of"]
    conditions: tuple[Condition, ...] = Field(min_length=1, max_length=20)


class AnyOf(Model):
    """True while at least one condition is true."""

    type: Literal["any_of"]
    conditions: tuple[Condition, ...] = Field(min_length=1, max_length=20)


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
    | HeightAbove
    | AltitudeReached
    | AirspeedReached
    | TrackReached
    | FixPassed
    | OnLeg
    | OffRunways
    | DistanceBelow
    | Collided
    | LineBegun
    | LineEnded
    | AllOf
    | AnyOf,
    Field(discriminator="type"),
]

AllOf.model_rebuild()
AnyOf.model_rebuild()


def parts(condition: Condition) -> Iterator[Condition]:
    """Yield the conditions that one is made of, itself if it is not made of others."""
    match condition:
        case AllOf(conditions=inner) | AnyOf(conditions=inner):
            for one in inner:
                yield from parts(one)
        case _:
            yield condition
