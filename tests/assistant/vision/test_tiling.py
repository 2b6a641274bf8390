"""Big pictures in tiles."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.assistant.vision.detector import Found, Shot
from airhilt.assistant.vision.gating import Gate
from airhilt.assistant.vision.tiling import OVERLAP_PX, TILE_PX, Piece, Tile, merged, tiles_of
from pictures import BlobDetector, background, with_blobs


def test_small_pictures_are_looked_at_in_one_piece() -> None:
    assert tiles_of((720, 1280)) == [Tile(0, 0, 720, 1280)]


@pytest.mark.parametrize(("columns", "rows"), [(1920, 1080), (1281, 200), (100, 3000)])
def test_tiles_are_small_and_leave_nothing_out(columns: int, rows: int) -> None:
    picture = background(columns, rows)
    seen = np.zeros((rows, columns), dtype=bool)
    for tile in tiles_of(picture.shape):
        assert max(tile.height, tile.width) <= TILE_PX
        assert tile.of(picture).shape[:2] == (tile.height, tile.width)
        tile.of(seen)[...] = True
    assert seen.all()


@settings(max_examples=8, deadline=None)
@given(
    left=st.integers(0, 1919),
    top=st.integers(0, 1079),
    width=st.integers(2, OVERLAP_PX),
    height=st.integers(2, OVERLAP_PX),
)
def test_what_is_smaller_than_the_overlap_is_found_once_and_whole(
    left: int, top: int, width: int, height: int
) -> None:
    box = (left, top, min(left + width, 1920), min(top + height, 1080))
    flat = np.full((1080, 1920, 3), 100, np.uint8)
    found = Gate(BlobDetector()).look(Shot("tower", 0), with_blobs(flat, [("airplane", box)]))
    assert [(one.label, one.box) for one in found] == [("airplane", box)]


def test_what_two_tiles_take_for_different_things_is_one() -> None:
    box, beside = (600.0, 300.0, 640.0, 330.0), (602.0, 300.0, 642.0, 330.0)
    confident, doubtful = Found("airplane", 0.9, box), Found("truck", 0.5, beside)
    assert merged([Piece(doubtful, is_cut=False), Piece(confident, is_cut=False)]) == [confident]


def test_different_things_side_by_side_stay_two() -> None:
    flat = np.full((1080, 1920, 3), 100, np.uint8)
    blobs = [("truck", (600, 300, 640, 330)), ("truck", (642, 300, 682, 330))]
    found = Gate(BlobDetector()).look(Shot("tower", 0), with_blobs(flat, blobs))
    assert sorted(one.box for one in found) == [box for _, box in blobs]
