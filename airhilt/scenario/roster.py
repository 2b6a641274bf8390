"""The actors of a scenario by the names that messages use."""

from __future__ import annotations

from airhilt.scenario.models import AircraftSpec, Scenario, VehicleSpec, WildlifeSpec


def roster_of(scenario: Scenario) -> tuple[str, ...]:
    """Return the callsigns on the roster of the briefing."""
    return tuple(
        actor.callsign
        for actor in scenario.actors
        if isinstance(actor, VehicleSpec) or (isinstance(actor, AircraftSpec) and actor.on_roster)
    )


def callsigns_of(scenario: Scenario) -> dict[str, str]:
    """Return the callsign of each actor by its callsign and by its 24-bit address."""
    return {actor.callsign: actor.callsign for actor in scenario.actors} | {
        actor.icao24: actor.callsign
        for actor in scenario.actors
        if not isinstance(actor, WildlifeSpec)
    }
