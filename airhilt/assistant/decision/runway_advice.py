"""Recommendations to those whom a threat on a runway concerns."""

from __future__ import annotations

from airhilt.assistant.decision.aerodrome import Strip
from airhilt.assistant.decision.findings import NotReadBack
from airhilt.assistant.decision.mobiles import Mobile, lined_up_on
from airhilt.assistant.decision.situation import RunwaySituation
from airhilt.assistant.decision.threats import RunwayConfig, Threat
from airhilt.messages import CancelTakeoff, GoAround, HoldPosition, Recommendation, Severity

FIRM_BRAKING_M_S2 = 2.5
"""Deceleration, in m/s2, within which somebody who can stop short of the pavement is told to."""


def advice(
    mobile: Mobile,
    threat: Threat,
    severity: Severity,
    situation: RunwaySituation,
    config: RunwayConfig,
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
        misread = threat.kind == "readback_mismatch" and time_to_go_s <= config.caution_s
        return GoAround(runway=use.direction.ident) if is_urgent or misread else None
    if use.kind == "departure" and mobile.on_ground and is_urgent:
        return CancelTakeoff(runway=use.direction.ident)
    return None


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
