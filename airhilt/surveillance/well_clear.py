"""Well clear: the volume that unmanned aircraft keep free, and when a violation is told.

RTCA DO-365B (2021), section 2.2.4.3 and appendix C, for phase I (en route), as NASA's DAIDALUS
configures it without uncertainties of sensors. Two are not well clear while they are within DMOD
or close with a modified tau within the limit and a miss distance within DMOD, and are within ZTHR
vertically. The formulas of the intervals are those of Munoz, Narkawicz, Chamberlain, "A TCAS-II
Resolution Advisory Detection Algorithm" (AIAA 2013-4622).
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from airhilt.geodesy.relative_motion import Relative
from airhilt.units import FOOT, NAUTICAL_MILE

AlertName = Literal["preventive", "corrective", "warning"]


class Volume(NamedTuple):
    """The volume in which two are not well clear; DMOD is the limit of the miss distance too."""

    tau_s: float
    dmod_m: float
    zthr_m: float


class AlertLevel(NamedTuple):
    """One level of alerts: a volume, and how long before its violation there is an alert."""

    name: AlertName
    volume: Volume
    alert_s: float


_TAU_S, _DMOD_M = 35.0, 0.66 * NAUTICAL_MILE
PREVENTIVE = AlertLevel("preventive", Volume(_TAU_S, _DMOD_M, 700 * FOOT), 55.0)
CORRECTIVE = AlertLevel("corrective", Volume(_TAU_S, _DMOD_M, 450 * FOOT), 55.0)
WARNING = AlertLevel("warning", Volume(_TAU_S, _DMOD_M, 450 * FOOT), 25.0)
LEVELS = (WARNING, CORRECTIVE, PREVENTIVE)
"""The levels, the most urgent first."""
LOOK_AHEAD_S = 180.0
"""Time for which a manoeuvre is to stay well clear, in s (DAIDALUS)."""
HYSTERESIS_S = 5.0
"""Time without a violation ahead after which an alert ends, in s. It keeps the least duration of
an alert, the persistence of 4 s, as well."""


class Gap(NamedTuple):
    """Vertical distance of the other one above the own aircraft, and its rate."""

    gap_m: float
    rate_m_s: float


Interval = tuple[float, float]
"""Begin and end from now, in s; the begin may be past, and the ends infinite."""


def time_to_violation_s(motion: Relative, gap: Gap, volume: Volume) -> float | None:
    """Return the time until two are not well clear if both fly on; 0 if they are not already.

    None if they stay well clear.
    """
    across, along = _horizontal_interval(motion, volume), _vertical_interval(gap, volume.zthr_m)
    if across is None or along is None:
        return None
    begin_s, end_s = max(across[0], along[0], 0.0), min(across[1], along[1])
    return begin_s if begin_s <= end_s else None


def level_of(motion: Relative, gap: Gap) -> AlertLevel | None:
    """Return the most urgent level of which there is an alert now; None if there is none."""
    for level in LEVELS:
        violation_s = time_to_violation_s(motion, gap, level.volume)
        if violation_s is not None and violation_s <= level.alert_s:
            return level
    return None


def _horizontal_interval(motion: Relative, volume: Volume) -> Interval | None:
    """Return from when to when two are not well clear horizontally."""
    inside = motion.interval_within(volume.dmod_m)
    if inside is None:
        return None
    speed_squared = motion.velocity_north_m_s**2 + motion.velocity_east_m_s**2
    closing = motion.north_m * motion.velocity_north_m_s + motion.east_m * motion.velocity_east_m_s
    if speed_squared < 1e-12:
        return inside
    # Modified tau is within the limit where s^2 + tau (s . v) <= DMOD^2, a parabola in time.
    half_b = closing + 0.5 * volume.tau_s * speed_squared
    rest = motion.distance_m**2 + volume.tau_s * closing - volume.dmod_m**2
    # It holds where two come within DMOD, so that it does from its first root on until they part.
    discriminant = max(half_b**2 - speed_squared * rest, 0.0)
    return (-half_b - math.sqrt(discriminant)) / speed_squared, inside[1]


def _vertical_interval(gap: Gap, zthr_m: float) -> Interval | None:
    """Return from when to when two are within a vertical distance."""
    if gap.rate_m_s == 0.0:
        return (-math.inf, math.inf) if abs(gap.gap_m) <= zthr_m else None
    edges = sorted((edge - gap.gap_m) / gap.rate_m_s for edge in (-zthr_m, zthr_m))
    return edges[0], edges[1]
