"""Checks of the taxiways, places and runways that taxi commands name."""

from __future__ import annotations

from collections.abc import Iterator

from pydantic import BaseModel

from airhilt.commands import (
    CrossCommand,
    EnterCommand,
    FollowCommand,
    HoldShortCommand,
    LandCommand,
    TaxiToCommand,
    TurnAtCommand,
    VacateCommand,
)
from airhilt.errors import AirhiltError
from airhilt.scenario.models import Scenario
from airhilt.scenario.problems import Problem, unknown
from airhilt.world.actors.taxi_clearances import nodes_of
from airhilt.world.checks.walk import models_of
from airhilt.world.surface.layout import Layout


def unknown_taxiways(scenario: Scenario, layout: Layout) -> Iterator[Problem]:
    """Yield taxiways, places and runways of taxi commands that the airport does not have."""
    taxiways = list(dict.fromkeys(edge.taxiway for edge in layout.airport.taxiways.edges))
    exits = [*taxiways, *(hold.position for hold in layout.holds.values())]
    for path, model in models_of(scenario):
        for field, name in _taxiways(model):
            if name not in (exits if field == "exit" else taxiways):
                yield unknown(f"{path}/{field}", "taxiway", name, taxiways)
        for field, name in _runways(model):
            try:
                layout.runway(name)
            except AirhiltError as error:
                yield Problem(f"{path}/{field}", str(error))
        if isinstance(model, TaxiToCommand) and model.place and not model.runway:
            found = nodes_of(layout, model.place)
            if not found:
                known = [*layout.stands, *taxiways]
                yield unknown(f"{path}/place", "stand or taxiway", model.place, known)


def _taxiways(model: BaseModel) -> Iterator[tuple[str, str]]:
    """Yield the fields of a command that name taxiways, with their names."""
    match model:
        case TaxiToCommand(via=via):
            yield from ((f"via/{index}", name) for index, name in enumerate(via))
        case HoldShortCommand(taxiway=str(name)) | TurnAtCommand(taxiway=name):
            yield "taxiway", name
        case CrossCommand(at=str(name)) | EnterCommand(at=str(name)):
            yield "at", name
        case VacateCommand(exit=str(name)):
            yield "exit", name
    for field, name in _stops(model):
        if not name[:1].isdigit():
            yield field, name


def _runways(model: BaseModel) -> Iterator[tuple[str, str]]:
    """Yield the fields of a command that name runways besides ``runway``, with their names."""
    match model:
        case TaxiToCommand(cross=cross):
            yield from ((f"cross/{index}", name) for index, name in enumerate(cross))
        case LandCommand(hold_short=str(name)):
            yield "hold_short", name
    for field, name in _stops(model):
        if name[:1].isdigit():
            yield field, name


def _stops(model: BaseModel) -> Iterator[tuple[str, str]]:
    """Yield the runways and taxiways that a command says to stop before, with their fields."""
    if isinstance(model, TaxiToCommand | FollowCommand):
        yield from ((f"hold_short/{index}", name) for index, name in enumerate(model.hold_short))
