"""The scale of a diagram, and where its map lies on the sheet."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from airhilt.world.surface.ground_plan import GroundPlan, Leg
from airhilt.world.surface.path import Local

MAP_PX = 1000.0
"""Length of the longer side of the map, in px."""
NARROWEST_PX = 860.0
"""Least width of the sheet, in px: the header and the legend need it."""
MARGIN_M = 220.0
"""Ground shown around everything that is drawn, in m."""
HEADER_PX, FOOTER_PX = 84.0, 64.0
"""Height of what stands above the map and below it, in px."""


@dataclass(frozen=True)
class View:
    """Turns local metres into pixels of the sheet.

    Attributes
    ----------
    west, north
        Local metres of the upper left corner of the map.
    scale
        Pixels in a metre.
    width, map_height
        Size of the map, in px.
    """

    west: float
    north: float
    scale: float
    width: float
    map_height: float

    def __call__(self, point: Local) -> Local:
        """Return where a point lies on the sheet, in px."""
        return (
            round((point[0] - self.west) * self.scale, 1),
            round((self.north - point[1]) * self.scale + HEADER_PX, 1),
        )

    def all(self, points: Iterable[Local]) -> list[Local]:
        """Return where points lie on the sheet, in px."""
        return [self(point) for point in points]

    def leg(self, ends: Leg) -> Leg:
        """Return where the ends of a line lie on the sheet, in px."""
        return self(ends[0]), self(ends[1])

    @property
    def height(self) -> float:
        """Height of the whole sheet, in px."""
        return HEADER_PX + self.map_height + FOOTER_PX


def view_of(plan: GroundPlan) -> View:
    """Return the view that shows runways, taxiways and buildings with a margin."""
    points = [end for runway in plan.runways for end in runway.centreline]
    points += [end for leg in plan.taxiway_legs for end in leg.ends]
    points += [corner for building in plan.buildings for corner in building.outline]
    east, north = zip(*points, strict=True)
    wide_m = max(east) - min(east) + 2.0 * MARGIN_M
    high_m = max(north) - min(north) + 2.0 * MARGIN_M
    scale = MAP_PX / max(wide_m, high_m)
    width = max(wide_m * scale, NARROWEST_PX)
    centre = (max(east) + min(east)) / 2.0
    return View(centre - width / scale / 2.0, max(north) + MARGIN_M, scale, width, high_m * scale)
