"""Following things from picture to picture."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.assistant.vision.detector import Found
from airhilt.assistant.vision.tracker import Tracker, _Track
from airhilt.imaging.view import Intrinsics, Pose, View
from airhilt.messages import CONFIRMED_HITS, CameraView, Detection
from airhilt.units import SECOND_NS
from breadth import examples
from pictures import PERIOD_NS, a, camera_view

VIEW = camera_view()
Scene = Callable[[float], list[Found]]
"""What there is at a time in seconds."""


def follow(
    tracker: Tracker, scene: Scene, steps: Iterable[int], rate_hz: float = 16.0
) -> list[list[Detection]]:
    return [
        tracker.follow(round(step * SECOND_NS / rate_hz), VIEW, scene(step / rate_hz))
        for step in steps
    ]


def finding(told: Detection) -> Found:
    return Found(told.label, told.confidence, told.box)


def ids_by_label(pictures: list[list[Detection]]) -> dict[str, set[int | None]]:
    ids: dict[str, set[int | None]] = {}
    for told in pictures:
        for one in told:
            ids.setdefault(one.label, set()).add(one.track_id)
    return ids


def ids(pictures: list[list[Detection]]) -> set[int | None]:
    return {one.track_id for told in pictures for one in told}


def test_hits_count_the_pictures_in_which_it_was_found() -> None:
    told = follow(Tracker(), lambda t: [a("truck", 100 + 40 * t, 50, 20)], range(5))
    assert [[(one.track_id, one.hits) for one in each] for each in told] == [
        [(1, hits)] for hits in range(1, 6)
    ]


@examples(60)
@given(
    heading=st.floats(0.0, 2.0 * math.pi),
    speed=st.floats(0.0, 120.0),
    side=st.floats(6.0, 80.0),
    rate_hz=st.sampled_from([4.0, 16.0, 30.0]),
    seed=st.integers(0, 1000),
)
def test_one_thing_that_moves_evenly_has_one_track(
    heading: float, speed: float, side: float, rate_hz: float, seed: int
) -> None:
    rng = np.random.default_rng(seed)

    def scene(t: float) -> list[Found]:
        column, row = 320 + speed * t * math.cos(heading), 180 + speed * t * math.sin(heading)
        noise = rng.normal(0.0, 0.5 + 0.03 * side, 2)
        return [a("airplane", column + noise[0], row + noise[1], side * rng.uniform(0.9, 1.1))]

    assert ids(follow(Tracker(), scene, range(int(1.3 * rate_hz)), rate_hz)) == {1}


@examples(60)
@given(
    angle=st.floats(0.5, math.pi - 0.5),
    speed=st.floats(85.0, 150.0),
    side=st.floats(6.0, 40.0),
    seed=st.integers(0, 1000),
)
def test_two_of_a_kind_that_cross_keep_their_tracks(
    angle: float, speed: float, side: float, seed: int
) -> None:
    rng = np.random.default_rng(seed)

    def scene(t: float) -> list[Found]:
        found = []
        for direction in (-angle / 2.0, angle / 2.0):
            along = speed * (t - 1.0)
            noise = rng.normal(0.0, 0.5, 2)
            column = 320 + along * math.cos(direction) + noise[0]
            found.append(a("airplane", column, 180 + along * math.sin(direction) + noise[1], side))
        return found

    tracker = Tracker()
    told = follow(tracker, scene, range(33))
    upper = [min(each, key=lambda one: one.box[1]).track_id for each in told]
    assert ids(told) == {1, 2}
    assert upper[0] != upper[-1]


def test_an_airplane_and_a_bird_that_cross_keep_their_tracks() -> None:
    def scene(t: float) -> list[Found]:
        return [a("airplane", 100 + 100 * t, 180, 16), a("bird", 400 - 200 * t, 182, 12)]

    told = ids_by_label(follow(Tracker(), scene, range(33)))
    assert [len(each) for each in told.values()] == [1, 1]


def test_an_airplane_that_overtakes_a_bird_of_its_size_unseen_is_still_the_airplane() -> None:
    """The bird flew ahead as fast; while both were hidden it stopped. Places alone mislead."""

    def scene(t: float) -> list[Found]:
        airplane = a("airplane", 100 + 40 * t, 180, 16)
        return [] if 1.0 < t < 1.5 else [airplane, a("bird", 108 + 40 * min(t, 1.0), 180, 16)]

    told = follow(Tracker(), scene, range(33))
    assert ids(told) == {1, 2}
    assert [finding(one) for one in told[-1]] == scene(2.0)


def test_what_is_vaguely_expected_does_not_take_what_is_settled() -> None:
    """What was found once may be anywhere, so that hardly anything is unlikely to be it."""

    def scene(t: float) -> list[Found]:
        settled = a("truck", 320, 200, 20)
        if t == 1.0:
            return [settled, a("truck", 332, 200, 20)]
        return [a("truck", 324, 200, 20)] if t > 1.0 else [settled]

    told = follow(Tracker(), scene, range(18))
    assert [[one.track_id for one in each] for each in told[15:]] == [[1], [1, 2], [1]]


@examples(40)
@given(
    speed=st.floats(-100.0, 100.0),
    side=st.floats(8.0, 60.0),
    growth=st.floats(-0.2, 0.4),
    seed=st.integers(0, 1000),
)
def test_what_is_hidden_for_half_a_second_keeps_its_track(
    speed: float, side: float, growth: float, seed: int
) -> None:
    rng = np.random.default_rng(seed)

    def scene(t: float) -> list[Found]:
        if 1.0 < t < 1.5:
            return []
        noise = rng.normal(0.0, 0.4, 2)
        return [a("truck", 320 + speed * t + noise[0], 200 + noise[1], side * (1 + growth * t))]

    assert ids(follow(Tracker(), scene, range(40))) == {1}


def test_random_false_findings_are_hardly_ever_confirmed() -> None:
    """Two a second, anywhere in the picture, for ten minutes."""
    rng = np.random.default_rng(1)

    def scene(_: float) -> list[Found]:
        return [
            a("bird", rng.uniform(10, 630), rng.uniform(10, 350), rng.uniform(5, 15))
            for _ in range(rng.poisson(2.0 / 16.0))
        ]

    told = follow(Tracker(), scene, range(9600))
    confirmed = {one.track_id for each in told for one in each if one.hits >= 3}
    assert len(confirmed) <= 10


def test_at_one_picture_a_second_a_miss_is_no_end() -> None:
    found = [a("truck", 320, 200, 20)]
    told = follow(Tracker(), lambda t: [] if t in (4.0, 7.0) else found, range(12), rate_hz=1.0)
    assert ids(told) == {1}


def test_a_thing_is_called_what_it_was_taken_for_most() -> None:
    def scene(t: float) -> list[Found]:
        return [a("bird" if t == 0.5 else "airplane", 320, 200, 12, 0.6)]

    told = follow(Tracker(), scene, range(16))
    assert {one.label for each in told for one in each} == {"airplane"}
    assert ids(told) == {1}


class TestOfWhatIsUnsure:
    def test_nothing_begins(self) -> None:
        told = follow(Tracker(threshold=0.5), lambda t: [a("bird", 320, 200, 8, 0.4)], range(16))
        assert not any(told)

    def test_what_goes_on_with_a_confirmed_track_is_told(self) -> None:
        def scene(t: float) -> list[Found]:
            return [a("bird", 100 + 30 * t, 200, 8, 0.9 if t < 0.2 else 0.2)]

        told = follow(Tracker(threshold=0.5), scene, range(32))
        assert [len(each) for each in told] == [1] * 32
        assert ids(told) == {1}
        assert told[-1][0].confidence == 0.2

    def test_sure_findings_come_first(self) -> None:
        tracker = Tracker(threshold=0.5)
        follow(tracker, lambda t: [a("bird", 100, 100, 10)], range(5))
        near, far = a("bird", 100.5, 100, 10, 0.3), a("bird", 103, 101, 10, 0.9)
        (told,) = follow(tracker, lambda t: [near, far], [5])
        assert [(finding(one), one.track_id) for one in told] == [(far, 1)]


def test_the_same_pictures_give_the_same_tracks() -> None:
    def scene(t: float) -> list[Found]:
        return [a("bird", 100 + 20 * k + 90 * t, 100 + 9 * k, 6 + k) for k in range(8)]

    assert follow(Tracker(), scene, range(20)) == follow(Tracker(), scene, range(20))


class TestCameraThatTurns:
    """What is far away seems to jump about; its track takes the turns out."""

    PLACES = ((300.0, 5000.0, 200.0), (-250.0, 6000.0, 260.0))
    """East, north and up, in metres."""

    def told(self, angles: Callable[[float], tuple[float, float, float]]) -> list[list[Detection]]:
        tracker = Tracker()
        told = []
        for step in range(48):
            heading, pitch, roll = angles(step / 16.0)
            view = camera_view(
                heading_deg=heading % 360.0, pitch_deg=pitch, roll_deg=roll, height_m=200.0
            )
            found = []
            for place in self.PLACES:
                column, row = pixel_of(view, place)
                if 0 < column < 640 and 0 < row < 360 and not 1.0 < step / 16.0 < 1.4:
                    found.append(a("airplane", column, row, 9.0))
            assert step or len(found) == 2
            told.append(tracker.follow(step * PERIOD_NS, view, found))
        return told

    @pytest.mark.parametrize(
        "angles",
        [
            lambda t: (6.0 * math.sin(4.0 * t), 0.0, 0.0),
            lambda t: (0.0, 5.0 * math.sin(5.0 * t), 0.0),
            lambda t: (0.0, 0.0, 25.0 * math.sin(3.0 * t)),
            lambda t: (3.0 * t, 2.0 * math.sin(6.0 * t), 20.0 * math.sin(2.0 * t)),
            lambda t: (359.0 + t, 1.0, 0.0),
        ],
        ids=["yaw", "pitch", "roll", "all", "through north"],
    )
    def test_keeps_its_tracks(self, angles: Callable[[float], tuple[float, float, float]]) -> None:
        assert ids(self.told(angles)) == {1, 2}

    def test_what_turns_about_behind_it_is_let_go(self) -> None:
        tracker = Tracker()
        tracker.follow(0, VIEW, [a("airplane", 320, 180, 20)])
        behind = camera_view(heading_deg=180.0)
        assert tracker.follow(PERIOD_NS, behind, []) == []
        (told,) = tracker.follow(2 * PERIOD_NS, behind, [a("airplane", 320, 180, 20)])
        assert told.track_id == 2


def pixel_of(view: CameraView, place: tuple[float, float, float]) -> tuple[float, float]:
    """Return where a renderer's camera, at the origin of places, has a place."""
    lens = Intrinsics(view.width_px, view.height_px, math.radians(view.horizontal_fov_deg))
    angles = (math.radians(x) for x in (view.heading_deg, view.pitch_deg, view.roll_deg))
    camera = View(lens, Pose.of((0.0, 0.0, view.height_m), *angles))
    column, row = camera.pixels(camera.in_camera(np.array([place])))[0]
    return float(column), float(row)


# --- its laws -----------------------------------------------------------------------------------


def settled(side_px: float = 20.0) -> _Track:
    """Return a track whose place is known to 3 px in each direction."""
    track = _Track.begin(1, a("truck", 300.0, 150.0, side_px), 0)
    track.covariance[:, 0, 0] = 9.0
    return track


@pytest.mark.parametrize(
    ("hits", "misses", "silent_s", "is_over"),
    [
        (CONFIRMED_HITS, 2, 1.0, False),
        (CONFIRMED_HITS, 2, 1.01, True),
        (CONFIRMED_HITS - 1, 2, 0.3, False),
        (CONFIRMED_HITS - 1, 2, 0.31, True),
        (CONFIRMED_HITS, 1, 5.0, False),
    ],
)
def test_a_track_lives_for_a_second_and_one_that_is_not_confirmed_for_0_3_s(
    hits: int, misses: int, silent_s: float, is_over: bool
) -> None:
    track = settled()
    track.hits, track.misses = hits, misses
    assert track.is_over(round(silent_s * SECOND_NS), VIEW) is is_over


@pytest.mark.parametrize(
    ("column", "row", "is_over"),
    [(0.0, 0.0, False), (640.0, 360.0, False), (-0.1, 100.0, True), (640.1, 100.0, True),
     (100.0, -0.1, True), (100.0, 360.1, True)],
)  # fmt: skip
def test_what_has_left_the_picture_unseen_is_over(column: float, row: float, is_over: bool) -> None:
    track = settled()
    track.state[:2, 0] = column, row
    assert not track.is_over(0, VIEW)
    track.misses = 1
    assert track.is_over(0, VIEW) is is_over


@pytest.mark.parametrize(("confidence", "is_told"), [(0.5, True), (0.49, False)])
def test_a_finding_below_the_threshold_begins_no_track_and_continues_a_confirmed_one(
    confidence: float, is_told: bool
) -> None:
    tracker = Tracker(0.5)
    unsure = a("truck", 300.0, 150.0, 20.0)._replace(confidence=confidence)
    assert bool(tracker.follow(0, VIEW, [unsure])) is is_told
    sure = unsure._replace(confidence=0.9)
    for step in range(1, CONFIRMED_HITS + 1):
        (told,) = tracker.follow(step * PERIOD_NS, VIEW, [sure])
    (again,) = tracker.follow((CONFIRMED_HITS + 1) * PERIOD_NS, VIEW, [unsure])
    assert again.track_id == told.track_id
