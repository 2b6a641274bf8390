"""What was seen, measured against what was true of each picture."""

from __future__ import annotations

from typing import Any

import pytest

from airhilt.imaging.matching import matches
from airhilt.messages import EXPOSURE_LEFT_OUT, Box, Detection, SightingTruth
from airhilt.metrics.detection_scores import DetectionScores, must_be_found
from airhilt.metrics.summary import VisionStatistics
from sightings import found, frame, info, seen, sighting, truth, vision

PLANE = (40.0, 30.0, 70.0, 40.0)
NOWHERE = (100.0, 60.0, 120.0, 70.0)


class Watched:
    """Numbers of a run that is fed picture by picture."""

    def __init__(self, *cameras: str) -> None:
        self.sight = DetectionScores()
        self.sight.take(vision("on"))
        for camera in cameras or ("tower",):
            self.sight.take(info(camera))

    def picture(
        self, seq: int, *sightings: SightingTruth, by: tuple[Detection, ...] | None = (),
        camera: str = "tower", late_s: float = 0.1,
    ) -> Watched:  # fmt: skip
        """Take a picture; ``by`` None: nobody looks at it."""
        self.sight.take(truth(seq, *sightings, camera=camera))
        self.sight.take(frame(seq, camera))
        if by is not None:
            self.sight.take(seen(seq, *by, camera=camera, late_s=late_s))
        return self

    def numbers(self, **dropped: int) -> VisionStatistics:
        return self.sight.statistics(
            {f"vision: camera/{name}/frame": n for name, n in dropped.items()}
        )


# --- which detection is about whom ------------------------------------------------------------


@pytest.mark.parametrize(
    ("box", "is_about"),
    [
        (PLANE, True),
        ((45.0, 31.0, 74.0, 42.0), True),  # overlaps by more than 0.3
        ((58.0, 33.0, 90.0, 46.0), False),  # by less
        (NOWHERE, False),
    ],
)
def test_a_detection_is_about_what_its_box_overlaps(box: Box, is_about: bool) -> None:
    assert (matches([sighting(PLANE)], [found(box)])[0] is not None) is is_about


@pytest.mark.parametrize(("dx", "is_about"), [(0.0, True), (5.9, True), (6.5, False)])
def test_of_what_is_small_the_middle_decides(dx: float, is_about: bool) -> None:
    """Six pixels long: half of it and three pixels more."""
    small = sighting((40.0, 30.0, 46.0, 32.0))
    there = found((43.0 + dx - 4.0, 29.0, 43.0 + dx + 4.0, 33.0))
    assert (matches([small], [there])[0] is not None) is is_about


def test_what_is_thin_needs_no_overlap_either() -> None:
    thin = sighting((40.0, 0.0, 65.0, 1.5))
    assert matches([thin], [found((40.0, 1.2, 65.0, 2.7))]) == [thin]


def test_nobody_is_found_twice_and_the_nearest_goes_first() -> None:
    one, other = sighting(PLANE, "AAL123"), sighting((64.0, 30.0, 94.0, 40.0), "DAL456")
    first, second = found((44.0, 30.0, 74.0, 40.0)), found(PLANE)
    assert matches([one, other], [first, second]) == [None, one]
    assert matches([one], [found(PLANE), found(PLANE)]) == [one, None]


def test_of_two_that_could_be_meant_it_is_the_one_of_that_class() -> None:
    bird, plane = sighting(PLANE, "GOOSE", label="bird"), sighting((38.0, 30.0, 68.0, 40.0))
    assert matches([bird, plane], [found(PLANE)]) == [plane]


def test_nothing_can_be_about_what_no_pixel_shows() -> None:
    assert matches([sighting(PLANE, pixels=0.0)], [found(PLANE)]) == [None]


@pytest.mark.parametrize(
    ("changed", "counts"),
    [
        ({}, True),
        ({"box": (40.0, 30.0, 47.9, 33.0)}, False),
        ({"box": (40.0, 30.0, 48.0, 33.0)}, True),
        ({"visible_fraction": 0.49}, False),
        ({"transmission": 0.09}, False),
    ],
)
def test_only_what_is_large_and_clear_must_be_found(changed: dict[str, Any], counts: bool) -> None:
    assert must_be_found(sighting(**{"box": PLANE} | changed)) is counts


# --- the numbers ------------------------------------------------------------------------------


def test_pictures_are_counted_as_taken_looked_at_and_dropped() -> None:
    watched = Watched("tower", "runway")
    watched.picture(0).picture(1, by=None).picture(0, camera="runway")
    numbers = watched.numbers(tower=1)
    assert (numbers.taken, numbers.looked_at, numbers.dropped) == (3, 2, 1)
    tower, runway = numbers.cameras
    assert (tower.camera, tower.taken, tower.looked_at, tower.dropped) == ("tower", 2, 1, 1)
    assert (runway.camera, runway.taken, runway.looked_at, runway.dropped) == ("runway", 1, 1, 0)


def test_exposures_that_were_left_out_are_counted_apart_and_leave_no_rate_per_minute() -> None:
    watched = Watched().picture(0, by=(found(NOWHERE),)).picture(3)
    for seq in (1, 2):
        watched.sight.take(frame(seq).model_copy(update={"encoding": "none"}))
        watched.sight.take(seen(seq).model_copy(update={"missed": EXPOSURE_LEFT_OUT}))
    numbers = watched.numbers()
    assert (numbers.taken, numbers.looked_at, numbers.missed) == (2, 2, 0)
    assert (numbers.exposures_left_out, numbers.why_missed) == (2, "")
    assert (numbers.false_detections, numbers.false_per_picture) == (1, 0.5)
    assert (numbers.false_per_minute, numbers.false_confirmed_per_minute) == (None, None)


def test_a_picture_that_a_detector_missed_counts_as_that_and_nothing_else() -> None:
    watched = Watched().picture(0, sighting(PLANE), by=(found(PLANE),))
    watched.picture(1, sighting(PLANE), by=None)
    for why in ("no answer", "no answer again"):
        watched.sight.take(seen(1).model_copy(update={"missed": why}))
    numbers = watched.numbers()
    assert (numbers.looked_at, numbers.missed, numbers.why_missed) == (1, 2, "no answer")
    assert (numbers.recall, numbers.sightings, numbers.latency.n) == (1.0, 1, 1)


def test_vision_latency_is_from_the_exposure_to_the_detections() -> None:
    watched = Watched()
    for seq, late_s in enumerate((0.1, 0.2, 0.6)):
        watched.picture(seq, late_s=late_s)
    latency = watched.numbers().latency
    assert (latency.n, latency.min_s, latency.p50_s) == (3, 0.1, 0.2)
    assert latency.p95_s == pytest.approx(0.56)


def test_recall_is_over_what_counts_in_the_pictures_looked_at() -> None:
    far = sighting((10.0, 10.0, 14.0, 12.0), "FAR")
    plane = sighting(PLANE)
    watched = Watched().picture(0, plane, far, by=(found(PLANE),)).picture(1, plane, by=())
    watched.picture(2, plane, by=None)
    numbers = watched.numbers()
    assert (numbers.sightings, numbers.recall) == (2, 0.5)
    of_its_size = next(one for one in numbers.by_size if one.from_px == 20.0)
    assert (of_its_size.to_px, of_its_size.sightings, of_its_size.recall) == (50.0, 2, 0.5)
    assert [one.sightings for one in numbers.by_size] == [0, 0, 2, 0]
    assert [one.recall for one in numbers.by_size] == [None, None, 0.5, None]


def test_a_wrong_class_is_found_all_the_same_and_counted_apart() -> None:
    numbers = Watched().picture(0, sighting(PLANE), by=(found(PLANE, label="bird"),)).numbers()
    assert (numbers.recall, numbers.labels_right, numbers.false_detections) == (1.0, 0.0, 0)


def test_false_detections_are_told_by_the_minute_of_a_camera() -> None:
    """Two cameras for half a minute each; three boxes about nothing, one of them confirmed."""
    watched = Watched("tower", "runway")
    for seq in range(480):
        by = (found(NOWHERE, hits=seq, track_id=7),) if 1 <= seq <= 3 else ()
        watched.picture(seq, by=by).picture(seq, camera="runway")
    numbers = watched.numbers()
    assert numbers.false_detections == 3
    assert numbers.false_per_minute == pytest.approx(3.0)
    assert numbers.false_confirmed_per_minute == pytest.approx(1.0)
    assert numbers.false_tracks == 1
    assert numbers.cameras[0].false_per_minute == pytest.approx(6.0)
    assert numbers.cameras[1].false_per_minute == 0.0


def test_a_track_that_once_was_about_somebody_is_no_false_one() -> None:
    watched = Watched().picture(0, sighting(PLANE), by=(found(PLANE, track_id=4),))
    watched.picture(1, by=(found(NOWHERE, track_id=4),))
    assert watched.numbers().false_tracks == 0


def test_the_first_detection_of_each_actor_says_when_where_and_how_large() -> None:
    watched = Watched("tower", "runway")
    watched.picture(16, sighting(PLANE, range_m=3_000.0), by=())
    plane = sighting(PLANE, range_m=2_900.0)
    watched.picture(17, plane, camera="runway", by=(found(PLANE),))
    watched.picture(18, plane, by=(found(PLANE),))
    deer = sighting(NOWHERE, "DEER1", label="deer")
    watched.picture(19, plane, deer, by=(found(NOWHERE, label="deer"), found(PLANE)))
    first, second = watched.numbers().first_detections
    assert (first.actor, first.camera, first.range_m, first.size_px) == (
        "DAL456", "runway", 2_900.0, 30.0
    )  # fmt: skip
    assert (first.t_frame_s, first.t_s) == (17 / 16, pytest.approx(17 / 16 + 0.1))
    assert second.actor == "DEER1"


# --- where there is nothing to measure --------------------------------------------------------


@pytest.mark.parametrize(("state", "cause"), [("off", ""), ("not evaluated", "no EGL")])
def test_without_vision_nothing_is_a_zero(state: str, cause: str) -> None:
    sight = DetectionScores()
    sight.take(vision(state, cause))
    numbers = sight.statistics({})
    assert (numbers.state, numbers.cause) == (state, cause)
    for name, value in numbers.model_dump(
        exclude={"state", "cause", "why_missed", "latency"}
    ).items():
        assert value in (None, []), name
    assert (numbers.latency.n, numbers.latency.p50_s) == (0, None)


def test_what_was_measured_before_vision_was_lost_stays() -> None:
    watched = Watched().picture(0, sighting(PLANE), by=(found(PLANE),))
    watched.sight.take(vision("lost", "the renderer has died"))
    numbers = watched.numbers()
    assert (numbers.state, numbers.cause) == ("lost", "the renderer has died")
    assert (numbers.taken, numbers.recall) == (1, 1.0)


def test_truth_is_not_kept_for_ever() -> None:
    watched = Watched()
    for seq in range(2_000):
        watched.picture(seq, sighting(PLANE), by=None)
    watched.sight.take(seen(0, found(PLANE)))
    assert watched.numbers().looked_at == 0
    watched.sight.take(seen(1_999, found(PLANE)))
    assert watched.numbers().recall == 1.0


@pytest.mark.parametrize(
    ("size", "bin_px"),
    [(8.0, 8.0), (11.9, 8.0), (12.0, 12.0), (19.9, 12.0), (20.0, 20.0), (49.9, 20.0), (50.0, 50.0)],
)
def test_recall_is_told_from_8_12_20_and_50_pixels_on(size: float, bin_px: float) -> None:
    numbers = Watched().picture(1, sighting((10.0, 10.0, 10.0 + size, 14.0))).numbers()
    assert [one.from_px for one in numbers.by_size if one.sightings] == [bin_px]
    assert [one.from_px for one in numbers.by_size] == [8.0, 12.0, 20.0, 50.0]
