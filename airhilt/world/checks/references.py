"""Checks of references: to actors and radio lines."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.host import library
from airhilt.scenario.models import (
    AircraftSpec,
    LineBegun,
    LineEnded,
    Scenario,
    VehicleSpec,
    WildlifeSpec,
)
from airhilt.scenario.problems import Problem
from airhilt.world.checks.walk import conditions_of, models_of


def dangling_references(scenario: Scenario) -> Iterator[Problem]:
    """Yield references to actors and lines that do not exist, and pairs of one actor."""
    callsigns = [actor.callsign for actor in scenario.actors]
    line_ids = [line.id for line in scenario.radio.lines]
    for path, callsign in _mentioned_actors(scenario):
        if callsign not in callsigns:
            yield Problem(path, f"no actor {callsign!r}{library.nearest(callsign, callsigns)}")
    for path, condition in conditions_of(scenario):
        if isinstance(condition, LineBegun | LineEnded) and condition.line not in line_ids:
            yield Problem(
                f"{path}/line",
                f"no radio line {condition.line!r}{library.nearest(condition.line, line_ids)}",
            )
        pair = getattr(condition, "actors", None)
        if pair is not None and pair[0] == pair[1]:
            yield Problem(f"{path}/actors", f"found {pair[0]!r} twice; expected two actors")
    for index, callsign in enumerate(scenario.cockpits):
        yield from _no_aircraft(scenario, f"cockpits/{index}", callsign)
    for index, callsign in enumerate(scenario.tcas):
        yield from _no_tcas(scenario, f"tcas/{index}", callsign)
    if scenario.conflict is not None and len(set(scenario.conflict.actors)) < 2:
        yield Problem("conflict/actors", "found one actor twice; expected two actors")


def _no_aircraft(scenario: Scenario, path: str, callsign: str) -> Iterator[Problem]:
    """Yield a problem if the scenario has no aircraft with a callsign."""
    aircraft = [actor.callsign for actor in scenario.actors if isinstance(actor, AircraftSpec)]
    if callsign not in aircraft:
        yield Problem(path, f"no aircraft {callsign!r}{library.nearest(callsign, aircraft)}")


def _no_tcas(scenario: Scenario, path: str, callsign: str) -> Iterator[Problem]:
    """Yield a problem if the scenario has no aircraft with a callsign that can carry TCAS II."""
    yield from _no_aircraft(scenario, path, callsign)
    for actor in scenario.actors:
        if not isinstance(actor, AircraftSpec) or actor.callsign != callsign:
            continue
        if not actor.transponder.has_adsb:
            found = f"{callsign!r} has no Mode S transponder"
            yield Problem(path, f"{found}; expected one: TCAS II coordinates by it")


def _mentioned_actors(scenario: Scenario) -> Iterator[tuple[str, str]]:
    """Yield every callsign that refers to an actor, with its path."""
    for path, model in models_of(scenario, ""):
        if isinstance(model, AircraftSpec | VehicleSpec | WildlifeSpec):
            continue
        for field in ("actor", "meant", "taken_by"):
            callsign = getattr(model, field, None)
            if callsign is not None:
                yield f"{path}/{field}", callsign
        if model is not scenario:
            for number, callsign in enumerate(getattr(model, "actors", ())):
                yield f"{path}/actors/{number}", callsign
