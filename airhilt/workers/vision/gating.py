"""Looks again only where a picture has changed.

A camera that stands still sees the same background in every picture, and in the air pictures are
often the same to the bit though the camera has moved. Each tile of a picture is compared with what
was there when it was last looked at, and what was found in it stays until a pixel has changed. So
the answers are those of a look at everything, but for changes too faint to count.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from airhilt.workers.vision.detector import Detector, Found, Picture
from airhilt.workers.vision.tiling import Tile, merged, pieces_of, tiles_of

LEAST_CHANGE = 2
"""Levels of 255 by which a pixel must change."""
ROWS_AT_ONCE = 16


class _Looked(NamedTuple):
    """What a tile was like when it was last looked at."""

    pixels: Picture
    found: tuple[Found, ...]


class Gate:
    """Puts a detector behind a watch for changes, for any number of cameras.

    Small pictures are looked at in one piece, big ones in tiles.
    """

    def __init__(self, detector: Detector) -> None:
        self._detector = detector
        self._looked: dict[tuple[str, Tile], _Looked] = {}

    def look(self, camera: str, picture: Picture) -> list[Found]:
        """Return what is in the next picture of a camera, the surest first.

        Raises
        ------
        airhilt.errors.VisionError
            The detector has failed.
        """
        tiles = tiles_of(picture)
        found = [self._look_at(camera, tile, picture) for tile in tiles]
        if len(tiles) == 1:
            return list(found[0])
        return merged([
            piece
            for tile, these in zip(tiles, found, strict=True)
            for piece in pieces_of(these, tile, picture)
        ])  # fmt: skip

    def _look_at(self, camera: str, tile: Tile, picture: Picture) -> tuple[Found, ...]:
        """Return what is in a tile, with boxes as they are in it."""
        pixels = tile.of(picture)
        last = self._looked.get((camera, tile))
        if last is None or has_changed(last.pixels, pixels):
            kept = pixels.copy()
            last = _Looked(kept, tuple(self._detector.detect(kept)))
            self._looked[camera, tile] = last
        return last.found


def has_changed(before: Picture, after: Picture) -> bool:
    """Return whether any pixel has changed by `LEAST_CHANGE` or more."""
    for first in range(0, len(before), ROWS_AT_ONCE):
        one, other = before[first : first + ROWS_AT_ONCE], after[first : first + ROWS_AT_ONCE]
        if not np.array_equal(one, other):
            change = np.maximum(one, other) - np.minimum(one, other)
            if change.max() >= LEAST_CHANGE:
                return True
    return False
