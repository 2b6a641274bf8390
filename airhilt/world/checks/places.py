"""Checks of places: runways, holds, nodes, distances on the ground, and ways over the airport."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from airhilt.commands import ContinueCommand, HoldPositionCommand, LandCommand, TaxiCommand
from airhilt.errors import AirhiltError
from airhilt.geodesy.positions import HoldShortPosition, NodePosition, Position, RunwayPosition
from airhilt.geodesy.wgs84 import Place, distance_m, onward
from airhilt.scenario.models import (
    AircraftSpec,
    AircraftStart,
    HoldingShort,
    LinedUp,
    Scenario,
    Standing,
)
from airhilt.scenario.problems import Problem
from airhilt.world.checks.walk import commands_of, models_of
from airhilt.world.site import ScenarioSite

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Layout

GREATEST_SURFACE_DISTANCE_M = 10_000.0
"""Greatest distance of what stands on the ground from the airport's reference point, in m."""


def unknown_places(scenario: Scenario, site: ScenarioSite) -> Iterator[Problem]:
    """Yield what refers to a runway, a hold, a node or an airport that does not exist."""
    if scenario.surface_surveillance is not None and site.layout is None:
        yield Problem(
            "surface_surveillance", "the scene is en route; expected a scene of type 'airport'"
        )
    for path, model in models_of(scenario):
        position: Position | None = None
        match model:
            case HoldShortPosition() | NodePosition() | RunwayPosition():
                position = model
            case HoldingShort(runway=runway, taxiway=taxiway):
                position = HoldShortPosition(type="hold_short", runway=runway, taxiway=taxiway)
            case _:
                ident = getattr(model, "runway", None)
                if ident is None:
                    continue
                position = RunwayPosition(type="runway", runway=ident, along_m=0.0)
        try:
            site.place(position)
        except AirhiltError as error:
            yield Problem(path, str(error))
    for index, actor in enumerate(scenario.actors):
        place = None
        if isinstance(actor.initial, Standing):
            place = _place(site, actor.initial.position)
        if place is None:
            continue  # It is in the air, or named above.
        away_m = distance_m(place, site.place(site.centre))
        if site.layout is None or away_m > GREATEST_SURFACE_DISTANCE_M:
            yield Problem(
                f"actors/{index}/initial/position",
                f"found a place {away_m / 1000.0:.1f} km from the centre of "
                f"{'an airport' if site.layout else 'airspace without an airport'}; expected "
                f"an airport, and at most {GREATEST_SURFACE_DISTANCE_M / 1000.0:g} km",
            )


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
