"""Embree, through embreex: casts rays on the processor, and needs nothing of the system."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from airhilt.errors import RendererError, first_line
from airhilt.imaging.masks import Mask
from airhilt.sensors.cameras.raycasting import Hits, SceneBuilder, Triangles
from airhilt.sensors.cameras.raycasting.renderer import RayRenderer
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.shapes.mesh import Floats, Mesh

NOTHING = -1
"""Embree's number of the geometry that a ray meets where it meets none."""


class Embree:
    """Draws with Embree.

    embreex casts ray by ray on one thread and holds Python's interpreter lock meanwhile.
    """

    name = "embree"
    distributions = ("embreex",)
    needs = "pip install embreex (there are wheels for Linux x86-64, macOS and Windows)"

    def open(self, landscape: Mesh, light: Illumination) -> RayRenderer:
        """Return a renderer of a landscape; errors as `scene_builder`."""
        return RayRenderer(landscape, light, self.scene_builder())

    def scene_builder(self) -> SceneBuilder:
        """Return what makes scenes of triangles."""
        try:
            from embreex.rtcore import EmbreeDevice
        except ImportError as error:
            raise RendererError(
                f"the renderer embree needs embreex: {self.needs} ({first_line(error)})"
            ) from None
        return partial(EmbreeScene, EmbreeDevice())


class EmbreeScene:
    """Triangles in Embree."""

    def __init__(self, device: Any, corners: Floats) -> None:
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene as Scene

        # Not robust: that takes an eighth more time, and keeps one ray in half a million from
        # passing between two triangles.
        self._scene = Scene(device)
        TriangleMesh(self._scene, np.ascontiguousarray(corners, dtype=np.float32))

    def triangles(self, origin: npt.NDArray[np.floating], directions: Floats) -> Triangles:
        """Return the first triangle that each ray meets."""
        found: Triangles = self._scene.run(_for_each(origin, directions), directions.T)
        return found

    def hits(self, origin: npt.NDArray[np.floating], directions: Floats) -> Hits:
        """Return where each ray first meets a triangle."""
        found = self._scene.run(_for_each(origin, directions), directions.T, output=True)
        distance = found["tfar"]
        distance[found["primID"] == NOTHING] = np.inf
        return Hits(distance, found["primID"], found["u"], found["v"])

    def blocked(self, origins: npt.NDArray[np.floating], direction: Floats) -> Mask:
        """Return which rays meet any triangle."""
        ways = np.asarray(direction, dtype=np.float32)[None]
        rays = np.ascontiguousarray(origins, dtype=np.float32)
        return np.asarray(self._scene.run(rays, ways, query="OCCLUDED") != NOTHING)


def _for_each(origin: npt.NDArray[np.floating], directions: Floats) -> Floats:
    """Return the origin of each ray, shape (n, 3)."""
    return np.broadcast_to(np.asarray(origin, dtype=np.float32), directions.T.shape)


RENDERER = Embree()
