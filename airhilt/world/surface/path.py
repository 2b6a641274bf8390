"""Polylines in local metres, with corners that wheels can follow."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from shapely import LineString

Local = tuple[float, float]
"""East and north in metres."""
Leg = tuple[Local, Local]
"""Both ends of a straight line."""

ARC_STEP_M = 3.0
"""Greatest distance between points on a rounded corner, in m."""
SHORTEST_LEG_M = 0.01
STRAIGHT_M = 0.05
"""Distance from the line between its neighbours below which a point is no corner, in m."""


def length(points: Sequence[Local]) -> float:
    """Return the length (m) of a polyline."""
    return sum(math.dist(a, b) for a, b in pairwise(points))


def turn(before: Local, corner: Local, after: Local) -> float:
    """Return the change of direction (rad) at a corner, positive to the right, in [-pi, pi]."""
    first, second = unit(before, corner), unit(corner, after)
    across = first[1] * second[0] - first[0] * second[1]
    along = first[0] * second[0] + first[1] * second[1]
    return math.atan2(across, along)


def rounded(points: Sequence[Local], radius_m: float, first_radius_m: float = 0.0) -> list[Local]:
    """Return a polyline whose corners are arcs, smaller where the legs beside one are too short.

    ``first_radius_m`` is the radius of the first arc, if it differs.
    """
    points = without_repeats(points)
    if len(points) > 2:
        points = [(x, y) for x, y in LineString(points).simplify(STRAIGHT_M).coords]
    path = list(points[:1])
    for index in range(1, len(points) - 1):
        before, corner, after = points[index - 1 : index + 2]
        angle = turn(before, corner, after)
        half = math.tan(abs(angle) / 2.0)
        reach = min(
            half * (first_radius_m if index == 1 and first_radius_m else radius_m),
            math.dist(before, corner) / (1.0 if index == 1 else 2.0),
            math.dist(corner, after) / (1.0 if index == len(points) - 2 else 2.0),
        )
        if reach < SHORTEST_LEG_M:
            path.append(corner)
            continue
        start = between(corner, before, reach / math.dist(corner, before))
        path.extend(_arc(start, unit(before, corner), angle, reach / half))
    path.extend(points[-1:] if len(points) > 1 else [])
    return without_repeats(path)


def dense(points: Sequence[Local], step_m: float) -> list[Local]:
    """Return a polyline with further points on its legs, none longer than ``step_m``."""
    path = list(points[:1])
    for a, b in pairwise(points):
        parts = max(1, math.ceil(math.dist(a, b) / step_m))
        path.extend(between(a, b, part / parts) for part in range(1, parts + 1))
    return path


def step(start: Local, direction: Local, distance_m: float) -> Local:
    """Return the point at a distance from another, in the direction of a unit vector."""
    return start[0] + distance_m * direction[0], start[1] + distance_m * direction[1]


def cut(points: Sequence[Local], length_m: float) -> list[Local]:
    """Return the first ``length_m`` of a polyline, or all of it if it is shorter."""
    path = list(points[:1])
    for a, b in pairwise(points):
        leg = math.dist(a, b)
        if leg >= length_m:
            path.append(between(a, b, length_m / leg) if leg else b)
            return path
        length_m -= leg
        path.append(b)
    return path


def between(a: Local, b: Local, fraction: float) -> Local:
    """Return the point that lies so far from one point to another."""
    return a[0] + fraction * (b[0] - a[0]), a[1] + fraction * (b[1] - a[1])


def without_repeats(points: Sequence[Local]) -> list[Local]:
    """Return a polyline without points that lie where the one before them does."""
    path: list[Local] = []
    for point in points:
        if not path or math.dist(path[-1], point) > SHORTEST_LEG_M:
            path.append(point)
    return path


def unit(a: Local, b: Local) -> Local:
    """Return the direction from one point to another."""
    leg = math.dist(a, b)
    return (b[0] - a[0]) / leg, (b[1] - a[1]) / leg


def _arc(start: Local, heading: Local, angle: float, radius_m: float) -> list[Local]:
    """Return points of an arc that leaves ``start`` in a direction and turns by an angle."""
    side = math.copysign(1.0, angle)
    centre = (start[0] + side * radius_m * heading[1], start[1] - side * radius_m * heading[0])
    steps = max(2, math.ceil(abs(angle) * radius_m / ARC_STEP_M))
    begin = math.atan2(start[1] - centre[1], start[0] - centre[0])
    return [
        (
            centre[0] + radius_m * math.cos(begin - angle * step / steps),
            centre[1] + radius_m * math.sin(begin - angle * step / steps),
        )
        for step in range(steps + 1)
    ]
