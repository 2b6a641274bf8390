"""`airhilt doctor` says what is missing before a run does."""

from __future__ import annotations

import importlib.metadata
import os
import sys
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from airhilt.assistant.vision.detectors import embedded
from airhilt.cli.commands import doctor
from airhilt.cli.commands.doctor import COMMAND, Finding, examine
from airhilt.errors import RendererError
from airhilt.plugins import Family
from engine_package import installed
from paths import ROOT


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
    def version(name: str) -> str:
        if name == "av":
            raise importlib.metadata.PackageNotFoundError
        return "1"

    monkeypatch.setattr(importlib.metadata, "version", version)
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
        ("airhilt.report_sections", "report section broken"),
        ("airhilt.asr", "recogniser broken"),
    ],
)
def test_a_broken_member_is_listed_with_the_cause_and_is_not_absent(
    group: str, title: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with installed(tmp_path, monkeypatch, group, "broken", "raise RuntimeError('it is broken')"):
        broken = found()[title]
    assert str(broken).startswith(f"BROKEN   {title}: ")
    assert "RuntimeError: it is broken" in broken.remedy


def test_a_broken_renderer_is_listed_with_the_cause_and_is_not_absent(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.undo()
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), *sys.path]))
    monkeypatch.setattr(Family, "names", lambda _: ["broken"])
    source = "raise RuntimeError('it is broken')"
    with installed(tmp_path, monkeypatch, "airhilt.renderers", "broken", source):
        (broken,) = doctor._renderers()
    assert str(broken).startswith("BROKEN   renderer broken: ")
    assert "RuntimeError: it is broken" in broken.remedy


def test_a_sensor_of_airhilt_that_is_broken_is_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("airhilt.sensors.adsb.SENSOR", 42)
    sensor = found()["sensor adsb"]
    assert str(sensor).startswith("BROKEN   sensor adsb: ")
    assert sensor.needed


FAILS_WHEN_MADE = """
from airhilt.engines import Engine
ENGINE = Engine("broken", "fails", lambda _: 1 / 0)
"""


def test_an_engine_of_another_package_that_cannot_be_made_is_broken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with installed(tmp_path, monkeypatch, "airhilt.asr", "broken", FAILS_WHEN_MADE):
        assert str(found()["recogniser broken"]).startswith("BROKEN   recogniser broken: ")


def test_the_command_fails_if_something_is_broken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with installed(tmp_path, monkeypatch, "airhilt.kinds", "broken", "raise RuntimeError"):
        done = CliRunner().invoke(COMMAND)
    assert done.exit_code == 1
    assert "BROKEN   kind broken" in done.stdout


def test_every_package_that_airhilt_depends_on_is_looked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    monkeypatch.setattr(importlib.metadata, "requires", lambda _: declared)
    names = {each.split(">")[0] for each in declared if ";" not in each}
    assert names <= set(found())
    assert {"click", "jinja2", "rich"} <= names
