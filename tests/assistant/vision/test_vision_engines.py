"""Detectors by their names."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from airhilt.assistant.reference import reference_worker
from airhilt.assistant.vision.detectors.embedded import EmbeddedDetector
from airhilt.engine_families import DETECTORS
from airhilt.errors import VisionError
from airhilt.messages import Detections
from pictures import Told, a, background, frame, info


def test_a_yolo_file_that_is_not_there_is_not_downloaded(tmp_path: Path) -> None:
    for name in ("yolov10n.pt", str(tmp_path)):
        with pytest.raises(VisionError, match=r"no such file.*nothing is downloaded"):
            DETECTORS.create(f"yolo:{name}")


def test_a_yolo_file_of_another_kind_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "model.onnx"
    path.write_bytes(b"x")
    with pytest.raises(VisionError, match=r"model\.onnx: expected a model.*onnx:FILE takes \.onnx"):
        DETECTORS.create(f"yolo:{path}")


def test_an_onnx_file_that_is_none_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "broken.onnx"
    path.write_bytes(b"not a network")
    with pytest.raises(VisionError, match=r"detector onnx: .*broken\.onnx: no ONNX model"):
        DETECTORS.create(str(path))


@pytest.mark.parametrize(("times", "expected"), [(0.9, 0), (1.1, 1)])
def test_what_is_found_below_the_threshold_of_the_card_is_not_told_alone(
    times: float, expected: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    worker = reference_worker("vision", "embedded")
    told = Told([a("truck", 320, 100, 40, times * EmbeddedDetector().threshold)])
    monkeypatch.setattr(EmbeddedDetector, "detect", lambda _, picture: told.detect(picture))
    (output,) = worker.step(0, [info(), frame(background())]).outputs
    assert len(Detections.model_validate_json(output.payload).detections) == expected


def test_yolo_is_kept_from_the_network_and_nothing_else_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given: dict[str, str] = {}

    class Model:
        names = {4: "airplane"}  # noqa: RUF012
        task = "detect"

        def __init__(self, _: Path) -> None:
            given.update(os.environ)

    monkeypatch.setitem(sys.modules, "ultralytics", SimpleNamespace(YOLO=Model))
    monkeypatch.setenv("YOLO_VERBOSE", "true")
    monkeypatch.delenv("YOLO_OFFLINE", raising=False)
    path = tmp_path / "yolov10n.pt"
    path.write_bytes(b"x")
    assert DETECTORS.create(f"yolo:{path}").name == "yolo:yolov10n"
    assert (given["YOLO_OFFLINE"], given["YOLO_VERBOSE"]) == ("true", "false")


def test_without_the_package_it_says_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "ultralytics", None)
    path = tmp_path / "yolov10n.pt"
    path.write_bytes(b"x")
    with pytest.raises(VisionError, match=r"pip install airhilt\[yolo\]"):
        DETECTORS.create(f"yolo:{path}")
