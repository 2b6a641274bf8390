"""Meshes of landscapes, kept for all processes of a user: to cut out an airport takes seconds."""

from __future__ import annotations

import json
import zlib
from collections.abc import Callable, Sequence

import numpy as np
import shapely

import airhilt.geodesy
import airhilt.sensors.cameras.scene
import airhilt.shapes
import airhilt.world.surface
from airhilt.host.caches import CacheFolder
from airhilt.host.files import packages_sha256
from airhilt.host.machine import processor_sha256
from airhilt.shapes.mesh import Floats, Mesh

COMPRESSION = 1
"""Level of zlib."""
SHAPES = ((3, 3), (3, 3), (3,), (), (), ())
"""Arrays of a mesh with an entry for each triangle."""


def kept_mesh(determined_by: Sequence[object], make: Callable[[], Mesh]) -> Mesh:
    """Return a mesh, which is made if it is not in the cache.

    Parameters
    ----------
    determined_by
        All that determines it besides code and libraries, as JSON.
    """
    code = packages_sha256(
        airhilt.geodesy, airhilt.sensors.cameras.scene, airhilt.shapes, airhilt.world.surface
    )
    libraries = [shapely.__version__, shapely.geos_version_string, np.__version__]
    key = json.dumps([code, *libraries, processor_sha256(), *determined_by])

    def packed() -> bytes:
        return zlib.compress(b"".join(each.tobytes() for each in make().arrays), COMPRESSION)

    numbers = np.frombuffer(zlib.decompress(CacheFolder("landscapes").get(key, packed)), np.float32)
    sizes = [int(np.prod(shape, dtype=int)) for shape in SHAPES]
    triangles = len(numbers) // sum(sizes)
    parts = np.split(numbers, np.cumsum(sizes)[:-1] * triangles)
    arrays: list[Floats] = [
        part.reshape(triangles, *shape) for part, shape in zip(parts, SHAPES, strict=True)
    ]
    return Mesh(*arrays)
