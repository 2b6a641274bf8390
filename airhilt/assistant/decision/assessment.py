"""All threats on an airport's runways at one instant: the ladder's steps (a), (b) and (c)."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator

from airhilt.assistant.decision.clearance_conflicts import clearance_conflicts
from airhilt.assistant.decision.flight_path import in_flight_path
from airhilt.assistant.decision.meeting_runways import meeting_uses
from airhilt.assistant.decision.occupied_runway import occupied
from airhilt.assistant.decision.situation import RunwaySituation
from airhilt.assistant.decision.threats import Outlook, RunwayConfig, Threat


def threats_now(situation: RunwaySituation, config: RunwayConfig, t_ns: int) -> Iterator[Threat]:
    """Yield all threats; more than one may have the same key."""
    outlook = Outlook(situation, config, t_ns)
    uses = list(situation.uses.values())
    for use in uses:
        yield from occupied(outlook, use)
        yield from in_flight_path(outlook, use)
    for first, second in itertools.combinations(uses, 2):
        yield from meeting_uses(outlook, first, second)
    yield from clearance_conflicts(outlook)


def worst_threats(
    config: RunwayConfig, situation: RunwaySituation, t_ns: int
) -> dict[tuple[str, ...], Threat]:
    """Return the most severe threat of each key, by the rules that are applied."""
    found = threats_now(situation, config, t_ns)
    return worst(threat for threat in found if not set(threat.rules).isdisjoint(config.rules))


def worst(found: Iterable[Threat]) -> dict[tuple[str, ...], Threat]:
    """Return the most severe of some threats with the same key, for each key."""
    threats: dict[tuple[str, ...], Threat] = {}
    for threat in found:
        known = threats.setdefault(threat.key, threat)
        if threat.severity.rank > known.severity.rank:
            threats[threat.key] = threat
    return threats
