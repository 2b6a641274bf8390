"""Tiles of big pictures, so that a detector sees them at their own resolution."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import product
from typing import NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from airhilt.assistant.vision.detector import GRID_PX, SAME_OVERLAP, Found
from airhilt.imaging.boxes import moved, overlap, share_of_smaller
from airhilt.messages import Box

GREATEST_SIDE_PX = 1280
"""Longest side of a picture that is looked at in one piece, in pixels."""
TILE_PX = 640
OVERLAP_PX = 128
"""Least overlap of tiles, in pixels: what is smaller is whole in at least one tile."""
SAME_SHARE = 0.7
EDGE_PX = 1.0


Pixel = TypeVar("Pixel", bound=np.generic)


class Tile(NamedTuple):
    """A part of a picture, in pixels."""

    top: int
    left: int
    height: int
    width: int

    def of(self, picture: npt.NDArray[Pixel]) -> npt.NDArray[Pixel]:
        """Return the pixels of the part."""
        return picture[self.top : self.top + self.height, self.left : self.left + self.width]

    @property
    def box(self) -> Box:
        """Box about the whole part."""
        return self.left, self.top, self.left + self.width, self.top + self.height

    def holds(self, place: tuple[float, float]) -> bool:
        """Return whether a place, column and row, is in the part."""
        column, row = place
        return 0.0 <= column - self.left < self.width and 0.0 <= row - self.top < self.height


class Piece(NamedTuple):
    """A finding in a tile, with its box in the picture."""

    found: Found
    is_cut: bool
    """True if its box ends where the tile does and the picture does not."""


def tiles_of(shape: Sequence[int]) -> list[Tile]:
    """Return overlapping tiles of a big picture of a shape, and a small one in one piece."""
    rows, columns = shape[:2]
    if max(rows, columns) <= GREATEST_SIDE_PX:
        return [Tile(0, 0, rows, columns)]
    return [
        Tile(top, left, min(TILE_PX, rows - top), min(TILE_PX, columns - left))
        for top, left in product(_starts(rows), _starts(columns))
    ]


def pieces_of(found: Iterable[Found], tile: Tile, shape: Sequence[int]) -> list[Piece]:
    """Return the findings in a tile of a picture, with their boxes in the picture."""
    rows, columns = shape[:2]
    top, left, height, width = tile
    return [
        Piece(
            one._replace(box=moved(one.box, left, top)),
            is_cut=(left > 0 and one.box[0] < EDGE_PX)
            or (top > 0 and one.box[1] < EDGE_PX)
            or (left + width < columns and one.box[2] > width - EDGE_PX)
            or (top + height < rows and one.box[3] > height - EDGE_PX),
        )
        for one in found
    ]


def merged(pieces: Sequence[Piece]) -> list[Found]:
    """Return each thing once, by falling confidence.

    Where several tiles show one thing, a whole finding is kept before one that an edge cuts, and
    then the more confident one. Pieces of a thing that is bigger than the overlap may stay pieces.
    """
    kept: list[Found] = []
    for piece in sorted(pieces, key=lambda each: (each.is_cut, -each.found.confidence)):
        if not any(_is_same(piece.found, other) for other in kept):
            kept.append(piece.found)
    return sorted(kept, key=lambda found: -found.confidence)


def _is_same(one: Found, other: Found) -> bool:
    """Return whether two findings are on one body; pieces of one class may overlap less."""
    return overlap(one.box, other.box) > SAME_OVERLAP or (
        one.label == other.label and share_of_smaller(one.box, other.box) > SAME_SHARE
    )


def _starts(length: int) -> list[int]:
    """Return the begins of tiles along a side: even, on the grid, with enough overlap."""
    if length <= TILE_PX:
        return [0]
    last = length - TILE_PX
    count = -(-last // (TILE_PX - OVERLAP_PX - 2 * GRID_PX))
    starts = [last * index // count // GRID_PX * GRID_PX for index in range(count)]
    return [*starts, -(-last // GRID_PX) * GRID_PX]
