"""Rays that runs share: what moving cameras meet of the landscape, kept by view and landscape."""

from __future__ import annotations

import json
import zlib
from collections.abc import Callable
from dataclasses import astuple

import numpy as np
import numpy.typing as npt

from airhilt.host.caches import CacheFolder
from airhilt.imaging.view import View, Window
from airhilt.sensors.cameras.drawing_keys import arrays_sha256, drawn_by, view_key
from airhilt.shapes.mesh import Floats

Pieces = npt.NDArray[np.intp]
"""Numbers of pieces of the landscape."""
COMPRESSION = 1
"""Level of zlib: a window of 640 by 360 pixels takes some 10 kB."""


class SharedRays:
    """Hits of rays on one landscape.

    Parameters
    ----------
    library
        Library that casts the rays, with its version.
    corners
        Corners of the triangles, shape (n, 3, 3).
    piece_of
        Piece of each triangle.
    """

    def __init__(self, library: str, corners: Floats, piece_of: Pieces) -> None:
        self._folder = CacheFolder("rays")
        self._scene = [*drawn_by(library), arrays_sha256((corners, piece_of))]
        self._type = np.min_scalar_type(int(piece_of.max(initial=0)))

    def get(self, view: View, window: Window, cast: Callable[[], Pieces]) -> Pieces:
        """Return the piece that each pixel of a window shows, found by rays if nobody has yet."""
        key = json.dumps([*self._scene, view_key(view), astuple(window)])
        packed = self._folder.get(key, lambda: self._packed(cast()))
        pieces = np.frombuffer(zlib.decompress(packed), self._type)
        return pieces.reshape(window.height, window.width).astype(np.intp)

    def _packed(self, pieces: Pieces) -> bytes:
        return zlib.compress(pieces.astype(self._type).tobytes(), COMPRESSION)
