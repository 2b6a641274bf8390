"""Belief about each aircraft in flight, from ADS-B and from what was said."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from airhilt.geodesy.relative_motion import VerticalProfile
from airhilt.geodesy.wgs84 import displaced
from airhilt.messages import AdsbReport
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS

if TYPE_CHECKING:
    from airhilt.assistant.decision.service_messages import TrackSlice

LEVEL_BELOW_M_S = 200 * FOOT_PER_MINUTE
"""Vertical rate, in m/s, below which flight counts as level: three quanta of ADS-B."""
LEVEL_WITHIN_M = 200 * FOOT
"""Distance to the cleared level, in m, within which an aircraft is levelling off.

The filtered rate may still say otherwise. It is the tolerance of ICAO Doc 4444, 8.5.5.2.1, in RVSM
airspace."""
UNFOLLOWED_NS = 30 * SECOND_NS
"""Time after a readback, in ns, from which its level is no longer expected of an aircraft that
moves away from it: twice the time in which crews begin what they read back."""
EMERGENCY_DESCENT_M_S = 5000 * FOOT_PER_MINUTE
"""Rate of an emergency descent, in m/s, until it is seen: airliners do 4,000 to 7,500 ft/min."""
EMERGENCY_LEVEL_M = 10_000 * FOOT
"""Level to which cabins without pressure descend, in m (14 CFR 121.329: oxygen above it)."""
VELOCITY_MEMORY = 0.6
"""Weight of the earlier velocity in the exponential mean; about 1 s at two reports a second."""


@dataclass(slots=True)
class Track:
    """One aircraft, with its position as of ``t_ns``."""

    icao24: str
    callsign: str
    t_ns: int
    latitude_rad: float
    longitude_rad: float
    altitude_m: float
    velocity_north_m_s: float
    velocity_east_m_s: float
    vertical_rate_m_s: float
    cleared_m: float | None = None
    """Level that was last read back, in m."""
    cleared_ns: int = 0
    """Time of that readback."""
    in_distress: bool = False
    """True if it is in distress, and goes where it can."""
    descent_ns: int | None = None
    """Time at which its crew announced an emergency descent; None if they did not."""
    cleared_id: str = ""
    """Id of the transmission with that readback."""
    descent_id: str = ""
    """Id of the transmission with that announcement."""

    @classmethod
    def of(cls, report: AdsbReport | TrackSlice, altitude_ft: float, t_ns: int) -> Track:
        """Return the track of a first report, which is as of a time."""
        speed, course = report.ground_speed_kt * KNOT, report.track_deg * DEGREE
        return cls(
            report.icao24,
            report.callsign or report.icao24,
            t_ns,
            report.latitude_deg * DEGREE,
            report.longitude_deg * DEGREE,
            altitude_ft * FOOT,
            speed * math.cos(course),
            speed * math.sin(course),
            report.vertical_rate_fpm * FOOT_PER_MINUTE,
        )

    def update(self, report: AdsbReport, altitude_ft: float) -> None:
        """Update with a newer report; an older one is ignored."""
        if report.t_adsb_in_ns < self.t_ns:
            return
        now = Track.of(report, altitude_ft, report.t_adsb_in_ns)
        self.callsign = report.callsign or self.callsign
        self.t_ns, self.altitude_m = now.t_ns, now.altitude_m
        self.latitude_rad, self.longitude_rad = now.latitude_rad, now.longitude_rad
        self.velocity_north_m_s = _mean(self.velocity_north_m_s, now.velocity_north_m_s)
        self.velocity_east_m_s = _mean(self.velocity_east_m_s, now.velocity_east_m_s)
        self.vertical_rate_m_s = _mean(self.vertical_rate_m_s, now.vertical_rate_m_s)
        if not self._is_followed():
            self.cleared_m = None

    def clear(self, level_m: float, t_ns: int, radio_id: str) -> None:
        """Expect it at a level that its crew has read back."""
        self.cleared_m, self.cleared_ns, self.cleared_id = level_m, t_ns, radio_id

    def announce_descent(self, t_ns: int, radio_id: str) -> None:
        """Expect an emergency descent that its crew has announced."""
        self.descent_ns, self.descent_id = t_ns, radio_id

    def _is_followed(self) -> bool:
        """Return whether it is at its cleared level, moves to it, or still may begin to.

        Who stays level longer than usual may have been told to, and will end at that level.
        """
        if self.cleared_m is None or self.t_ns - self.cleared_ns < UNFOLLOWED_NS:
            return True
        to_go_m = self.cleared_m - self.altitude_m
        is_level = abs(self.vertical_rate_m_s) < LEVEL_BELOW_M_S
        is_there = abs(to_go_m) <= LEVEL_WITHIN_M
        return is_level or is_there or to_go_m * self.vertical_rate_m_s > 0.0

    def at(self, t_ns: int) -> Track:
        """Return the track extrapolated to a time."""
        elapsed = (t_ns - self.t_ns) / SECOND_NS
        latitude, longitude = displaced(
            (self.latitude_rad, self.longitude_rad),
            self.velocity_north_m_s * elapsed,
            self.velocity_east_m_s * elapsed,
            self.altitude_m,
        )
        return replace(
            self,
            t_ns=t_ns,
            latitude_rad=latitude,
            longitude_rad=longitude,
            altitude_m=self.profile().at(elapsed),
        )

    @property
    def _is_about_to_descend(self) -> bool:
        """True if an emergency descent was announced a moment ago."""
        return self.descent_ns is not None and self.t_ns - self.descent_ns < UNFOLLOWED_NS

    @property
    def radio_id(self) -> str:
        """Id of the transmission that its expected climb or descent rests on; empty if none."""
        if self._is_about_to_descend:
            return self.descent_id
        return "" if self.profile().target_m is None else self.cleared_id

    def profile(self) -> VerticalProfile:
        """Return the expected climb or descent: to the cleared level, if it moves towards it.

        An emergency descent is expected from the words on, before it can be seen.
        """
        rate = self.vertical_rate_m_s
        if self._is_about_to_descend:
            steepest = min(rate, -EMERGENCY_DESCENT_M_S)
            return VerticalProfile(self.altitude_m, steepest, EMERGENCY_LEVEL_M)
        if abs(rate) < LEVEL_BELOW_M_S:
            return VerticalProfile(self.altitude_m, 0.0)
        if self.cleared_m is not None:
            to_go_m = self.cleared_m - self.altitude_m
            if to_go_m * rate > 0.0:
                return VerticalProfile(self.altitude_m, rate, self.cleared_m)
            if abs(to_go_m) <= LEVEL_WITHIN_M:
                return VerticalProfile(self.altitude_m, 0.0)
        return VerticalProfile(self.altitude_m, rate)


def _mean(before: float, now: float) -> float:
    return VELOCITY_MEMORY * before + (1.0 - VELOCITY_MEMORY) * now
