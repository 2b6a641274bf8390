"""What a browser shows of the cameras of a run."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from airhilt.cosim import simulation as cosim
from airhilt.errors import RendererError
from airhilt.options import Options
from airhilt.record import RunFolder
from airhilt.report import write_report
from airhilt.scenario import Scenario
from camera_run import camera_run, passing
from devtools import Page

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    with pytest.MonkeyPatch.context() as patch:
        return camera_run(tmp_path_factory.mktemp("cameras") / "run", patch).folder


@pytest.fixture(scope="module")
def report(folder: Path) -> Path:
    return write_report(folder)


def text(page: Page, selector: str) -> str:
    found: str = page.evaluate(f"document.querySelector('{selector}').textContent")
    return found


def count(page: Page, selector: str) -> int:
    found: int = page.evaluate(f"document.querySelectorAll('{selector}').length")
    return found


def test_key_pictures_are_shown_with_boxes_and_who_is_in_them(page: Page, report: Path) -> None:
    page.open(report)
    assert page.evaluate("document.getElementById('cameras').hidden") is False
    assert page.evaluate(
        "[...document.querySelectorAll('.picture figcaption')].map((c) => c.firstChild.data.trim())"
    ) == ["First detection", "First warning", "Closest approach"]
    first = ".picture:first-child"
    assert count(page, f"{first} .framed > svg:first-child rect.unconfirmed") == 1
    assert count(page, f"{first} .framed > svg:first-child rect.true") == 1
    assert count(page, f"{first} .zoom image") == 1
    listed = text(page, f"{first} .boxes")
    assert "airplane 0.80, not confirmed: DAL456, 4,0" in listed
    assert "m off" in listed
    assert "WARNING to " in text(page, ".picture:nth-child(2)")
    assert re.search(r"\d s before the closest approach", text(page, ".picture:nth-child(3)"))
    assert "known 50 ms later" in text(page, f"{first} figcaption")


def test_pictures_are_really_loaded(page: Page, report: Path) -> None:
    page.open(report)
    loaded = "[...document.querySelectorAll('.thumbs img')].map((i) => [i.naturalWidth, i.alt])"
    assert page.evaluate(f"Promise.all({loaded})") == [
        [320, "View of nose-AAL123 at 0.0 s"],
        [320, "View of nose-DAL456 at 0.0 s"],
    ]


def test_the_time_of_a_picture_sets_the_clock(page: Page, report: Path) -> None:
    page.open(report)
    page.evaluate("document.querySelector('.picture:nth-child(3) button').click()")
    shown = float(text(page, ".picture:nth-child(3) button"))
    assert page.evaluate("clock.t") == pytest.approx(shown, abs=0.06)


def test_each_camera_has_a_timeline_and_a_row(page: Page, report: Path) -> None:
    page.open(report)
    assert count(page, "#detections svg rect.in-view") == 2
    assert count(page, "#detections svg rect.confirmed") >= 2
    assert count(page, "#detections svg .taken") == 3
    assert count(page, "#camera-figures tbody tr") == 3
    assert "nose-AAL123" in text(page, "#camera-figures")
    assert "Vision" in text(page, "#latencies")


def test_the_numbers_of_vision_are_shown(page: Page, report: Path) -> None:
    page.open(report)
    tiles = text(page, "#vision-tiles")
    for name in ("First detection", "Recall", "False detections", "Vision latency"):
        assert name in tiles
    assert count(page, "#recall tbody tr") == 4
    assert "DAL456" in text(page, "#first-detections")


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("width", [390, 800, 1280])
def test_the_page_fits_its_window(page: Page, report: Path, width: int, dark: bool) -> None:
    page.open(report, width=width, dark=dark)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    widest = "Math.max(...[...document.querySelectorAll('.picture')].map((p) => p.scrollWidth))"
    assert page.evaluate(widest) <= width


def test_a_killed_run_shows_its_pictures(page: Page, folder: Path, tmp_path: Path) -> None:
    killed = shutil.copytree(folder, tmp_path / "run")
    RunFolder(killed).summary_path.unlink()
    page.open(write_report(killed))
    assert count(page, ".picture") == 3
    assert count(page, "#detections svg rect.in-view") == 2
    assert count(page, "#vision-tiles .tile") == 0


def test_why_vision_was_not_evaluated_is_shown(
    page: Page, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def missing(scenario: Scenario, renderer: str) -> None:
        raise RendererError("no <b>EGL</b> here")

    with monkeypatch.context() as patch:
        patch.setattr("camera_run.BlankSceneRenderer", lambda scenario: missing(scenario, "open3d"))
        short = passing().model_copy(update={"duration_s": 1.0})
        folder = camera_run(tmp_path / "run", patch, short).folder
    page.open(write_report(folder))
    assert "Vision is not evaluated: no <b>EGL</b> here" in text(page, "#cameras-note")
    assert "vision is not evaluated: no <b>EGL</b> here" in text(page, "#notes")
    assert count(page, ".picture") == 0


def test_a_run_without_cameras_has_no_such_section(page: Page, tmp_path: Path) -> None:
    short = passing().model_copy(update={"duration_s": 1.0})
    options = Options(out=tmp_path / "run", cameras=False, speech=False)
    page.open(write_report(cosim.run(short, options).folder))
    assert page.evaluate("document.getElementById('cameras').hidden") is True
    assert page.evaluate("document.getElementById('detections-figure').hidden") is True


def test_the_plan_shows_where_cameras_look_and_the_bearings_of_what_they_have_found(
    page: Page, report: Path
) -> None:
    page.open(report)
    times = page.evaluate("given.sections.plan.map((one) => one.found.map(([t]) => t))")
    page.evaluate(f"clock.set({next(found[0] for found in times if found)})")
    assert count(page, "#plan .cone") == len(times)
    assert count(page, "#plan .bearing") >= 1
