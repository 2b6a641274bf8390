"""Big pictures in tiles."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pictures import BlobDetector, background, with_blobs

from airhilt.workers.vision.detector import Found, Picture
from airhilt.workers.vision.tiling import OVERLAP_PX, TILE_PX, Tiled


def test_small_pictures_are_looked_at_in_one_piece() -> None:
    detector = BlobDetector()
    Tiled(detector).detect(background(1280, 720))
    assert detector.asked == [(720, 1280)]
    assert Tiled(detector).name == detector.name


@pytest.mark.parametrize(("columns", "rows"), [(1920, 1080), (1281, 200), (100, 3000)])
def test_tiles_are_small_and_leave_nothing_out(columns: int, rows: int) -> None:
    class Covering(BlobDetector):
        def __init__(self) -> None:
            self.seen = np.zeros(rows * columns, dtype=bool)

        def detect(self, picture: Picture) -> list[Found]:
            assert max(picture.shape) <= TILE_PX
            self.seen[picture.astype(int) @ (1, 256, 65_536)] = True
            return []

    numbers = np.arange(rows * columns, dtype="<u4").view(np.uint8).reshape(rows, columns, 4)
    detector = Covering()
    Tiled(detector).detect(numbers[..., :3])
    assert detector.seen.all()


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
    found = Tiled(BlobDetector()).detect(with_blobs(flat, [("airplane", box)]))
    assert [(one.label, one.box) for one in found] == [("airplane", box)]


def test_different_things_side_by_side_stay_two() -> None:
    flat = np.full((1080, 1920, 3), 100, np.uint8)
    blobs = [("truck", (600, 300, 640, 330)), ("truck", (642, 300, 682, 330))]
    found = Tiled(BlobDetector()).detect(with_blobs(flat, blobs))  # type: ignore[arg-type]
    assert sorted(one.box for one in found) == [box for _, box in blobs]
