"""What a detector learns from, and how it is judged: the tools measure what they say."""

from __future__ import annotations

import dataclasses
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

import calibrate_detector as calibrating
import detector_data as data
import detector_disturbances as disturbances
import detector_lessons as lessons
import detector_places as places
import eval_detector as judging
import eval_disturbed as disturbed
from airhilt.assistant.vision.detector import Found
from airhilt.assistant.vision.detectors.embedded import Calibration
from airhilt.sensors.cameras.dataset.placement import gone_on
from airhilt.sensors.cameras.dataset.records import run_lengths
from airhilt.sensors.cameras.scene.bodies import BodyState

BOX = (40.0, 30.0, 60.0, 40.0)


def body(box: Any = BOX, label: int = 0, contrast: float = 80.0) -> Any:
    return data.Body(label, box, 900.0, 1.0, 0.8, contrast)


def found(box: Any, label: str = "airplane", confidence: float = 0.9) -> Found:
    return Found(label, confidence, box)


class TestContrast:
    def test_it_is_what_half_of_the_body_differs_more_than_from_what_is_around(self) -> None:
        picture = np.full((60, 100, 3), 100, dtype=np.uint8)
        mask = np.zeros((60, 100), dtype=bool)
        mask[30:40, 40:60] = True
        picture[30:40, 40:54] = 130
        picture[30:40, 54:60] = 255
        assert data.contrast(picture, BOX, mask) == 30.0

    def test_lamps_alone_make_no_contrast(self) -> None:
        picture = np.full((60, 100, 3), 8, dtype=np.uint8)
        mask = np.zeros((60, 100), dtype=bool)
        mask[30:40, 40:60] = True
        picture[34:36, 41:45] = 255
        assert data.contrast(picture, BOX, mask) == 0.0

    def test_a_body_that_fills_the_picture_is_seen(self) -> None:
        picture = np.full((60, 100, 3), 100, dtype=np.uint8)
        mask = np.ones((60, 100), dtype=bool)
        assert data.contrast(picture, (0.0, 0.0, 100.0, 60.0), mask) == 255.0

    def test_what_can_hardly_be_made_out_does_not_count(self) -> None:
        assert body().counts
        assert not body(contrast=12.0).counts
        assert not body(box=(40.0, 30.0, 44.0, 32.0)).counts


class TestMask:
    @given(cells=st.lists(st.lists(st.booleans(), min_size=3, max_size=3), min_size=1, max_size=5))
    def test_it_is_what_was_written(self, cells: list[list[bool]]) -> None:
        mask = np.array(cells)
        assert np.array_equal(data.mask_of(run_lengths(mask)), mask)


class TestMatching:
    def test_each_body_is_found_once(self) -> None:
        seen, used = judging.matched([body()], [found(BOX), found(BOX)], judging.strictly)
        assert (seen, used) == ({0}, {0})

    def test_another_class_finds_nothing(self) -> None:
        assert judging.matched([body()], [found(BOX, "truck")], judging.strictly) == (
            set(),
            set(),
        )

    def test_half_of_a_body_is_not_enough_unless_asked_loosely(self) -> None:
        half = found((40.0, 30.0, 49.0, 40.0))
        assert judging.matched([body()], [half], judging.strictly) == (set(), set())
        assert judging.matched([body()], [half], judging.loosely) == ({0}, {0})

    def test_what_lies_on_a_faint_body_is_not_false(self) -> None:
        assert judging.on_faint([body(contrast=3.0)], found(BOX))
        assert not judging.on_faint([body()], found(BOX))


class TestPlaces:
    def shot(self, *bodies: Any) -> Any:
        about = {"width": 100, "height": 60}
        return data.Shot(Path("none.jpg"), about, bodies)

    def labels(self, shot: Any, *boxes: Any) -> list[int]:
        return [label for _, _, label, _ in places.places_in(shot, [found(box) for box in boxes])]

    def test_a_place_on_a_body_has_its_class_and_its_box(self) -> None:
        shot = self.shot(body(label=1))
        near = (38.0, 29.0, 57.0, 41.0)
        assert list(places.places_in(shot, [found(near)])) == [(near, 0.9, 2, BOX)]

    def test_a_place_beside_all_bodies_is_nothing(self) -> None:
        assert self.labels(self.shot(body()), (0.0, 0.0, 20.0, 10.0)) == [0]

    def test_a_place_with_a_part_of_a_body_teaches_nothing(self) -> None:
        part = (40.0, 30.0, 47.0, 36.0)
        assert self.labels(self.shot(body()), part) == []

    def test_a_place_on_a_faint_body_teaches_nothing(self) -> None:
        assert self.labels(self.shot(body(contrast=3.0)), BOX) == []

    def test_of_two_bodies_the_likelier_is_meant(self) -> None:
        behind = body(box=(44.0, 30.0, 66.0, 40.0), label=2)
        assert self.labels(self.shot(behind, body()), BOX) == [1]

    def test_what_hardly_looks_like_anything_is_left_out(self) -> None:
        faint = [found(BOX, confidence=0.01)]
        assert list(places.places_in(self.shot(), faint)) == []


class FirstNetwork:
    """Sees something at one place in every picture."""

    asked = 0

    def __init__(self, path: Path) -> None:
        pass

    def proposed(self, picture: np.ndarray) -> list[Found]:
        FirstNetwork.asked += 1
        assert picture.any()
        return [found(BOX)]


def folder_of(path: Path, *levels: int, seed: int = 0) -> Path:
    """Return a folder of grey pictures with nobody in them."""
    path.mkdir(parents=True, exist_ok=True)
    images = []
    for number, level in enumerate(levels):
        Image.fromarray(np.full((60, 100, 3), level, dtype=np.uint8)).save(path / f"{number}.png")
        images.append({"id": number, "file_name": f"{number}.png", "width": 100, "height": 60})
    document = {"info": {"seed": seed}, "categories": [], "images": images, "annotations": []}
    (path / "annotations.json").write_text(json.dumps(document), encoding="utf-8")
    return path


class TestKeptPictures:
    @pytest.fixture
    def asking(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
        """Return what asks a first network about folders, and keeps what it says."""
        monkeypatch.setattr(places, "EmbeddedDetector", FirstNetwork)
        monkeypatch.setattr(FirstNetwork, "asked", 0)
        network, scratch = tmp_path / "detector.onnx", tmp_path / "scratch"
        network.write_bytes(b"one")
        scratch.mkdir()
        return lambda folder: places.places_of(folder, network, scratch, seed=5)

    def test_pictures_are_those_of_the_folder_and_asked_about_once(
        self, asking: Any, tmp_path: Path
    ) -> None:
        folder = folder_of(tmp_path / "train", 50, 90, 70)
        for _ in range(2):
            known = asking(folder)
            assert known.pictures[::2, 0, 0, 0].tolist() == [50, 70]
            assert known.picture.tolist() == [0, 1, 2]
        assert FirstNetwork.asked == 3

    def test_decoding_that_is_broken_off_is_begun_anew(self, asking: Any, tmp_path: Path) -> None:
        folder = folder_of(tmp_path / "train", 50, 90)
        second = (folder / "1.png").read_bytes()
        (folder / "1.png").unlink()
        with pytest.raises(FileNotFoundError):
            asking(folder)
        (folder / "1.png").write_bytes(second)
        assert asking(folder).pictures[0, 0, 0, 0] == 50

    def test_other_data_of_the_same_size_is_not_taken_for_it(
        self, asking: Any, tmp_path: Path
    ) -> None:
        asking(folder_of(tmp_path / "train", 50, 90, seed=1))
        again = asking(folder_of(tmp_path / "train", 60, 70, seed=2))
        assert again.pictures[0, 0, 0, 0] == 60

    def test_another_network_is_asked_anew(self, asking: Any, tmp_path: Path) -> None:
        folder = folder_of(tmp_path / "train", 50, 90)
        asking(folder)
        (tmp_path / "detector.onnx").write_bytes(b"another")
        asking(folder)
        assert FirstNetwork.asked == 4


@pytest.fixture(scope="module")
def seen(tmp_path_factory: pytest.TempPathFactory) -> list[Any]:
    """Return pictures of a grey plain with a body in it, every second disturbed."""
    folder = folder_of(tmp_path_factory.mktemp("plain"), *([100] * 40))
    mask = np.ones((10, 20), dtype=bool)
    shots = [
        dataclasses.replace(shot, bodies=(dataclasses.replace(body(), corner=(30, 40), mask=mask),))
        for shot in data.read_folder(folder)
    ]
    return list(disturbances.half_disturbed(shots, (3,)))


class TestDisturbances:
    def test_masks_are_where_bodies_are(self, seen: list[Any]) -> None:
        masks = seen[0][0].masks()
        assert masks.sum() == 200
        assert masks[30:40, 40:60].all()

    def test_a_large_picture_is_disturbed_too(self) -> None:
        large = np.full((720, 1280, 3), 100, dtype=np.uint8)
        bodies = np.zeros((720, 1280), dtype=bool)
        disturber = disturbances.Disturber(3)
        taken = [disturber(large, bodies, np.random.default_rng(seed)) for seed in range(4)]
        assert {each.picture.shape for each in taken} == {large.shape}
        assert any(each.picture.std() > 1.0 for each in taken)

    def test_every_second_picture_is_as_it_was(self, seen: list[Any]) -> None:
        assert all((picture == 100).all() for _, picture in seen[::2])
        assert all(picture.std() > 0.0 or picture.mean() != 100.0 for _, picture in seen[1::2])

    def test_a_body_is_drowned_by_what_deviates_as_much_as_it_stands_out(
        self, seen: list[Any]
    ) -> None:
        rough = disturbances.Disturbed(seen[0][1], 90.0)
        smooth = disturbances.Disturbed(seen[0][1], 20.0)
        assert not rough.bodies([body()])[0].counts
        assert smooth.bodies([body()])[0].counts

    def test_pictures_are_disturbed_alike_from_one_time_to_the_next(self, seen: list[Any]) -> None:
        """Pictures with other numbers have other disturbances."""
        again = list(disturbances.half_disturbed([shot for shot, _ in seen], (3,)))
        assert all(
            np.array_equal(one, other) for (_, one), (_, other) in zip(seen, again, strict=True)
        )
        assert len({float(picture.mean()) for _, picture in seen[1::2]}) > 10


class TestJudgingDisturbed:
    """A grey plain with a body of 80 levels, under noise of 10."""

    def sight(self, apart: float, found_: bool, size_px: float = 30.0) -> Any:
        return disturbed.Sight(0, 0, size_px, apart, found_)

    def test_bodies_are_apart_by_their_contrast_in_deviations(self) -> None:
        sights = [self.sight(apart, True) for apart in (9.0, 4.0, 3.9, 2.0, 1.9)]
        assert [len(group) for group in disturbed.groups(sights)] == [2, 2, 1]

    def test_the_deviation_is_that_of_what_was_added_by_its_strongest_colour(self) -> None:
        draws = np.random.default_rng(1)
        drawn = np.full((60, 100, 3), 100, dtype=np.uint8)
        noise = draws.normal(0.0, (3.0, 10.0, 3.0), drawn.shape).round()
        seen = (drawn + noise).astype(np.uint8)
        shot = data.Shot(Path("none.jpg"), {"width": 100, "height": 60}, (body(),))
        added = disturbed.deviation_of(shot, body(), drawn, seen, of_itself=False)
        assert added == pytest.approx(10.0, rel=0.15)

    def test_a_body_is_no_part_of_the_deviation_of_a_picture_itself(self) -> None:
        picture = np.full((60, 100, 3), 100, dtype=np.uint8)
        picture[30:40, 40:60] = 250
        mask = np.ones((10, 20), dtype=bool)
        one = dataclasses.replace(body(), corner=(30, 40), mask=mask)
        shot = data.Shot(Path("none.jpg"), {"width": 100, "height": 60}, (one,))
        assert disturbed.deviation_of(shot, one, picture, picture, of_itself=True) == 0.0

    def test_a_row_has_the_same_bodies_without_the_disturbance_beside_it(self) -> None:
        outcomes = {
            disturbed.AS_IT_IS: disturbed.Outcome((self.sight(30.0, True),), 0),
            "texture": disturbed.Outcome((self.sight(5.0, False),), 3),
        }
        row = disturbed.table_of(outcomes)[1]
        assert row["at least 4"] == {"airplanes": 1, "found": 0.0, "as it is": 1.0}
        assert row["2 to 4"] == {"airplanes": 0, "found": None, "as it is": None}
        assert row["false on empty"] == 3


class TestLessons:
    def folder(self, boxes: Any, labels: Any, truth: Any) -> Any:
        picture = np.zeros((1, 60, 100, 3), dtype=np.uint8)
        picture[0, :, 50:] = 200
        return places.Places(
            picture,
            np.zeros(len(boxes), dtype=np.int64),
            np.array(boxes, dtype=np.float32),
            np.full(len(boxes), 0.5, dtype=np.float32),
            np.array(labels),
            np.array(truth, dtype=np.float32),
        )

    def test_a_batch_has_bodies_and_nothing_in_the_parts_that_it_says(self) -> None:
        other = (10.0, 10.0, 20.0, 20.0)
        drawn = lessons.Lessons([self.folder([BOX, other], [1, 0], [BOX, other])], 4)
        numbers, views, known, labels, _ = drawn.batch(0)
        assert len(labels) == lessons.BATCH
        assert (labels > 0).mean() == pytest.approx(lessons.OF_BODIES, abs=0.01)
        assert ((numbers >= 0) == (labels == 0)).all()
        assert np.isfinite(known).all()
        again = lessons.Lessons([self.folder([BOX, other], [1, 0], [BOX, other])], 4)
        assert np.array_equal(again.batch(0)[1], views)

    def test_mirrored_views_have_mirrored_moves(self) -> None:
        """The body is always where the picture gets bright."""
        body_box = (50.0, 20.0, 70.0, 40.0)
        places_of_it = [(40.0, 20.0, 60.0, 40.0), (10.0, 10.0, 20.0, 20.0)]
        folder = self.folder(places_of_it, [1, 0], [body_box, places_of_it[1]])
        _, views, _, labels, moves = lessons.Lessons([folder], 4).batch(1)
        columns = views[labels > 0, 0].astype(float).mean(axis=(1, 3))
        is_brighter_right = columns[:, 16:].mean(axis=1) > columns[:, :16].mean(axis=1)
        assert ((moves[labels > 0, 0] > 0.0) == is_brighter_right).all()
        assert 0.2 < is_brighter_right.mean() < 0.8

    def test_what_fooled_the_network_comes_more_often(self) -> None:
        boxes = [BOX, (0.0, 0.0, 10.0, 10.0), (20.0, 0.0, 30.0, 10.0)]
        drawn = lessons.Lessons([self.folder(boxes, [1, 0, 0], boxes)], 4)
        drawn.fooled = np.array([0.9, 0.0])
        numbers = drawn.batch(2)[0]
        assert (numbers == 0).sum() > 10 * (numbers == 1).sum()


class TestCalibration:
    def test_the_fit_finds_the_calibration_under_which_findings_came_true(self) -> None:
        draws = np.random.default_rng(3)
        meant = Calibration(
            of_class={"airplane": 0.8, "bird": -1.0}, logit=1.5, size=0.6, logit_and_size=0.2
        )
        kinds = ("airplane", "bird")
        made, true = [], []
        for _ in range(20_000):
            side = float(2.0 ** draws.uniform(3.0, 7.0))
            score = float(draws.uniform(0.02, 0.98))
            one = found((0.0, 0.0, side, side / 2.0), kinds[int(draws.integers(2))], score)
            odds = meant.log_odds(one.label, score, side)
            made.append(one)
            true.append(bool(draws.random() < 1.0 / (1.0 + math.exp(-odds))))
        fitted = calibrating.fitted(made, true)
        for kind in kinds:
            for score in (0.1, 0.5, 0.9):
                for side in (10.0, 32.0, 100.0):
                    assert fitted.log_odds(kind, score, side) == pytest.approx(
                        meant.log_odds(kind, score, side), abs=0.3
                    )

    def test_the_threshold_is_the_lowest_from_which_no_camera_has_too_many(self) -> None:
        few, many = calibrating.Count(minutes=2.0), calibrating.Count(minutes=2.0)
        low, middle = calibrating.THRESHOLDS[3], calibrating.THRESHOLDS[8]
        for threshold in calibrating.THRESHOLDS:
            few.false[threshold] = 3 if threshold < low else 0
            many.false[threshold] = 3 if threshold < middle else 2
        assert calibrating.chosen_threshold({"fixed": few, "nose": many}) == middle


class TestMinutesOfCameras:
    def aircraft(self, up_m: float, shape: str) -> BodyState:
        return BodyState("own", 0.0, 0.0, up_m, math.pi / 2.0, 0.02, 0.0, shape, True)

    def test_an_aircraft_on_the_ground_rolls_ahead(self) -> None:
        later = gone_on(self.aircraft(3.0, "gear"), 10.0)
        assert (later.east_m, later.up_m) == (pytest.approx(80.0), 3.0)
        assert (later.pitch_rad, later.roll_rad) == (0.02, 0.0)

    def test_one_with_its_gear_down_descends_and_stays_above_the_ground(self) -> None:
        start = self.aircraft(200.0, "gear")
        heights = [gone_on(start, float(t)).up_m for t in range(120)]
        assert heights == sorted(heights, reverse=True)
        assert heights[10] == pytest.approx(200.0 - 750.0 * math.tan(math.radians(3.0)))
        assert heights[-1] > 0.0

    def test_one_in_cruise_keeps_its_height(self) -> None:
        later = gone_on(self.aircraft(3000.0, "clean"), 10.0)
        assert (later.east_m, later.up_m) == (pytest.approx(750.0), 3000.0)
