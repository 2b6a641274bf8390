"""Checks of references: to actors and radio lines."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.scenario.models import (
    AircraftSpec,
    LineBegun,
    LineEnded,
    Scenario,
    VehicleSpec,
    WildlifeSpec,
)
from airhilt.scenario.problems import Problem, unknown
from airhilt.world.checks.walk import conditions_of, models_of


def dangling_references(scenario: Scenario) -> Iterator[Problem]:
    """Yield references to actors and lines that do not exist, and pairs of one actor."""
    callsigns = [actor.callsign for actor in scenario.actors]
    line_ids = [line.id for line in scenario.radio.lines]
    for path, callsign in _mentioned_actors(scenario):
        if callsign not in callsigns:
            yield unknown(path, "actor", callsign, callsigns)
    for path, condition in conditions_of(scenario):
        if isinstance(condition, LineBegun | LineEnded) and condition.line not in line_ids:
            yield unknown(f"{path}/line", "radio line", condition.line, line_ids)
        pair = getattr(condition, "actors", None)
        if pair is not None and pair[0] == pair[1]:
            yield Problem(f"{path}/actors", f"found {pair[0]!r} twice; expected two actors")
    aircraft = {one.callsign: one for one in scenario.actors if isinstance(one, AircraftSpec)}
    for field, listed in (("cockpits", scenario.cockpits), ("tcas", scenario.tcas)):
        for index, callsign in enumerate(listed):
            path = f"{field}/{index}"
            if callsign not in aircraft:
                yield unknown(path, "aircraft", callsign, aircraft)
            elif field == "tcas" and not aircraft[callsign].transponder.has_adsb:
                found = f"{callsign!r} has no Mode S transponder"
                yield Problem(path, f"{found}; expected one: TCAS II coordinates by it")
    if scenario.conflict is not None and len(set(scenario.conflict.actors)) < 2:
        yield Problem("conflict/actors", "found one actor twice; expected two actors")


def _mentioned_actors(scenario: Scenario) -> Iterator[tuple[str, str]]:
    """Yield the path and the callsign of every reference to an actor."""
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
