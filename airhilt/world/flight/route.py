"""A route over the ellipsoid: straight legs through waypoints, joined by arcs.

A leg is the plane through its two ends and the vertical at its middle. The distance of a position
from that plane is three multiplications on Earth-centred coordinates, and is the distance from the
geodesic to within a metre for legs up to `LONGEST_LEG_M`; longer ones are divided, on the geodesic,
when the route is made.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import NamedTuple

from geographiclib.geodesic import Geodesic

from airhilt.geodesy.wgs84 import Place, Vector, dot, earth_centred, vertical
from airhilt.world.flight.state import AircraftState

LONGEST_LEG_M = 100_000.0
"""Length in m from which a leg is divided."""
SHORTEST_LEG_M = 50.0
"""Distance in m below which two waypoints are one."""
SHARPEST_TURN_RAD = math.radians(150.0)
"""Turn in rad from which no arc cuts the corner: the turn begins at the waypoint."""


class Guide(NamedTuple):
    """Position of an aircraft relative to its path."""

    cross_track_m: float
    """Distance of the aircraft from the path, positive to the right."""
    course_rad: float
    """True course of the path beside the aircraft."""
    turn_rate: float
    """Turn rate of the path there at the present ground speed, in rad/s, positive to the right."""


class Leg:
    """A straight leg between two places at sea level, each (latitude, longitude) in radians."""

    def __init__(self, start: Place, end: Place) -> None:
        a, b = earth_centred(start), earth_centred(end)
        chord = _minus(b, a)
        middle = _minus(vertical(start), _scaled(vertical(end), -1.0))
        self.start = start
        self.end = end
        self.right = _unit(_cross(chord, middle))
        self.length_m = math.sqrt(dot(chord, chord))
        self._origin = a
        self._end = b
        self._forward = _unit(chord)
        self._forward_at_end = _cross(vertical(end), self.right)

    def cross_track_m(self, state: AircraftState) -> float:
        """Return the distance to the right of the leg."""
        x, y, z = self._origin
        right_x, right_y, right_z = self.right
        return (
            right_x * (state.ecef_x_m - x)
            + right_y * (state.ecef_y_m - y)
            + right_z * (state.ecef_z_m - z)
        )

    def to_go_m(self, state: AircraftState) -> float:
        """Return the distance to the end along the leg, negative beyond it."""
        x, y, z = self._end
        forward_x, forward_y, forward_z = self._forward_at_end
        return (
            forward_x * (x - state.ecef_x_m)
            + forward_y * (y - state.ecef_y_m)
            + forward_z * (z - state.ecef_z_m)
        )

    def course_rad(self, latitude_rad: float, longitude_rad: float) -> float:
        """Return the true course of the leg, or of a parallel to it, at a place."""
        right_x, right_y, right_z = self.right
        sin_longitude, cos_longitude = math.sin(longitude_rad), math.cos(longitude_rad)
        right_east = right_y * cos_longitude - right_x * sin_longitude
        right_north = right_z * math.cos(latitude_rad) - math.sin(latitude_rad) * (
            right_x * cos_longitude + right_y * sin_longitude
        )
        return math.atan2(-right_north, right_east)

    def distance_m(self, place: Vector, *, is_last: bool) -> float:
        """Return how far a place at sea level is from the leg; the last one goes on for ever."""
        from_start = _minus(place, self._origin)
        along_m = dot(from_start, self._forward)
        beyond_m = min(along_m, 0.0)
        if not is_last:
            beyond_m += max(along_m - self.length_m, 0.0)
        return math.hypot(dot(from_start, self.right), beyond_m)

    def guide(self, state: AircraftState) -> Guide:
        """Return the position of the aircraft relative to the leg."""
        return Guide(
            self.cross_track_m(state),
            self.course_rad(state.latitude_rad, state.longitude_rad),
            0.0,
        )


class Arc:
    """The arc that leads from one leg into the next without passing their common end.

    It begins at a lead in m before that end, and ends as far behind it.
    """

    def __init__(self, before: Leg, after: Leg, lead_m: float) -> None:
        place = before.end
        self.turn = turn_between(before, after)
        self.side = math.copysign(1.0, self.turn)
        self.radius_m = lead_m / math.tan(abs(self.turn) / 2.0)
        self._after = after
        self._lead = lead_m
        self._place = earth_centred(place)
        self._east, self._north = _east_north(place)
        course = before.course_rad(*place)
        # The centre lies abeam of the arc's beginning, on the inner side.
        abeam = course + self.side * math.pi / 2.0
        self._centre_east = -lead_m * math.sin(course) + self.radius_m * math.sin(abeam)
        self._centre_north = -lead_m * math.cos(course) + self.radius_m * math.cos(abeam)

    def to_go_m(self, state: AircraftState) -> float:
        """Return the distance to the arc's end along the next leg, negative beyond it."""
        return self._after.to_go_m(state) - self._after.length_m + self._lead

    def guide(self, state: AircraftState) -> Guide:
        """Return the position of the aircraft relative to the arc."""
        offset = (
            state.ecef_x_m - self._place[0],
            state.ecef_y_m - self._place[1],
            state.ecef_z_m - self._place[2],
        )
        east = dot(offset, self._east) - self._centre_east
        north = dot(offset, self._north) - self._centre_north
        outside = math.hypot(east, north) - self.radius_m
        return Guide(
            -self.side * outside,
            math.atan2(east, north) + self.side * math.pi / 2.0,
            self.side * state.ground_speed_m_s / self.radius_m,
        )


def legs_through(start: Place, waypoints: Sequence[Place]) -> tuple[Leg, ...]:
    """Return the legs from a place through waypoints, one of which at least is away from it."""
    ends: list[Place] = [start]
    for waypoint in waypoints:
        ends.extend(_divided(ends[-1], waypoint))
    if len(ends) == 1:
        raise ValueError(
            f"the route leads nowhere; expected a waypoint at least {SHORTEST_LEG_M:.0f} m away"
        )
    return tuple(Leg(a, b) for a, b in itertools.pairwise(ends))


def turn_between(before: Leg, after: Leg) -> float:
    """Return the change of course (rad, positive to the right) from a leg to the next."""
    place = before.end
    change = after.course_rad(*place) - before.course_rad(*place)
    return (change + math.pi) % (2.0 * math.pi) - math.pi


def _divided(start: Place, end: Place) -> list[Place]:
    """Return the ends of the pieces of the geodesic from ``start`` to ``end``."""
    line = Geodesic.WGS84.InverseLine(*(math.degrees(angle) for angle in (*start, *end)))
    if line.s13 < SHORTEST_LEG_M:
        return []
    pieces = math.ceil(line.s13 / LONGEST_LEG_M)
    places = (line.Position(line.s13 * piece / pieces) for piece in range(1, pieces))
    return [*((math.radians(at["lat2"]), math.radians(at["lon2"])) for at in places), end]


def _east_north(place: Place) -> tuple[Vector, Vector]:
    east = (-math.sin(place[1]), math.cos(place[1]), 0.0)
    return east, _cross(vertical(place), east)


def _minus(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _scaled(a: Vector, factor: float) -> Vector:
    return a[0] * factor, a[1] * factor, a[2] * factor


def _cross(a: Vector, b: Vector) -> Vector:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def _unit(a: Vector) -> Vector:
    return _scaled(a, 1.0 / math.sqrt(dot(a, a)))
