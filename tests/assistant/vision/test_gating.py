"""Looking again only where a picture has changed."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.assistant.vision.changes import MARGIN_PX, windows_about
from airhilt.assistant.vision.detector import Found, Picture, PictureMissed, Shot
from airhilt.assistant.vision.gating import Gate
from airhilt.assistant.vision.tiling import Tile, tiles_of
from airhilt.imaging.boxes import area, moved, shared_area
from airhilt.imaging.pinhole import Pinhole
from airhilt.messages import Box
from airhilt.units import SECOND_NS
from pictures import COLOURS, PERIOD_NS, Blob, BlobDetector, background, camera_view, with_blobs

BIG = 1920, 1080


def test_an_identical_picture_has_the_same_in_it_without_a_look() -> None:
    detector = BlobDetector()
    gate = Gate(detector)
    picture = with_blobs(background(), [("truck", (100, 100, 130, 120))])
    first, *others = [gate.look(Shot("tower", 0), picture.copy()) for _ in range(100)]
    assert len(first) == 1
    assert all(found == first for found in others)
    assert detector.asked == [(360, 640)]


def test_in_a_big_picture_only_tiles_with_a_change_are_looked_at() -> None:
    detector = BlobDetector()
    gate = Gate(detector)
    scene = with_blobs(background(*BIG), [("airplane", (1400, 60, 1460, 80))])
    tiles = len(tiles_of(scene.shape))
    gate.look(Shot("tower", 0), scene)
    assert len(detector.asked) == tiles
    # In the corner of the first tile, where no other tile is.
    moved = with_blobs(scene, [("truck", (100, 200, 124, 212))])
    found = gate.look(Shot("tower", 0), moved)
    assert len(detector.asked) == tiles + 1
    assert found == Gate(BlobDetector()).look(Shot("tower", 0), moved)
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


def require_what_a_look_at_everything_finds(
    scenes: Sequence[Sequence[Blob]], still: Sequence[Blob]
) -> None:
    gate = Gate(BlobDetector())
    for blobs in scenes:
        picture = with_blobs(background(1400, 200), [*still, *blobs])
        assert gate.look(Shot("tower", 0), picture) == Gate(BlobDetector()).look(
            Shot("tower", 0), picture
        )


@settings(max_examples=6, deadline=None)
@given(scenes=st.lists(BLOBS, min_size=2, max_size=3), still=BLOBS)
def test_it_finds_what_a_look_at_everything_finds(
    scenes: list[list[Blob]], still: list[Blob]
) -> None:
    require_what_a_look_at_everything_finds(scenes, still)


def test_a_faint_change_counts_once_it_has_added_up() -> None:
    detector = BlobDetector()
    gate, scene = Gate(detector), background()
    for step in range(4):
        gate.look(Shot("tower", 0), scene + np.uint8(step))
    assert len(detector.asked) == 2


def test_cameras_do_not_know_of_each_other() -> None:
    detector = BlobDetector()
    gate = Gate(detector)
    empty, full = background(), with_blobs(background(), [("truck", (50, 50, 80, 70))])
    for _ in range(3):
        assert not gate.look(Shot("tower", 0), empty)
        assert gate.look(Shot("runway", 0), full)
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
        gate.look(Shot("tower", 0), truck)
    assert gate.look(Shot("tower", 0), truck)


def test_who_writes_into_a_picture_afterwards_changes_nothing() -> None:
    gate = Gate(BlobDetector())
    picture = with_blobs(background(), [("truck", (50, 50, 80, 70))])
    assert gate.look(Shot("tower", 0), picture)
    picture[:] = background()
    assert not gate.look(Shot("tower", 0), picture)


# --- windows, of detectors that see parts ---------------------------------------------------


class PartBlobDetector(BlobDetector):
    """Sees parts of pictures too."""

    def detect_in(self, picture: Picture, part: Tile, shot: Shot) -> list[Found]:
        found = self.detect(part.of(picture))
        return [one._replace(box=moved(one.box, part.left, part.top)) for one in found]


def places(found: Sequence[Found]) -> set[tuple[str, Box]]:
    return {(one.label, one.box) for one in found}


def test_only_a_window_about_a_small_change_is_looked_at() -> None:
    detector = PartBlobDetector()
    gate, scene = Gate(detector), with_blobs(background(), [("truck", (20, 20, 50, 40))])
    gate.look(Shot("tower", 0), scene)
    found = gate.look(Shot("tower", 0), with_blobs(scene, [("airplane", (400, 200, 430, 210))]))
    assert {one.label for one in found} == {"airplane", "truck"}
    rows, columns = detector.asked[-1]
    assert 10 + 2 * MARGIN_PX <= rows < 180
    assert 30 + 2 * MARGIN_PX <= columns < 220


def test_what_a_window_would_cut_is_looked_at_as_a_whole() -> None:
    detector = PartBlobDetector()
    gate, scene = Gate(detector), with_blobs(background(), [("airplane", (100, 100, 300, 120))])
    gate.look(Shot("tower", 0), scene)
    lit = scene.copy()
    lit[90, 110] = 255
    assert places(gate.look(Shot("tower", 0), lit)) == {("airplane", (100.0, 100.0, 300.0, 120.0))}
    assert detector.asked[-1][1] >= 200


def test_what_reaches_out_of_a_window_is_told_if_its_middle_is_in_it() -> None:
    class FarReaching(PartBlobDetector):
        def detect_in(self, picture: Picture, part: Tile, shot: Shot) -> list[Found]:
            _, top, right, bottom = part.box
            inner = right - 30.0, top, right + 20.0, bottom
            outer = right - 20.0, top, right + 30.0, bottom
            return [Found("bird", 0.4, inner), Found("truck", 0.9, outer)]

    gate, scene = Gate(FarReaching()), background()
    gate.look(Shot("tower", 0), scene)
    found = gate.look(Shot("tower", 0), with_blobs(scene, [("bird", (300, 100, 306, 104))]))
    assert [one.label for one in found] == ["bird"]


@pytest.mark.parametrize("size", [
    pytest.param((640, 360), marks=pytest.mark.slow),
    pytest.param((1400, 200), marks=pytest.mark.slow), (645, 361),
])  # fmt: skip
@settings(max_examples=20, deadline=None)
@given(scenes=st.lists(BLOBS, min_size=2, max_size=5), still=BLOBS)
def test_windows_find_what_a_look_at_everything_finds(
    size: tuple[int, int], scenes: list[list[Blob]], still: list[Blob]
) -> None:
    gate = Gate(PartBlobDetector())
    for blobs in scenes:
        picture = with_blobs(background(*size), [*still, *blobs])
        found = places(gate.look(Shot("tower", 0), picture))
        assert found == places(Gate(BlobDetector()).look(Shot("tower", 0), picture))


@given(
    changed=st.sets(st.tuples(st.integers(0, 22), st.integers(0, 39)), max_size=12),
    boxes=st.lists(
        st.builds(
            lambda left, top, wide, high: (left, top, min(left + wide, 640.0), top + high),
            st.floats(0.0, 600.0), st.floats(0.0, 300.0), st.floats(1.0, 200.0),
            st.floats(1.0, 60.0),
        ),
        max_size=4,
    ),
)  # fmt: skip
def test_windows_hold_changes_and_cut_nothing_that_was_there(
    changed: set[tuple[int, int]], boxes: list[Box]
) -> None:
    blocks = np.zeros((23, 40), dtype=bool)
    for row, column in changed:
        blocks[row, column] = True
    windows = windows_about(blocks, boxes, 360, 640)
    held = np.zeros((360, 640), dtype=int)
    for window in windows:
        window.of(held)[...] += 1
    assert held.max(initial=0) <= 1
    assert all(
        held[16 * row : 16 * row + 16, 16 * column : 16 * column + 16].all()
        for row, column in changed
    )
    for box in boxes:
        shared = [shared_area(box, window.box) for window in windows]
        assert max(shared, default=0.0) in (0.0, pytest.approx(area(box)))


# --- cameras that move ------------------------------------------------------------------------

WIDE = background(800, 360)
LENS = Pinhole(camera_view())


class Flight:
    """A camera on an aircraft that turns; its pictures are parts of a wide one."""

    def __init__(self) -> None:
        self.detector = PartBlobDetector()
        self._gate = Gate(self.detector)
        self._expected: list[Box] = []

    def look(self, at_s: float, left: int, blobs: Sequence[Blob] = ()) -> list[Found]:
        """Look at a picture that begins at a column of the wide one."""
        turn_deg = math.degrees(math.atan(left / LENS.focal_px))
        view = camera_view(heading_deg=turn_deg, carrier="AAL123")
        picture = with_blobs(WIDE[:, left : left + 640], blobs)
        shot = Shot("nose", round(at_s * SECOND_NS), view=view)
        found = self._gate.look(shot, picture, self._expected)
        self._expected = [one.box for one in found]
        return found


def looks_of_flight(lefts: Sequence[int], period_s: float = 0.0625) -> list[tuple[int, int]]:
    flight = Flight()
    for number, left in enumerate(lefts):
        flight.look(period_s * number, left)
    return flight.detector.asked


@pytest.mark.parametrize("step_px", [1, 9])
def test_a_turn_that_the_header_tells_is_no_reason_for_a_look(step_px: int) -> None:
    assert looks_of_flight(range(0, 16 * step_px, step_px)) == [(360, 640)]


def test_all_that_changes_is_looked_at_once_a_second() -> None:
    assert looks_of_flight(range(33)) == [(360, 640)] * 3
    assert looks_of_flight([7] * 33) == [(360, 640)]


def test_what_a_turn_does_not_explain_is_looked_at_a_few_times_a_second() -> None:
    detector = PartBlobDetector()
    gate = Gate(detector)
    for number in range(16):
        shot = Shot("nose", number * PERIOD_NS, view=camera_view(carrier="AAL123"))
        gate.look(shot, background(seed=number))
    assert detector.asked == [(360, 640)] * 6


def test_what_appears_while_the_camera_turns_is_found_at_once_in_a_window() -> None:
    flight = Flight()
    assert not flight.look(0.0, 0)
    assert places(flight.look(0.0625, 3, [("airplane", (300, 100, 330, 112))])) == {
        ("airplane", (300.0, 100.0, 330.0, 112.0))
    }
    rows, columns = flight.detector.asked[-1]
    assert rows * columns < 0.15 * 640 * 360


def test_what_is_followed_is_looked_at_in_each_picture_though_it_moves_little() -> None:
    flight = Flight()
    boxes = [(300 + step, 100, 330 + step, 112) for step in range(8)]
    for step, box in enumerate(boxes):
        found = flight.look(0.0625 * step, 2 * step, [("airplane", box)])
        assert places(found) == {("airplane", tuple(map(float, box)))}
    assert flight.detector.asked.count((360, 640)) == 1
