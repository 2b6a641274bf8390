"""Conflicts on runways (S01A, S01B, S01C), with what those concerned should do."""

from __future__ import annotations

from dataclasses import dataclass, field

from airhilt.assistant.decision.aerodrome import Strip
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.assessment import worst_threats
from airhilt.assistant.decision.escalation import Escalation
from airhilt.assistant.decision.findings import NotReadBack
from airhilt.assistant.decision.mobiles import Mobile, lined_up_on
from airhilt.assistant.decision.situation import Situation
from airhilt.assistant.decision.threats import RunwayConfig, Threat
from airhilt.assistant.decision.visual_tracks import VisualTracks
from airhilt.messages import (
    CONTROLLER,
    AdsbReport,
    Briefing,
    CancelTakeoff,
    Evidence,
    GoAround,
    HoldPosition,
    Recommendation,
    Severity,
    Transcript,
    TransmissionOpened,
)

FIRM_BRAKING_M_S2 = 2.5
"""Deceleration, in m/s2, within which somebody who can stop short of the pavement is told to."""


@dataclass(slots=True)
class _Ongoing:
    """One conflict from first suspicion to its end."""

    id: str
    threat: Threat
    escalation: Escalation = field(default_factory=Escalation)
    revision: int = 0


class RunwayWatch:
    """Watches the runways of the airport in the briefing; without one it has nothing to do."""

    def __init__(self, config: RunwayConfig, visual_tracks: VisualTracks) -> None:
        self.config = config
        self._visual_tracks = visual_tracks
        self._situation: Situation | None = None
        self._ongoing: dict[tuple[str, ...], _Ongoing] = {}
        self._count = 0

    @property
    def has_conflict(self) -> bool:
        """True if there is a conflict to be judged again even without news."""
        return bool(self._ongoing)

    def runway_of_arrival(self, callsign: str) -> str | None:
        """Return the runway for which a callsign is on final, None if it is not."""
        situation = self._situation
        mobile = None if situation is None else situation.mobile(callsign)
        use = None if situation is None or mobile is None else situation.use(mobile)
        return None if use is None or use.kind != "arrival" else use.direction.ident

    def take_briefing(self, briefing: Briefing) -> None:
        """Set the airport, and who is expected there."""
        if briefing.airport is not None and briefing.airport.runways:
            self._situation = Situation(briefing.airport, briefing)

    def take_report(self, report: AdsbReport, t_ns: int) -> None:
        """Update the position of an aircraft or a vehicle at a time."""
        if self._situation is not None:
            self._situation.take_report(report, t_ns)

    def take_opening(self, opened: TransmissionOpened) -> None:
        """Note that somebody has begun to transmit."""
        if self._situation is not None:
            self._situation.take_opening(opened)

    def take_transcript(self, transcript: Transcript) -> None:
        """Update clearances with a call."""
        if self._situation is not None:
            self._situation.take_transcript(transcript)

    def judge(self, t_ns: int) -> list[Alert]:
        """Return the alerts that are new, have risen, or are over."""
        situation = self._situation
        if situation is None:
            return []
        situation.forget(t_ns)
        situation.look(self._visual_tracks)
        threats = worst_threats(situation, self.config, t_ns)
        alerts: list[Alert] = []
        for threat in threats.values():
            alerts += self._raise(t_ns, threat, situation)
        for key in [key for key in self._ongoing if key not in threats]:
            alerts += self._calm(t_ns, key)
        return alerts

    def _raise(self, t_ns: int, threat: Threat, situation: Situation) -> list[Alert]:
        ongoing = self._ongoing.get(threat.key)
        if threat.severity is Severity.INFO:
            if ongoing is not None:
                ongoing.escalation.stays()
            return []
        if ongoing is None:
            self._count += 1
            ongoing = self._ongoing[threat.key] = _Ongoing(f"runway-{self._count}", threat)
        ongoing.threat = threat
        # Speech does not become more certain with time, and what is seen has lasted already.
        persistence_s = self.config.persistence_s if "adsb" in threat.sources[:1] else 0.0
        if not ongoing.escalation.rises(threat.severity, t_ns, persistence_s):
            return []
        severity = ongoing.escalation.severity or threat.severity
        advice = {
            callsign: recommended
            for callsign in threat.parties
            if (mobile := situation.mobile(callsign)) is not None
            and (recommended := self._advice(mobile, threat, severity, situation)) is not None
        }
        return [self._alert(ongoing, severity, advice)]

    def _calm(self, t_ns: int, key: tuple[str, ...]) -> list[Alert]:
        ongoing = self._ongoing[key]
        if ongoing.escalation.severity is None:
            del self._ongoing[key]
            return []
        if not ongoing.escalation.is_over(t_ns, self.config.release_s):
            return []
        del self._ongoing[key]
        return [self._alert(ongoing, Severity.INFO, {}, active=False)]

    # --- what to do about it ----------------------------------------------------------------

    def _advice(
        self, mobile: Mobile, threat: Threat, severity: Severity, situation: Situation
    ) -> Recommendation | None:
        """Return what a mobile should do to stay clear.

        On final and while rolling, something is recommended for a WARNING only; on final also if a
        readback was wrong and time is short, and to whoever was told so and has not answered.
        """
        use = situation.use(mobile)
        if use is None:
            return _stop(mobile, threat.strip, threat.runway)
        is_urgent = severity is Severity.WARNING or isinstance(threat.finding, NotReadBack)
        if use.kind == "arrival":
            time_to_go_s = use.time_to_threshold_s(mobile.t_ns)
            misread = threat.kind == "readback_mismatch" and time_to_go_s <= self.config.caution_s
            return GoAround(runway=use.direction.ident) if is_urgent or misread else None
        if use.kind == "departure" and mobile.on_ground and is_urgent:
            return CancelTakeoff(runway=use.direction.ident)
        return None

    def _alert(
        self,
        ongoing: _Ongoing,
        severity: Severity,
        advice: dict[str, Recommendation],
        active: bool = True,
    ) -> Alert:
        """Return the alert about a threat; crews and drivers are told from CAUTION on."""
        threat, told = ongoing.threat, ongoing.escalation.severity or severity
        concerned = threat.parties if told.rank >= Severity.CAUTION.rank else ()
        alert = Alert(
            id=ongoing.id,
            revision=ongoing.revision,
            kind=threat.kind,
            severity=severity,
            recipients=(*concerned, CONTROLLER),
            traffic=threat.traffic,
            evidence=Evidence(
                sources=threat.sources,
                runway=threat.runway,
                time_to_go_s=threat.time_to_go_s,
                note=threat.finding.statement(),
            ),
            finding=threat.finding,
            recommendations=advice,
            active=active,
        )
        ongoing.revision += 1
        return alert


def _stop(mobile: Mobile, strip: Strip, runway: str) -> Recommendation | None:
    """Return what a mobile on the ground should do that does not use a runway yet.

    One that is on the pavement already, or leaves it, should go on: None.
    """
    if not mobile.on_ground:
        return None
    lined_up = lined_up_on(mobile, strip)
    if lined_up is not None:
        return CancelTakeoff(runway=lined_up.ident)
    braking_m = mobile.speed_m_s**2 / (2.0 * FIRM_BRAKING_M_S2)
    if strip.room_m(mobile.point, mobile.heading_rad) > braking_m:
        return HoldPosition(runway=runway)
    return None
