"""Invents the taxiways, holds, stands and cameras of an airport of which only runways are known."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations, pairwise

import networkx
from shapely import LineString, Point, Polygon

from airhilt.errors import ScenarioError
from airhilt.world.surface import path as lines
from airhilt.world.surface.airport import Camera, ReferencePoint, Runway
from airhilt.world.surface.draft import Draft
from airhilt.world.surface.path import Local
from airhilt.world.surface.strips import RunwayStrip

LETTERS = "ABCDEFGHJKLMNPQRSTUVWYZ"
"""Taxiway designators: no I, O or X (ICAO Annex 14 volume I, 5.4.3.36)."""
TAXIWAY_WIDTH_M = 23.0
"""Width of taxiways, in m (ICAO Annex 14 volume I, 3.9.4, code letters E and F)."""
BEHIND_HOLD_M = 46.0
"""Distance from the hold line to the parallel taxiway, in m: 76 m + 46 m are the 400 ft of FAA AC
150/5300-13B."""
END_M = 20.0
"""Distance from the end of the pavement to the centre line of the connector there, in m."""
SEARCH_STEP_M = 20.0
BETWEEN_CONNECTORS_M = 600.0
MARGIN_M = 5.0
"""Distance of taxiways from the protected areas of runways that they do not serve, in m."""
BETWEEN_HOLDS_M = 60.0
"""Least distance between two runways that one taxiway crosses, in m: an aircraft fits there."""
FLATTEST_CROSSING = 4.0
"""Greatest length of a crossing over a runway, in hold distances: about 30 degrees."""
CROSSING_COST_M = 3000.0
STAND_COUNT, STAND_SPACING_M, STAND_DEPTH_M = 8, 80.0, 75.0
APRON_CLEARANCE_M = 120.0
APRON_STEP_M, APRON_REACH_M = 50, 5000
CAMERA_BEHIND_HOLD_M = 15.0
BETTER_ACROSS_M = 100.0
"""A connector lies on the other side of the runway if that is so much nearer to the end, in m."""
GAP_COST_M = 6000.0
"""Cost of a gap in a parallel taxiway, in m."""
DETOUR, DETOUR_M = 3.0, 800.0
"""A way longer than `DETOUR` times a straight leg and `DETOUR_M` more gets that leg."""


@dataclass(frozen=True)
class Apron:
    """Stands, terminal and tower around a taxiway."""

    at: Local
    """Middle of the taxiway."""
    along: Local
    away: Local
    """Unit vectors along the taxiway, and from it to the stands and the terminal."""

    def point(self, along_m: float, away_m: float) -> Local:
        """Return a point along the taxiway and away from it."""
        return lines.step(lines.step(self.at, self.along, along_m), self.away, away_m)

    def _block(self, half_length_m: float, near_m: float, far_m: float) -> tuple[Local, ...]:
        corners = ((-1, near_m), (1, near_m), (1, far_m), (-1, far_m))
        return tuple(self.point(side * half_length_m, away_m) for side, away_m in corners)

    @property
    def terminal(self) -> tuple[Local, ...]:
        """Corners of the terminal."""
        return self._block(STAND_COUNT * STAND_SPACING_M / 2.0, 110.0, 150.0)

    @property
    def outline(self) -> Polygon:
        """Ground that the apron covers."""
        return Polygon(self._block(STAND_COUNT * STAND_SPACING_M / 2.0 + 20.0, 5.0, 170.0))


@dataclass(frozen=True)
class _Crossing:
    """Piece of a leg over a runway, by distance along the leg."""

    begin_m: float
    end_m: float
    at: Local
    runway: str


class TaxiwayPlan:
    """Invents the taxiways of an airport, around an apron that lies between its runways."""

    def __init__(self, reference: ReferencePoint, runways: tuple[Runway, ...]) -> None:
        self.draft = Draft(reference, runways, TAXIWAY_WIDTH_M)
        self.strips = self.draft.strips
        self.apron = self._find_apron()
        self._joined = networkx.Graph()
        self._sides: dict[str, int] = {}
        self._draw_apron()
        for letter, strip in zip(LETTERS, self.strips.values(), strict=False):
            self._draw_parallel(letter, strip)
        self._join_all()

    def cameras(self, tower_height_m: float) -> tuple[Camera, ...]:
        """Return cameras on the tower and at each runway end."""
        tower = self.apron.point(0.0, 130.0)
        compass = {"north": 0.0, "east": 90.0, "south": 180.0, "west": 270.0}
        return (
            *(
                self.draft.camera(f"tower_{name}", tower, tower_height_m + 2.0, azimuth)
                for name, azimuth in compass.items()
            ),
            *(
                camera
                for name, side in self._sides.items()
                for camera in self.draft.runway_cameras(
                    name, side * (self.strips[name].hold_distance_m + CAMERA_BEHIND_HOLD_M)
                )
            ),
        )

    # --- apron ----------------------------------------------------------------------------

    def _find_apron(self) -> Apron:
        """Return the clear place for an apron that is nearest to the middle of the airport."""
        for radius_m in range(0, APRON_REACH_M, APRON_STEP_M):
            for angle in (math.tau * part / 24.0 for part in range(24 if radius_m else 1)):
                apron = self._apron_at((radius_m * math.sin(angle), radius_m * math.cos(angle)))
                if all(
                    strip.protected_area.distance(apron.outline) >= APRON_CLEARANCE_M
                    for strip in self.strips.values()
                ):
                    return apron
        raise ScenarioError("the runways leave no place for an apron between or beside them")

    def _apron_at(self, at: Local) -> Apron:
        """Return an apron beside the nearest runway, turned away from it."""
        here = Point(at)
        line = min(
            self.strips.values(), key=lambda strip: strip.centreline.distance(here)
        ).centreline
        along = lines.unit(*line.coords)
        right = (along[1], -along[0])
        start = line.coords[0]
        on_right = (at[0] - start[0]) * right[0] + (at[1] - start[1]) * right[1] >= 0.0
        return Apron(at, along, right if on_right else (-right[0], -right[1]))

    def _draw_apron(self) -> None:
        names = []
        for number in range(1, STAND_COUNT + 1):
            along = (number - (STAND_COUNT + 1) / 2.0) * STAND_SPACING_M
            joint = self._joint(f"Z/{number}", self.apron.point(along, 0.0))
            stand = self.draft.node(
                f"stand_{number}", self.apron.point(along, STAND_DEPTH_M), "stand"
            )
            self.draft.taxiway("ramp", joint, stand)
            names.append(joint)
        for a, b in pairwise(names):
            self._draw_leg("Z", a, b)

    # --- parallel taxiways ----------------------------------------------------------------

    def _draw_parallel(self, letter: str, strip: RunwayStrip) -> None:
        """Draw the taxiway beside a runway, on the side where it crosses least."""
        sides = {side: self._connectors(strip, side) for side in (1, -1)}
        side = min(sides, key=lambda side: self._side_cost(strip, side, sides[side]))
        self._sides[strip.name] = side
        connectors = [(along, side) for along in sides[side]]
        for end in (END_M, strip.centreline.length - END_M):
            reached = min((abs(along - end) for along, _ in connectors), default=math.inf)
            other = min(sides[-side], key=lambda along: abs(along - end), default=math.inf)
            if abs(other - end) + BETTER_ACROSS_M < reached:
                connectors.append((other, -side))
        joints = {}
        for number, (along, here) in enumerate(sorted(connectors), start=1):
            name = f"{letter}{number}"
            joint = self._joint(
                f"{letter}/{name}", self.draft.beside(strip.name, along, here * self._offset(strip))
            )
            runway = self.draft.node(
                f"{strip.name} at {name}", self.draft.beside(strip.name, along, 0.0), "runway"
            )
            self.draft.entrance(name, joint, runway, strip.name)
            joints[joint] = here
        for a, b in pairwise(joint for joint, here in joints.items() if here == side):
            self._draw_leg(letter, a, b)

    def _connectors(self, strip: RunwayStrip, side: int) -> list[float]:
        """Return where connectors can be: at both ends, or near, and at intervals between."""
        length = strip.centreline.length
        inner = range(1, int((length - 2.0 * END_M) / SEARCH_STEP_M))
        grid = [END_M, *(END_M + step * SEARCH_STEP_M for step in inner), length - END_M]
        possible = [along for along in grid if self._is_clear(strip, along, side)]
        count = max(2, round(length / BETWEEN_CONNECTORS_M))
        wanted = (END_M + part * (length - 2.0 * END_M) / count for part in range(count + 1))
        chosen = {min(possible, key=lambda along: abs(along - at)) for at in wanted if possible}
        return sorted(chosen)

    def _is_clear(self, strip: RunwayStrip, along: float, side: int) -> bool:
        connector = LineString(
            [
                self.draft.beside(strip.name, along, 0.0),
                self.draft.beside(strip.name, along, side * self._offset(strip)),
            ]
        )
        return all(
            other.protected_area.distance(connector) >= MARGIN_M
            for other in self.strips.values()
            if other is not strip
        )

    def _side_cost(self, strip: RunwayStrip, side: int, connectors: list[float]) -> float:
        if not connectors:
            return math.inf
        at = [
            self.draft.beside(strip.name, along, side * self._offset(strip)) for along in connectors
        ]
        short = connectors[0] + float(strip.centreline.length) - connectors[-1]
        to_apron = math.dist(at[len(at) // 2], self.apron.at)
        legs = (self._cost(a, b) for a, b in pairwise(at))
        return short + to_apron + sum(min(cost, GAP_COST_M) for cost in legs)

    @staticmethod
    def _offset(strip: RunwayStrip) -> float:
        return float(strip.hold_distance_m + BEHIND_HOLD_M)

    # --- legs -----------------------------------------------------------------------------

    def _joint(self, name: str, at: Local) -> str:
        self._joined.add_node(name)
        return self.draft.node(name, at, "junction")

    def _join_all(self) -> None:
        """Join what is not joined yet, by the cheapest legs, and shorten the longest ways."""
        at = self.draft.at
        legs = sorted(
            (cost, a, b)
            for a, b in combinations(sorted(self._joined), 2)
            if (cost := self._cost(at[a], at[b])) < math.inf
        )
        count = 0
        for cost, a, b in legs:
            if networkx.has_path(self._joined, a, b):
                way = networkx.shortest_path_length(self._joined, a, b, weight="cost")
                if way < DETOUR * cost + DETOUR_M:
                    continue
            count += 1
            self._draw_leg(f"Y{count}", a, b)
        if not networkx.is_connected(self._joined):
            raise ScenarioError("the runways leave no way to join their taxiways")

    def _cost(self, a: Local, b: Local) -> float:
        crossings = self._crossings(a, b)
        if crossings is None:
            return math.inf
        # To the millimetre, so that rounding does not decide between two legs of one length.
        return round(math.dist(a, b) + CROSSING_COST_M * len(crossings), 3)

    def _crossings(self, a: Local, b: Local) -> list[_Crossing] | None:
        """Return the runways that a leg goes over, or None if no taxiway can lie there."""
        leg = LineString([a, b])
        if leg.intersects(self.apron.outline):
            return None
        found = []
        for strip in self.strips.values():
            if strip.protected_area.distance(leg) >= MARGIN_M:
                continue
            inside = leg.intersection(strip.protected_area)
            at = leg.intersection(strip.centreline)
            if (
                at.geom_type != "Point"
                or at.is_empty
                or inside.length > FLATTEST_CROSSING * strip.hold_distance_m
            ):
                return None
            begin, end = sorted(leg.project(Point(corner)) for corner in inside.coords)
            found.append(_Crossing(begin, end, (at.x, at.y), strip.name))
        found.sort(key=lambda crossing: crossing.begin_m)
        ends = [0.0, *(crossing.end_m for crossing in found)]
        begins = [*(crossing.begin_m for crossing in found), leg.length]
        gaps = [begin - end for end, begin in zip(ends, begins, strict=True)]
        if found and (
            min(gaps[0], gaps[-1]) < MARGIN_M or min(gaps[1:-1], default=math.inf) < BETWEEN_HOLDS_M
        ):
            return None
        return found

    def _draw_leg(self, taxiway: str, a: str, b: str) -> None:
        """Draw a leg with the holds of the runways it goes over; nothing where none can lie."""
        at = self.draft.at
        crossings = self._crossings(at[a], at[b])
        if crossings is None:
            return
        self._joined.add_edge(a, b, cost=self._cost(at[a], at[b]))
        ahead, before = lines.unit(at[a], at[b]), a
        if not crossings:
            self.draft.taxiway(taxiway, a, b)
            return
        for crossing, following in zip(crossings, [*crossings[1:], None], strict=True):
            runway = self.draft.node(f"{crossing.runway} at {taxiway}", crossing.at, "runway")
            after = b
            if following is not None:
                middle = (crossing.end_m + following.begin_m) / 2.0
                after = self.draft.node(
                    f"{taxiway} before {following.runway}",
                    lines.step(at[a], ahead, middle),
                    "junction",
                )
            back = (-ahead[0], -ahead[1])
            self.draft.entrance(taxiway, before, runway, crossing.runway, _compass(back))
            self.draft.entrance(taxiway, after, runway, crossing.runway, _compass(ahead))
            before = after


def _compass(direction: Local) -> str:
    """Return the cardinal direction nearest to a vector."""
    east, north = direction
    if abs(north) >= abs(east):
        return "north" if north > 0.0 else "south"
    return "east" if east > 0.0 else "west"
