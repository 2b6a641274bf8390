"""Big pictures in tiles."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.assistant.vision.detector import GRID_PX, Found, Shot
from airhilt.assistant.vision.gating import Gate
from airhilt.assistant.vision.tiling import (
    OVERLAP_PX,
    TILE_PX,
    Piece,
    merged,
    tiles_of,
)
from pictures import BlobDetector, with_blobs


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


@pytest.mark.parametrize("length", [1281, 1300, 1600, 1920, 2560, 3840, 4096])
def test_tiles_begin_on_the_grid_and_overlap_by_128_px_at_least(length: int) -> None:
    tiles = [tile for tile in tiles_of((100, length)) if tile.top == 0]
    lefts = [tile.left for tile in tiles]
    assert lefts[0] == 0
    assert all(left % GRID_PX == 0 for left in lefts)
    for tile, after in itertools.pairwise(tiles):
        assert tile.left + tile.width - after.left >= OVERLAP_PX
    assert length - GRID_PX < tiles[-1].left + TILE_PX < length + GRID_PX
    assert tiles[-1].left + tiles[-1].width == length
    # No more than there must be, and evenly.
    steps = [after - left for left, after in itertools.pairwise(lefts)]
    assert max(steps) - min(steps) <= 2 * GRID_PX
    assert len(tiles) <= -(-(length - TILE_PX) // (TILE_PX - OVERLAP_PX - 2 * GRID_PX)) + 1


def test_a_whole_finding_is_kept_before_a_surer_one_that_an_edge_cuts() -> None:
    whole, cut = (
        Found("truck", 0.5, (600, 300, 640, 330)),
        Found("truck", 0.9, (600, 300, 638, 330)),
    )
    assert merged([Piece(cut, is_cut=True), Piece(whole, is_cut=False)]) == [whole]


@pytest.mark.parametrize(("right_px", "label", "count"), [(670, "truck", 2), (650, "truck", 1),
                                                          (650, "bird", 2)])  # fmt: skip
def test_pieces_of_one_class_are_one_if_they_share_most_of_the_smaller(
    right_px: int, label: Any, count: int
) -> None:
    """Seven tenths of it; of different classes, more must overlap."""
    large, small = (500, 300, 640, 330), (right_px - 40, 300, right_px, 330)
    found = [Piece(Found("truck", 0.9, large), False), Piece(Found(label, 0.5, small), False)]
    assert len(merged(found)) == count
