"""The displays of a pilot, a driver and a controller of a run that is only pretended."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from airhilt.messages import (
    Severity,
    WorkloadQuestion,
)
from airhilt.report.airport import ReportAirport
from devtools import Page
from seat_pages import (
    CALL,
    CARD,
    CATEGORIES,
    COMMAND,
    INSTRUMENT,
    INSTRUMENTS,
    KIND,
    TRAFFIC,
    advise,
    cockpit,
    commands,
    fly,
    next_command,
    own_seat,
    seated,
)
from stations import (
    ADVISORY,
    PretendedRun,
    seat_page,
)

pytestmark = pytest.mark.browser
LOW_CONTRAST = Path(__file__).with_name("contrast.js").read_text()
BANDS = """(() => {
    const pfd = document.getElementById('pfd'), height = pfd.height - 80;
    const copy = Object.assign(document.createElement('canvas'), { width: 14, height });
    const pen = copy.getContext('2d', { willReadFrequently: true });
    pen.drawImage(pfd, 40 - pfd.width, -30);
    const data = pen.getImageData(0, 0, 14, height).data;
    const seen = { red: [false, false], green: [false, false] };
    for (let i = 0; i < data.length; i += 4) {
        const isBelow = Number(i > data.length / 2), [red, green, blue] = data.slice(i, i + 3);
        if (red > 190 && green < 70 && blue < 60) seen.red[isBelow] = true;
        if (green > 170 && red < 60 && blue < 110) seen.green[isBelow] = true;
    }
    return [...seen.red, ...seen.green];
})()"""
"""Red above and below the middle of the vertical speed indicator, and green above and below it."""


@pytest.mark.parametrize(
    ("seat", "actions"),
    [("TOWER", []), ("OPS1", ["hold_position"])],
)
def test_a_key_of_the_cockpit_does_nothing_at_another_seat(
    page: Page, seat: str, actions: list[str]
) -> None:
    with seated(page, seat) as run:
        for key in "gbsha":
            page.press(key, ord(key.upper()))
            page.evaluate("document.activeElement.blur()")
        assert commands(run, page) == actions


def test_a_crew_is_offered_to_go_around_near_the_airport_and_its_heading_by_the_compass(
    page: Page,
) -> None:
    """An aircraft at Washington flies 270 degrees true, which are 281 magnetic."""
    phrases = "[...document.querySelectorAll('#phrase-list button')].map((one) => one.title).join()"
    with seated(page, "AAL123") as run:
        run.changes.add("briefing", "TOWER", ReportAirport("kdca").as_json(), CATEGORIES)
        for t_s, altitude_ft, text in (
            (1.0, 35_000, "heading two eight zero"),
            (2.0, 2_000, "going around"),
        ):
            assert "going around" not in page.evaluate(phrases)
            place = (t_s, 9_000.0, 0.0, altitude_ft, [-80.0, 0.0], 270.0, False, "")
            run.changes.add("state", "AAL123", "aircraft", "B738", *place)
            run.changes.add("call", CALL)  # The phrases are renewed at once.
            page.wait_for(f"{phrases}.includes('{text}')")


def test_a_seat_has_the_displays_of_its_category_whoever_is_in_the_roster(page: Page) -> None:
    phrases = "document.getElementById('phrase-list').innerText"
    with seated(page, "AAL123", roster={"DAL456": "aircraft"}) as run:
        fly(run)
        run.changes.add("call", CALL)  # The phrases are renewed at once.
        page.wait_for(f"{INSTRUMENT}.startsWith('Primary flight display')")
        page.wait_for(f"{phrases}.includes('Report level')")
        for repeats in (False, True, True):  # A key that is held gives its command once.
            page.key("keyDown", "g", 71, repeats=repeats)
        assert commands(run, page) == ["go_around"]


COLOURS = """['#traffic tbody th', '#advisories .badge'].map((found) =>
    [...document.querySelectorAll(found)].map((one) => getComputedStyle(one).color))"""


def test_a_callsign_has_the_colour_of_the_severity(page: Page) -> None:
    with seat_page(has_seats=False) as (run, url):
        page.open(url)
        fly(run)
        for severity, callsign in (("ADVISORY", "AAL123"), ("WARNING", "DAL456")):
            advise(
                run, "ATC", "Bird strike risk.", id=severity, severity=severity, traffic=[callsign]
            )
            page.wait_for(f"document.querySelector('#traffic .{severity}')")
        callsigns, badges = page.evaluate(COLOURS)
        assert callsigns == badges
        assert len(set(badges)) == 2


def test_a_pilot_is_shown_no_advisory_to_somebody_else(page: Page) -> None:
    listed = "document.getElementById('advisories').innerText"
    with seated(page, "AAL123") as run:
        fly(run)
        page.wait_for(f"{TRAFFIC}.includes('DAL456')")
        advise(run, "ATC", "Both lose separation.")
        advise(run, "AAL123", "Bird strike risk.", severity="CAUTION", traffic=["AAL123"])
        page.wait_for(f"{listed}.includes('Bird strike risk.')")
        assert "Both lose separation." not in page.evaluate(listed)
        assert "WARNING" not in page.evaluate(TRAFFIC)
        advise(run, "AAL123", "Descend now.")
        page.wait_for(f"{listed}.includes('Descend now.') && {TRAFFIC}.includes('WARNING')")


def test_a_pilot_sees_on_the_instruments_what_tcas_advises(page: Page) -> None:
    descend = {
        "action": "altitude", "sense": "descend", "altitude_ft": 34_000.0,
        "vertical_rate_fpm": 1_500.0, "turn_deg": 0.0,
    }  # fmt: skip
    with seated(page, "AAL123") as run:
        fly(run)
        tcas(run, 0, "traffic, traffic", "CAUTION")
        page.wait_for(f"{INSTRUMENT}.includes('TCAS: traffic')")
        assert page.evaluate(BANDS) == [False, False, False, False]
        tcas(run, 1, "descend, descend", "WARNING", descend)
        page.wait_for(f"{INSTRUMENT}.includes('TCAS: descend, fly −2,000 to −1,500 feet')")
        page.wait_for(f"JSON.stringify({BANDS}) === '[true,true,false,true]'")
        assert "WARNING" in page.evaluate(TRAFFIC)
        tcas(run, 2, "clear of conflict", "INFO", active=False)
        page.wait_for(f"{INSTRUMENT}.includes('clear of conflict')")
        page.wait_for(f"JSON.stringify({BANDS}) === '[false,false,false,false]'")


def tcas(
    run: PretendedRun, revision: int, note: str, severity: str, advised: Any = None,
    *, active: bool = True,
) -> None:  # fmt: skip
    """Let TCAS of the own aircraft tell something of the other one."""
    text = {"recipient": "AAL123", "message": note, "recommendation": advised}
    evidence = ADVISORY["evidence"] | {"sources": ["tcas"], "note": note}
    row = {"equipment": "tcas", "id": "t", "revision": revision, "severity": severity}
    row |= {"active": active, "texts": [text], "evidence": evidence}
    run.changes.add("advisory", ADVISORY | row)


def test_a_pilot_may_reject_a_take_off_on_the_roll_and_go_around_elsewhere(page: Page) -> None:
    offered = "[...document.querySelectorAll('#panel-actions button:not([hidden])')][0]"
    with seated(page, "AAL123") as run:
        for mode, button, actions in (
            ("takeoff_roll", "Reject take-off", ["cancel_takeoff"]),
            ("glide", "Go around", ["hold_position", "go_around"]),
        ):
            cockpit(run, INSTRUMENTS | {"mode": mode, "on_ground": mode != "glide"})
            page.wait_for(f"{offered}.textContent === '{button}'")
            page.press("b", 66)
            page.press("g", 71)
            assert commands(run, page) == actions


TAXI = {
    "action": "taxi", "to": {"type": "hold_short", "runway": "01", "taxiway": "D"},
    "via": ["K", "D"], "speed_kt": None, "off_taxiways": False,
}  # fmt: skip
OFFERED = "[...document.querySelectorAll('#offers button')].map((one) => one.textContent)"


def offer(run: PretendedRun, command: dict[str, Any]) -> None:
    run.seats.offer(own_seat(run), "a call", COMMAND.validate_python(command))


def test_what_a_call_has_for_the_seat_is_a_button_that_does_it(page: Page) -> None:
    with seated(page, "OPS1") as run:
        offer(run, TAXI)
        page.wait_for(f"{OFFERED}[0] === 'Drive to the hold short of runway 01 on D via K, D'")
        assert not commands(run, page)
        page.evaluate("document.querySelector('#offers button').click()")
        assert next_command(run).model_dump(mode="json") == TAXI
        page.wait_for("document.getElementById('panel-state').textContent.startsWith('Set: ')")
        run.seats.end_offer("OPS1", COMMAND.validate_python(TAXI))
        page.wait_for(f"{OFFERED}.length === 0")
        offer(run, TAXI)
        page.wait_for(f"{OFFERED}.length === 1")
        page.click("seat-take")  # Who leaves the seat is shown nothing of it.
        page.wait_for(f"{OFFERED}.length === 0")


def test_a_track_that_a_call_has_is_magnetic_as_on_the_instruments(page: Page) -> None:
    with seated(page, "AAL123") as run:
        run.changes.add("briefing", "TOWER", ReportAirport("kdca").as_json(), CATEGORIES)
        offer(run, {"action": "track", "track_deg": 259.3})
        page.wait_for(f"{OFFERED}[0] === 'Turn to track 270\u00b0'")
        page.evaluate("document.querySelector('#offers button').click()")
        assert next_command(run).track_deg == 259.3


def test_a_task_card_stays_where_it_is_while_the_instruments_move(page: Page) -> None:
    with seated(page, "AAL123") as run:
        run.seats.add_task("AAL123", CARD)
        page.wait_for("window.card = document.querySelector('#tasks button')")
        page.evaluate("window.card.focus()")
        cockpit(run, INSTRUMENTS | {"altitude_ft": 34_000})
        page.wait_for("document.getElementById('instruments').textContent.includes('34,000')")
        assert page.evaluate("document.activeElement === window.card")


@pytest.mark.parametrize(("seat", "view"), [("OPS1", "airport"), ("TOWER", "all")])
def test_a_driver_begins_with_the_airport_and_a_controller_with_all_traffic(
    page: Page, seat: str, view: str
) -> None:
    with seated(page, seat) as run:
        run.changes.add("briefing", "TOWER", ReportAirport("kdca").as_json(), CATEGORIES)
        page.wait_for("document.getElementById('plan-view').options[1]?.value === 'airport'")
        assert page.evaluate("document.getElementById('plan-view').value") == view


def test_an_alert_of_the_equipment_sounds_once_while_aircraft_get_their_names(page: Page) -> None:
    counted = """(() => {
        const start = OscillatorNode.prototype.start;
        window.pulses = 0;
        OscillatorNode.prototype.start = function (at) {
            window.pulses += 1;
            start.call(this, at);
        };
    })()"""
    listed = "document.getElementById('advisories').innerText"
    with seated(page, "AAL123") as run:
        page.evaluate(counted)
        tcas(run, 0, "traffic, traffic", "CAUTION")
        page.wait_for("window.pulses === 1")
        for address, name in (("a1b2c3", "UAL789"), ("d4e5f6", "JBU321")):
            run.changes.add("name", address, name)
        advise(run, "AAL123", "Bird strike risk.", severity="CAUTION", traffic=["AAL123"])
        page.wait_for(f"{listed}.includes('Bird strike risk.')")
        assert page.evaluate("window.pulses") == 1
        tcas(run, 1, "traffic, traffic", "CAUTION")
        page.wait_for("window.pulses === 2")


@pytest.mark.parametrize("seat", KIND)
def test_contrast_of_all_text_at_a_seat_is_enough(page: Page, seat: str) -> None:
    """WCAG 2.1, 1.4.3: at least 4.5 to 1, light and dark."""
    with seated(page, seat) as run:
        fly(run)
        for severity in Severity:
            advise(run, seat, f"An advisory of {severity}.", severity=severity)
        run.seats.add_task(seat, CARD)
        run.seats.notify(seat, "Your call was cut after 60 s.")
        run.seats.ask(seat, WorkloadQuestion(number=1, scale="isa", asked_ns=0))
        page.wait_for("document.querySelectorAll('.own-advisory').length === 4")
        page.wait_for("!document.getElementById('isa').hidden")
        for scheme in ("light", "dark"):
            features = [{"name": "prefers-color-scheme", "value": scheme}]
            page.call("Emulation.setEmulatedMedia", features=features)
            assert page.evaluate(LOW_CONTRAST) == [], scheme


SET = """(() => {{
    const field = document.getElementById('panel-{}');
    field.value = '{}';
    field.form.requestSubmit();
}})()"""
"""Sets a value at the mode panel."""


@pytest.mark.parametrize(
    ("has_airport", "unit", "track_deg"), [(True, "mag", 269.3), (False, "true", 280.0)]
)
def test_the_mode_panel_takes_tracks_as_the_instruments_show_them(
    page: Page, has_airport: bool, unit: str, track_deg: float
) -> None:
    with seated(page, "AAL123") as run:
        airport = ReportAirport("kdca").as_json() if has_airport else None
        run.changes.add("briefing", "TOWER", airport, CATEGORIES)
        told = "document.getElementById('panel-state').textContent"
        cockpit(run, INSTRUMENTS)
        page.wait_for("document.getElementById('instruments').textContent.includes('35,000')")
        page.evaluate(SET.format("rate", 1_500))
        assert page.evaluate(told) == "Vertical speed: set another altitude first."
        cockpit(run, INSTRUMENTS | {"selected_altitude_ft": 9_000})
        page.wait_for(f"document.getElementById('panel-track-unit').textContent.includes('{unit}')")
        page.wait_for("document.getElementById('instruments').textContent.includes('9,000')")
        page.evaluate(SET.format("track", 280))
        page.evaluate(SET.format("rate", 2_500))
        track, climb = next_command(run), next_command(run)
        assert track.track_deg == pytest.approx(track_deg)
        assert (climb.altitude_ft, climb.vertical_rate_fpm) == (9_000, 2_500)
        page.wait_for(f"{told}.includes('vertical speed 2500 ft/min, down to 9,000')")


def test_a_controller_sees_what_a_radar_alone_has_found_on_the_plan(page: Page) -> None:
    told = "document.getElementById('plan').ariaLabel"
    with seated(page, "TOWER") as run:
        fly(run)
        plot = {"t": 0.9, "kind": "combined", "north": 0.0, "turn_s": 4.8}
        for east_m, code in ((0.0, "4321"), (9_000.0, "7000")):
            run.changes.add("plot", plot | {"east": east_m, "code": code, "altitude_ft": 4_500})
        echo = {"kind": "primary", "east": 20_000.0, "code": None, "altitude_ft": None}
        run.changes.add("plot", plot | echo)
        run.changes.add("clock", 2.0, "paused", "paused")
        page.wait_for(f"{told}.includes('radar reply 7000 4,500 feet, radar echo')")
        assert "4321" not in page.evaluate(told)  # It is of AAL123.
        run.changes.add("clock", 10.0, "paused", "paused")
        page.wait_for(f"{told}.includes('AAL123') && !{told}.includes('radar')")


def test_a_controller_orders_strips_by_keys(page: Page) -> None:
    names = "[...document.querySelectorAll('.flight-strip')].map((one) => one.dataset.callsign)"
    with seated(page, "TOWER") as run:
        fly(run)
        page.wait_for(f"{names}.join() === 'AAL123,DAL456,OPS1'")
        assert page.evaluate("document.getElementById('pfd').getClientRects().length") == 0
        page.evaluate("document.querySelector('.flight-strip').focus()")
        moved = "new KeyboardEvent('keydown', {key: 'ArrowDown', altKey: true, bubbles: true})"
        page.evaluate(f"document.activeElement.dispatchEvent({moved})")
        assert page.evaluate(f"{names}.join()") == "DAL456,AAL123,OPS1"
        page.press("x", 88)
        assert page.evaluate("document.querySelector('.cocked').dataset.callsign") == "AAL123"
