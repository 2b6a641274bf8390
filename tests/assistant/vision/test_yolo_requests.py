"""What a YOLO model is asked, and what counts of its answer, with a model that stands for one."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from airhilt.assistant.vision.detector import Found
from airhilt.assistant.vision.detectors import yolo
from airhilt.assistant.vision.detectors.yolo import YoloDetector
from airhilt.errors import VisionError

NAMES = {0: "person", 2: "Car", 4: "airplane", 5: "bus", 7: "truck", 14: "bird"}
"""Some classes of COCO, by their numbers there."""


class Column(list[Any]):
    """Numbers that are read as those of torch are."""

    def int(self) -> Column:
        return Column(int(each) for each in self)

    def tolist(self) -> list[Any]:
        return list(self)


class Model:
    """Answers with given boxes, and keeps what it is asked."""

    task = "detect"

    def __init__(self, *found: tuple[float, float, tuple[float, ...]]) -> None:
        self.names = NAMES
        self.found = found
        self.asked: list[dict[str, Any]] = []
        self.pictures: list[np.ndarray] = []

    def predict(self, picture: np.ndarray, **settings: Any) -> list[Any]:
        self.pictures.append(picture)
        self.asked.append(settings)
        kind, sure, boxes = (Column(each[part] for each in self.found) for part in range(3))
        return [SimpleNamespace(boxes=SimpleNamespace(cls=kind, conf=sure, xyxy=boxes))]


@pytest.fixture
def detector(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    def of(model: Any) -> YoloDetector:
        path = tmp_path / "small.pt"
        path.touch()
        monkeypatch.setattr(yolo, "_load", lambda _: model)
        return YoloDetector(path)

    return of


@pytest.mark.parametrize(
    ("size", "asked"),
    [((96, 128), (96, 128)), ((97, 129), (128, 160)), ((360, 640), (384, 640)), ((1, 1), (32, 32))],
)
def test_a_picture_is_looked_at_in_its_own_resolution_in_whole_steps_of_32_px(
    size: tuple[int, int], asked: tuple[int, int], detector: Any
) -> None:
    model = Model()
    assert detector(model).detect(np.zeros((*size, 3), np.uint8)) == []
    assert model.asked[0]["imgsz"] == asked


def test_it_is_asked_for_what_airhilt_knows_from_a_tenth_on_without_a_word(detector: Any) -> None:
    model = Model()
    looks = detector(model)
    assert (looks.name, looks.threshold) == ("yolo:small", 0.25)
    looks.detect(np.zeros((32, 32, 3), np.uint8))
    asked = model.asked[0]
    assert (asked["conf"], asked["max_det"], asked["verbose"]) == (0.1, 300, False)
    assert (sorted(asked["classes"]), asked["device"]) == ([2, 4, 5, 7, 14], "cpu")


def test_it_gets_blue_before_green_before_red(detector: Any) -> None:
    model = Model()
    detector(model).detect(np.full((32, 32, 3), (1, 2, 3), np.uint8))
    assert model.pictures[0][0, 0].tolist() == [3, 2, 1]
    assert model.pictures[0].flags.c_contiguous


def test_cars_and_buses_are_trucks_and_boxes_without_an_inside_are_none(detector: Any) -> None:
    found = detector(
        Model(
            (2, 0.5, (1.0, 2.0, 3.0, 4.0)), (5, 0.25, (0.0, 0.0, 9.0, 9.0)),
            (4, 0.9, (5.0, 0.0, 5.0, 9.0)), (4, 0.9, (0.0, 7.0, 9.0, 7.0)),
            (14, 0.75, (0.0, 0.0, 1.0, 1.0)),
        )
    ).detect(np.zeros((32, 32, 3), np.uint8))  # fmt: skip
    assert found == [
        Found("truck", 0.5, (1.0, 2.0, 3.0, 4.0)),
        Found("truck", 0.25, (0.0, 0.0, 9.0, 9.0)),
        Found("bird", 0.75, (0.0, 0.0, 1.0, 1.0)),
    ]


def test_a_model_of_another_task_or_of_other_things_is_refused(detector: Any) -> None:
    model = Model()
    model.task = "segment"
    with pytest.raises(VisionError, match="its task is 'segment'"):
        detector(model)
    model = Model()
    model.names = {0: "person", 1: "dog"}
    with pytest.raises(VisionError, match=r"it knows 2 classes \(person, dog\)"):
        detector(model)


def test_a_model_that_fails_while_it_looks_or_loads_is_named(
    detector: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    class Failing(Model):
        def predict(self, picture: np.ndarray, **settings: Any) -> list[Any]:
            raise RuntimeError("out of memory")

    with pytest.raises(VisionError, match=r"small.pt: failed: .*out of memory"):
        detector(Failing()).detect(np.zeros((32, 32, 3), np.uint8))

    def unreadable(_: Path) -> Any:
        raise ValueError("no pickle")

    monkeypatch.setattr(yolo, "_load", unreadable)
    with pytest.raises(VisionError, match=r"does not load: .*no pickle"):
        YoloDetector(tmp_path / "small.pt")
