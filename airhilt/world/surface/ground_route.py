"""A way over an airport, with the runways and taxiways that it meets."""

from __future__ import annotations

import bisect
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

import shapely
from shapely import LineString, Point
from shapely.geometry.base import BaseGeometry
from shapely.ops import substring

from airhilt.geodesy.wgs84 import Place
from airhilt.world.surface.layout import Layout

LEAST_CROSSING_M = 1.0
"""Length in a protected area below which a way only touches its edge, in m."""
ON_TAXIWAY_M = 5.0
"""Distance from the centre line of a taxiway within which a way is on it, in m."""
LOOK_BACK_M = 5.0
LOOK_AHEAD_M = 60.0
"""Part of a way around the last known place in which the next one is looked for, in m."""


@dataclass(frozen=True, slots=True)
class Crossing:
    """A part of a way that lies in the protected area of a runway, in metres along the way."""

    runway: str
    """Name of the whole runway, such as ``01/19``."""
    enter_m: float
    leave_m: float


class GroundRoute:
    """A polyline over an airport, whose points are known by their distance along it.

    Attributes
    ----------
    crossings
        Parts of it within the protected areas of runways, in their order.
    """

    def __init__(self, airport: Layout, places: Sequence[Place]) -> None:
        self._airport = airport
        self._places = list(places)
        points = [airport.local_frame.to_local(place) for place in self._places]
        self._along = [0.0, *accumulate(math.dist(a, b) for a, b in pairwise(points))]
        self._line = LineString(points if len(points) > 1 else points * 2)
        self._legs = shapely.linestrings(list(pairwise(self._line.coords)))
        self.crossings = sorted(
            (
                Crossing(strip.name, *within)
                for strip in airport.strips.values()
                for within in self._within(strip.protected_area)
                if within[1] - within[0] >= LEAST_CROSSING_M
            ),
            key=lambda each: (each.enter_m, each.runway),
        )

    @property
    def length_m(self) -> float:
        """Length of the whole way."""
        return self._along[-1]

    def along_m(self, here: Place, last_m: float) -> float:
        """Return how far along it a place is, near a distance where it was before."""
        at = Point(self._airport.local_frame.to_local(here))
        first_m = max(last_m - LOOK_BACK_M, 0.0)
        near = substring(self._line, first_m, min(last_m + LOOK_AHEAD_M, self.length_m))
        return first_m + float(near.project(at))

    def meets_m(self, taxiway: str, after_m: float) -> float | None:
        """Return where it next comes on to a taxiway; None if it does not."""
        lines = [
            LineString(self._airport.leg(edge))
            for edge in self._airport.airport.taxiways.edges
            if edge.taxiway == taxiway
        ]
        on_it = shapely.union_all(lines).buffer(ON_TAXIWAY_M)
        return next((begin for begin, _ in self._within(on_it) if begin > after_m), None)

    def part(self, first_m: float, last_m: float) -> list[Place]:
        """Return its corners from one distance to another, and the place at the second."""
        first = bisect.bisect_right(self._along, first_m)
        last = bisect.bisect_left(self._along, last_m)
        if last >= len(self._places):
            return self._places[min(first, len(self._places) - 1) :]
        end = self._line.interpolate(last_m)
        return [*self._places[first:last], self._airport.local_frame.to_place(end.x, end.y)]

    def _within(self, area: BaseGeometry) -> Iterator[tuple[float, float]]:
        """Yield where it enters and leaves an area, in metres along it."""
        inside: tuple[float, float] | None = None
        for begin_m, piece, leg in zip(
            self._along, shapely.intersection(self._legs, area), self._legs, strict=False
        ):
            for part in getattr(piece, "geoms", [piece]):
                if part.is_empty or part.length == 0.0:
                    continue
                start = Point(leg.coords[0])
                ends = sorted(begin_m + start.distance(Point(end)) for end in part.coords)
                if inside is not None and ends[0] - inside[1] <= LEAST_CROSSING_M:
                    inside = inside[0], ends[-1]
                    continue
                if inside is not None:
                    yield inside
                inside = ends[0], ends[-1]
        if inside is not None:
            yield inside
