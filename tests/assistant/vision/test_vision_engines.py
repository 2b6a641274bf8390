"""Detectors by their names."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from airhilt.assistant.reference import reference_worker
from airhilt.assistant.vision.detectors.embedded import MODEL, EmbeddedDetector
from airhilt.engine_families import DETECTORS
from airhilt.errors import VisionError
from airhilt.messages import Detections
from pictures import Told, a, background, frame, info


def test_a_yolo_file_that_is_not_there_is_not_downloaded(tmp_path: Path) -> None:
    for name in ("yolov10n.pt", f"{tmp_path}/yolo11n.onnx", str(tmp_path)):
        with pytest.raises(VisionError, match=r"no such file.*nothing is downloaded"):
            DETECTORS.create(f"yolo:{name}")


def test_a_yolo_file_of_another_kind_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "model.engine"
    path.write_bytes(b"x")
    with pytest.raises(VisionError, match=r"model\.engine: expected a model.*\.pt or \.onnx"):
        DETECTORS.create(f"yolo:{path}")


def test_an_onnx_file_that_is_none_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "broken.onnx"
    path.write_bytes(b"not a network")
    with pytest.raises(VisionError, match=r"detector yolo: .*broken\.onnx: no ONNX model"):
        DETECTORS.create(f"yolo:{path}")


def test_an_onnx_file_with_code_in_its_metadata_is_refused(tmp_path: Path) -> None:
    path, ran = tmp_path / "model.onnx", tmp_path / "ran"
    network = MODEL.read_bytes()
    code = f"open({str(ran)!r}, 'w')".encode()
    entry = b"\x0a\x05names\x12" + bytes([len(code)]) + code
    # Field 14 of onnx.ModelProto is metadata_props, of keys and values.
    assert len(entry) < 128
    path.write_bytes(network + b"\x72" + bytes([len(entry)]) + entry)
    with pytest.raises(VisionError, match="'names' is no plain value, and may be code"):
        DETECTORS.create(f"yolo:{path}")
    assert not ran.exists()


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
