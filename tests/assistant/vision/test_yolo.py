"""ultralytics YOLO, here a small model that has learned nothing."""

from __future__ import annotations

import importlib.util
import socket
from pathlib import Path
from typing import Any

import pytest

from airhilt.assistant.vision.detectors.onnx import OnnxDetector
from airhilt.assistant.vision.detectors.yolo import LEAST_CONFIDENCE, YoloDetector
from airhilt.engine_families import DETECTORS
from airhilt.errors import VisionError
from pictures import background
from tiny_models import write_yolo
from torchvision_operators import mend_torchvision

INSTALLED = importlib.util.find_spec("ultralytics") is not None
pytestmark = [
    pytest.mark.yolo,
    pytest.mark.skipif(not INSTALLED, reason="no ultralytics: pip install airhilt[yolo]"),
    pytest.mark.filterwarnings("ignore"),
]
PICTURE = background(640, 360)


@pytest.fixture(scope="module", autouse=True)
def _offline(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """No settings of the user, no network, and operators for torchvision where it has none."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("YOLO_CONFIG_DIR", str(tmp_path_factory.mktemp("ultralytics")))
        for name in ("YOLO_OFFLINE", "YOLO_VERBOSE"):
            patch.setenv(name, "true" if name == "YOLO_OFFLINE" else "false")
        patch.setattr(socket.socket, "connect", _no_network)
        mend_torchvision()
        yield


def _no_network(*_: object) -> None:
    raise AssertionError("something asked the network")


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with `tiny_models.write_yolo`'s."""
    folder = tmp_path_factory.mktemp("models")
    write_yolo(folder)
    return folder


@pytest.mark.parametrize("file", ["yolov10n.pt", "yolov10n.onnx", "fixed.onnx"])
class TestModel:
    def test_finds_things_with_names_that_are_known(self, models: Path, file: str) -> None:
        detector = DETECTORS.create(str(models / file))
        found = detector.detect(PICTURE)
        assert found
        assert {one.label for one in found} <= {"airplane", "truck", "bird"}
        assert all(LEAST_CONFIDENCE <= one.confidence <= 1.0 for one in found)
        assert [one.confidence for one in found] == sorted(
            (one.confidence for one in found), reverse=True
        )
        for left, top, right, bottom in (one.box for one in found):
            assert 0.0 <= left < right <= 640.0
            assert 0.0 <= top < bottom <= 360.0
        assert LEAST_CONFIDENCE < detector.threshold < 1.0
        assert detector.name.partition(":")[2] == Path(file).stem


def test_the_two_forms_of_a_model_find_the_same(models: Path) -> None:
    torch_found = YoloDetector(models / "yolov10n.pt").detect(background(640, 384))
    onnx_found = OnnxDetector(models / "yolov10n.onnx").detect(background(640, 384))
    assert len(torch_found) == len(onnx_found)
    for one, other in zip(torch_found, onnx_found, strict=True):
        assert one.confidence == pytest.approx(other.confidence, abs=1e-4)


def test_red_and_blue_are_not_mistaken_for_each_other(models: Path) -> None:
    """The model sees the picture as ultralytics shows it one that it reads from a file."""
    image = pytest.importorskip("PIL.Image")
    picture = background(320, 320)
    picture[100:200, 100:200] = (255, 0, 40)
    path = models / "picture.png"
    image.fromarray(picture).save(path)
    detector = YoloDetector(models / "yolov10n.pt")
    found = detector.detect(picture)
    boxes = detector._model.predict(
        path, imgsz=320, conf=LEAST_CONFIDENCE, max_det=300, classes=list(detector.classes.labels),
        verbose=False,
    )[0].boxes  # fmt: skip
    assert found
    assert [one.confidence for one in found] == pytest.approx(boxes.conf.tolist(), abs=1e-6)


def test_a_model_of_other_things_is_refused(models: Path) -> None:
    with pytest.raises(VisionError, match=r"others\.pt: it knows 80 classes \(class0.*airplane"):
        YoloDetector(models / "others.pt")


def test_a_file_that_is_no_model_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "broken.pt"
    path.write_bytes(b"not a model")
    with pytest.raises(VisionError, match=r"broken\.pt: does not load"):
        YoloDetector(path)
