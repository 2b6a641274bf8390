"""`airhilt doctor` says what is missing before a run does."""

from __future__ import annotations

from pathlib import Path

import pytest

from airhilt.assistant.vision.detectors import embedded
from airhilt.cli import doctor
from airhilt.cli.doctor import Finding, examine
from airhilt.errors import RendererError


@pytest.fixture(autouse=True)
def _no_renderers(monkeypatch: pytest.MonkeyPatch) -> None:
    """They take seconds, and are tried elsewhere."""
    monkeypatch.setattr(doctor, "_renderers", list)


def found() -> dict[str, Finding]:
    return {finding.name: finding for finding in examine()}


def test_the_detector_is_loaded() -> None:
    assert str(found()["detector embedded"]).startswith("ok       detector embedded (small network")


def test_a_detector_without_its_model_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(embedded, "MODEL", tmp_path / "detector.onnx")
    detector = found()["detector embedded"]
    assert str(detector).startswith("MISSING  detector embedded: ")
    assert str(tmp_path) in detector.remedy


def test_an_optional_package_is_named_with_the_extra_that_brings_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(doctor, "_version", lambda name: "" if name == "av" else "1")
    assert str(found()["av"]).startswith("absent   av: ")
    assert "'airhilt[video]'" in found()["av"].remedy


def test_embree_is_needed_and_the_other_renderers_are_not(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(name: str) -> None:
        raise RendererError(f"install {name}")

    monkeypatch.undo()
    monkeypatch.setattr("airhilt.sensors.cameras.renderer_process.probe", fail)
    assert str(found()["renderer embree"]) == "MISSING  renderer embree: install embree"
    for name in ("open3d", "moderngl"):
        assert str(found()[f"renderer {name}"]) == f"absent   renderer {name}: install {name}"
