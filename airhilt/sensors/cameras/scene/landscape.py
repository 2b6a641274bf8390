"""The landscape: an airport and the land about it, or the land below a flight."""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from shapely import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from airhilt.errors import CameraError
from airhilt.sensors.cameras.scene import markings, scenery
from airhilt.sensors.cameras.scene.ground import Layer, cells, ring, sheet
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.lights import airport_lights
from airhilt.sensors.cameras.scene.mesh_cache import kept_mesh
from airhilt.shapes.lights import Light
from airhilt.shapes.material import Material
from airhilt.shapes.mesh import Colour, Mesh, join, srgb
from airhilt.units import DEGREE

if TYPE_CHECKING:  # An airport brings in NetworkX, which en route nobody needs.
    from airhilt.world.surface.layout import Layout

ASPHALT = srgb(72, 74, 78)
TAXI_ASPHALT = srgb(96, 97, 99)
SHOULDER = srgb(112, 110, 104)
APRON = srgb(150, 149, 145)
RUBBER = srgb(55, 56, 60)
PAINT = srgb(222, 222, 216)
YELLOW = srgb(228, 178, 34)
GRASS = srgb(104, 122, 62)
WATER = srgb(70, 92, 104)
LAND = (srgb(96, 112, 62), srgb(78, 98, 56), srgb(112, 112, 80), srgb(128, 124, 108),
        srgb(66, 88, 54), srgb(140, 134, 120))  # fmt: skip
FIELDS = (srgb(104, 122, 66), srgb(132, 128, 80), srgb(72, 94, 56), srgb(150, 138, 96),
          srgb(88, 110, 60), srgb(56, 80, 52), srgb(122, 104, 78))  # fmt: skip
APRON_REACH_M = 48.0
STAND_M = 30.0
STAND_LINE_M = 0.15
"""Half the width of the line about a stand, in m."""
HOLD_WIDTH_M = 22.0
NEAR_M = 7000.0
FAR_M = 70_000.0
HORIZON_M = 420_000.0
CUMULUS_M = (1_200.0, 1_900.0)
"""Heights of bases and tops of the clouds about an airport, in m."""
CUMULUS_REACH_M = 16_000.0
CUMULI = 36
DEEPEST_CLOUDS_M = 1_400.0
"""Greatest height of clouds from their bases to the tops, in m: fair-weather clouds are low."""
SHADOW_REACH = 6.0
"""Greatest length of a shadow for its height: the sun is lower only for minutes."""
WET = np.float32(0.6)
"""Light of wet pavement for that of dry (J. Lekner, M. Dorf, Applied Optics 27, 1988)."""
FLOODLIGHT = 0.06
"""Light of floodlights on an apron at night, against that of a white surface in the sun."""
CLEARANCE_M = 0.2
ARC = 8
"""Number of edges for a quarter of a circle: at taxiway ends they are within 6 cm of it."""
SIGN_RED = srgb(190, 24, 28)


@dataclass(frozen=True)
class Block:
    """A body in which no camera can stand."""

    name: str
    outline: Polygon
    height_m: float


@dataclass(frozen=True)
class Landscape:
    """All that stands still.

    Attributes
    ----------
    mesh
        Its triangles, in metres east, north and up of the scene's centre at ground level.
    lights
        Points of light that are on at dusk and at night.
    blocks
        Solids that cameras must not stand in.
    """

    mesh: Mesh
    lights: tuple[Light, ...]
    blocks: tuple[Block, ...]

    def require_free(self, name: str, position_m: tuple[float, float, float]) -> None:
        """Complain about a camera that could see nothing.

        Raises
        ------
        CameraError
            It is in the ground or in a building.
        """
        east, north, up = position_m
        if not up > CLEARANCE_M:
            raise CameraError(
                f"camera {name!r} is {up:.1f} m above the ground; expected more than "
                f"{CLEARANCE_M} m: raise its height"
            )
        for block in self.blocks:
            if up < block.height_m and block.outline.covers(Point(east, north)):
                raise CameraError(
                    f"camera {name!r} is inside {block.name!r}, which is {block.height_m:.0f} m "
                    f"high: raise it above that, or move it"
                )


def airport_landscape(layout: Layout, light: Illumination, is_kept: bool = False) -> Landscape:
    """Return an airport.

    Parameters
    ----------
    is_kept
        True if its mesh is taken from the cache, or kept there for other processes.
    """
    blocks = tuple(
        Block(each.name, _polygon(each.footprint, layout), each.height_m)
        for each in layout.airport.buildings
    )
    away = _shadow_reach(light)

    detail = Detail(light.shows_deck, light.texture > 0.0, light.wet)

    def make() -> Mesh:
        return _Airport(layout, blocks, away, detail).mesh()

    mesh = kept_mesh([layout.airport.model_dump_json(), away, *detail], make) if is_kept else make()
    return Landscape(mesh, airport_lights(layout), blocks)


def open_country(light: Illumination, name: str, cloud_tops_m: float | None) -> Landscape:
    """Return land without an airport, with a layer of clouds below some height."""
    seed = _seed(name)
    layers = [
        _land(0.0, 9_000.0, 480, FIELDS, seed, "fields"),
        _land(9_000.0, 40_000.0, 420, (*FIELDS, *FIELDS, WATER), seed, "far fields"),
        _land(40_000.0, HORIZON_M, 240, (*FIELDS, *FIELDS, WATER), seed, "farthest fields"),
    ]
    parts = [sheet(layers, Polygon(), seed), _base()]
    woods = scenery.trees(scenery.scattered(300.0, 9000.0, 500, Polygon(), seed, "woods"), seed)
    if woods is not None:
        parts.append(woods)
    if cloud_tops_m is not None and light.overcast < 0.7:
        base = max(0.55 * cloud_tops_m, cloud_tops_m - DEEPEST_CLOUDS_M)
        parts.append(scenery.clouds(base, cloud_tops_m, 30_000.0, 60, seed))
    return Landscape(join(parts), (), ())


class Detail(NamedTuple):
    """Detail of an airport besides its buildings and pavements.

    Attributes
    ----------
    clouds
        True for fair-weather clouds about it.
    wear
        True for what use leaves and needs: rubber on runways, lines about stands, floodlights.
    wet
        True for pavements that rain has made darker.
    """

    clouds: bool
    wear: bool
    wet: bool


class _Airport:
    """The mesh of an airport.

    Parameters
    ----------
    away
        Way that the shadow of a height of 1 m goes, in m; None without shadows.
    """

    def __init__(
        self,
        layout: Layout,
        blocks: Sequence[Block],
        away: tuple[float, float] | None,
        detail: Detail,
    ) -> None:
        self._layout = layout
        self._airport = layout.airport
        self._plane = layout.local_frame
        self._away = away
        self._detail = detail
        self._seed = _seed(layout.airport.icao)
        to_local = layout.local_frame.to_local
        nodes = {node.name: to_local(node.place) for node in self._airport.taxiways.nodes}
        self._legs = [
            ((nodes[edge.nodes[0]], nodes[edge.nodes[1]]), edge.width_m)
            for edge in self._airport.taxiways.edges
        ]
        self._blocks = blocks
        self._runways = unary_union([strip.pavement for strip in layout.strips.values()])
        self._taxiways = unary_union(
            [LineString(leg).buffer(width / 2.0, ARC) for leg, width in self._legs]
        )
        self._apron = self._apron_area()
        waters = [_polygon(water.outline, layout) for water in self._airport.water]
        self._water = unary_union(waters)
        paved = [self._runways, self._taxiways, self._apron, *(b.outline for b in self._blocks)]
        reach = unary_union([geometry.buffer(140.0, ARC) for geometry in paved])
        self._inside = reach.buffer(160.0, ARC).buffer(-160.0, ARC)

    def mesh(self) -> Mesh:
        ground = sheet(self._layers(), self._shadows(), self._seed)
        if self._detail.wet:
            paved = np.isin(ground.material, (Material.ASPHALT, Material.CONCRETE))
            ground = replace(ground, colours=ground.colours * np.where(paved, WET, 1.0)[:, None])
        parts = [ground, _base()]
        for block in self._blocks:
            shape = scenery.tower if block.name == "Tower" else scenery.building
            parts.append(shape(block.outline, block.height_m))
        parts += list(self._furniture())
        forbidden = unary_union([self._inside, self._water])
        reach = max(math.hypot(*corner) for corner in self._inside.convex_hull.exterior.coords)
        woods = scenery.scattered(200.0, reach + 3500.0, 650, forbidden, self._seed, "woods")
        town = scenery.scattered(200.0, reach + 5000.0, 420, forbidden, self._seed, "town")
        if self._detail.clouds:
            parts.append(scenery.clouds(*CUMULUS_M, CUMULUS_REACH_M, CUMULI, self._seed))
        for found in (scenery.trees(woods, self._seed), scenery.houses(town, self._seed)):
            if found is not None:
                parts.append(found)
        return join(parts)

    # --- ground -------------------------------------------------------------------------------

    def _layers(self) -> Iterator[Layer]:
        layout = self._layout
        paint = [markings.runway_paint(strip, self._plane) for strip in layout.strips.values()]
        yield Layer(unary_union(paint), (PAINT,))
        holds = [
            mark
            for hold in layout.holds.values()
            for mark in markings.hold_lines(hold, self._plane, HOLD_WIDTH_M)
        ]
        yield Layer(unary_union(holds).intersection(self._taxiways), (YELLOW,))
        lines = markings.taxiway_lines([leg for leg, _ in self._legs])
        yield Layer(lines.difference(self._runways), (YELLOW,))
        if self._detail.wear:
            yield Layer(self._stand_lines(), (YELLOW,))
            yield Layer(self._rubber(), (RUBBER,), Material.ASPHALT)
        yield self._mottled(self._runways, ASPHALT, Material.ASPHALT, 90, 0.05, "asphalt")
        yield self._mottled(self._taxiways, TAXI_ASPHALT, Material.ASPHALT, 90, 0.05, "taxiways")
        yield Layer(self._runways.buffer(7.0, join_style="mitre"), (SHOULDER,), Material.ASPHALT)
        slabs = self._mottled(self._apron, APRON, Material.CONCRETE, 120, 0.05, "slabs")
        yield replace(slabs, glow=FLOODLIGHT if self._detail.wear else 0.0)
        yield Layer(self._taxiways.buffer(5.0, ARC), (SHOULDER,), Material.ASPHALT)
        yield Layer(self._water, (WATER,), Material.WATER)
        yield self._mottled(self._inside, GRASS, Material.GRASS, 420, 0.13, "grass")
        reach = 1.15 * max(NEAR_M, math.hypot(*np.abs(self._inside.bounds).reshape(2, 2).max(0)))
        yield _land(0.0, reach, 420, LAND, self._seed, "land")
        yield _land(reach, FAR_M, 160, LAND, self._seed, "far land")
        yield _land(FAR_M, HORIZON_M, 60, LAND[4:5], self._seed, "farthest land")

    def _mottled(
        self,
        area: BaseGeometry,
        colour: Colour,
        material: Material,
        count: int,
        mottle: float,
        name: str,
    ) -> Layer:
        """Return an area in cells that differ a little, as they do where repaired or mown."""
        reach = max(abs(bound) for bound in area.bounds) * 1.5 if not area.is_empty else 1.0
        found = cells(0.0, reach, count, self._seed, name)
        return Layer(area, (colour,), material, found, mottle)

    def _stand_lines(self) -> BaseGeometry:
        """Return the lines about stands, which aircraft keep within."""
        outlines = [
            Point(self._plane.to_local(node.place)).buffer(STAND_M, quad_segs=1).exterior
            for node in self._airport.taxiways.nodes
            if node.kind == "stand"
        ]
        return unary_union([line.buffer(STAND_LINE_M) for line in outlines])

    def _rubber(self) -> BaseGeometry:
        """Return where tyres have left rubber on runways."""
        strips = self._layout.strips.values()
        marks = [mark for strip in strips for mark in markings.rubber(strip, self._plane)]
        return unary_union(marks).intersection(self._runways)

    def _apron_area(self) -> BaseGeometry:
        stands = [
            Point(self._plane.to_local(node.place)).buffer(APRON_REACH_M, ARC)
            for node in self._airport.taxiways.nodes
            if node.kind == "stand"
        ]
        around = [block.outline.buffer(38.0, join_style="mitre") for block in self._blocks]
        joined = unary_union([*stands, *around]).buffer(60.0, ARC).buffer(-60.0, ARC)
        keep_off = unary_union(
            [strip.pavement.buffer(60.0, ARC) for strip in self._layout.strips.values()]
        )
        return joined.difference(keep_off)

    def _shadows(self) -> BaseGeometry:
        if self._away is None:
            return Polygon()
        shadows = [scenery.shadow(each.outline, each.height_m, self._away) for each in self._blocks]
        return unary_union(shadows)

    def _furniture(self) -> Iterator[Mesh]:
        """Yield the boards that stand beside holding positions."""
        for hold in self._layout.holds.values():
            east, north = self._plane.to_local(hold.place)
            sin, cos = math.sin(hold.heading_rad), math.cos(hold.heading_rad)
            yield scenery.sign(east - cos * 16.0, north + sin * 16.0, hold.heading_rad, SIGN_RED)


def casts_shadows(light: Illumination) -> bool:
    """Return whether the sun is so high and the sky so clear that things cast shadows."""
    return bool(light.sun[2] >= math.sin(math.radians(2.0)) and light.overcast <= 0.8)


def _shadow_reach(light: Illumination) -> tuple[float, float] | None:
    """Return which way the shadow of a height of 1 m goes, in m; None without shadows."""
    sun = light.sun
    if not casts_shadows(light):
        return None
    length = min(math.hypot(sun[0], sun[1]) / float(sun[2]), SHADOW_REACH)
    level = max(math.hypot(sun[0], sun[1]), 1e-6)
    return -float(sun[0]) / level * length, -float(sun[1]) / level * length


def _polygon(outline: Sequence[tuple[float, float]], layout: Layout) -> Polygon:
    """Return an area, given by latitudes and longitudes in degrees, in local metres."""
    to_local = layout.local_frame.to_local
    return Polygon([to_local((lat * DEGREE, lon * DEGREE)) for lat, lon in outline]).buffer(0.0)


def _base() -> Mesh:
    """Return a floor just below the ground, that shows through no more than hairline cracks."""
    floor = shapely.get_coordinates(Point(0.0, 0.0).buffer(NEAR_M, quad_segs=8))[:-1]
    vertices = np.column_stack((floor, np.full(len(floor), -4.0)))
    middle = np.arange(1, len(vertices) - 1)
    faces = np.column_stack((np.zeros_like(middle), middle, middle + 1))[:, ::-1]
    return Mesh.of(vertices, faces, GRASS).made_of(Material.GRASS)


def _land(
    inner_m: float, outer_m: float, count: int, colours: tuple[Colour, ...], seed: int, name: str
) -> Layer:
    found = cells(inner_m, outer_m, count, seed, name)
    return Layer(ring(inner_m, outer_m), colours, Material.FIELD, found, 0.12)


def _seed(name: str) -> int:
    return zlib.crc32(name.encode())
