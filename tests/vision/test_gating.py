"""Looking again only where a picture has changed."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from pictures import COLOURS, PERIOD_NS, Blob, BlobDetector, background, camera_view, with_blobs

from airhilt.workers.vision.detector import Found, Picture
from airhilt.workers.vision.gating import (
    WHOLE,
    Gate,
    GateSettings,
    changed_cells,
    gate_of,
    windows_of,
)

VIEW = camera_view()
CHANGES = GateSettings.of_reach(BlobDetector.REACH_PX)
NEVER_WHOLE = GateSettings(whole_every_s=1e6, most_area=1.0)


def looks(gate: Gate, *pictures: Picture, first: int = 0) -> list[list[object]]:
    return [
        list(gate.look("tower", VIEW, (first + index) * PERIOD_NS, picture))
        for index, picture in enumerate(pictures)
    ]


def test_how_far_to_look_comes_from_the_detector() -> None:
    class Near(BlobDetector):
        reach_px = 33.0

    class Unknown(BlobDetector):
        reach_px = None

    near = gate_of(Near())
    assert (near.reach_cells, near.context_cells) == (3, 6)
    assert near.most_windows > 0
    assert gate_of(Unknown()) == gate_of(BlobDetector()) == WHOLE


def test_an_identical_picture_has_the_same_in_it_without_a_look() -> None:
    detector = BlobDetector()
    picture = with_blobs(background(), [("truck", (100, 100, 130, 120))])
    first, *others = looks(Gate(detector, CHANGES), *[picture.copy() for _ in range(100)])
    assert len(first) == 1
    assert all(found == first for found in others)
    assert len(detector.asked) == 1


def test_what_moves_is_looked_at_in_a_small_window() -> None:
    detector = BlobDetector()
    scene = with_blobs(background(), [("airplane", (400, 60, 460, 80))])
    pictures = [
        with_blobs(scene, [("truck", (100 + 3 * step, 200, 124 + 3 * step, 212))])
        for step in range(12)
    ]
    found = looks(Gate(detector, CHANGES), *pictures)
    assert found == [list(BlobDetector().detect(picture)) for picture in pictures]
    assert detector.asked[0] == (360, 640)
    assert all(rows <= 288 and columns <= 320 for rows, columns in detector.asked[1:])


SMALL = camera_view(320, 200)
NEAR = GateSettings(reach_cells=2, context_cells=2, whole_every_s=1e6, most_area=1.0)
"""Just as far as the detector of blobs sees."""
BLOBS = st.lists(
    st.builds(
        lambda label, left, top, width, height: (
            label,
            (left, top, min(left + width, 320), min(top + height, 200)),
        ),
        st.sampled_from(sorted(COLOURS)),
        st.integers(0, 319),
        st.integers(0, 199),
        st.integers(1, 60),
        st.integers(1, 60),
    ),
    max_size=4,
)


@settings(max_examples=40, deadline=None)
@given(scenes=st.lists(BLOBS, min_size=2, max_size=4), still=BLOBS)
def test_it_finds_what_a_look_at_the_whole_finds(
    scenes: list[list[Blob]], still: list[Blob]
) -> None:
    gate = Gate(BlobDetector(), NEAR)
    for step, blobs in enumerate(scenes):
        picture = with_blobs(background(320, 200), [*still, *blobs])
        found = gate.look("tower", SMALL, step * PERIOD_NS, picture)
        assert sorted(found) == sorted(BlobDetector().detect(picture))


def test_what_vanishes_is_not_found_any_more() -> None:
    scene = background()
    first, second = looks(
        Gate(BlobDetector(), CHANGES), with_blobs(scene, [("bird", (300, 100, 306, 104))]), scene
    )
    assert first
    assert not second


def test_a_faint_change_counts_once_it_has_added_up() -> None:
    detector = BlobDetector()
    scene = background()
    pictures = [scene + np.uint8(step) for step in range(4)]
    looks(Gate(detector, NEVER_WHOLE), *pictures)
    assert len(detector.asked) == 2


def test_much_change_is_looked_at_as_a_whole() -> None:
    detector = BlobDetector()
    looks(Gate(detector, CHANGES), background(seed=1), background(seed=2))
    assert detector.asked == [(360, 640), (360, 640)]


def test_the_whole_is_looked_at_again_after_a_second() -> None:
    detector = BlobDetector()
    scene = background()
    pictures = [
        with_blobs(scene, [("bird", (100 + step, 100, 110 + step, 110))]) for step in range(33)
    ]
    looks(Gate(detector, CHANGES), *pictures)
    assert [asked == (360, 640) for asked in detector.asked] == [
        step % 16 == 0 for step in range(33)
    ]


def test_a_camera_that_moves_is_looked_at_as_a_whole() -> None:
    detector = BlobDetector()
    gate = Gate(detector, CHANGES)
    scene = background()
    for step in range(4):
        view = camera_view(heading_deg=float(step))
        bird = ("bird", (9 + step, 9, 19 + step, 19))
        gate.look("nose", view, step * PERIOD_NS, with_blobs(scene, [bird]))
    assert detector.asked == [(360, 640)] * 4


def test_a_camera_that_moves_and_sees_the_same_to_the_bit_is_not_asked_again() -> None:
    detector = BlobDetector()
    gate = Gate(detector, CHANGES)
    scene = with_blobs(background(), [("bird", (9, 9, 19, 19))])
    found = [
        gate.look("nose", camera_view(heading_deg=float(step)), step * PERIOD_NS, scene.copy())
        for step in range(4)
    ]
    assert detector.asked == [(360, 640)]
    assert found == [found[0]] * 4


def test_cameras_do_not_know_of_each_other() -> None:
    detector = BlobDetector()
    gate = Gate(detector, CHANGES)
    empty, full = background(), with_blobs(background(), [("truck", (50, 50, 80, 70))])
    for step in range(3):
        assert not gate.look("tower", VIEW, step * PERIOD_NS, empty)
        assert gate.look("runway", VIEW, step * PERIOD_NS, full)
    assert len(detector.asked) == 2


def test_a_detector_that_sees_far_looks_at_the_whole_unless_nothing_changed() -> None:
    detector = BlobDetector()
    scene = background()
    moved = with_blobs(scene, [("bird", (100, 100, 110, 110))])
    looks(Gate(detector, WHOLE), scene, scene, moved, moved)
    assert detector.asked == [(360, 640)] * 2


def test_what_is_longer_than_its_window_is_looked_at_as_a_whole() -> None:
    class Long(BlobDetector):
        """Takes the whole width of what it sees for an airplane, once there is a truck."""

        def detect(self, picture: Picture) -> list[Found]:
            rows, columns = picture.shape[:2]
            box = (0.0, 0.0, float(columns), float(rows))
            return [Found("airplane", 0.9, box) for _ in super().detect(picture)]

    detector = Long()
    truck = with_blobs(background(), [("truck", (320, 158, 324, 165))])
    _, second = looks(Gate(detector, NEVER_WHOLE), background(), truck)
    assert len(detector.asked) == 3
    assert second == [Found("airplane", 0.9, (0.0, 0.0, 640.0, 360.0))]


def test_neighbours_of_what_has_changed_are_found_once() -> None:
    """Each box holds the middle of the next one, and only the first has changed."""

    class Wide(BlobDetector):
        def detect(self, picture: Picture) -> list[Found]:
            rows, columns = picture.shape[:2]
            return [
                one._replace(box=(
                    max(one.box[0] - 60, 0.0), max(one.box[1] - 60, 0.0),
                    min(one.box[2] + 60, float(columns)), min(one.box[3] + 60, float(rows)),
                ))
                for one in super().detect(picture)
            ]  # fmt: skip

    row: list[Blob] = [("truck", (40 + 50 * k, 100, 50 + 50 * k, 110)) for k in range(10)]
    first = with_blobs(background(), row)
    second = with_blobs(first, [("bird", (40, 100, 50, 110))])
    _, found = looks(Gate(Wide(), NEVER_WHOLE), first, second)
    assert sorted(found) == sorted(Wide().detect(second))


def test_a_change_of_one_pixel_in_an_odd_corner_is_a_change() -> None:
    before = np.zeros((361, 645, 3), np.uint8)
    after = before.copy()
    after[360, 644, 2] = 2
    cells = changed_cells(before, after, 2)
    assert cells.shape == (23, 41)
    assert np.argwhere(cells).tolist() == [[22, 40]]


def test_windows_that_meet_become_one() -> None:
    cells = np.zeros((20, 20), dtype=bool)
    cells[2, 2:8] = cells[2:8, 2] = True  # Its rectangle holds the next one.
    cells[6, 6] = True
    cells[15:17, 15] = True
    assert windows_of(cells) == [
        (slice(2, 8), slice(2, 8)),
        (slice(15, 17), slice(15, 16)),
    ]
