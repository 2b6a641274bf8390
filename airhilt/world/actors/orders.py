"""The orders of a call: what each of its instructions commands, or that nothing moves for it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, cast, get_args

import pydantic
from pydantic import BaseModel

from airhilt.commands import (
    AltitudeCommand,
    ApproachCommand,
    BacktrackCommand,
    BehindCommand,
    CancelLandingCommand,
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
    is_event,
    reported,
)
from airhilt.world.actors.traffic import DOING, passing

NOTHING_MOVES: frozenset[Action] = frozenset(
    {"squawk", "ident", "say", "stand_by", "start_up",
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
        LandCommand, CancelLandingCommand, GoAroundCommand, ApproachCommand, SideStepCommand,
        JoinCommand, ExtendCommand, ShortApproachCommand, ReturnToFieldCommand,
    ),
    "radio": (ContactCommand,),
    "report": (ReportCommand,),
}  # fmt: skip
"""Commands in the air and on the radio, by what they are about; all others are about movement on
the surface."""
LANDINGS: frozenset[Action] = frozenset(
    {"cleared_to_land", "touch_and_go", "cleared_option", "stop_and_go", "low_approach"}
)
APPROACHES: frozenset[Action] = frozenset(
    {"cleared_approach", "circle", "side_step", "join", "continue_approach"}
)
DEPARTURES: frozenset[Action] = frozenset({"line_up", "cleared_for_takeoff", "backtrack"})
FOR_NOW: frozenset[Action] = LANDINGS - {"cleared_to_land"}
"""Landings after which something else at a runway may be told in the same call."""
TO_FINAL: frozenset[Action] = frozenset({"cleared_to_land", "cleared_approach", "circle", "join"})
"""Actions with which a level is kept until the final approach."""
TO_A_RUNWAY = (LandCommand, ApproachCommand, JoinCommand)
"""Commands by which an aircraft flies to a runway."""
AFTER_LANDING = (TaxiToCommand, FollowCommand, GiveWayCommand, CrossCommand, ContinueCommand)
"""Commands that wait until the runway has been left, if the same call is about leaving it."""


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
    after: Command | None = None
    """Command of the same call for whose end it waits, which nobody had to say."""
    part_of: Instruction | None = None
    """Clearance in the same call that has it as a detail; it is done or refused with that."""
    alone: Command | None = None
    """Order that is left of it if that clearance is refused; None: nothing."""

    @property
    def rank(self) -> int:
        """Place in the order of doing: as in the call, except for what would undo something.

        What ends a clearance comes first. A level and a way come before the approach, which goes on
        from them, and a level before what is said about the way to it. A speed is kept, and an
        orbit flown, on the approach. Who stops stands in the end.
        """
        match self.command:
            case GoAroundCommand() | CancelTakeoffCommand() | CancelLandingCommand():
                return 0
            case VerticalRateCommand() | CrossFixCommand():
                return 2
            case OrbitCommand() | SpeedCommand() | MachCommand() | ResumeSpeedCommand():
                return 4
            case HoldPositionCommand():
                return 5
            case None:
                return 3
        return 1 if subject_of(self.command) in ("level", "track") else 3


def orders_of(
    instructions: Iterable[Instruction],
    bound_runway: str | None,
    variation_deg: float,
    callsign: str,
) -> tuple[Order, ...]:
    """Return the orders that instructions give to an actor, by its callsign, one for each.

    Headings are magnetic, and are flown as true tracks: without wind. The variation is in degrees,
    positive east. An instruction without a runway means the one that the rest of the call names, or
    the one that the actor is going to use. A level that comes with a takeoff or a go-around is the
    level that it climbs to, and a heading that comes with a takeoff is flown after it. A level that
    comes with an approach or a landing is kept until the final approach, and the approach follows
    the heading, or the fix, that comes with it. A limit is kept by flying at it; that of a low
    approach is part of its clearance. What a call with a taxi clearance says about runways to cross
    and where to hold short is part of that clearance, and so is where to hold short with whom to
    follow, and the runway to hold short of with a clearance to land.
    """
    given = tuple(instructions)
    details = _details(given, variation_deg)
    orders: list[Order] = []
    for index, each in enumerate(given):
        runway = _runway_in_call(given, index) or bound_runway
        detail = next((one for one in details if any(each is part for part in one.parts)), None)
        if each.action == "report":
            order = _report(each, callsign, orders)
        elif each.action in NOTHING_MOVES or _goes_on(each, runway):
            order = Order(each)
        else:
            order = _order(each, given, runway, variation_deg, details)
            if each.condition is not None and order.command is not None:
                order = _once(each, order.command, callsign, orders)
        if detail is not None:
            alone = order.command if detail.is_done_alone and not each.is_conditional else None
            order = Order(each, part_of=detail.to, alone=alone)
        orders.append(order)
    return tuple(_waiting(order, orders, callsign) for order in orders)


def _runway_in_call(given: Sequence[Instruction], index: int) -> str | None:
    """Return the runway that the rest of a call names for an instruction without one.

    What is told for after a touch-and-go does not say where that is.
    """
    action, runway = given[index].action, given[index].runway
    if runway is not None and action != "continue_approach":
        return runway
    if action in DEPARTURES:
        kind: frozenset[Action] = DEPARTURES
        before: frozenset[Action] = DEPARTURES | {"taxi"}
    else:
        kind = before = LANDINGS | APPROACHES if action in LANDINGS | APPROACHES else frozenset()
    named = [one.runway for one in given[:index] if one.action in before and one.runway]
    if named:
        return named[-1]
    if action in FOR_NOW or runway is not None:
        return None
    return next((one.runway for one in given[index:] if one.action in kind and one.runway), None)


def _goes_on(told: Instruction, runway: str | None) -> bool:
    """Return whether an approach goes on to the runway to which it is flown anyway."""
    is_same = runway is not None and told.runway in (None, runway)
    return told.action == "continue_approach" and is_same


def _waiting(order: Order, orders: Sequence[Order], callsign: str) -> Order:
    """Return an order with the condition that follows from the rest of its call, if one does."""
    command = order.command
    if command is None or order.when is not None or order.instruction.is_conditional:
        return order
    before = [each for each in orders[: orders.index(order)] if each.command is not None]
    now = [each.command for each in orders if each.when is None]
    last = before[-1].command if before else None
    after: Command | None = None
    if isinstance(command, TO_A_RUNWAY):
        if any(isinstance(each, HoldAtCommand) for each in now):
            return Order(order.instruction, unable="unable approach, told to hold")
        if not any(isinstance(each, GoAroundCommand) for each in now):
            after = _last(now, TrackCommand, DirectCommand)
    if last is not None and _follows(command, last):
        after = last
    if isinstance(command, AFTER_LANDING):
        after = _last([each.command for each in before], LandCommand, VacateCommand, TurnAtCommand)
    elif isinstance(command, ContactCommand) and isinstance(last, AFTER_LANDING):
        waits = _waiting(before[-1], orders, callsign)
        return replace(order, when=waits.when, after=waits.after)
    when = None if after is None else done(after, callsign)
    return order if when is None else replace(order, when=when, after=after)


def _last(commands: Sequence[Command | None], *types: type[BaseModel]) -> Command | None:
    return next((each for each in reversed(commands) if isinstance(each, types)), None)


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


@dataclass(frozen=True, slots=True)
class _Detail:
    """Instructions that say one thing about a clearance in the same call, and what they say."""

    to: Instruction
    """The clearance."""
    parts: tuple[Instruction, ...]
    told: Mapping[str, object]
    is_done_alone: bool = False
    """True if what they say is done, or refused, by itself if the clearance is refused."""


def _details(call: Sequence[Instruction], variation_deg: float) -> list[_Detail]:
    """Return what instructions of a call say about its other clearances."""
    given = [each for each in call if not each.is_conditional]
    first: dict[Action, Instruction] = {}
    for each in given:
        first.setdefault(each.action, each)
    takeoffs = (each for each in call if each.action == "cleared_for_takeoff")
    takeoff = next(takeoffs, None)
    around = next((each for each in given if _is_go_around(each, given)), None)
    details = _of_climb(around or takeoff, given)
    if takeoff is not None:
        details += _of_takeoff(takeoff, call, variation_deg)
    if around is None:
        details += _of_approach(given)
    return [*details, *_of_way(given, first)]


def _is_go_around(told: Instruction, call: Sequence[Instruction]) -> bool:
    """Return whether an instruction ends an approach; who is to continue goes on with it."""
    if told.action == "cancel_landing":
        return not any(each.action == "continue_approach" for each in call)
    return told.action in ("go_around", "missed_approach", "cancel_approach")


def _of_climb(climb: Instruction | None, given: Sequence[Instruction]) -> list[_Detail]:
    """Return what is said about a takeoff or a go-around: a level, and to keep the heading."""
    if climb is None:
        return []
    levels = tuple(each for each in given if each.action == "altitude" and each.altitude_ft)
    present = tuple(
        each for each in given
        if each.action == "heading" and each.heading_deg is None and not _is_turn_at(each)
    )  # fmt: skip
    level = {"climb_to_ft": levels[0].altitude_ft} if levels else {}
    return [_Detail(climb, levels, level, is_done_alone=True), _Detail(climb, present, {})]


def _of_takeoff(
    takeoff: Instruction, call: Sequence[Instruction], variation_deg: float
) -> list[_Detail]:
    """Return the heading that comes with a takeoff clearance, and is flown after it."""
    headings = (each for each in call if each.action == "heading" and each.heading_deg is not None)
    after = (each for each in headings if each.condition is None or is_departed(each.condition))
    told = next(after, None)
    if told is None or told.heading_deg is None:
        return []
    track_deg = (told.heading_deg + variation_deg) % 360.0
    return [_Detail(takeoff, (told,), {"track_deg": track_deg}, is_done_alone=True)]


def _of_approach(given: Sequence[Instruction]) -> list[_Detail]:
    """Return the level that comes with an approach, and is kept until the final approach."""
    levels = [each for each in given if each.action == "altitude" and each.bound != "or_less"]
    if not levels or levels[0].altitude_ft is None or is_event(levels[0].until):
        return []
    to = (each for each in given if each.action in TO_FINAL)
    return [_Detail(each, (), {"level_ft": levels[0].altitude_ft}) for each in to]


def _of_way(given: Sequence[Instruction], first: Mapping[Action, Instruction]) -> list[_Detail]:
    """Return what is said about a way over the ground, a landing or a low approach."""
    short = tuple(each for each in given if each.action == "hold_short" and _short_of(each))
    names = tuple(_short_of(each) for each in short)
    if follow := first.get("follow"):  # Its way is that of who is followed.
        at = next(index for index, each in enumerate(given) if each is follow)
        to = tuple(each for each in given[at:] if each.action == "taxi")
        stops = _Detail(follow, short, {"hold_short": names}, is_done_alone=True)
        return [stops, _Detail(follow, to, {})]
    ways = (each for each in given if each.action == "taxi")
    taxi = next((each for each in ways if each.runway or each.position or each.via), None)
    if taxi is not None:
        crossed = tuple(each for each in given if each.action == "cross" and each.runway)
        return [
            _Detail(taxi, crossed, {"cross": tuple(each.runway for each in crossed)}),
            _Detail(taxi, short, {"hold_short": names}, is_done_alone=True),
        ]
    if (land := first.get("cleared_to_land")) and short and short[0].runway:
        return [_Detail(land, short[:1], {"hold_short": short[0].runway})]
    least = tuple(each for each in given if each.action == "altitude" and each.bound == "or_more")
    if (low := first.get("low_approach")) and least:
        return [_Detail(low, least[:1], {"not_below_ft": least[0].altitude_ft})]
    return []


def _short_of(told: Instruction) -> str | None:
    """Return the runway or taxiway to hold short of."""
    return told.runway or told.hold_short or told.position


def _is_turn_at(told: Instruction) -> bool:
    """Return whether a turn is onto a taxiway, and to no heading."""
    return told.action == "heading" and told.turn is not None and told.position is not None


def _order(
    instruction: Instruction,
    call: Sequence[Instruction],
    bound_runway: str | None,
    variation_deg: float,
    details: Sequence[_Detail],
) -> Order:
    if _is_broken(instruction, call):
        return Order(instruction, unable=f"unable to keep a level {instruction.until}")
    if instruction.action == "cancel_landing" and not _is_go_around(instruction, call):
        return Order(instruction, CancelLandingCommand(action="cancel_landing"))
    try:
        command = _command(instruction, bound_runway, variation_deg)
        if command is not None:
            told = {name: value for detail in details if detail.to is instruction
                    for name, value in detail.told.items()}  # fmt: skip
            command = command.model_validate({**command.model_dump(), **told})
    except NotUnderstood as asks:
        return Order(instruction, question=str(asks))
    except pydantic.ValidationError:
        return Order(instruction, question="say again")
    if command is None:
        return Order(instruction, unable=_unable(instruction))
    return Order(instruction, command)


def _is_broken(told: Instruction, call: Sequence[Instruction]) -> bool:
    """Return whether an approach or a landing beside a level does not wait for its event."""
    is_left = any(each.action in TO_FINAL and not each.is_conditional for each in call)
    return told.action == "altitude" and is_left and is_event(told.until)


def _unable(told: Instruction) -> str:
    """Return the words about an instruction that nobody can carry out."""
    if told.action == "speed" and told.named is not None:
        return f"unable {told.named} speed, say speed in knots"
    if told.action == "cross_fix":
        return "unable to cross a fix at a speed"
    return f"unable to {told.action.replace('_', ' ')}"


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
    instruction: Instruction, bound_runway: str | None, variation_deg: float
) -> Command | None:
    """Return the command of an instruction; None: there is none.

    `NotUnderstood` says what is missing.
    """
    return (
        _at_runway(instruction, bound_runway)
        or _in_circuit(instruction, bound_runway)
        or _en_route(instruction)
        or _flown(instruction, variation_deg)
        or _on_ground(instruction, bound_runway)
        or _on_radio(instruction)
    )


def _at_runway(told: Instruction, bound_runway: str | None) -> Command | None:
    """Return the command of an aircraft at a runway."""
    match told.action:
        case "go_around" | "cancel_landing" | "missed_approach" | "cancel_approach":
            return GoAroundCommand(action="go_around")
        case "cancel_takeoff":
            return CancelTakeoffCommand(action="cancel_takeoff")
        case "line_up":
            return LineUpCommand(action="line_up", runway=_runway(told, bound_runway))
        case "cleared_for_takeoff":
            return TakeOffCommand(action="take_off", runway=_runway(told, bound_runway))
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
        case "continue_approach":  # To another runway than before.
            return ApproachCommand(
                action="approach", runway=told.runway or _runway(told, None), kind="circling"
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
        case "return_to_field" if told.runway is not None:
            return ApproachCommand(action="approach", runway=told.runway, kind="visual")
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
        case "cross_fix" if told.altitude_ft is not None and told.speed_kt is None:
            return CrossFixCommand(
                action="cross_fix",
                fix=_fix(told),
                altitude_ft=told.altitude_ft,
                bound=told.bound,
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
