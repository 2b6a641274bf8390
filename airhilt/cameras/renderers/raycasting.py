"""Pictures by Open3D's `RaycastingScene` (Embree): no display, no graphics driver.

The world is a mosaic of plane pieces of one colour each. A ray is cast for every second pixel of
every second row; where the four about a pixel meet the same piece, so does the pixel, and its
distance follows from the plane. Only the other pixels cost rays of their own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from airhilt.cameras.light import Light, encode
from airhilt.cameras.mesh import Floats, Mesh
from airhilt.cameras.renderers import Samples
from airhilt.cameras.view import Pose, View, Window
from airhilt.errors import RendererError, first_line

THREADS = 1
"""Of a cast: runs share a machine with each other."""
Number = TypeVar("Number", bound=np.generic)
MISSED = 0
"""Number of the piece that is the sky."""


@dataclass(frozen=True)
class _Body:
    scene: Any
    normals: Floats
    colours: Floats
    glow: Floats


class Open3DRenderer:
    """Draws by casting rays.

    Raises
    ------
    RendererError
        Open3D is not installed, or not able to start.
    """

    def __init__(self, world: Mesh, light: Light) -> None:
        self._open3d = _import_open3d()
        self._light = light
        self._world = self._scene(world)
        self._piece_of, self._normals, self._heights, self._colours = _pieces(world, light)
        self._bodies: dict[str, _Body] = {}

    def add_shape(self, name: str, mesh: Mesh) -> None:
        """Take in the shape of a body."""
        self._bodies[name] = _Body(self._scene(mesh), mesh.normals, mesh.colours, mesh.glow)

    def close(self) -> None:
        """Give back what was taken."""
        self._bodies.clear()

    def world(self, view: View, samples: int = 1) -> Samples:
        """Return the world behind all bodies, with the sky and the air."""
        directions = view.directions(*view.sample_places(view.whole, samples))
        shape = directions.shape[1:]
        if samples == 1:
            pieces = self._adaptively(view, directions).reshape(-1)
        else:
            pieces = self._pieces_at(view, directions.reshape(3, -1))
        towards = directions.reshape(3, -1)
        normals, heights = self._planes_from(view)
        slope = _of(normals[0], pieces) * towards[0]
        slope += _of(normals[1], pieces) * towards[1]
        slope += _of(normals[2], pieces) * towards[2]
        with np.errstate(divide="ignore"):
            distance = np.divide(_of(heights, pieces), slope, out=slope)
        light = self._light
        colour = np.stack([_of(channel, pieces) for channel in self._colours])
        light.through_air(colour, distance, light.backdrop_extinction_per_m)
        sky = np.flatnonzero(pieces == MISSED)
        colour[:, sky] = light.sky_towards(towards[:, sky])
        return Samples(encode(colour).reshape(*shape, 3), distance.reshape(shape))

    def body(self, shape: str, pose: Pose, view: View, window: Window, samples: int) -> Samples:
        """Return a body alone, through the air."""
        body = self._bodies[shape]
        directions = view.directions(*view.sample_places(window, samples))
        size = directions.shape[1:]
        rotation = pose.rotation.astype(np.float32)
        origin = (np.asarray(view.pose.position_m) - np.asarray(pose.position_m)) @ pose.rotation
        answer = self._cast(body.scene, _rays(origin, rotation.T @ directions.reshape(3, -1)))
        distance = answer["t_hit"].numpy()
        colour = np.zeros((len(distance), 3), dtype=np.uint8)
        hit = np.flatnonzero(np.isfinite(distance))
        if len(hit):
            faces = answer["primitive_ids"].numpy()[hit]
            u, v = answer["primitive_uvs"].numpy()[hit].T
            weights = np.stack((1.0 - u - v, u, v), axis=1)
            normals = np.einsum("nk,nki->ni", weights, body.normals[faces]) @ rotation.T
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
            lit = self._light.shade(body.colours[faces], normals)
            lit += (body.glow[faces] * self._light.darkness)[:, None] * body.colours[faces]
            air = self._light.extinction_per_m
            seen = self._light.through_air(np.ascontiguousarray(lit.T), distance[hit], air)
            colour[hit] = encode(seen)
        return Samples(colour.reshape(*size, 3), distance.reshape(size))

    def shadow(
        self, shape: str, pose: Pose, view: View, window: Window, samples: int
    ) -> npt.NDArray[np.bool_]:
        """Return where a body keeps the sun from the flat ground."""
        directions = view.directions(*view.sample_places(window, samples))
        shaded = np.zeros(directions.shape[1:], dtype=bool)
        below = directions[2] < -1e-5
        if not below.any():
            return shaded
        towards = directions[:, below].T.astype(np.float64)
        position = np.asarray(view.pose.position_m, dtype=np.float64)
        away = -position[2] / towards[:, 2]
        ground = position + towards * away[:, None] - np.asarray(pose.position_m)
        sun = np.broadcast_to(
            (self._light.sun @ pose.rotation).astype(np.float32)[:, None], (3, len(ground))
        )
        tensor = self._open3d.core.Tensor.from_numpy(_rays(ground @ pose.rotation, sun))
        scene = self._bodies[shape].scene
        shaded[below] = scene.test_occlusions(tensor, nthreads=THREADS).numpy()
        return shaded

    def _adaptively(self, view: View, directions: Floats) -> npt.NDArray[np.int32]:
        """Return the piece that each sample meets."""
        rows, columns = directions.shape[1:]
        towards = np.ascontiguousarray(directions[:, ::2, ::2])
        height, width = towards.shape[1:]
        coarse = self._pieces_at(view, towards.reshape(3, -1)).reshape(height, width)
        # The neighbours below and to the right; the last ones are their own.
        below = np.vstack((coarse[1:], coarse[-1:]))
        alike = coarse == below
        alike[:, :-1] &= (coarse[:, 1:] == coarse[:, :-1]) & (below[:, 1:] == coarse[:, :-1])
        pieces = np.empty((height, 2, width, 2), dtype=np.int32)
        pieces[...] = coarse[:, None, :, None]
        unsure = np.empty((height, 2, width, 2), dtype=bool)
        unsure[...] = ~alike[:, None, :, None]
        unsure[:, 0, :, 0] = False
        found = np.ascontiguousarray(pieces.reshape(2 * height, 2 * width)[:rows, :columns])
        ask = np.flatnonzero(unsure.reshape(2 * height, 2 * width)[:rows, :columns])
        towards = directions.reshape(3, -1).take(ask, axis=1)
        found.reshape(-1)[ask] = self._pieces_at(view, towards)
        return found

    def _pieces_at(self, view: View, directions: Floats) -> npt.NDArray[np.int32]:
        answer = self._cast(self._world, _rays(np.asarray(view.pose.position_m), directions))
        # Open3D marks a miss with the greatest number, which wraps to the entry before the first.
        faces = answer["primitive_ids"].numpy().view(np.int32)
        return _of(self._piece_of, faces + 1)

    def _planes_from(self, view: View) -> tuple[Floats, Floats]:
        """Return normals of all planes, and their heights above the camera's place."""
        heights = self._heights - np.asarray(view.pose.position_m) @ self._normals
        heights[MISSED] = 1.0
        return self._normals.astype(np.float32), heights.astype(np.float32)

    def _scene(self, mesh: Mesh) -> Any:
        scene = self._open3d.t.geometry.RaycastingScene(nthreads=THREADS)
        corners = np.ascontiguousarray(mesh.corners.reshape(-1, 3))
        faces = np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)
        scene.add_triangles(corners, faces)
        return scene

    def _cast(self, scene: Any, rays: Floats) -> Any:
        return scene.cast_rays(self._open3d.core.Tensor.from_numpy(rays), nthreads=THREADS)


def _of(table: npt.NDArray[Number], entries: npt.NDArray[np.int32]) -> npt.NDArray[Number]:
    """Return entries of a table; clipping spares NumPy a look at each before."""
    return table.take(entries, mode="clip")


def _rays(origin: npt.NDArray[np.floating], directions: Floats) -> Floats:
    """Return rays as Open3D takes them; directions are of shape (3, n)."""
    rays = np.empty((directions.shape[1], 6), dtype=np.float32)
    rays[:, :3] = origin
    rays[:, 3:] = directions.T
    return rays


def _pieces(
    world: Mesh, light: Light
) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.float64], npt.NDArray[np.float64], Floats]:
    """Return the piece of each triangle; normals, heights and colours of pieces in columns.

    Triangles of one colour in one plane are one piece. The first entry stands for no triangle,
    and piece 0 is the sky: its plane is infinitely far in every direction.
    """
    baked = light.baked(world)
    normals = world.face_normals.astype(np.float64)
    heights = np.einsum("ij,ij->i", normals, world.corners[:, 0].astype(np.float64))
    keys = np.column_stack((np.round(normals, 5), np.round(heights, 2), np.round(baked, 5)))
    _, first, piece = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    none = np.zeros((1, 3))
    return (
        np.concatenate(([MISSED], piece.reshape(-1) + 1)).astype(np.int32),
        np.ascontiguousarray(np.vstack((none, normals[first])).T),
        np.concatenate(([1.0], heights[first])),
        np.ascontiguousarray(np.vstack((none, baked[first])).T, dtype=np.float32),
    )


def _import_open3d() -> Any:
    try:
        import open3d
    except ImportError as error:
        raise RendererError(
            "the renderer open3d needs Open3D 0.19 and its system libraries: "
            "pip install 'airhilt[vision]' and apt install libgl1 libegl1 libx11-6 libgomp1 "
            f"({first_line(error)}); or choose --renderer moderngl"
        ) from None
    return open3d
