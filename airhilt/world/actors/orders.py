"""The orders of a call: what each of its instructions commands, or that nothing moves for it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, cast, get_args

import pydantic
from pydantic import BaseModel

from airhilt.commands import (
    AltitudeCommand,
    ApproachCommand,
    BacktrackCommand,
    BehindCommand,
    CancelTakeoffCommand,
    CircuitLeg,
    Command,
    ContactCommand,
    ContinueCommand,
    CrossCommand,
    CrossFixCommand,
    DirectCommand,
    DriftDownCommand,
    EmergencyDescentCommand,
    EnterCommand,
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
    MachCommand,
    OrbitCommand,
    PushBackCommand,
    ReportCommand,
    ResumeRouteCommand,
    ResumeSpeedCommand,
    ReturnToFieldCommand,
    RouteCommand,
    ShortApproachCommand,
    SideStepCommand,
    SpeedCommand,
    TakeOffCommand,
    TaxiToCommand,
    TrackCommand,
    TurnAtCommand,
    TurnCommand,
    VacateCommand,
    VerticalRateCommand,
)
from airhilt.phraseology import Action, Instruction
from airhilt.phraseology.call import OTHERWISE
from airhilt.scenario.models import Condition
from airhilt.world.actors.order_conditions import (
    READY,
    THEN,
    condition_of,
    done,
    fix_named,
    is_departed,
    reported,
)
from airhilt.world.actors.traffic import DOING, passing

NOTHING_MOVES: frozenset[Action] = frozenset(
    {"squawk", "ident", "say", "stand_by", "continue_approach", "start_up",
     "expedite", "visual_separation", "no_speed_restrictions", "wildlife", "wildlife_gone"}
)  # fmt: skip
"""Actions after which nobody moves: what they ask for is done by reading them back, or by what the
actor does anyway."""


BEHIND = re.compile(
    r"(?:behind|after|following)\s+(?:the\s+)?(?!passing|reaching|leaving|you\b)(.+?)"
    r"(?:\s+(?:has|have|is|passes|lands|departs|vacates)\b.*)?"
)
"""Condition to wait for other traffic (ICAO Doc 4444, 12.2.7: "behind landing 737")."""
WAITING = get_args(BehindCommand.model_fields["command"].annotation)
"""Commands that wait for other traffic."""
ON_THE_WAY: frozenset[Action] = frozenset({"cross", "hold_short", "taxi"})
"""Actions that may be part of another clearance in the same call: to taxi, to follow, to land."""


Subject = Literal["level", "speed", "track", "approach", "radio", "report", "surface"]
_ABOUT: Mapping[Subject, tuple[type[BaseModel], ...]] = {
    "level": (
        AltitudeCommand, DriftDownCommand, EmergencyDescentCommand, VerticalRateCommand,
        CrossFixCommand,
    ),
    "speed": (SpeedCommand, MachCommand, ResumeSpeedCommand),
    "track": (
        TrackCommand, TurnCommand, RouteCommand, ResumeRouteCommand, DirectCommand, OrbitCommand,
        HoldAtCommand,
    ),
    "approach": (
        LandCommand, GoAroundCommand, ApproachCommand, SideStepCommand, JoinCommand, ExtendCommand,
        ShortApproachCommand, ReturnToFieldCommand,
    ),
    "radio": (ContactCommand,),
    "report": (ReportCommand,),
}  # fmt: skip
"""Commands in the air and on the radio, by what they are about; all others are about movement on
the surface."""
APPROACHES: frozenset[Action] = frozenset({"cleared_approach", "circle", "side_step", "join"})
"""Actions whose runway is that of a clearance behind them in the same call."""


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
    when: Condition | None = None
    """Condition that the actor waits for; None: it carries it out now."""


def orders_of(
    instructions: Iterable[Instruction],
    bound_runway: str | None,
    variation_deg: float,
    callsign: str,
) -> tuple[Order, ...]:
    """Return the orders that instructions give to an actor, by its callsign, one for each.

    Headings are magnetic, and are flown as true tracks: without wind. The variation is in degrees,
    positive east. An instruction without a runway means the one that the actor is going to use. A
    runway that is named with an approach is that of what follows in the call. A level that comes
    with a takeoff or a go-around is the level that it climbs to, and a heading that comes with a
    takeoff is flown after it. A limit is kept by flying at it; that of a low approach is part of
    its clearance. What a call with a taxi clearance says about runways to cross and where to hold
    short is part of that clearance, and so is where to hold short with whom to follow, and the
    runway to hold short of with a clearance to land.
    """
    given = tuple(instructions)
    now = [each for each in given if not each.is_conditional]
    levels = (each for each in now if each.action == "altitude")
    level_ft = next((each.altitude_ft for each in levels if each.altitude_ft is not None), None)
    climbs = any(each.action in ("cleared_for_takeoff", "go_around") for each in now)
    heading_deg = _heading_after_takeoff(given)
    details = _details(now)
    orders: list[Order] = []
    for each in given:
        is_part = not each.is_conditional and any(each in part.of for part in details)
        is_level = climbs and each.action == "altitude"
        is_level |= (
            each.action == "heading"
            and not _is_turn_at(each)
            and (heading_deg is not None or (climbs and each.heading_deg is None))
        )
        if each.action == "report":
            orders.append(_report(each, callsign, orders))
        elif each.action in NOTHING_MOVES or is_level or is_part:
            orders.append(Order(each))
        else:
            order = _order(each, bound_runway, level_ft, variation_deg, details)
            if each.condition is not None and order.command is not None:
                order = _once(each, order.command, callsign, orders)
            elif orders and (last := orders[-1].command) and _follows(order.command, last):
                order = Order(each, order.command, when=done(last, callsign))
            if heading_deg is not None and isinstance(order.command, TakeOffCommand):
                track_deg = (heading_deg + variation_deg) % 360.0
                command = order.command.model_copy(update={"track_deg": track_deg})
                order = Order(each, command)
            orders.append(order)
        if each.action in APPROACHES and each.runway is not None:
            bound_runway = each.runway
    return tuple(orders)


def _follows(command: Command | None, last: Command) -> bool:
    """Return whether a command waits for the one before it in the call, which need not be said."""
    match command:
        case ContactCommand():
            return isinstance(last, VacateCommand | TurnAtCommand)
        case JoinCommand():
            is_again = isinstance(last, LandCommand) and last.then != "full_stop"
            return is_again or isinstance(last, GoAroundCommand)
    return False


def _report(told: Instruction, callsign: str, before: Sequence[Order]) -> Order:
    """Return the order to report something; nobody reports what it never sees.

    Who is told a heading ``before`` is established on that.
    """
    what, last = told.position or "", before[-1].command if before else None
    is_on_heading = what == "established" and isinstance(last, TrackCommand)
    when = done(last, callsign) if last and is_on_heading else reported(what, callsign)
    if told.condition is not None or when is None:
        return Order(told)
    return Order(told, ReportCommand(action="report", words=what), when=when)


def _heading_after_takeoff(given: Sequence[Instruction]) -> float | None:
    """Return the heading that comes with a takeoff clearance; None if there is none."""
    if not any(each.action == "cleared_for_takeoff" for each in given):
        return None
    return next(
        (
            each.heading_deg
            for each in given
            if each.action == "heading" and (each.condition is None or is_departed(each.condition))
        ),
        None,
    )


class _Detail(NamedTuple):
    """Instructions that say one thing about a clearance in the same call, and what they say."""

    of: tuple[Instruction, ...]
    about: type[BaseModel]
    """Command of the clearance."""
    told: Mapping[str, object]


def _details(given: Sequence[Instruction]) -> list[_Detail]:
    """Return what instructions of a call say about its other clearances."""
    taxis = any(each.action == "taxi" and (each.runway or each.position or each.via)
                for each in given)  # fmt: skip
    does = {each.action for each in given}
    crossed = tuple(each for each in given if each.action == "cross" and each.runway)
    short = tuple(each for each in given if each.action == "hold_short" and _short_of(each))
    names = tuple(_short_of(each) for each in short)
    least = tuple(each for each in given if each.action == "altitude" and each.bound == "or_more")
    if "follow" in does:  # Its way is that of who is followed.
        first = next(index for index, each in enumerate(given) if each.action == "follow")
        to = tuple(each for each in given[first:] if each.action == "taxi")
        return [_Detail((*short, *to), FollowCommand, {"hold_short": names})]
    if taxis:
        told = {"cross": tuple(each.runway for each in crossed), "hold_short": names}
        return [_Detail((*crossed, *short), TaxiToCommand, told)]
    if "cleared_to_land" in does and short and short[0].runway:
        return [_Detail(short[:1], LandCommand, {"hold_short": short[0].runway})]
    if "low_approach" in does and least:
        return [_Detail(least[:1], LandCommand, {"not_below_ft": least[0].altitude_ft})]
    return []


def _short_of(told: Instruction) -> str | None:
    """Return the runway or taxiway to hold short of."""
    return told.runway or told.hold_short or told.position


def _is_turn_at(told: Instruction) -> bool:
    """Return whether a turn is onto a taxiway, and to no heading."""
    return told.action == "heading" and told.turn is not None and told.position is not None


def _order(
    instruction: Instruction,
    bound_runway: str | None,
    level_ft: float | None,
    variation_deg: float,
    details: Sequence[_Detail],
) -> Order:
    try:
        command = _command(instruction, bound_runway, level_ft, variation_deg)
        for detail in details:
            if isinstance(command, detail.about):
                command = command.model_validate({**command.model_dump(), **detail.told})
    except NotUnderstood as asks:
        return Order(instruction, question=str(asks))
    except pydantic.ValidationError:
        return Order(instruction, question="say again")
    if command is None:
        return Order(instruction, unable=f"unable to {instruction.action.replace('_', ' ')}")
    return Order(instruction, command)


def _once(
    instruction: Instruction, command: Command, callsign: str, before: Sequence[Order]
) -> Order:
    """Return the order of a command that waits for a condition.

    It waits for other traffic, for what the actor itself reaches, passes or leaves, or for the end
    of what it is told ``before`` in the same call. About any other condition it asks.
    """
    condition = instruction.condition or ""
    commands = [each.command for each in before if each.command is not None]
    if condition == OTHERWISE or READY.fullmatch(condition):
        return Order(instruction, command)
    if condition == THEN:
        last = commands[-1] if commands else None
        if isinstance(last, GiveWayCommand):
            return _behind(instruction, command, last.to, "passing")
        when = None if last is None else done(last, callsign)
    elif isinstance(command, WAITING):
        return _behind_traffic(instruction, command)
    else:
        when = condition_of(condition, callsign, commands)
    if when is None:
        return Order(instruction, question=f"say again, {condition}")
    return Order(instruction, command, when=when)


def _behind_traffic(instruction: Instruction, command: Command) -> Order:
    """Return the order of a command on the ground that waits for other traffic."""
    match = BEHIND.fullmatch(instruction.condition or "")
    whom = "" if match is None else match[1]
    words = whom.split()
    is_traffic = any(word not in DOING for word in words)
    return _behind(instruction, command, whom if is_traffic else "", passing(words))


def _behind(instruction: Instruction, command: Command, whom: str, doing: str) -> Order:
    try:
        behind = BehindCommand.model_validate(
            {"action": "behind", "whom": whom, "traffic": doing, "command": command.model_dump()}
        )
    except pydantic.ValidationError:
        return Order(instruction, question=f"say again, {instruction.condition}")
    return Order(instruction, behind)


def _command(
    instruction: Instruction,
    bound_runway: str | None,
    level_ft: float | None,
    variation_deg: float,
) -> Command | None:
    """Return the command of an instruction; None: there is none.

    `NotUnderstood` says what is missing.
    """
    return (
        _at_runway(instruction, bound_runway, level_ft)
        or _in_circuit(instruction, bound_runway)
        or _en_route(instruction)
        or _flown(instruction, variation_deg)
        or _on_ground(instruction, bound_runway)
        or _on_radio(instruction)
    )


def _at_runway(
    told: Instruction, bound_runway: str | None, level_ft: float | None
) -> Command | None:
    """Return the command of an aircraft at a runway."""
    climb = {} if level_ft is None else {"climb_to_ft": level_ft}
    match told.action:
        case "go_around" | "cancel_landing" | "missed_approach" | "cancel_approach":
            return GoAroundCommand(action="go_around", **climb)
        case "cancel_takeoff":
            return CancelTakeoffCommand(action="cancel_takeoff")
        case "line_up":
            return LineUpCommand(action="line_up", runway=_runway(told, bound_runway))
        case "cleared_for_takeoff":
            return TakeOffCommand(action="take_off", runway=_runway(told, bound_runway), **climb)
        case "cleared_to_land":
            return LandCommand(action="land", runway=_runway(told, bound_runway))
        case "touch_and_go" | "cleared_option":
            return LandCommand(
                action="land", runway=_runway(told, bound_runway), then="touch_and_go"
            )
        case "stop_and_go":
            return LandCommand(
                action="land", runway=_runway(told, bound_runway), then="stop_and_go"
            )
        case "low_approach":
            return LandCommand(
                action="land", runway=_runway(told, bound_runway), then="low_approach"
            )
        case "cleared_approach":
            is_visual = told.approach == "visual"
            kind = "visual" if is_visual else "straight_in"
            return ApproachCommand(action="approach", runway=_runway(told, bound_runway), kind=kind)
        case "circle":
            return ApproachCommand(
                action="approach", runway=_runway(told, bound_runway), kind="circling"
            )
        case "side_step":
            return SideStepCommand(action="side_step", runway=_runway(told, bound_runway))
    return None


def _in_circuit(told: Instruction, bound_runway: str | None) -> Command | None:
    """Return the command of an aircraft in the traffic circuit."""
    place, turn = told.position, told.turn
    match told.action:
        case "join":
            leg = _leg(place)
            return JoinCommand(
                action="join", leg=leg, runway=_runway(told, bound_runway), side=turn
            )
        case "extend":
            return ExtendCommand(action="extend", leg=_leg(place or "downwind"))
        case "short_approach":
            return ShortApproachCommand(action="short_approach")
        case "return_to_field":
            return ReturnToFieldCommand(action="return_to_field")
        case "orbit":
            return OrbitCommand(action="orbit", turn=turn or "right")
    return None


def _en_route(told: Instruction) -> Command | None:
    """Return the command of an aircraft about its route and its speed."""
    turn = told.turn
    match told.action:
        case "direct":
            return DirectCommand(action="direct", to=_fix(told))
        case "hold_at":
            return HoldAtCommand(action="hold_at", fix=_fix(told), turn=turn or "right")
        case "own_navigation":
            return ResumeRouteCommand(action="resume_route")
        case "speed" if told.speed_kt is not None:
            return SpeedCommand(action="speed", cas_kt=told.speed_kt)
        case "speed" if told.named == "normal":
            return ResumeSpeedCommand(action="resume_speed")
        case "mach" if told.mach is not None:
            return MachCommand(action="mach", mach=told.mach)
        case "resume_speed":
            return ResumeSpeedCommand(action="resume_speed")
        case "vertical_rate" if told.rate_fpm is not None:
            return VerticalRateCommand(action="vertical_rate", vertical_rate_fpm=told.rate_fpm)
        case "cross_fix" if told.altitude_ft is not None:
            return CrossFixCommand(
                action="cross_fix",
                fix=_fix(told),
                altitude_ft=told.altitude_ft,
            )
    return None


def _flown(told: Instruction, variation_deg: float) -> Command | None:
    """Return the command of an aircraft about its level or heading."""
    match told.action:
        case "altitude":
            if told.altitude_ft is None:
                raise NotUnderstood("say altitude")
            return AltitudeCommand(
                action="altitude",
                altitude_ft=told.altitude_ft,
                vertical_rate_fpm=told.rate_fpm,
            )
        case "heading":
            if told.heading_deg is None:
                if told.position is None:
                    raise NotUnderstood("say heading")
                if told.turn is not None:
                    taxiway = told.position
                    return TurnAtCommand(action="turn_at", taxiway=taxiway, side=told.turn)
                return TurnCommand(action="turn", degrees=0.0)  # The present or runway heading.
            track_deg = (told.heading_deg + variation_deg) % 360.0
            return TrackCommand(action="track", track_deg=track_deg)
        case "turn_by" if told.turn_deg is not None:
            degrees = -told.turn_deg if told.turn == "left" else told.turn_deg
            return TurnCommand(action="turn", degrees=degrees)
    return None


def _on_ground(told: Instruction, bound_runway: str | None) -> Command | None:
    """Return the command on the ground."""
    place, turn = told.position, told.turn
    match told.action:
        case "hold_position" | "stop":
            return HoldPositionCommand(action="hold_position")
        case "hold_short":
            taxiway = told.hold_short or place
            return HoldShortCommand(action="hold_short", runway=told.runway, taxiway=taxiway)
        case "cross":
            return CrossCommand(action="cross", runway=told.runway, at=place)
        case "proceed" if told.runway is not None:
            return EnterCommand(action="enter", runway=told.runway, at=place)
        case "taxi" | "proceed":
            if told.runway is None and place is None and not told.via:
                return ContinueCommand(action="continue")
            return TaxiToCommand(action="taxi_to", runway=told.runway, place=place, via=told.via)
        case "vacate":
            return VacateCommand(action="vacate", exit=place, side=turn)
        case "backtrack":
            return BacktrackCommand(action="backtrack", runway=_runway(told, bound_runway))
        case "follow":
            return FollowCommand(action="follow", whom=_named(told, "whom to follow"))
        case "give_way":
            return GiveWayCommand(action="give_way", to=_named(told, "whom to give way to"))
        case "push_back":
            return PushBackCommand(action="push_back")
    return None


def _on_radio(told: Instruction) -> Command | None:
    """Return the command on the radio."""
    match told.action:
        case "contact" | "monitor":
            return ContactCommand(
                action="contact",
                unit=told.position,
                frequency_khz=told.frequency_khz,
                calls=told.action == "contact",
            )
    return None


def _runway(told: Instruction, bound_runway: str | None) -> str:
    if runway := told.runway or bound_runway:
        return runway
    raise NotUnderstood("say runway")


def _fix(told: Instruction) -> str:
    return fix_named(_named(told, "the fix"))


def _named(told: Instruction, what: str) -> str:
    if told.position is None:
        raise NotUnderstood(f"say {what}")
    return told.position


def subject_of(command: Command) -> Subject:
    """Return what a command is about: a later one about the same replaces it."""
    return next((name for name, about in _ABOUT.items() if isinstance(command, about)), "surface")


def _leg(words: str | None) -> CircuitLeg:
    """Return the leg of the circuit that words name; a straight-in approach is on final."""
    if words is not None and "straight" in words:
        return "final"
    for leg in cast("tuple[CircuitLeg, ...]", get_args(CircuitLeg)):
        if words is not None and leg in words:
            return leg
    raise NotUnderstood("say which leg")
