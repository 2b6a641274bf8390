"""The page of a participant in a real browser."""

from __future__ import annotations

import csv
import json
import shutil
from base64 import b64decode
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from airhilt.host.library import find
from airhilt.record import open_run
from airhilt.station.started_runs import StartedRuns
from devtools import Page
from microphone import page_with_microphone
from seats import contents
from shortened import shortened
from stations import commanded, experiment_page

LOW_CONTRAST = Path(__file__).with_name("contrast.js").read_text()
PLAN: dict[str, Any] = {
    "participants": ["P01"], "seat": "AAL123", "scenarios": ["s02a_headon"],
    "questions": {
        "before": [
            {"type": "choice", "name": "licence", "question": "Which licence have you?",
             "choices": ["none", "private"]},
            {"type": "scale", "name": "rested", "title": "Rest", "question": "How rested are you?",
             "low": "Tired", "high": "Rested", "steps": 5},
        ],
        "after_trial": [
            {"type": "scale", "name": "trust", "question": "How much did you trust it?",
             "low": "Not at all", "high": "Completely", "steps": 101, "first": 0},
        ],
        "end": [
            {"type": "choice", "name": "again", "question": "Once more?", "choices": ["no", "yes"]},
        ],
    },
}  # fmt: skip
ANSWER_ALL = """
    for (const input of document.querySelectorAll('#items [type=range]')) input.click();
    for (const input of document.querySelectorAll('#items [type=radio]:first-of-type')) {
        input.click();
    }
"""
NOTES = "document.getElementById('notes').textContent"
SAID = "document.getElementById('words').value === ''"
SUBMIT = "document.getElementById('questions').requestSubmit()"


@contextmanager
def ended(folder: Path, run: str) -> Iterator[None]:
    """Stop a run of a folder in the end, also where a test fails."""
    try:
        yield
    finally:
        StartedRuns(folder).stop(run)


def heading(page: Page, text: str) -> None:
    page.wait_for(f"document.getElementById('step').textContent === {text!r}")


@pytest.mark.browser
def test_the_page_says_which_answers_cannot_be_read(page: Page, tmp_path: Path) -> None:
    (tmp_path / "plan.json").write_text(json.dumps(PLAN))
    kept = tmp_path / "out" / "P01" / "before.json"
    with experiment_page(tmp_path / "plan.json", tmp_path / "out") as url:
        page.open(url)
        heading(page, "Questions before the first trial")
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text('{"rested": 9}')
        page.wait_for(f"{NOTES}.includes('before.json: rested: found 9')")
        told = page.evaluate(NOTES)
        assert told.endswith("move the file away to ask again. Please tell the experimenter.")
        page.open("about:blank")
    page.complaints.clear()  # A browser complains of each answer that is an error.


@pytest.mark.browser
def test_a_participant_answers_the_questions_of_the_plan(
    page: Page, recorded_run: Path, tmp_path: Path
) -> None:
    file, out = tmp_path / "plan.json", tmp_path / "out"
    file.write_text(json.dumps(PLAN))
    with experiment_page(file, out) as url:
        for dark in (True, False):
            page.open(url, width=1280, height=720, dark=dark)
            heading(page, "Questions before the first trial")
            assert page.evaluate(LOW_CONTRAST) == []
        page.evaluate("document.querySelector('[name=licence][value=private]').click()")
        page.evaluate(SUBMIT)
        assert page.evaluate(NOTES) == "Please answer these as well: “Rest”."
        page.evaluate("document.querySelector('[name=rested][value=\"4\"]').click()")
        page.evaluate(SUBMIT)
        heading(page, "Trial 1 of 1")
        shutil.copytree(recorded_run, out / "P01" / "01-s02a_headon-1")
        heading(page, "Questions after trial 1 of 1")
        assert page.evaluate("document.querySelectorAll('#items input').length") == 6
        page.evaluate(ANSWER_ALL)
        page.evaluate(SUBMIT)
        page.wait_for("document.querySelectorAll('#items input').length === 1")
        page.evaluate(SUBMIT)
        assert "How much did you trust it?" in page.evaluate(NOTES)
        page.evaluate(ANSWER_ALL)
        page.evaluate(SUBMIT)
        heading(page, "Questions at the end")
        page.evaluate(ANSWER_ALL)
        page.evaluate(SUBMIT)
        heading(page, "All trials are done")
    kept = [json.loads(path.read_text()) for path in sorted((out / "P01").glob("*.json"))]
    assert {"licence": "private", "rested": 4} in kept
    assert {"trust": 50} in kept
    assert {"again": "yes"} in kept


CRAMPED = """(() => {
    const pane = document.querySelector('main').getBoundingClientRect(),
        boxes = [...document.querySelectorAll('#items label')]
            .map((label) => [label.textContent.trim(), label.getBoundingClientRect()]);
    return boxes.filter(([, box], i) => box.left < pane.left || box.right > pane.right
        || boxes.some(([, other], j) => j > i && other.left < box.right + 4
            && box.left < other.right + 4 && other.top < box.bottom && box.top < other.bottom))
        .map(([text]) => text);
})()"""
"""Script that returns the answers that touch another one, or lie outside of the page."""


@pytest.mark.browser
@pytest.mark.parametrize("width", [1280, 420])
def test_no_answer_of_a_scale_touches_another_one(page: Page, tmp_path: Path, width: int) -> None:
    scale = {
        "type": "scale", "name": "change", "question": "How much did it change?", "steps": 11,
        "first": -500, "interval": 100, "low": "Much less than in all that I have seen so far",
        "high": "Much more than in all that I have seen so far",
    }  # fmt: skip
    (tmp_path / "plan.json").write_text(json.dumps(PLAN | {"questions": {"before": [scale]}}))
    with experiment_page(tmp_path / "plan.json", tmp_path / "out") as url:
        page.open(url, width=width, height=720)
        heading(page, "Questions before the first trial")
        assert page.evaluate("document.querySelectorAll('#items label').length") == 11
        assert page.evaluate(CRAMPED) == []


SLIDER = "document.querySelector('#items input')"


def places(page: Page) -> int:
    """Return how many different columns of pixels the middle of the first slider has."""
    x, y, width, height = page.evaluate(
        f"(({{x, y, width, height}}) => [x, y, width, height])({SLIDER}.getBoundingClientRect())"
    )
    clip = {"x": x + 0.1 * width, "y": y, "width": 0.8 * width, "height": height, "scale": 1}
    shot = b64decode(page.call("Page.captureScreenshot", clip=clip)["data"])
    pixels = np.asarray(Image.open(BytesIO(shot)).convert("RGB"))
    return len(np.unique(pixels, axis=1)[0])


@pytest.mark.browser
def test_a_slider_shows_no_answer_before_there_is_one(page: Page, tmp_path: Path) -> None:
    asked = {"before": PLAN["questions"]["after_trial"]}
    (tmp_path / "plan.json").write_text(json.dumps(PLAN | {"questions": asked}))
    with experiment_page(tmp_path / "plan.json", tmp_path / "out") as url:
        for dark in (True, False):
            page.open(url, dark=dark)
            heading(page, "Questions before the first trial")
            assert places(page) == 1
            assert page.evaluate(f"{SLIDER}.getAttribute('aria-valuetext')") == "not answered"
        page.evaluate(SUBMIT)
        assert "How much did you trust it?" in page.evaluate(NOTES)
        page.evaluate(f"{SLIDER}.focus()")
        page.press("ArrowRight", 39)
        assert places(page) > 1
        assert page.evaluate(f"{SLIDER}.getAttribute('aria-valuetext')") is None
        page.evaluate(SUBMIT)
        heading(page, "Trial 1 of 1")
    assert json.loads((tmp_path / "out" / "P01" / "before.json").read_text()) == {"trust": 51}


def go(page: Page, url: str, participant: str) -> None:
    """Open the page of a participant of a team, as by its link."""
    page.open(f"{url}#{participant}", width=1280, height=720)
    page.wait_for(f"document.getElementById('title').textContent === 'Experiment, {participant}'")


HELD = """
    window.held = [];
    window.answering = fetch;
    window.fetch = async (path, ...more) => {
        const answer = await answering(path, ...more);
        if (path.includes('P02')) await new Promise((release) => held.push(release));
        return answer;
    };
"""
"""Script that keeps answers of the server to P02 until `held` releases them."""
WRITTEN = """
    window.written = 0;
    const observer = new MutationObserver((records) => { written += records.length; });
    for (const place of document.querySelectorAll('[role=status], [role=alert]'))
        observer.observe(place, { subtree: true, childList: true, characterData: true });
"""
SOME_SECONDS = "new Promise((done) => setTimeout(done, 2500))"
"""Script that lasts until the page has asked again, twice or more."""
TITLE = "document.getElementById('title').textContent"
CHECKED = "document.querySelectorAll('#items :checked').length"
ASKS = "!document.getElementById('questions').hidden"


def team_file(folder: Path) -> Path:
    """Return the file of a plan in which P01 and P02 are a team, and have questions before."""
    team = {"participants": [["P01", "P02"]], "seats": ["tower", "AAL123"], "seat": None}
    file = folder / "plan.json"
    file.write_text(json.dumps(PLAN | team | {"scenarios": ["s01b_nominal"]}))
    return file


def turn_to(page: Page, participant: str) -> None:
    """Look at the page of another participant of the team, in the same tab."""
    page.evaluate(f"location.hash = '#{participant}'")
    page.wait_for(f"{TITLE} === 'Experiment, {participant}' && {ASKS}")


@pytest.mark.slow
@pytest.mark.browser
def test_answers_that_are_chosen_stay_with_their_participant(page: Page, tmp_path: Path) -> None:
    with experiment_page(team_file(tmp_path), tmp_path / "out") as url:
        go(page, url, "P01")
        page.evaluate("document.querySelector('[name=licence][value=private]').click()")
        page.evaluate("document.querySelector('[name=rested][value=\"4\"]').click()")
        turn_to(page, "P02")
        assert page.evaluate(CHECKED) == 0
        page.evaluate(SUBMIT)
        assert page.evaluate(NOTES).startswith("Please answer these as well")
        turn_to(page, "P01")
        assert page.evaluate(NOTES) == ""
        assert page.evaluate(CHECKED) == 2
        page.evaluate(SUBMIT)
        heading(page, "Trial 1 of 1")
        turn_to(page, "P02")
        page.evaluate("location.hash = '#P0X'")
        page.wait_for(f"{NOTES}.includes('P0X')")
        texts = [page.evaluate(f"document.getElementById({name!r}).textContent")
                 for name in ("title", "step", "step-text")]  # fmt: skip
        assert texts == ["Experiment", "", ""]
        assert not page.evaluate(ASKS)
    page.complaints.clear()  # A browser complains of each answer that is an error.
    kept = json.loads((tmp_path / "out" / "P01+P02" / "P01" / "before.json").read_text())
    assert kept == {"licence": "private", "rested": 4}


@pytest.mark.browser
def test_a_slow_answer_is_not_shown_on_the_page_of_another_participant(
    page: Page, tmp_path: Path
) -> None:
    with experiment_page(team_file(tmp_path), tmp_path / "out") as url:
        go(page, url, "P01")
        page.evaluate(HELD)
        page.evaluate("location.hash = '#P02'")
        page.wait_for("held.length")
        assert not page.evaluate(ASKS)
        page.evaluate(f"""window.titles = [];
            new MutationObserver(() => titles.push({TITLE})).observe(
                document.getElementById('title'), {{ childList: true }});
            location.hash = '#P01';
            held.forEach((release) => release())""")
        turn_to(page, "P01")
        assert "Experiment, P02" not in page.evaluate("titles")
        page.open("about:blank")


@pytest.mark.slow
@pytest.mark.browser
def test_a_page_writes_again_only_what_has_changed(page: Page, tmp_path: Path) -> None:
    """A screen reader reads aloud what is written where it listens."""
    (tmp_path / "plan.json").write_text(json.dumps(PLAN))
    with experiment_page(tmp_path / "plan.json", tmp_path / "out") as url:
        page.open(url)
        heading(page, "Questions before the first trial")
        page.evaluate(WRITTEN)
        page.evaluate(SOME_SECONDS)
        assert page.evaluate("written") == 0
        page.evaluate(
            "window.answering = fetch; window.fetch = () => Promise.reject(new TypeError())"
        )
        page.wait_for(f"{NOTES}.startsWith('The experiment does not answer.')")
        page.evaluate("written = 0")
        page.evaluate(SOME_SECONDS)
        assert page.evaluate("written") == 0
        page.evaluate("window.fetch = answering")
        page.wait_for(f"{NOTES} === ''")


@pytest.mark.slow
@pytest.mark.browser
def test_a_controller_and_a_pilot_have_a_trial_together(tmp_path: Path) -> None:
    scenario = json.loads(find("scenarios", "s01b_nominal").read_text())
    (tmp_path / "short.json").write_text(json.dumps(shortened(scenario, 12.0)))
    team = {
        "participants": [["P01", "P02"]], "seats": ["tower", "AAL123"], "seat": None,
        "scenarios": [str(tmp_path / "short.json")], "nasa_tlx": False,
        "options": {"speech": False, "cameras": False, "assistant": "none"},
        "questions": {"after_trial": [PLAN["questions"]["before"][1]]},
    }  # fmt: skip
    file, out = tmp_path / "plan.json", tmp_path / "out"
    file.write_text(json.dumps(PLAN | team))
    folder, run, offered = out / "P01+P02", "01-short-1", "document.getElementById('seat-name')"
    with (
        commanded("experiment", file, "--participant", "P02", "--out", str(out)) as url,
        ended(folder, run),
        page_with_microphone() as tower,
        page_with_microphone() as pilot,
    ):
        tower.open(url, width=1280, height=720)
        heading(tower, "Who are you?")
        assert tower.evaluate(LOW_CONTRAST) == []
        tower.evaluate("document.querySelector('#choices a[href=\"#P01\"]').click()")
        go(pilot, url, "P02")
        heading(tower, "Trial 1 of 1")
        tower.click("begin")
        people = ((tower, "P01", "Washington Tower", "1"), (pilot, "P02", "AAL123", "5"))
        for page, _, seat, _ in people:
            page.wait_for("!document.getElementById('open').hidden")
            page.open(page.evaluate("document.getElementById('open').href"))
            page.wait_for("document.getElementById('state').textContent === 'paused'")
            assert page.evaluate(f"[...{offered}.options].map((one) => one.value)") == [seat]
            use = "none" if page is pilot else "voice"
            page.evaluate(f"document.getElementById('seat-uses').value = '{use}'")
            page.click("seat-take")
            page.wait_for("!document.getElementById('say').hidden")
            is_silent = str(page is pilot).lower()
            page.wait_for(f"document.getElementById('words').disabled === {is_silent}")
        for page, participant, _, answer in people:
            page.wait_for("document.getElementById('state').textContent === 'finished'")
            go(page, url, participant)
            heading(page, "Questions after trial 1 of 1")
            page.evaluate(f"document.querySelector('[value=\"{answer}\"]').click()")
            page.evaluate(SUBMIT)
        for page, *_ in people:
            heading(page, "All trials are done")
    with (out / "experiment.csv").open() as table:
        rows = list(csv.DictReader(table))
    names = ("participant", "seat", "run", "after_trial.rested")
    assert [[row[name] for name in names] for row in rows] == [
        ["P01", "Washington Tower", f"P01+P02/{run}", "1"],
        ["P02", "AAL123", f"P01+P02/{run}", "5"],
    ]
    assert all(0.0 < float(row["person.seat_time_s"]) <= 12.0 for row in rows)
    agreed = [
        (one["subject"], one["text"])
        for one in contents(list(open_run(folder / run).log()), "truth/event")
        if "agree" in one["text"]
    ]
    assert agreed == [
        ("Washington Tower", "agrees to speak and type; the voice is recorded"),
        ("AAL123", "agrees to nothing"),
    ]
