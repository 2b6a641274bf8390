"""Detectors that people bring as ONNX files are told apart by their inputs and outputs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("onnx")
from onnx import TensorProto

import tiny_detectors as tiny
from airhilt.assistant.reference import vision_worker
from airhilt.assistant.vision.class_names import notice_of
from airhilt.assistant.vision.detectors.onnx import OnnxDetector
from airhilt.engine_families import DETECTORS
from airhilt.errors import VisionError

GREY = np.full((*tiny.PICTURE_PX, 3), 128, np.uint8)
VOC = ["aeroplane", "bicycle", "bird", "boat", "bottle", "bus", "car", "cat", "chair", "cow"]


@pytest.mark.parametrize("family", tiny.FAMILIES, ids=lambda each: each.__name__)
def test_a_network_of_each_family_finds_the_airplane_where_it_is(
    family: Callable[[], dict[str, Any]], tmp_path: Path
) -> None:
    detector = DETECTORS.create(str(tiny.write(tmp_path / "model.onnx", **family())))
    (found,) = detector.detect(GREY)
    assert found.label == "airplane"
    assert found.confidence == pytest.approx(tiny.SCORE, abs=1e-5)
    assert found.box == pytest.approx(tiny.AIRPLANE, abs=0.01)
    assert 0.1 < detector.threshold < 1.0


@pytest.mark.parametrize(
    ("family", "place", "colour"),
    [
        (tiny.yolov10, (0, 0, 4), (204, 10, 20)),
        (tiny.yolox, (0, 5 * 40 + 12, 5 + tiny.COCO_INDEX), (10, 20, 204)),
    ],
)
def test_yolo_gets_parts_of_red_first_and_yolox_levels_of_blue(
    family: Callable[[], dict[str, Any]],
    place: tuple[int, ...],
    colour: tuple[int, int, int],
    tmp_path: Path,
) -> None:
    made = family()
    (found,) = made["outputs"].values()
    found[place] = 0.0
    if family is tiny.yolox:
        found[0, 5 * 40 + 12, 4] = 1.0 / 255.0
    detector = OnnxDetector(tiny.write(tmp_path / "model.onnx", **made, lit=place))
    picture = np.full((*tiny.PICTURE_PX, 3), colour, np.uint8)
    (airplane,) = detector.detect(picture)
    assert airplane.confidence == pytest.approx(0.8, abs=1e-4)


def voc(folder: Path, kind: int) -> Path:
    found = np.zeros((1, 300, 6), np.float32)
    found[0, 0] = (*tiny.IN_HALF, tiny.SCORE, kind)
    names = str(dict(enumerate(VOC)))
    return tiny.write(folder / "voc.onnx", tiny.PICTURES, {"output0": found}, {"names": names})


def test_an_aeroplane_is_an_airplane_and_what_is_dropped_is_told(tmp_path: Path) -> None:
    path = voc(tmp_path, 0)
    (found,) = OnnxDetector(path).detect(GREY)
    assert found.label == "airplane"
    assert notice_of(vision_worker(f"onnx:{path}").description) == (
        "vision tells aeroplane as airplane, bird, bus as truck, car as truck; drops 6 classes: "
        "bicycle, boat, bottle, cat, chair, cow"
    )
    assert not notice_of(vision_worker("embedded").description)


def test_a_person_says_what_classes_are_called(tmp_path: Path) -> None:
    path = voc(tmp_path, 9)
    assert not OnnxDetector(path).detect(GREY)
    (found,) = OnnxDetector(path, {"Cow": "deer"}).detect(GREY)
    assert found.label == "deer"
    with pytest.raises(VisionError, match=r"--detector-classes kow=.*no such class.*'cow'"):
        OnnxDetector(path, {"kow": "deer"})


@pytest.mark.parametrize(("name", "text"), [
    ("labels.txt", "\n".join(VOC)),
    ("model.txt", "\n".join(VOC)),
    ("config.json", '{"id2label": {"0": "aeroplane", "1": "bicycle"}}'),
])  # fmt: skip
def test_names_of_classes_are_read_beside_the_file(name: str, text: str, tmp_path: Path) -> None:
    made = tiny.yolov10()
    (found,) = made["outputs"].values()
    found[0, 0, 5] = 0
    (tmp_path / name).write_text(text)
    (airplane,) = OnnxDetector(tiny.write(tmp_path / "model.onnx", **made)).detect(GREY)
    assert airplane.label == "airplane"


def floats(*shape: int) -> np.ndarray:
    return np.zeros(shape, np.float32)


@pytest.mark.parametrize(
    ("inputs", "outputs", "message"),
    [
        ({"x": (TensorProto.FLOAT, [1, 10])}, {"y": floats(1, 300, 6)}, "takes 'x' .* three col"),
        ({"x": (TensorProto.FLOAT, [1, 1, 64, 64])}, {"y": floats(1, 300, 6)}, "three colours"),
        (tiny.PICTURES, {"y": floats(1, 1000)}, r"gives 'y' \[1, 1000\]; expected a detector as"),
        (tiny.PICTURES, {"a": floats(1, 9, 4), "b": floats(1, 7)}, "gives 'a' .*, 'b'"),
        (tiny.PICTURES, {"y": floats(1, 300, 11)}, "7 classes have no names; expected the meta"),
        (
            {**tiny.PICTURES, "z": (TensorProto.FLOAT, [3, 3, 3, 3])}, {"y": floats(1, 300, 6)},
            "takes 'z' .* besides pictures",
        ),
    ],
)  # fmt: skip
def test_other_networks_are_refused_in_one_line(
    inputs: dict[str, Any], outputs: dict[str, Any], message: str, tmp_path: Path
) -> None:
    path = tiny.write(tmp_path / "other.onnx", inputs, outputs)
    with pytest.raises(VisionError, match=message) as caught:
        OnnxDetector(path)
    assert "\n" not in str(caught.value)


def test_a_later_opset_and_a_picture_without_pixels_are_refused(tmp_path: Path) -> None:
    path = tiny.write(tmp_path / "later.onnx", **tiny.yolov10(), opset=99)
    with pytest.raises(VisionError, match=r"later\.onnx: no ONNX model that can be run") as caught:
        OnnxDetector(path)
    assert "\n" not in str(caught.value)
    detector = OnnxDetector(tiny.write(tmp_path / "model.onnx", **tiny.yolov10()))
    with pytest.raises(VisionError, match="a picture of 0 by 0 pixels"):
        detector.detect(np.zeros((0, 0, 3), np.uint8))


def test_code_in_the_metadata_is_not_run(tmp_path: Path) -> None:
    names = {"names": f"open({str(tmp_path / 'ran')!r}, 'w')"}
    path = tiny.write(tmp_path / "model.onnx", **tiny.yolov10(), metadata=names)
    with pytest.raises(VisionError, match="names of its classes cannot be read"):
        OnnxDetector(path)
    assert not (tmp_path / "ran").exists()
