"""Places the names on a diagram so that they hide neither each other nor buildings."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import chain, permutations

from shapely import LineString, Point, Polygon, box

from airhilt.units import bearing_degrees
from airhilt.world.surface import path as lines
from airhilt.world.surface.chart import svg
from airhilt.world.surface.chart.view import View
from airhilt.world.surface.ground_plan import (
    GroundPlan,
    Leg,
    RunwayEndShape,
    RunwayShape,
    TaxiwayLeg,
)
from airhilt.world.surface.path import Local

SHORT_TAXIWAY_PX = 70.0
"""A taxiway that is not longer, in px, has its letter beyond its end, so that its hold is seen."""
LABELLED_AREA_M2 = 4000.0
"""Buildings smaller than this are named only when pointed at."""
NARROW_RUNWAY_PX = 9.0
"""A runway drawn narrower than this has no room for numbers on it."""
CLEAR_OF_CROSSING_PX = 60.0
"""Least distance of a runway's size from a crossing with another, in px."""


class Labels:
    """The names on one diagram, and the room that they take."""

    def __init__(self, plan: GroundPlan, view: View) -> None:
        self._plan = plan
        self._view = view
        self._taken: list[Polygon] = []

    def buildings(self) -> Iterator[str]:
        """Yield the names of the larger buildings."""
        shapes = [
            (building.name, Polygon(self._view.all(building.outline)))
            for building in self._plan.buildings
        ]
        self._taken.extend(shape for _, shape in shapes)
        for name, shape in shapes:
            if shape.area > LABELLED_AREA_M2 * self._view.scale**2:
                yield self._beside(name, shape)

    def runways(self) -> Iterator[str]:
        """Yield the numbers, courses and sizes of the runways."""
        for runway in self._plan.runways:
            for end in runway.ends:
                yield from self._runway_end(end)
            yield from self._size(runway)

    def taxiways(self) -> Iterator[str]:
        """Yield the letters of the taxiways."""
        for name, legs in self._plan.taxiways.items():
            if name != "ramp":
                yield from self._letter(name, legs)

    def _runway_end(self, end: RunwayEndShape) -> Iterator[str]:
        start, far_end = self._view(end.start), self._view(end.far_end)
        ahead = lines.unit(start, far_end)
        turn = math.degrees(math.atan2(ahead[0], -ahead[1]))
        at = lines.step(start, ahead, -14.0)
        self._taken.append(_box(at, 26.0, 20.0))
        yield svg.text("ident", at, end.ident, turn)
        if end.width_m * self._view.scale >= NARROW_RUNWAY_PX:
            course = f"{bearing_degrees(end.course_rad):05.1f}°"
            place = lines.step(start, ahead, 62.0)
            turn = (turn + 90.0) % 180.0 - 90.0
            yield svg.text("onrunway", place, course, turn - 90.0 if turn > 0 else turn + 90.0)

    def _size(self, runway: RunwayShape) -> Iterator[str]:
        if runway.width_m * self._view.scale < NARROW_RUNWAY_PX:
            return
        start, far_end = self._view.leg(runway.centreline)
        ahead = lines.unit(start, far_end)
        turn = math.degrees(math.atan2(ahead[1], ahead[0]))
        turn = (turn + 90.0) % 180.0 - 90.0
        crossings = [
            self._view(crossing.place)
            for crossing in self._plan.intersections
            if runway.name in crossing.name.split(" crosses ")
        ]
        spots = [lines.between(start, far_end, part) for part in (0.3, 0.5, 0.7, 0.4, 0.6)]
        free = (
            at
            for at in spots
            if all(math.dist(at, other) > CLEAR_OF_CROSSING_PX for other in crossings)
        )
        size = f"{runway.ends[0].length_m:.0f} × {runway.width_m:.0f} m"
        yield svg.text("onrunway", next(free, spots[0]), size, turn)

    def _letter(self, name: str, taxiway: Sequence[TaxiwayLeg]) -> Iterator[str]:
        legs = [self._view.leg(leg.ends) for leg in taxiway]
        legs.sort(key=lambda leg: -math.dist(*leg))
        width = 7.5 * len(name) + 6.0
        spots = [lines.between(a, b, part) for a, b in legs for part in (0.5, 0.3, 0.7, 0.1, 0.9)]
        if sum(math.dist(*leg) for leg in legs) < SHORT_TAXIWAY_PX:
            spots = [*self._beyond(legs, width / 2.0 + 6.0), *spots]
        x, y = self._free(spots, width, 14.0)
        yield (
            f'<rect class="plate" x="{x - width / 2:.1f}" y="{y - 7:.1f}" '
            f'width="{width:.1f}" height="14" rx="2"/>'
        )
        yield svg.text("letter", (x, y), name)

    def _beyond(self, legs: Sequence[Leg], away_px: float) -> list[Local]:
        """Return points beyond both ends of a short taxiway, the one farther from runways first."""
        ends = max(
            ((a, b) for a, b in permutations(chain(*legs), 2)), key=lambda pair: math.dist(*pair)
        )
        spots = [lines.step(at, lines.unit(other, at), away_px) for at, other in permutations(ends)]
        runways = [LineString(self._view.all(runway.centreline)) for runway in self._plan.runways]
        return sorted(spots, key=lambda at: -min(line.distance(Point(at)) for line in runways))

    def _beside(self, name: str, shape: Polygon) -> str:
        """Return the name of a building next to it, where there is room."""
        west, north, east, south = shape.bounds
        middle_x, middle_y = (west + east) / 2.0, (north + south) / 2.0
        half = 3.2 * len(name)
        spots = (
            (west - half - 6.0, middle_y),
            (middle_x, south + 9.0),
            (middle_x, north - 8.0),
            (east + half + 6.0, middle_y),
        )
        return svg.text("small", self._free(spots, 2.0 * half, 11.0), name)

    def _free(self, spots: Sequence[Local], width: float, height: float) -> Local:
        """Take the first spot at which a label hides nothing, or the first of all."""
        free = (at for at in spots if not self._is_taken(_box(at, width, height)))
        at = next(free, spots[0])
        self._taken.append(_box(at, width, height))
        return at

    def _is_taken(self, label: Polygon) -> bool:
        return any(label.intersects(other) for other in self._taken)


def _box(at: Local, width: float, height: float) -> Polygon:
    x, y = at
    return box(x - width / 2.0, y - height / 2.0, x + width / 2.0, y + height / 2.0)
