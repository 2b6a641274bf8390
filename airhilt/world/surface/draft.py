"""Draws an airport in local metres, and writes its file."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal

from shapely import LineString, Point

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.units import DEGREE
from airhilt.world.surface import path as lines
from airhilt.world.surface.airport import (
    Airport,
    Camera,
    Edge,
    HoldShort,
    Node,
    ReferencePoint,
    Runway,
    Taxiways,
)
from airhilt.world.surface.airport import Point as Corner
from airhilt.world.surface.path import Local
from airhilt.world.surface.strips import runway_strip

DECIMALS = 7
"""Decimals of degrees: a centimetre."""


class Draft:
    """The taxiways of an airport while they are drawn, in metres from its reference point."""

    def __init__(
        self, reference: ReferencePoint, runways: Sequence[Runway], width_m: float
    ) -> None:
        self.local_frame = LocalFrame(reference.place)
        self.strips = {runway.name: runway_strip(runway, self.local_frame) for runway in runways}
        self.width_m = width_m
        self.at: dict[str, Local] = {}
        self._nodes: list[Node] = []
        self._edges: list[Edge] = []
        self.holds: list[HoldShort] = []

    @property
    def taxiways(self) -> Taxiways:
        """The taxiways drawn so far."""
        return Taxiways(nodes=tuple(self._nodes), edges=tuple(self._edges))

    def beside(self, runway: str, along_m: float, right_m: float) -> Local:
        """Return a point by its distance along a runway's centre line and to the right of it.

        ``runway`` is a name such as ``01/19``; the first direction counts.
        """
        start, end = self.strips[runway].centreline.coords
        ahead = lines.unit(start, end)
        return lines.step(lines.step(start, ahead, along_m), (ahead[1], -ahead[0]), right_m)

    def node(
        self, name: str, at: Local, kind: Literal["junction", "hold", "runway", "stand"]
    ) -> str:
        """Add a point of the taxiways, and return its name."""
        latitude, longitude = self.degrees(at)
        self._nodes.append(Node(name=name, lat_deg=latitude, lon_deg=longitude, kind=kind))
        self.at[name] = at
        return name

    def taxiway(self, name: str, *nodes: str) -> None:
        """Join nodes, one after the other."""
        for pair in pairwise(nodes):
            self._edges.append(Edge(nodes=pair, taxiway=name, width_m=self.width_m))

    def entrance(
        self, taxiway: str, outside: str, on_runway: str, runway: str, side: str | None = None
    ) -> str:
        """Join a junction to a node on a runway, with a hold where the protected area begins."""
        leg = LineString([self.at[outside], self.at[on_runway]])
        edge = leg.intersection(self.strips[runway].protected_area.exterior)
        if not isinstance(edge, Point) or edge.is_empty:
            raise ValueError(f"{outside} to {on_runway} does not cross the hold line of {runway}")
        hold = HoldShort(
            node=f"{runway} {taxiway}" + (f"_{side}" if side else ""),
            runway=runway,
            taxiway=taxiway,
            side=side,
        )
        self.node(hold.node, (edge.x, edge.y), "hold")
        self.taxiway(taxiway, outside, hold.node, on_runway)
        self.holds.append(hold)
        return hold.node

    def corners(self, *points: Local) -> tuple[Corner, ...]:
        """Return points as corners of a polygon."""
        return tuple(self.degrees(point) for point in points)

    def degrees(self, at: Local) -> Corner:
        """Return a point as latitude and longitude in degrees."""
        latitude, longitude = self.local_frame.to_place(*at)
        return round(latitude / DEGREE, DECIMALS), round(longitude / DEGREE, DECIMALS)

    def camera(
        self,
        name: str,
        at: Local,
        height_m: float,
        azimuth_deg: float,
        elevation_deg: float = -4.0,
        fov_deg: float = 70.0,
    ) -> Camera:
        """Return a camera; by default it looks slightly down, over a wide angle."""
        latitude, longitude = self.degrees(at)
        return Camera(
            name=name,
            lat_deg=latitude,
            lon_deg=longitude,
            height_m=height_m,
            azimuth_deg=round(azimuth_deg % 360.0, 1),
            elevation_deg=elevation_deg,
            horizontal_fov_deg=fov_deg,
        )

    def runway_cameras(self, runway: str, right_m: float) -> tuple[Camera, ...]:
        """Return a camera at each end of a runway that looks along it and slightly inwards."""
        strip = self.strips[runway]
        alongs_m = (40.0, strip.centreline.length - 40.0)
        return tuple(
            self.camera(
                f"runway_{end.ident}",
                self.beside(runway, along_m, right_m),
                8.0,
                math.degrees(end.course_rad) - math.copysign(8.0, side * right_m),
                elevation_deg=-1.0,
                fov_deg=45.0,
            )
            for end, along_m, side in zip(strip.ends, alongs_m, (1.0, -1.0), strict=True)
        )


def write_airport(airport: Airport, path: Path) -> None:
    """Write the file of an airport, one line an item."""
    path.write_text(as_text(airport), encoding="utf-8")


def as_text(airport: Airport) -> str:
    """Return the file of an airport as text."""
    document = airport.model_dump(mode="json", exclude_defaults=True)
    return f"{_layout(document)}\n"


def _layout(value: Any, indent: str = "") -> str:
    """Return JSON in which whatever fits in a line is one."""
    flat = json.dumps(value, ensure_ascii=False)
    if not isinstance(value, (dict, list)) or (indent and len(indent) + len(flat) <= 100):
        return flat
    deeper = f"{indent}  "
    if isinstance(value, dict):
        items = [
            f"{deeper}{json.dumps(key)}: {_layout(item, deeper)}" for key, item in value.items()
        ]
        opening, closing = "{", "}"
    else:
        items = [f"{deeper}{_layout(item, deeper)}" for item in value]
        opening, closing = "[", "]"
    return f"{opening}\n" + ",\n".join(items) + f"\n{indent}{closing}"
