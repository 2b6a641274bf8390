"""Velocities that are checked against positions, for feeds that give none, or a wrong one.

What a target covers within some seconds is compared with what its reported velocities come to. If
the two differ by more than their errors, a line through its last places gives the velocity, until
the two agree again. Places that lie on no line, because of a jump, give none.
"""

from __future__ import annotations

import cmath
import math
from collections import deque
from dataclasses import dataclass, field
from typing import NamedTuple, TypeVar

from airhilt.geodesy.wgs84 import Place, offset_m
from airhilt.messages import AdsbReport, SurfaceTrack
from airhilt.surveillance.squitters import (
    NACP_95_PERCENT_M,
    NACV_95_PERCENT_M_S,
    VERTICAL_RATE_STEP_FPM,
)
from airhilt.surveillance.surface import SPEED_95_PERCENT_M_S
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS, bearing_degrees

SPAN_S = 12.0
"""Time over which places and velocities are compared, in s: a climb of 500 ft/min then shows."""
LINE_S = 5.0
"""Time over which the places make a line, in s."""
LEAST_REPORTS = 3
"""Least number of reports for either, however long their interval."""
FORGOTTEN_NS = 15 * SECOND_NS
"""Silence after which earlier places count no more, in ns: tracks are dropped then as well."""
LATENCY_S = 0.6
"""Time by which a place and a velocity of one report may differ, in s: the uncompensated latency
that 14 CFR 91.227 (e) allows."""
ALTITUDE_ROOM_M = 100.0 * FOOT
"""Error of a climb by two altitudes, in m: the step of Mode C (ICAO Annex 10, volume IV)."""
LEAST_NACP = 8
"""Accuracy category of a place, if it is unknown: what 14 CFR 91.227 (c) asks for."""
DRIFTING, FLEETING = math.sqrt(2.0), 3.0
"""Error of a way by two places, in 95 % errors of one: if errors last for minutes, as those of
satellite navigation do, and if they are others after seconds, as those of radar are."""
TURN_RAD_S = 3.0 * DEGREE
"""Rate of turn up to which a way is taken for a line, in rad/s: the standard rate."""
MOVING_M_S = 2.0
"""Speed below which a target's direction is mostly error, and nobody moves on, in m/s."""
Report = TypeVar("Report", AdsbReport, SurfaceTrack)


class _Point(NamedTuple):
    """Way of a target up to a time; complex numbers are north and east."""

    t_s: float
    velocity: complex
    """As reported, in m/s."""
    covered_m: complex
    """Way by places."""
    led_m: complex
    """Way by reported velocities."""
    path_m: float
    """Way by reported speeds, whatever their direction."""


class _Motion:
    """Way of a target over the ground, or up, by its places and by its reported velocities."""

    def __init__(self) -> None:
        self._points: deque[_Point] = deque()
        self._is_wrong = False

    def velocity(
        self, elapsed_s: float, step_m: complex, reported: complex, error_m: float, error_m_s: float
    ) -> complex:
        """Return the velocity after one more step: the reported one, if it is no contradiction.

        The errors are those of a way by two places, and of a velocity.
        """
        points = self._points
        last = points[-1] if points else _Point(0.0, reported, 0.0, 0.0, 0.0)
        led_m = 0.5 * (last.velocity + reported) * elapsed_s
        if elapsed_s > 0.0 or not points:
            last = _Point(
                last.t_s + elapsed_s, reported, last.covered_m + step_m, last.led_m + led_m,
                last.path_m + abs(led_m),
            )  # fmt: skip
            points.append(last)
        while len(points) > LEAST_REPORTS and points[0].t_s < last.t_s - SPAN_S:
            points.popleft()
        if len(points) < LEAST_REPORTS:
            return reported
        first = points[0]
        span_s, path_m = last.t_s - first.t_s, last.path_m - first.path_m
        covered_m = last.covered_m - first.covered_m
        # A standstill is reported as such, and so is the want of a velocity.
        moves_m = LATENCY_S * path_m / span_s + error_m_s * span_s if path_m > 0.0 else 0.0
        if abs(covered_m - (last.led_m - first.led_m)) > error_m + moves_m:
            self._is_wrong = True
        elif abs(covered_m) > error_m:
            self._is_wrong = False
        return self._along_line(reported, error_m) if self._is_wrong else reported

    def _along_line(self, reported: complex, error_m: float) -> complex:
        """Return the velocity by a least-squares line; the reported one if there is no line."""
        end_s = self._points[-1].t_s
        count = sum(point.t_s >= end_s - LINE_S for point in self._points)
        points = list(self._points)[-max(count, LEAST_REPORTS) :]
        middle_s = sum(point.t_s for point in points) / len(points)
        middle_m = sum(point.covered_m for point in points) / len(points)
        ways = [(point.t_s - middle_s, point.covered_m - middle_m) for point in points]
        velocity = sum(t_s * way_m for t_s, way_m in ways) / sum(t_s**2 for t_s, _ in ways)
        bend_m = abs(velocity) * TURN_RAD_S * (end_s - points[0].t_s) ** 2 / 8.0
        off_m = max(abs(way_m - velocity * t_s) for t_s, way_m in ways)
        return velocity if off_m <= 0.5 * error_m + bend_m else reported


@dataclass
class _Past:
    """State of one target as of its last report."""

    t_ns: int
    place: Place
    altitude_ft: float | None = None
    ground: _Motion = field(default_factory=_Motion)
    climb: _Motion = field(default_factory=_Motion)


class VelocityChecks:
    """Gives reports the velocity by their targets' places, where theirs contradicts these."""

    def __init__(self) -> None:
        self._pasts: dict[str | int, _Past] = {}
        """By address or number of the track; the one heard longest ago is first."""

    def checked(self, report: Report) -> Report:
        """Return a report with a velocity that agrees with the places up to it.

        One that is older than the last of its target is returned as it is.
        """
        key: str | int
        if isinstance(report, AdsbReport):
            key, t_ns = report.icao24, report.t_adsb_in_ns
            error_m = DRIFTING * NACP_95_PERCENT_M[report.nacp or LEAST_NACP]
            error_m_s = NACV_95_PERCENT_M_S[report.nacv]
        else:
            key, t_ns = report.track, report.t_track_ns
            error_m, error_m_s = FLEETING * report.accuracy_m, SPEED_95_PERCENT_M_S
        place = report.latitude_deg * DEGREE, report.longitude_deg * DEGREE
        past = self._past(key, t_ns, place)
        elapsed_s = (t_ns - past.t_ns) / SECOND_NS
        if elapsed_s < 0.0:
            return report
        reported = cmath.rect(report.ground_speed_kt * KNOT, (report.track_deg or 0.0) * DEGREE)
        step_m = complex(*offset_m(past.place, place))
        velocity = past.ground.velocity(elapsed_s, step_m, reported, error_m, error_m_s)
        changed: dict[str, float] = {}
        if velocity != reported:
            changed["ground_speed_kt"] = abs(velocity) / KNOT
            if abs(velocity) >= MOVING_M_S:
                changed["track_deg"] = bearing_degrees(cmath.phase(velocity))
        if isinstance(report, AdsbReport):
            rate_m_s = self._rate_m_s(report, past, elapsed_s)
            if rate_m_s is not None:
                changed["vertical_rate_fpm"] = rate_m_s / FOOT_PER_MINUTE
        past.t_ns, past.place, past.altitude_ft = t_ns, place, report.altitude_ft
        return report.model_copy(update=changed) if changed else report

    def _past(self, key: str | int, t_ns: int, place: Place) -> _Past:
        """Return what is known of a target, and forget those of whom nothing was heard lately."""
        past = self._pasts.pop(key, None)
        if past is None or abs(t_ns - past.t_ns) > FORGOTTEN_NS:
            past = _Past(t_ns, place)
        self._pasts[key] = past
        while abs(t_ns - (first := next(iter(self._pasts.items())))[1].t_ns) > FORGOTTEN_NS:
            del self._pasts[first[0]]
        return past

    def _rate_m_s(self, report: AdsbReport, past: _Past, elapsed_s: float) -> float | None:
        """Return the vertical rate by the altitudes; None if the reported one may be right."""
        if report.altitude_ft is None or past.altitude_ft is None:
            past.climb = _Motion()
            return None
        step_m = (report.altitude_ft - past.altitude_ft) * FOOT
        reported = complex(report.vertical_rate_fpm * FOOT_PER_MINUTE)
        error_m_s = VERTICAL_RATE_STEP_FPM * FOOT_PER_MINUTE
        rate = past.climb.velocity(elapsed_s, step_m, reported, ALTITUDE_ROOM_M, error_m_s)
        return None if rate == reported else rate.real
