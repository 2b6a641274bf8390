"""Triangles with colours, and the solids from which all bodies in pictures are made.

Axes of a body: x to the right, y ahead, z up, in metres. Colours are linear RGB reflectances.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from airhilt.shapes.material import Material

Floats = npt.NDArray[np.float32]
Colour = tuple[float, float, float]
Paint = Callable[[Floats], Floats]
"""Returns colours for the centres of triangles."""

CREASE_RAD = math.radians(40.0)
"""Faces that meet at a sharper angle than this keep their edge."""


def srgb(red: int, green: int, blue: int) -> Colour:
    """Return an 8-bit sRGB colour as linear light (IEC 61966-2-1)."""
    red_, green_, blue_ = (_linear(value / 255.0) for value in (red, green, blue))
    return red_, green_, blue_


def _linear(value: float) -> float:
    return value / 12.92 if value <= 0.04045 else float(((value + 0.055) / 1.055) ** 2.4)


@dataclass(frozen=True)
class Mesh:
    """Triangles that share no corners."""

    corners: Floats
    normals: Floats
    """Corners of each triangle and normals there, shape (n, 3, 3)."""
    colours: Floats
    """Colour of each triangle, shape (n, 3)."""
    glow: Floats
    """Light that each triangle gives off at night, times its colour; shape (n,)."""
    sunlit: Floats
    """Share of the direct sun that reaches each triangle, shape (n,)."""
    material: Floats
    """Number of the `Material` of each triangle, shape (n,)."""

    @property
    def arrays(self) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """All arrays, in the order of the attributes."""
        return self.corners, self.normals, self.colours, self.glow, self.sunlit, self.material

    def __len__(self) -> int:
        return len(self.corners)

    @classmethod
    def of(
        cls,
        vertices: npt.ArrayLike,
        triangles: npt.ArrayLike,
        colour: Colour | Floats,
        *,
        crease_rad: float = CREASE_RAD,
        glow: float = 0.0,
    ) -> Mesh:
        """Return triangles given by the numbers of their vertices.

        Normals are smooth across edges blunter than ``crease_rad``; the colour is that of all, or
        one for each.
        """
        points = np.asarray(vertices, dtype=np.float32)
        faces = np.asarray(triangles, dtype=np.int64).reshape(-1, 3)
        corners = points[faces]
        across = _cross(corners)
        proper = np.linalg.norm(across, axis=1) > 1e-10
        faces, corners, across = faces[proper], corners[proper], across[proper]
        colours = np.broadcast_to(np.asarray(colour, dtype=np.float32), (len(proper), 3))[proper]
        ones = np.ones(len(faces), dtype=np.float32)
        normals = _smooth(points, faces, across, crease_rad)
        return cls(corners, normals, colours, glow * ones, ones, float(Material.PAINT) * ones)

    def part(self, wanted: npt.NDArray[np.bool_]) -> Mesh:
        """Return those triangles for which ``wanted`` is true."""
        return Mesh(*(array[wanted] for array in self.arrays))

    def moved(self, right_m: float = 0.0, ahead_m: float = 0.0, up_m: float = 0.0) -> Mesh:
        """Return the mesh moved by an offset."""
        offset = np.array((right_m, ahead_m, up_m), dtype=np.float32)
        return replace(self, corners=self.corners + offset)

    def turned(self, rotation: npt.ArrayLike) -> Mesh:
        """Return the mesh turned by a rotation matrix."""
        matrix = np.asarray(rotation, dtype=np.float32)
        return replace(self, corners=self.corners @ matrix.T, normals=self.normals @ matrix.T)

    def stretched(self, right: float, ahead: float, up: float) -> Mesh:
        """Return the mesh stretched along its axes."""
        factors = np.array((right, ahead, up), dtype=np.float32)
        normals = self.normals / factors
        normals /= np.linalg.norm(normals, axis=2, keepdims=True)
        return replace(self, corners=self.corners * factors, normals=normals)

    def mirrored(self) -> Mesh:
        """Return the mesh mirrored from right to left."""
        flip = np.array((-1.0, 1.0, 1.0), dtype=np.float32)
        return replace(
            self, corners=(self.corners * flip)[:, ::-1], normals=(self.normals * flip)[:, ::-1]
        )

    def made_of(self, material: Material) -> Mesh:
        """Return the mesh in one material."""
        return replace(self, material=np.full(len(self), material, dtype=np.float32))

    @property
    def face_normals(self) -> Floats:
        """Normal of each triangle, shape (n, 3)."""
        return _unit(_cross(self.corners))

    @property
    def mean_normals(self) -> Floats:
        """Mean of the normals at the corners of each triangle, shape (n, 3)."""
        return _unit(self.normals.sum(axis=1))


def join(meshes: Sequence[Mesh]) -> Mesh:
    """Return several meshes as one."""
    return Mesh(*map(np.concatenate, zip(*(mesh.arrays for mesh in meshes), strict=True)))


def box(
    colour: Colour, width_m: float, length_m: float, height_m: float, taper: float = 1.0
) -> Mesh:
    """Return a block that stands on the ground about the origin; ``taper`` narrows its top."""
    x, y = width_m / 2.0, length_m / 2.0
    corners = np.array([(-x, -y, 0.0), (x, -y, 0.0), (x, y, 0.0), (-x, y, 0.0)])
    top = corners * taper + (0.0, 0.0, height_m)
    return loft([corners, top], colour, closed=True)


def loft(
    rings: Sequence[npt.ArrayLike],
    colour: Colour | Paint,
    *,
    closed: bool = False,
    crease_rad: float = CREASE_RAD,
) -> Mesh:
    """Return the skin through rings of points, with flat ends if ``closed``; it faces outwards.

    It is painted in the quadrangles between two rings.
    """
    points = np.stack([np.asarray(ring, dtype=np.float32) for ring in rings])
    levels, count = points.shape[:2]
    here = np.arange(count)
    onward = (here + 1) % count
    faces, middles = [], []
    for level in range(levels - 1):
        a, b = level * count, (level + 1) * count
        pair = points[level : level + 2]
        middles += [(pair + pair[:, onward]).sum(axis=0) / 4.0] * 2
        faces.append(np.column_stack((a + here, a + onward, b + onward)))
        faces.append(np.column_stack((a + here, b + onward, b + here)))
    vertices = points.reshape(-1, 3)
    if closed:
        first, last = len(vertices), len(vertices) + 1
        vertices = np.vstack((vertices, points[0].mean(axis=0), points[-1].mean(axis=0)))
        end = (levels - 1) * count
        faces.append(np.column_stack((onward, here, np.full(count, first))))
        faces.append(np.column_stack((end + here, end + onward, np.full(count, last))))
        middles += [np.tile(points[level].mean(axis=0), (count, 1)) for level in (0, -1)]
    painted = colour(np.vstack(middles)) if callable(colour) else colour
    return Mesh.of(vertices, _outwards(vertices, np.vstack(faces)), painted, crease_rad=crease_rad)


def _outwards(vertices: Floats, faces: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Return faces turned so that what they enclose has a volume above 0."""
    corners = vertices[faces] - vertices.mean(axis=0)
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    return faces if volume >= 0.0 else faces[:, ::-1]


def tube(
    start: npt.ArrayLike,
    end: npt.ArrayLike,
    radii_m: tuple[float, float],
    colour: Colour,
    sides: int = 8,
) -> Mesh:
    """Return a rod or cone from one point to another, with flat ends."""
    a, b = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    axis = (b - a) / np.linalg.norm(b - a)
    aside = np.cross(axis, (0.0, 0.0, 1.0) if abs(axis[2]) < 0.9 else (1.0, 0.0, 0.0))
    aside /= np.linalg.norm(aside)
    other = np.cross(axis, aside)
    angles = np.linspace(0.0, math.tau, sides, endpoint=False)[:, None]
    circle = np.cos(angles) * aside + np.sin(angles) * other
    return loft([a + radii_m[0] * circle, b + radii_m[1] * circle], colour, closed=True)


def ellipsoid(
    colour: Colour | Paint,
    right_m: float,
    ahead_m: float,
    up_m: float,
    sides: int = 10,
    levels: int = 6,
) -> Mesh:
    """Return an ellipsoid about the origin, given by its half axes."""
    angles = np.linspace(0.0, math.tau, sides, endpoint=False)
    rings = []
    for latitude in np.linspace(-math.pi / 2.0 + 0.02, math.pi / 2.0 - 0.02, levels):
        radius = math.cos(latitude)
        rings.append(
            np.column_stack(
                (
                    right_m * radius * np.cos(angles),
                    ahead_m * radius * np.sin(angles),
                    np.full(sides, up_m * math.sin(latitude)),
                )
            )
        )
    return loft(rings, colour, closed=True, crease_rad=math.radians(75.0))


def wheel(colour: Colour, radius_m: float, width_m: float) -> Mesh:
    """Return a wheel on an axle along x, about the origin."""
    return tube((-width_m / 2.0, 0, 0), (width_m / 2.0, 0, 0), (radius_m, radius_m), colour, 12)


def _unit(vectors: Floats) -> Floats:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(vectors / np.maximum(length, 1e-12), dtype=np.float32)


def _cross(corners: Floats) -> Floats:
    edges = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return np.asarray(np.cross(*edges), dtype=np.float32)


def _smooth(
    points: Floats, faces: npt.NDArray[np.int64], across: Floats, crease_rad: float
) -> Floats:
    """Return a normal for each corner: the mean over the faces there that bend little."""
    _, welded = np.unique(np.round(points, 4), axis=0, return_inverse=True)
    at = welded.reshape(-1)[faces].reshape(-1)
    owner = np.repeat(np.arange(len(faces)), 3)
    order = np.argsort(at, kind="stable")
    counts = np.bincount(at, minlength=int(at.max()) + 1)
    starts = np.concatenate(([0], np.cumsum(counts)[:-1]))
    mine = np.repeat(np.arange(len(at)), counts[at])
    step = np.arange(len(mine)) - np.repeat(np.cumsum(counts[at]) - counts[at], counts[at])
    theirs = owner[order[starts[at][mine] + step]]
    unit = across / np.linalg.norm(across, axis=1, keepdims=True)
    bend = np.einsum("ij,ij->i", unit[owner[mine]], unit[theirs])
    kept = bend > math.cos(crease_rad)
    total = np.column_stack([
        np.bincount(mine[kept], weights=axis, minlength=len(at)) for axis in across[theirs[kept]].T
    ])  # fmt: skip
    length = np.linalg.norm(total, axis=1, keepdims=True)
    normals = np.where(length > 1e-12, total / np.maximum(length, 1e-12), unit[owner])
    return np.asarray(normals.reshape(-1, 3, 3), dtype=np.float32)
