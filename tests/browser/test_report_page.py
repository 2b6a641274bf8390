"""The report of a run, as a browser shows it."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from airhilt.cosim import Options, run
from airhilt.metrics.report import write_report
from airhilt.record import RunFolder
from airhilt.scenario import Scenario

sys.path.insert(0, str(Path(__file__).parent))
from devtools import BROWSERS, Page, browser_page

EXECUTABLE = next((found for name in BROWSERS if (found := shutil.which(name))), None)

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(EXECUTABLE is None, reason="no Chromium on PATH: apt-get install chromium"),
]


@pytest.fixture(scope="module")
def browser() -> Iterator[Page]:
    assert EXECUTABLE is not None
    with browser_page(EXECUTABLE) as page:
        yield page


@pytest.fixture
def page(browser: Page) -> Iterator[Page]:
    """A page that must have nothing to complain of."""
    browser.complaints.clear()
    yield browser
    assert browser.complaints == []


@pytest.fixture(scope="module")
def folder(encounter: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("report") / "run"
    return run(encounter, Options(latency="fixed", out=out)).folder


@pytest.fixture(scope="module")
def report(folder: Path) -> Path:
    return write_report(folder)


def cursors(page: Page) -> list[float]:
    return page.evaluate(
        "[...document.querySelectorAll('.cursor')].map((c) => +c.getAttribute('x1'))"
    )


def test_all_charts_are_drawn(page: Page, report: Path) -> None:
    page.open(report)
    for chart, least in (("plan", 2), ("profile", 2), ("separation", 2)):
        assert page.evaluate(f"document.querySelectorAll('#{chart} svg path.line').length") == least
    assert page.evaluate("document.querySelectorAll('#histogram svg rect').length") >= 2
    assert page.evaluate("document.querySelectorAll('.tile').length") == 9
    assert page.evaluate("document.querySelectorAll('#timeline tr').length") > 5


def test_the_slider_moves_all_three_charts(page: Page, report: Path) -> None:
    page.open(report)
    before = cursors(page)
    aircraft = "document.querySelector('#plan g g').innerHTML"
    was = page.evaluate(aircraft)
    page.evaluate("document.getElementById('slider').focus()")
    for _ in range(4):
        page.press("ArrowRight", 39)
    after = cursors(page)
    assert len(after) == 2
    assert all(later > earlier for earlier, later in zip(before, after, strict=True))
    assert page.evaluate(aircraft) != was


def test_the_play_button_moves_time_and_stops_again(page: Page, report: Path) -> None:
    page.open(report)
    wait = "new Promise((done) => setTimeout(() => done(clock.t), 300))"
    begin = page.evaluate("clock.t")
    page.evaluate("document.getElementById('play').click()")
    assert page.evaluate(wait) > begin
    page.evaluate("document.getElementById('play').click()")
    stopped = page.evaluate("clock.t")
    assert page.evaluate(wait) == stopped


def test_a_row_of_the_timeline_shows_its_time(page: Page, report: Path) -> None:
    page.open(report)
    page.evaluate("document.querySelector('#timeline tr:last-child button').click()")
    last = float(page.evaluate("document.querySelector('#timeline tr:last-child').dataset.t"))
    assert page.evaluate("clock.t") == pytest.approx(last)


def test_a_filter_hides_the_rows_of_its_kind(page: Page, report: Path) -> None:
    page.open(report)
    visible = "[...document.querySelectorAll('#timeline tr')].filter((row) => !row.hidden).length"
    before = page.evaluate(visible)
    page.evaluate("document.querySelector('#filters [aria-pressed=true]').click()")
    assert page.evaluate(visible) < before


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("width", [360, 768, 1600])
def test_the_page_fits_its_window(page: Page, report: Path, width: int, dark: bool) -> None:
    page.open(report, width=width, dark=dark)
    assert page.evaluate("document.scrollingElement.scrollWidth") <= width


@pytest.mark.parametrize("dark", [False, True])
def test_text_can_be_read(page: Page, report: Path, dark: bool) -> None:
    page.open(report, dark=dark)
    ratios = page.evaluate("""(() => {
      const pixel = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
      const luminance = (name) => {
        pixel.fillStyle = getComputedStyle(document.documentElement).getPropertyValue(name);
        pixel.fillRect(0, 0, 1, 1);
        const [r, g, b] = [...pixel.getImageData(0, 0, 1, 1).data].map((v) => v / 255)
          .map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const inks = ["--ink", "--dim", "--accent", "--good", "--bad", "--warn", "--other"]
        .concat([..."01234567"].map((i) => `--c${i}`));
      const pairs = inks.flatMap((ink) => [[ink, "--panel"], [ink, "--page"]])
        .concat([["--bad", "--bad-fill"], ["--ink", "--warn-fill"]]);
      return pairs.map(([ink, paper]) => {
        const [low, high] = [luminance(ink), luminance(paper)].sort((a, b) => a - b);
        return [`${ink} on ${paper}`, (high + 0.05) / (low + 0.05)];
      });
    })()""")
    assert [(name, ratio) for name, ratio in ratios if ratio < 4.5] == []


def test_hostile_text_is_shown_and_not_run(page: Page, folder: Path, tmp_path: Path) -> None:
    hostile = "</script><img src=x onerror='document.title=1'><b id=planted>"
    copy = shutil.copytree(folder, tmp_path / "run")
    info = RunFolder(copy).info()
    info.realised["title"] = hostile
    RunFolder(copy).write_info(info)
    page.open(write_report(copy))
    assert page.evaluate("document.getElementById('title').textContent") == hostile
    assert page.evaluate("document.getElementById('planted')") is None
    assert page.evaluate("document.title") != "1"


@pytest.mark.parametrize("size", [0, 9000])
def test_a_killed_run_is_drawn_as_far_as_it_goes(
    page: Page, folder: Path, tmp_path: Path, size: int
) -> None:
    copy = shutil.copytree(folder, tmp_path / "run")
    (copy / "summary.json").unlink()
    log = copy / "log.mcap"
    log.write_bytes(log.read_bytes()[:size])
    page.open(write_report(copy))
    assert page.evaluate("document.querySelectorAll('.note').length") >= 2
    assert page.evaluate("document.querySelectorAll('#plan svg').length") == (size > 0)
