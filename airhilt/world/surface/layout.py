"""The geometry of an airport: runways and what protects them, holds, taxi routes, exits.

`Layout` computes everything from the numbers of an `airport.Airport`; nothing here is stored.
Importing this module brings in Shapely and NetworkX: do so where an airport is needed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import combinations
from pathlib import Path
from types import MappingProxyType
from typing import Any

from shapely import LineString, Point

from airhilt.errors import ScenarioError
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place, distance_and_azimuth, distance_m
from airhilt.host import library
from airhilt.units import DEGREE, FOOT
from airhilt.world.surface import path as lines
from airhilt.world.surface.airport import (
    Airport,
    Edge,
    HoldShort,
    load_airport,
    read_airport,
)
from airhilt.world.surface.airport import Polygon as Corners
from airhilt.world.surface.path import Leg, Local
from airhilt.world.surface.runway import RunwayEnd
from airhilt.world.surface.strips import RunwayStrip, runway_strip
from airhilt.world.surface.taxiways import TaxiwayGraph

TAXI_RADIUS_M = 100.0 * FOOT
"""Radius of the centre line in a taxiway turn, in m (FAA AC 150/5300-13, table 4-2, group III)."""
LINE_UP_RADIUS_M = 40.0
"""Radius of the arc on to the centre line, in m. Even a 747-400 needs only 46.6 m of pavement for a
half turn (Boeing D6-58326-1, section 4.3)."""
ALIGNED_M = 40.0
"""Length of the straight on the centre line at the end of an entry path, in m."""
EXIT_TANGENT_M = 45.0
"""Distance before the exit at which lead-off arcs begin, in m: their radius is 45 m at a right
angle, and 152 m at 33 degrees."""
LARGEST_EXIT_RADIUS_M = 300.0
"""Greatest radius of a lead-off arc, in m."""
SHARPEST_EXIT_RAD = math.radians(110.0)
"""Greatest turn into an exit."""
CLEAR_OF_HOLD_M = 75.0
"""Distance of the nose beyond the hold line at which the tail of a 747-400, 70.7 m long, is past
it too."""
POINT_STEP_M = 4.0
"""Greatest distance between the points of entries and exits, in m."""
AT_STAND_M = 5.0
"""Distance from a stand within which somebody is parked on it, in m."""
ON_TAXIWAY_M = 15.0
"""Distance from the centre line within which a place is on a taxiway, in m; assumed."""
HALF_HOLD_LINE_M = 16.0
"""Half the length of a hold line, in m: it is drawn wider than its taxiway."""


@dataclass(frozen=True)
class Hold:
    """A point where traffic holds short of a runway."""

    name: str
    """Name of its node in the taxiway graph."""
    place: Place
    """Place of the hold line, on the centre line of the taxiway: noses stop before it."""
    heading_rad: float
    """True heading along the taxiway towards the runway."""
    runway: str
    """Name of the strip, such as ``01/19``."""
    taxiway: str
    position: str
    """The taxiway, and the side of the runway where the taxiway has a hold on both: ``J_north``."""


@dataclass(frozen=True)
class Exit:
    """A way off a runway."""

    taxiway: str
    position: str
    """Position of its hold: the taxiway, and the side of the runway where it leads off on both."""
    along_m: float
    """Distance from the landing threshold to where ``path`` leaves the centre line."""
    turn_rad: float
    """Angle by which it turns, positive to the right."""
    path: tuple[Place, ...]
    """Way from the centre line over a lead-off arc past the hold line, so far that the tail of a
    747 is clear, where the taxiways allow it."""
    hold: str
    """Name of the hold whose line it passes."""


def load_layout(name: str, files: Mapping[str, Any] = MappingProxyType({})) -> Layout:
    """Return the layout of an airport; one that ships with AIRHILT is computed once a process.

    Parameters and errors are those of `airhilt.world.surface.airport.load_airport`.
    """
    if name in files:
        return Layout(load_airport(name, files))
    return _shipped(library.find("airports", name.lower()))


@cache
def _shipped(path: Path) -> Layout:
    return Layout(read_airport(path))


class Layout:
    """Geometry of an airport, in the local frame of its reference point."""

    def __init__(self, airport: Airport) -> None:
        self.airport = airport
        self.local_frame = LocalFrame(airport.reference.place)
        self.elevation_m = airport.elevation_ft * FOOT
        self.strips = {
            runway.name: runway_strip(runway, self.local_frame) for runway in airport.runways
        }
        self.taxiways = TaxiwayGraph(airport, self.strips, self.local_frame)
        self._exits: dict[str, list[Exit]] = {}
        """Exits of each direction that was asked for."""
        self.holds = {given.node: self._hold(given) for given in airport.holds}

    # --- runways --------------------------------------------------------------------------

    def runway(self, ident: str) -> RunwayEnd:
        """Return one direction of a runway, such as ``01``; ``1`` names it too.

        Raises
        ------
        ScenarioError
            There is none; the message names those that exist.
        """
        return next(end for end in self.strip_of(ident).ends if end.ident == _two_digits(ident))

    def strip_of(self, ident: str) -> RunwayStrip:
        """Return the runway one of whose directions is ``ident``.

        Raises
        ------
        ScenarioError
            There is none; the message names those that exist.
        """
        for strip in self.strips.values():
            if _two_digits(ident) in (end.ident for end in strip.ends):
                return strip
        known = ", ".join(end.ident for strip in self.strips.values() for end in strip.ends)
        raise ScenarioError(f"{self.airport.icao} has no runway {ident!r}; it has {known}")

    @cached_property
    def intersections(self) -> list[tuple[str, str, Local]]:
        """Pairs of runways whose centre lines cross, and where, in local metres."""
        crossings = []
        for first, second in combinations(self.strips.values(), 2):
            point = first.centreline.intersection(second.centreline)
            if isinstance(point, Point) and not point.is_empty:
                crossings.append((first.name, second.name, (point.x, point.y)))
        return crossings

    # --- holds, taxi routes, entries and exits --------------------------------------------

    def hold(self, runway_ident: str, taxiway: str) -> Hold:
        """Return the holding position of a runway on a taxiway.

        ``taxiway`` may name the side too (``J_north``), and must where there are two.

        Raises
        ------
        ScenarioError
            There is none, or more than one; the message names those that exist.
        """
        strip = self.strip_of(runway_ident)
        here = [hold for hold in self.holds.values() if hold.runway == strip.name]
        found = [hold for hold in here if hold.position == taxiway] or [
            hold for hold in here if hold.taxiway == taxiway
        ]
        if len(found) == 1:
            return found[0]
        if found:
            positions = " or ".join(hold.position for hold in found)
            raise ScenarioError(
                f"taxiway {taxiway} has {len(found)} holds short of runway {strip.name} at "
                f"{self.airport.icao}: say {positions}"
            )
        positions = ", ".join(sorted(hold.position for hold in here)) or "none"
        raise ScenarioError(
            f"{self.airport.icao} has no hold short of runway {runway_ident} on taxiway "
            f"{taxiway!r}; there is: {positions}"
        )

    def node(self, name: str) -> Place:
        """Return where a node of the taxiways is.

        Raises
        ------
        ScenarioError
            There is none; the message gives the nearest.
        """
        return self.local_frame.to_place(*self.taxiways.at(name))

    def taxi_route(
        self,
        start: Place | str,
        end: Place | str,
        via: Sequence[str] = (),
        heading_rad: float | None = None,
    ) -> list[Place]:
        """Return the shortest way along the taxiways, with corners that wheels can follow.

        Protected areas are avoided where there is a way round them.

        Parameters
        ----------
        start, end
            Places, or names of nodes. A place is joined to the nearest taxiway, or, on the
            pavement of a runway, to its centre line.
        via
            Names of taxiways or nodes that the way must use, in that order.
        heading_rad
            True heading of what begins at the start: the way turns it round only where no other
            leads to the end.

        Raises
        ------
        ScenarioError
            A node or taxiway does not exist, a place is off the taxiways, or there is no path.
        """
        points = self.taxiways.route(start, end, via, heading_rad)
        return self._places(lines.rounded(points, TAXI_RADIUS_M))

    def entry_path(self, hold: Hold, runway_ident: str) -> list[Place]:
        """Return the way from a hold line to lined up on a runway.

        It follows the taxiway, turns on to the centre line in an arc, and ends some 40 m
        further, pointing down the runway.

        Raises
        ------
        ScenarioError
            The hold is at another runway, or at the far end of this one.
        """
        strip, end = self.strip_of(runway_ident), self.runway(runway_ident)
        if hold.runway != strip.name:
            raise ScenarioError(
                f"hold {hold.name!r} is short of runway {hold.runway}, not of {runway_ident}"
            )
        points = [
            self.taxiways.nodes[name] for name in self.taxiways.to_centreline(hold.name, strip.name)
        ]
        ahead = self._direction(end)
        points.append(lines.step(points[-1], ahead, max(lines.length(points), ALIGNED_M)))
        curve = lines.rounded(points, LINE_UP_RADIUS_M)
        curve[-1] = lines.step(curve[-2], ahead, ALIGNED_M)
        if _along(ahead, curve[-1], self.local_frame.to_local(end.end)) <= 0.0:
            raise ScenarioError(
                f"hold {hold.name!r} is at the far end of runway {runway_ident}: nothing of it "
                "lies ahead there"
            )
        return self._places(lines.dense(curve, POINT_STEP_M))

    def exits(self, runway_ident: str) -> list[Exit]:
        """Return the ways off a runway, in the order in which a landing meets them.

        Raises
        ------
        ScenarioError
            There is no such runway.
        """
        strip, end = self.strip_of(runway_ident), self.runway(runway_ident)
        if end.ident not in self._exits:
            found = [
                way
                for hold in self.holds.values()
                if hold.runway == strip.name and (way := self._exit(hold, end)) is not None
            ]
            self._exits[end.ident] = sorted(found, key=lambda way: (way.along_m, way.taxiway))
        return self._exits[end.ident]

    def way_across(self, hold: Hold) -> tuple[list[Place], float] | None:
        """Return the way from a hold line across its runway, and on beyond the far hold line.

        The second number is the distance along the way, in m, at which that line is. None: no
        taxiway leads across there.
        """
        holds = [each.name for each in self.holds.values() if each.runway == hold.runway]
        across = self.taxiways.across(hold.name, hold.runway, holds)
        if across is None:
            return None
        onward_from_hold = self.taxiways.away(across[-2], across[-1], self.stands)[1:]
        corners = [self.taxiways.nodes[name] for name in [*across, *onward_from_hold]]
        curve = lines.rounded(corners, TAXI_RADIUS_M)
        line_m = LineString(curve).project(Point(self.taxiways.nodes[across[-1]]))
        return self._places(lines.dense(curve, POINT_STEP_M)), float(line_m)

    def way_off(self, here: Place, hold: Hold, heading_rad: float) -> tuple[list[Place], float]:
        """Return the way from a runway over a hold line, and on beyond it.

        The second number is the distance along the way, in m, at which that line is. What begins it
        points in a true heading.

        Raises
        ------
        ScenarioError
            No taxiway leads there.
        """
        way = self.taxi_route(here, hold.name, (), heading_rad)
        inside = self.taxiways.to_centreline(hold.name, hold.runway)[1]
        beyond = self.taxiways.away(inside, hold.name, self.stands)[1:]
        length_m = lines.length([self.local_frame.to_local(place) for place in way])
        return [*way, *(self.node(name) for name in beyond)], length_m

    @cached_property
    def stands(self) -> tuple[str, ...]:
        """Names of the nodes where aircraft and vehicles stand."""
        return tuple(node.name for node in self.airport.taxiways.nodes if node.kind == "stand")

    def runway_at(self, here: Place) -> str | None:
        """Return the runway in whose protected area a place is, in one direction."""
        point = self.local_frame.to_local(here)
        on = (strip for strip in self.strips.values() if strip.protects(point))
        return next((strip.ends[0].ident for strip in on), None)

    def stand_at(self, here: Place) -> str | None:
        """Return the stand at which a place is."""
        near = (name for name in self.stands if distance_m(self.node(name), here) < AT_STAND_M)
        return next(near, None)

    def taxiway_at(self, here: Place) -> str | None:
        """Return the taxiway on which a place is."""
        point = Point(self.local_frame.to_local(here))
        away = (
            (LineString(self.leg(edge)).distance(point), edge.taxiway)
            for edge in self.airport.taxiways.edges
        )
        nearest_m, taxiway = min(away)
        return taxiway if nearest_m < ON_TAXIWAY_M else None

    # --- shapes in local metres -----------------------------------------------------------

    def leg(self, edge: Edge) -> Leg:
        """Return both ends of a straight piece of a taxiway."""
        first, second = edge.nodes
        return self.taxiways.nodes[first], self.taxiways.nodes[second]

    def hold_line(self, hold: Hold, least_half_m: float = 0.0) -> Leg:
        """Return both ends of a hold line, along the edge of the area that it protects.

        The line is at least twice ``least_half_m`` long.
        """
        along = lines.unit(*self.strips[hold.runway].centreline.coords)
        middle, half_m = self.taxiways.nodes[hold.name], max(HALF_HOLD_LINE_M, least_half_m)
        return lines.step(middle, along, -half_m), lines.step(middle, along, half_m)

    def outline(self, corners: Corners) -> list[Local]:
        """Return the corners of an area that the airport's file has in degrees."""
        return [self.local_frame.to_local((lat * DEGREE, lon * DEGREE)) for lat, lon in corners]

    # --- parts ----------------------------------------------------------------------------

    def _hold(self, given: HoldShort) -> Hold:
        way = self.taxiways.to_centreline(given.node, given.runway)
        place = self.local_frame.to_place(*self.taxiways.nodes[given.node])
        towards = self.local_frame.to_place(*self.taxiways.nodes[way[1]])
        return Hold(
            name=given.node,
            place=place,
            heading_rad=distance_and_azimuth(place, towards)[1],
            runway=given.runway,
            taxiway=given.taxiway,
            position=given.position,
        )

    # --- on the graph ---------------------------------------------------------------------

    def _exit(self, hold: Hold, end: RunwayEnd) -> Exit | None:
        inward = self.taxiways.to_centreline(hold.name, hold.runway)
        ahead = self._direction(end)
        outward = [self.taxiways.nodes[name] for name in reversed(inward)]
        before = lines.step(outward[0], ahead, -LARGEST_EXIT_RADIUS_M)
        angle = lines.turn(before, outward[0], outward[1])
        if abs(angle) > SHARPEST_EXIT_RAD:
            return None
        onward_from_hold = [
            self.taxiways.nodes[name]
            for name in self.taxiways.away(inward[1], hold.name, self.stands)[1:]
        ]
        radius = min(EXIT_TANGENT_M / math.tan(abs(angle) / 2.0), LARGEST_EXIT_RADIUS_M)
        curve = lines.rounded([before, *outward, *onward_from_hold], TAXI_RADIUS_M, radius)[1:]
        along = _along(ahead, self.local_frame.to_local(end.threshold), curve[0])
        if along <= 0.0:
            return None
        past_hold = LineString(curve).project(Point(self.taxiways.nodes[hold.name]))
        path = lines.cut(curve, past_hold + CLEAR_OF_HOLD_M)
        return Exit(
            taxiway=hold.taxiway,
            position=hold.position,
            along_m=along,
            turn_rad=angle,
            path=tuple(self._places(lines.dense(path, POINT_STEP_M))),
            hold=hold.name,
        )

    def _direction(self, end: RunwayEnd) -> Local:
        return lines.unit(self.local_frame.to_local(end.start), self.local_frame.to_local(end.end))

    def _places(self, points: Sequence[Local]) -> list[Place]:
        return [self.local_frame.to_place(*point) for point in points]


def _along(direction: Local, start: Local, point: Local) -> float:
    return (point[0] - start[0]) * direction[0] + (point[1] - start[1]) * direction[1]


def _two_digits(ident: str) -> str:
    """Return a runway designator with the leading zero of ICAO Annex 14 volume I, 5.2.2.4."""
    return ident if ident[1:2].isdigit() else f"0{ident}"
