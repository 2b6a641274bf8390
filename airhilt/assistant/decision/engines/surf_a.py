"""The baseline in the cockpit for runways: alerts from ADS-B In, in the manner of SURF-A.

Sources
-------
HONEYWELL
    Honeywell SURF-A as published up to 2025 (theunn.com, avweb.com, and SURF-A in
    aerospacetestinginternational.com): aural alerts "traffic on runway" 30 s and 15 s before a
    predicted collision, during take-off and landing, from ADS-B; in demonstrations more than 1 NM
    or 30 s from touchdown, and on take-off 30 s or 4,400 ft from one who crosses at 35 mph.
DO-323
    RTCA DO-323, SURF IA: traffic on the runway, or about to enter it, counts. The thresholds are
    not public.
AC 25.1322-1
    FAA advisory circular on alerting of crews: a caution asks for awareness at once and for a
    response later, a warning for both at once.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Self

from pydantic import Field, model_validator

from airhilt.assistant.decision.aerodrome import Vector
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.findings import Obstruction, Obstructs
from airhilt.assistant.decision.mobiles import STANDING_M_S, TOUCHDOWN_M, Use
from airhilt.assistant.decision.raised_alerts import Hazard, RaisedAlerts
from airhilt.assistant.decision.situation import Obstacle, RunwaySituation
from airhilt.configuration import Configuration, Seconds, require_order
from airhilt.engines import Engine
from airhilt.errors import AirhiltError
from airhilt.messages import (
    AdsbReport,
    Briefing,
    CancelTakeoff,
    Evidence,
    GoAround,
    Message,
    Recommendation,
    Severity,
)
from airhilt.units import SECOND_NS

AGAIN_NS = SECOND_NS
"""Period at which a conflict is judged again without news, in ns."""
BEHIND_M = 30.0
"""Distance behind an aircraft, in m, from which nobody is in its way: an assumption."""
BRAKING_M_S2 = 4.0
"""Hardest braking of those about to enter, in m/s2, as vehicles have it: an assumption."""


class SurfaceAlertConfig(Configuration):
    """Thresholds of the alerts."""

    caution_s: Seconds = Field(
        30.0, description="time to the collision from which there is a CAUTION, in s (HONEYWELL)"
    )
    warning_s: Seconds = Field(
        15.0, description="time to the collision from which there is a WARNING, in s (HONEYWELL)"
    )
    margin_s: Seconds = Field(
        5.0,
        description="two that are at one place within this time of each other collide, in s: an "
        "assumption",
    )
    persistence_s: Seconds = Field(
        0.0, description="time for which a severity must hold to be told, in s: an assumption"
    )
    release_s: Seconds = Field(
        5.0, description="time for which a conflict must be over to be told, in s: an assumption"
    )

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        require_order(self, "warning_s", "caution_s")
        return self


class SurfaceAlertEngine:
    """Alerts the crew that takes off or lands of traffic on its runway, and nobody else.

    All aircraft with a transponder are taken to have the system. What has no ADS-B is not seen.
    Crews respond from a severity on: WARNING after AC 25.1322-1; an assumption.
    """

    name = "surf_a"
    reads: tuple[type[Message], ...] = (Briefing, AdsbReport)

    def __init__(
        self,
        configuration: SurfaceAlertConfig | None = None,
        responds_from: Severity = Severity.WARNING,
    ) -> None:
        self.configuration = config = configuration or SurfaceAlertConfig()
        self._responds_from = responds_from
        self._situation: RunwaySituation | None = None
        self._alerts = RaisedAlerts("surf", config.persistence_s, config.release_s)

    def receive(self, received: ReceivedMessage) -> None:
        """Update the traffic with one message."""
        match received.message:
            case Briefing(airport=airport) as briefing if airport is not None and airport.runways:
                self._situation = RunwaySituation(airport, briefing)
            case AdsbReport() as report if self._situation is not None:
                self._situation.take_report(report, received.t_ns)

    def decide(self, t_ns: int) -> Decision:
        """Return the alerts that are new, have risen, or are over."""
        if self._situation is None:
            return Decision()
        self._situation.forget(t_ns)
        found = predicted_collisions(self._situation, self.configuration, self._responds_from, t_ns)
        alerts = self._alerts.update(t_ns, found)
        return Decision(alerts, again_ns=t_ns + AGAIN_NS if self._alerts.has_any else None)


def predicted_collisions(
    situation: RunwaySituation, config: SurfaceAlertConfig, responds_from: Severity, t_ns: int
) -> Iterator[Hazard]:
    """Yield the collisions that crews are to be told of, and respond to from a severity on."""
    for use in situation.uses.values():
        if use.mobile.is_vehicle or use.is_climbing:
            continue
        for obstacle in situation.obstacles(use.strip):
            if obstacle.mobile is use.mobile:
                continue
            time_to_go_s = _time_to_go_s(situation, use, obstacle, config.margin_s, t_ns)
            if time_to_go_s is not None and time_to_go_s <= config.caution_s:
                is_warning = time_to_go_s <= config.warning_s
                severity = Severity.WARNING if is_warning else Severity.CAUTION
                responds = severity.rank >= responds_from.rank
                yield _hazard(use, obstacle, severity, time_to_go_s, responds=responds)


def _time_to_go_s(
    situation: RunwaySituation, use: Use, obstacle: Obstacle, margin_s: float, t_ns: int
) -> float | None:
    """Return the time until somebody meets another on its runway; None if they do not meet.

    An arrival is not expected to brake. It has the time to its touchdown at most, so that traffic
    far down the runway is told of before the landing too (HONEYWELL).
    """
    speed, entry_m = obstacle.mobile.speed_m_s, obstacle.way.entry_m
    cannot_stop = speed > STANDING_M_S and entry_m <= speed**2 / (2.0 * BRAKING_M_S2)
    if not (obstacle.is_inside or cannot_stop):
        return None
    along_m = use.direction.along_m(_meeting_place(use, obstacle))
    if along_m < use.along_m - BEHIND_M:
        return None
    reach_s = _reach_s(use, along_m, t_ns)
    if reach_s is None:
        return None
    leaves_s = obstacle.leaving_s(situation.use(obstacle.mobile), use)
    if leaves_s is not None and reach_s > leaves_s + margin_s:
        return None
    if reach_s < entry_m / max(speed, STANDING_M_S) - margin_s:
        return None
    if use.kind != "arrival":
        return reach_s
    return min(reach_s, _reach_s(use, TOUCHDOWN_M, t_ns) or 0.0)


def _meeting_place(use: Use, obstacle: Obstacle) -> Vector:
    """Return where a mobile is met: in the middle of its way across, or where it is now.

    The latter holds for those that stand, and that move along the runway.
    """
    other, way, direction = obstacle.mobile, obstacle.way, use.direction
    is_along = any(direction.points_along(other.heading_rad + turn) for turn in (0.0, math.pi))
    if other.speed_m_s < STANDING_M_S or is_along:
        return other.point
    return other.point.moved((way.entry_m + way.exit_m) / 2.0, other.heading_rad)


def _reach_s(use: Use, along_m: float, t_ns: int) -> float | None:
    """Return the time until the user of a runway is somewhere on it; None if it stops before."""
    if use.kind != "arrival":
        return use.time_to_s(max(along_m, use.along_m), t_ns)
    age_s = (t_ns - use.mobile.t_ns) / SECOND_NS
    return max(max(along_m - use.along_m, 0.0) / max(use.mobile.speed_m_s, 1.0) - age_s, 0.0)


def _hazard(
    use: Use, obstacle: Obstacle, severity: Severity, time_to_go_s: float, *, responds: bool
) -> Hazard:
    """Return the hazard for the crew that uses the runway, and for nobody else."""
    own, other, runway = use.mobile.callsign, obstacle.mobile.callsign, use.direction.ident
    how: Obstructs = "on" if obstacle.is_inside else "entering"
    finding = Obstruction(own, use.kind, runway, how, other, runway)
    response = _response(use) if responds else None
    return Hazard(
        key=(own, other),
        severity=severity,
        kind="runway_conflict",
        recipients=(own,),
        traffic=(own, other),
        evidence=Evidence(
            sources=("adsb",),
            runway=runway,
            time_to_go_s=time_to_go_s,
            note=finding.statement(),
            tracks=(use.mobile.icao24, obstacle.mobile.icao24),
            rules=("predicted_collision",),
        ),
        finding=finding,
        recommendations={} if response is None else {own: response},
    )


def _response(use: Use) -> Recommendation | None:
    """Return what a crew does on an alert; None if it brakes already.

    The real system commands nothing. Crews of the testbed act on recommendations, so the usual
    response takes its place: go around, or reject the take-off.
    """
    if use.kind == "arrival":
        return GoAround(runway=use.direction.ident)
    return CancelTakeoff(runway=use.direction.ident) if use.kind == "departure" else None


def _engine(argument: str, configuration: SurfaceAlertConfig) -> SurfaceAlertEngine:
    """Return the engine; the argument is the severity from which crews respond.

    Raises
    ------
    AirhiltError
        There are no alerts of that severity.
    """
    severities = {each.value.lower(): each for each in (Severity.CAUTION, Severity.WARNING)}
    severity = severities.get(argument or "warning")
    if severity is None:
        raise AirhiltError(
            f"assistant 'surf_a:{argument}': expected surf_a:{' or surf_a:'.join(severities)}"
        )
    return SurfaceAlertEngine(configuration, severity)


ENGINE = Engine(
    name="surf_a",
    summary="alerts crews of traffic on their runway by ADS-B, in the manner of SURF-A",
    create=_engine,
    argument="SEVERITY",
    configuration=SurfaceAlertConfig,
)
