"""Scenery: buildings, the tower, trees, houses and clouds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import shapely
import shapely.affinity
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from airhilt.sensors.cameras.scene.ground import drop_m
from airhilt.shapes.material import Material
from airhilt.shapes.mesh import Colour, Mesh, box, join, loft, srgb
from airhilt.sim.streams import stream

CONCRETE = srgb(196, 192, 184)
PLASTER = srgb(214, 208, 196)
ROOF = srgb(142, 142, 144)
WINDOW = srgb(74, 72, 70)
TOWER_WHITE = srgb(224, 224, 220)
TREE_GREENS = (srgb(52, 80, 40), srgb(66, 92, 44), srgb(44, 70, 42), srgb(84, 100, 52))
HOUSES = (srgb(170, 150, 130), srgb(190, 184, 172), srgb(150, 110, 92), srgb(204, 200, 196))
CLOUD = srgb(246, 247, 250)
CLOUD_KINDS, CLOUD_SIDES = 8, 8
NARROWEST_CLOUD_M, WIDEST_CLOUD_M = 250.0, 900.0
LIGHT_THROUGH_CLOUD = 0.8
STOREY_M = 4.5
LIT_WINDOW = 3.0
"""Light from windows at night, against their reflectance."""


def building(outline: Polygon, height_m: float) -> Mesh:
    """Return a block with bands of windows and plant on its roof."""
    walls = _walls(shapely.geometry.polygon.orient(outline), 0.0, height_m, PLASTER)
    parts = [walls, _roof(outline, height_m, ROOF)]
    storeys = max(int(height_m // STOREY_M), 1)
    wider = shapely.geometry.polygon.orient(outline.buffer(0.12, join_style="mitre"))
    for number in range(storeys):
        low = number * height_m / storeys + 1.3
        band = _walls(wider, low, low + 1.9, WINDOW)
        parts.append(replace(band, glow=np.full(len(band), LIT_WINDOW, dtype=np.float32)))
    middle = outline.representative_point()
    plant = box(CONCRETE, 8.0, 8.0, 2.5).moved(middle.x, middle.y, height_m)
    if outline.buffer(-6.0).contains(middle):
        parts.append(plant)
    return join(parts).made_of(Material.WALL)


def tower(outline: Polygon, height_m: float) -> Mesh:
    """Return a control tower: a shaft that ends in a cab of slanting glass."""
    middle = outline.centroid
    half = 0.5 * math.sqrt(outline.area)
    ring = partial(_ring, 8, math.pi / 8.0)
    cab = height_m - 7.0
    parts = [
        loft([ring(0.62 * half, 0.0), ring(0.5 * half, cab - 5.0)], TOWER_WHITE, closed=True),
        loft([ring(0.5 * half, cab - 5.0), ring(half, cab - 1.0), ring(half, cab)], CONCRETE,
             closed=True),
        loft([ring(0.9 * half, cab), ring(half, cab + 3.6)], WINDOW, closed=True),
        loft([ring(1.04 * half, cab + 3.6), ring(0.8 * half, cab + 4.8)], CONCRETE,
             closed=True),
    ]  # fmt: skip
    return join(parts).moved(middle.x, middle.y).made_of(Material.WALL)


def _ring(corners: int, turn: float, radius: float, up: float) -> list[tuple[float, float, float]]:
    angles = np.linspace(0.0, math.tau, corners, endpoint=False) + turn
    return [(radius * math.cos(a), radius * math.sin(a), up) for a in angles]


def trees(places: Sequence[tuple[float, float]], seed: int) -> Mesh | None:
    """Return trees at places: round ones and pointed ones."""
    draws = stream(seed, "trees")
    kinds = [_tree(colour, pointed) for colour in TREE_GREENS for pointed in (False, True)]
    found = []
    for east, north in places:
        size = float(draws.uniform(6.0, 13.0))
        kind = kinds[int(draws.integers(len(kinds)))]
        wide = size * float(draws.uniform(0.6, 1.0))
        low = -float(drop_m(math.hypot(east, north)))
        found.append(kind.stretched(wide, wide, size).moved(east, north, low))
    return join(found).made_of(Material.FOLIAGE) if found else None


def _tree(colour: Colour, pointed: bool) -> Mesh:
    ring = partial(_ring, 5, 0.0)
    if pointed:
        return loft([ring(0.28, 0.08), ring(0.02, 1.0)], colour, crease_rad=1.0)
    return loft([ring(0.22, 0.0), ring(0.5, 0.45), ring(0.2, 1.0)], colour)


def houses(places: Sequence[tuple[float, float]], seed: int) -> Mesh | None:
    """Return low houses at places, a few of them tall."""
    draws = stream(seed, "houses")
    kinds = {colour: _without_floor(box(colour, 1.0, 1.0, 1.0)) for colour in HOUSES}
    found = []
    for east, north in places:
        colour = HOUSES[int(draws.integers(len(HOUSES)))]
        tall = draws.uniform() < 0.12
        height = float(draws.uniform(22.0, 48.0) if tall else draws.uniform(5.0, 14.0))
        size = draws.uniform(12.0, 36.0, size=2)
        block = kinds[colour].stretched(float(size[0]), float(size[1]), height)
        turn = float(draws.uniform(0.0, math.pi))
        low = -float(drop_m(math.hypot(east, north)))
        found.append(_turned(block, turn).moved(east, north, low))
    return join(found).made_of(Material.WALL) if found else None


def _without_floor(mesh: Mesh) -> Mesh:
    """Return what stands on the ground without what nobody sees."""
    return mesh.part(mesh.face_normals[:, 2] > -0.5)


def clouds(base_m: float, tops_m: float, reach_m: float, count: int, seed: int) -> Mesh:
    """Return fair-weather cumulus: flat bases at one height, and heaps on them up to another."""
    draws = stream(seed, "clouds")
    kinds = [_cumulus(draws) for _ in range(CLOUD_KINDS)]
    found = []
    for _ in range(count):
        distance = reach_m * math.sqrt(float(draws.uniform(0.002, 1.0)))
        angle, turn = draws.uniform(0.0, math.tau, size=2)
        east, north = distance * math.sin(angle), distance * math.cos(angle)
        tall = (tops_m - base_m) * float(draws.uniform(0.35, 1.0))
        wide = min(max(tall, NARROWEST_CLOUD_M), WIDEST_CLOUD_M) * float(draws.uniform(1.0, 2.2))
        kind = kinds[int(draws.integers(len(kinds)))].stretched(wide, wide, tall)
        low = base_m - float(drop_m(distance))
        found.append(_turned(kind, turn).moved(east, north, low))
    return join(found).made_of(Material.CLOUD)


def _cumulus(draws: np.random.Generator) -> Mesh:
    """Return a heap of puffs about 2 wide and 1 high, cut off flat below.

    Light goes through: all sides but the base are lit as if they looked up a little more.
    """
    found = []
    for number in range(int(draws.integers(10, 14))):
        is_low = number % 2 == 0
        spread = (0.5, 0.32) if is_low else (0.26, 0.18)
        right, ahead = (float(place) for place in draws.normal(size=2) * spread)
        inward = math.exp(-2.0 * (right**2 + ahead**2))
        size = float(draws.uniform(0.24, 0.36)) * (0.55 + 0.55 * inward)
        up = 0.3 * size if is_low else inward * float(draws.uniform(0.2, 0.5))
        angles = np.linspace(0.0, math.tau, CLOUD_SIDES, endpoint=False) + number
        rings = [
            np.column_stack((
                right + size * math.cos(latitude) * np.cos(angles),
                ahead + size * math.cos(latitude) * np.sin(angles),
                np.full(CLOUD_SIDES, max(up + size * math.sin(latitude), 0.0)),
            ))
            for latitude in np.radians((-45.0, -5.0, 30.0, 60.0, 82.0))
        ]  # fmt: skip
        found.append(loft(rings, CLOUD, closed=True, crease_rad=math.radians(80.0)))
    heap = join(found)
    heap = heap.stretched(1.0, 1.0, 1.0 / float(heap.corners[..., 2].max()))
    normals = heap.normals + np.array((0.0, 0.0, LIGHT_THROUGH_CLOUD), dtype=np.float32)
    return replace(heap, normals=normals / np.linalg.norm(normals, axis=2, keepdims=True))


def scattered(
    inner_m: float, outer_m: float, count: int, forbidden: BaseGeometry, seed: int, name: str
) -> list[tuple[float, float]]:
    """Return places about the origin, in clumps, that are not forbidden."""
    draws = stream(seed, name)
    places: list[tuple[float, float]] = []
    shapely.prepare(forbidden)
    while len(places) < count:
        distance = inner_m + (outer_m - inner_m) * float(draws.uniform()) ** 1.3
        angle = float(draws.uniform(0.0, math.tau))
        clump = draws.normal(size=(9, 2)) * 38.0
        for offset in clump:
            east = distance * math.sin(angle) + float(offset[0])
            north = distance * math.cos(angle) + float(offset[1])
            if not shapely.intersects_xy(forbidden, east, north):
                places.append((east, north))
    return places[:count]


def sign(east: float, north: float, heading_rad: float, colour: Colour) -> Mesh:
    """Return a board beside a taxiway that faces traffic of some heading."""
    board = box(colour, 2.4, 0.3, 0.9).moved(up_m=0.5)
    return _turned(board, -heading_rad).moved(east, north)


def _turned(mesh: Mesh, turn_rad: float) -> Mesh:
    sin, cos = math.sin(turn_rad), math.cos(turn_rad)
    return mesh.turned(((cos, -sin, 0), (sin, cos, 0), (0, 0, 1)))


def _walls(outline: Polygon, low_m: float, high_m: float, colour: Colour) -> Mesh:
    ring = np.asarray(outline.exterior.coords)[:-1]
    count = len(ring)
    low = np.column_stack((ring, np.full(count, low_m)))
    high = np.column_stack((ring, np.full(count, high_m)))
    here = np.arange(count)
    onward = (here + 1) % count
    faces = np.vstack((
        np.column_stack((here, onward, count + onward)),
        np.column_stack((here, count + onward, count + here)),
    ))  # fmt: skip
    return Mesh.of(np.vstack((low, high)), faces, colour)


def _roof(outline: Polygon, height_m: float, colour: Colour) -> Mesh:
    ring = np.asarray(shapely.convex_hull(outline).exterior.coords)[:-1]
    if shapely.convex_hull(outline).area > 1.02 * outline.area:
        pieces = shapely.get_parts(shapely.constrained_delaunay_triangles(outline))
        rings = [np.asarray(shapely.geometry.polygon.orient(p).exterior.coords)[:3] for p in pieces]
        points = np.vstack(rings)
        faces = np.arange(len(points)).reshape(-1, 3)
    else:
        points = np.asarray(shapely.geometry.polygon.orient(Polygon(ring)).exterior.coords)[:-1]
        middle = np.arange(1, len(points) - 1)
        faces = np.column_stack((np.zeros_like(middle), middle, middle + 1))
    vertices = np.column_stack((points[:, :2], np.full(len(points), height_m)))
    return Mesh.of(vertices, faces, colour)


def shadow(outline: BaseGeometry, height_m: float, away: tuple[float, float]) -> BaseGeometry:
    """Return the ground in the shadow of a block; ``away`` is metres of shadow a metre high."""
    moved = shapely.affinity.translate(outline, away[0] * height_m, away[1] * height_m)
    return shapely.union(outline, moved).convex_hull
