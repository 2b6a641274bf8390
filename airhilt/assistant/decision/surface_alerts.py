"""Alerts of collisions on a runway to the crew that takes off or lands, in the manner of SURF-A.

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
from airhilt.assistant.decision.findings import Obstruction, Obstructs
from airhilt.assistant.decision.leaving import leaving_s
from airhilt.assistant.decision.mobiles import ALIGNED_RAD, STANDING_M_S, TOUCHDOWN_M, Use
from airhilt.assistant.decision.raised_alerts import Hazard
from airhilt.assistant.decision.situation import Obstacle, RunwaySituation
from airhilt.configuration import Configuration, Seconds, require_order
from airhilt.messages import CancelTakeoff, Evidence, GoAround, Recommendation, Severity
from airhilt.units import SECOND_NS, wrap_angle

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


def predicted_collisions(
    situation: RunwaySituation, config: SurfaceAlertConfig, responds_from: Severity, t_ns: int
) -> Iterator[Hazard]:
    """Yield the collisions that crews are to be told of.

    Parameters
    ----------
    responds_from
        Severity from which crews respond.
    """
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
    if not (obstacle.is_inside or _cannot_stop(obstacle)):
        return None
    other, way = obstacle.mobile, obstacle.way
    along_m = use.direction.along_m(_meeting_place(use, obstacle))
    if along_m < use.along_m - BEHIND_M:
        return None
    reach_s = _reach_s(use, along_m, t_ns)
    if reach_s is None:
        return None
    leaves_s = leaving_s(obstacle, situation.use(other), use)
    if leaves_s is not None and reach_s > leaves_s + margin_s:
        return None
    if reach_s < way.entry_m / max(other.speed_m_s, STANDING_M_S) - margin_s:
        return None
    if use.kind != "arrival":
        return reach_s
    return min(reach_s, _reach_s(use, TOUCHDOWN_M, t_ns) or 0.0)


def _cannot_stop(obstacle: Obstacle) -> bool:
    """Return whether a mobile outside cannot stop short of the runway's area any more."""
    speed = obstacle.mobile.speed_m_s
    return speed > STANDING_M_S and obstacle.way.entry_m <= speed**2 / (2.0 * BRAKING_M_S2)


def _meeting_place(use: Use, obstacle: Obstacle) -> Vector:
    """Return where a mobile is met: in the middle of its way across, or where it is now.

    The latter holds for those that stand, and that move along the runway.
    """
    other, way = obstacle.mobile, obstacle.way
    angle = abs(wrap_angle(other.heading_rad - use.direction.course_rad))
    if other.speed_m_s < STANDING_M_S or min(angle, math.pi - angle) <= ALIGNED_RAD:
        return other.point
    ahead_m = (way.entry_m + way.exit_m) / 2.0
    return Vector(
        other.point.east + ahead_m * math.sin(other.heading_rad),
        other.point.north + ahead_m * math.cos(other.heading_rad),
    )


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
