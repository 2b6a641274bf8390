"""Steps (a) and (c) of the ladder: what was said does not agree, or was not said."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from airhilt.assistant.decision.aerodrome import Strip
from airhilt.assistant.decision.clearances import Discrepancy, Unanswered
from airhilt.assistant.decision.findings import NotReadBack, OpposedClearances, RunwayMisread
from airhilt.assistant.decision.threats import Outlook, Snapshot, Threat
from airhilt.messages import Severity
from airhilt.phraseology import Instruction


def clearance_conflicts(outlook: Outlook) -> Iterator[Threat]:
    """Yield wrong readbacks, and clearances that oppose each other."""
    for discrepancy in outlook.situation.clearances.discrepancies(outlook.t_ns):
        yield from misread(outlook, discrepancy)
    for unanswered in outlook.situation.clearances.unanswered(outlook.t_ns):
        yield from _not_read_back(outlook, unanswered)
    yield from _opposed(outlook)


def misread(outlook: Snapshot, discrepancy: Discrepancy) -> Iterator[Threat]:
    """Yield the threat of a readback that is wrong, or somebody else's, for an active runway."""
    said = (discrepancy.read, discrepancy.given)
    strip, activity = activity_of(outlook, discrepancy.callsign, said)
    if strip is None or not activity:
        return
    parties = tuple(dict.fromkeys((discrepancy.callsign, discrepancy.addressed)))
    yield Threat(
        ("readback", discrepancy.callsign, str(discrepancy.t_end_ns)),
        Severity.CAUTION,
        strip,
        discrepancy.read.runway or strip.directions[0].ident,
        parties,
        tuple(dict.fromkeys((*parties, activity[0]))),
        RunwayMisread(
            callsign=discrepancy.callsign,
            addressed=discrepancy.addressed,
            given=discrepancy.given,
            read=discrepancy.read,
            traffic=activity[0],
        ),
        sources=("radio", "adsb"),
        kind="readback_mismatch",
        radio_ids=discrepancy.radio_ids,
        rules=("readback_mismatch" if len(parties) == 1 else "recipient_ambiguity",),
    )


def _not_read_back(outlook: Outlook, unanswered: Unanswered) -> Iterator[Threat]:
    """Yield the threat that somebody does not know to keep off an active runway."""
    callsign, given = unanswered.callsign, unanswered.given
    strip, activity = activity_of(outlook, callsign, (given,))
    if strip is None or not activity:
        return
    yield Threat(
        ("silence", callsign, str(unanswered.t_end_ns)),
        Severity.CAUTION,
        strip,
        given.runway or strip.directions[0].ident,
        (callsign,),
        (callsign, activity[0]),
        NotReadBack(callsign, given, activity[0]),
        sources=("radio", "adsb"),
        kind="readback_mismatch",
        radio_ids=(unanswered.radio_id,),
        rules=("readback_missing",),
    )


def activity_of(
    outlook: Snapshot, callsign: str | None, said: tuple[Instruction | None, ...]
) -> tuple[Strip | None, list[str]]:
    """Return the runway that an instruction is about, and who else than a callsign uses it."""
    aerodrome = outlook.situation.aerodrome
    named = [each.runway for each in said if each]
    strips = [strip for ident in named if (strip := aerodrome.strip_of(ident)) is not None]
    for strip in dict.fromkeys(strips) or aerodrome.strips:
        activity = [name for name in _active(outlook, strip) if name != callsign]
        if activity:
            return strip, list(dict.fromkeys(activity))
    return None, []


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
    using = [
        clearance
        for clearance in outlook.in_force
        if clearance.action in ("cleared_to_land", "cleared_for_takeoff", "line_up")
        and clearance.is_certain
    ]
    for first, second in itertools.combinations(using, 2):
        strip = outlook.situation.aerodrome.strip_of(first.runway)
        if (
            strip is None
            or first.runway is None
            or second.runway is None
            or strip is not outlook.situation.aerodrome.strip_of(second.runway)
            or first.runway == second.runway
            or first.callsign == second.callsign
        ):
            continue
        parties = (first.callsign, second.callsign)
        yield Threat(
            ("clearances", strip.name, *sorted(parties)),
            Severity.CAUTION,
            strip,
            first.runway,
            parties,
            parties,
            OpposedClearances(parties, (first.runway, second.runway)),
            sources=("radio",),
            radio_ids=(first.radio_id, second.radio_id),
            rules=("opposed_clearances",),
        )
