"""The orders of a call: what each of its instructions commands, or that nothing moves for it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import cast, get_args

from airhilt.commands import (
    AltitudeCommand,
    ApproachCommand,
    BacktrackCommand,
    CancelTakeoffCommand,
    CircuitLeg,
    Command,
    ContactCommand,
    CrossCommand,
    DirectCommand,
    ExtendCommand,
    FollowCommand,
    GiveWayCommand,
    GoAroundCommand,
    HoldAtCommand,
    HoldPositionCommand,
    HoldShortCommand,
    JoinCommand,
    LandCommand,
    LineUpCommand,
    OrbitCommand,
    PushBackCommand,
    ResumeRouteCommand,
    ReturnToFieldCommand,
    ShortApproachCommand,
    SideStepCommand,
    SpeedCommand,
    TakeOffCommand,
    TaxiToCommand,
    TrackCommand,
    TurnCommand,
    VacateCommand,
)
from airhilt.phraseology import Action, Instruction

NOTHING_MOVES: frozenset[Action] = frozenset(
    {"squawk", "ident", "report", "say", "stand_by", "monitor", "continue_approach", "start_up",
     "expedite", "visual_separation", "no_speed_restrictions", "wildlife", "wildlife_gone"}
)  # fmt: skip
"""Actions after which nobody moves: what they ask for is done by reading them back, or by what the
actor does anyway."""


class NotUnderstood(Exception):
    """An instruction lacks what is needed to do it; the text is what its listener asks."""


@dataclass(frozen=True, slots=True)
class Order:
    """An instruction to an actor, and its command."""

    instruction: Instruction
    command: Command | None = None
    """None: nothing moves because of it, or it cannot be carried out."""
    unable: str = ""
    """Why nobody could carry it out, as it is said on the radio; empty if somebody could."""
    question: str = ""
    """What the actor asks before it can be carried out; empty if nothing is missing."""


def orders_of(
    instructions: Iterable[Instruction], bound_runway: str | None, variation_deg: float
) -> tuple[Order, ...]:
    """Return the orders that instructions give to an actor, one for each instruction.

    Headings are magnetic, and are flown as true tracks: without wind. The variation is in degrees,
    positive east. An instruction without a runway means the one that the actor is going to use. A
    level that comes with a takeoff or a go-around is the level that it climbs to. A level to cross
    a fix at, or not to pass, is no level to fly to.
    """
    given = tuple(instructions)
    now = [each for each in given if not each.is_conditional]
    levels = (each for each in now if each.action == "altitude" and each.bound is None)
    level_ft = next((each.altitude_ft for each in levels if each.altitude_ft is not None), None)
    climbs = any(each.action in ("cleared_for_takeoff", "go_around") for each in now)
    orders = []
    for each in given:
        if each.action in NOTHING_MOVES or (climbs and each.action == "altitude"):
            orders.append(Order(each))
        elif each.is_conditional:
            orders.append(Order(each, question=f"say again, {each.condition}"))
        else:
            orders.append(_order(each, bound_runway, level_ft, variation_deg))
    return tuple(orders)


def _order(
    instruction: Instruction,
    bound_runway: str | None,
    level_ft: float | None,
    variation_deg: float,
) -> Order:
    try:
        command = _command(instruction, bound_runway, level_ft, variation_deg)
    except NotUnderstood as asks:
        return Order(instruction, question=str(asks))
    if command is None:
        return Order(instruction, unable=f"unable to {instruction.action.replace('_', ' ')}")
    return Order(instruction, command)


def _command(
    instruction: Instruction,
    bound_runway: str | None,
    level_ft: float | None,
    variation_deg: float,
) -> Command | None:
    """Return the command of an instruction; None: there is none.

    `NotUnderstood` says what is missing.
    """
    place, turn = instruction.position, instruction.turn
    climb = {} if level_ft is None else {"climb_to_ft": level_ft}

    def runway() -> str:
        if named := instruction.runway or bound_runway:
            return named
        raise NotUnderstood("say runway")

    def named(what: str) -> str:
        if place is None:
            raise NotUnderstood(f"say {what}")
        return place

    match instruction.action:
        # Aircraft at a runway.
        case "go_around" | "cancel_landing" | "missed_approach" | "cancel_approach":
            return GoAroundCommand(action="go_around", **climb)
        case "cancel_takeoff":
            return CancelTakeoffCommand(action="cancel_takeoff")
        case "line_up":
            return LineUpCommand(action="line_up", runway=runway())
        case "cleared_for_takeoff":
            return TakeOffCommand(action="take_off", runway=runway(), **climb)
        case "cleared_to_land":
            return LandCommand(action="land", runway=runway())
        case "touch_and_go" | "cleared_option":
            return LandCommand(action="land", runway=runway(), then="touch_and_go")
        case "stop_and_go":
            return LandCommand(action="land", runway=runway(), then="stop_and_go")
        case "low_approach":
            return LandCommand(action="land", runway=runway(), then="low_approach")
        case "cleared_approach":
            is_visual = instruction.approach == "visual"
            kind = "visual" if is_visual else "straight_in"
            return ApproachCommand(action="approach", runway=runway(), kind=kind)
        case "circle":
            return ApproachCommand(action="approach", runway=runway(), kind="circling")
        case "side_step":
            return SideStepCommand(action="side_step", runway=runway())
        # In the circuit, and en route.
        case "join":
            leg = _leg(place)
            side = turn or "left"
            return JoinCommand(action="join", leg=leg, runway=runway(), side=side)
        case "extend":
            return ExtendCommand(action="extend", leg=_leg(place or "downwind"))
        case "short_approach":
            return ShortApproachCommand(action="short_approach")
        case "return_to_field":
            return ReturnToFieldCommand(action="return_to_field")
        case "orbit":
            return OrbitCommand(action="orbit", turn=turn or "right")
        case "direct":
            return DirectCommand(action="direct", to=named("the fix"))
        case "hold_at":
            return HoldAtCommand(action="hold_at", fix=named("the fix"), turn=turn or "right")
        case "own_navigation":
            return ResumeRouteCommand(action="resume_route")
        case "altitude" if instruction.bound is None:
            if instruction.altitude_ft is None:
                raise NotUnderstood("say altitude")
            return AltitudeCommand(
                action="altitude",
                altitude_ft=instruction.altitude_ft,
                vertical_rate_fpm=instruction.rate_fpm,
            )
        case "heading":
            if instruction.heading_deg is None:
                raise NotUnderstood("say heading")
            track_deg = (instruction.heading_deg + variation_deg) % 360.0
            return TrackCommand(action="track", track_deg=track_deg)
        case "turn_by" if instruction.turn_deg is not None:
            degrees = -instruction.turn_deg if turn == "left" else instruction.turn_deg
            return TurnCommand(action="turn", degrees=degrees)
        case "speed" if instruction.speed_kt is not None and instruction.bound is None:
            return SpeedCommand(action="speed", cas_kt=instruction.speed_kt)
        # On the ground.
        case "hold_position" | "stop":
            return HoldPositionCommand(action="hold_position")
        case "hold_short":
            taxiway = instruction.hold_short or place
            return HoldShortCommand(action="hold_short", runway=instruction.runway, taxiway=taxiway)
        case "cross":
            return CrossCommand(action="cross", runway=instruction.runway, at=place)
        case "taxi" | "proceed":
            return TaxiToCommand(
                action="taxi_to", runway=instruction.runway, place=place, via=instruction.via
            )
        case "vacate":
            return VacateCommand(action="vacate", exit=place, side=turn)
        case "backtrack":
            return BacktrackCommand(action="backtrack", runway=runway())
        case "follow":
            return FollowCommand(action="follow", whom=named("whom to follow"))
        case "give_way":
            return GiveWayCommand(action="give_way", to=named("whom to give way to"))
        case "push_back":
            return PushBackCommand(action="push_back")
        # On the radio.
        case "contact":
            return ContactCommand(
                action="contact", unit=place, frequency_khz=instruction.frequency_khz
            )
    return None


def _leg(words: str | None) -> CircuitLeg:
    """Return the leg of the circuit that words name."""
    for leg in cast("tuple[CircuitLeg, ...]", get_args(CircuitLeg)):
        if words is not None and leg in words:
            return leg
    raise NotUnderstood("say which leg")
