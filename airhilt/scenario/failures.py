"""Radio lines with the failures of their scenario applied.

The lines of a scenario say how everything should go. Only this module changes them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from airhilt.scenario.models import (
    Blocked,
    CallsignConfused,
    Delayed,
    Dropped,
    EngineFailure,
    Failure,
    Ignored,
    NotReceived,
    RadioLine,
    ReadbackWrong,
    Scenario,
    ScriptedCommand,
    StuckMicrophone,
)

LineFailure = ReadbackWrong | NotReceived | CallsignConfused | Delayed | Dropped | Ignored | Blocked


@dataclass(frozen=True)
class EffectiveLine:
    """Radio line with its failures applied."""

    declared: RadioLine
    """Line as the scenario declares it."""
    line: RadioLine | None
    """Line as it is said; None if it is never said."""
    late_s: float = 0.0
    """Delay of the line, in s."""
    failures: tuple[str, ...] = ()
    """Failures of the line, in words."""
    affected: frozenset[str] = frozenset()
    """Actors that act wrongly because of the failures."""
    uncleared: frozenset[str] = frozenset()
    """Affected actors that act without a clearance; a late clearance is one."""
    deaf: frozenset[str] = frozenset()
    """Actors that do not take the line for theirs, however well they hear it."""
    listens_first: bool = True
    """False if it is said over whatever is being said."""


def apply_failures(scenario: Scenario) -> list[EffectiveLine]:
    """Return the lines of a scenario with its failures, in the order of the file."""
    return [_effective(line, scenario.failures) for line in scenario.radio.lines]


def _effective(declared: RadioLine, failures: tuple[Failure, ...]) -> EffectiveLine:
    effective = EffectiveLine(declared, declared)
    for failure in failures:
        if isinstance(failure, EngineFailure | StuckMicrophone) or failure.line != declared.id:
            continue
        if effective.line is not None:
            effective = _failed(effective, effective.line, failure)
    return effective


def _failed(effective: EffectiveLine, line: RadioLine, failure: LineFailure) -> EffectiveLine:
    """Return a line with one more failure."""
    declared = effective.declared
    match failure:
        case ReadbackWrong(text=text, commands=commands):
            said = line.model_copy(update={"text": text, "commands": commands})
            what = f"{declared.speaker} reads back otherwise"
            return _uncleared(effective, what, {declared.speaker, *_actors(commands)}, line=said)
        case NotReceived(actor=actor):
            return _uncleared(
                effective,
                f"{actor} does not receive it",
                {actor},
                line=_without(line, actor),
                deaf=effective.deaf | {actor},
            )
        case Ignored(actor=actor):
            return _uncleared(effective, f"{actor} ignores it", {actor}, line=_without(line, actor))
        case CallsignConfused(meant=meant, taken_by=taken_by, text=text, commands=commands):
            said = _retarget(line, meant, taken_by, commands)
            if text is not None:
                said = said.model_copy(update={"text": text})
            what = f"{taken_by} takes it, {meant} was meant"
            return _uncleared(
                effective, what, {meant, taken_by}, line=said, deaf=effective.deaf | {meant}
            )
        case Delayed(by_s=by_s):
            what = f"it comes {by_s:g} s late"
            return _with(
                effective, what, _actors(declared.commands), late_s=effective.late_s + by_s
            )
        case Dropped():
            return _with(effective, "it is never said", _actors(declared.commands), line=None)
        case Blocked():
            what = f"{declared.speaker} does not listen before speaking"
            return _with(effective, what, _actors(declared.commands), listens_first=False)


def _uncleared(
    effective: EffectiveLine, what: str, actors: set[str], **changes: Any
) -> EffectiveLine:
    """Return a line with one more failure, by which actors do what they are not cleared for."""
    return _with(effective, what, actors, uncleared=effective.uncleared | actors, **changes)


def _with(effective: EffectiveLine, what: str, affected: set[str], **changes: Any) -> EffectiveLine:
    """Return a line with one more failure in words, and the changes that it makes."""
    return replace(
        effective,
        failures=(*effective.failures, what),
        affected=effective.affected | affected,
        **changes,
    )


def _actors(commands: tuple[ScriptedCommand, ...]) -> set[str]:
    return {scripted.actor for scripted in commands}


def _changed(
    line: RadioLine, change: Callable[[ScriptedCommand], ScriptedCommand | None]
) -> RadioLine:
    changed = (change(scripted) for scripted in line.commands)
    return line.model_copy(update={"commands": tuple(c for c in changed if c is not None)})


def _without(line: RadioLine, actor: str) -> RadioLine:
    return _changed(line, lambda scripted: None if scripted.actor == actor else scripted)


def _retarget(
    line: RadioLine, meant: str, taken_by: str, instead: tuple[ScriptedCommand, ...] | None
) -> RadioLine:
    """Return a line whose commands for one actor another carries out, or does others instead."""
    if instead is not None:
        kept = _without(line, meant)
        return kept.model_copy(update={"commands": (*kept.commands, *instead)})
    return _changed(
        line,
        lambda scripted: (
            scripted.model_copy(update={"actor": taken_by}) if scripted.actor == meant else scripted
        ),
    )
