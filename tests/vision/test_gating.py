"""Looking again only where a picture has changed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pictures import COLOURS, Blob, BlobDetector, background, with_blobs

from airhilt.workers.vision.detector import Found, Picture, PictureMissed
from airhilt.workers.vision.gating import Gate, has_changed
from airhilt.workers.vision.tiling import tiles_of

BIG = 1920, 1080


def test_an_identical_picture_has_the_same_in_it_without_a_look() -> None:
    detector = BlobDetector()
    gate = Gate(detector)
    picture = with_blobs(background(), [("truck", (100, 100, 130, 120))])
    first, *others = [gate.look("tower", picture.copy()) for _ in range(100)]
    assert len(first) == 1
    assert all(found == first for found in others)
    assert detector.asked == [(360, 640)]


def test_in_a_big_picture_only_tiles_with_a_change_are_looked_at() -> None:
    detector = BlobDetector()
    gate = Gate(detector)
    scene = with_blobs(background(*BIG), [("airplane", (1400, 60, 1460, 80))])
    tiles = len(tiles_of(scene))
    gate.look("tower", scene)
    assert len(detector.asked) == tiles
    # In the corner of the first tile, where no other tile is.
    moved = with_blobs(scene, [("truck", (100, 200, 124, 212))])
    found = gate.look("tower", moved)
    assert len(detector.asked) == tiles + 1
    assert found == Gate(BlobDetector()).look("tower", moved)
    assert {one.label for one in found} == {"airplane", "truck"}


BLOBS = st.lists(
    st.builds(
        lambda label, left, top, width, height: (
            label,
            (left, top, min(left + width, 1400), min(top + height, 200)),
        ),
        st.sampled_from(sorted(COLOURS)),
        st.integers(0, 1399),
        st.integers(0, 199),
        st.integers(1, 60),
        st.integers(1, 60),
    ),
    max_size=4,
)


@settings(max_examples=40, deadline=None)
@given(scenes=st.lists(BLOBS, min_size=2, max_size=4), still=BLOBS)
def test_it_finds_what_a_look_at_everything_finds(
    scenes: list[list[Blob]], still: list[Blob]
) -> None:
    gate = Gate(BlobDetector())
    for blobs in scenes:
        picture = with_blobs(background(1400, 200), [*still, *blobs])
        assert gate.look("tower", picture) == Gate(BlobDetector()).look("tower", picture)


def test_what_vanishes_is_not_found_any_more() -> None:
    gate, scene = Gate(BlobDetector()), background()
    assert gate.look("tower", with_blobs(scene, [("bird", (300, 100, 306, 104))]))
    assert not gate.look("tower", scene)


def test_a_faint_change_counts_once_it_has_added_up() -> None:
    detector = BlobDetector()
    gate, scene = Gate(detector), background()
    for step in range(4):
        gate.look("tower", scene + np.uint8(step))
    assert len(detector.asked) == 2


def test_cameras_do_not_know_of_each_other() -> None:
    detector = BlobDetector()
    gate = Gate(detector)
    empty, full = background(), with_blobs(background(), [("truck", (50, 50, 80, 70))])
    for _ in range(3):
        assert not gate.look("tower", empty)
        assert gate.look("runway", full)
    assert len(detector.asked) == 2


def test_a_picture_that_was_missed_is_looked_at_again() -> None:
    class Late(BlobDetector):
        def detect(self, picture: Picture) -> list[Found]:
            found = list(super().detect(picture))
            if len(self.asked) == 1:
                raise PictureMissed("detector late: no answer")
            return found

    gate, truck = Gate(Late()), with_blobs(background(), [("truck", (50, 50, 80, 70))])
    with pytest.raises(PictureMissed):
        gate.look("tower", truck)
    assert gate.look("tower", truck)


def test_who_writes_into_a_picture_afterwards_changes_nothing() -> None:
    gate = Gate(BlobDetector())
    picture = with_blobs(background(), [("truck", (50, 50, 80, 70))])
    assert gate.look("tower", picture)
    picture[:] = background()
    assert not gate.look("tower", picture)


@pytest.mark.parametrize(("level", "expected"), [(8, False), (10, False), (7, True), (11, True)])
def test_one_pixel_in_an_odd_corner_is_a_change_from_two_levels_on(
    level: int, expected: bool
) -> None:
    before = np.full((361, 645, 3), 9, np.uint8)
    after = before.copy()
    after[360, 644, 2] = level
    assert has_changed(before, after) is expected
