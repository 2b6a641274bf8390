"""What a scenario's failures make of its radio lines.

The lines of a scenario say how everything should go. This is the only place where that changes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

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


@dataclass(frozen=True)
class EffectiveLine:
    """A line as it really happens."""

    declared: RadioLine
    line: RadioLine | None
    """None if it is never said."""
    late_s: float
    failures: tuple[str, ...]
    """What went wrong with it, in words."""
    misled: frozenset[str]
    """Actors that do, or leave undone, something because of that."""
    deaf: frozenset[str] = frozenset()
    """Actors that do not take it for theirs, however well they hear it."""
    listens_first: bool = True
    """False: it is said over whatever is being said."""


def apply_failures(scenario: Scenario) -> list[EffectiveLine]:
    """Return the lines of a scenario with its failures, in the order of the file."""
    return [_happening(line, scenario.failures) for line in scenario.radio.lines]


def _happening(declared: RadioLine, failures: tuple[Failure, ...]) -> EffectiveLine:
    line: RadioLine | None = declared
    late_s = 0.0
    texts: list[str] = []
    misled: set[str] = set()
    deaf: set[str] = set()
    listens_first = True
    for failure in failures:
        if isinstance(failure, EngineFailure | StuckMicrophone):
            continue
        if failure.line != declared.id or line is None:
            continue
        match failure:
            case ReadbackWrong(text=text, commands=commands):
                misled |= {declared.speaker, *_actors(commands)}
                line = line.model_copy(update={"text": text, "commands": commands})
                texts.append(f"{declared.speaker} reads back otherwise")
            case NotReceived(actor=actor):
                misled.add(actor)
                deaf.add(actor)
                line = _without(line, actor)
                texts.append(f"{actor} does not receive it")
            case Ignored(actor=actor):
                misled.add(actor)
                line = _without(line, actor)
                texts.append(f"{actor} ignores it")
            case CallsignConfused(meant=meant, taken_by=taken_by, text=text):
                misled |= {meant, taken_by}
                deaf.add(meant)
                line = _retarget(line, meant, taken_by)
                if text is not None:
                    line = line.model_copy(update={"text": text})
                texts.append(f"{taken_by} takes it, {meant} was meant")
            case Delayed(by_s=by_s):
                misled |= _actors(declared.commands)
                late_s += by_s
                texts.append(f"it comes {by_s:g} s late")
            case Dropped():
                misled |= _actors(declared.commands)
                line = None
                texts.append("it is never said")
            case Blocked():
                misled |= _actors(declared.commands)
                listens_first = False
                texts.append(f"{declared.speaker} does not listen before speaking")
    return EffectiveLine(
        declared,
        line,
        late_s,
        tuple(texts),
        frozenset(misled),
        frozenset(deaf),
        listens_first,
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


def _retarget(line: RadioLine, meant: str, taken_by: str) -> RadioLine:
    return _changed(
        line,
        lambda scripted: (
            scripted.model_copy(update={"actor": taken_by}) if scripted.actor == meant else scripted
        ),
    )
