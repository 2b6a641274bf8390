"""`airhilt doctor` says what is missing before a run does."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from airhilt.assistant.vision.detectors import embedded
from airhilt.cli import doctor
from airhilt.cli.doctor import Finding, examine
from airhilt.errors import RendererError
from engine_package import installed


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


@pytest.mark.parametrize(
    ("group", "title"),
    [
        ("airhilt.sensors", "sensor broken"),
        ("airhilt.kinds", "kind broken"),
        ("airhilt.report_sections", "report section broken"),
        ("airhilt.commands", "command broken"),
    ],
)
def test_a_broken_member_is_listed_with_the_cause_and_is_not_needed(
    group: str, title: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with installed(tmp_path, monkeypatch, group, "broken", "raise RuntimeError('it is broken')"):
        broken = found()[title]
    assert str(broken).startswith(f"absent   {title}: ")
    assert "RuntimeError: it is broken" in broken.remedy


def test_a_broken_renderer_is_listed_with_the_cause_and_is_not_needed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.undo()
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), *sys.path]))
    source = "raise RuntimeError('it is broken')"
    with installed(tmp_path, monkeypatch, "airhilt.renderers", "broken", source):
        broken = doctor._renderer("broken", needed=False)
    assert str(broken).startswith("absent   renderer broken: ")
    assert "RuntimeError: it is broken" in broken.remedy


def test_the_members_that_can_be_used_are_listed_by_family() -> None:
    families = found()
    for family, member in {
        "sensors": "adsb", "kinds": "deer", "report sections": "timeline", "commands": "cosim",
    }.items():  # fmt: skip
        assert member in families[family].found


def test_a_sensor_of_airhilt_that_is_broken_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("airhilt.sensors.adsb.SENSOR", 42)
    assert str(found()["sensor adsb"]).startswith("MISSING  sensor adsb: ")
