"""All threats on an airport's runways at one instant: the ladder's steps (a), (b) and (c)."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator

from airhilt.assistant.decision.clearance_conflicts import clearance_conflicts
from airhilt.assistant.decision.flight_path import in_flight_path
from airhilt.assistant.decision.mobiles import ROLLING_M_S, Use
from airhilt.assistant.decision.occupied_runway import occupied
from airhilt.assistant.decision.situation import RunwaySituation
from airhilt.assistant.decision.threats import Outlook, RunwayConfig, Threat, obstruction
from airhilt.messages import Severity


def worst_threats(
    config: RunwayConfig, situation: RunwaySituation, t_ns: int
) -> dict[tuple[str, ...], Threat]:
    """Return the most severe threat of each key, by the rules that are applied."""
    found = _threats(Outlook(situation, config, t_ns))
    return worst(threat for threat in found if threat.rule in config.rules)


def worst(found: Iterable[Threat]) -> dict[tuple[str, ...], Threat]:
    """Return the most severe of some threats with the same key, for each key."""
    threats: dict[tuple[str, ...], Threat] = {}
    for threat in found:
        known = threats.setdefault(threat.key, threat)
        if threat.severity.rank > known.severity.rank:
            threats[threat.key] = threat
    return threats


def _threats(outlook: Outlook) -> Iterator[Threat]:
    """Yield all threats; more than one may have the same key."""
    uses = list(outlook.situation.uses.values())
    for use in uses:
        yield from occupied(outlook, use)
        yield from in_flight_path(outlook, use)
    for first, second in itertools.combinations(uses, 2):
        if first.strip is not second.strip:
            yield from _crossing(outlook, first, second)
        elif first.direction is not second.direction:
            yield from _head_on(outlook, first, second)
    yield from clearance_conflicts(outlook)


def _head_on(outlook: Outlook, first: Use, second: Use) -> Iterator[Threat]:
    """Yield the threat of two users of one runway in opposite directions."""
    gap_m = first.direction.along_m(second.mobile.point) - first.along_m
    kinds = {first.kind, second.kind}
    if gap_m < 0.0 or kinds == {"arrival", "rollout"}:  # The latter is on the runway.
        return
    severity: Severity | None = Severity.WARNING
    if kinds == {"arrival"}:
        time_to_go_s = min(use.time_to_threshold_s(outlook.t_ns) for use in (first, second))
        severity = outlook.urgency(first, time_to_go_s)
    else:
        closing_m_s = first.mobile.speed_m_s + second.mobile.speed_m_s
        time_to_go_s = gap_m / max(closing_m_s, ROLLING_M_S)
    if severity is not None:
        other, where = second.mobile.callsign, first.strip.name
        yield obstruction(
            first, "opposite", other, severity, time_to_go_s, where=where, rule="meeting"
        )


def _crossing(outlook: Outlook, first: Use, second: Use) -> Iterator[Threat]:
    """Yield the threat of two users at the crossing of their runways at about the same time."""
    point = outlook.situation.aerodrome.crossing(first.strip, second.strip)
    if point is None:
        return
    own_s, other_s = (
        use.time_to_s(use.direction.along_m(point), outlook.t_ns) for use in (first, second)
    )
    if own_s is None or other_s is None:
        return
    time_to_go_s = min(own_s, other_s)
    config = outlook.config
    if abs(own_s - other_s) > config.crossing_margin_s or time_to_go_s > config.caution_s:
        return
    severity = Severity.WARNING if time_to_go_s <= config.warning_s else Severity.CAUTION
    other, where = second.mobile.callsign, second.direction.ident
    yield obstruction(
        first, "on crossing", other, severity, time_to_go_s, where=where, rule="meeting"
    )
