"""The airport as the briefing charts it: runways in local metres, and where the tower separates."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import shapely

from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place, offset_m
from airhilt.messages import AirportBriefing, RunwayBriefing
from airhilt.surveillance.squitters import NACP_95_PERCENT_M
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE, wrap_angle

ZONE_RADIUS_M = 5.0 * NAUTICAL_MILE
ZONE_HEIGHT_M = 2500.0 * FOOT
"""Height of a tower's airspace above the airport, in m.

Class D reaches up to 2,500 ft (FAA AIM, 3-2-5), by custom within some 5 NM."""
CERTAINLY_INSIDE = 1.25
"""Factor on the 95 % position error. Who is this far inside an area is certainly inside it."""
CLEAR_OF_PAVEMENT_M = 10.0
"""Distance from the pavement, in m, within which a mobile counts as on the runway."""
RAY_M = 3000.0
ALIGNED_RAD = 15.0 * DEGREE
"""Greatest angle between the courses of a runway and of who uses it, in rad."""
ACCURATE_NACP = 11
"""Accuracy category (NACp) for which the protected area is hardly made smaller."""


class Vector(NamedTuple):
    """East and north components, in m from the airport's centre, or without a unit."""

    east: float
    north: float

    def moved(self, distance_m: float, heading_rad: float) -> Vector:
        """Return the point at a distance straight on along a heading."""
        return Vector(
            self.east + distance_m * math.sin(heading_rad),
            self.north + distance_m * math.cos(heading_rad),
        )


class TrafficZone(NamedTuple):
    """Airspace in which a tower keeps aircraft apart by sight."""

    latitude_rad: float
    longitude_rad: float
    ceiling_m: float

    @classmethod
    def of(cls, airport: AirportBriefing) -> TrafficZone | None:
        """Return the zone of an airport, None if it has no runways."""
        if not airport.runways:
            return None
        latitude, longitude = _centre(airport)
        return cls(latitude, longitude, airport.elevation_ft * FOOT + ZONE_HEIGHT_M)

    def contains(self, track: Track) -> bool:
        """Return whether an aircraft is in the zone."""
        north_m, east_m = offset_m(
            (self.latitude_rad, self.longitude_rad), (track.latitude_rad, track.longitude_rad)
        )
        return math.hypot(north_m, east_m) <= ZONE_RADIUS_M and track.altitude_m <= self.ceiling_m


@dataclass(frozen=True)
class Direction:
    """One direction of a runway."""

    ident: str
    threshold: Vector
    ahead: Vector
    """Unit vector down the runway."""
    length_m: float
    """Length from the threshold to the end, in m."""
    displaced_m: float
    """Length of the pavement before the threshold, in m; a takeoff begins there."""
    half_width_m: float
    elevation_m: float

    @property
    def course_rad(self) -> float:
        """Course towards the end, in rad from north."""
        return math.atan2(self.ahead.east, self.ahead.north)

    def points_along(self, heading_rad: float) -> bool:
        """Return whether a heading is that of the runway within `ALIGNED_RAD`."""
        return abs(wrap_angle(heading_rad - self.course_rad)) <= ALIGNED_RAD

    def along_m(self, point: Vector) -> float:
        """Return how far past the threshold a point is; negative before it."""
        east, north = point.east - self.threshold.east, point.north - self.threshold.north
        return east * self.ahead.east + north * self.ahead.north

    def point(self, along_m: float) -> Vector:
        """Return the point of the centre line that is so far past the threshold."""
        east = self.threshold.east + along_m * self.ahead.east
        return Vector(east, self.threshold.north + along_m * self.ahead.north)

    def across_m(self, point: Vector) -> float:
        """Return how far to the right of the centre line a point is."""
        east, north = point.east - self.threshold.east, point.north - self.threshold.north
        return east * self.ahead.north - north * self.ahead.east


class Strip:
    """A runway, such as ``01/19``, with the area that hold-short positions keep clear."""

    def __init__(self, directions: tuple[Direction, ...], area: shapely.Polygon) -> None:
        self.name = "/".join(direction.ident for direction in directions)
        self.directions = directions
        first = directions[0]
        self.centreline = shapely.LineString(
            [first.point(-first.displaced_m), first.point(first.length_m)]
        )
        self._area = area
        self._pavement = self.centreline.buffer(first.half_width_m, cap_style="flat")
        room_m = float(self._pavement.distance(area.exterior)) - CLEAR_OF_PAVEMENT_M
        self._margins_m = [
            max(min(CERTAINLY_INSIDE * error_m, room_m), 0.0) for error_m in NACP_95_PERCENT_M
        ]
        self._cores = [area.buffer(-margin_m) for margin_m in self._margins_m]
        for core in (area, *self._cores):
            shapely.prepare(core)

    def core(self, nacp: int = ACCURATE_NACP) -> shapely.Polygon:
        """Return the part of the area in which a position is certain to be in the area.

        It is the area less a margin for the error of an accuracy category (NACp), but at least the
        pavement.
        """
        return self._cores[nacp]

    def margin_m(self, nacp: int = ACCURATE_NACP) -> float:
        """Return how far inside the edge of the area that part begins."""
        return self._margins_m[nacp]

    def contains(self, point: Vector) -> bool:
        """Return whether a point is in the protected area."""
        return bool(shapely.contains_xy(self._area, point.east, point.north))

    def share_inside(self, points: npt.NDArray[np.float64]) -> float:
        """Return the share of some points, shape (n, 2), that is in the protected area."""
        return float(shapely.contains_xy(self._area, points[:, 0], points[:, 1]).mean())

    def room_m(self, point: Vector, heading_rad: float) -> float:
        """Return the distance straight on to the pavement, in m: 0 on it, or if it is not ahead."""
        way = self.pavement_way(point, heading_rad)
        return 0.0 if way is None else way.entry_m

    def pavement_way(self, point: Vector, heading_rad: float) -> Way | None:
        """Return how a straight way leads through the pavement; None if it does not."""
        return way_through(self._pavement, point, heading_rad)


class Way(NamedTuple):
    """Distances along a heading to a runway's area, and to where it is left behind, in m."""

    entry_m: float
    """Distance to the area; 0 inside."""
    exit_m: float


def way_through(core: shapely.Polygon, point: Vector, heading_rad: float) -> Way | None:
    """Return how a straight way leads through an area; None if it does not."""
    inside = shapely.LineString([point, point.moved(RAY_M, heading_rad)]).intersection(core)
    if inside.is_empty:
        return None
    here = shapely.Point(point)
    return Way(float(here.distance(inside)), float(shapely.hausdorff_distance(here, inside)))


class Aerodrome:
    """The runways of an airport in a local frame."""

    def __init__(self, airport: AirportBriefing) -> None:
        self.ground_m = airport.elevation_ft * FOOT
        """Altitude of the ground above which cameras give heights."""
        self._frame = LocalFrame(_centre(airport))
        self.strips = self._strips(airport)
        self._by_ident = {
            direction.ident: strip for strip in self.strips for direction in strip.directions
        }
        self._crossings: dict[frozenset[str], Vector] = {}
        for first, second in itertools.combinations(self.strips, 2):
            point = first.centreline.intersection(second.centreline)
            if not point.is_empty:
                self._crossings[frozenset((first.name, second.name))] = Vector(point.x, point.y)

    def locate(self, latitude_deg: float, longitude_deg: float) -> Vector:
        """Return a position in the local frame."""
        return Vector(*self._frame.to_local((latitude_deg * DEGREE, longitude_deg * DEGREE)))

    def strip_of(self, ident: str | None) -> Strip | None:
        """Return the runway of a designator, None if there is no such."""
        return self._by_ident.get(ident) if ident else None

    def crossing(self, first: Strip, second: Strip) -> Vector | None:
        """Return where the centre lines of two runways cross, None if they do not."""
        return self._crossings.get(frozenset((first.name, second.name)))

    def _strips(self, airport: AirportBriefing) -> tuple[Strip, ...]:
        by_ident = {runway.ident: runway for runway in airport.runways}
        strips = []
        while by_ident:
            _, runway = by_ident.popitem()
            other = by_ident.pop(opposite(runway.ident), None)
            area = shapely.Polygon([self.locate(*corner) for corner in runway.protected_area])
            directions = [self._direction(runway, other)]
            if other is not None:
                directions.append(self._direction(other, runway))
            directions.sort(key=lambda direction: direction.ident)
            strips.append(Strip(tuple(directions), area))
        return tuple(sorted(strips, key=lambda strip: strip.name))

    def _direction(self, runway: RunwayBriefing, opposed: RunwayBriefing | None) -> Direction:
        threshold, end = self.locate(*runway.threshold), self.locate(*runway.end)
        length_m = math.dist(threshold, end)
        return Direction(
            ident=runway.ident,
            threshold=threshold,
            ahead=Vector(*((b - a) / length_m for a, b in zip(threshold, end, strict=True))),
            length_m=length_m,
            displaced_m=0.0 if opposed is None else math.dist(self.locate(*opposed.end), threshold),
            half_width_m=runway.width_m / 2.0,
            elevation_m=runway.elevation_ft * FOOT,
        )


def opposite(ident: str) -> str:
    """Return the designator of the other direction of a runway."""
    side = ident.lstrip("0123456789")
    number = (int(ident[: len(ident) - len(side)]) + 17) % 36 + 1
    return f"{number:02d}{ {'L': 'R', 'R': 'L'}.get(side, side) }"


def _centre(airport: AirportBriefing) -> Place:
    """Return the middle of the thresholds."""
    thresholds = [runway.threshold for runway in airport.runways]
    first_deg = thresholds[0][1]
    east_deg = [(longitude - first_deg + 180.0) % 360.0 - 180.0 for _, longitude in thresholds]
    latitude_deg = sum(latitude for latitude, _ in thresholds) / len(thresholds)
    longitude_deg = first_deg + sum(east_deg) / len(east_deg)
    return latitude_deg * DEGREE, longitude_deg * DEGREE
