"""The page of a debrief in a real browser."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from airhilt.errors import RendererError
from airhilt.record import open_run
from airhilt.station import redrawing
from airhilt.station.app import debrief_app
from airhilt.station.debrief import Debrief
from camera_run import camera_run
from devtools import Page
from stations import serving, viewed

pytestmark = pytest.mark.browser
LOW_CONTRAST = Path(__file__).with_name("contrast.js").read_text()
TEXT = "document.getElementById({!r}).textContent"


@pytest.fixture(scope="module")
def spoken_url(spoken_run: Path) -> Iterator[str]:
    with viewed(spoken_run) as url:
        yield url


@pytest.fixture(scope="module")
def airport_url(airport_run: Path) -> Iterator[str]:
    with viewed(airport_run) as url:
        yield url


@pytest.fixture(scope="module")
def filmed_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    with pytest.MonkeyPatch.context() as patch:
        return camera_run(tmp_path_factory.mktemp("filmed") / "run", patch).folder


def opened(page: Page, url: str, **how: Any) -> Page:
    page.open(url, **how)
    page.wait_for("document.body.dataset.ready")
    return page


def time_shown(page: Page) -> float:
    return float(page.evaluate("document.getElementById('slider').value"))


def set_time(page: Page, t: float) -> None:
    page.evaluate(
        f"(() => {{ const slider = document.getElementById('slider'); slider.value = {t};"
        "slider.dispatchEvent(new Event('input')); })()"
    )


DRAWN_LINES = """(() => {
    const stroke = CanvasRenderingContext2D.prototype.stroke;
    window.drawn = [];
    CanvasRenderingContext2D.prototype.stroke = function (...given) {
        window.drawn.push([this.strokeStyle, this.getLineDash().length > 0]);
        return stroke.apply(this, given);
    };
})()"""
"""Notes the colour of each line on the plan, and if it is dashed."""
INK = """import(new URL('page/dom.js', location)).then(({{ colour }}) => {{
    const pen = document.createElement('canvas').getContext('2d');
    pen.strokeStyle = colour({!r});
    return pen.strokeStyle;
}})"""
"""A colour of the page, as a canvas names it."""


def test_a_picture_that_was_kept_has_its_boxes_and_the_plan_its_bearings(
    page: Page, filmed_run: Path
) -> None:
    """Whatever can be drawn again on this machine."""
    kept = next((filmed_run / "pictures").glob("first_detection-*.png"))
    camera, seq = kept.stem.removeprefix("first_detection-").rsplit("-", 1)
    with viewed(filmed_run) as url:
        opened(page, url)
        record = page.evaluate(f"fetch('api/cameras/{camera}').then((answer) => answer.json())")
        i = record["seq"].index(int(seq))
        boxes = record["found"][i]["boxes"]
        assert boxes
        page.evaluate(f"document.getElementById('camera').value = {camera!r}")
        page.evaluate("document.getElementById('camera').dispatchEvent(new Event('change'))")
        set_time(page, record["t"][i])
        page.wait_for("document.getElementById('camera-caption').textContent.includes('as it was')")
        drawn = page.evaluate(
            "[...document.querySelectorAll('#camera-boxes text')].map((one) => one.textContent)"
        )
        assert drawn == [f"{one['label']} {one['confidence']:.2f}" for one in boxes]
        page.evaluate(DRAWN_LINES)
        set_time(page, record["t"][i] + 0.01)
        page.wait_for("window.drawn.length > 0")
        lines = page.evaluate("window.drawn")
        inks = {name: page.evaluate(INK.format(name)) for name in ("--accent", "--warn")}
        after = lines[lines.index([inks["--accent"], True]) + 1 :]  # After the field of view.
        assert after[: len(boxes) + 1].count([inks["--warn"], False]) == len(boxes)


def test_where_nothing_can_be_drawn_the_pictures_that_were_kept_are_shown(
    page: Page, filmed_run: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise RendererError("no renderer here")

    monkeypatch.setattr(redrawing._Scene, "__init__", fail)
    shown = f"{TEXT.format('camera-none')} + '|' + {TEXT.format('camera-caption')}"
    none = "no renderer here|"
    debrief = Debrief(open_run(filmed_run))
    record = debrief.camera("nose-AAL123")
    times = dict(zip(record["seq"], record["t"], strict=True))
    first, last = min(record["kept"]), max(record["kept"])
    drawn = next(seq for seq in record["seq"] if seq not in record["kept"])
    with serving(debrief_app(debrief)) as url:
        opened(page, url)
        for seq in (drawn, last, drawn, first):
            set_time(page, times[seq])
            is_kept = seq in record["kept"]
            told = f"includes('Picture {seq} at')" if is_kept else f"startsWith({none!r})"
            page.wait_for(f"({shown}).{told}")
            assert page.evaluate("document.getElementById('camera-image').hidden") is not is_kept
        assert page.evaluate(TEXT.format("camera-caption")).count("as it was") == 1
    page.complaints.clear()  # Of pictures that cannot be drawn.


def test_it_opens_at_the_beginning_with_all_traffic(page: Page, spoken_url: str) -> None:
    opened(page, spoken_url, width=1280, height=720)
    label = page.evaluate("document.getElementById('plan').getAttribute('aria-label')")
    assert "AAL123" in label
    assert "DAL456" in label
    assert time_shown(page) == 0.0
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert page.evaluate("document.documentElement.scrollHeight <= innerHeight")


def test_it_plays_at_the_chosen_speed_and_stops_at_the_end(page: Page, spoken_url: str) -> None:
    opened(page, spoken_url)
    for _ in range(3):
        page.press(">", 190)
    assert page.evaluate("document.getElementById('rate').value") == "8"
    set_time(page, 20.0)
    page.press(" ", 32)
    assert page.evaluate(TEXT.format("play-word")) == "Pause"
    page.wait_for("document.getElementById('play-word').textContent === 'Play'")
    assert time_shown(page) == pytest.approx(float(page.evaluate("slider.max")), abs=0.11)


def test_it_stays_within_the_loop(page: Page, spoken_url: str) -> None:
    opened(page, spoken_url)
    set_time(page, 2.0)
    page.press("[", 219)
    set_time(page, 3.0)
    page.press("]", 221)
    for _ in range(3):
        page.press(">", 190)
    page.press(" ", 32)
    page.evaluate("new Promise((done) => setTimeout(done, 700))")
    assert page.evaluate(TEXT.format("play-word")) == "Pause"
    assert 1.9 <= time_shown(page) <= 3.1
    page.press(" ", 32)


def test_keys_jump_from_event_to_event(page: Page, spoken_url: str) -> None:
    opened(page, spoken_url)
    page.press(".", 190)
    first = time_shown(page)
    page.press(".", 190)
    second = time_shown(page)
    assert 0.0 < first < second
    page.press(",", 188)
    assert time_shown(page) == first


def test_the_call_on_the_air_and_the_active_advisory_are_marked(
    page: Page, spoken_url: str
) -> None:
    opened(page, spoken_url)
    current = "document.querySelector('#{} [aria-current]')?.textContent ?? ''"
    page.evaluate("document.querySelector('#calls button').click()")
    assert "AAL123" in page.evaluate(current.format("calls"))
    page.evaluate("document.querySelector('#advisories button').click()")
    marked = page.evaluate(current.format("advisories"))
    assert "Traffic DAL456" in marked
    assert "Rests on" in marked


def test_the_sound_of_a_frequency_can_be_played_from_any_time(page: Page, spoken_url: str) -> None:
    opened(page, spoken_url)
    names = page.evaluate(
        "[...document.querySelectorAll('#sounds label')].map((one) => one.textContent)"
    )
    assert any("MHz" in name for name in names)
    assert "Assistant" in names
    duration = page.evaluate(
        "fetch('api/run').then((answer) => answer.json()).then((run) => new Promise((done) => {"
        "const sound = new Audio(`api/sounds/${run.sounds[0]}.wav`);"
        "sound.onseeked = () => done(sound.currentTime); sound.onloadedmetadata = () => {"
        "sound.currentTime = 3; }; sound.onerror = () => done(-1); }))"
    )
    assert duration == 3


def test_an_airport_and_vehicles_are_shown(page: Page, airport_url: str) -> None:
    opened(page, airport_url, dark=True)
    names = "[...document.querySelectorAll('#traffic tbody th')].map((one) => one.textContent)"
    assert sorted(page.evaluate(names)) == ["AAL123", "OPS1", "OPS2"]
    assert "ground" in page.evaluate("document.querySelector('#traffic tbody').textContent")
    assert page.evaluate(
        "[...document.querySelectorAll('#plan-view option')].some((one) => one.value === 'airport')"
    )
    assert page.evaluate(TEXT.format("camera-none")) == "This run has no pictures."
    assert page.evaluate(TEXT.format("sounds")) == "no sound"


def test_every_control_has_a_name_and_can_be_reached(page: Page, spoken_url: str) -> None:
    opened(page, spoken_url)
    nameless = page.evaluate(
        "[...document.querySelectorAll('button, select, input, canvas:not([aria-hidden])')]"
        ".filter((one) => !one.getAttribute('aria-label') && !one.labels?.length"
        " && !(one.tagName === 'BUTTON' && one.textContent.trim())).map((one) => one.outerHTML)"
    )
    assert nameless == []


def test_contrast_of_all_text_is_enough(page: Page, spoken_url: str) -> None:
    """WCAG 2.1, 1.4.3: at least 4.5 to 1."""
    for dark in (False, True):
        opened(page, spoken_url, dark=dark)
        page.evaluate("document.querySelector('#advisories button').click()")
        assert page.evaluate(LOW_CONTRAST) == []


def test_two_runs_follow_one_clock(page: Page, spoken_run: Path, airport_run: Path) -> None:
    shown = "[...document.querySelectorAll('iframe')].map((one) => one.contentDocument)"
    with viewed(spoken_run, airport_run) as url:
        opened(page, url, width=1280, height=720)
        titles = page.evaluate(f"{shown}.map((one) => one.getElementById('traffic').textContent)")
        assert "DAL456" in titles[0]
        assert "OPS1" in titles[1]
        set_time(page, 4.0)
        times = f"{shown}.map((one) => Number(one.getElementById('slider').value))"
        assert page.evaluate(times) == [4.0, 4.0]
        set_time(page, 20.0)
        assert page.evaluate(times) == [20.0, pytest.approx(6.0, abs=0.2)]
        page.evaluate(f"{shown}[0].querySelector('#calls button').click()")
        assert time_shown(page) < 20.0
        assert page.evaluate("document.documentElement.scrollHeight <= innerHeight")
