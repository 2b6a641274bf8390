"""The pair of actors that the conflict of a scenario is between."""

from __future__ import annotations

from airhilt.scenario.models import Pair, Scenario


def pair_of(scenario: Scenario) -> Pair | None:
    """Return the annotated pair in the order in which the actors are listed."""
    if scenario.conflict is None:
        return None
    order = [actor.callsign for actor in scenario.actors]
    first, second = sorted(scenario.conflict.actors, key=order.index)
    return first, second
