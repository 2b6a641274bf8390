"""Paths that wheels can follow: straights and circular arcs, none tighter than a radius.

Road engineers call it a horizontal alignment (AASHTO, A Policy on Geometric Design of Highways
and Streets, chapter 3). Coordinates are east and north in metres, headings are true, curvature is
positive to the right.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from airhilt.units import wrap_angle
from airhilt.world.surface.path import Local, without_repeats

CORNER_CUT_M = 3.0
"""Greatest distance by which a corner is cut, in m, unless the least radius asks for more."""
SHORTEST_M = 1e-6
STRAIGHT_RAD = 1e-9
"""Change of heading below which a path is straight, in rad."""


class Element(NamedTuple):
    """A straight or an arc."""

    east_m: float
    """East of its beginning, in m; north and heading are those of the beginning too."""
    north_m: float
    heading_rad: float
    curvature_per_m: float
    length_m: float

    def at(self, along_m: float) -> tuple[float, float, float]:
        """Return east, north and heading at a distance from the beginning.

        The chord of an arc has its mean direction, and is shorter than it by sin(x) / x, x being
        half the angle.
        """
        half = 0.5 * self.curvature_per_m * along_m
        middle = self.heading_rad + half
        chord = along_m * math.sin(half) / half if half else along_m
        return (
            self.east_m + chord * math.sin(middle),
            self.north_m + chord * math.cos(middle),
            middle + half,
        )

    @property
    def end(self) -> tuple[float, float, float]:
        """East, north and heading at the end."""
        return self.at(self.length_m)


def aligned(
    start: Local, heading_rad: float, points: Sequence[Local], radius_m: float
) -> list[Element]:
    """Return a smooth path from a pose along a polyline, ending exactly at its last point.

    Corners become arcs, as wide as `CORNER_CUT_M` and half of the legs beside them allow. Where
    not even the least radius fits, the path runs to the corner and turns behind it; a point that
    it could only reach by a loop is left out, unless it is the last. ``radius_m`` is the least that
    any arc has.
    """
    path = _Path(start, heading_rad, radius_m)
    points = without_repeats([start, *points])[1:]
    for index, point in enumerate(points):
        if index == len(points) - 1:
            path.turn_towards(point)
            path.go_to(point)
        elif path.can_head_for(point):
            path.turn_towards(point)
            following = points[index + 1]
            room = math.dist(point, following) * (1.0 if index == len(points) - 2 else 0.5)
            path.round_corner(point, following, room)
    return path.elements


class _Path:
    """A path in the making, with the pose at its end so far."""

    def __init__(self, start: Local, heading_rad: float, radius_m: float) -> None:
        self.elements: list[Element] = []
        self._east, self._north = start
        self._heading = heading_rad
        self._radius = radius_m

    def can_head_for(self, point: Local) -> bool:
        """Return whether a turn and a straight lead to a point, without a loop."""
        distance, bearing = self._to(point)
        off = abs(wrap_angle(bearing - self._heading))
        if off > math.pi / 2.0:
            return distance >= 2.0 * self._radius
        return distance >= 2.0 * self._radius * math.sin(off)

    def turn_towards(self, point: Local) -> None:
        """Turn until a point lies straight ahead; the shorter way round, if it leads there."""
        distance, bearing = self._to(point)
        off = wrap_angle(bearing - self._heading)
        if distance < SHORTEST_M or abs(off) < STRAIGHT_RAD:
            return
        widest = min(distance / (4.0 * math.sin(abs(off))), CORNER_CUT_M / _one_less_cosine(off))
        if not self._turn(point, math.copysign(1.0, off), max(self._radius, widest)):
            self._turn(point, -math.copysign(1.0, off), self._radius)

    def _turn(self, point: Local, side: float, radius: float) -> bool:
        """Follow a circle to where its tangent leads to a point; False if the point is inside."""
        distance, bearing = self._to(point)
        off = wrap_angle(side * (bearing - self._heading))
        ahead, aside = distance * math.cos(off), distance * math.sin(off)
        tangent_squared = distance * distance - 2.0 * radius * aside
        if tangent_squared < 0.0:
            return False
        tangent = math.sqrt(tangent_squared)
        angle = (math.atan2(aside - radius, ahead) + math.atan2(radius, tangent)) % math.tau
        if angle < math.tau - STRAIGHT_RAD:
            self._append(side / radius, radius * angle)
        return True

    def round_corner(self, corner: Local, following: Local, room_m: float) -> None:
        """Go to a corner that lies ahead and around it, or to it if there is no room for that.

        ``room_m`` is what the arc may take of the leg that follows.
        """
        ahead, _ = self._to(corner)
        onward = _polar(corner, following)[1]
        turn = wrap_angle(onward - self._heading)
        half = 0.5 * abs(turn)
        if half < STRAIGHT_RAD:
            self.go_to(corner)
            return
        widest = max(self._radius, CORNER_CUT_M * math.cos(half) / _one_less_cosine(half))
        room = min(ahead, room_m)
        if room < self._radius * math.tan(half):
            self.go_to(corner)
            return
        radius = min(widest, room / math.tan(half))
        reach = min(room, radius * math.tan(half))
        self._append(0.0, ahead - reach)
        self._append(math.copysign(1.0 / radius, turn), 2.0 * half * radius)
        self._east = corner[0] + reach * math.sin(onward)
        self._north = corner[1] + reach * math.cos(onward)
        self._heading = onward

    def go_to(self, point: Local) -> None:
        """Go straight to a point that lies ahead."""
        distance, bearing = self._to(point)
        if distance >= SHORTEST_M:
            self._heading = bearing
        self._append(0.0, distance)
        self._east, self._north = point

    def _append(self, curvature: float, length: float) -> None:
        if length < SHORTEST_M:
            return
        element = Element(self._east, self._north, self._heading, curvature, length)
        self.elements.append(element)
        self._east, self._north, self._heading = element.end

    def _to(self, point: Local) -> tuple[float, float]:
        return _polar((self._east, self._north), point)


def _polar(a: Local, b: Local) -> tuple[float, float]:
    """Return the distance and the bearing from one point to another."""
    east, north = b[0] - a[0], b[1] - a[1]
    return math.hypot(east, north), math.atan2(east, north)


def _one_less_cosine(angle: float) -> float:
    """Return 1 - cos(angle), above 0 for the least of angles too."""
    return 2.0 * math.sin(0.5 * angle) ** 2
