"""The shapes of an airport as they are drawn: polygons, lines and names, in local metres.

`ground_plan` takes them from a `Layout`. The diagram of ``airhilt airport show`` and the plan view
of a report draw the same shapes. Importing this module brings in Shapely and NetworkX: do so where
an airport is needed.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

from airhilt.units import DEGREE
from airhilt.world.surface import path as lines
from airhilt.world.surface.layout import Hold, Layout
from airhilt.world.surface.path import Local
from airhilt.world.surface.runway import RunwayEnd
from airhilt.world.surface.strips import RunwayStrip

HALF_HOLD_LINE_M = 16.0
"""Half the length of a hold line, in m: it is drawn wider than its taxiway."""

Outline = tuple[Local, ...]
"""Corners of a polygon in order, the first not repeated."""
Leg = tuple[Local, Local]
"""Both ends of a straight line."""


@dataclass(frozen=True)
class RunwayEndShape:
    """One direction of a runway.

    Attributes
    ----------
    start, far_end
        Ends of the pavement, in the direction of landing.
    course_rad
        True course of the centre line.
    displaced_m
        Distance of the threshold from the start.
    """

    ident: str
    start: Local
    threshold: Local
    far_end: Local
    course_rad: float
    length_m: float
    width_m: float
    displaced_m: float


@dataclass(frozen=True)
class RunwayShape:
    """A runway, and the area around it that its holding positions protect."""

    name: str
    pavement: Outline
    protected: Outline
    ends: tuple[RunwayEndShape, RunwayEndShape]

    @property
    def width_m(self) -> float:
        """Width of the pavement."""
        return self.ends[0].width_m

    @property
    def centreline(self) -> Leg:
        """Centre line from the start of the first direction to that of the second."""
        return self.ends[0].start, self.ends[1].start


@dataclass(frozen=True)
class TaxiwayLeg:
    """A straight piece of a taxiway."""

    taxiway: str
    ends: Leg
    width_m: float

    @property
    def length_m(self) -> float:
        """Length of the piece."""
        return math.dist(*self.ends)


@dataclass(frozen=True)
class HoldLine:
    """A hold line: it lies along the edge of the protected area, across its taxiway.

    Attributes
    ----------
    name
        Name of its node in the taxiway graph.
    position
        The taxiway, and the side of the runway where the taxiway has a hold on both.
    direction
        Unit vector along the line.
    """

    name: str
    position: str
    runway: str
    middle: Local
    direction: Local

    def ends(self, least_half_m: float = 0.0) -> Leg:
        """Return both ends of the line, which is at least twice the given length."""
        half_m = max(HALF_HOLD_LINE_M, least_half_m)
        return (
            lines.step(self.middle, self.direction, -half_m),
            lines.step(self.middle, self.direction, half_m),
        )


@dataclass(frozen=True)
class Area:
    """A named polygon: a building, or water."""

    name: str
    outline: Outline


@dataclass(frozen=True)
class Spot:
    """A named place."""

    name: str
    place: Local


@dataclass(frozen=True)
class CameraShape:
    """A fixed camera, with the direction and width of its view."""

    name: str
    place: Local
    azimuth_deg: float
    horizontal_fov_deg: float


@dataclass(frozen=True)
class GroundPlan:
    """All shapes of an airport, in metres east and north of its reference point."""

    icao: str
    name: str
    elevation_m: float
    runways: tuple[RunwayShape, ...]
    taxiway_legs: tuple[TaxiwayLeg, ...]
    holds: tuple[HoldLine, ...]
    buildings: tuple[Area, ...]
    water: tuple[Area, ...]
    stands: tuple[Spot, ...]
    cameras: tuple[CameraShape, ...]
    tower: Local | None
    intersections: tuple[Spot, ...]
    """Crossings of two runways, each named after both, such as ``01/19 crosses 15/33``."""

    @cached_property
    def taxiways(self) -> dict[str, list[TaxiwayLeg]]:
        """Legs of each taxiway, by its name."""
        legs: dict[str, list[TaxiwayLeg]] = defaultdict(list)
        for leg in self.taxiway_legs:
            legs[leg.taxiway].append(leg)
        return dict(legs)

    def runway_end(self, ident: str) -> RunwayEndShape | None:
        """Return one direction of a runway, such as ``01``, or None if there is none."""
        ends = (end for runway in self.runways for end in runway.ends)
        return next((end for end in ends if end.ident == ident), None)


def ground_plan(layout: Layout) -> GroundPlan:
    """Return the shapes of an airport."""
    airport, frame = layout.airport, layout.local_frame

    def outline(corners: Iterable[tuple[float, float]]) -> Outline:
        return tuple(frame.to_local((lat * DEGREE, lon * DEGREE)) for lat, lon in corners)

    return GroundPlan(
        icao=airport.icao,
        name=airport.name,
        elevation_m=layout.elevation_m,
        runways=tuple(_runway(layout, strip) for strip in layout.strips.values()),
        taxiway_legs=tuple(
            TaxiwayLeg(edge.taxiway, _leg(layout, edge.nodes), edge.width_m)
            for edge in airport.taxiways.edges
        ),
        holds=tuple(_hold_line(layout, hold) for hold in layout.holds.values()),
        buildings=tuple(Area(one.name, outline(one.footprint)) for one in airport.buildings),
        water=tuple(Area(one.name, outline(one.outline)) for one in airport.water),
        stands=tuple(Spot(name, frame.to_local(layout.node(name))) for name in layout.stands),
        cameras=tuple(
            CameraShape(
                one.name, frame.to_local(one.place), one.azimuth_deg, one.horizontal_fov_deg
            )
            for one in airport.cameras
        ),
        tower=frame.to_local(airport.tower.place) if airport.tower else None,
        intersections=tuple(
            Spot(f"{first} crosses {second}", at) for first, second, at in layout.intersections
        ),
    )


def _runway(layout: Layout, strip: RunwayStrip) -> RunwayShape:
    first, second = strip.ends
    return RunwayShape(
        strip.name,
        tuple(strip.pavement.exterior.coords[:-1]),
        tuple(strip.protected_area.exterior.coords[:-1]),
        (_runway_end(layout, first), _runway_end(layout, second)),
    )


def _runway_end(layout: Layout, end: RunwayEnd) -> RunwayEndShape:
    start, threshold, far_end = map(
        layout.local_frame.to_local, (end.start, end.threshold, end.end)
    )
    return RunwayEndShape(
        end.ident,
        start,
        threshold,
        far_end,
        end.course_rad,
        end.length_m,
        end.width_m,
        end.displaced_m,
    )


def _leg(layout: Layout, nodes: tuple[str, str]) -> Leg:
    first, second = (layout.local_frame.to_local(layout.node(name)) for name in nodes)
    return first, second


def _hold_line(layout: Layout, hold: Hold) -> HoldLine:
    along = lines.unit(*layout.strips[hold.runway].centreline.coords)
    middle = layout.local_frame.to_local(hold.place)
    return HoldLine(hold.name, hold.position, hold.runway, middle, along)
