"""Texts of radio lines compared with the commands that a scenario says they mean.

The texts are read by the project's own parser, as an assistant or a crew in noise reads them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from airhilt.commands import (
    AltitudeCommand,
    Command,
    GoAroundCommand,
    LandCommand,
    LineUpCommand,
    SideStepCommand,
    SpeedCommand,
    TakeOffCommand,
    TaxiCommand,
    TrackCommand,
    TurnCommand,
)
from airhilt.phraseology import Action, Call, Instruction, parse_call
from airhilt.scenario.models import ReadbackWrong, Scenario, ScriptedCommand, WildlifeSpec
from airhilt.scenario.problems import Problem

GREATEST_VARIATION_DEG = 30.0
"""Greatest difference of a true track and the magnetic heading that is said, in degrees."""

WORDS: dict[str, frozenset[Action]] = {
    "land": frozenset(
        {"cleared_to_land", "cleared_option", "touch_and_go", "stop_and_go", "low_approach",
         "cleared_approach", "continue_approach"}
    ),
    "side_step": frozenset({"cleared_to_land", "cleared_approach", "continue_approach"}),
    "line_up": frozenset({"line_up", "cleared_for_takeoff"}),
    "take_off": frozenset({"cleared_for_takeoff"}),
    "cancel_takeoff": frozenset({"cancel_takeoff", "hold_position", "stop"}),
    "go_around": frozenset({"go_around", "missed_approach", "cancel_landing"}),
    "altitude": frozenset({"altitude", "climb_via", "descend_via", "cross_fix", "go_around",
                           "cleared_for_takeoff"}),
    "track": frozenset({"heading", "turn_by", "direct", "circle"}),
    "turn": frozenset({"heading", "turn_by", "circle"}),
    "speed": frozenset({"speed", "mach", "resume_speed", "no_speed_restrictions"}),
    "hold_position": frozenset({"hold_position", "hold_short", "stop", "give_way", "hold_at"}),
    "continue": frozenset({"cross", "proceed", "taxi", "line_up", "backtrack"}),
    "taxi": frozenset({"taxi", "proceed", "cross", "backtrack", "vacate", "line_up", "follow"}),
}  # fmt: skip
"""Actions in words by which each command is given; the others have no words of their own."""

BESIDES: dict[str, frozenset[Action]] = {
    "land": frozenset({"circle"}),
    "take_off": frozenset({"altitude", "heading", "turn_by"}),
    "go_around": frozenset({"altitude", "heading", "turn_by"}),
    "route": frozenset({"direct", "heading", "turn_by", "cleared_approach", "cross_fix"}),
    "resume_route": frozenset({"direct", "resume_speed"}),
    "drift_down": frozenset({"altitude"}),
    "emergency_descent": frozenset({"altitude"}),
}
"""Actions that each command carries out as well, though none of them need be said."""
MAY_CHANGE_NOTHING: frozenset[Action] = WORDS["hold_position"] | {"continue_approach", "follow"}
"""Actions that order what an actor may do already, so that they need no command."""
ORDERS = frozenset[Action]().union(*WORDS.values()) - MAY_CHANGE_NOTHING
"""Actions that nothing but a command carries out."""


@dataclass(frozen=True)
class _Text:
    """A text of the scenario, with what it should mean."""

    path: str
    words: str
    station: str | None
    """Actor that the call is to, or from; None if it is between units."""
    commands: tuple[ScriptedCommand, ...]
    is_order: bool
    """True if it is said to the actor, or has commands: each order in it must be a command."""
    answered: tuple[ScriptedCommand, ...] = ()
    """Commands of the lines that answer it, which carry out what it orders."""


def doubtful_texts(scenario: Scenario) -> Iterator[Problem]:
    """Yield texts that name another actor than their line, or differ from what its commands are.

    Such a text does not say what a command does, or orders what no command does, neither of its
    line nor of what answers it. A wrong readback is compared with the commands of its failure; what
    other failures change is meant to differ.
    """
    callsigns = [a.callsign for a in scenario.actors if not isinstance(a, WildlifeSpec)]
    for text in _texts(scenario, callsigns):
        call = parse_call(text.words, callsigns)
        told = [scripted.actor for scripted in text.commands]
        expected = dict.fromkeys([text.station, *told] if text.station else told)
        for callsign in expected:
            if call.callsign != callsign:
                names = f"names {call.callsign or 'no actor'}, not {callsign}"
                yield Problem(text.path, f"{names}: {text.words!r}")
        for scripted in text.commands:
            found = _difference(scripted.command, call)
            if found is not None:
                yield Problem(text.path, f"{found}: {text.words!r}")
        for order in _without_command(text, call):
            said = order.replace("_", " ")
            yield Problem(text.path, f"says {said}, which no command does: {text.words!r}")


def _without_command(text: _Text, call: Call) -> Iterator[Action]:
    """Yield the actions of an order that neither its commands nor those of its answers do."""
    if not text.is_order:
        return
    done: frozenset[Action] = frozenset()
    for scripted in (*text.commands, *text.answered):
        action = scripted.command.action
        done |= WORDS.get(action, frozenset()) | BESIDES.get(action, frozenset())
    for each in call.instructions:
        is_kept = each.action == "altitude" and each.sense == "maintain"
        if each.action in ORDERS - done and not is_kept:
            yield each.action


def _texts(scenario: Scenario, callsigns: list[str]) -> Iterator[_Text]:
    lines = {line.id: line for line in scenario.radio.lines}
    for index, line in enumerate(scenario.radio.lines):
        named = next((name for name in (line.to, line.speaker) if name in callsigns), None)
        is_order = line.to in callsigns or bool(line.commands)
        yield _Text(
            f"radio/lines/{index}/text", line.text, named, line.commands, is_order,
            tuple(_answered(scenario, index, named)),
        )  # fmt: skip
    for index, failure in enumerate(scenario.failures):
        if isinstance(failure, ReadbackWrong):
            speaker = lines[failure.line].speaker
            named = speaker if speaker in callsigns else None
            yield _Text(
                f"failures/{index}/text", failure.text, named, failure.commands,
                bool(failure.commands),
            )  # fmt: skip


def _answered(scenario: Scenario, index: int, actor: str | None) -> Iterator[ScriptedCommand]:
    """Yield the commands of what an actor says after a line, until it is called again."""
    for line in scenario.radio.lines[index + 1 :]:
        if actor is None or line.to == actor:
            return
        if line.speaker == actor:
            yield from line.commands


def _difference(command: Command, call: Call) -> str | None:
    """Return how a command differs from what is said; None if it does not."""
    actions = WORDS.get(command.action)
    if actions is None:
        return None
    said = [each for each in call.instructions if each.action in actions]
    if not said:
        return f"does not say to {command.action.replace('_', ' ')}, as its command does"
    for name, value in _details(command).items():
        details = [
            detail for each in call.instructions if (detail := _said(each, name)) is not None
        ]
        if details and not any(_agree(name, value, detail) for detail in details):
            return f"says {name} {_shown(details[0])}, where its command has {_shown(value)}"
    return None


def _details(command: Command) -> dict[str, str | float]:
    """Return the details of a command that its words may have, by their names there."""
    match command:
        case LandCommand() | LineUpCommand() | SideStepCommand():
            return {"runway": command.runway}
        case TakeOffCommand():
            return {"runway": command.runway, "altitude_ft": command.climb_to_ft}
        case GoAroundCommand():
            return {"altitude_ft": command.climb_to_ft}
        case AltitudeCommand(altitude_ft=altitude_ft, vertical_rate_fpm=rate_fpm):
            rate = {} if rate_fpm is None else {"rate_fpm": rate_fpm}
            return {"altitude_ft": altitude_ft, **rate}
        case TaxiCommand(via=via) if via:
            return {"via": ", ".join(via)}
        case TurnCommand():
            return {"turn_deg": command.degrees}
        case TrackCommand():
            return {"heading_deg": command.track_deg}
        case SpeedCommand():
            return {"speed_kt": command.cas_kt}
    return {}


def _said(instruction: Instruction, name: str) -> str | float | None:
    """Return a detail of an instruction; a turn to the left is negative."""
    if name == "via":
        return ", ".join(instruction.via) or None
    if name == "turn_deg":
        if instruction.turn_deg is None or instruction.turn is None:
            return None
        return instruction.turn_deg if instruction.turn == "right" else -instruction.turn_deg
    said: str | float | None = getattr(instruction, name)
    return said


def _shown(value: str | float) -> str:
    return value if isinstance(value, str) else f"{value:g}"


def _agree(name: str, value: str | float, said: str | float) -> bool:
    if name == "heading_deg" and isinstance(value, float) and isinstance(said, float):
        return abs((value - said + 180.0) % 360.0 - 180.0) <= GREATEST_VARIATION_DEG
    return value == said
