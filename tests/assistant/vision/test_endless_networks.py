"""A network that never ends is stopped when a detector looks at it for the first time."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from airhilt.assistant.vision.detectors.embedded import MODEL, EmbeddedDetector
from airhilt.assistant.vision.detectors.onnx import OnnxDetector
from airhilt.errors import VisionError

pytest.importorskip("onnx")
from onnx import TensorProto

from endless_networks import write_endless


@pytest.fixture(autouse=True)
def _short_patience(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("airhilt.host.onnx.FIRST_LOOK_S", 0.3)


def shipped(folder: Path) -> Path:
    for file in (*MODEL.parent.glob("*.onnx"), MODEL.with_name("card.json")):
        shutil.copy(file, folder)
    return folder / MODEL.name


def test_the_network_of_a_detector_is_stopped(tmp_path: Path) -> None:
    path = shipped(tmp_path)
    write_endless(
        path,
        {"picture": (TensorProto.UINT8, ["n", "rows", "columns", 3])},
        {"found": ["n", "found", 6]},
    )
    with pytest.raises(VisionError, match=r"detector\.onnx: the network does not end within 0\.3"):
        EmbeddedDetector(path)


def test_the_network_of_a_refiner_is_stopped(tmp_path: Path) -> None:
    path = shipped(tmp_path)
    card = json.loads(path.with_name("card.json").read_text())
    write_endless(
        tmp_path / card["refiner"]["file"],
        {
            "views": (TensorProto.UINT8, ["n", 2, 40, 40, 3]),
            "about": (TensorProto.FLOAT, ["n", 3]),
        },
        {"chances": ["n", 1 + len(card["classes"])], "moves": ["n", 4]},
    )
    with pytest.raises(VisionError, match=r"refiner .*: the network does not end within 0\.3 s"):
        EmbeddedDetector(path)


@pytest.mark.parametrize("sides", [("rows", "columns"), (64, 96)])
def test_a_network_of_others_is_stopped(tmp_path: Path, sides: tuple[int | str, ...]) -> None:
    path = tmp_path / "endless.onnx"
    write_endless(path, {"images": (TensorProto.FLOAT, [1, 3, *sides])}, {"output0": [1, 6, 100]})
    with pytest.raises(VisionError, match=r"endless\.onnx: the network does not end within 0\.3 s"):
        OnnxDetector(path)
