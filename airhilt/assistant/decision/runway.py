"""Conflicts on runways (S01A, S01B, S01C), with what those concerned should do."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.assessment import worst, worst_threats
from airhilt.assistant.decision.clarifications import Clarifications
from airhilt.assistant.decision.clearance_conflicts import activity_of
from airhilt.assistant.decision.escalation import Escalation
from airhilt.assistant.decision.guard import ConfidenceGuard
from airhilt.assistant.decision.mobiles import Use
from airhilt.assistant.decision.runway_advice import advice
from airhilt.assistant.decision.situation import RunwaySituation
from airhilt.assistant.decision.threats import RunwayConfig, Snapshot, Threat
from airhilt.assistant.decision.visual_tracks import VisualTracks
from airhilt.messages import (
    CONTROLLER,
    AdsbReport,
    Briefing,
    Evidence,
    PartialTranscript,
    Recommendation,
    Severity,
    Transcript,
    TransmissionOpened,
)
from airhilt.phraseology import Call

PROVISIONAL = "provisional_instruction"
"""Name among the rules of an advisory that rests on an instruction of a call that went on."""
Rules = Callable[[RunwaySituation, int], Mapping[tuple[str, ...], Threat]]
"""Rules of an engine: the threats on the runways at a time, each by its key."""


@dataclass(slots=True)
class _Ongoing:
    """One conflict from first suspicion to its end."""

    threat: Threat
    escalation: Escalation
    told: frozenset[str] = frozenset()
    """Recipients that were told of it last, by the names that they had then."""
    tracks: tuple[str, ...] = ()
    """Addresses of those in conflict who are known by ADS-B."""
    is_provisional: bool = True
    """True while it rests on nothing but calls that go on."""


class RunwayWatch:
    """Watches the runways of the airport in the briefing; without one it has nothing to do.

    Parameters
    ----------
    guard
        Tells what is in doubt.
    rules
        Rules that find threats; None: those of the reference engine.
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
        situation = self._situation
        mobile = None if situation is None else situation.mobile(callsign)
        return None if situation is None or mobile is None else situation.use(mobile)

    def take_briefing(self, briefing: Briefing) -> None:
        """Set the airport, and who is expected there."""
        if briefing.airport is not None and briefing.airport.runways:
            self._situation = RunwaySituation(briefing.airport, briefing, self._guard)

    def take_report(self, report: AdsbReport, t_ns: int) -> None:
        """Update the position of an aircraft or a vehicle at a time."""
        if self._situation is not None:
            self._situation.take_report(report, t_ns)

    def take_opening(self, opened: TransmissionOpened) -> None:
        """Note that somebody has begun to transmit."""
        if self._situation is not None:
            self._situation.take_opening(opened)

    def take_partial(self, partial: PartialTranscript) -> None:
        """Update the provisional instructions of a call that goes on."""
        if self._situation is not None:
            self._situation.take_partial(partial)

    def take_transcript(self, transcript: Transcript) -> Call | None:
        """Update clearances with a call, and return its meaning; None without an airport."""
        return None if self._situation is None else self._situation.take_transcript(transcript)

    def judge(self, t_ns: int) -> list[Alert]:
        """Return the alerts that are new, have risen, or are over."""
        situation = self._situation
        if situation is None:
            return []
        situation.forget(t_ns)
        situation.look(self._visual_tracks)
        threats = self._threats(t_ns, situation)
        alerts: list[Alert] = []
        for key, threat in threats.items():
            alerts += self._raise(t_ns, key, threat, situation)
        for key in [key for key in self._ongoing if key not in threats]:
            alerts += self._calm(t_ns, key)
        return alerts + self._ask(t_ns, situation)

    def observe(self, t_ns: int) -> None:
        """Note what is wrong at a time at which nothing is told."""
        threats = {} if self._situation is None else self._threats(t_ns, self._situation)
        for key, threat in threats.items():
            if threat.severity is not Severity.INFO:
                self._ongoing_of(key, threat).escalation.observe(threat.severity, t_ns)
        for key, ongoing in self._ongoing.items():
            if key not in threats or threats[key].severity is Severity.INFO:
                ongoing.escalation.observe(None, t_ns)

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
            found += [
                replace(threat, provisional_ids=supposed.radio_ids)
                for threat in self._rules(supposed.situation, t_ns).values()
            ]
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
    ) -> list[Alert]:
        if threat.severity is Severity.INFO:
            if key in self._ongoing:
                self._ongoing[key].escalation.stays()
            return []
        ongoing = self._ongoing_of(key, threat)
        if "adsb" in threat.sources:
            known = (situation.mobile(callsign) for callsign in threat.traffic)
            ongoing.tracks = tuple(mobile.icao24 for mobile in known if mobile is not None)
        # Speech does not become more certain with time, and what is seen has lasted already.
        persistence_s = self.config.persistence_s if "adsb" in threat.sources[:1] else 0.0
        has_risen = ongoing.escalation.rises(threat.severity, t_ns, persistence_s)
        is_renamed = bool(ongoing.told) and not ongoing.told.issuperset(threat.parties)
        if not has_risen and not is_renamed:
            return []
        ongoing.told = frozenset(threat.parties)
        severity = ongoing.escalation.severity or threat.severity
        recommendations = {
            callsign: recommended
            for callsign in threat.parties
            if (mobile := situation.mobile(callsign)) is not None
            and (recommended := advice(mobile, threat, severity, situation, self.config))
            is not None
        }
        return [self._alert(ongoing, recommendations)]

    def _calm(self, t_ns: int, key: tuple[str, ...]) -> list[Alert]:
        ongoing = self._ongoing[key]
        if ongoing.escalation.severity is None:
            del self._ongoing[key]
            return []
        # What a call seemed to say, and does not say as a whole, is withdrawn at once.
        release_s = 0.0 if ongoing.is_provisional else self.config.release_s
        if not ongoing.escalation.is_over(t_ns, release_s):
            return []
        del self._ongoing[key]
        return [self._alert(ongoing, {}, active=False)]

    def _ask(self, t_ns: int, situation: RunwaySituation) -> list[Alert]:
        """Return questions for what is in doubt about a runway that somebody else uses."""
        snapshot = Snapshot(situation, t_ns)
        alerts: list[Alert] = []
        for doubt in situation.clearances.doubts(t_ns):
            strip, active = activity_of(snapshot, doubt.callsign, (doubt.said,))
            if strip is not None and active:
                alerts += self._clarifications.ask(t_ns, doubt, active[0], strip.name)
        return alerts

    def _alert(
        self,
        ongoing: _Ongoing,
        recommendations: dict[str, Recommendation],
        active: bool = True,
    ) -> Alert:
        """Return the alert about a threat; crews and drivers are told from CAUTION on."""
        threat, groups = ongoing.threat, self.config.recipients
        is_for_crews = "concerned" in groups and ongoing.escalation.is_for_crews
        recipients = (
            *(threat.parties if is_for_crews else ()),
            *((CONTROLLER,) if "controller" in groups else ()),
        )
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
                camera_ids=threat.cameras,
                tracks=ongoing.tracks,
                rules=(*threat.rules, PROVISIONAL) if threat.provisional_ids else threat.rules,
                shares=dict(threat.shares),
            ),
            finding=threat.finding,
            recommendations=recommendations,
            active=active,
        )
