"""A controller's displays: targets of ADS-B and of surface surveillance, and the runways."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from shapely import Point, Polygon

from airhilt.geodesy.wgs84 import displaced, offset_m
from airhilt.messages import AdsbReport, Briefing, Message, RunwayBriefing, SurfaceTrack
from airhilt.sim import Director
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE, SECOND_NS, wrap_angle

STALE_S = 15.0
"""Age in s after which a target has left the display: three turns of a terminal radar."""
FINAL_LENGTH_M = 15.0 * NAUTICAL_MILE
"""Length of what counts as the final approach of a runway, in m: an assumption."""
FINAL_ANGLE_RAD = math.radians(30.0)
"""Greatest angle between the track of an arrival and its runway: that at which final approaches are
intercepted (FAA Order JO 7110.65, 5-9-2)."""
FINAL_SLOPE = 0.12
"""Greatest part of its distance to the threshold that an arrival is high, and that it is aside of
the centre line: twice a glide path of 3.5 degrees."""


@dataclass(frozen=True, slots=True)
class Target:
    """A target with a callsign, as it is displayed at one instant; SI and radians."""

    callsign: str
    latitude_rad: float
    longitude_rad: float
    altitude_m: float
    """Height above mean sea level; the airport's elevation on the ground."""
    velocity_north_m_s: float
    velocity_east_m_s: float
    vertical_m_s: float
    on_ground: bool
    t_ns: int

    @property
    def speed_m_s(self) -> float:
        """Ground speed."""
        return math.hypot(self.velocity_north_m_s, self.velocity_east_m_s)

    @property
    def track_rad(self) -> float:
        """True track."""
        return math.atan2(self.velocity_east_m_s, self.velocity_north_m_s)

    def at(self, t_ns: int) -> Target:
        """Return the target as it is at another time if it moves straight on."""
        time_s = (t_ns - self.t_ns) / SECOND_NS
        latitude_rad, longitude_rad = displaced(
            (self.latitude_rad, self.longitude_rad),
            self.velocity_north_m_s * time_s,
            self.velocity_east_m_s * time_s,
        )
        return replace(
            self,
            latitude_rad=latitude_rad,
            longitude_rad=longitude_rad,
            altitude_m=self.altitude_m + self.vertical_m_s * time_s,
            t_ns=t_ns,
        )


class Displays:
    """Displays of all units. They know what is published, never what really is."""

    def __init__(self, director: Director) -> None:
        self._director = director
        self._reports: dict[str, AdsbReport | SurfaceTrack] = {}
        """Last report of each callsign; targets are made of it when somebody looks."""
        self._runways: dict[str, RunwayBriefing] = {}
        self._areas: dict[str, Polygon] = {}
        self._elevation_m = 0.0
        self._ceilings_ft: dict[str, float] = {}
        self.vehicles: frozenset[str] = frozenset()
        """Callsigns of the vehicles of the briefing."""
        self.horizontal_minimum_m = 5.0 * NAUTICAL_MILE
        self.vertical_minimum_m = 1000.0 * FOOT

    def take(self, message: Message) -> None:
        """Take in a message of surveillance, or the briefing."""
        match message:
            case AdsbReport(callsign=str() as callsign) | SurfaceTrack(callsign=str() as callsign):
                self._reports[callsign] = message
            case Briefing():
                self._brief(message)

    def _brief(self, briefing: Briefing) -> None:
        self.horizontal_minimum_m = briefing.horizontal_separation_nm * NAUTICAL_MILE
        self.vertical_minimum_m = briefing.vertical_separation_ft * FOOT
        self.vehicles = frozenset(
            each.callsign for each in briefing.roster if each.category == "vehicle"
        )
        self._ceilings_ft = {
            each.callsign: each.ceiling_ft for each in briefing.roster if each.ceiling_ft
        }
        airport = briefing.airport
        if airport is not None:
            self._elevation_m = airport.elevation_ft * FOOT
            self._runways = {each.ident: each for each in airport.runways}
            self._areas = {each.ident: Polygon(each.protected_area) for each in airport.runways}

    def _target_of(self, callsign: str, report: AdsbReport | SurfaceTrack) -> Target:
        """Return the target of a report, at the time of the report."""
        rate_fpm = 0.0
        if isinstance(report, AdsbReport):
            rate_fpm, on_ground = report.vertical_rate_fpm, report.on_ground
        else:
            on_ground = report.on_ground is not False
        is_high = report.altitude_ft is not None and not on_ground
        speed_m_s, track_rad = report.ground_speed_kt * KNOT, (report.track_deg or 0.0) * DEGREE
        return Target(
            callsign,
            report.latitude_deg * DEGREE,
            report.longitude_deg * DEGREE,
            (report.altitude_ft or 0.0) * FOOT if is_high else self._elevation_m,
            speed_m_s * math.cos(track_rad),
            speed_m_s * math.sin(track_rad),
            rate_fpm * FOOT_PER_MINUTE if is_high else 0.0,
            not is_high,
            _time_ns(report),
        )

    def target(self, callsign: str) -> Target | None:
        """Return the target of a callsign as it is now, None if it is on no display."""
        report, now_ns = self._reports.get(callsign), self._director.now_ns
        if report is None or now_ns - _time_ns(report) > STALE_S * SECOND_NS:
            return None
        return self._target_of(callsign, report).at(now_ns)

    def targets(self) -> list[Target]:
        """Return all targets on the displays, as they are now."""
        found = (self.target(callsign) for callsign in self._reports)
        return [target for target in found if target is not None]

    def ceiling_ft(self, callsign: str) -> float:
        """Return the service ceiling of an aircraft, infinite if it is not known."""
        return self._ceilings_ft.get(callsign, math.inf)

    def height_m(self, target: Target) -> float:
        """Return the height of a target above the airport."""
        return target.altitude_m - self._elevation_m

    def runway_of(self, target: Target) -> str | None:
        """Return the runway whose area, guarded by hold-short positions, a target is in."""
        if not target.on_ground:
            return None
        here = Point(target.latitude_rad / DEGREE, target.longitude_rad / DEGREE)
        return next((ident for ident, area in self._areas.items() if area.contains(here)), None)

    def are_one_runway(self, one: str | None, other: str) -> bool:
        """Return whether two directions are those of one runway."""
        areas = self._areas.get(one or ""), self._areas.get(other)
        return one == other or (areas[0] is not None and areas[0] == areas[1])

    def final_of(self, target: Target) -> str | None:
        """Return the runway that a target in flight is on final approach to, None if to none."""
        if target.on_ground:
            return None
        found = [
            (before_m, ident)
            for ident, runway in self._runways.items()
            if (before_m := self._before_m(target, runway)) is not None
        ]
        return min(found)[1] if found else None

    def _before_m(self, target: Target, runway: RunwayBriefing) -> float | None:
        """Return the distance of an arrival before the threshold; None if it is not on final."""
        (lat, lon), (end_lat, end_lon) = runway.threshold, runway.end
        threshold = (lat * DEGREE, lon * DEGREE)
        north_m, east_m = offset_m(threshold, (end_lat * DEGREE, end_lon * DEGREE))
        course_rad = math.atan2(east_m, north_m)
        north_m, east_m = offset_m(threshold, (target.latitude_rad, target.longitude_rad))
        before_m = -(north_m * math.cos(course_rad) + east_m * math.sin(course_rad))
        aside_m = abs(east_m * math.cos(course_rad) - north_m * math.sin(course_rad))
        is_aligned = abs(wrap_angle(target.track_rad - course_rad)) <= FINAL_ANGLE_RAD
        if not 0.0 <= before_m <= FINAL_LENGTH_M or not is_aligned:
            return None
        reach_m = FINAL_SLOPE * before_m + 100.0
        return before_m if max(aside_m, self.height_m(target)) <= reach_m else None


def _time_ns(report: AdsbReport | SurfaceTrack) -> int:
    return report.t_adsb_in_ns if isinstance(report, AdsbReport) else report.t_track_ns
