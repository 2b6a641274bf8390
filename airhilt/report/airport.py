"""The airport of a run as its report draws it.

Importing this module brings in Shapely and NetworkX: do so where an airport is needed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np

from airhilt.geodesy.wgs84 import Place
from airhilt.units import NAUTICAL_MILE
from airhilt.world.surface import path as lines
from airhilt.world.surface.airport import load_airport
from airhilt.world.surface.ground_plan import Area, RunwayShape, ground_plan
from airhilt.world.surface.layout import Layout
from airhilt.world.surface.path import Local

Json = dict[str, Any]


class ReportAirport:
    """The shapes of an airport, and where places lie among them.

    `files` are the airports that the scenario of the run brought along. It raises `ScenarioError`
    if there is none of that name, or its file is wrong.
    """

    def __init__(self, name: str, files: Mapping[str, Any] = MappingProxyType({})) -> None:
        layout = Layout(load_airport(name, files))
        self._frame = layout.local_frame
        self._plan = ground_plan(layout)
        self._variation_deg = layout.airport.magnetic_variation.east_deg

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
        end = self._plan.runway_end(ident)
        if end is None:
            return None
        ahead = lines.unit(end.threshold, end.far_end)
        along = (np.asarray(east_m) - end.threshold[0]) * ahead[0]
        along += (np.asarray(north_m) - end.threshold[1]) * ahead[1]
        crossings = np.flatnonzero((along[:-1] < 0.0) & (along[1:] >= 0.0))
        if not len(crossings):
            return None
        two = slice(crossings[0], crossings[0] + 2)
        return float(np.interp(0.0, along[two], t_s[two]))

    def as_json(self) -> Json:
        """Return what is drawn, in m east and north of the reference point."""
        plan = self._plan
        return {
            "icao": plan.icao,
            "name": plan.name,
            "elevation_m": round(plan.elevation_m, 1),
            "variation_deg": self._variation_deg,
            "runways": [_runway(runway) for runway in plan.runways],
            "taxiways": [
                {
                    "name": name,
                    "width_m": max(leg.width_m for leg in legs),
                    "legs": [_leg(leg.ends) for leg in legs],
                }
                for name, legs in plan.taxiways.items()
            ],
            "holds": [
                {
                    "name": f"{hold.position}, short of {hold.runway}",
                    "line": _leg(hold.ends()),
                }
                for hold in plan.holds
            ],
            "buildings": _areas(plan.buildings),
            "water": _areas(plan.water),
            "tower": None if plan.tower is None else _point(plan.tower),
        }


def _runway(runway: RunwayShape) -> Json:
    return {
        "name": runway.name,
        "width_m": round(runway.width_m, 1),
        "pavement": _points(runway.pavement),
        "protected": _points(runway.protected),
        "ends": [
            {"ident": end.ident, "start": _point(end.start), "threshold": _point(end.threshold)}
            for end in runway.ends
        ],
    }


def _areas(areas: Iterable[Area]) -> list[Json]:
    return [{"name": area.name, "outline": _points(area.outline)} for area in areas]


def _leg(ends: tuple[Local, Local]) -> list[float]:
    return [part for end in ends for part in _point(end)]


def _points(points: Iterable[Local]) -> list[list[float]]:
    return [_point(point) for point in points]


def _point(point: Local) -> list[float]:
    return [round(point[0], 1), round(point[1], 1)]
