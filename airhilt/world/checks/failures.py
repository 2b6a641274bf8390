"""Checks of failures: whether each has something to change."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.errors import AirhiltError
from airhilt.scenario.models import (
    AircraftSpec,
    CallsignConfused,
    Dropped,
    EngineFailure,
    Scenario,
    StuckMicrophone,
)
from airhilt.scenario.problems import Problem, unknown
from airhilt.world.flight.aircraft_type import load_aircraft_type


def idle_failures(scenario: Scenario) -> Iterator[Problem]:
    """Yield failures of lines that do not exist, and failures that would change nothing."""
    lines = {line.id: line for line in scenario.radio.lines}
    for index, failure in enumerate(scenario.failures):
        path = f"failures/{index}"
        if isinstance(failure, EngineFailure):
            yield from _engine(path, failure, scenario)
            continue
        if isinstance(failure, StuckMicrophone):
            yield from _microphone(path, failure, scenario)
            continue
        if failure.line not in lines:
            yield unknown(f"{path}/line", "radio line", failure.line, lines)
            continue
        told = [scripted.actor for scripted in lines[failure.line].commands]
        field = next((name for name in ("actor", "meant") if hasattr(failure, name)), None)
        if field is not None and getattr(failure, field) not in told:
            yield Problem(
                f"{path}/{field}",
                f"found {getattr(failure, field)!r}, whom line {failure.line!r} tells nothing; "
                f"expected {' or '.join(told) or 'a line with commands'}",
            )
        if isinstance(failure, CallsignConfused) and failure.taken_by == failure.meant:
            yield Problem(f"{path}/taken_by", f"found {failure.meant!r} twice; expected two actors")
        if isinstance(failure, Dropped) and any(
            getattr(other, "line", None) == failure.line
            for number, other in enumerate(scenario.failures)
            if number != index
        ):
            yield Problem(f"{path}/line", f"line {failure.line!r} is dropped and fails otherwise")


def _microphone(path: str, failure: StuckMicrophone, scenario: Scenario) -> Iterator[Problem]:
    talks = any(failure.actor in (line.speaker, line.to) for line in scenario.radio.lines)
    if not talks and any(actor.callsign == failure.actor for actor in scenario.actors):
        yield Problem(
            f"{path}/actor",
            f"{failure.actor!r} is on no frequency; expected an actor with a line of its own, or "
            "to it",
        )


def _engine(path: str, failure: EngineFailure, scenario: Scenario) -> Iterator[Problem]:
    actor = next((one for one in scenario.actors if one.callsign == failure.actor), None)
    if actor is None:
        return  # Named elsewhere.
    if not isinstance(actor, AircraftSpec):
        yield Problem(f"{path}/actor", f"found a {actor.type}; expected an aircraft")
        return
    try:
        engines = len(load_aircraft_type(actor.aircraft, scenario.files).mesh.engines_m)
    except AirhiltError:
        return  # Named elsewhere.
    if failure.engine >= engines:
        yield Problem(
            f"{path}/engine",
            f"found {failure.engine}; expected 0 to {engines - 1}, the engines of a "
            f"{actor.aircraft}",
        )
