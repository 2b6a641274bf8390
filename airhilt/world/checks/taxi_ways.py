"""Checks of ways over the airport: taxi commands, exits, and where aircraft stand."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from airhilt.commands import (
    ContinueCommand,
    HoldPositionCommand,
    LandCommand,
    TaxiCommand,
)
from airhilt.errors import AirhiltError
from airhilt.geodesy.positions import Position, RunwayPosition
from airhilt.geodesy.wgs84 import Place, onward
from airhilt.scenario.models import (
    AircraftSpec,
    AircraftStart,
    HoldingShort,
    LinedUp,
    Scenario,
    Standing,
)
from airhilt.scenario.problems import Problem
from airhilt.world.checks.walk import commands_of
from airhilt.world.site import ScenarioSite

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Layout


def missing_ways(scenario: Scenario, site: ScenarioSite, layout: Layout) -> Iterator[Problem]:
    """Yield taxi commands without a way, and aircraft that stand off the taxiways.

    The place after a takeoff or a landing is not known beforehand; a way then begins at a stand.
    """
    somewhere = layout.node(layout.stands[0]) if layout.stands else None
    begins: dict[str, Place | None] = {}
    for index, actor in enumerate(scenario.actors):
        begins[actor.callsign] = here = _stands_at(actor.initial, site)
        if here is None or somewhere is None or not isinstance(actor, AircraftSpec):
            continue
        try:
            layout.taxi_route(here, somewhere)
        except AirhiltError as error:
            yield Problem(f"actors/{index}/initial", str(error))
    for path, callsign, command in commands_of(scenario):
        if isinstance(command, TaxiCommand):
            end = _place(site, command.to)
            if end is None:
                continue  # Named elsewhere.
            try:
                if not command.off_taxiways:
                    layout.taxi_route(begins.get(callsign) or somewhere or end, end, command.via)
            except AirhiltError as error:
                yield Problem(path, str(error))
            begins[callsign] = end
        elif not isinstance(command, HoldPositionCommand | ContinueCommand):
            begins[callsign] = None
        if isinstance(command, LandCommand) and command.exit is not None:
            yield from _exit(path, command.runway, command.exit, layout)


def _exit(path: str, runway: str, name: str, layout: Layout) -> Iterator[Problem]:
    try:
        exits = layout.exits(runway)
    except AirhiltError:
        return  # Named elsewhere.
    if not any(name in (way.taxiway, way.position) for way in exits):
        known = ", ".join(dict.fromkeys(way.position for way in exits)) or "none"
        yield Problem(f"{path}/exit", f"runway {runway} has no exit {name!r}; there are: {known}")


def _stands_at(initial: AircraftStart, site: ScenarioSite) -> Place | None:
    """Return where an actor begins on the ground; None if it does not, or its place is unknown."""
    match initial:
        case Standing(position=position):
            return _place(site, position)
        case HoldingShort(runway=runway, taxiway=taxiway, before_m=before_m):
            try:
                hold = site.airport.hold(runway, taxiway)
            except AirhiltError:
                return None
            return onward(hold.place, hold.heading_rad, -before_m)
        case LinedUp(runway=runway):
            return _place(site, RunwayPosition(type="runway", runway=runway, along_m=0.0))
    return None


def _place(site: ScenarioSite, position: Position) -> Place | None:
    """Return where a position is; None if it refers to nothing."""
    try:
        return site.place(position)
    except AirhiltError:
        return None
