"""The report as a browser shows it."""

from __future__ import annotations

import re
import shutil
import subprocess

import pytest

from airhilt import run
from airhilt.scenario import Scenario

CHROMIUM = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome")
     if (found := shutil.which(name))), None,
)  # fmt: skip

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(CHROMIUM is None, reason="no Chromium: apt-get install chromium"),
]

PROBE = """
<script>
addEventListener("load", () => setTimeout(() => {
  const slider = document.getElementById("slider");
  const cursor = () => document.querySelector("#profile .cursor").getAttribute("x1");
  const before = cursor();
  slider.value = 5;
  slider.dispatchEvent(new Event("input"));
  document.body.dataset.moved = String(before !== cursor());
  document.body.dataset.now = document.getElementById("now").textContent;
}, 50));
addEventListener("error", (event) => { document.body.dataset.error = event.message; });
</script>
"""


@pytest.fixture(scope="module", params=["reference", "none"])
def page(
    request: pytest.FixtureRequest,
    encounter: Scenario,
    tmp_path_factory: pytest.TempPathFactory,
) -> str:
    """What the page of a run has become in a browser."""
    folder = tmp_path_factory.mktemp("page")
    report = run(encounter, out=folder / "run", assistant=request.param).folder / "report.html"
    html = report.read_text().replace("<body>", f"<body>{PROBE}")
    (folder / "probed.html").write_text(html)
    done = subprocess.run(
        [str(CHROMIUM), "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic",
         "--no-first-run", "--disable-background-networking", "--disable-component-update",
         "--disable-sync", f"--user-data-dir={folder / 'profile'}", "--virtual-time-budget=2000",
         "--window-size=1300,2000", "--dump-dom", f"file://{folder / 'probed.html'}"],
        capture_output=True,
        text=True,
        timeout=60.0,
        check=True,
    )  # fmt: skip
    return done.stdout


def test_nothing_goes_wrong_on_the_page(page: str) -> None:
    assert "data-error" not in page


@pytest.mark.parametrize("chart", ["Plan view", "Vertical profile", "horizontal separation"])
def test_charts_are_drawn_with_units(page: str, chart: str) -> None:
    assert f'aria-label="{chart}"' in page
    for unit in ("east, NM", "altitude, ft", "time, s", "separation, NM"):
        assert unit in page


def test_the_slider_moves_the_cursor_and_tells_the_time(page: str) -> None:
    assert 'data-moved="true"' in page
    assert re.search(r'data-now="[\d.]+ NM, \d+ ft apart', page)


def test_the_timeline_lists_the_calls(page: str) -> None:
    assert "Washington Center, American one two three" in page
