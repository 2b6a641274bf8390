"""Backgrounds of fixed cameras, kept for all processes of a user.

A fixed camera's picture of the landscape is drawn with many samples a pixel, which takes 0.4 to
2.3 s of CPU. Each run has a process of its own that draws, and so would draw it again.
"""

from __future__ import annotations

import hashlib
import json
import zlib
from collections.abc import Callable
from dataclasses import astuple

import numpy as np

import airhilt.imaging
import airhilt.sensors.cameras
from airhilt.host.caches import CacheFolder
from airhilt.host.files import packages_sha256
from airhilt.host.processor import processor_sha256
from airhilt.imaging.view import View
from airhilt.sensors.cameras.renderers import Samples, library_of
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.landscape import Landscape

COMPRESSION = 1
"""Level of zlib: 720 rows take 1.4 instead of 6.5 MB, for 35 ms to write and 10 ms to read."""


class BackgroundCache:
    """The pictures of one landscape in one light, by one renderer.

    Parameters
    ----------
    renderer
        Name of the renderer.
    library
        Library that casts its rays, with its version: see `library_of`.
    """

    def __init__(
        self, renderer: str, library: str, landscape: Landscape, light: Illumination
    ) -> None:
        self._folder = CacheFolder("backgrounds")
        self._scene = [
            packages_sha256(airhilt.imaging, airhilt.sensors.cameras),
            renderer, library, np.__version__, processor_sha256(), _content(landscape),
            light.sun.tolist(), light.visibility_m, light.overcast, light.background,
        ]  # fmt: skip

    @classmethod
    def of(cls, renderer: str, landscape: Landscape, light: Illumination) -> BackgroundCache | None:
        """Return the cache for a renderer, None if more than its library determines pictures."""
        library = library_of(renderer)
        return cls(renderer, library, landscape, light) if library else None

    def get(self, view: View, samples: int, draw: Callable[[], Samples]) -> Samples:
        """Return the picture of a camera that stands still, drawn if it is not in the cache.

        Parameters
        ----------
        samples
            Number of samples along each side of a pixel.
        """
        lens, pose = view.intrinsics, view.pose
        camera = [*astuple(lens), *pose.position_m, *pose.rotation.ravel().tolist(), samples]
        packed = self._folder.get(json.dumps([*self._scene, camera]), lambda: _packed(draw()))
        return _unpacked(packed, lens.height_px, lens.width_px)


def _content(landscape: Landscape) -> str:
    """Return the SHA-256 of all that stands still and can be seen."""
    mesh, digest = landscape.mesh, hashlib.sha256(repr(landscape.lights).encode())
    for array in mesh.arrays:
        digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()


def _packed(drawn: Samples) -> bytes:
    return zlib.compress(drawn.colour.tobytes() + drawn.distance_m.tobytes(), COMPRESSION)


def _unpacked(packed: bytes, rows: int, columns: int) -> Samples:
    content, pixels = zlib.decompress(packed), rows * columns
    colour = np.frombuffer(content, np.uint8, 3 * pixels)
    distance = np.frombuffer(content, np.float32, pixels, offset=3 * pixels)
    return Samples(colour.reshape(rows, columns, 3), distance.reshape(rows, columns))
