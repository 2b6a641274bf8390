"""Backgrounds of fixed cameras, kept for all processes of a user.

A fixed camera's picture of the landscape is drawn with many samples a pixel, which takes 0.4 to
2.3 s of CPU. Each run has a process of its own that draws, and so would draw it again.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Callable

import numpy as np

from airhilt.host.caches import CacheFolder
from airhilt.imaging.view import View
from airhilt.sensors.cameras.drawing_keys import arrays_sha256, drawn_by, view_key
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
            *drawn_by(library), renderer, arrays_sha256(landscape.mesh.arrays),
            repr(landscape.lights), light.key,
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
        key = json.dumps([*self._scene, view_key(view), samples])
        lens = view.intrinsics
        packed = self._folder.get(key, lambda: _packed(draw()))
        return _unpacked(packed, lens.height_px, lens.width_px)


def _packed(drawn: Samples) -> bytes:
    return zlib.compress(drawn.colour.tobytes() + drawn.distance_m.tobytes(), COMPRESSION)


def _unpacked(packed: bytes, rows: int, columns: int) -> Samples:
    content, pixels = zlib.decompress(packed), rows * columns
    colour = np.frombuffer(content, np.uint8, 3 * pixels)
    distance = np.frombuffer(content, np.float32, pixels, offset=3 * pixels)
    return Samples(colour.reshape(rows, columns, 3), distance.reshape(rows, columns))
