"""Dependencies between the radio lines of a scenario."""

from __future__ import annotations

from collections.abc import Set

from airhilt.scenario.models import (
    AllOf,
    AnyOf,
    Condition,
    LineBegun,
    LineEnded,
    RadioLine,
    Scenario,
    TimeReached,
)
from airhilt.scenario.models.conditions import parts


def needed_lines(scenario: Scenario) -> dict[str, tuple[str, ...]]:
    """Return, for each line, the lines that its speaker must have understood to say it.

    These are first the line that it answers, then the lines to its speaker whose end it waits for.
    """
    answered = _answered(scenario)
    lines = {line.id: line for line in scenario.radio.lines}
    needed: dict[str, tuple[str, ...]] = {}
    for line in scenario.radio.lines:
        names = [answered[line.id]] if line.id in answered else []
        if line.when is not None:
            names += [name for name in _awaited(line.when) if lines[name].to == line.speaker]
        needed[line.id] = tuple(dict.fromkeys(names))
    return needed


def _answered(scenario: Scenario) -> dict[str, str]:
    """Return the line that each line answers: the one that it names, or the one it reads back.

    An actor reads back the last line before on the frequency, if the addressee of the readback
    said that line to the actor.
    """
    callsigns = {actor.callsign for actor in scenario.actors}
    found: dict[str, str] = {}
    last: dict[int, RadioLine] = {}
    for line in scenario.radio.lines:
        before = last.get(line.frequency_khz)
        if line.answers is not None:
            found[line.id] = line.answers
        elif (
            before is not None
            and line.speaker in callsigns
            and (before.speaker, before.to) == (line.to, line.speaker)
        ):
            found[line.id] = before.id
        last[line.frequency_khz] = line
    return found


def controlling_units(scenario: Scenario) -> dict[str, tuple[int, ...]]:
    """Return the units with a controller, and the frequencies of each in kHz.

    They are the controller of the radio, which comes first, those that the scenario declares, and
    every other unit that speaks with an actor in the script on a frequency of its own.
    """
    actors = {actor.callsign for actor in scenario.actors}
    spoken: dict[str, dict[int, None]] = {}
    for line in scenario.radio.lines:
        for unit, other in ((line.speaker, line.to), (line.to, line.speaker)):
            if unit is not None and unit not in actors and other in {*actors, None}:
                spoken.setdefault(unit, {})[line.frequency_khz] = None
    found = {scenario.radio.controller: spoken.get(scenario.radio.controller, {})}
    for unit, controller in scenario.controllers.items():
        on = dict.fromkeys(controller.frequencies_khz)
        found[unit] = found.get(unit, spoken.get(unit, {})) | on
    for unit, on in spoken.items():
        taken = {frequency_khz for each in found.values() for frequency_khz in each}
        if unit not in found and taken.isdisjoint(on):
            found[unit] = on
    return {unit: tuple(on) for unit, on in found.items()}


def tunable_units(scenario: Scenario) -> list[str]:
    """Return the units on some frequency: of radio lines, or of the scenario's controllers."""
    actors = {actor.callsign for actor in scenario.actors}
    named = [name for line in scenario.radio.lines for name in (line.speaker, line.to) if name]
    named += [unit for unit, each in scenario.controllers.items() if each.frequencies_khz]
    return [name for name in dict.fromkeys(named) if name not in actors]


def is_named_by(words: str, unit: str) -> bool:
    """Return whether words, such as "ground", name a unit."""
    return set(words.casefold().split()) <= set(unit.casefold().split())


def unsayable_lines(scenario: Scenario) -> Set[str]:
    """Return the ids of the lines whose condition can never come true.

    Such a line waits for itself, for lines that wait for it, or for a time after the run.
    """
    waiting = {line.id: line.when for line in scenario.radio.lines if line.when is not None}
    while sayable := [
        name
        for name, when in waiting.items()
        if _can_come_true(when, waiting.keys(), scenario.duration_s)
    ]:
        for name in sayable:
            del waiting[name]
    return waiting.keys()


def _can_come_true(condition: Condition, waiting: Set[str], duration_s: float) -> bool:
    """Return whether a condition may come true before any of the lines that wait."""
    match condition:
        case TimeReached(at_s=at_s):
            return at_s < duration_s
        case LineBegun(line=line) | LineEnded(line=line):
            return line not in waiting
        case AllOf(conditions=inner):
            return all(_can_come_true(one, waiting, duration_s) for one in inner)
        case AnyOf(conditions=inner):
            return any(_can_come_true(one, waiting, duration_s) for one in inner)
        case _:
            return True


def _awaited(condition: Condition) -> list[str]:
    """Return the lines whose end a condition asks for."""
    return [each.line for each in parts(condition) if isinstance(each, LineEnded)]
