"""Steps (a) and (c) of the ladder: what was said does not agree, or was not said."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from airhilt.assistant.decision.aerodrome import Strip
from airhilt.assistant.decision.clearances import Discrepancy, Unanswered
from airhilt.assistant.decision.findings import NotReadBack, OpposedClearances, RunwayMisread
from airhilt.assistant.decision.threats import Outlook, Snapshot, Threat
from airhilt.messages import Severity
from airhilt.phraseology import Instruction


def clearance_conflicts(outlook: Outlook) -> Iterator[Threat]:
    """Yield wrong readbacks, missing ones, and clearances that oppose each other."""
    clearances = outlook.situation.clearances
    for discrepancy in clearances.discrepancies(outlook.t_ns):
        yield from misread(outlook, discrepancy)
    for unanswered in clearances.unanswered(outlook.t_ns):
        yield from _not_read_back(outlook, unanswered)
    yield from _opposed(outlook)


def misread(outlook: Snapshot, discrepancy: Discrepancy) -> Iterator[Threat]:
    """Yield the threat of a readback that is wrong, or somebody else's, for an active runway."""
    callsign, addressed = discrepancy.callsign, discrepancy.addressed
    given, read = discrepancy.given, discrepancy.read
    active = activity_of(outlook, callsign, (read, given))
    if active is None:
        return
    strip, traffic = active
    parties = tuple(dict.fromkeys((callsign, addressed)))
    yield Threat(
        key=("readback", callsign, str(discrepancy.t_end_ns)),
        severity=Severity.CAUTION,
        strip=strip,
        runway=read.runway or strip.directions[0].ident,
        parties=parties,
        traffic=tuple(dict.fromkeys((*parties, traffic))),
        finding=RunwayMisread(callsign, addressed, given, read, traffic),
        rule="readback_mismatch" if callsign == addressed else "recipient_ambiguity",
        sources=("radio", "adsb"),
        kind="readback_mismatch",
        radio_ids=discrepancy.radio_ids,
    )


def _not_read_back(outlook: Outlook, unanswered: Unanswered) -> Iterator[Threat]:
    """Yield the threat that somebody does not know to keep off an active runway."""
    callsign, given = unanswered.callsign, unanswered.given
    active = activity_of(outlook, callsign, (given,))
    if active is None:
        return
    strip, traffic = active
    yield Threat(
        key=("silence", callsign, str(unanswered.t_end_ns)),
        severity=Severity.CAUTION,
        strip=strip,
        runway=given.runway or strip.directions[0].ident,
        parties=(callsign,),
        traffic=(callsign, traffic),
        finding=NotReadBack(callsign, given, traffic),
        rule="readback_missing",
        sources=("radio", "adsb"),
        kind="readback_mismatch",
        radio_ids=(unanswered.radio_id,),
    )


def activity_of(
    outlook: Snapshot, callsign: str | None, said: tuple[Instruction | None, ...]
) -> tuple[Strip, str] | None:
    """Return the runway that an instruction is about, and who else than a callsign uses it.

    None if nobody else does.
    """
    aerodrome = outlook.situation.aerodrome
    named = [aerodrome.strip_of(each.runway) for each in said if each]
    for strip in [strip for strip in named if strip is not None] or aerodrome.strips:
        for other in _active(outlook, strip):
            if other != callsign:
                return strip, other
    return None


def _active(outlook: Snapshot, strip: Strip) -> Iterator[str]:
    """Yield who is on a runway, uses it or one that crosses it, or was cleared on to it."""
    for obstacle in outlook.situation.obstacles(strip):
        if obstacle.is_inside:
            yield obstacle.mobile.callsign
    for use in outlook.situation.uses.values():
        if use.strip is strip or outlook.situation.aerodrome.crossing(strip, use.strip):
            yield use.mobile.callsign
    for clearance in outlook.cleared_on(strip):
        yield clearance.callsign


def _opposed(outlook: Outlook) -> Iterator[Threat]:
    """Yield the threat of two clearances to use one runway in opposite directions."""
    strip_of = outlook.situation.aerodrome.strip_of
    using = [
        (clearance, strip, clearance.runway)
        for clearance in outlook.in_force
        if clearance.action in ("cleared_to_land", "cleared_for_takeoff", "line_up")
        and clearance.is_certain
        and clearance.runway is not None
        and (strip := strip_of(clearance.runway)) is not None
    ]
    for (first, strip, runway), (second, other_strip, other_runway) in combinations(using, 2):
        parties = (first.callsign, second.callsign)
        is_opposed = strip is other_strip and runway != other_runway
        if is_opposed and first.callsign != second.callsign:
            yield Threat(
                key=("clearances", strip.name, *sorted(parties)),
                severity=Severity.CAUTION,
                strip=strip,
                runway=runway,
                parties=parties,
                traffic=parties,
                finding=OpposedClearances(parties, (runway, other_runway)),
                rule="opposed_clearances",
                sources=("radio",),
                radio_ids=(first.radio_id, second.radio_id),
            )
