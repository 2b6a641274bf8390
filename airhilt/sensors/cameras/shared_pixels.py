"""The pixels of pictures, as they lie in memory that two processes share."""

from __future__ import annotations

import mmap
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from airhilt.sensors.cameras.mounts import Camera
from airhilt.shapes.mesh import Floats

BYTES_PER_PIXEL = 4 + 3 + 1
"""Size of a pixel: distance, colour, instance."""
Planes = tuple[npt.NDArray[np.uint8], npt.NDArray[np.uint8], Floats]
"""Colour, instance and distance of a picture."""


def camera_bytes(camera: Camera) -> int:
    """Return the size of a camera's picture."""
    return camera.intrinsics.width_px * camera.intrinsics.height_px * BYTES_PER_PIXEL


def places_of(cameras: Mapping[str, Camera]) -> dict[str, int]:
    """Return where in the memory each picture begins, a multiple of the size of a float."""
    places, place = {}, 0
    for name, camera in cameras.items():
        places[name] = place
        place += camera_bytes(camera)
    return places


def planes(pixels: mmap.mmap, place: int, camera: Camera) -> Planes:
    """Return colour, instance and distance of the picture that begins at a place."""
    rows, columns = camera.intrinsics.height_px, camera.intrinsics.width_px
    count = rows * columns
    distance = np.frombuffer(pixels, np.float32, count, place)
    colour = np.frombuffer(pixels, np.uint8, 3 * count, place + 4 * count)
    instance = np.frombuffer(pixels, np.uint8, count, place + 7 * count)
    shape = rows, columns
    return colour.reshape(*shape, 3), instance.reshape(shape), distance.reshape(shape)
