"""A YOLO model learns from an export, and AIRHILT looks with what it has become."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

import train_yolo
from airhilt.assistant.vision.detectors.onnx import OnnxDetector
from airhilt.sensors.cameras.dataset.export import export
from airhilt.sensors.cameras.dataset.pictures import Takes, random_pictures
from pictures import background

INSTALLED = importlib.util.find_spec("ultralytics") is not None


def exported(folder: Path, count: int) -> Path:
    takes = Takes(of_world=2, empty=0.0)
    export(
        lambda first: random_pictures(count, 3, ["en_route"], "embree", (96, 64), takes, first),
        folder,
        {},
        ("yolo",),
    )
    return folder


@pytest.mark.yolo
@pytest.mark.skipif(not INSTALLED, reason="no ultralytics: pip install airhilt[yolo]")
@pytest.mark.filterwarnings("ignore")
def test_a_model_learns_for_an_epoch_and_looks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from torchvision_operators import mend_torchvision

    monkeypatch.setenv("YOLO_CONFIG_DIR", str(tmp_path / "ultralytics"))
    mend_torchvision()
    data = exported(tmp_path / "data", 20)
    given = [str(data), "--model", "yolo11n.yaml", "--out", str(tmp_path / "mine")]
    train_yolo.main([*given, "--epochs", "1", "--side", "64", "--batch", "8"])
    detector = OnnxDetector(tmp_path / "mine" / "mine.onnx")
    assert set(detector.classes.labels.values()) >= {"airplane", "truck", "bird"}
    detector.detect(background(96, 64))


def test_a_folder_that_is_no_export_of_yolo_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        train_yolo.main([str(tmp_path), "--model", "a.pt", "--out", str(tmp_path / "new")])
    assert "has no data.yaml; expected what" in capsys.readouterr().err
