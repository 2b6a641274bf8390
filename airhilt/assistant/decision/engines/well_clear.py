"""The baseline of unmanned aviation: detect and avoid by DO-365B, for crews with ADS-B In.

DO-365B asks a system for bands of tracks that lead to a violation, and leaves the choice among the
others to the pilot. The choice here is an assumption: the smallest turn that stays well clear for
the look-ahead, to the right rather than to the left, as both turn that meet head-on (ICAO Annex 2,
3.2.2.2); after the response time it is chosen anew, to the same side. The other one is taken to fly
straight on. The turn is begun after the response time, and its duration is part of that.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from airhilt.assistant.decision.aerodrome import TrafficZone
from airhilt.assistant.decision.air_tracks import AirTracks, Pair, Reach
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.escalation import Escalation
from airhilt.assistant.decision.findings import Announcement
from airhilt.assistant.decision.tracks import Track
from airhilt.engines import Engine
from airhilt.geodesy.relative_motion import Relative, relative
from airhilt.messages import AdsbReport, Briefing, Evidence, Message, Severity, Turn
from airhilt.surveillance.well_clear import (
    CORRECTIVE,
    HYSTERESIS_S,
    LOOK_AHEAD_S,
    PREVENTIVE,
    WARNING,
    AlertLevel,
    AlertName,
    Gap,
    Volume,
    level_of,
    time_to_violation_s,
)
from airhilt.units import DEGREE, SECOND_NS

SEVERITIES: dict[AlertName, Severity] = {
    "preventive": Severity.ADVISORY,
    "corrective": Severity.CAUTION,
    "warning": Severity.WARNING,
}
AURALS = {
    Severity.ADVISORY: "traffic, monitor",
    Severity.CAUTION: "traffic, avoid",
    Severity.WARNING: "traffic, maneuver now, traffic, maneuver now",
}
"""Aural alerts (DO-365B, table 2-21)."""
STALE_S = 15.0
"""Silence after which a track is dropped, in s; an assumption."""
CYCLE_NS = SECOND_NS
"""Time without a report after which a pair with an alert is judged again, in ns."""
REACH = Reach(
    WARNING.volume.dmod_m,
    PREVENTIVE.volume.zthr_m,
    PREVENTIVE.alert_s + PREVENTIVE.volume.tau_s,
)
"""The farthest volume. A violation begins within the time of an alert, and two that fly straight on
are within DMOD after tau more at most."""
TURNS_DEG = tuple(sign * degrees for degrees in range(10, 100, 10) for sign in (1, -1))
"""Turns that are tried, to the right if positive, the smallest first; steps are an assumption."""
RESPONSE_S = 15.0
"""Time for the pilot's decision and the turn, in s; an assumption."""

Velocity = tuple[float, float]
"""North and east, in m/s."""


@dataclass(slots=True)
class _Encounter:
    """One pair from its first alert to its last."""

    escalation: Escalation
    recommendations: dict[str, Turn] = field(default_factory=dict)


class WellClearEngine:
    """Alerts of DO-365B, phase I, to both crews of each pair that ADS-B shows.

    Every aircraft with ADS-B is taken to have ADS-B In and the alerts. Positions and velocities of
    both are those of their reports. Aircraft without ADS-B are unknown to it, though a real system
    may see them by active surveillance or radar. Phase II, in the terminal area, is left out: there
    is no alert if both are in the zone of a tower.
    """

    name = "well_clear"
    reads: tuple[type[Message], ...] = (Briefing, AdsbReport)

    def __init__(self) -> None:
        self._tracks = AirTracks()
        self._zone: TrafficZone | None = None
        self._encounters: dict[Pair, _Encounter] = {}
        self._count = 0

    def receive(self, received: ReceivedMessage) -> None:
        """Update a track with a report, or the terminal area with the briefing."""
        match received.message:
            case AdsbReport() as report:
                self._tracks.take_report(report, received.t_ns)
            case Briefing(airport=airport):
                self._zone = None if airport is None else TrafficZone.of(airport)

    def decide(self, t_ns: int) -> Decision:
        """Return the alerts that are new, have risen, or are over."""
        tracks = self._tracks
        pairs = tracks.pairs_with_news(t_ns, REACH, STALE_S, self._encounters)
        silent = tracks.silent(self._encounters, t_ns, CYCLE_NS)
        alerts = [
            alert for pair in dict.fromkeys([*pairs, *silent]) for alert in self._judge(pair, t_ns)
        ]
        tracks.end_step()
        return Decision(alerts, again_ns=t_ns + CYCLE_NS if self._encounters else None)

    def _judge(self, pair: Pair, t_ns: int) -> Iterator[Alert]:
        first, second = (self._tracks.present(icao24, t_ns) for icao24 in pair)
        motion, zone = relative(first, second), self._zone
        own, other = first.profile(), second.profile()
        gap = Gap(other.altitude_m - own.altitude_m, other.rate_m_s - own.rate_m_s)
        is_exempt = (
            self._tracks.is_grounded(first)
            or self._tracks.is_grounded(second)
            or (zone is not None and zone.contains(first) and zone.contains(second))
        )
        level = None if is_exempt else level_of(motion, gap)
        encounter = self._encounters.get(pair)
        if level is None:
            if encounter is not None and self._is_over(encounter, motion, t_ns):
                del self._encounters[pair]
                evidence = Evidence(sources=("adsb",), note="well clear", tracks=pair)
                yield _alert(encounter, first, second, evidence, is_active=False)
            return
        if encounter is None:
            self._count += 1
            encounter = _Encounter(Escalation(f"well-clear-{self._count}"))
            self._encounters[pair] = encounter
        escalation, before = encounter.escalation, encounter.recommendations
        has_risen = escalation.rises(SEVERITIES[level.name], t_ns, persistence_s=0.0)
        turns: dict[str, Turn] = {}
        if level is not PREVENTIVE and (has_risen or not escalation.is_fresh(t_ns, RESPONSE_S)):
            turns = _turns(first, second, gap, before)
            encounter.recommendations = turns if has_risen else {**before, **turns}
        news = escalation.changes(t_ns, other=turns, ignoring=())
        if has_risen or news:
            yield _alert(encounter, first, second, _evidence(pair, motion, gap, level))

    def _is_over(self, encounter: _Encounter, motion: Relative, t_ns: int) -> bool:
        """Note that nothing is wrong now, and return whether an alert is over.

        Once crews were told to turn, it does not end before the two are past each other: going
        back would bring it back.
        """
        if encounter.recommendations and motion.time_to_closest_approach_s() > 0.0:
            encounter.escalation.stays()
            return False
        return encounter.escalation.is_over(t_ns, HYSTERESIS_S)


def smallest_turn(
    motion: Relative, own: Velocity, gap: Gap, told: Turn | None = None
) -> Turn | None:
    """Return the smallest turn of the own aircraft that remains well clear; None if none does.

    There is none either if the two are past each other before a turn is made. Who was ``told`` to
    turn to one side is told to turn to the other one only if no turn to that side will do.

    Parameters
    ----------
    motion
        The other one relative to the own aircraft.
    own
        Own velocity over the ground.
    """
    if motion.time_to_closest_approach_s() <= RESPONSE_S:
        return None
    held = 0.0 if told is None else told.degrees
    for degrees in sorted(TURNS_DEG, key=lambda each: each * held < 0.0):
        if _stays_clear(motion, own, gap, degrees * DEGREE):
            return Turn(degrees=degrees)
    return None


def _stays_clear(motion: Relative, own: Velocity, gap: Gap, turn_rad: float) -> bool:
    cosine, sine = math.cos(turn_rad), math.sin(turn_rad)
    north, east = own
    later = motion.at(RESPONSE_S)
    turned = Relative(
        later.north_m,
        later.east_m,
        later.velocity_north_m_s + north - (north * cosine - east * sine),
        later.velocity_east_m_s + east - (north * sine + east * cosine),
    )
    gap_later = Gap(gap.gap_m + gap.rate_m_s * RESPONSE_S, gap.rate_m_s)
    volume: Volume = CORRECTIVE.volume
    violation_s = time_to_violation_s(turned, gap_later, volume)
    return violation_s is None or violation_s > LOOK_AHEAD_S


def _turns(first: Track, second: Track, gap: Gap, told: Mapping[str, Turn]) -> dict[str, Turn]:
    opposite = Gap(-gap.gap_m, -gap.rate_m_s)
    turns = {
        own.callsign: smallest_turn(
            relative(own, other),
            (own.velocity_north_m_s, own.velocity_east_m_s),
            seen,
            told.get(own.callsign),
        )
        for own, other, seen in ((first, second, gap), (second, first, opposite))
    }
    return {callsign: turn for callsign, turn in turns.items() if turn is not None}


def _evidence(pair: Pair, motion: Relative, gap: Gap, level: AlertLevel) -> Evidence:
    approach_s = max(motion.time_to_closest_approach_s(), 0.0)
    violation_s = time_to_violation_s(motion, gap, level.volume)
    return Evidence(
        sources=("adsb",),
        time_to_loss_s=violation_s,
        time_to_closest_approach_s=approach_s,
        horizontal_at_closest_approach_m=motion.at(approach_s).distance_m,
        vertical_at_closest_approach_m=abs(gap.gap_m + gap.rate_m_s * approach_s),
        note=f"{level.name} alert, not well clear in {violation_s or 0.0:.0f} s",
        tracks=pair,
        rules=(level.name,),
    )


def _alert(
    encounter: _Encounter,
    first: Track,
    second: Track,
    evidence: Evidence,
    *,
    is_active: bool = True,
) -> Alert:
    severity = encounter.escalation.severity
    callsigns = (first.callsign, second.callsign)
    return encounter.escalation.alert(
        kind="loss_of_separation",
        recipients=callsigns,
        traffic=callsigns,
        evidence=evidence,
        finding=Announcement(AURALS[severity]) if severity in AURALS else None,
        recommendations=encounter.recommendations,
        active=is_active,
    )


ENGINE = Engine(
    name="well_clear",
    summary="detect and avoid of DO-365B by ADS-B In, which tells both crews",
    create=lambda _: WellClearEngine(),
)
