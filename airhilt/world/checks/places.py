"""Checks of places: runways, hold-short positions, nodes, and distances on the ground."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.errors import AirhiltError
from airhilt.geodesy.positions import HoldShortPosition, NodePosition, Position, RunwayPosition
from airhilt.geodesy.wgs84 import distance_m
from airhilt.scenario.models import HoldingShort, Scenario, Standing
from airhilt.scenario.problems import Problem
from airhilt.world.checks.walk import models_of
from airhilt.world.site import ScenarioSite

GREATEST_SURFACE_DISTANCE_M = 10_000.0
"""Greatest distance of what stands on the ground from the airport's reference point, in m."""


def missing_airport(scenario: Scenario, site: ScenarioSite) -> Iterator[Problem]:
    """Yield surface surveillance where there is no airport."""
    if scenario.surface_surveillance is not None and site.layout is None:
        yield Problem(
            "surface_surveillance", "the scene is en route; expected a scene of type 'airport'"
        )


def unknown_places(scenario: Scenario, site: ScenarioSite) -> Iterator[Problem]:
    """Yield what refers to a runway, a hold-short position or a node that does not exist."""
    for path, model in models_of(scenario, ""):
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
        if not isinstance(actor.initial, Standing):
            continue
        try:
            away_m = distance_m(site.place(actor.initial.position), site.place(site.centre))
        except AirhiltError:
            continue  # Named above.
        if site.layout is None or away_m > GREATEST_SURFACE_DISTANCE_M:
            yield Problem(
                f"actors/{index}/initial/position",
                f"found a place {away_m / 1000.0:.1f} km from the centre of "
                f"{'an airport' if site.layout else 'airspace without an airport'}; expected "
                f"an airport, and at most {GREATEST_SURFACE_DISTANCE_M / 1000.0:g} km",
            )
