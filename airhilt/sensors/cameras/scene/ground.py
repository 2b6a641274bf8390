"""The ground as one sheet of triangles: each spot belongs to the topmost thing that lies there."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely import MultiPoint, Point, Polygon
from shapely.geometry.base import BaseGeometry

from airhilt.geodesy.wgs84 import MEAN_RADIUS_M
from airhilt.shapes.material import Material
from airhilt.shapes.mesh import Colour, Floats, Mesh, join
from airhilt.sim.streams import stream

FLAT_M = 9000.0
"""Radius of the flat ground around the origin, in m; beyond it the Earth falls away."""
GRID_M = 0.01
"""Width of the grid on which corners lie, in m, so that neighbours meet exactly."""


@dataclass(frozen=True)
class Layer:
    """An area of one material and colour, or of cells that vary from one to the next.

    Attributes
    ----------
    colours
        Colours of the cells; each cell has one of them.
    cells
        Polygons that cover the area without overlap; empty if the whole area is one cell.
    mottle
        Greatest change of a cell's brightness, as a share of it.
    glow
        Light of lamps on it at night.
    """

    area: BaseGeometry
    colours: tuple[Colour, ...]
    material: Material = Material.PAINT
    cells: tuple[BaseGeometry, ...] = ()
    mottle: float = 0.0
    glow: float = 0.0


def sheet(layers: Iterable[Layer], shadows: BaseGeometry, seed: int) -> Mesh:
    """Return layers, the topmost first, as triangles that neither overlap nor leave gaps."""
    taken: BaseGeometry = Polygon()
    shapely.prepare(shadows)
    draws = stream(seed, "ground")
    pieces: list[Mesh] = []
    for layer in layers:
        area = _surfaces(layer.area)
        left = shapely.difference(area, taken, grid_size=GRID_M)
        taken = _surfaces(shapely.union(taken, area, grid_size=GRID_M))
        shapely.prepare(left)
        parts: Iterable[BaseGeometry] = (left,)
        if layer.cells:
            parts = shapely.intersection(left, np.asarray(layer.cells), grid_size=GRID_M)
        areas, looks = [], []
        for part in parts:
            if part.is_empty:
                continue
            colour = layer.colours[int(draws.integers(len(layer.colours)))]
            change = 1.0 + layer.mottle * float(draws.uniform(-1.0, 1.0))
            for piece, sunlit in _split(part, shadows):
                areas.append(piece)
                looks.append((*(share * change for share in colour), sunlit))
        pieces.append(_triangles(areas, looks, layer))
    return join(pieces)


def _surfaces(area: BaseGeometry) -> BaseGeometry:
    """Return an area without the points and lines that overlays leave where areas touch."""
    if area.geom_type != "GeometryCollection":
        return area
    parts = shapely.get_parts(area)
    return shapely.union_all(parts[shapely.get_dimensions(parts) == 2])


def _split(area: BaseGeometry, shadows: BaseGeometry) -> list[tuple[BaseGeometry, float]]:
    """Return what of an area the sun reaches, and what lies in the shadow."""
    if not shadows.intersects(area):
        return [(area, 1.0)]
    lit = shapely.difference(area, shadows, grid_size=GRID_M)
    shaded = shapely.intersection(area, shadows, grid_size=GRID_M)
    return [(part, sun) for part, sun in ((lit, 1.0), (shaded, 0.0)) if not part.is_empty]


def _triangles(
    areas: Sequence[BaseGeometry], looks: Sequence[tuple[float, ...]], layer: Layer
) -> Mesh:
    """Return areas as triangles; the looks of each are its colour and its share of sunlight."""
    parts, area = shapely.get_parts(np.asarray(areas, dtype=object), return_index=True)
    is_surface = shapely.get_dimensions(parts) == 2
    groups = shapely.constrained_delaunay_triangles(parts[is_surface])
    faces, group = shapely.get_parts(groups, return_index=True)
    flat = np.zeros((len(faces), 3, 3), dtype=np.float64)
    flat[..., :2] = shapely.get_coordinates(faces).reshape(-1, 4, 2)[:, :3]
    edges = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
    area_2 = edges[0][:, 0] * edges[1][:, 1] - edges[0][:, 1] * edges[1][:, 0]
    proper = np.abs(area_2) > 1e-3
    flat, clockwise = flat[proper], area_2[proper] < 0.0
    flat[clockwise] = flat[clockwise][:, ::-1]
    flat[..., 2] = -drop_m(np.hypot(flat[..., 0], flat[..., 1]))
    look = np.asarray(looks, dtype=np.float32).reshape(-1, 4)[area[is_surface][group[proper]]]
    count = len(flat)
    up = np.zeros((count, 3, 3), dtype=np.float32)
    up[..., 2] = 1.0
    return Mesh(
        flat.astype(np.float32),
        up,
        np.ascontiguousarray(look[:, :3]),
        np.full(count, layer.glow, dtype=np.float32),
        np.ascontiguousarray(look[:, 3]),
        np.full(count, layer.material, dtype=np.float32),
    )


def drop_m(distance_m: Floats | float) -> Floats:
    """Return how far the ground has fallen below the plane at some distance from the origin."""
    beyond = np.maximum(np.asarray(distance_m, dtype=np.float64) - FLAT_M, 0.0)
    return np.asarray(beyond * beyond / (2.0 * MEAN_RADIUS_M))


def ring(inner_m: float, outer_m: float) -> BaseGeometry:
    """Return the ground between two distances from the origin."""
    middle = Point(0.0, 0.0)
    outer = middle.buffer(outer_m, quad_segs=24)
    return outer.difference(middle.buffer(inner_m, quad_segs=24)) if inner_m > 0.0 else outer


def cells(
    inner_m: float, outer_m: float, count: int, seed: int, name: str
) -> tuple[BaseGeometry, ...]:
    """Return irregular cells that cover a ring about the origin, smaller towards its middle."""
    draws = stream(seed, name)
    part = draws.uniform(size=count)
    radii = inner_m * (outer_m / inner_m) ** part if inner_m > 0.0 else outer_m * np.sqrt(part)
    angles = draws.uniform(0.0, math.tau, size=count)
    points = MultiPoint(np.column_stack((radii * np.cos(angles), radii * np.sin(angles))))
    around = ring(0.0, outer_m)
    return tuple(shapely.get_parts(shapely.voronoi_polygons(points, extend_to=around)))
