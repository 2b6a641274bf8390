"""The geometry of an airport: runways and what protects them, holds, taxi routes, exits.

`Layout` computes everything from the numbers of an `airport.Airport`; nothing here is stored.
Importing this module brings in Shapely and NetworkX: do so where an airport is needed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import networkx
from shapely import LineString, Point, Polygon

from airhilt import library
from airhilt.errors import ScenarioError
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place, distance_and_azimuth, onward
from airhilt.units import FOOT
from airhilt.world.surface import path as lines
from airhilt.world.surface.airport import Airport, HoldShort, Runway, RunwayThreshold
from airhilt.world.surface.path import Local
from airhilt.world.surface.runway import RunwayEnd

STRIP_BEYOND_END_M = 60.0
"""ICAO Annex 14 volume I, 3.4.2: a runway strip extends 60 m beyond the end of the runway."""
TAXI_RADIUS_M = 100.0 * FOOT
"""Of the centre line in a taxiway turn, design group III: FAA AC 150/5300-13, table 4-2."""
LINE_UP_RADIUS_M = 40.0
"""Of the arc on to the centre line. Even a 747-400 needs only 46.6 m of pavement for a half turn
(Boeing D6-58326-1, section 4.3)."""
ALIGNED_M = 40.0
"""Straight ahead on the centre line at the end of an entry path."""
EXIT_TANGENT_M = 45.0
"""Lead-off arcs begin so far before the exit: radius 45 m at a right angle, 152 m at 33 degrees."""
LARGEST_EXIT_RADIUS_M = 300.0
SHARPEST_EXIT_RAD = math.radians(110.0)
CLEAR_OF_HOLD_M = 75.0
"""A 747-400 is 70.7 m long: its tail is past the hold line when its nose is this far beyond."""
ON_CENTRELINE_M = 2.0
OFF_TAXIWAYS_M = 150.0
"""Farther than this from any taxiway, a place is not on the airport's taxiways."""
ON_TAXIWAY_M = 10.0
"""Nearer than this to a taxiway, a place is on it."""
RUNWAY_COST = 10.0
"""A metre of taxiway within a protected area weighs as much as ten outside, so that routes cross
no runway that they can go round."""
SHARP_TURN_RAD = math.radians(100.0)
SHARP_TURN_COST_M = 2000.0
"""Routes make a turn sharper than that only if the way round is this much longer."""
TOUCHES_M = 0.5
"""A taxiway with less than this in a protected area ends at its edge."""
POINT_STEP_M = 4.0
"""Between the points of entries and exits, at most."""


@dataclass(frozen=True)
class RunwayStrip:
    """A runway with the area around it that its holding positions protect.

    Attributes
    ----------
    name
        Such as ``01/19``.
    ends
        Its two directions, in the order of the name.
    pavement, protected_area, centreline
        In local metres. The protected area reaches to the holding positions on both sides and
        60 m beyond both ends of the pavement: ICAO Doc 9870, Manual on the Prevention of Runway
        Incursions, 1.1, counts an incursion within the area protected by the holding positions.
    hold_distance_m
        Of the holding positions from the centre line: FAA AC 150/5300-13B, runway design
        standards matrix (appendix G), 250 ft for approach categories C and D; ICAO Annex 14
        volume I, table 3-2, 90 m for code number 4 with precision approaches.
    """

    name: str
    ends: tuple[RunwayEnd, RunwayEnd]
    pavement: Polygon
    protected_area: Polygon
    centreline: LineString
    hold_distance_m: float


@dataclass(frozen=True)
class Hold:
    """Where traffic holds short of a runway.

    Attributes
    ----------
    name
        Of its node in the taxiway graph.
    place
        Of the hold line, on the centre line of the taxiway: noses stop before it.
    heading_rad
        True, along the taxiway towards the runway.
    runway
        Name of the strip, such as ``01/19``.
    position
        The taxiway, and the side of the runway where the taxiway has a hold on both: ``J_north``.
    """

    name: str
    place: Place
    heading_rad: float
    runway: str
    taxiway: str
    position: str


@dataclass(frozen=True)
class Exit:
    """A way off a runway.

    Attributes
    ----------
    position
        Of its hold: the taxiway, and the side of the runway where it leads off on both.
    along_m
        From the landing threshold to where ``path`` leaves the centre line.
    turn_rad
        How far it turns, positive to the right.
    path
        From the centre line over a lead-off arc past the hold line, so far that the tail of a
        747 is clear, where the taxiways allow it.
    hold
        Name of the hold whose line it passes.
    """

    taxiway: str
    position: str
    along_m: float
    turn_rad: float
    path: tuple[Place, ...]
    hold: str


class Layout:
    """What can be computed from an airport's file, in the local frame of its reference point."""

    def __init__(self, airport: Airport) -> None:
        self.airport = airport
        self.frame = LocalFrame(airport.reference.place)
        self.elevation_m = airport.elevation_ft * FOOT
        self.strips = {runway.name: runway_strip(runway, self.frame) for runway in airport.runways}
        self._nodes: dict[str, Local] = {
            node.name: self.frame.to_local(node.place) for node in airport.taxiways.nodes
        }
        self._graph = self._taxiway_graph()
        self._exits: dict[str, list[Exit]] = {}
        """Of each direction, once they were asked for."""
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
        return self.frame.to_place(*self._node(name))

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
            Of what begins at the start, true: the way turns it round only where no other leads
            to the end.

        Raises
        ------
        ScenarioError
            A node or taxiway does not exist, a place is off the taxiways, or there is no path.
        """
        graph = self._graph.copy()
        first, last = self._join(graph, start, "start"), self._join(graph, end, "end")
        behind = None
        if heading_rad is not None:
            ahead = math.sin(heading_rad), math.cos(heading_rad)
            behind = lines.step(graph.nodes[first]["at"], ahead, -1.0)
        points = [graph.nodes[name]["at"] for name in self._route(graph, first, last, via, behind)]
        points = self._attach(points[::-1], end)[::-1]
        points = self._attach(points, start)
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
        points = [self._nodes[name] for name in self._to_centreline(hold.name, strip.name)]
        ahead = self._direction(end)
        points.append(lines.step(points[-1], ahead, max(lines.length(points), ALIGNED_M)))
        curve = lines.rounded(points, LINE_UP_RADIUS_M)
        curve[-1] = lines.step(curve[-2], ahead, ALIGNED_M)
        if _along(ahead, curve[-1], self.frame.to_local(end.end)) <= 0.0:
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

    @cached_property
    def stands(self) -> tuple[str, ...]:
        """Names of the nodes where aircraft and vehicles stand."""
        return tuple(node.name for node in self.airport.taxiways.nodes if node.kind == "stand")

    # --- construction ---------------------------------------------------------------------

    def _taxiway_graph(self) -> networkx.Graph:
        graph = networkx.Graph()
        for name, at in self._nodes.items():
            graph.add_node(name, at=at)
        for edge in self.airport.taxiways.edges:
            self._connect(graph, *edge.nodes, edge.taxiway)
        return graph

    def _connect(self, graph: networkx.Graph, a: str, b: str, taxiway: str) -> None:
        leg = LineString([graph.nodes[a]["at"], graph.nodes[b]["at"]])
        inside = {
            strip.name: leg.intersection(strip.protected_area).length
            for strip in self.strips.values()
        }
        graph.add_edge(
            a,
            b,
            taxiway=taxiway,
            cost=leg.length + (RUNWAY_COST - 1.0) * max(inside.values()),
            inside={name for name, metres in inside.items() if metres > TOUCHES_M},
        )

    def _hold(self, given: HoldShort) -> Hold:
        way = self._to_centreline(given.node, given.runway)
        place = self.frame.to_place(*self._nodes[given.node])
        towards = self.frame.to_place(*self._nodes[way[1]])
        return Hold(
            name=given.node,
            place=place,
            heading_rad=distance_and_azimuth(place, towards)[1],
            runway=given.runway,
            taxiway=given.taxiway,
            position=given.position,
        )

    # --- on the graph ---------------------------------------------------------------------

    def _node(self, name: str) -> Local:
        if name not in self._nodes:
            nearest = library.nearest(name, sorted(self._nodes))
            raise ScenarioError(f"{self.airport.icao} has no taxiway node {name!r}{nearest}")
        return self._nodes[name]

    def _join(self, graph: networkx.Graph, where: Place | str, what: str) -> str:
        """Return the node that stands for a place, after splitting the nearest edge there."""
        if isinstance(where, str):
            self._node(where)
            return where
        at = Point(self.frame.to_local(where))
        legs = [
            (LineString([graph.nodes[a]["at"], graph.nodes[b]["at"]]), a, b) for a, b in graph.edges
        ]
        if not legs:
            raise ScenarioError(f"{self.airport.icao} has no taxiways")
        leg, a, b = min(legs, key=lambda item: (item[0].distance(at), *item[1:]))
        name = f"the {what} of the route"
        for strip in self.strips.values():
            if leg.distance(at) > ON_TAXIWAY_M and strip.pavement.contains(at):
                self._join_to_runway(graph, strip, at, name)
                return name
        if leg.distance(at) > OFF_TAXIWAYS_M:
            raise ScenarioError(
                f"the {what} of the taxi route is {leg.distance(at):.0f} m from the nearest "
                f"taxiway of {self.airport.icao}, at most {OFF_TAXIWAYS_M:.0f} m are expected"
            )
        foot = leg.interpolate(leg.project(at))
        for corner in (a, b):
            if foot.distance(Point(graph.nodes[corner]["at"])) < lines.SHORTEST_LEG_M:
                return str(corner)
        taxiway = graph.edges[a, b]["taxiway"]
        graph.remove_edge(a, b)
        graph.add_node(name, at=(foot.x, foot.y))
        self._connect(graph, a, name, taxiway)
        self._connect(graph, name, b, taxiway)
        return name

    def _join_to_runway(
        self, graph: networkx.Graph, strip: RunwayStrip, at: Point, name: str
    ) -> None:
        """Add a node on a centre line, and join it to its neighbours there."""
        centreline = strip.centreline
        along = {
            node: centreline.project(Point(data["at"]))
            for node, data in graph.nodes(data=True)
            if centreline.distance(Point(data["at"])) <= ON_CENTRELINE_M
        }
        here = centreline.project(at)
        foot = centreline.interpolate(here)
        graph.add_node(name, at=(foot.x, foot.y))
        below = max(
            (node for node in along if along[node] <= here), key=along.__getitem__, default=None
        )
        above = min(
            (node for node in along if along[node] > here), key=along.__getitem__, default=None
        )
        for node in (below, above):
            if node is not None:
                self._connect(graph, name, node, strip.name)

    def _attach(self, points: list[Local], where: Place | str) -> list[Local]:
        """Return a way that begins at a place, where it began at the taxiway nearest to it."""
        if isinstance(where, str):
            return points
        at = self.frame.to_local(where)
        on_taxiway = math.dist(at, points[0]) < ON_TAXIWAY_M and len(points) > 1
        return [at, *(points[1:] if on_taxiway else points)]

    def _route(
        self,
        graph: networkx.Graph,
        start: str,
        end: str,
        via: Sequence[str],
        behind: Local | None,
    ) -> list[str]:
        taxiways = {data["taxiway"] for _, _, data in graph.edges(data=True)}
        for name in via:
            if name not in taxiways and name not in graph:
                nearest = library.nearest(name, sorted(taxiways))
                raise ScenarioError(f"{self.airport.icao} has no taxiway {name!r}{nearest}")
        route = _shortest_way(graph, start, [end], via, behind)
        if route is None:
            through = f" via {', '.join(via)}" if via else ""
            raise ScenarioError(
                f"there is no taxi route from {start!r} to {end!r}{through} at {self.airport.icao}"
            )
        return route

    def _to_centreline(self, hold: str, runway: str) -> list[str]:
        """Return the nodes from a hold to the centre line of the runway that it protects."""
        centreline = self.strips[runway].centreline
        protected = networkx.subgraph_view(
            self._graph, filter_edge=lambda a, b: runway in self._graph.edges[a, b]["inside"]
        )
        lengths, ways = networkx.single_source_dijkstra(protected, hold, weight="cost")
        reached = [
            (lengths[name], name)
            for name in ways
            if centreline.distance(Point(self._nodes[name])) <= ON_CENTRELINE_M
        ]
        if not reached:
            raise ScenarioError(
                f"no taxiway of {self.airport.icao} leads from hold {hold!r} on to runway {runway}"
            )
        return list(ways[min(reached)[1]])

    def _exit(self, hold: Hold, end: RunwayEnd) -> Exit | None:
        inward = self._to_centreline(hold.name, hold.runway)
        ahead = self._direction(end)
        outward = [self._nodes[name] for name in reversed(inward)]
        before = lines.step(outward[0], ahead, -LARGEST_EXIT_RADIUS_M)
        angle = lines.turn(before, outward[0], outward[1])
        if abs(angle) > SHARPEST_EXIT_RAD:
            return None
        onward_from_hold = [self._nodes[name] for name in self._away(inward[1], hold.name)[1:]]
        radius = min(EXIT_TANGENT_M / math.tan(abs(angle) / 2.0), LARGEST_EXIT_RADIUS_M)
        curve = lines.rounded([before, *outward, *onward_from_hold], TAXI_RADIUS_M, radius)[1:]
        along = _along(ahead, self.frame.to_local(end.threshold), curve[0])
        if along <= 0.0:
            return None
        past_hold = LineString(curve).project(Point(self._nodes[hold.name]))
        path = lines.cut(curve, past_hold + CLEAR_OF_HOLD_M)
        return Exit(
            taxiway=hold.taxiway,
            position=hold.position,
            along_m=along,
            turn_rad=angle,
            path=tuple(self._places(lines.dense(path, POINT_STEP_M))),
            hold=hold.name,
        )

    def _away(self, inside: str, hold: str) -> list[str]:
        """Return nodes from a hold away from its runway.

        They lead to the nearest stand that is reached without entering a runway, or else as
        straight on as the taxiways go.
        """
        outside = networkx.subgraph_view(
            self._graph, filter_edge=lambda a, b: not self._graph.edges[a, b]["inside"]
        )
        if to_stand := _shortest_way(outside, hold, self.stands, before=self._nodes[inside]):
            return to_stand
        way, before = [hold], inside
        while nexts := [name for name in outside[way[-1]] if name not in way]:
            here = self._nodes[way[-1]]
            turns = {
                name: abs(lines.turn(self._nodes[before], here, self._nodes[name]))
                for name in nexts
            }
            before = way[-1]
            way.append(min(turns, key=lambda name: (turns[name], name)))
        return way

    def _direction(self, end: RunwayEnd) -> Local:
        return lines.unit(self.frame.to_local(end.start), self.frame.to_local(end.end))

    def _places(self, points: Sequence[Local]) -> list[Place]:
        return [self.frame.to_place(*point) for point in points]


def _shortest_way(
    graph: networkx.Graph,
    start: str,
    ends: Sequence[str],
    via: Sequence[str] = (),
    before: Local | None = None,
) -> list[str] | None:
    """Return the nodes of the cheapest way from a node to the nearest of some others, or None.

    The search runs over legs rather than nodes, so that turns have a cost and no way doubles
    back; ``before`` is a point from which the start is reached. Each leg is known by how many
    names of ``via`` have been used when it ends.
    """
    if start in ends and not via:
        return [start]
    goal = "", "", len(via)
    legs = networkx.DiGraph()
    legs.add_nodes_from((("", start, 0), goal))
    for middle in graph:
        here = graph.nodes[middle]["at"]
        tails = [(name, graph.nodes[name]["at"]) for name in graph[middle]]
        if middle == start:
            tails.append(("", before))
        for head, data in graph[middle].items():
            for tail, point in tails:
                if tail == head:
                    continue
                cost = data["cost"] + _turn_cost(point, here, graph.nodes[head]["at"])
                for stage, wanted in enumerate([*via, None]):
                    used = stage + (wanted in (data["taxiway"], head))
                    legs.add_edge((tail, middle, stage), (middle, head, used), cost=cost)
    legs.add_edges_from(
        ((tail, end, len(via)), goal, {"cost": 0.0})
        for end in ends
        if end in graph
        for tail in graph[end]
    )
    try:
        way = networkx.shortest_path(legs, ("", start, 0), goal, weight="cost")
    except networkx.NetworkXNoPath:
        return None
    return [str(head) for _, head, _ in way[:-1]]


def _turn_cost(before: Local | None, corner: Local, after: Local) -> float:
    if before is None or abs(lines.turn(before, corner, after)) < SHARP_TURN_RAD:
        return 0.0
    return SHARP_TURN_COST_M


def runway_strip(runway: Runway, frame: LocalFrame) -> RunwayStrip:
    """Return a runway of an airport's file with the area around it, in local metres."""
    low, high = runway.ends
    a, b = frame.to_local(low.place), frame.to_local(high.place)
    width_m = runway.width_ft * FOOT
    beyond = STRIP_BEYOND_END_M / math.dist(a, b)
    centreline = LineString([a, b])
    longer = LineString([lines.between(a, b, -beyond), lines.between(a, b, 1.0 + beyond)])
    return RunwayStrip(
        name=runway.name,
        ends=(_runway_end(low, high, width_m), _runway_end(high, low, width_m)),
        pavement=_band(centreline, width_m / 2.0),
        protected_area=_band(longer, runway.hold_distance_m),
        centreline=centreline,
        hold_distance_m=runway.hold_distance_m,
    )


def _runway_end(here: RunwayThreshold, there: RunwayThreshold, width_m: float) -> RunwayEnd:
    length_m, course_rad = distance_and_azimuth(here.place, there.place)
    displaced_m = here.displaced_threshold_ft * FOOT
    slope = (there.elevation_ft - here.elevation_ft) * FOOT / length_m
    return RunwayEnd(
        ident=here.ident,
        start=here.place,
        threshold=onward(here.place, course_rad, displaced_m),
        end=there.place,
        elevation_m=here.elevation_ft * FOOT + slope * displaced_m,
        width_m=width_m,
        length_m=length_m,
        displaced_m=displaced_m,
        course_rad=course_rad,
    )


def _band(line: LineString, half_width_m: float) -> Polygon:
    band = line.buffer(half_width_m, cap_style="flat")
    assert isinstance(band, Polygon)
    return band


def _along(direction: Local, start: Local, point: Local) -> float:
    return (point[0] - start[0]) * direction[0] + (point[1] - start[1]) * direction[1]


def _two_digits(ident: str) -> str:
    """Return a runway designator with the leading zero of ICAO Annex 14 volume I, 5.2.2.4."""
    return ident if ident[1:2].isdigit() else f"0{ident}"
