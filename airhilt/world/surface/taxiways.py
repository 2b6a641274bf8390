"""The taxiways of an airport as a graph, and ways through it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import networkx
from shapely import LineString, Point

from airhilt.errors import ScenarioError
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place
from airhilt.host import library
from airhilt.world.surface import path as lines
from airhilt.world.surface.airport import Airport
from airhilt.world.surface.path import Local
from airhilt.world.surface.strips import RunwayStrip

ON_CENTRELINE_M = 2.0
"""Greatest distance of a node from a centre line on which it lies, in m."""
OFF_TAXIWAYS_M = 150.0
"""Distance from all taxiways beyond which a place is not on them, in m."""
ON_TAXIWAY_M = 10.0
"""Distance from a taxiway below which a place is on it, in m."""
RUNWAY_COST = 10.0
"""Cost of a metre of taxiway within a protected area, in metres outside of one: routes cross no
runway that they can go round."""
SHARP_TURN_RAD = math.radians(100.0)
"""Turns from this on are sharp."""
SHARP_TURN_COST_M = 2000.0
"""Cost of a sharp turn, in metres: what the way round may be longer."""
TOUCHES_M = 0.5
"""A taxiway with less than this in a protected area ends at its edge."""


class TaxiwayGraph:
    """The taxiways of an airport in local metres.

    Attributes
    ----------
    nodes
        Places of the nodes, by name.
    """

    def __init__(
        self, airport: Airport, strips: Mapping[str, RunwayStrip], local_frame: LocalFrame
    ) -> None:
        self._icao = airport.icao
        self._strips = strips
        self._local_frame = local_frame
        self.nodes: dict[str, Local] = {
            node.name: local_frame.to_local(node.place) for node in airport.taxiways.nodes
        }
        self._graph = networkx.Graph()
        for name, at in self.nodes.items():
            self._graph.add_node(name, at=at)
        for edge in airport.taxiways.edges:
            self._connect(self._graph, *edge.nodes, edge.taxiway)

    def route(
        self, start: Place | str, end: Place | str, via: Sequence[str], heading_rad: float | None
    ) -> list[Local]:
        """Return the corners of the cheapest way; see `airhilt.world.surface.layout.Layout`.

        Raises
        ------
        ScenarioError
            A node or taxiway does not exist, a place is off the taxiways, or there is no way.
        """
        graph = self._graph.copy()
        first, last = self._join(graph, start, "start"), self._join(graph, end, "end")
        behind = None
        if heading_rad is not None:
            ahead = math.sin(heading_rad), math.cos(heading_rad)
            behind = lines.step(graph.nodes[first]["at"], ahead, -1.0)
        taxiways = {data["taxiway"] for _, _, data in graph.edges(data=True)}
        for name in via:
            if name not in taxiways and name not in graph:
                nearest = library.nearest(name, sorted(taxiways))
                raise ScenarioError(f"{self._icao} has no taxiway {name!r}{nearest}")
        names = _shortest_way(graph, first, [last], via, behind)
        if names is None:
            through = f" via {', '.join(via)}" if via else ""
            raise ScenarioError(
                f"there is no taxi route from {first!r} to {last!r}{through} at {self._icao}"
            )
        points = [graph.nodes[name]["at"] for name in names]
        points = self._attach(points[::-1], end)[::-1]
        return self._attach(points, start)

    def at(self, name: str) -> Local:
        """Return where a node is.

        Raises
        ------
        ScenarioError
            There is none; the message gives the nearest.
        """
        if name not in self.nodes:
            nearest = library.nearest(name, sorted(self.nodes))
            raise ScenarioError(f"{self._icao} has no taxiway node {name!r}{nearest}")
        return self.nodes[name]

    def to_centreline(self, hold: str, runway: str) -> list[str]:
        """Return the nodes from a hold to the centre line of the runway that it protects.

        Raises
        ------
        ScenarioError
            No taxiway leads there.
        """
        centreline = self._strips[runway].centreline
        protected = networkx.subgraph_view(
            self._graph, filter_edge=lambda a, b: runway in self._graph.edges[a, b]["inside"]
        )
        lengths, ways = networkx.single_source_dijkstra(protected, hold, weight="cost")
        reached = [
            (lengths[name], name)
            for name in ways
            if centreline.distance(Point(self.nodes[name])) <= ON_CENTRELINE_M
        ]
        if not reached:
            raise ScenarioError(
                f"no taxiway of {self._icao} leads from hold {hold!r} on to runway {runway}"
            )
        return list(ways[min(reached)[1]])

    def across(self, hold: str, runway: str, holds: Sequence[str]) -> list[str] | None:
        """Return the nodes from a hold across its runway to the nearest on the other side, or None.

        ``holds`` are the names of all holds of that runway.
        """
        centreline = self._strips[runway].centreline
        protected = networkx.subgraph_view(
            self._graph, filter_edge=lambda a, b: runway in self._graph.edges[a, b]["inside"]
        )
        lengths, ways = networkx.single_source_dijkstra(protected, hold, weight="cost")
        beyond = [
            (lengths[name], name)
            for name in holds
            if name in ways and centreline.crosses(LineString([self.nodes[hold], self.nodes[name]]))
        ]
        return list(ways[min(beyond)[1]]) if beyond else None

    def away(self, inside: str, hold: str, stands: Sequence[str]) -> list[str]:
        """Return nodes from a hold away from its runway, on whose side is the node ``inside``.

        They lead to the nearest stand that is reached without entering a runway, or else as
        straight on as the taxiways go.
        """
        outside = networkx.subgraph_view(
            self._graph, filter_edge=lambda a, b: not self._graph.edges[a, b]["inside"]
        )
        if to_stand := _shortest_way(outside, hold, stands, before=self.nodes[inside]):
            return to_stand
        way, before = [hold], inside
        while nexts := [name for name in outside[way[-1]] if name not in way]:
            here = self.nodes[way[-1]]
            turns = {
                name: abs(lines.turn(self.nodes[before], here, self.nodes[name])) for name in nexts
            }
            before = way[-1]
            way.append(min(turns, key=lambda name: (turns[name], name)))
        return way

    def _connect(self, graph: networkx.Graph, a: str, b: str, taxiway: str) -> None:
        leg = LineString([graph.nodes[a]["at"], graph.nodes[b]["at"]])
        inside = {
            strip.name: leg.intersection(strip.protected_area).length
            for strip in self._strips.values()
        }
        graph.add_edge(
            a,
            b,
            taxiway=taxiway,
            cost=leg.length + (RUNWAY_COST - 1.0) * max(inside.values()),
            inside={name for name, metres in inside.items() if metres > TOUCHES_M},
        )

    def _join(self, graph: networkx.Graph, where: Place | str, what: str) -> str:
        """Return the node that stands for a place, after splitting the nearest edge there."""
        if isinstance(where, str):
            self.at(where)
            return where
        at = Point(self._local_frame.to_local(where))
        legs = [
            (LineString([graph.nodes[a]["at"], graph.nodes[b]["at"]]), a, b) for a, b in graph.edges
        ]
        if not legs:
            raise ScenarioError(f"{self._icao} has no taxiways")
        leg, a, b = min(legs, key=lambda item: (item[0].distance(at), *item[1:]))
        name = f"the {what} of the route"
        for strip in self._strips.values():
            if leg.distance(at) > ON_TAXIWAY_M and strip.pavement.contains(at):
                self._join_to_runway(graph, strip, at, name)
                return name
        if leg.distance(at) > OFF_TAXIWAYS_M:
            raise ScenarioError(
                f"the {what} of the taxi route is {leg.distance(at):.0f} m from the nearest "
                f"taxiway of {self._icao}, at most {OFF_TAXIWAYS_M:.0f} m are expected"
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
        below = [node for node in along if along[node] <= here]
        above = [node for node in along if along[node] > here]
        if below:
            self._connect(graph, name, max(below, key=along.__getitem__), strip.name)
        if above:
            self._connect(graph, name, min(above, key=along.__getitem__), strip.name)

    def _attach(self, points: list[Local], where: Place | str) -> list[Local]:
        """Return a way that begins at a place, where it began at the taxiway nearest to it."""
        if isinstance(where, str):
            return points
        at = self._local_frame.to_local(where)
        on_taxiway = math.dist(at, points[0]) < ON_TAXIWAY_M and len(points) > 1
        return [at, *(points[1:] if on_taxiway else points)]


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
