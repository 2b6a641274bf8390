"""Step (b) of the ladder: a runway is occupied, or about to be, and somebody comes.

What cameras show counts as an obstacle without a transponder.
"""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.assistant.decision.aerodrome import Strip
from airhilt.assistant.decision.clearances import Clearance
from airhilt.assistant.decision.findings import Obstructs
from airhilt.assistant.decision.ladder import Score
from airhilt.assistant.decision.mobiles import Use
from airhilt.assistant.decision.occupancy import SeenOnGround
from airhilt.assistant.decision.situation import Obstacle, SeenObstacle
from airhilt.assistant.decision.threats import (
    UNIDENTIFIED,
    WILDLIFE,
    Outlook,
    RunwayRule,
    Threat,
    obstruction,
)
from airhilt.messages import Severity
from airhilt.surveillance.squitters import NACP_95_PERCENT_M
from airhilt.units import SECOND_NS

LEAST_ENTRY_M_S = 2.0
"""Speed, in m/s, below which nobody is about to enter a runway."""
HARD_BRAKING_M_S2 = 4.0
"""Hardest braking of a vehicle in front of a hold line, in m/s2."""
ONE_SIDED = 0.67
"""Share of the 95 % radius of a position error that is exceeded in 5 % of cases in one direction:
1.645 / 2.4477."""
AIRCRAFT = "airplane"
"""Class of aircraft in pictures; all else that is no animal has a driver."""
CROSSING_NS = 30 * SECOND_NS
"""Time after which an unseen mobile that was cleared to cross is taken to be across, in ns."""


def occupied(outlook: Outlook, use: Use) -> Iterator[Threat]:
    """Yield who or what is on a runway that somebody uses, or about to enter it."""
    situation = outlook.situation
    for obstacle in situation.obstacles(use.strip):
        yield from _in_way(outlook, use, obstacle)
    for seen in situation.seen(use.strip):
        yield from _seen_in_way(outlook, use, seen)
    if not use.is_climbing:
        yield from _unseen(outlook, use)
        if use.kind != "rollout":
            yield from _wildlife(outlook, use)


def _in_way(outlook: Outlook, use: Use, obstacle: Obstacle) -> Iterator[Threat]:
    """Yield the threat of a mobile on a runway before its user, or about to enter it."""
    other = obstacle.mobile
    coming = None if other is use.mobile else outlook.coming(use, other.point)
    if coming is None or not (obstacle.is_inside or _enters(outlook, obstacle, use.strip)):
        return
    enters = not (obstacle.is_inside or _has_entered(outlook, obstacle, use.strip))
    severity, time_to_go_s = coming
    cleared_to, own = outlook.cleared_to(other.callsign, use.strip), outlook.situation.use(other)
    is_allowed = other.landed or own is not None or "cross" in cleared_to
    takes_off = own is not None and own.kind == "departure" and own.strip is use.strip
    stays = "proceed" in cleared_to and not takes_off
    leaving_s = None if stays else obstacle.leaving_s(own, use)
    if leaving_s is not None:
        leaving_s = max(leaving_s - (outlook.t_ns - other.t_ns) / SECOND_NS, 0.0)
    if _is_harmless(outlook, leaving_s, is_allowed, severity, time_to_go_s):
        severity = Severity.INFO
    if enters and severity is Severity.WARNING:
        severity = Severity.CAUTION
    yield obstruction(use, "entering" if enters else "on", other.callsign, severity, time_to_go_s)


def _seen_in_way(outlook: Outlook, use: Use, seen: SeenObstacle) -> Iterator[Threat]:
    """Yield the threat of something that only cameras show on a runway before its user."""
    thing = seen.thing
    coming = outlook.coming(use, thing.fix.point)
    if coming is None:
        return
    severity, time_to_go_s = coming
    clearance = _sent_there(outlook, use.strip, thing)
    callsign = None if clearance is None else clearance.callsign
    radio_ids = () if clearance is None else (clearance.radio_id,)
    sources: tuple[str, ...] = ("vision", "adsb")
    rule: RunwayRule = "occupancy"
    shares: dict[str, float] = {}
    if seen.is_certain:
        cleared_to = outlook.cleared_to(callsign, use.strip)
        clear_s = None if "proceed" in cleared_to else seen.clear_s
        if _is_harmless(outlook, clear_s, "cross" in cleared_to, severity, time_to_go_s):
            severity = Severity.INFO
    else:  # It is one hint among others: W_A is that somebody uses the runway, W_C that a call
        # tells of the thing.
        report = outlook.situation.wildlife_report(use.strip, outlook.t_ns)
        if thing.is_animal and report is not None:
            radio_ids = (report.id,)
        config = outlook.config.score
        score = Score.of(config, vision=seen.weight, asr=1.0, context=float(bool(radio_ids)))
        hinted = score.severity(config)
        if hinted is None:
            return
        severity = min(severity, hinted, key=lambda each: each.rank)
        sources, rule = ("adsb", "vision"), "score"
        shares = score.shares(vision=score.vision, adsb=score.asr, radio=score.context)
    how, what, unnamed = named(thing, callsign)
    yield obstruction(
        use,
        how,
        what,
        severity,
        time_to_go_s,
        (*sources, "radio") if radio_ids else sources,
        unnamed=unnamed,
        tracks=thing.tracks,
        radio_ids=radio_ids,
        rule=rule,
        shares=shares,
    )


def named(thing: SeenOnGround, callsign: str | None) -> tuple[Obstructs, str, str | None]:
    """Return how something is in the way, what it is, and a word if it has no callsign."""
    if thing.is_animal:
        return "animal on", str(thing.label), WILDLIFE
    if callsign is not None:
        return "on, by camera", callsign, None
    return "unidentified on", str(thing.label), UNIDENTIFIED


def _sent_there(outlook: Outlook, strip: Strip, thing: SeenOnGround) -> Clearance | None:
    """Return the clearance of the only vehicle, or aircraft, without ADS-B sent on to a runway."""
    if thing.is_animal:
        return None
    situation, vehicle = outlook.situation, thing.label != AIRCRAFT
    sent = {
        clearance.callsign: clearance
        for clearance in outlook.cleared_on(strip)
        if situation.mobile(clearance.callsign) is None
        and situation.is_vehicle(clearance.callsign) == vehicle
    }
    return next(iter(sent.values())) if len(sent) == 1 else None


def _is_harmless(
    outlook: Outlook,
    clear_s: float | None,
    is_allowed: bool,
    severity: Severity,
    time_to_go_s: float,
) -> bool:
    """Return whether what is on a runway leaves it in time, and is allowed to do so that late."""
    if clear_s is None or clear_s + outlook.config.leaving_margin_s > time_to_go_s:
        return False
    is_late = time_to_go_s <= outlook.config.late_s
    return (is_allowed and not is_late) or severity is Severity.CAUTION


def _enters(outlook: Outlook, obstacle: Obstacle, strip: Strip) -> bool:
    """Return whether a mobile outside cannot stop short of the runway any more, or has gone on.

    One that was told to hold is given the benefit of the doubt.
    """
    mobile = obstacle.mobile
    idents = tuple(direction.ident for direction in strip.directions)
    holds = outlook.situation.clearances.is_holding(mobile.callsign, idents)
    travelled_m = 0.0 if holds else mobile.travelled_m(outlook.t_ns)
    return _cannot_stop(obstacle, strip, 1.0 if holds else ONE_SIDED, travelled_m)


def _has_entered(outlook: Outlook, obstacle: Obstacle, strip: Strip) -> bool:
    """Return whether a mobile that was outside when it reported is on the runway now.

    It is if it could not stop short any more, and has come that far since.
    """
    travelled_m = obstacle.mobile.travelled_m(outlook.t_ns)
    return travelled_m >= obstacle.way.entry_m and _cannot_stop(obstacle, strip, 1.0, 0.0)


def _cannot_stop(obstacle: Obstacle, strip: Strip, errors: float, travelled_m: float) -> bool:
    """Return whether a mobile cannot stop short of a runway after it has travelled a distance.

    The error of its position is a share, `errors`, of the 95 % radius.
    """
    mobile = obstacle.mobile
    error_m = NACP_95_PERCENT_M[mobile.nacp] * errors
    to_line_m = obstacle.way.entry_m - strip.margin_m(mobile.nacp) - travelled_m
    braking_m = mobile.speed_m_s**2 / (2.0 * HARD_BRAKING_M_S2)
    return mobile.speed_m_s > LEAST_ENTRY_M_S and to_line_m + error_m <= braking_m


def _unseen(outlook: Outlook, use: Use) -> Iterator[Threat]:
    """Yield the threat of an unseen mobile that was cleared on to the runway."""
    time_to_go_s = outlook.time_to_go_s(use, use.direction.length_m)
    if outlook.urgency(use, time_to_go_s) is None:
        return
    for clearance in outlook.cleared_on(use.strip):
        callsign = clearance.callsign
        if clearance.action not in ("cross", "proceed") or outlook.situation.mobile(callsign):
            continue
        left_ns = clearance.t_end_ns + CROSSING_NS - outlook.t_ns
        if clearance.action == "cross" and left_ns / SECOND_NS <= time_to_go_s:
            continue
        yield obstruction(
            use,
            "cleared on to",
            callsign,
            Severity.CAUTION,
            time_to_go_s,
            ("adsb", "radio"),
            radio_ids=(clearance.radio_id,),
            rule="cleared_on",
        )


def _wildlife(outlook: Outlook, use: Use) -> Iterator[Threat]:
    """Yield the threat of wildlife that was reported on the runway."""
    report = outlook.situation.wildlife_report(use.strip, outlook.t_ns)
    time_to_go_s = outlook.time_to_go_s(use, use.along_m)
    severity = outlook.urgency(use, time_to_go_s)
    if report is not None and severity is not None:
        yield obstruction(
            use,
            "reported on",
            WILDLIFE,
            severity,
            time_to_go_s,
            ("adsb", "radio"),
            unnamed=WILDLIFE,
            radio_ids=(report.id,),
            rule="reported_wildlife",
        )
