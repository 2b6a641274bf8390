"""The worker that looks at pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from airhilt.assistant.vision.detector import Found, Picture, PictureMissed
from airhilt.assistant.vision.worker import VisionWorker
from airhilt.errors import VisionError
from airhilt.imaging.masks import runs_of
from airhilt.messages import EXPOSURE_LEFT_OUT, Detection, Detections
from airhilt.sim import Input, WorkerLost
from airhilt.workers.pool import parse_output
from airhilt.workers.protocol import LocalWorker
from pictures import BlobDetector, Told, a, background, camera_view, frame, info, with_blobs

EMPTY = background()
TRUCK = with_blobs(EMPTY, [("truck", (100, 200, 130, 220))])


def seen(worker: VisionWorker, *items: Input) -> list[Detections]:
    outputs = [output for item in items for output in worker.step(item.t_in_ns, [item]).outputs]
    messages = [parse_output("vision", out.key, out.payload, 10**12) for out in outputs]
    found = [each for each in messages if isinstance(each, Detections)]
    assert found == messages
    assert [output.key for output in outputs] == [f"vision/{each.camera}" for each in found]
    return found


def test_a_picture_becomes_detections_of_it() -> None:
    (told,) = seen(VisionWorker(Told([a("airplane", 320, 100, 40, 0.75)])), frame(EMPTY, seq=7))
    assert told == Detections(
        camera="tower",
        seq=7,
        t_frame_ns=437_500_000,
        view=camera_view(),
        detections=(
            Detection(label="airplane", confidence=0.75, box=(300, 80, 340, 120), track_id=1),
        ),
        engine="told",
    )


def test_only_pictures_that_are_old_are_left_out() -> None:
    wanted = VisionWorker(BlobDetector()).description.inputs
    assert [one.key for one in wanted if one.policy == "latest"] == ["camera/*/frame"]


def test_an_exposure_that_was_left_out_is_told_as_that_and_changes_no_track() -> None:
    left_out = replace(frame(TRUCK, 1, encoding="none"), payload=b"")
    items = [frame(TRUCK, 0), left_out, frame(TRUCK, 2)]
    before, between, after = seen(VisionWorker(BlobDetector()), *items)
    assert (between.missed, between.detections) == (EXPOSURE_LEFT_OUT, ())
    assert (before.detections[0].track_id, after.detections[0].track_id) == (1, 1)
    assert (between.seq, after.detections[0].hits) == (1, 2)


def test_what_stays_has_one_track_and_more_hits_from_picture_to_picture() -> None:
    told = seen(VisionWorker(BlobDetector()), *[frame(TRUCK, seq) for seq in range(4)])
    assert [(each.detections[0].track_id, each.detections[0].hits) for each in told] == [
        (1, hits) for hits in range(1, 5)
    ]


def test_each_camera_has_tracks_of_its_own() -> None:
    items = [frame(TRUCK, seq, camera) for seq in range(2) for camera in ("tower", "runway")]
    told = seen(VisionWorker(BlobDetector()), *items)
    assert [each.camera for each in told] == ["tower", "runway"] * 2
    assert [(one.track_id, one.hits) for each in told for one in each.detections] == [
        (1, 1), (1, 1), (1, 2), (1, 2),
    ]  # fmt: skip


class TestOwnAircraft:
    """Its lower third is in the picture."""

    def own(self) -> tuple[int, ...]:
        mask = np.zeros((360, 640), dtype=bool)
        mask[240:] = True
        return runs_of(mask)

    @pytest.mark.parametrize(
        ("row", "is_told"), [(230, True), (240, True), (242, True), (250, False), (340, False)]
    )
    def test_what_is_mostly_a_part_of_it_is_dropped(self, row: int, is_told: bool) -> None:
        worker = VisionWorker(Told([a("airplane", 320, row, 40)]))
        (told,) = seen(worker, info(own_aircraft=self.own()), frame(EMPTY))
        assert bool(told.detections) == is_told

    def test_what_reaches_beyond_the_picture_is_judged_by_what_is_in_it(self) -> None:
        worker = VisionWorker(Told([a("airplane", 320, 360, 60)]))
        (told,) = seen(worker, info(own_aircraft=self.own()), frame(EMPTY))
        assert told.detections == ()

    def test_other_cameras_are_not_masked(self) -> None:
        worker = VisionWorker(Told([a("airplane", 320, 340, 20)]))
        (told,) = seen(worker, info("tail", own_aircraft=self.own()), frame(EMPTY))
        assert told.detections


def test_of_a_picture_that_was_missed_it_is_said_why_and_no_track_ends() -> None:
    class Blinking(Told):
        def __init__(self, *pictures: Sequence[Found]) -> None:
            super().__init__(*pictures)
            self.asked = 0

        def detect(self, picture: Picture) -> Sequence[Found]:
            self.asked += 1
            if self.asked == 3:
                raise PictureMissed("detector told: blinked")
            return super().detect(picture)

    pictures = [frame(background(seed=seq), seq) for seq in range(4)]
    told = seen(VisionWorker(Blinking([a("truck", 320, 100, 40)])), *pictures)
    assert [each.missed for each in told] == ["", "", "detector told: blinked", ""]
    assert [[one.track_id for one in each.detections] for each in told] == [[1], [1], [], [1]]
    assert told[-1].detections[0].is_confirmed


def test_a_detector_that_fails_is_the_loss_of_the_worker() -> None:
    class Blind(Told):
        def detect(self, picture: Picture) -> Sequence[Found]:
            raise VisionError("detector told: it is dark")

    pending = LocalWorker(VisionWorker(Blind())).dispatch(0, 0, [frame(EMPTY)])
    with pytest.raises(WorkerLost, match="'vision' failed: VisionError: detector told: it is dark"):
        pending.result()
