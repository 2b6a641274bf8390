"""axe-core finds nothing serious on the pages, light and dark.

npm install axe-core --prefix axe
AXE_CORE=axe/node_modules/axe-core/axe.min.js pytest -m slow tests/station
"""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path
from typing import Any

import pytest

from devtools import Page
from nominal import nominal
from stations import experiment_page, running, seat_page, stationed, take_seat, viewed

AXE = Path(os.environ.get("AXE_CORE", "node_modules/axe-core/axe.min.js"))
pytestmark = [
    pytest.mark.browser,
    pytest.mark.slow,
    pytest.mark.skipif(not AXE.is_file(), reason="no axe-core: npm install axe-core"),
]
FOUND = """
    axe.run(document, {runOnly: [
        'wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice']})
    .then(({passes, violations}) => [passes.length, violations
        .filter(({impact}) => ['serious', 'critical'].includes(impact))
        .map(({id, nodes}) => [id, nodes.map((node) => node.html.slice(0, 200))])])
"""

SHOW_TLX = """
    Promise.all([fetch('api/run'), import(new URL('page/questionnaire.js', location))])
    .then(async ([answer, { Questionnaire }]) => new Questionnaire(
        document.getElementById('tlx-items'), (await answer.json()).nasa_tlx))
"""


def serious(page: Page) -> Any:
    """Return what axe-core finds serious or critical on a page, light and dark."""
    found = []
    for theme in ("light", "dark"):
        features = [{"name": "prefers-color-scheme", "value": theme}]
        page.call("Emulation.setEmulatedMedia", features=features)
        page.evaluate(AXE.read_text("utf-8"))
        passed, violations = page.evaluate(FOUND)
        assert passed > 10
        found += violations
    return found


def opened(page: Page, url: str) -> Page:
    page.open(url, width=1280, height=720)
    page.wait_for("document.body.dataset.ready")
    return page


def test_the_first_page(page: Page, recorded_run: Path, tmp_path: Path) -> None:
    shutil.copytree(recorded_run, tmp_path / "runs" / "one")
    with stationed(tmp_path / "runs") as (_, client):
        assert serious(opened(page, str(client.base_url))) == []


def test_the_debrief(page: Page, spoken_run: Path) -> None:
    with viewed(spoken_run) as url:
        opened(page, url)
        page.evaluate("document.querySelector('#advisories button').click()")
        assert serious(page) == []


def test_two_runs_side_by_side(page: Page, spoken_run: Path, airport_run: Path) -> None:
    with viewed(spoken_run, airport_run) as url:
        assert serious(opened(page, url)) == []


@pytest.mark.parametrize("seat", ["AAL123", "tower"])
def test_the_seats(page: Page, encounter_file: Path, tmp_path: Path, seat: str) -> None:
    with running(encounter_file, tmp_path / "run", "--seat", seat) as (_, url):
        seated(page, url)
        page.wait_for("!document.getElementById('own-advisories').hidden")
        assert serious(page) == []


def test_the_seat_of_a_driver(page: Page, tmp_path: Path) -> None:
    short = nominal("s01b_nominal").model_copy(update={"cameras": ()})
    file = tmp_path / "driver.json"
    file.write_text(short.model_dump_json())
    with running(file, tmp_path / "run", "--seat", "OPS1") as (_, url):
        seated(page, url)
        page.wait_for("document.querySelector('#panel-actions button')")
        assert serious(page) == []


@pytest.mark.parametrize("dialog", ["help", "tlx-dialog"])
def test_the_dialogs(page: Page, dialog: str) -> None:
    with seat_page() as (_, url):
        opened(page, url)
        page.evaluate(SHOW_TLX)
        page.evaluate(f"document.getElementById('{dialog}').showModal()")
        assert serious(page) == []


@pytest.mark.parametrize("done", [0, 1], ids=["ready", "questions"])
def test_an_experiment(page: Page, recorded_run: Path, tmp_path: Path, done: int) -> None:
    plan = {"participants": ["P01"], "seat": "AAL123", "scenarios": ["s02a_headon"]}
    file, out = tmp_path / "plan.json", tmp_path / "out"
    file.write_text(json.dumps(plan))
    for number in range(1, done + 1):
        shutil.copytree(recorded_run, out / "P01" / f"{number:02d}-s02a_headon-{number}")
    with experiment_page(file, out) as url:
        opened(page, url)
        page.wait_for("document.getElementById('step').textContent")
        assert serious(page) == []


def seated(page: Page, url: str) -> None:
    page.open(url, width=1280, height=720)
    page.wait_for("document.getElementById('state').textContent.startsWith('running')")
    take_seat(page)
    page.wait_for("document.body.dataset.seat")
