"""Draws an airport as a diagram, north up, as SVG or PNG."""

from __future__ import annotations

import io
import math
import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import chain, permutations
from pathlib import Path
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch, Wedge
from matplotlib.patches import Polygon as PolygonPatch
from shapely import LineString, Point, Polygon, box
from shapely.geometry.base import BaseGeometry

from airhilt.errors import ScenarioError
from airhilt.units import FOOT, bearing_degrees
from airhilt.world.surface import path as lines
from airhilt.world.surface.airport import Airport, Role
from airhilt.world.surface.layout import Layout
from airhilt.world.surface.path import Leg, Local
from airhilt.world.surface.runway import RunwayEnd
from airhilt.world.surface.strips import RunwayStrip

MAP_PT = 1000.0
"""Length of the longer side of the map, in points of 1/72 in."""
NARROWEST_PT = 860.0
"""Least width of the sheet, in points: the header and the legend need it."""
HEADER_PT, FOOTER_PT = 84.0, 64.0
"""Height of what stands above the map and below it, in points."""
MARGIN_M = 220.0
"""Ground shown around everything that is drawn, in m."""
SHORT_TAXIWAY_PT = 70.0
"""A taxiway that is not longer, in points, has its letter beyond its end: its hold is seen."""
NAMED_LEGS = 5
"""Number of legs of a taxiway, the longest, on which or beside which its name may stand."""
LABELLED_AREA_M2 = 4000.0
"""Buildings smaller than this are named only when pointed at."""
NARROW_RUNWAY_PT = 9.0
"""A runway drawn narrower than this, in points, has no room for numbers on it."""
CAMERA_REACH_PT = 26.0
"""Length of the wedge that shows where a camera looks, in points."""
VHF_KHZ = (117_975, 137_000)
"""The aeronautical mobile band, in kHz: ICAO Annex 10 volume V, 4.1."""
SHOWN_ROLES: tuple[Role, ...] = ("tower", "ground", "clearance", "approach", "departure", "atis")

Style = dict[str, Any]
"""Arguments of matplotlib."""
INK, RUNWAY, PINK = "#1b2a36", "#3b444c", "#d6336c"
PROTECTED: Style = {
    "facecolor": "#d6336c0d",
    "edgecolor": "#d6336cb3",
    "linestyle": (0, (5, 4)),
    "lw": 0.8,
}
CROSSING: Style = {"fill": False, "edgecolor": PINK, "linewidth": 1.6}
CAMERA: Style = {"facecolor": "#6741d94d", "edgecolor": "#6741d9", "linewidth": 0.6}
HOLD: Style = {"color": "#c92a2a", "linewidth": 2.4, "solid_capstyle": "butt"}
TOWER: Style = {"color": "#1864ab", "marker": "^", "markersize": 11.0, "markeredgecolor": "white"}
STAND: Style = {"color": "#2b8a3e", "marker": "o", "markersize": 5.0, "markeredgewidth": 0.0}
PLATE: Style = {"boxstyle": "round,pad=0.25", "facecolor": "#1b1b1b", "edgecolor": "#f5c518"}
ON_RUNWAY: Style = {"facecolor": RUNWAY, "edgecolor": "none", "pad": 0.5}
STYLE: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "airport",
    "font.size": 9.5,
    "text.color": INK,
}
DARK = "<style>@media (prefers-color-scheme: dark) { svg { filter: invert(1) hue-rotate(180deg) } }"
POINTED_AT = re.compile(r"<g id=([\"'])shown (.*?)\1>")
"""Group of an SVG that has a name; the name is shown when the group is pointed at."""


def draw(layout: Layout, path: Path) -> Path:
    """Write the diagram of an airport; the name of the file says whether as SVG or PNG.

    Raises
    ------
    ScenarioError
        The name ends otherwise, or the file cannot be written.
    """
    kind, stream = path.suffix.lower(), io.BytesIO()
    if kind not in (".svg", ".png"):
        raise ScenarioError(f"{path}: expected a name that ends in .svg or .png")
    with rc_context(STYLE):
        figure = _Diagram(layout).figure
        title = f"{layout.airport.name} ({layout.airport.icao})"
        if kind == ".svg":
            figure.savefig(stream, format="svg", metadata={"Date": None, "Title": title})
            named = POINTED_AT.sub(r"<g><title>\2</title>", stream.getvalue().decode())
            content = named.replace("<style ", f"{DARK}</style>\n  <style ", 1).encode()
        else:
            figure.savefig(stream, format="png", dpi=144, metadata={"Title": title})
            content = stream.getvalue()
    try:
        path.write_bytes(content)
    except OSError as error:
        raise ScenarioError(f"{path}: cannot be written: {error.strerror}") from error
    return path


class _Diagram:
    """The diagram of one airport: a map in local metres, and what stands beside it."""

    def __init__(self, layout: Layout) -> None:
        self._layout = layout
        self._taken: list[BaseGeometry] = []
        """Areas, in local metres, that no further name may hide."""
        self._buildings = [
            (building.name, Polygon(layout.outline(building.footprint)))
            for building in layout.airport.buildings
        ]
        east, north = zip(*self._extent(), strict=True)
        wide_m = max(east) - min(east) + 2.0 * MARGIN_M
        high_m = max(north) - min(north) + 2.0 * MARGIN_M
        self._point_m = max(wide_m, high_m) / MAP_PT
        """Length of a point on the map, in m."""
        wide_m = max(wide_m, NARROWEST_PT * self._point_m)
        self._width = wide_m / self._point_m
        self._height = HEADER_PT + high_m / self._point_m + FOOTER_PT
        self.figure = Figure((self._width / 72.0, self._height / 72.0), dpi=72)
        west, south = (max(east) + min(east) - wide_m) / 2.0, min(north) - MARGIN_M
        self._window = box(west, south, west + wide_m, south + high_m)
        self._map = self.figure.add_axes(
            (0.0, FOOTER_PT / self._height, 1.0, 1.0 - (HEADER_PT + FOOTER_PT) / self._height),
            facecolor="#eef1e6",
            xlim=(west, west + wide_m),
            ylim=(south, south + high_m),
            xticks=(),
            yticks=(),
        )
        self._draw_ground()
        for strip in layout.strips.values():
            self._draw_runway(strip)
        self._draw_marks()
        for strip in layout.strips.values():
            self._name_runway(strip)
        self._name_taxiways()
        self._draw_margin()

    def _extent(self) -> Iterator[Local]:
        yield from self._layout.taxiways.nodes.values()
        for strip in self._layout.strips.values():
            yield from strip.centreline.coords
        for _, building in self._buildings:
            yield from building.exterior.coords

    # --- shapes ---------------------------------------------------------------------------

    def _patch(self, patch: Patch, name: str) -> None:
        patch.set(gid=f"shown {name}", zorder=self._layer)
        self._map.add_patch(patch)

    def _area(self, shape: Polygon, name: str, style: Style) -> None:
        self._patch(PolygonPatch(list(shape.exterior.coords), **style), name)

    def _line(self, points: Sequence[Local], name: str = "", **style: Any) -> None:
        gid = f"shown {name}" if name else None
        self._map.plot(*zip(*points, strict=True), gid=gid, zorder=self._layer, **style)

    def _text(self, at: Local, words: str, turn_deg: float = 0.0, **style: Any) -> None:
        style |= {"ha": "center", "va": "center", "rotation_mode": "anchor", "clip_on": True}
        self._map.text(at[0], at[1], words, rotation=turn_deg, zorder=self._layer, **style)

    @property
    def _layer(self) -> int:
        """Place of the next shape: above all that are drawn."""
        return len(self._map.get_children())

    def _draw_ground(self) -> None:
        layout = self._layout
        for water in layout.airport.water:
            shape = Polygon(layout.outline(water.outline))
            self._area(shape, water.name, {"facecolor": "#bcd9ec"})
            visible = shape.buffer(0.0).intersection(self._window)
            if not visible.is_empty:
                at, half_m = visible.representative_point(), 4.5 * len(water.name) * self._point_m
                west, _, east, _ = self._window.bounds
                place = min(max(at.x, west + half_m), east - half_m), at.y
                self._text(place, water.name, style="italic", color="#2f6690", fontsize=13)
        for strip in layout.strips.values():
            self._area(strip.protected_area, f"protected area of {strip.name}", PROTECTED)
        for edge in layout.airport.taxiways.edges:
            width_pt = max(edge.width_m / self._point_m, 2.5)
            ends = layout.leg(edge)
            self._line(ends, color="#aab2b9", linewidth=width_pt, solid_capstyle="round")
        for edge in layout.airport.taxiways.edges:
            self._line(layout.leg(edge), color="#e0a800", linewidth=0.7)

    def _draw_runway(self, strip: RunwayStrip) -> None:
        self._area(strip.pavement, strip.name, {"facecolor": RUNWAY})
        dashes: Style = {"linewidth": 0.9, "linestyle": (0, (10, 8))}
        self._line(strip.centreline.coords, color="white", **dashes)
        for end in strip.ends:
            threshold = self._layout.local_frame.to_local(end.threshold)
            ahead = self._ahead(end)
            across, half_m = (-ahead[1], ahead[0]), end.width_m / 2.0
            bar = [lines.step(threshold, across, side * half_m) for side in (-1, 1)]
            self._line(bar, color="white", linewidth=2.0, solid_capstyle="butt")
            if end.displaced_m:
                tip = lines.step(threshold, ahead, -6.0 * self._point_m)
                back = lines.step(tip, ahead, -6.0 * self._point_m)
                wings = [lines.step(back, across, side * half_m) for side in (-1, 1)]
                self._line((wings[0], tip, wings[1]), color="white", linewidth=1.2)

    def _draw_marks(self) -> None:
        layout, airport = self._layout, self._layout.airport
        for hold in layout.holds.values():
            ends = layout.hold_line(hold, least_half_m=5.0 * self._point_m)
            self._line(ends, f"hold {hold.name}", **HOLD)
            self._taken.append(LineString(ends).buffer(2.0 * self._point_m))
        for first, second, at in layout.intersections:
            self._taken.append(self._box(at, 18.0, 18.0))
            circle = Circle(at, 9.0 * self._point_m, **CROSSING)
            self._patch(circle, f"{first} crosses {second}")
        for name in layout.stands:
            self._line([layout.taxiways.nodes[name]], name, **STAND)
        for name, shape in self._buildings:
            self._area(shape, name, {"facecolor": "#8d7f76", "edgecolor": "#5f544d"})
        self._taken += [shape for _, shape in self._buildings]
        for name, shape in self._buildings:
            if shape.area > LABELLED_AREA_M2:
                self._name_building(name, shape)
        if airport.tower is not None:
            self._line([layout.local_frame.to_local(airport.tower.place)], "tower", **TOWER)
        for camera in airport.cameras:
            at, half = layout.local_frame.to_local(camera.place), camera.horizontal_fov_deg / 2.0
            middle, reach_m = 90.0 - camera.azimuth_deg, CAMERA_REACH_PT * self._point_m
            view = Wedge(at, reach_m, middle - half, middle + half, **CAMERA)
            self._patch(view, camera.name)

    # --- names ----------------------------------------------------------------------------

    def _name_building(self, name: str, shape: Polygon) -> None:
        """Write the name of a building next to it, where there is room."""
        west, south, east, north = shape.bounds
        x, y = (west + east) / 2.0, (south + north) / 2.0
        half_m, point = 3.0 * len(name) * self._point_m, self._point_m
        spots = (
            (west - half_m - 6.0 * point, y),
            (x, south - 9.0 * point),
            (x, north + 8.0 * point),
            (east + half_m + 6.0 * point, y),
        )
        self._text(self._free(spots, 2.0 * half_m / point, 11.0), name)

    def _name_runway(self, strip: RunwayStrip) -> None:
        """Write the number and the course of both ends of a runway, and its size."""
        has_room = strip.ends[0].width_m / self._point_m >= NARROW_RUNWAY_PT
        white: Style = {"color": "white", "fontsize": 9, "bbox": ON_RUNWAY}
        for end in strip.ends:
            start, ahead = self._layout.local_frame.to_local(end.start), self._ahead(end)
            at, bearing = lines.step(start, ahead, -14.0 * self._point_m), _bearing_deg(ahead)
            self._taken.append(self._box(at, 26.0, 20.0))
            self._text(at, end.ident, -bearing, fontsize=17, weight="bold")
            if has_room:
                course = f"{bearing_degrees(end.course_rad):05.1f}°"
                along = lines.step(start, ahead, 62.0 * self._point_m)
                self._text(along, course, _upright_deg(bearing), **white)
        if has_room:
            size = f"{strip.ends[0].length_m:.0f} × {strip.ends[0].width_m:.0f} m"
            line = strip.centreline
            spots = [line.interpolate(part, normalized=True) for part in (0.3, 0.5, 0.7, 0.4, 0.6)]
            at = self._free([(spot.x, spot.y) for spot in spots], 40.0, 40.0)
            self._text(at, size, _upright_deg(_bearing_deg(self._ahead(strip.ends[0]))), **white)

    def _name_taxiways(self) -> None:
        self._taken += [strip.pavement for strip in self._layout.strips.values()]
        taxiways: dict[str, list[Leg]] = defaultdict(list)
        for edge in self._layout.airport.taxiways.edges:
            taxiways[edge.taxiway].append(self._layout.leg(edge))
        for name, legs in taxiways.items():
            if name == "ramp":
                continue
            legs.sort(key=lambda leg: -math.dist(*leg))
            width = 7.5 * len(name) + 6.0
            spots = [
                lines.between(a, b, part)
                for a, b in legs[:NAMED_LEGS]
                for part in (0.5, 0.3, 0.7, 0.1, 0.9)
            ]
            spots += [
                lines.step(at, side, (width / 2.0 + 8.0) * self._point_m)
                for at in spots
                for side in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))
            ]
            if sum(math.dist(*leg) for leg in legs) < SHORT_TAXIWAY_PT * self._point_m:
                away_m = (width / 2.0 + 6.0) * self._point_m
                spots = [*self._beyond(legs, away_m), *spots]
            style: Style = {"color": "#f5c518", "fontsize": 10, "weight": "bold", "bbox": PLATE}
            self._text(self._free(spots, width, 14.0), name, **style)

    def _beyond(self, legs: Sequence[Leg], away_m: float) -> list[Local]:
        """Return points beyond both ends of a short taxiway, the one farther from runways first."""
        ends = max(permutations(chain(*legs), 2), key=lambda pair: math.dist(*pair))
        spots = [lines.step(at, lines.unit(other, at), away_m) for at, other in permutations(ends)]
        runways = [strip.centreline for strip in self._layout.strips.values()]
        return sorted(spots, key=lambda at: -min(line.distance(Point(at)) for line in runways))

    def _free(self, spots: Sequence[Local], width_pt: float, height_pt: float) -> Local:
        """Take the first spot at which a name hides nothing, or that at which it hides least."""

        def hidden_m2(at: Local) -> float:
            name = self._box(at, width_pt, height_pt)
            return sum(float(name.intersection(o).area) for o in self._taken if name.intersects(o))

        best = next((at for at in spots if not hidden_m2(at)), None) or min(spots, key=hidden_m2)
        self._taken.append(self._box(best, width_pt, height_pt))
        return best

    def _box(self, at: Local, width_pt: float, height_pt: float) -> Polygon:
        (x, y), half_x, half_y = at, width_pt * self._point_m / 2.0, height_pt * self._point_m / 2.0
        return box(x - half_x, y - half_y, x + half_x, y + half_y)

    def _ahead(self, end: RunwayEnd) -> Local:
        to_local = self._layout.local_frame.to_local
        return lines.unit(to_local(end.start), to_local(end.end))

    # --- beside the map -------------------------------------------------------------------

    def _draw_margin(self) -> None:
        """Write header and legend, and draw the scale and the directions of north."""
        airport, layout = self._layout.airport, self._layout
        variation = airport.magnetic_variation
        facts = (
            f"elevation {airport.elevation_ft:.0f} ft ({airport.elevation_ft * FOOT:.0f} m) · "
            f"variation {_variation(variation.east_deg)} ({variation.epoch:.1f}) · "
            f"{len(layout.strips)} runways, {len(layout.holds)} holds"
        )
        self._note(self._height - 26.0, f"{airport.icao}  {airport.name}", 20, weight="bold")
        self._note(self._height - 48.0, facts, 12)
        self._note(self._height - 68.0, _frequencies(airport), 10.5)
        invented = sorted(block for block, source in airport.sources.items() if source.synthetic)
        if invented:
            blocks = ", ".join(invented)
            self._note(
                12.0, f"Not surveyed, drawn or generated: {blocks}. Not for navigation.", 9.5
            )
        self._draw_scale()
        self._draw_north(variation.east_deg)
        marks = {
            "hold line": Line2D([], [], **HOLD),
            "protected area": Patch(**PROTECTED),
            "intersection": Line2D(
                [], [], marker="o", fillstyle="none", color=PINK, markersize=10.0, linestyle="none"
            ),
            "tower": Line2D([], [], linestyle="none", **TOWER),
            "camera": Line2D([], [], linestyle="none", marker=(3, 0, 80), ms=12.0, c="#6741d980"),
            "stand": Line2D([], [], linestyle="none", **STAND),
        }
        self.figure.legend(
            marks.values(),
            marks,
            loc="center left",
            bbox_to_anchor=self._sheet(max(self._width / 3.0, 240.0), 42.0),
            ncols=len(marks),
            handlelength=1.4,
            frameon=False,
        )

    def _draw_scale(self) -> None:
        longest_m = self._width / 4.0 * self._point_m
        metres = next(each for each in (2000, 1000, 500, 200, 100) if each <= longest_m)
        left, right = 16.0, 16.0 + metres / self._point_m
        corners = [self._sheet(x, y) for x, y in ((left, 45), (left, 40), (right, 40), (right, 45))]
        self.figure.add_artist(Line2D(*zip(*corners, strict=True), color=INK, linewidth=1.4))
        self._note(28.0, f"{metres} m, {metres / FOOT:.0f} ft", 9.5)

    def _draw_north(self, variation_deg: float) -> None:
        """Draw an arrow to true north, and a dashed line to magnetic north."""
        x, y = self._width - 40.0, self._height - HEADER_PT - 62.0
        declination = math.radians(variation_deg)
        magnetic = x + 56.0 * math.sin(declination), y + 56.0 * math.cos(declination)
        line: Style = {"color": INK, "relpos": (0.5, 1.0), "shrinkA": 0.0, "shrinkB": 0.0}
        for words, tip, kind in (
            ("N", (x, y + 42.0), {"arrowstyle": "-|>", "mutation_scale": 16.0, "linewidth": 2.0}),
            (f"\nvar. {_variation(variation_deg)}", magnetic, {"arrowstyle": "-", "ls": "--"}),
        ):
            self._map.annotate(
                words,
                xy=self._sheet(*tip),
                xytext=self._sheet(x, y),
                xycoords="figure fraction",
                ha="center",
                va="top",
                fontsize=10,
                arrowprops=line | kind,
                zorder=self._layer,
            )

    def _note(self, y_pt: float, words: str, size_pt: float, **style: Any) -> None:
        self.figure.text(*self._sheet(16.0, y_pt), words, va="center", fontsize=size_pt, **style)

    def _sheet(self, x_pt: float, y_pt: float) -> Local:
        """Return a point of the sheet, from its lower left corner, as shares of its size."""
        return x_pt / self._width, y_pt / self._height


def _frequencies(airport: Airport) -> str:
    by_role = defaultdict(list)
    for item in airport.frequencies:
        if VHF_KHZ[0] <= item.frequency_khz <= VHF_KHZ[1]:
            by_role[item.role].append(f"{item.frequency_khz / 1000.0:g}")
    return " · ".join(
        f"{'ATIS' if role == 'atis' else role} {' '.join(by_role[role][:2])}"
        for role in SHOWN_ROLES
        if role in by_role
    )


def _variation(east_deg: float) -> str:
    return f"{abs(east_deg):.1f}° {'E' if east_deg >= 0.0 else 'W'}"


def _bearing_deg(direction: Local) -> float:
    return math.degrees(math.atan2(*direction))


def _upright_deg(bearing_deg: float) -> float:
    """Return the turn of a text along a line, which is not upside down."""
    return (90.0 - bearing_deg + 90.0) % 180.0 - 90.0
