"""The embedded detector finds what there is, and says what is wrong with a file."""

from __future__ import annotations

import json
import math
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pytest

from airhilt.assistant.vision.detector import Found, Shot
from airhilt.assistant.vision.detectors.embedded import MODEL, EmbeddedDetector
from airhilt.assistant.vision.refiner import Refiner
from airhilt.assistant.vision.tiling import Tile
from airhilt.errors import VisionError
from airhilt.imaging.boxes import overlap
from airhilt.messages import Box

SHOT = Shot("nose", 0)


@pytest.fixture(scope="module")
def detector() -> EmbeddedDetector:
    return EmbeddedDetector()


Airliner = tuple[npt.NDArray[np.uint8], Box]
"""A picture, and the box of the aircraft in it."""


@pytest.fixture(scope="module")
def airliner() -> Airliner:
    """A 737 over open country, before a camera in the air, and its box."""
    import datetime

    from airhilt.imaging.view import Intrinsics, Pose
    from airhilt.scenario.models import Daylight, Weather
    from airhilt.sensors.cameras.mounts import Camera
    from airhilt.sensors.cameras.scene.bodies import BodyState, aircraft_model
    from airhilt.sensors.cameras.scene.builder import air_and_sun
    from airhilt.sensors.cameras.scene.landscape import open_country
    from airhilt.sensors.cameras.scene_renderer import SceneRenderer

    day = Daylight(date=datetime.date(2026, 5, 1), solar_time_h=10.0)
    light = air_and_sun(Weather(visibility_m=20_000.0), day, 1.0, 0.8, True)
    pose = Pose.of((0.0, 0.0, 900.0), 0.0)
    camera = Camera("nose", Intrinsics(636, 356, 0.7), pose)
    scene_renderer = SceneRenderer(
        open_country(light, "test", None), light, {"737": aircraft_model("737")}, [camera],
        "embree",
    )  # fmt: skip
    body = BodyState("737", -10.0, 150.0, 907.5, 3.1, 0.03, 0.05, "clean", True)
    frame = scene_renderer.shoot(["nose"], [body], 0)[0]
    scene_renderer.close()
    return frame.colour, cast(Box, tuple(frame.sightings[0].box))


def copy(folder: Path, **card: Any) -> Path:
    """Return the detector's file in another place, with changes to its card."""
    for network in MODEL.parent.glob("*.onnx"):
        shutil.copy(network, folder)
    document = json.loads(MODEL.with_name("card.json").read_text())
    (folder / "card.json").write_text(json.dumps(document | card))
    return folder / MODEL.name


def test_an_airliner_is_found_where_it_is(detector: EmbeddedDetector, airliner: Airliner) -> None:
    picture, box = airliner
    surest = detector.detect(picture)[0]
    assert surest.label == "airplane"
    assert np.abs(np.subtract(surest.box, box)).max() < 16.0


def test_pictures_of_any_size_give_boxes_within_them(
    detector: EmbeddedDetector, airliner: Airliner
) -> None:
    picture, _ = airliner
    for rows, columns in ((356, 636), (200, 301), (33, 47), (1, 1)):
        part = picture[-rows:, :columns]
        for found in detector.detect(part):
            left, top, right, bottom = found.box
            assert 0.0 <= left < right <= columns
            assert 0.0 <= top < bottom <= rows


def test_a_part_of_a_picture_has_in_it_what_the_whole_has_there(
    detector: EmbeddedDetector,
    airliner: Airliner,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    picture, (left, top, right, bottom) = airliner
    rows, columns = picture.shape[:2]
    whole = Tile(0, 0, rows, columns)
    assert detector.detect_in(picture, whole, SHOT) == detector.detect(picture)
    row, column = (max(round(side) // 16 * 16 - 64, 0) for side in (top, left))
    window = Tile(row, column, 176, 240)
    found = detector.detect_in(picture, window, SHOT)[0]
    assert found.label == "airplane"
    assert overlap(found.box, (left, top, right, bottom)) > 0.5
    # The refiner has the whole picture, so what it sees of the body is no less.
    looked_at: list[tuple[int, ...]] = []
    judge = Refiner.judge

    def note(self: Refiner, shown: np.ndarray, places: Sequence[Found]) -> list[Found]:
        looked_at.append(shown.shape)
        return judge(self, shown, places)

    with monkeypatch.context() as patch:
        patch.setattr(Refiner, "judge", note)
        detector.detect_in(picture, window, SHOT)
    assert looked_at == [picture.shape]
    outside = Tile(0, 0, 96, 96)
    assert all(one.label != "airplane" for one in detector.detect_in(picture, outside, SHOT))


def test_a_file_of_its_own_is_used_with_its_card(tmp_path: Path, airliner: Airliner) -> None:
    picture, _ = airliner
    assert EmbeddedDetector(copy(tmp_path)).detect(picture) == EmbeddedDetector().detect(picture)
    severe = EmbeddedDetector(copy(tmp_path, threshold=1.0))
    assert severe.threshold == 1.0
    assert all(found.confidence < severe.threshold for found in severe.detect(picture))


def test_what_is_unsure_is_told_too_but_not_what_is_hardly_anything(
    tmp_path: Path, airliner: Airliner
) -> None:
    picture, _ = airliner
    for threshold in (0.2, 0.6, 0.9):
        detector = EmbeddedDetector(copy(tmp_path, threshold=threshold))
        told = {found.confidence for found in detector.detect(picture)}
        everything = {one.confidence for one in EmbeddedDetector(threshold=0.0).detect(picture)}
        assert told == {one for one in everything if one >= threshold / 2.0}


def test_a_calibration_changes_how_sure_it_is_and_not_what_is_found(
    tmp_path: Path, airliner: Airliner
) -> None:
    picture, _ = airliner
    plain = {"of_class": {}, "logit": 1.0, "size": 0.0, "size_squared": 0.0, "logit_and_size": 0.0}
    (tmp_path / "plain").mkdir()
    (tmp_path / "kind").mkdir()
    before = EmbeddedDetector(copy(tmp_path / "plain", calibration=plain), 0.0).detect(picture)
    kind = plain | {"of_class": {"airplane": 1.0}}
    after = EmbeddedDetector(copy(tmp_path / "kind", calibration=kind), 0.0).detect(picture)
    assert {one.box for one in before} == {one.box for one in after}
    confidence = {one.box: one.confidence for one in before}
    for one in after:
        if one.label == "airplane":
            odds = confidence[one.box] / (1.0 - confidence[one.box])
            assert one.confidence == pytest.approx(odds * math.e / (1.0 + odds * math.e), rel=1e-3)
        else:
            assert one.confidence == pytest.approx(confidence[one.box])


@pytest.mark.parametrize(
    ("card", "message"),
    [
        ({"classes": ["airplane", "A submarine"]}, "classes/1"),
        ({"classes": []}, "classes"),
        ({"threshold": 2.0}, "threshold"),
    ],
)
def test_a_card_that_is_wrong_is_named(
    tmp_path: Path, card: dict[str, object], message: str
) -> None:
    with pytest.raises(VisionError, match=rf"card\.json: {message}"):
        EmbeddedDetector(copy(tmp_path, **card))
