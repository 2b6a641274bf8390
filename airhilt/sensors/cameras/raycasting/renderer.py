"""Pictures of what rays meet: all of the drawing that is the same for every ray caster.

The landscape is a mosaic of plane pieces of one colour and material each. A ray is cast for every
second pixel of every second row; where the four about a pixel meet the same piece, so does the
pixel, and its distance follows from the plane. Only the other pixels cost rays of their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from airhilt.imaging.masks import Mask
from airhilt.imaging.view import Pose, View, Window
from airhilt.sensors.cameras.raycasting import RayScene, SceneBuilder
from airhilt.sensors.cameras.renderers import Part, Samples
from airhilt.sensors.cameras.scene.illumination import (
    LEVELS,
    SKY_STEPS,
    Illumination,
    encode,
    encode_levels,
)
from airhilt.sensors.cameras.scene.textures import DECK_M, TINT, deck, factors, on_surface
from airhilt.shapes.mesh import Floats, Mesh

Number = TypeVar("Number", bound=np.generic)
Doubles = npt.NDArray[np.float64]
Pieces = npt.NDArray[np.intp]
"""Numbers of pieces of the landscape."""
Kinds = npt.NDArray[np.int32]
"""Numbers of materials."""
Glare = tuple[npt.NDArray[np.intp], Floats]
"""Samples in which light about the sun is, and the light, shape (3, n)."""
Deck = tuple[npt.NDArray[np.intp], Floats]
"""Samples in which the sky is, and the share of it that thin clouds hide."""
MISSED = 0
"""Number of the piece that is the sky."""


@dataclass(frozen=True)
class _Body:
    scene: RayScene
    normals: Floats
    colours: Floats
    glow: Floats
    material: Kinds


class RayRenderer:
    """Draws by casting rays."""

    def __init__(self, landscape: Mesh, light: Illumination, build: SceneBuilder) -> None:
        self._build = build
        self._light = light
        self._landscape = build(landscape.corners)
        found = _pieces(landscape, light)
        self._piece_of, self._normals, self._heights, colours, self._materials = found
        tables = np.concatenate((colours, light.sky.T), axis=1) - light.airlight[:, None]
        self._beyond_air = np.ascontiguousarray(tables * np.float32(LEVELS))
        self._shapes: dict[str, Mesh] = {}
        self._bodies: dict[str, _Body] = {}

    def add_shape(self, name: str, mesh: Mesh) -> None:
        """Keep the shape of a body, to draw it by this name."""
        self._shapes[name] = mesh

    def close(self) -> None:
        """Release the shapes."""
        self._shapes.clear()
        self._bodies.clear()

    def _body_of(self, name: str) -> _Body:
        """Return the body of a name; most are never seen, so it is built when it is."""
        if name not in self._bodies:
            mesh = self._shapes[name]
            scene, material = self._build(mesh.corners), mesh.material.astype(np.int32)
            self._bodies[name] = _Body(scene, mesh.normals, mesh.colours, mesh.glow, material)
        return self._bodies[name]

    def landscape(self, view: View, window: Window, samples: int = 1) -> Samples:
        """Return the landscape behind all bodies, with the sky and the air."""
        x, y = view.on_focal_plane(*view.sample_places(window, samples))
        if samples == 1:
            pieces = self._adaptively(view, x, y)
        else:
            pieces = self._pieces_at(view, *np.broadcast_arrays(x, y))
        rays = Rays.of(view, x, y, samples)
        sky = pieces == MISSED
        glare = self._look_up(rays, pieces, sky)
        # A plane n p = h is met at the depth h / (n d): its inverse is linear in the picture.
        (right, down, ahead), away = self._planes(view, pieces)
        inverse_depth = _of(right, pieces)
        inverse_depth *= x
        part = _of(down, pieces)
        part *= y
        inverse_depth += part
        inverse_depth += _of(ahead, pieces)
        texture = None
        if self._light.texture > 0.0:
            texture = self._texture(rays, inverse_depth, pieces, away)
        with np.errstate(divide="ignore"):
            distance = np.divide(rays.length, inverse_depth, out=inverse_depth)
        left = np.exp(distance * np.float32(-self._light.background_extinction_per_m))
        np.copyto(left, np.float32(1.0), where=sky)
        deck = self._deck(rays, sky)
        return Samples(self._colour_of(pieces, left, texture, deck, glare), distance)

    def parts(self, view: View, parts: Sequence[Part]) -> list[Samples]:
        """Return bodies through the air, and shadows."""
        return [self._shadow(view, *part[:4]) if part.is_shadow else self._body(view, *part[:4])
                for part in parts]  # fmt: skip

    def _body(self, view: View, shape: str, pose: Pose, window: Window, samples: int) -> Samples:
        body = self._body_of(shape)
        directions = view.directions(*view.sample_places(window, samples))
        size = directions.shape[1:]
        rotation = pose.rotation.astype(np.float32)
        origin = (np.asarray(view.pose.position_m) - np.asarray(pose.position_m)) @ pose.rotation
        ways = rotation.T @ directions.reshape(3, -1)
        distance, faces, u, v = body.scene.hits(origin, ways)
        colour = np.zeros((len(distance), 3), dtype=np.uint8)
        hit = np.flatnonzero(np.isfinite(distance))
        if len(hit):
            faces, u, v = faces[hit], u[hit], v[hit]
            weights = np.stack((1.0 - u - v, u, v), axis=1)
            normals = np.einsum("nk,nki->ni", weights, body.normals[faces]) @ rotation.T
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
            lit = self._light.shade(body.colours[faces], normals)
            if self._light.texture > 0.0:
                place = origin.astype(np.float32)[:, None] + ways[:, hit] * distance[hit]
                across = distance[hit] / np.float32(view.intrinsics.focal_px * samples)
                varied = factors(on_surface(body.material[faces], place, across))
                lit *= 1.0 + np.float32(self._light.texture) * (varied - 1.0)[:, None]
            lit += (body.glow[faces] * self._light.darkness)[:, None] * body.colours[faces]
            air = self._light.extinction_per_m
            seen = self._light.through_air(np.ascontiguousarray(lit.T), distance[hit], air)
            colour[hit] = encode(seen)
        return Samples(colour.reshape(*size, 3), distance.reshape(size))

    def _shadow(self, view: View, shape: str, pose: Pose, window: Window, samples: int) -> Samples:
        directions = view.directions(*view.sample_places(window, samples))
        size = directions.shape[1:]
        shaded = np.full(size, np.inf, dtype=np.float32)
        drawn = Samples(np.zeros((*size, 3), dtype=np.uint8), shaded)
        below = directions[2] < -1e-5
        if not below.any():
            return drawn
        towards = directions[:, below].T.astype(np.float64)
        position = np.asarray(view.pose.position_m, dtype=np.float64)
        away = -position[2] / towards[:, 2]
        ground = position + towards * away[:, None] - np.asarray(pose.position_m)
        sun = (self._light.sun @ pose.rotation).astype(np.float32)
        hidden = self._body_of(shape).scene.blocked(ground @ pose.rotation, sun)
        shaded[below] = np.where(hidden, np.float32(0.0), np.float32(np.inf))
        return drawn

    def _adaptively(self, view: View, x: Floats, y: Floats) -> Pieces:
        """Return the piece that each sample meets."""
        rows, columns = y.shape[0], x.shape[1]
        coarse = self._pieces_at(view, *np.broadcast_arrays(x[:, ::2], y[::2]))
        height, width = coarse.shape
        # The neighbours below and to the right; the last ones are their own.
        below = np.vstack((coarse[1:], coarse[-1:]))
        alike = coarse == below
        alike[:, :-1] &= (coarse[:, 1:] == coarse[:, :-1]) & (below[:, 1:] == coarse[:, :-1])
        pieces = np.empty((height, 2, width, 2), dtype=np.intp)
        pieces[...] = coarse[:, None, :, None]
        found = pieces.reshape(2 * height, 2 * width)[:rows, :columns]
        # The other three of each block that is not sure.
        row, column = np.divmod(np.flatnonzero(~alike), width)
        row, column = (2 * row + [[0], [1], [1]]).ravel(), (2 * column + [[1], [0], [1]]).ravel()
        inside = (row < rows) & (column < columns)
        row, column = row[inside], column[inside]
        found[row, column] = self._pieces_at(view, x[0, column], y[row, 0])
        return np.ascontiguousarray(found)

    def _pieces_at(self, view: View, x: Floats, y: Floats) -> Pieces:
        """Return the pieces towards places of the focal plane, of their shape."""
        axes = view.axes.astype(np.float32)
        towards = np.stack([x.ravel() * row[0] + y.ravel() * row[1] + row[2] for row in axes])
        met = self._landscape.triangles(np.asarray(view.pose.position_m), towards)
        # The first entry is that of a miss, whose number is -1.
        return _of(self._piece_of, met + 1).reshape(x.shape)

    def _look_up(self, rays: Rays, pieces: Pieces, sky: Mask) -> Glare | None:
        """Tell pieces of the sky apart by their elevation; return the glare of the sun on them."""
        rows = np.flatnonzero(sky.any(axis=1))
        if not len(rows):
            return None
        block = slice(int(rows[0]), int(rows[-1]) + 1)
        view, x, y, length = rays.view, rays.x, rays.y[block], rays.length[block]
        axes = view.axes.astype(np.float32)
        up = (x * axes[2, 0] + (y * axes[2, 1] + axes[2, 2])) / length
        steps = self._light.sky_steps(up)
        steps += len(self._heights)
        np.copyto(pieces[block], steps, where=sky[block])
        # The sun's glare, if any of it is in the picture.
        sun = view.axes.T @ self._light.sun
        across = sun[0] * x + (sun[1] * y + sun[2])
        near = np.flatnonzero((across > self._light.glare_from * length) & sky[block])
        if not len(near) or not self._light.glare.any():
            return None
        apart = np.float32(1.0) - (across / length).reshape(-1)[near].astype(np.float32)
        return near + block.start * pieces.shape[1], self._light.glare_at(apart)

    def _deck(self, rays: Rays, sky: Mask) -> Deck | None:
        """Return how much of the sky the deck of clouds hides."""
        eye = rays.view.pose.position_m
        if eye[2] > DECK_M or not self._light.shows_deck:
            return None
        right, down, ahead = rays.view.axes[2].astype(np.float32)
        above = rays.x * right + (rays.y * down + ahead) > 0.0
        flat = np.flatnonzero(sky & above)
        if not len(flat):
            return None
        towards = rays.to(flat)
        towards /= rays.length.reshape(-1)[flat]
        return flat, deck(towards, eye, rays.sample_rad, self._light.clouds)

    def _planes(self, view: View, pieces: Pieces) -> tuple[Floats, Floats]:
        """Return how the inverse depth grows to the right, down and ahead, and distances of planes.

        Both have a column for each piece, of which only those of ``pieces`` are filled in; those of
        the sky are 0.
        """
        slopes = np.zeros((3, len(self._heights) + SKY_STEPS), dtype=np.float32)
        is_there = np.zeros(slopes.shape[1], dtype=bool)
        is_there[pieces] = True
        is_there[MISSED] = False
        met = np.flatnonzero(is_there[: len(self._heights)])
        normals = self._normals.take(met, axis=1)
        heights = self._heights[met] - np.asarray(view.pose.position_m) @ normals
        # No ray meets a plane in which the camera lies.
        heights[heights == 0.0] = np.inf
        slopes[:, met] = (view.axes.T @ normals) / heights
        away = np.zeros(slopes.shape[1], dtype=np.float32)
        away[met] = np.abs(heights)
        return slopes, away

    def _texture(self, rays: Rays, inverse_depth: Floats, pieces: Pieces, away: Floats) -> Floats:
        """Return by what share each sample is brighter or darker than its piece."""
        found = np.zeros(pieces.shape, dtype=np.float32)
        flat = np.flatnonzero(inverse_depth > 0.0)
        depth = 1.0 / inverse_depth.reshape(-1)[flat]
        place = rays.to(flat)
        place *= depth
        place += np.asarray(rays.view.pose.position_m, dtype=np.float32)[:, None]
        piece = pieces.reshape(-1)[flat]
        # A pixel shows more of a slanting surface lengthwise than across: the mean of both.
        footprint = depth * rays.length.reshape(-1)[flat]
        footprint /= _of(away, piece)
        np.sqrt(footprint, out=footprint)
        footprint *= depth
        footprint *= np.float32(rays.sample_rad)
        varied = factors(on_surface(_of(self._materials, piece), place, footprint))
        varied -= np.float32(1.0)
        varied *= np.float32(self._light.texture)
        found.reshape(-1)[flat] = varied
        return found

    def _colour_of(
        self,
        pieces: Pieces,
        left: Floats,
        texture: Floats | None,
        deck: Deck | None,
        glare: Glare | None,
    ) -> npt.NDArray[np.uint8]:
        """Return what pieces look like when some of their light is left."""
        colour = np.empty((*pieces.shape, 3), dtype=np.uint8)
        change = None if texture is None else texture * left
        for index, air in enumerate(self._light.airlight.tolist()):
            seen = _of(self._beyond_air[index], pieces)
            if change is None:
                seen *= left
                seen += np.float32(air * LEVELS)
            else:
                # Of light c, c t l + a (1 - l) is seen; the table has c - a.
                varied = change * np.float32(TINT[index])
                seen *= left + varied
                varied += np.float32(1.0)
                varied *= np.float32(air * LEVELS)
                seen += varied
            if deck is not None:
                behind = seen.reshape(-1)
                white = np.float32(self._light.deck[index] * LEVELS)
                behind[deck[0]] += (white - behind[deck[0]]) * deck[1]
            if glare is not None:
                seen.reshape(-1)[glare[0]] += glare[1][index] * np.float32(LEVELS)
            colour[..., index] = encode_levels(seen)
        return colour


class Rays(NamedTuple):
    """Rays to the samples of a window.

    Attributes
    ----------
    x, y
        Places of the samples on the focal plane, shapes (1, columns) and (rows, 1).
    length
        Distances to them from the eye, shape (rows, columns); that of the plane is 1.
    sample_rad
        Angle that a sample takes in the middle of the picture.
    """

    view: View
    x: Floats
    y: Floats
    length: Floats
    sample_rad: float

    @classmethod
    def of(cls, view: View, x: Floats, y: Floats, samples: int) -> Rays:
        """Return the rays to places; a pixel has ``samples`` along each side."""
        length = np.sqrt(x * x + (y * y + np.float32(1.0)))
        return cls(view, x, y, length, 1.0 / (view.intrinsics.focal_px * samples))

    def to(self, flat: npt.NDArray[np.intp]) -> Floats:
        """Return the ways from the eye to some samples by their numbers, shape (3, n)."""
        row, column = np.divmod(flat, self.length.shape[1])
        right, down = self.x[0, column], self.y[row, 0]
        ways = np.empty((3, len(flat)), dtype=np.float32)
        for way, (across, along, ahead) in zip(
            ways, self.view.axes.astype(np.float32), strict=True
        ):
            np.multiply(right, across, out=way)
            way += down * along
            way += ahead
        return ways


def _of(table: npt.NDArray[Number], entries: npt.NDArray[np.integer]) -> npt.NDArray[Number]:
    """Return entries of a table; clipping spares NumPy a look at each before."""
    return table.take(entries, mode="clip")


def _pieces(landscape: Mesh, light: Illumination) -> tuple[Pieces, Doubles, Doubles, Floats, Kinds]:
    """Return the piece of each triangle; normals, heights, colours and materials of pieces.

    Triangles of one colour in one plane are one piece. The first entry stands for no triangle,
    and piece 0 is the sky: its plane is infinitely far in every direction.
    """
    baked = light.baked(landscape)
    normals = landscape.face_normals.astype(np.float64)
    heights = np.einsum("ij,ij->i", normals, landscape.corners[:, 0].astype(np.float64))
    keys = np.column_stack(
        (np.round(normals, 5), np.round(heights, 2), np.round(baked, 5), landscape.material)
    )
    _, first, piece = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    none = np.zeros((1, 3))
    return (
        np.concatenate(([MISSED], piece.reshape(-1) + 1)).astype(np.intp),
        np.ascontiguousarray(np.vstack((none, normals[first])).T),
        np.concatenate(([1.0], heights[first])),
        np.ascontiguousarray(np.vstack((none, baked[first])).T, dtype=np.float32),
        np.concatenate(([0.0], landscape.material[first])).astype(np.int32),
    )
