"""Pixels of pictures as a `airhilt.assistant.vision.gating.Gate` has looked at them.

Nobody may ever need the pixels of a picture whose detections are known already. So pixels are
read, and put together, only when a later picture is to be compared with them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from airhilt.assistant.vision.detector import Picture
from airhilt.assistant.vision.tiling import Tile


class SeenPicture(NamedTuple):
    """A picture that a camera has sent."""

    shape: tuple[int, int, int]
    """Rows, columns and 3 colours."""
    sha256: str
    """SHA-256 of the pixels; empty if nobody asks for it."""
    read: Callable[[], Picture]
    """Returns the pixels."""
    is_made: bool = True
    """True if the pixels are there to be read, False if reading makes them."""

    @classmethod
    def of(cls, pixels: Picture) -> SeenPicture:
        """Return the picture of these pixels, which may change later."""
        rows, columns, colours = pixels.shape
        kept = pixels.copy()
        return cls((rows, columns, colours), "", lambda: kept)


class _Layer(NamedTuple):
    """Windows of a tile that show one picture."""

    read: Callable[[], Picture]
    windows: Sequence[Tile]


class KeptPixels:
    """A tile as it was when its parts were last looked at.

    Parameters
    ----------
    picture
        The picture of which the whole tile was looked at.
    """

    def __init__(self, tile: Tile, picture: SeenPicture) -> None:
        self._tile = tile
        self._whole = Tile(0, 0, tile.height, tile.width)
        self._layers: list[_Layer] = []
        self.add(picture, [self._whole])

    def add(self, picture: SeenPicture, windows: Sequence[Tile]) -> None:
        """Put windows of a later picture over what there is."""
        tile = self._tile
        self._layers.append(_Layer(lambda: tile.of(picture.read()), windows))
        if picture.is_made:
            self.read()

    def read(self) -> Picture:
        """Return the pixels; they must not be written to."""
        if len(self._layers) > 1:
            pixels = np.empty((self._whole.height, self._whole.width, 3), dtype=np.uint8)
            for layer in self._seen_layers():
                shown = layer.read()
                for window in layer.windows:
                    window.of(pixels)[...] = window.of(shown)
            self._layers = [_Layer(lambda: pixels, [self._whole])]
        return self._layers[0].read()

    def _seen_layers(self) -> list[_Layer]:
        """Return the layers that later ones do not cover, the oldest first."""
        free = np.ones((self._whole.height, self._whole.width), dtype=bool)
        seen = []
        for layer in reversed(self._layers):
            if any(window.of(free).any() for window in layer.windows):
                seen.append(layer)
                for window in layer.windows:
                    window.of(free)[...] = False
            if not free.any():
                break
        return seen[::-1]
