"""Open3D's `RaycastingScene`: casts rays on the processor, on two threads."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from functools import partial
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from airhilt.errors import RendererError, first_line
from airhilt.imaging.masks import Mask
from airhilt.sensors.cameras.raycasting import Hits, SceneBuilder, Triangles
from airhilt.sensors.cameras.raycasting.renderer import RayRenderer
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.shapes.mesh import Floats, Mesh

BINDINGS = "open3d.cpu.pybind"
SYSTEM_LIBRARIES = "libgl1 libegl1 libx11-6 libudev1 libgomp1"
THREADS = 2
"""Threads of a cast: a run waits while its pictures are drawn."""


class Open3D:
    """Draws with Open3D."""

    name = "open3d"
    distributions = ("open3d-cpu", "open3d")
    needs = f"pip install 'airhilt[open3d]' and apt install {SYSTEM_LIBRARIES}"

    def open(self, landscape: Mesh, light: Illumination) -> RayRenderer:
        """Return a renderer of a landscape; errors as `scene_builder`."""
        return RayRenderer(landscape, light, self.scene_builder())

    def scene_builder(self) -> SceneBuilder:
        """Return what makes scenes of triangles."""
        try:
            open3d = _bindings()
        except ImportError as error:
            raise RendererError(
                f"the renderer open3d needs Open3D 0.19 and its system libraries: {self.needs} "
                f"({first_line(error)}); or choose --renderer embree"
            ) from None
        return partial(Open3DScene, open3d)


class Open3DScene:
    """Triangles in a `RaycastingScene`."""

    def __init__(self, open3d: Any, corners: Floats) -> None:
        self._tensor = open3d.core.Tensor.from_numpy
        self._scene = open3d.t.geometry.RaycastingScene(nthreads=THREADS)
        vertices = np.ascontiguousarray(corners.reshape(-1, 3))
        self._scene.add_triangles(
            vertices, np.arange(len(vertices), dtype=np.uint32).reshape(-1, 3)
        )

    def triangles(self, origin: npt.NDArray[np.floating], directions: Floats) -> Triangles:
        """Return the first triangle that each ray meets."""
        return _numbers(self._cast(origin, directions))

    def hits(self, origin: npt.NDArray[np.floating], directions: Floats) -> Hits:
        """Return where each ray first meets a triangle."""
        found = self._cast(origin, directions)
        u, v = found["primitive_uvs"].numpy().T
        return Hits(found["t_hit"].numpy(), _numbers(found), u, v)

    def blocked(self, origins: npt.NDArray[np.floating], direction: Floats) -> Mask:
        """Return which rays meet any triangle."""
        rays = np.empty((len(origins), 6), dtype=np.float32)
        rays[:, :3], rays[:, 3:] = origins, direction
        hidden = self._scene.test_occlusions(self._tensor(rays), nthreads=THREADS)
        return np.asarray(hidden.numpy())

    def _cast(self, origin: npt.NDArray[np.floating], directions: Floats) -> Any:
        rays = np.empty((directions.shape[1], 6), dtype=np.float32)
        rays[:, :3], rays[:, 3:] = origin, directions.T
        return self._scene.cast_rays(self._tensor(rays), nthreads=THREADS)


def _numbers(found: Any) -> Triangles:
    """Return the triangles of an answer; the greatest number, which is a miss, becomes -1."""
    numbers: Triangles = found["primitive_ids"].numpy().view(np.int32)
    return numbers


def _bindings() -> Any:
    """Return the C++ part of Open3D: the package around it imports tools that show things.

    Importing the whole package takes three times as long.
    """
    package = importlib.util.find_spec("open3d")
    if package is None or not package.submodule_search_locations:
        raise ImportError("no module named 'open3d'")
    folder = Path(package.submodule_search_locations[0]) / "cpu"
    if BINDINGS in sys.modules:
        return sys.modules[BINDINGS]
    spec = PathFinder.find_spec(BINDINGS, [str(folder)])
    if spec is None or spec.loader is None or sys.platform == "win32":
        return importlib.import_module("open3d")
    module = importlib.util.module_from_spec(spec)
    sys.modules[BINDINGS] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[BINDINGS]
        raise
    return module


RENDERER = Open3D()
