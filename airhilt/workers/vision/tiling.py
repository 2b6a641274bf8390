"""Big pictures in tiles, so that a detector sees them at their own resolution."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from airhilt.boxes import moved, overlap, share_of_smaller
from airhilt.workers.vision.detector import GRID_PX, Detector, Found, Picture

GREATEST_SIDE_PX = 1280
"""Pictures up to this are looked at in one piece."""
TILE_PX = 640
OVERLAP_PX = 128
"""What is smaller than this is whole in at least one tile."""
SAME_OVERLAP = 0.5
SAME_SHARE = 0.7
EDGE_PX = 1.0


class _Piece(NamedTuple):
    found: Found
    is_cut: bool
    """Its box ends where the tile does, and the picture does not."""


class Tiled:
    """Gives a detector big pictures in overlapping tiles, and small ones as they are.

    Of what is found in several tiles the whole ones count before those that an edge cuts, and
    then the surest. Pieces of what is bigger than the overlap may stay pieces.
    """

    def __init__(self, detector: Detector) -> None:
        self._detector = detector

    @property
    def name(self) -> str:
        """That of the detector."""
        return self._detector.name

    def detect(self, picture: Picture) -> Sequence[Found]:
        """Return what is in a picture; see `Detector.detect`."""
        rows, columns = picture.shape[:2]
        if max(rows, columns) <= GREATEST_SIDE_PX:
            return self._detector.detect(picture)
        pieces = [
            piece
            for top, left in product(_starts(rows), _starts(columns))
            for piece in self._pieces(picture, top, left)
        ]
        return merged(pieces)

    def _pieces(self, picture: Picture, top: int, left: int) -> list[_Piece]:
        tile = np.ascontiguousarray(picture[top : top + TILE_PX, left : left + TILE_PX])
        rows, columns = picture.shape[:2]
        height, width = tile.shape[:2]
        pieces = []
        for found in self._detector.detect(tile):
            is_cut = (
                (left > 0 and found.box[0] < EDGE_PX)
                or (top > 0 and found.box[1] < EDGE_PX)
                or (left + width < columns and found.box[2] > width - EDGE_PX)
                or (top + height < rows and found.box[3] > height - EDGE_PX)
            )
            pieces.append(_Piece(found._replace(box=moved(found.box, left, top)), is_cut))
        return pieces


def merged(pieces: Sequence[_Piece]) -> list[Found]:
    """Return each thing once, the surest first."""
    kept: list[Found] = []
    for piece in sorted(pieces, key=lambda each: (each.is_cut, -each.found.confidence)):
        if not any(_is_same(piece.found, other) for other in kept):
            kept.append(piece.found)
    return sorted(kept, key=lambda found: -found.confidence)


def _is_same(one: Found, other: Found) -> bool:
    return one.label == other.label and (
        overlap(one.box, other.box) > SAME_OVERLAP
        or share_of_smaller(one.box, other.box) > SAME_SHARE
    )


def _starts(length: int) -> list[int]:
    """Return where tiles begin along a side: evenly, on the grid, overlapping enough."""
    if length <= TILE_PX:
        return [0]
    last = length - TILE_PX
    count = -(-last // (TILE_PX - OVERLAP_PX - 2 * GRID_PX))
    starts = [last * index // count // GRID_PX * GRID_PX for index in range(count)]
    return [*starts, -(-last // GRID_PX) * GRID_PX]
