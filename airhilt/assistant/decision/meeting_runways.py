"""Two use one runway in opposite directions, or runways that cross, at about the same time."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.assistant.decision.mobiles import ROLLING_M_S, Use
from airhilt.assistant.decision.threats import Outlook, Threat, obstruction
from airhilt.messages import Severity


def meeting_uses(outlook: Outlook, first: Use, second: Use) -> Iterator[Threat]:
    """Yield the threat that two users of runways meet."""
    if first.strip is second.strip:
        yield from _head_on(outlook, first, second)
    else:
        yield from _crossing(outlook, first, second)


def _head_on(outlook: Outlook, first: Use, second: Use) -> Iterator[Threat]:
    """Yield the threat of two users of one runway in opposite directions."""
    if first.direction is second.direction:
        return
    gap_m = first.direction.along_m(second.mobile.point) - first.along_m
    kinds = {first.kind, second.kind}
    if gap_m < 0.0 or kinds == {"arrival", "rollout"}:  # The latter is on the runway.
        return
    if kinds == {"arrival"}:
        time_to_go_s = min(use.time_to_threshold_s(outlook.t_ns) for use in (first, second))
        severity = outlook.urgency(first, time_to_go_s)
    else:
        closing_m_s = first.mobile.speed_m_s + second.mobile.speed_m_s
        time_to_go_s = gap_m / max(closing_m_s, ROLLING_M_S)
        severity = Severity.WARNING
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
    times_s = [use.time_to_s(use.direction.along_m(point), outlook.t_ns) for use in (first, second)]
    own_s, other_s = times_s
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
