"""Alerts of TCAS II: its published thresholds, and the tests by range and altitude.

The thresholds are those of FAA, Introduction to TCAS II Version 7.1 (2011), table 2 and the section
on inhibits. Modified tau is that of RTCA DO-185B and of Munoz, Narkawicz, Chamberlain, "A TCAS-II
Resolution Advisory Detection Algorithm" (AIAA 2013-4622). The horizontal miss distance filter is
left out of `alert` and `project`, so their times are the earliest at which TCAS would give an
alert. `project` assumes that both aircraft are equipped.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal, NamedTuple

from airhilt.geodesy.relative_motion import Relative
from airhilt.units import FOOT, NAUTICAL_MILE

Alert = Literal["tcas_ta", "tcas_ra"]
AltitudeAt = Callable[[float], float]
"""Altitude (m) at a time from now (s)."""

CYCLE_S = 1.0
"""Period of TCAS surveillance, in s."""


class Thresholds(NamedTuple):
    """Thresholds of one alert in one sensitivity level."""

    tau_s: float
    dmod_m: float
    zthr_m: float


class SensitivityLevel(NamedTuple):
    """One row of table 2; ``resolution`` is None where no resolution advisory is given.

    ``alim_m`` is the vertical separation at the closest approach that an advisory aims at.
    """

    level: int
    traffic: Thresholds
    resolution: Thresholds | None
    alim_m: float


def _row(
    level: int,
    traffic: tuple[float, float, float],
    resolution: tuple[float, float, float] | None,
    alim_ft: float,
) -> SensitivityLevel:
    def thresholds(tau_s: float, dmod_nm: float, zthr_ft: float) -> Thresholds:
        return Thresholds(tau_s, dmod_nm * NAUTICAL_MILE, zthr_ft * FOOT)

    advisory = None if resolution is None else thresholds(*resolution)
    return SensitivityLevel(level, thresholds(*traffic), advisory, alim_ft * FOOT)


_LEVEL_2 = _row(2, (20, 0.30, 850), None, 300)
_LEVEL_3 = _row(3, (25, 0.33, 850), (15, 0.20, 600), 300)
_BY_ALTITUDE_FT = (
    (5_000, _row(4, (30, 0.48, 850), (20, 0.35, 600), 300)),
    (10_000, _row(5, (40, 0.75, 850), (25, 0.55, 600), 350)),
    (20_000, _row(6, (45, 1.00, 850), (30, 0.80, 600), 400)),
    (42_000, _row(7, (48, 1.30, 850), (35, 1.10, 700), 600)),
)
_ABOVE = _row(7, (48, 1.30, 1200), (35, 1.10, 800), 700)

TRAFFIC_INHIBITED_BELOW_M = 500 * FOOT
"""Height below which the traffic advisory is not announced, in m."""
RESOLUTION_INHIBITED_BELOW_M = 1000 * FOOT
"""Height below which no resolution advisory is given, in m: that of sensitivity level 2."""
INTRUDER_ON_GROUND_BELOW_M = 380 * FOOT
"""Height below which an intruder counts as on the ground, in m, if `OWN_LOW_M` applies."""
OWN_LOW_M = 1700 * FOOT
"""Own height below which intruders near the ground are left out, in m."""


def sensitivity_level(altitude_m: float, height_m: float) -> SensitivityLevel:
    """Return the sensitivity level for an own pressure altitude and height above ground, in m."""
    if height_m < RESOLUTION_INHIBITED_BELOW_M:
        return _LEVEL_2
    if height_m < 2350 * FOOT:
        return _LEVEL_3
    return next((row for limit_ft, row in _BY_ALTITUDE_FT if altitude_m < limit_ft * FOOT), _ABOVE)


class RangeMotion(NamedTuple):
    """Distance to the intruder, and its rate of change."""

    range_m: float
    rate_m_s: float

    @classmethod
    def of(cls, motion: Relative) -> RangeMotion:
        """Return the horizontal distance and its rate."""
        distance = motion.distance_m
        if distance == 0.0:
            return cls(0.0, 0.0)
        product = (
            motion.north_m * motion.velocity_north_m_s + motion.east_m * motion.velocity_east_m_s
        )
        return cls(distance, product / distance)


def range_test(motion: RangeMotion, thresholds: Thresholds) -> bool:
    """Return whether the pair is within DMOD or closes with a modified tau within the limit."""
    distance, rate = motion
    if distance <= thresholds.dmod_m:
        return True
    if rate >= 0.0:
        return False
    return (thresholds.dmod_m**2 - distance**2) / (distance * rate) <= thresholds.tau_s


def _altitude_test(gap_m: float, gap_rate_m_s: float, thresholds: Thresholds) -> bool:
    """Return whether the pair is within ZTHR or will be co-altitude within tau."""
    if abs(gap_m) <= thresholds.zthr_m:
        return True
    return gap_m * gap_rate_m_s < 0.0 and -gap_m / gap_rate_m_s <= thresholds.tau_s


class Own(NamedTuple):
    """Own altitude and height, and the intruder's height, as TCAS has them."""

    altitude_m: float
    height_m: float
    intruder_height_m: float


def alert(motion: Relative, gap_m: float, gap_rate_m_s: float, own: Own) -> Alert | None:
    """Return the alert that TCAS II gives at this instant by true states; see `alert_at`."""
    return alert_at(RangeMotion.of(motion), gap_m, gap_rate_m_s, own)


def alert_at(motion: RangeMotion, gap_m: float, gap_rate_m_s: float, own: Own) -> Alert | None:
    """Return the alert that TCAS II on the own aircraft gives at this instant; None if none.

    The gap is the intruder's altitude less the own one.
    """
    if own.height_m < TRAFFIC_INHIBITED_BELOW_M:
        return None
    if own.height_m < OWN_LOW_M and own.intruder_height_m < INTRUDER_ON_GROUND_BELOW_M:
        return None
    row = sensitivity_level(own.altitude_m, own.height_m)

    def is_met(thresholds: Thresholds) -> bool:
        return range_test(motion, thresholds) and _altitude_test(gap_m, gap_rate_m_s, thresholds)

    if row.resolution is not None and is_met(row.resolution):
        return "tcas_ra"
    return "tcas_ta" if is_met(row.traffic) else None


class Projection(NamedTuple):
    """Time until each alert, in s, if both fly on as they do; None if it does not come."""

    traffic_s: float | None
    resolution_s: float | None


def project(
    motion: Relative,
    own_altitude_m: AltitudeAt,
    other_altitude_m: AltitudeAt,
    ground_m: float,
    horizon_s: float = 1200.0,
) -> Projection:
    """Return the times until the alerts of the own aircraft's TCAS II, if nobody reacts.

    Horizontally both aircraft fly straight on. Their altitudes are functions of the time from now.
    Time goes on by TCAS's own cycle of one second. A resolution advisory counts as a traffic
    advisory too if none came before. `earliest` combines the projections of both aircraft.
    """
    first: dict[Alert, float] = {}
    for step in range(math.ceil(horizon_s / CYCLE_S)):
        time_s = step * CYCLE_S
        own_m, other_m = own_altitude_m(time_s), other_altitude_m(time_s)
        gap = other_m - own_m
        later = other_altitude_m(time_s + CYCLE_S) - own_altitude_m(time_s + CYCLE_S)
        said = alert(
            motion.at(time_s),
            gap,
            (later - gap) / CYCLE_S,
            Own(own_m, own_m - ground_m, other_m - ground_m),
        )
        if said is not None:
            first.setdefault("tcas_ta", time_s)
            first.setdefault(said, time_s)
        if "tcas_ra" in first:
            break
    return Projection(first.get("tcas_ta"), first.get("tcas_ra"))


def earliest(one: Projection, other: Projection) -> Projection:
    """Return the earlier of two projections, alert by alert."""

    def first(a: float | None, b: float | None) -> float | None:
        return min((time_s for time_s in (a, b) if time_s is not None), default=None)

    return Projection(
        first(one.traffic_s, other.traffic_s), first(one.resolution_s, other.resolution_s)
    )
