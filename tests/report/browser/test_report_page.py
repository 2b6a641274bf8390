"""The report of a run, as a browser shows it."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import pytest
from pydantic import TypeAdapter

from airhilt.commands import Command
from airhilt.cosim.simulation import run
from airhilt.messages import Recommendation
from airhilt.options import Options
from airhilt.record import RunFolder
from airhilt.report import write_report
from airhilt.scenario import Scenario
from breadth import mostly_slow
from devtools import Page
from engine_package import installed
from nominal import nominal
from radio_folder import busy_radio

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def folder(encounter: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("report") / "run"
    return run(encounter, Options(latency="fixed", out=out)).folder


@pytest.fixture(scope="module")
def report(folder: Path) -> Path:
    return write_report(folder)


@pytest.fixture(scope="module")
def incursion(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of a landing on which a vehicle drives in the way, with nobody to warn."""
    out = tmp_path_factory.mktemp("incursion") / "run"
    scenario = nominal("s01b_delayed_hold")
    run(scenario, Options(latency="fixed", assistant="none", out=out))
    return write_report(out)


@pytest.fixture(scope="module")
def radio(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of a run on whose radio everything happens."""
    return write_report(busy_radio(tmp_path_factory.mktemp("radio") / "run"))


def pressed(page: Page) -> Any:
    return page.evaluate("document.querySelector('#views [aria-pressed=true]').textContent")


def texts(page: Page, chart: str) -> Any:
    return page.evaluate(
        f"[...document.querySelectorAll('#{chart} svg text')].map((text) => text.textContent)"
    )


def cursors(page: Page) -> Any:
    return page.evaluate(
        "[...document.querySelectorAll('.cursor')].map((c) => +c.getAttribute('x1'))"
    )


def test_all_charts_are_drawn(page: Page, report: Path) -> None:
    page.open(report)
    for chart, least in (("plan", 2), ("profile", 2), ("separation", 2)):
        assert page.evaluate(f"document.querySelectorAll('#{chart} svg path.line').length") == least
    assert page.evaluate("document.querySelectorAll('#histogram svg rect').length") >= 2
    assert page.evaluate("document.querySelectorAll('#tiles .tile').length") == 9
    assert page.evaluate("document.querySelectorAll('#timeline tr').length") > 5


def test_the_parts_of_the_time_to_first_warning_are_drawn(page: Page, report: Path) -> None:
    page.open(report)
    assert page.evaluate("document.querySelectorAll('#warning-bar rect.part').length") == 5
    assert page.evaluate("document.querySelectorAll('#warning-parts .swatch').length") == 5
    rows = page.evaluate("document.querySelectorAll('#warning-parts tbody tr').length")
    assert rows == 6  # The parts and their sum; no call begins this conflict.
    begins = page.evaluate("document.getElementById('warning-begins').textContent")
    assert begins.startswith("begins with predicted loss of separation: AAL123, DAL456, at 0")


def test_the_slider_moves_all_charts(page: Page, report: Path) -> None:
    page.open(report)
    before = cursors(page)
    aircraft = "document.querySelector('#plan g g').innerHTML"
    was = page.evaluate(aircraft)
    page.evaluate("document.getElementById('slider').focus()")
    for _ in range(4):
        page.press("ArrowRight", 39)
    after = cursors(page)
    assert len(after) == 3
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
    last = float(page.evaluate("document.querySelector('#timeline tbody tr:last-child').dataset.t"))
    assert page.evaluate("clock.t") == pytest.approx(last)


def test_a_filter_hides_the_rows_of_its_kind(page: Page, report: Path) -> None:
    page.open(report)
    visible = "[...document.querySelectorAll('#timeline tr')].filter((row) => !row.hidden).length"
    before = page.evaluate(visible)
    page.evaluate("document.querySelector('#filters [aria-pressed=true]').click()")
    assert page.evaluate(visible) < before


@pytest.mark.parametrize("dark", mostly_slow([False, True], False))
@pytest.mark.parametrize("width", mostly_slow([360, 768, 1600], 360))
@pytest.mark.parametrize("which", ["report", "incursion", "radio"])
def test_the_page_fits_its_window(
    page: Page, request: pytest.FixtureRequest, which: str, width: int, dark: bool
) -> None:
    page.open(request.getfixturevalue(which), width=width, dark=dark)
    assert page.evaluate("document.scrollingElement.scrollWidth") <= width


# --- at an airport --------------------------------------------------------------------------


def test_en_route_there_is_no_airport_no_runway_and_one_view(page: Page, report: Path) -> None:
    page.open(report)
    assert page.evaluate("document.querySelectorAll('#views button').length") == 0
    assert page.evaluate("document.querySelectorAll('#plan .runway').length") == 0
    assert page.evaluate("document.getElementById('runways-figure').hidden")
    assert page.evaluate("document.getElementById('phases-figure').hidden")


def test_the_airport_lies_under_the_traffic(page: Page, incursion: Path) -> None:
    page.open(incursion)
    for part, least in (("runway", 3), ("protected", 3), ("taxiway", 20), ("hold", 10)):
        assert page.evaluate(f"document.querySelectorAll('#plan .{part}').length") >= least
    assert page.evaluate("document.querySelectorAll('#plan .body').length") == 3


def test_the_plan_begins_at_the_conflict_and_keys_change_the_view(
    page: Page, incursion: Path
) -> None:
    page.open(incursion)
    assert pressed(page) == "Conflict"
    assert "East (m)" in texts(page, "plan")
    page.evaluate("document.querySelector('#views button').focus()")
    page.call("Input.dispatchKeyEvent", type="keyDown", key="Enter", text="\r")
    assert pressed(page) == "All traffic"
    assert "East (NM)" in texts(page, "plan")
    assert "1 NM" in texts(page, "plan")
    page.open(incursion)
    assert pressed(page) == "Conflict"


def test_the_airport_as_a_whole_has_its_runways_named(page: Page, incursion: Path) -> None:
    page.open(incursion)
    page.evaluate("document.querySelectorAll('#views button')[1].click()")
    assert pressed(page) == "Airport"
    assert {"01", "19", "04", "22", "15", "33"} <= set(texts(page, "plan"))
    assert any(re.fullmatch(r"\d+ m", text) for text in texts(page, "plan"))


def test_who_is_out_of_view_is_pointed_to(page: Page, incursion: Path) -> None:
    page.open(incursion)
    page.evaluate("clock.set(0)")
    assert any(re.fullmatch(r"AAL123, [\d.,]+ k?m off", text) for text in texts(page, "plan"))
    page.evaluate("clock.set(endS)")
    assert not any("off" in text for text in texts(page, "plan"))


def test_runway_timelines_show_occupants_the_approach_and_the_incursion(
    page: Page, incursion: Path
) -> None:
    page.open(incursion)
    assert page.evaluate("document.querySelectorAll('#runways .occupied').length") >= 2
    assert page.evaluate("document.querySelectorAll('#runways .approach').length") == 1
    assert page.evaluate("document.querySelectorAll('#runways .threshold').length") == 1
    (badge,) = page.evaluate(
        "[...document.querySelectorAll('#runways .incursion')].map((mark) => mark.textContent)"
    )
    assert badge == "!"
    assert page.evaluate("document.querySelectorAll('#runways .window').length") == 1


def test_each_actor_has_a_timeline_of_its_phases(page: Page, incursion: Path) -> None:
    page.open(incursion)
    phases = page.evaluate("run.tracks.flatMap((track) => track.phases).length")
    assert page.evaluate("document.querySelectorAll('#phases .phase').length") == phases
    assert {"glide", "flare", "driving", "standing"} <= set(texts(page, "phases"))


def test_separation_on_a_runway_is_in_metres_without_a_minimum(page: Page, incursion: Path) -> None:
    page.open(incursion)
    assert {"Horizontal (m)", "Vertical (ft)", "1,000"} <= set(texts(page, "separation"))
    assert page.evaluate("document.querySelectorAll('#separation .minimum').length") == 0
    assert page.evaluate("document.querySelectorAll('#plan .ring').length") == 0


def test_tiles_say_how_severe_the_incursion_was_and_what_had_failed(
    page: Page, incursion: Path
) -> None:
    page.open(incursion)
    tiles = page.evaluate("document.getElementById('tiles').textContent")
    for text in ("accident", "OPS1 on 01/19, in the way of AAL123", "it comes 32 s late"):
        assert text in tiles
    assert "TCAS" not in tiles
    assert "AAL123 and OPS1 touched" in page.evaluate(
        "document.getElementById('outcome').textContent"
    )


def test_what_the_run_costs_people_is_told(page: Page, incursion: Path) -> None:
    page.open(incursion)
    costs = page.evaluate("document.getElementById('costs').textContent")
    for text in (
        "0 go-arounds",
        "0 rejected take-offs",
        "ft s",
        "NM s",
        "an hour",
        "transmissions",
    ):
        assert text in costs


def test_an_incursion_without_a_summary_is_told_without_a_category(
    page: Page, incursion: Path, tmp_path: Path
) -> None:
    copy = shutil.copytree(incursion.parent, tmp_path / "run")
    (copy / "summary.json").unlink()
    log = copy / "log.mcap"
    log.write_bytes(log.read_bytes()[: int(log.stat().st_size * 0.8)])
    page.open(write_report(copy))
    assert "How severe it was is not known" in page.evaluate(
        "document.getElementById('outcome').textContent"
    )
    assert page.evaluate("document.querySelectorAll('#runways .incursion').length") == 1


@pytest.mark.parametrize("actions", [Command, Recommendation], ids=["command", "recommendation"])
def test_every_action_is_put_in_words(page: Page, incursion: Path, actions: Any) -> None:
    page.open(incursion)
    schema = TypeAdapter(actions).json_schema()
    assert len(schema["discriminator"]["mapping"]) >= 7
    examples = {
        "altitude_ft": 3000, "track_deg": 5, "degrees": -30, "cas_kt": 210, "route": 2,
        "runway": "01", "climb_to_ft": 3000, "to": {"type": "node", "node": "J/A"},
        "gait": "walk", "callsign": "AAL123", "slot": "hold_short", "sense": "climb",
    }  # fmt: skip
    for action, reference in schema["discriminator"]["mapping"].items():
        fields = schema["$defs"][reference.rsplit("/", 1)[1]]["properties"]
        command = {"action": action} | {k: v for k, v in examples.items() if k in fields}
        said = page.evaluate(f"instruction({json.dumps(command)})")
        assert not re.search(r"[{}_]|undefined|null|NaN", said), said
    for action, said in (
        ({"action": "go_around", "runway": "01"}, "go around from runway 01"),
        ({"action": "cancel_takeoff", "runway": "01"}, "cancel the takeoff on runway 01"),
        ({"action": "hold_position", "runway": "01"}, "hold position short of runway 01"),
        ({"action": "confirm", "callsign": "AAL1", "slot": "runway"}, "confirm the runway of AAL1"),
        ({"action": "of_a_later_version", "callsign": "AAL1"}, "of a later version"),
    ):
        assert page.evaluate(f"instruction({json.dumps(action)})") == said


def test_commands_stand_in_the_timeline_in_words(page: Page, incursion: Path) -> None:
    page.open(incursion)
    rows = page.evaluate("document.getElementById('timeline').textContent")
    assert "land on runway 01" in rows
    assert "drive to 01/19 at D at 14 kt" in rows


def test_every_position_is_put_in_words(page: Page, incursion: Path) -> None:
    page.open(incursion)
    for position, said in (
        ({"type": "node", "node": "J/A"}, "J/A"),
        (
            {"type": "hold_short", "runway": "01", "taxiway": "J"},
            "the hold short of runway 01 on J",
        ),
        (
            {"type": "runway", "runway": "01", "along_m": -900, "offset_m": 20},
            "900 m before the threshold of runway 01, 20 m right of its centre line",
        ),
        ({"type": "geodetic", "lat_deg": 38.5, "lon_deg": -77}, "38.5000° N, 77.0000° W"),
        (
            {"type": "from_centre", "bearing_deg": 0, "distance_nm": 3},
            "3.00 NM from the centre, bearing 360°",
        ),
    ):
        assert page.evaluate(f"place({json.dumps(position)})") == said


def test_hostile_names_at_an_airport_stay_text(page: Page, incursion: Path, tmp_path: Path) -> None:
    hostile = "<img src=x onerror='document.title=1'><b id=planted>"
    html = incursion.read_text()
    escaped = json.dumps(hostile)[1:-1].replace("<", "\\u003c").replace(">", "\\u003e")
    for name in ("follow_me", "glide", "01/19", "AAL123", "Ops one"):
        assert name in html
        html = html.replace(name, escaped)
    planted = tmp_path / "page.html"
    planted.write_text(html)
    page.open(planted)
    assert page.evaluate("document.getElementById('planted')") is None
    assert page.evaluate("document.title") != "1"
    assert any(hostile in text for text in texts(page, "phases"))


# --- the radar ------------------------------------------------------------------------------


def test_a_run_without_radars_has_no_such_section(page: Page, report: Path) -> None:
    page.open(report)
    assert page.evaluate("document.getElementById('radar').hidden")


@pytest.mark.parametrize("width", mostly_slow([390, 1280], 390))
def test_plots_are_drawn_with_rings_and_the_last_turn_has_its_codes(
    page: Page, encounter: Scenario, tmp_path: Path, width: int
) -> None:
    options = Options(
        latency="fixed", speech=False, radar="terminal", cockpit=True, out=tmp_path / "run"
    )
    run(encounter, options)
    page.open(tmp_path / "run" / "report.html", width=width)
    plots = page.evaluate("run.sections.radar[0].plots.length")
    assert page.evaluate("document.querySelectorAll('#radar-0 .plot.past').length") == plots
    assert page.evaluate("document.querySelectorAll('#radar-0 .range-ring').length") >= 2
    page.evaluate("clock.set(20)")
    assert any(re.fullmatch(r"[0-7]{4} A3[45]\d", text) for text in texts(page, "radar-0"))
    assert "one turn in 4.8 s" in page.evaluate("document.getElementById('radars').textContent")
    assert page.evaluate("document.querySelectorAll('#radars tbody tr').length") == 2
    assert page.evaluate("document.querySelectorAll('#instruments tbody tr').length") == 2
    assert "en route" in page.evaluate("document.getElementById('instruments').textContent")
    assert page.evaluate("document.scrollingElement.scrollWidth") <= width


# --- the radio ------------------------------------------------------------------------------


def cells(page: Page, table: str, column: str) -> Any:
    return page.evaluate(
        f"[...document.querySelectorAll('#{table} td[data-label=\"{column}\"]')]"
        ".map((cell) => cell.textContent.trim())"
    )


def test_calls_are_shown_with_what_was_recognised_and_who_understood(
    page: Page, radio: Path
) -> None:
    page.open(radio)
    assert [text.split("to ")[0] for text in cells(page, "calls", "From")] == [
        "Tower", "AAL123", "DAL456", "Tower", "Tower"
    ]  # fmt: skip
    assert page.evaluate(
        "[...document.querySelectorAll('#calls del')].map((word) => word.textContent)"
    ) == ["two", "roger"]
    assert page.evaluate(
        "[...document.querySelectorAll('#calls ins')].map((word) => word.textContent)"
    ) == ["now", "rogers"]
    assert cells(page, "calls", "Recognised")[2] == "no words"
    assert cells(page, "calls", "After end")[0] == "250 ms"
    assert "took it for something else" in cells(page, "calls", "Heard")[0]
    assert "blocked" in cells(page, "calls", "Said")[3]
    assert "not received" in cells(page, "calls", "Said")[4]
    assert cells(page, "spoken", "Said") == ["AAL123 go around"]


def test_a_call_can_be_played(page: Page, radio: Path) -> None:
    page.open(radio)
    assert page.evaluate("document.querySelectorAll('#calls audio').length") == 4
    assert page.evaluate("document.querySelectorAll('#spoken audio').length") == 1
    assert page.evaluate("document.querySelector('audio').preload") == "none"
    length_s = page.evaluate("""new Promise((done) => {
      const player = document.querySelector("audio");
      player.addEventListener("loadedmetadata", () => done(player.duration));
      player.addEventListener("error", () => done(player.error.message));
      player.load();
      player.preload = "auto";
    })""")
    assert length_s == pytest.approx(3.0)


def test_playing_the_time_plays_the_calls_along(page: Page, radio: Path) -> None:
    page.open(radio)
    first = "document.querySelector('#calls audio')"
    begin = float(page.evaluate(f"{first}.dataset.from"))
    page.evaluate("speed.value = '1'; speed.dispatchEvent(new Event('change'))")
    page.evaluate(f"clock.set({begin + 0.5})")
    page.click("play")
    page.wait_for(f"{first}.currentTime > 0.6 && !{first}.paused")
    page.click("play")
    assert page.evaluate(f"{first}.paused")
    page.evaluate("document.getElementById('sound').click()")
    page.evaluate(f"clock.set({begin})")
    page.click("play")
    page.wait_for(f"clock.t > {begin + 0.3}")
    assert page.evaluate(f"{first}.paused")
    page.click("play")


def test_a_row_of_the_radio_shows_its_time_and_playing_it_does_not(page: Page, radio: Path) -> None:
    page.open(radio)
    page.evaluate("document.querySelector('#calls tbody tr:nth-child(2)').click()")
    assert page.evaluate("clock.t") == pytest.approx(5.0)
    assert page.evaluate("document.querySelector('#calls tr.current').rowIndex") == 2
    page.evaluate("document.querySelector('#calls audio').click()")
    assert page.evaluate("clock.t") == pytest.approx(5.0)


def test_timelines_show_who_is_on_the_air_and_what_was_blocked(page: Page, radio: Path) -> None:
    page.open(radio)
    assert page.evaluate("document.querySelectorAll('#transmissions .transmission').length") == 6
    assert page.evaluate("document.querySelectorAll('#transmissions .blocked').length") == 2
    assert {"119.100 MHz", "Tower", "AAL123", "DAL456", "assistant", "to ATC"} <= set(
        texts(page, "transmissions")
    )


def test_a_radio_without_calls_is_not_shown(page: Page, radio: Path, tmp_path: Path) -> None:
    copy = shutil.copytree(radio.parent, tmp_path / "run")
    (copy / "log.mcap").unlink()
    page.open(write_report(copy))
    assert page.evaluate("document.getElementById('radio').hidden")
    assert page.evaluate("document.getElementById('transmissions-figure').hidden")


def test_a_section_of_another_package_draws_itself(
    page: Page, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = (
        "from airhilt.report.sections import Section\n"
        'ENGINE = Section("greeting", order=5, module=__file__)\n'
    )
    group = "airhilt.report_sections"
    with installed(tmp_path, monkeypatch, group, "greeting", source) as package:
        (tmp_path / f"{package}.html").write_text('<p id="greeting"></p>')
        (tmp_path / f"{package}.js").write_text(
            'return { fit() { return (t) => { byId("greeting").textContent = seconds(t); }; } };'
        )
        page.open(write_report(busy_radio(tmp_path / "run")))
    page.evaluate("clock.set(2)")
    assert page.evaluate("document.getElementById('greeting').textContent") == "2.0 s"


@pytest.mark.parametrize("dark", [False, True])
def test_text_can_be_read(page: Page, report: Path, dark: bool) -> None:
    page.open(report, dark=dark)
    ratios = page.evaluate("""(() => {
      const pixel = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
      const luminance = (name) => {
        document.body.style.color = `var(${name})`;
        pixel.fillStyle = getComputedStyle(document.body).color;
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


def test_a_section_that_fails_is_named_and_the_others_are_drawn(
    page: Page, report: Path, tmp_path: Path
) -> None:
    broken = tmp_path / "page.html"
    assert "function drawRadio() {" in report.read_text()
    broken.write_text(
        report.read_text().replace("function drawRadio() {", "function drawRadio() { nothing();")
    )
    page.open(broken)
    notes = page.evaluate("document.getElementById('notes').textContent")
    assert "The section radio cannot be drawn: nothing is not defined" in notes
    assert page.evaluate("document.querySelectorAll('#timeline tr').length") > 5
    assert len(page.complaints) == 1
    page.complaints.clear()


@pytest.mark.parametrize("syntax", ["const = 1;", "return { draw() {", "}", "}); }"])
def test_a_script_that_cannot_be_parsed_is_named_and_the_others_are_drawn(
    page: Page, report: Path, tmp_path: Path, syntax: str
) -> None:
    broken = tmp_path / "page.html"
    broken.write_text(
        report.read_text().replace("function drawRadio() {", f"{syntax} function drawRadio() {{")
    )
    page.open(broken)
    notes = page.evaluate("document.getElementById('notes').textContent")
    assert "The section radio cannot be drawn: Uncaught SyntaxError" in notes
    assert page.evaluate("document.querySelectorAll('#timeline tr').length") > 5
    assert len(page.complaints) == 1
    assert "SyntaxError" in page.complaints.pop()


def test_a_script_that_fails_later_leaves_a_note(page: Page, report: Path) -> None:
    page.open(report)
    page.evaluate("new Promise((done) => { setTimeout(() => nothing()); setTimeout(done, 50); })")
    notes = page.evaluate("document.getElementById('notes').textContent")
    assert "A script of this page failed: Uncaught ReferenceError: nothing" in notes
    assert len(page.complaints) == 1
    page.complaints.clear()


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
