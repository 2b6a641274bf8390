"""Draws an airport as a diagram: SVG, or PNG where resvg-py is installed."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, permutations
from pathlib import Path
from xml.sax.saxutils import escape

from shapely import LineString, Point, Polygon, box

from airhilt.errors import ScenarioError
from airhilt.units import FOOT, bearing_degrees
from airhilt.world.surface import path as lines
from airhilt.world.surface.airport import Camera, Edge, Frequency, Role
from airhilt.world.surface.layout import Hold, Layout, RunwayStrip
from airhilt.world.surface.path import Local

MAP_PX = 1000.0
"""Of the longer side of the map."""
NARROWEST_PX = 860.0
MARGIN_M = 220.0
HEADER_PX, FOOTER_PX = 84.0, 64.0
SHORT_TAXIWAY_PX = 70.0
"""A taxiway that is not longer has its letter past its end, so that its hold is seen."""
CAMERA_REACH_PX = 26.0
VHF_KHZ = (117_975, 137_000)
"""The aeronautical mobile band: ICAO Annex 10 volume V, 4.1."""
LABELLED_AREA_M2 = 4000.0
"""Smaller buildings are named only when pointed at."""
SHOWN_ROLES: tuple[Role, ...] = ("tower", "ground", "clearance", "approach", "departure", "atis")

STYLE = """
text { font-family: 'DejaVu Sans', Verdana, Arial, sans-serif; fill: #1b2a36; }
.page { fill: #ffffff; } .land { fill: #eef1e6; } .water { fill: #bcd9ec; }
.protected { fill: #d6336c; fill-opacity: 0.05; stroke: #d6336c; stroke-width: 0.8;
  stroke-dasharray: 5 4; stroke-opacity: 0.7; }
.taxiway { stroke: #aab2b9; fill: none; stroke-linecap: round; }
.guide { stroke: #e0a800; fill: none; stroke-width: 0.7; }
.runway { fill: #3b444c; } .marking { stroke: #ffffff; fill: none; }
.hold { stroke: #c92a2a; stroke-width: 2.4; }
.building { fill: #8d7f76; stroke: #5f544d; stroke-width: 0.6; }
.tower { fill: #1864ab; stroke: #ffffff; stroke-width: 1; }
.camera { fill: #6741d9; fill-opacity: 0.3; stroke: #6741d9; stroke-width: 0.6; }
.stand { fill: #2b8a3e; } .crossing { fill: none; stroke: #d6336c; stroke-width: 1.6; }
.ident { font-size: 17px; font-weight: bold; } .small { font-size: 9.5px; }
.onrunway { font-size: 9px; fill: #ffffff; stroke: #3b444c; stroke-width: 3;
  paint-order: stroke; }
.title { font-size: 20px; font-weight: bold; }
.line { font-size: 12px; } .plate { fill: #1b1b1b; stroke: #f5c518; stroke-width: 0.8; }
.letter { font-size: 10px; font-weight: bold; fill: #f5c518; }
.ink { stroke: #1b2a36; stroke-width: 1.4; fill: none; } .solid { fill: #1b2a36; }
.name { font-style: italic; fill: #2f6690; font-size: 13px; }
@media (prefers-color-scheme: dark) {
  text { fill: #dfe7ee; } .page { fill: #14191d; } .land { fill: #20272b; }
  .water { fill: #16384f; } .taxiway { stroke: #5a646c; } .runway { fill: #0b0e10; }
  .runway { stroke: #8a959d; stroke-width: 0.6; } .building { fill: #6d625b; stroke: #a0948c; }
  .ink { stroke: #dfe7ee; } .solid { fill: #dfe7ee; } .name { fill: #8fc1e3; }
  .camera { fill: #b197fc; stroke: #b197fc; } .hold { stroke: #ff6b6b; }
  .protected { fill: #f783ac; stroke: #f783ac; } .stand { fill: #69db7c; }
  .onrunway { fill: #ffffff; stroke: #0b0e10; } .letter { fill: #f5c518; }
}
"""


def draw(layout: Layout, path: Path) -> Path:
    """Write the diagram of an airport as SVG or PNG, as the name of the file says.

    Raises
    ------
    ScenarioError
        The name ends otherwise, the file cannot be written, or PNG is asked for and resvg-py is
        not installed.
    """
    document = as_svg(layout)
    if path.suffix.lower() == ".svg":
        content = document.encode()
    elif path.suffix.lower() == ".png":
        content = _as_png(document)
    else:
        raise ScenarioError(f"{path}: expected a name that ends in .svg or .png")
    try:
        path.write_bytes(content)
    except OSError as error:
        raise ScenarioError(f"{path}: cannot be written: {error.strerror}") from error
    return path


def as_svg(layout: Layout) -> str:
    """Return the diagram of an airport, north up, as an SVG document."""
    return _Sheet(layout).document()


def _as_png(document: str) -> bytes:
    try:
        from resvg_py import svg_to_bytes
    except ImportError:
        raise ScenarioError(
            "PNG needs resvg-py: pip install 'airhilt[plot]', or write an .svg"
        ) from None
    return bytes(svg_to_bytes(svg_string=document, zoom=2.0))


@dataclass(frozen=True)
class _View:
    """From local metres to pixels."""

    west: float
    north: float
    scale: float

    def __call__(self, point: Local) -> Local:
        return (
            round((point[0] - self.west) * self.scale, 1),
            round((self.north - point[1]) * self.scale + HEADER_PX, 1),
        )


class _Sheet:
    """One diagram while it is drawn."""

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        self.airport = layout.airport
        west, south, east, north = self._extent()
        self.scale = MAP_PX / max(east - west, north - south)
        self.width = max((east - west) * self.scale, NARROWEST_PX)
        centre = (east + west) / 2.0
        self.height = (north - south) * self.scale
        self.view = _View(centre - self.width / self.scale / 2.0, north, self.scale)
        self.labels: list[Polygon] = []

    def document(self) -> str:
        """Return the whole SVG."""
        total = HEADER_PX + self.height + FOOTER_PX
        size = f'width="{self.width:.0f}" height="{total:.0f}"'
        parts = chain(
            self._ground(),
            self._taxiways(),
            *(self._runway(strip) for strip in self.layout.strips.values()),
            self._holds(),
            self._buildings(),
            self._cameras(),
            *(self._idents(strip) for strip in self.layout.strips.values()),
            self._letters(),
            self._frame(total),
        )
        return "\n".join(
            [
                f'<svg xmlns="http://www.w3.org/2000/svg" {size} '
                f'viewBox="0 0 {self.width:.0f} {total:.0f}" role="img">',
                f"<title>{escape(self.airport.name)} ({self.airport.icao})</title>",
                f"<style>{STYLE}</style>",
                *parts,
                "</svg>\n",
            ]
        )

    # --- layers ---------------------------------------------------------------------------

    def _ground(self) -> Iterator[str]:
        yield '<rect class="page" width="100%" height="100%"/>'
        clip = f'<rect x="0" y="{HEADER_PX}" width="{self.width:.0f}" height="{self.height:.0f}"/>'
        yield f'<clipPath id="map">{clip}</clipPath>'
        yield clip.replace("<rect", '<rect class="land"')
        window = box(0.0, HEADER_PX, self.width, HEADER_PX + self.height)
        for water in self.airport.water:
            outline = [self._pixel(point) for point in water.outline]
            yield self._area("water", outline, water.name, ' clip-path="url(#map)"')
            visible = Polygon(outline).buffer(0.0).intersection(window)
            if not visible.is_empty:
                at, half = visible.representative_point(), 4.5 * len(water.name)
                x = min(max(at.x, half), self.width - half)
                yield _text("name", (x, at.y), water.name)
        for strip in self.layout.strips.values():
            outline = [self.view(point) for point in strip.protected_area.exterior.coords]
            yield self._area("protected", outline, f"protected area of {strip.name}")

    def _taxiways(self) -> Iterator[str]:
        legs = [(edge, *self._leg(edge)) for edge in self.airport.taxiways.edges]
        for edge, a, b in legs:
            width = max(edge.width_m * self.scale, 2.5)
            yield _line("taxiway", a, b, f' style="stroke-width:{width:.1f}"')
        for _, a, b in legs:
            yield _line("guide", a, b)
        for name in self.layout.stands:
            at = self.view(self.layout.frame.to_local(self.layout.node(name)))
            yield f'<circle class="stand" cx="{at[0]}" cy="{at[1]}" r="3">{_title(name)}</circle>'

    def _runway(self, strip: RunwayStrip) -> Iterator[str]:
        outline = [self.view(point) for point in strip.pavement.exterior.coords]
        yield self._area("runway", outline, strip.name)
        a, b = (self.view(point) for point in strip.centreline.coords)
        yield _line("marking", a, b, ' style="stroke-width:0.9" stroke-dasharray="9 7"')
        for end in strip.ends:
            threshold = self.view(self.layout.frame.to_local(end.threshold))
            start, far = (
                self.view(self.layout.frame.to_local(place)) for place in (end.start, end.end)
            )
            ahead = lines.unit(start, far)
            across = (-ahead[1], ahead[0])
            half = end.width_m * self.scale / 2.0
            bar = lines.step(threshold, across, -half), lines.step(threshold, across, half)
            yield _line("marking", *bar, ' style="stroke-width:2"')
            if end.displaced_m:
                tip = lines.step(threshold, ahead, -6.0)
                wings = (
                    lines.step(lines.step(tip, ahead, -6.0), across, s * half) for s in (-1, 1)
                )
                for wing in wings:
                    yield _line("marking", tip, wing, ' style="stroke-width:1.2"')

    def _holds(self) -> Iterator[str]:
        for hold in self.layout.holds.values():
            a, b = (self.view(point) for point in self._hold_line(hold))
            tail = f">{_title(f'hold {hold.name}')}</line>"
            yield _line("hold", a, b).replace("/>", tail)
        for first, second, at in self.layout.intersections:
            x, y = self.view(at)
            title = _title(f"{first} crosses {second}")
            yield f'<circle class="crossing" cx="{x}" cy="{y}" r="9">{title}</circle>'

    def _buildings(self) -> Iterator[str]:
        shapes = [
            (building.name, Polygon([self._pixel(point) for point in building.footprint]))
            for building in self.airport.buildings
        ]
        for name, shape in shapes:
            yield self._area("building", list(shape.exterior.coords), name)
        self.labels.extend(shape for _, shape in shapes)
        for name, shape in shapes:
            if shape.area > LABELLED_AREA_M2 * self.scale**2:
                yield from self._beside(name, shape)
        if tower := self.airport.tower:
            x, y = self.view(self.layout.frame.to_local(tower.place))
            star = f"{x},{y - 9} {x + 6},{y + 5} {x - 6},{y + 5}"
            yield f'<polygon class="tower" points="{star}">{_title("tower")}</polygon>'

    def _cameras(self) -> Iterator[str]:
        for camera in self.airport.cameras:
            points = " ".join(f"{x:.1f},{y:.1f}" for x, y in self._wedge(camera))
            yield f'<polygon class="camera" points="{points}">{_title(camera.name)}</polygon>'

    def _idents(self, strip: RunwayStrip) -> Iterator[str]:
        for end in strip.ends:
            start, far = (
                self.view(self.layout.frame.to_local(place)) for place in (end.start, end.end)
            )
            ahead = lines.unit(start, far)
            turn = math.degrees(math.atan2(ahead[0], -ahead[1]))
            at = lines.step(start, ahead, -14.0)
            self.labels.append(_box(at, 26.0, 20.0))
            yield _text("ident", at, end.ident, turn)
            course = f"{bearing_degrees(end.course_rad):05.1f}°"
            place = lines.step(start, ahead, 62.0)
            turn = (turn + 90.0) % 180.0 - 90.0
            if end.width_m * self.scale >= 9.0:
                yield _text("onrunway", place, course, turn - 90.0 if turn > 0 else turn + 90.0)
        yield from self._size(strip)

    def _size(self, strip: RunwayStrip) -> Iterator[str]:
        end = strip.ends[0]
        start, far = (self.view(point) for point in strip.centreline.coords)
        if end.width_m * self.scale < 9.0:
            return
        ahead = lines.unit(start, far)
        turn = math.degrees(math.atan2(ahead[1], ahead[0]))
        turn = (turn + 90.0) % 180.0 - 90.0
        text = f"{end.length_m:.0f} × {end.width_m:.0f} m"
        crossings = [
            self.view(at) for *names, at in self.layout.intersections if strip.name in names
        ]
        spots = [lines.between(start, far, part) for part in (0.3, 0.5, 0.7, 0.4, 0.6)]
        free = (at for at in spots if all(math.dist(at, other) > 60.0 for other in crossings))
        yield _text("onrunway", next(free, spots[0]), text, turn)

    def _letters(self) -> Iterator[str]:
        legs = defaultdict(list)
        for edge in self.airport.taxiways.edges:
            if edge.taxiway != "ramp":
                legs[edge.taxiway].append(self._leg(edge))
        for name, own in legs.items():
            own.sort(key=lambda leg: -math.dist(*leg))
            width = 7.5 * len(name) + 6.0
            spots = [
                lines.between(a, b, part) for a, b in own for part in (0.5, 0.3, 0.7, 0.1, 0.9)
            ]
            if sum(math.dist(*leg) for leg in own) < SHORT_TAXIWAY_PX:
                spots = [*self._beyond(own, width / 2.0 + 6.0), *spots]
            free = (at for at in spots if not self._is_taken(_box(at, width, 14.0)))
            x, y = next(free, spots[0])
            self.labels.append(_box((x, y), width, 14.0))
            yield (
                f'<rect class="plate" x="{x - width / 2:.1f}" y="{y - 7:.1f}" '
                f'width="{width:.1f}" height="14" rx="2"/>'
            )
            yield _text("letter", (x, y), name)

    def _frame(self, total: float) -> Iterator[str]:
        airport = self.airport
        variation = airport.magnetic_variation
        side = "E" if variation.east_deg >= 0.0 else "W"
        yield _text("title", (16.0, 26.0), f"{airport.icao}  {airport.name}", anchor="start")
        facts = (
            f"elevation {airport.elevation_ft:.0f} ft ({airport.elevation_ft * FOOT:.0f} m) · "
            f"variation {abs(variation.east_deg):.1f}° {side} ({variation.epoch:.1f}) · "
            f"{len(self.layout.strips)} runways, {len(self.layout.holds)} holds"
        )
        yield _text("line", (16.0, 48.0), facts, anchor="start")
        yield _text("line", (16.0, 68.0), _frequencies(airport.frequencies), anchor="start")
        yield from self._north_arrow()
        yield from self._scale_bar(total)
        yield from self._legend(total)

    def _north_arrow(self) -> Iterator[str]:
        x, y = self.width - 40.0, HEADER_PX + 62.0
        yield f'<polygon class="solid" points="{x},{y - 42} {x + 7},{y} {x},{y - 9} {x - 7},{y}"/>'
        yield _text("line", (x, y + 11.0), "N")
        declination = math.radians(self.airport.magnetic_variation.east_deg)
        tip = x + 44.0 * math.sin(declination), y - 44.0 * math.cos(declination)
        yield _line("ink", (x, y), tip, ' stroke-dasharray="3 2"')

    def _scale_bar(self, total: float) -> Iterator[str]:
        metres = next(m for m in (2000, 1000, 500, 200, 100) if m * self.scale <= self.width / 4.0)
        x, y = 16.0, total - 40.0
        right = x + metres * self.scale
        yield f'<path class="ink" d="M{x} {y - 5}V{y}H{right:.1f}V{y - 5}"/>'
        yield _text("small", (right + 6.0, y - 2.0), f"{metres} m", anchor="start")
        feet = metres / FOOT
        yield _text("small", (x, y + 12.0), f"{feet:.0f} ft", anchor="start")

    def _legend(self, total: float) -> Iterator[str]:
        x, y = max(self.width / 3.0, 240.0), total - 42.0
        entries = (
            ('<line class="hold" x1="0" y1="0" x2="14" y2="0"/>', "hold line"),
            ('<rect class="protected" x="0" y="-5" width="14" height="10"/>', "protected area"),
            ('<circle class="crossing" cx="7" cy="0" r="5"/>', "intersection"),
            ('<polygon class="tower" points="7,-7 12,5 2,5"/>', "tower"),
            ('<polygon class="camera" points="0,5 14,0 10,9"/>', "camera"),
            ('<circle class="stand" cx="7" cy="0" r="3"/>', "stand"),
        )
        for symbol, name in entries:
            yield f'<g transform="translate({x:.1f} {y:.1f})">{symbol}</g>'
            yield _text("small", (x + 18.0, y), name, anchor="start")
            x += 28.0 + 6.2 * len(name)
        invented = sorted(
            block for block, source in self.airport.sources.items() if source.synthetic
        )
        if invented:
            note = f"Not surveyed, drawn or generated: {', '.join(invented)}. Not for navigation."
            yield _text("small", (16.0, total - 12.0), note, anchor="start")

    # --- geometry -------------------------------------------------------------------------

    def _extent(self) -> tuple[float, float, float, float]:
        frame, airport = self.layout.frame, self.airport
        points = [
            point for strip in self.layout.strips.values() for point in strip.centreline.coords
        ]
        points += [frame.to_local(node.place) for node in airport.taxiways.nodes]
        points += [self._local(point) for item in airport.buildings for point in item.footprint]
        east, north = zip(*points, strict=True)
        return (
            min(east) - MARGIN_M,
            min(north) - MARGIN_M,
            max(east) + MARGIN_M,
            max(north) + MARGIN_M,
        )

    def _local(self, point: tuple[float, float]) -> Local:
        return self.layout.frame.to_local((math.radians(point[0]), math.radians(point[1])))

    def _pixel(self, point: tuple[float, float]) -> Local:
        return self.view(self._local(point))

    def _beyond(self, legs: Sequence[tuple[Local, Local]], away_px: float) -> list[Local]:
        """Return points past both ends of a short taxiway, the one farther from runways first."""
        ends = max(
            ((a, b) for a, b in permutations(chain(*legs), 2)), key=lambda pair: math.dist(*pair)
        )
        spots = [lines.step(at, lines.unit(other, at), away_px) for at, other in permutations(ends)]
        runways = [
            LineString([self.view(point) for point in strip.centreline.coords])
            for strip in self.layout.strips.values()
        ]
        return sorted(spots, key=lambda at: -min(line.distance(Point(at)) for line in runways))

    def _leg(self, edge: Edge) -> tuple[Local, Local]:
        a, b = (self.layout.frame.to_local(self.layout.node(name)) for name in edge.nodes)
        return self.view(a), self.view(b)

    def _hold_line(self, hold: Hold) -> tuple[Local, Local]:
        """Return a line along the edge of the protected area, across the taxiway."""
        at = self.layout.frame.to_local(hold.place)
        a, b = self.layout.strips[hold.runway].centreline.coords
        ahead = lines.unit(a, b)
        half = max(16.0, 5.0 / self.scale)
        return lines.step(at, ahead, -half), lines.step(at, ahead, half)

    def _wedge(self, camera: Camera) -> list[Local]:
        at = self.view(self.layout.frame.to_local(camera.place))
        spread = (-0.5, -0.25, 0.0, 0.25, 0.5)
        angles = [
            math.radians(camera.azimuth_deg + part * camera.horizontal_fov_deg) for part in spread
        ]
        rim = [
            (at[0] + CAMERA_REACH_PX * math.sin(a), at[1] - CAMERA_REACH_PX * math.cos(a))
            for a in angles
        ]
        return [at, *rim]

    def _beside(self, name: str, shape: Polygon) -> Iterator[str]:
        """Write the name of a building next to it, where there is room."""
        west, north, east, south = shape.bounds
        middle_x, middle_y = (west + east) / 2.0, (north + south) / 2.0
        half = 3.2 * len(name)
        spots = (
            (west - half - 6.0, middle_y),
            (middle_x, south + 9.0),
            (middle_x, north - 8.0),
            (east + half + 6.0, middle_y),
        )
        free = (at for at in spots if not self._is_taken(_box(at, 2.0 * half, 11.0)))
        at = next(free, spots[0])
        self.labels.append(_box(at, 2.0 * half, 11.0))
        yield _text("small", at, name)

    def _is_taken(self, label: Polygon) -> bool:
        return any(label.intersects(other) for other in self.labels)

    @staticmethod
    def _area(style: str, outline: Sequence[Local], name: str, more: str = "") -> str:
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in outline)
        return f'<polygon class="{style}" points="{points}"{more}>{_title(name)}</polygon>'


def _frequencies(frequencies: Sequence[Frequency]) -> str:
    by_role = defaultdict(list)
    for item in frequencies:
        if VHF_KHZ[0] <= item.frequency_khz <= VHF_KHZ[1]:
            by_role[item.role].append(f"{item.frequency_khz / 1000.0:g}")
    return " · ".join(
        f"{'ATIS' if role == 'atis' else role} {' '.join(by_role[role][:2])}"
        for role in SHOWN_ROLES
        if role in by_role
    )


def _box(at: Local, width: float, height: float) -> Polygon:
    x, y = at
    return box(x - width / 2.0, y - height / 2.0, x + width / 2.0, y + height / 2.0)


def _title(text: str) -> str:
    return f"<title>{escape(text)}</title>"


def _line(style: str, a: Local, b: Local, more: str = "") -> str:
    return (
        f'<line class="{style}" x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" '
        f'y2="{b[1]:.1f}"{more}/>'
    )


def _text(style: str, at: Local, text: str, turn_deg: float = 0.0, anchor: str = "middle") -> str:
    turn = f' transform="rotate({turn_deg:.1f} {at[0]:.1f} {at[1]:.1f})"' if turn_deg else ""
    return (
        f'<text class="{style}" x="{at[0]:.1f}" y="{at[1]:.1f}" text-anchor="{anchor}" '
        f'dominant-baseline="central"{turn}>{escape(text)}</text>'
    )
