"""Big pictures in tiles, so that a detector sees them at their own resolution."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import product
from typing import NamedTuple

from airhilt.assistant.vision.detector import GRID_PX, SAME_OVERLAP, Found, Picture
from airhilt.imaging.boxes import moved, overlap, share_of_smaller
from airhilt.messages import Box

GREATEST_SIDE_PX = 1280
"""Pictures up to this are looked at in one piece."""
TILE_PX = 640
OVERLAP_PX = 128
"""What is smaller than this is whole in at least one tile."""
SAME_SHARE = 0.7
EDGE_PX = 1.0


class Tile(NamedTuple):
    """A part of a picture, in pixels."""

    top: int
    left: int
    height: int
    width: int

    def of(self, picture: Picture) -> Picture:
        """Return its pixels."""
        return picture[self.top : self.top + self.height, self.left : self.left + self.width]

    @property
    def box(self) -> Box:
        """About all of it."""
        return self.left, self.top, self.left + self.width, self.top + self.height

    def holds(self, place: tuple[float, float]) -> bool:
        """Return whether a place, column and row, is in it."""
        column, row = place
        return 0.0 <= column - self.left < self.width and 0.0 <= row - self.top < self.height


class Piece(NamedTuple):
    """What was found in a tile, where it is in the picture."""

    found: Found
    is_cut: bool
    """Its box ends where the tile does, and the picture does not."""


def tiles_of(picture: Picture) -> list[Tile]:
    """Return overlapping tiles of a big picture, and a small one in one piece."""
    rows, columns = picture.shape[:2]
    if max(rows, columns) <= GREATEST_SIDE_PX:
        return [Tile(0, 0, rows, columns)]
    return [
        Tile(top, left, min(TILE_PX, rows - top), min(TILE_PX, columns - left))
        for top, left in product(_starts(rows), _starts(columns))
    ]


def pieces_of(found: Iterable[Found], tile: Tile, picture: Picture) -> list[Piece]:
    """Return what was found in a tile of a picture."""
    rows, columns = picture.shape[:2]
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
    """Return each thing once, the surest first.

    Of what is found in several tiles the whole ones count before those that an edge cuts, and
    then the surest. Pieces of what is bigger than the overlap may stay pieces.
    """
    kept: list[Found] = []
    for piece in sorted(pieces, key=lambda each: (each.is_cut, -each.found.confidence)):
        if not any(_is_same(piece.found, other) for other in kept):
            kept.append(piece.found)
    return sorted(kept, key=lambda found: -found.confidence)


def _is_same(one: Found, other: Found) -> bool:
    """Return whether two are on one body: for pieces of one class less is enough."""
    return overlap(one.box, other.box) > SAME_OVERLAP or (
        one.label == other.label and share_of_smaller(one.box, other.box) > SAME_SHARE
    )


def _starts(length: int) -> list[int]:
    """Return where tiles begin along a side: evenly, on the grid, overlapping enough."""
    if length <= TILE_PX:
        return [0]
    last = length - TILE_PX
    count = -(-last // (TILE_PX - OVERLAP_PX - 2 * GRID_PX))
    starts = [last * index // count // GRID_PX * GRID_PX for index in range(count)]
    return [*starts, -(-last // GRID_PX) * GRID_PX]
