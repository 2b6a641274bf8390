"""The airport of a run as its report draws it.

Importing this module brings in Shapely and NetworkX: do so where an airport is needed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np

from airhilt.geodesy.wgs84 import Place
from airhilt.units import NAUTICAL_MILE
from airhilt.world.surface import path as lines
from airhilt.world.surface.airport import Edge
from airhilt.world.surface.layout import load_layout
from airhilt.world.surface.path import Local
from airhilt.world.surface.strips import RunwayStrip

Json = dict[str, Any]


class ReportAirport:
    """The shapes of an airport, and where places lie among them.

    `files` are the airports that the scenario of the run brought along. It raises `ScenarioError`
    if there is none of that name, or its file is wrong.
    """

    def __init__(self, name: str, files: Mapping[str, Any] = MappingProxyType({})) -> None:
        self._layout = load_layout(name, files)
        self._frame = self._layout.local_frame

    def locate(self, place: Place, height_m: float) -> Local:  # noqa: ARG002
        """Return the distance of a place east and north of the reference point, in NM."""
        east_m, north_m = self._frame.to_local(place)
        return east_m / NAUTICAL_MILE, north_m / NAUTICAL_MILE

    def threshold_crossed_s(
        self, ident: str, t_s: Sequence[float], east_m: Sequence[float], north_m: Sequence[float]
    ) -> float | None:
        """Return when a track first crosses the threshold of a runway in the landing direction.

        The time is in s, None if the track never crosses it or there is no such runway.
        """
        ends = (end for strip in self._layout.strips.values() for end in strip.ends)
        end = next((end for end in ends if end.ident == ident), None)
        if end is None:
            return None
        threshold = self._frame.to_local(end.threshold)
        ahead = lines.unit(threshold, self._frame.to_local(end.end))
        along = (np.asarray(east_m) - threshold[0]) * ahead[0]
        along += (np.asarray(north_m) - threshold[1]) * ahead[1]
        crossings = np.flatnonzero((along[:-1] < 0.0) & (along[1:] >= 0.0))
        if not len(crossings):
            return None
        two = slice(crossings[0], crossings[0] + 2)
        return float(np.interp(0.0, along[two], t_s[two]))

    def as_json(self) -> Json:
        """Return what is drawn, in m east and north of the reference point."""
        layout, airport = self._layout, self._layout.airport
        taxiways: dict[str, list[Edge]] = defaultdict(list)
        for edge in airport.taxiways.edges:
            taxiways[edge.taxiway].append(edge)
        tower = airport.tower and _point(self._frame.to_local(airport.tower.place))
        return {
            "icao": airport.icao,
            "name": airport.name,
            "elevation_m": round(layout.elevation_m, 1),
            "variation_deg": airport.magnetic_variation.east_deg,
            "runways": [self._runway(strip) for strip in layout.strips.values()],
            "taxiways": [
                {
                    "name": name,
                    "width_m": max(edge.width_m for edge in edges),
                    "legs": [_leg(layout.leg(edge)) for edge in edges],
                }
                for name, edges in taxiways.items()
            ],
            "holds": [
                {
                    "name": f"{hold.position}, short of {hold.runway}",
                    "line": _leg(layout.hold_line(hold)),
                }
                for hold in layout.holds.values()
            ],
            "buildings": [
                {"name": one.name, "outline": _points(layout.outline(one.footprint))}
                for one in airport.buildings
            ],
            "water": [
                {"name": one.name, "outline": _points(layout.outline(one.outline))}
                for one in airport.water
            ],
            "tower": tower,
        }

    def _runway(self, strip: RunwayStrip) -> Json:
        return {
            "name": strip.name,
            "width_m": round(strip.ends[0].width_m, 1),
            "pavement": _points(strip.pavement.exterior.coords[:-1]),
            "protected": _points(strip.protected_area.exterior.coords[:-1]),
            "ends": [
                {
                    "ident": end.ident,
                    "start": _point(self._frame.to_local(end.start)),
                    "threshold": _point(self._frame.to_local(end.threshold)),
                }
                for end in strip.ends
            ],
        }


def _leg(ends: tuple[Local, Local]) -> list[float]:
    return [part for end in ends for part in _point(end)]


def _points(points: Iterable[Local]) -> list[list[float]]:
    return [_point(point) for point in points]


def _point(point: Local) -> list[float]:
    return [round(point[0], 1), round(point[1], 1)]
