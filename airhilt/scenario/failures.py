"""Radio lines with the failures of their scenario applied.

The lines of a scenario say how everything should go. Only this module changes them.
"""

from __future__ import annotations

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
    for_whom = {scripted.actor for scripted in declared.commands}
    match failure:
        case ReadbackWrong(text=text, commands=commands):
            actors = {declared.speaker, *(scripted.actor for scripted in commands)}
            said = line.model_copy(update={"text": text, "commands": commands})
            what = f"{declared.speaker} reads back otherwise"
            return _uncleared(effective, what, actors, line=said)
        case NotReceived(actor=actor):
            what, deaf = f"{actor} does not receive it", effective.deaf | {actor}
            return _uncleared(effective, what, {actor}, line=_without(line, actor), deaf=deaf)
        case Ignored(actor=actor):
            return _uncleared(effective, f"{actor} ignores it", {actor}, line=_without(line, actor))
        case CallsignConfused(meant=meant, taken_by=taken_by):
            said, deaf = _retargeted(line, failure), effective.deaf | {meant}
            what = f"{taken_by} takes it, {meant} was meant"
            return _uncleared(effective, what, {meant, taken_by}, line=said, deaf=deaf)
        case Delayed(by_s=by_s):
            late_s = effective.late_s + by_s
            return _with(effective, f"it comes {by_s:g} s late", for_whom, late_s=late_s)
        case Dropped():
            return _with(effective, "it is never said", for_whom, line=None)
        case Blocked():
            what = f"{declared.speaker} does not listen before speaking"
            return _with(effective, what, for_whom, listens_first=False)


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


def _without(line: RadioLine, actor: str) -> RadioLine:
    kept = tuple(scripted for scripted in line.commands if scripted.actor != actor)
    return line.model_copy(update={"commands": kept})


def _retargeted(line: RadioLine, failure: CallsignConfused) -> RadioLine:
    """Return a line whose commands for one actor another carries out, or does others instead."""
    commands = tuple(
        scripted.model_copy(update={"actor": failure.taken_by})
        if scripted.actor == failure.meant
        else scripted
        for scripted in line.commands
    )
    if failure.commands is not None:
        commands = (*_without(line, failure.meant).commands, *failure.commands)
    text = line.text if failure.text is None else failure.text
    return line.model_copy(update={"commands": commands, "text": text})
