"""An airport as the report of a run draws it: corners in metres, and what things are called.

Importing this module brings in Shapely and NetworkX: do so where an airport is needed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from shapely import Polygon

from airhilt.units import DEGREE
from airhilt.world.surface import path as lines
from airhilt.world.surface.airport import load_airport
from airhilt.world.surface.layout import Hold, Layout, RunwayStrip
from airhilt.world.surface.path import Local

Json = dict[str, Any]

HALF_HOLD_LINE_M = 16.0
"""A hold line is drawn somewhat wider than its taxiway."""


class GroundPlan:
    """The ground plan of an airport, in metres east and north of its reference point.

    Parameters
    ----------
    name
        Of the airport.

    Raises
    ------
    ScenarioError
        There is none of that name, or its file is wrong.
    """

    def __init__(self, name: str) -> None:
        self._layout = Layout(load_airport(name))

    def locate(self, latitude_rad: float, longitude_rad: float) -> Local:
        """Return how far east and north of the reference point a place is (m)."""
        return self._layout.frame.to_local((latitude_rad, longitude_rad))

    def threshold_crossed_s(
        self,
        ident: str,
        t_s: Sequence[float],
        east_m: Sequence[float],
        north_m: Sequence[float],
    ) -> float | None:
        """Return when a track first comes over the threshold of a runway, or None.

        Raises
        ------
        ScenarioError
            There is no such runway.
        """
        end = self._layout.runway(ident)
        threshold = self._layout.frame.to_local(end.threshold)
        ahead = lines.unit(threshold, self._layout.frame.to_local(end.end))
        along = (np.asarray(east_m) - threshold[0]) * ahead[0]
        along += (np.asarray(north_m) - threshold[1]) * ahead[1]
        crossings = np.flatnonzero((along[:-1] < 0.0) & (along[1:] >= 0.0))
        if not len(crossings):
            return None
        two = slice(crossings[0], crossings[0] + 2)
        return float(np.interp(0.0, along[two], t_s[two]))

    def as_json(self) -> Json:
        """Return what is drawn."""
        layout, airport = self._layout, self._layout.airport
        return {
            "icao": airport.icao,
            "name": airport.name,
            "elevation_m": round(layout.elevation_m, 1),
            "runways": [_runway(layout, strip) for strip in layout.strips.values()],
            "taxiways": _taxiways(layout),
            "holds": [_hold_line(layout, hold) for hold in layout.holds.values()],
            "buildings": [
                {"name": building.name, "outline": _outline(layout, building.footprint)}
                for building in airport.buildings
            ],
            "water": [
                {"name": water.name, "outline": _outline(layout, water.outline)}
                for water in airport.water
            ],
            "tower": _metres(layout.frame.to_local(airport.tower.place)) if airport.tower else None,
        }


def _runway(layout: Layout, strip: RunwayStrip) -> Json:
    return {
        "name": strip.name,
        "width_m": round(strip.ends[0].width_m, 1),
        "pavement": _corners(strip.pavement),
        "protected": _corners(strip.protected_area),
        "ends": [
            {
                "ident": end.ident,
                "start": _metres(layout.frame.to_local(end.start)),
                "threshold": _metres(layout.frame.to_local(end.threshold)),
            }
            for end in strip.ends
        ],
    }


def _taxiways(layout: Layout) -> list[Json]:
    """Return the legs of each taxiway with the widest it is anywhere."""
    legs: dict[str, list[list[float]]] = defaultdict(list)
    widths: dict[str, float] = defaultdict(float)
    for edge in layout.airport.taxiways.edges:
        ends = (layout.frame.to_local(layout.node(name)) for name in edge.nodes)
        legs[edge.taxiway].append([part for end in ends for part in _metres(end)])
        widths[edge.taxiway] = max(widths[edge.taxiway], edge.width_m)
    return [{"name": name, "width_m": widths[name], "legs": own} for name, own in legs.items()]


def _hold_line(layout: Layout, hold: Hold) -> Json:
    """Return a line along the edge of the protected area, across the taxiway."""
    at = layout.frame.to_local(hold.place)
    ahead = lines.unit(*layout.strips[hold.runway].centreline.coords)
    ends = (lines.step(at, ahead, side * HALF_HOLD_LINE_M) for side in (-1.0, 1.0))
    return {
        "name": f"{hold.position}, short of {hold.runway}",
        "line": [part for end in ends for part in _metres(end)],
    }


def _outline(layout: Layout, corners: Iterable[tuple[float, float]]) -> list[list[float]]:
    return [
        _metres(layout.frame.to_local((latitude * DEGREE, longitude * DEGREE)))
        for latitude, longitude in corners
    ]


def _corners(area: Polygon) -> list[list[float]]:
    return [_metres(corner) for corner in area.exterior.coords[:-1]]


def _metres(point: Local) -> list[float]:
    return [round(point[0], 1), round(point[1], 1)]
