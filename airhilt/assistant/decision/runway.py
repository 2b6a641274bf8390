"""Conflicts on runways (S01A, S01B, S01C), with what those concerned should do."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.assessment import worst, worst_threats
from airhilt.assistant.decision.clarifications import Clarifications
from airhilt.assistant.decision.clearance_conflicts import activity_of
from airhilt.assistant.decision.escalation import Escalation
from airhilt.assistant.decision.findings import NotReadBack
from airhilt.assistant.decision.guard import ConfidenceGuard
from airhilt.assistant.decision.mobiles import STANDING_M_S, Mobile, Use, lined_up_on
from airhilt.assistant.decision.situation import RunwaySituation
from airhilt.assistant.decision.threats import RunwayConfig, Snapshot, Threat
from airhilt.assistant.decision.visual_tracks import VisualTracks
from airhilt.messages import (
    CONTROLLER,
    Briefing,
    CancelTakeoff,
    Evidence,
    GoAround,
    HoldPosition,
    Message,
    Recommendation,
    Severity,
)

FIRM_BRAKING_M_S2 = 2.5
"""Deceleration, in m/s2, within which somebody who can stop short of the pavement is told to."""
PROVISIONAL = "provisional_instruction"
"""Rule of an advisory that rests on an instruction of an unfinished call."""
Rules = Callable[[RunwaySituation, int], Mapping[tuple[str, ...], Threat]]
"""Rules of an engine: the threats on the runways at a time, each by its key."""


@dataclass(slots=True)
class _Ongoing:
    """One conflict from first suspicion to its end."""

    threat: Threat
    escalation: Escalation
    told: frozenset[str] = frozenset()
    """Recipients that were told of it last, by the names that they had then."""
    recommendations: Mapping[str, Recommendation] = field(default_factory=dict)
    """Recommendations that were told last, by the names that their recipients had then."""
    tracks: tuple[str, ...] = ()
    """Addresses of those in conflict who are known by ADS-B."""
    is_provisional: bool = True
    """True while it rests on nothing but unfinished calls."""


class RunwayWatch:
    """Watches the runways of the airport in the briefing; without one it has nothing to do.

    Without `rules` of its own, it judges by those of the reference engine.
    """

    def __init__(
        self,
        config: RunwayConfig,
        visual_tracks: VisualTracks,
        guard: ConfidenceGuard,
        rules: Rules | None = None,
    ) -> None:
        self.config = config
        self._guard = guard
        self._clarifications = Clarifications("runway")
        self._rules = rules or partial(worst_threats, config)
        self._visual_tracks = visual_tracks
        self._situation: RunwaySituation | None = None
        self._ongoing: dict[tuple[str, ...], _Ongoing] = {}
        self._count = 0

    @property
    def has_conflict(self) -> bool:
        """True if there is a conflict to be judged again even without news."""
        return bool(self._ongoing)

    def runway_of_arrival(self, callsign: str) -> str | None:
        """Return the runway for which a callsign is on final, None if it is not."""
        use = self._use(callsign)
        return None if use is None or use.kind != "arrival" else use.direction.ident

    def runway_in_use(self, callsign: str) -> str | None:
        """Return the runway that a callsign lands on or departs from, None if it does not."""
        use = self._use(callsign)
        return None if use is None else use.direction.ident

    def _use(self, callsign: str) -> Use | None:
        uses = {} if self._situation is None else self._situation.uses
        return next((use for use in uses.values() if use.mobile.callsign == callsign), None)

    def take(self, message: Message, t_ns: int) -> None:
        """Update the airport, and who and what is there, with one message at a time."""
        match message:
            case Briefing(airport=airport) if airport is not None and airport.runways:
                self._situation = RunwaySituation(airport, message, self._guard)
            case _ if self._situation is not None:
                self._situation.take(message, t_ns)

    def judge(self, t_ns: int) -> list[Alert]:
        """Return the alerts that are new, have risen, or are over."""
        situation = self._situation
        if situation is None:
            return []
        situation.forget(t_ns)
        situation.look(self._visual_tracks)
        threats = self._threats(t_ns, situation)
        raised = [self._raise(t_ns, key, each, situation) for key, each in threats.items()]
        calmed = [self._calm(t_ns, key) for key in list(self._ongoing) if key not in threats]
        told = [alert for alert in (*raised, *calmed) if alert is not None]
        return told + self._ask(t_ns, situation)

    def observe(self, t_ns: int) -> None:
        """Update how long each severity has held, without telling anything."""
        threats = {} if self._situation is None else self._threats(t_ns, self._situation)
        wrong = {key: each for key, each in threats.items() if each.severity is not Severity.INFO}
        for key, threat in wrong.items():
            self._ongoing_of(key, threat).escalation.observe(threat.severity, t_ns)
        for key in self._ongoing.keys() - wrong.keys():
            self._ongoing[key].escalation.observe(None, t_ns)

    def _threats(self, t_ns: int, situation: RunwaySituation) -> dict[tuple[str, ...], Threat]:
        """Return what is wrong now, by what it is and the addresses of those who are in it.

        A mobile is named by its address until it has sent its callsign; its threat stays the same
        one. A call that has not ended may add a threat or make one more severe, but removes none.
        """

        def address(name: str) -> str:
            mobile = situation.mobile(name)
            return name if mobile is None else mobile.icao24

        found = list(self._rules(situation, t_ns).values())
        supposed = situation.supposed(t_ns)
        if supposed is not None:
            other, radio_ids = supposed
            threats = self._rules(other, t_ns).values()
            found += [replace(threat, provisional_ids=radio_ids) for threat in threats]
        return {tuple(sorted(map(address, threat.key))): threat for threat in worst(found).values()}

    def _ongoing_of(self, key: tuple[str, ...], threat: Threat) -> _Ongoing:
        """Return the conflict of a threat, a new one if it has none."""
        ongoing = self._ongoing.get(key)
        if ongoing is None:
            self._count += 1
            ongoing = _Ongoing(threat, Escalation(f"runway-{self._count}"))
            self._ongoing[key] = ongoing
        ongoing.threat = threat
        ongoing.is_provisional = ongoing.is_provisional and bool(threat.provisional_ids)
        return ongoing

    def _raise(
        self, t_ns: int, key: tuple[str, ...], threat: Threat, situation: RunwaySituation
    ) -> Alert | None:
        if threat.severity is Severity.INFO:
            if key in self._ongoing:
                self._ongoing[key].escalation.stays()
            return None
        ongoing = self._ongoing_of(key, threat)
        if "adsb" in threat.sources:
            known = (situation.mobile(callsign) for callsign in threat.traffic)
            ongoing.tracks = tuple(mobile.icao24 for mobile in known if mobile is not None)
        # Speech does not become more certain with time, and what is seen has lasted already.
        persistence_s = self.config.persistence_s if "adsb" in threat.sources[:1] else 0.0
        has_risen = ongoing.escalation.rises(threat.severity, t_ns, persistence_s)
        is_renamed = bool(ongoing.told) and not ongoing.told.issuperset(threat.parties)
        severity = ongoing.escalation.severity or threat.severity
        mobiles = {callsign: situation.mobile(callsign) for callsign in threat.parties}
        recommendations = {
            callsign: recommended
            for callsign, mobile in mobiles.items()
            if mobile is not None
            and (recommended := advice(mobile, threat, severity, situation, self.config))
            is not None
        }
        before = ongoing.recommendations
        news = ongoing.escalation.changes(
            t_ns,
            other=[name for name, each in recommendations.items() if before.get(name) != each],
            ignoring=[
                name
                for name, each in recommendations.items()
                if (mobile := mobiles[name]) is not None and not _is_done(mobile, each)
            ],
        )
        if not has_risen and not is_renamed and not news:
            return None
        ongoing.told, ongoing.recommendations = frozenset(threat.parties), recommendations
        crews = threat.parties if has_risen or is_renamed else news
        return self._alert(ongoing, recommendations, crews)

    def _calm(self, t_ns: int, key: tuple[str, ...]) -> Alert | None:
        ongoing = self._ongoing[key]
        # What a call seemed to say, and does not say as a whole, is withdrawn at once.
        release_s = 0.0 if ongoing.is_provisional else self.config.release_s
        was_told = ongoing.escalation.severity is not None
        if was_told and not ongoing.escalation.is_over(t_ns, release_s):
            return None
        del self._ongoing[key]
        return self._alert(ongoing, {}, ongoing.threat.parties, active=False) if was_told else None

    def _ask(self, t_ns: int, situation: RunwaySituation) -> list[Alert]:
        """Return questions for what is in doubt about a runway that somebody else uses."""
        snapshot = Snapshot(situation, t_ns)
        alerts: list[Alert] = []
        for doubt in situation.clearances.doubts(t_ns):
            active = activity_of(snapshot, doubt.callsign, (doubt.said,))
            if active is not None:
                strip, traffic = active
                alerts += self._clarifications.ask(t_ns, doubt, traffic, strip.name)
        return alerts

    def _alert(
        self,
        ongoing: _Ongoing,
        recommendations: dict[str, Recommendation],
        told: Collection[str],
        *,
        active: bool = True,
    ) -> Alert:
        """Return the alert about a threat; crews and drivers are told from CAUTION on."""
        threat, groups = ongoing.threat, self.config.recipients
        is_for_crews = "concerned" in groups and ongoing.escalation.is_for_crews
        crews = tuple(name for name in threat.parties if is_for_crews and name in told)
        recipients = (*crews, CONTROLLER) if "controller" in groups else crews
        return ongoing.escalation.alert(
            kind=threat.kind,
            recipients=recipients,
            traffic=threat.traffic,
            evidence=Evidence(
                sources=threat.sources,
                runway=threat.runway,
                time_to_go_s=threat.time_to_go_s,
                note=threat.finding.statement(),
                radio_ids=tuple(dict.fromkeys((*threat.radio_ids, *threat.provisional_ids))),
                camera_ids=tuple(sorted({track.camera for track in threat.tracks})),
                tracks=ongoing.tracks,
                rules=(threat.rule, PROVISIONAL) if threat.provisional_ids else (threat.rule,),
                shares=dict(threat.shares),
            ),
            finding=threat.finding,
            recommendations=recommendations,
            active=active,
        )


def _is_done(mobile: Mobile, recommended: Recommendation) -> bool:
    """Return whether a mobile does what it was told, which is still recommended."""
    if isinstance(recommended, GoAround):
        return mobile.vertical_rate_m_s > 0.0 and not mobile.on_ground
    return mobile.is_slowing or mobile.speed_m_s < STANDING_M_S


def advice(
    mobile: Mobile,
    threat: Threat,
    severity: Severity,
    situation: RunwaySituation,
    config: RunwayConfig,
) -> Recommendation | None:
    """Return what a mobile should do to stay clear.

    On final and while rolling, something is recommended for a WARNING only; on final also if a
    readback was wrong and time is short, and to whoever was told so and has not answered. One on
    the ground that does not use a runway stops, unless it is on the pavement or leaves it.
    """
    use = situation.use(mobile)
    if use is not None:
        is_urgent = severity is Severity.WARNING or isinstance(threat.finding, NotReadBack)
        if use.kind == "arrival":
            time_to_go_s = use.time_to_threshold_s(mobile.t_ns)
            misread = threat.kind == "readback_mismatch" and time_to_go_s <= config.caution_s
            return GoAround(runway=use.direction.ident) if is_urgent or misread else None
        if use.kind == "departure" and mobile.on_ground and is_urgent:
            return CancelTakeoff(runway=use.direction.ident)
        return None
    if not mobile.on_ground:
        return None
    lined_up = lined_up_on(mobile, threat.strip)
    if lined_up is not None:
        return CancelTakeoff(runway=lined_up.ident)
    braking_m = mobile.speed_m_s**2 / (2.0 * FIRM_BRAKING_M_S2)
    room_m = threat.strip.room_m(mobile.point, mobile.heading_rad)
    return HoldPosition(runway=threat.runway) if room_m > braking_m else None
