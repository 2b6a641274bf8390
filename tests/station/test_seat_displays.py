"""The page at the seats of a pilot, a driver and a controller of a run that is only pretended."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest
from pydantic import TypeAdapter

from airhilt.commands import Command
from airhilt.messages import (
    FlyCommand,
    PerceiveAdvisory,
    SayText,
    SeatAct,
    Severity,
    TaskCard,
    WorkloadQuestion,
)
from airhilt.report.airport import ReportAirport
from airhilt.station import browsers
from airhilt.station.audiences import Audience
from airhilt.station.browsers import Browsers
from airhilt.station.pictures import Picture
from devtools import Page
from loudspeaker import COUNT_PIECES, PIECES, piece
from microphone import NO_CONNECTION, SAY
from stations import (
    ADVISORY,
    PATIENCE_S,
    TOWER,
    PretendedClient,
    PretendedRun,
    seat_page,
    take_seat,
)

pytestmark = pytest.mark.browser
CATEGORIES = {"AAL123": "aircraft", "DAL456": "aircraft", "OPS1": "vehicle"}
LOW_CONTRAST = Path(__file__).with_name("contrast.js").read_text()
KIND = {"TOWER": "controller", "AAL123": "pilot", "OPS1": "driver"}
KEYS = "[...document.querySelectorAll('#help-keys dd')].map((one) => one.textContent)"


INSTRUMENTS = {
    "callsign": "AAL123", "airspeed_kt": 265.0, "mach": 0.78, "altitude_ft": 35000,
    "vertical_speed_fpm": 0, "north": "true", "heading_deg": 90.0, "track_deg": 90.0,
    "ground_speed_kt": 480.0, "pitch_deg": 2.0, "roll_deg": 0.0, "gear": 0.0, "flaps": 0.0,
    "on_ground": False, "mode": "en_route", "radio_height_ft": None,
    "selected_altitude_ft": 35000, "selected_airspeed_kt": 265,
}  # fmt: skip
COMMAND: TypeAdapter[Command] = TypeAdapter(Command)
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
INSTRUMENT = "document.getElementById('pfd').ariaLabel"
TRAFFIC = "document.getElementById('nd').ariaLabel"


def fly(run: PretendedRun, t_s: float = 1.0) -> None:
    """Let two aircraft fly towards each other, 20 NM apart, and tell the pilot of one of them."""
    for name, east_m, speed_m_s in (("AAL123", 0.0, 240.0), ("DAL456", 37_040.0, -240.0)):
        heading_deg = 90.0 if speed_m_s > 0.0 else 270.0
        place = (t_s, east_m, 0.0, 35_000, [speed_m_s, 0.0], heading_deg, False, "")
        run.changes.add("state", name, "aircraft", "B737", *place)
    cockpit(run, INSTRUMENTS)


def cockpit(run: PretendedRun, shown: dict[str, Any]) -> None:
    """Let the instruments of the seat show something."""
    (own,) = run.views.own.values()
    own.put("cockpit", shown)


def own_seat(run: PretendedRun) -> str:
    (seat,) = run.views.own
    return seat


def next_command(run: PretendedRun) -> Command:
    """Return the next command that is given at a seat."""
    act = run.next()
    assert isinstance(act, FlyCommand)
    return act.command


def advise(run: PretendedRun, recipient: str, message: str, **other: Any) -> None:
    """Give an advisory to somebody."""
    text = {"recipient": recipient, "message": message, "recommendation": None}
    run.changes.add("advisory", ADVISORY | {"id": message, "texts": [text]} | other)


@contextmanager
def seated(
    page: Page,
    seat: str,
    pace: str = "realtime",
    roster: dict[str, str] | None = None,
    **more: Any,
) -> Iterator[PretendedRun]:
    """Open the page of a run, take its seat, of which more may be told, and yield the run."""
    known = {"seat": seat, "category": CATEGORIES.get(seat, "unit")}
    info = TOWER.model_copy(update=known | more)
    with seat_page(PretendedRun([info])) as (run, url):
        run.changes.add("briefing", "TOWER", None, CATEGORIES if roster is None else roster)
        run.changes.add("clock", 1.0, "running", pace)
        page.open(url, width=1280, height=720)
        page.wait_for("document.getElementById('state').textContent.startsWith('running')")
        take_seat(page)
        page.wait_for(f"document.body.dataset.seat === '{KIND[seat]}'")
        page.wait_for("!document.getElementById('talk').hidden")
        page.wait_for("!document.getElementById('words').disabled")
        page.evaluate("document.activeElement.blur()")
        yield run


def commands(run: PretendedRun, page: Page) -> list[str]:
    """Return the actions of the commands that the page has sent so far."""
    page.evaluate("document.getElementById('words').value = 'over'")
    page.evaluate(SAY)
    actions: list[str] = []
    while not isinstance(act := run.next(), SayText):
        assert isinstance(act, FlyCommand)
        actions.append(act.command.action)
    return actions


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


def test_the_list_of_keys_has_those_that_act_at_the_seat(page: Page) -> None:
    with seated(page, "TOWER"):
        page.press("?", 191)
        listed = page.evaluate(KEYS)
        assert "hold to talk" in listed
        assert not {
            "cockpit: go around",
            "brake, hold position, reject take-off",
            "1 s back",
            "sound off or on",
        } & set(listed)
        page.evaluate("document.getElementById('help').close()")
        page.click("seat-take")
        page.wait_for("document.getElementById('talk').hidden")
        page.press("?", 191)
        assert "sound off or on" in page.evaluate(KEYS)


FOCUS = "document.activeElement.id"


def test_the_field_for_a_call_and_the_microphone_are_reached_at_once(page: Page) -> None:
    with seated(page, "TOWER") as run:
        fly(run)
        advise(run, "ATC", "Both lose separation.")
        page.wait_for("!document.getElementById('own-advisories').hidden")
        page.press("c", ord("C"))
        assert page.evaluate(FOCUS) == "words"
        page.evaluate("document.activeElement.blur()")
        page.evaluate("document.getElementById('theme').focus()")
        reached = []
        for _ in range(8):
            page.press("Tab", 9)
            reached.append(page.evaluate(FOCUS))
        assert {"words", "talk-button"} <= set(reached)


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


def test_enter_ticks_a_box_where_the_space_bar_is_to_talk(page: Page) -> None:
    ticked = "document.getElementById('plan-rings').checked"
    with seated(page, "TOWER"):
        page.evaluate("document.getElementById('plan-rings').focus()")
        page.press("Enter", 13)
        assert page.evaluate(ticked) is False
        page.press("Enter", 13)
        assert page.evaluate(ticked) is True


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


CALL = {
    "id": "c-1", "from": 0.2, "to": 0.8, "frequency_khz": 119_100, "snr_db": None,
    "speaker": None, "addressed": None, "said": None, "blocked_by": [], "transcripts": [],
    "hearings": [], "has_sound": False,
}  # fmt: skip
CARD = TaskCard(
    line="l-1", due_ns=0, addressed="TOWER", frequency_khz=119_100, text="American 123."
)


def test_a_task_card_stays_where_it_is_while_the_instruments_move(page: Page) -> None:
    with seated(page, "AAL123") as run:
        run.seats.add_task("AAL123", CARD)
        page.wait_for("window.card = document.querySelector('#tasks button')")
        page.evaluate("window.card.focus()")
        cockpit(run, INSTRUMENTS | {"altitude_ft": 34_000})
        page.wait_for("document.getElementById('instruments').textContent.includes('34,000')")
        assert page.evaluate("document.activeElement === window.card")


def test_a_list_keeps_the_focus_and_open_evidence_when_something_new_comes(page: Page) -> None:
    listed = "document.getElementById('advisories').innerText"
    with seated(page, "TOWER") as run:
        advise(run, "ATC", "Both lose separation.")
        page.wait_for("document.querySelector('#advisories summary')")
        page.evaluate("document.querySelector('#advisories summary').click()")
        run.changes.add("call", CALL)
        page.wait_for("document.querySelector('#calls button')")
        page.evaluate("document.querySelector('#calls button').focus()")
        advise(run, "ATC", "Runway occupied.")
        run.changes.add("call", CALL | {"said": "Tower, hello."})
        page.wait_for(f"{listed}.includes('Runway occupied.')")
        page.wait_for("document.getElementById('calls').innerText.includes('Tower, hello.')")
        assert page.evaluate("document.activeElement.closest('#calls') !== null")
        assert page.evaluate("document.querySelector('#advisories details').open")


def test_the_newest_call_is_still_seen_when_a_warning_takes_room_from_the_list(page: Page) -> None:
    is_seen = """(() => {
        const list = document.getElementById('calls').getBoundingClientRect(),
            row = document.querySelector('#calls > li:last-child').getBoundingClientRect();
        return row.bottom <= list.bottom + 1;
    })()"""
    with seated(page, "TOWER") as run:
        for second in range(20):
            run.changes.add(
                "call", CALL | {"id": f"call-{second}", "from": second, "to": second + 1}
            )
        run.changes.add("clock", 20.0, "running", "realtime", 0.0)
        page.wait_for("document.querySelectorAll('#calls > li').length === 20")
        page.wait_for(is_seen)
        advise(run, "TOWER", "Runway occupied. " * 20)
        page.wait_for("document.getElementById('own-advisories').innerText.includes('occupied')")
        page.wait_for(is_seen)
        page.evaluate("document.getElementById('calls').style.height = '60px'")
        page.wait_for(is_seen)


def test_a_pace_that_nobody_can_choose_is_shown_and_goes_on_in_real_time(page: Page) -> None:
    chosen = "document.getElementById('pace-factor').selectedOptions[0]?.textContent"
    with seated(page, "TOWER", pace="4x") as run:
        page.wait_for(f"{chosen} === '4x'")
        run.changes.add("clock", 2.0, "paused", "paused")
        page.wait_for("document.getElementById('pace-pause').textContent === 'Go on'")
        page.click("pace-pause")
        assert run.next().factor == 1.0
        run.changes.add("clock", 3.0, "running", "0.5x")
        page.wait_for(f"{chosen} === 'half as fast'")


def test_no_pause_is_offered_where_the_run_has_none(page: Page) -> None:
    with seated(page, "TOWER", may_pause=False):
        page.wait_for("document.getElementById('frequencies').textContent.includes('119.1')")
        assert page.evaluate("document.getElementById('pace').hidden")


def test_words_that_were_lost_with_the_connection_are_given_back_and_those_heard_are_not(
    page: Page, monkeypatch: pytest.MonkeyPatch
) -> None:
    told, words = (
        "document.getElementById('seat-state').textContent",
        "document.getElementById('words').value",
    )
    with seated(page, "TOWER") as run:
        with lost_at("text", monkeypatch):
            page.evaluate(f"{words} = 'American 123, hold.'")
            page.evaluate(SAY)
            page.wait_for(f"{told}.includes('before the run had heard your last words')")
        page.wait_for("document.getElementById('link').hidden")
        assert page.evaluate(f"{told}.includes('say them again')")
        assert page.evaluate(words) == "American 123, hold."
        page.evaluate(SAY)
        assert run.next().text == "American 123, hold."
        page.wait_for(f"{told} === ''")
        assert page.evaluate(words) == ""


@contextmanager
def lost_at(kind: str, monkeypatch: pytest.MonkeyPatch, *, is_done: bool = False) -> Iterator[None]:
    """Let each connection end when an act of a kind comes, before it is done or after that."""
    done = PretendedClient.act

    def do_until_it_ends(client: PretendedClient, act: SeatAct) -> str:
        why = done(client, act) if is_done or act.do != kind else ""
        if act.do == kind:
            raise RuntimeError("the connection has ended")
        return why

    with monkeypatch.context() as patched:
        patched.setattr(PretendedClient, "act", do_until_it_ends)
        yield


IS_BACK = "document.getElementById('link').hidden"


@pytest.mark.parametrize("is_done", [False, True], ids=["unheard", "heard"])
def test_a_command_that_was_lost_with_the_connection_is_not_told_to_be_set_nor_given_again(
    page: Page, monkeypatch: pytest.MonkeyPatch, is_done: bool
) -> None:
    told = "document.getElementById('panel-state').textContent"
    with seated(page, "AAL123") as run:
        with lost_at("fly", monkeypatch, is_done=is_done):
            page.press("g", 71)
            page.wait_for(f"{told}.startsWith('Not set: the connection is lost.')")
            assert page.evaluate(f"{told}.includes('may have heard it: Go around')")
            page.wait_for(IS_BACK)
        assert commands(run, page) == ["go_around"] * is_done
        page.press("g", 71)
        page.wait_for(f"{told} === 'Set: Go around.'")
        assert commands(run, page) == ["go_around"]


def test_what_is_wished_without_a_connection_is_told_not_to_be_done_and_not_done_later(
    page: Page,
) -> None:
    with seated(page, "AAL123") as run:
        page.evaluate(f"{NO_CONNECTION}; null")
        for wish, where, said in (
            ("panel-go-around", "panel-state", "Not set: the connection is lost."),
            ("pace-pause", "seat-state", "Not set: the connection is lost."),
            ("seat-take", "seat-state", "Not done: the connection is lost."),
        ):
            page.evaluate(f"document.getElementById('{wish}').click()")
            assert page.evaluate(f"document.getElementById('{where}').textContent") == said
        page.evaluate("connect()")
        assert commands(run, page) == []
        assert page.evaluate("document.body.dataset.seat") == "pilot"


def test_a_person_is_told_by_how_much_the_run_is_behind_the_clock(page: Page) -> None:
    told = "document.getElementById('behind').textContent"
    announced = "document.getElementById('behind-told').textContent"
    with seated(page, "TOWER") as run:
        for behind_s, pace, text in (
            (3.2, "realtime", "3 s behind the clock"),
            (0.4, "realtime", ""),
            (5.0, "0.5x", "5 s behind the clock"),
            (0.0, "paused", ""),
        ):
            is_told = f"{told}.includes('{text}') && Boolean({told}) === {str(bool(text)).lower()}"
            tell_clock_until(page, is_told, run, 1.0, "running", pace, behind_s)
            if text:
                assert page.evaluate(announced) == "The run is behind the clock."
        assert page.evaluate(announced) == "The run is not behind the clock any more."


def tell_clock_until(page: Page, expression: str, run: PretendedRun, *clock: Any) -> None:
    """Tell the clock again until an expression in the page is true."""
    due = time.monotonic() + PATIENCE_S
    while not page.evaluate(expression):
        assert time.monotonic() < due, f"never true: {expression}"
        run.changes.add("clock", *clock)
        page.evaluate("new Promise((done) => setTimeout(done, 100))")


def test_a_run_that_stands_still_without_a_pause_is_told_to_be_behind(page: Page) -> None:
    told = "document.getElementById('behind').textContent"
    with seated(page, "TOWER") as run:
        run.changes.add("clock", 2.0, "running", "realtime", 0.0)
        page.wait_for(f"/^[0-9]+ s behind the clock/.test({told})")
        tell_clock_until(page, f"!{told}", run, 3.0, "paused", "paused", 0.0)


def test_who_watches_a_run_without_seats_is_told_what_was_refused(page: Page) -> None:
    with seat_page(has_seats=False) as (run, url):
        page.open(url)
        refused = {"t": 1.0, "kind": "refused", "who": "page", "text": "a stranger's origin"}
        run.changes.add("event", refused)
        told = "document.getElementById('refused').textContent"
        page.wait_for(f'{told} === "Refused at 1.0 s: a stranger\'s origin"')


def test_a_screen_reader_is_told_of_an_advisory_to_others_while_nobody_has_a_seat(
    page: Page,
) -> None:
    with seat_page(has_seats=False) as (run, url):
        run.changes.add("clock", 1.0, "running", "realtime")
        page.open(url)
        page.wait_for("document.getElementById('state').textContent.startsWith('running')")
        advise(run, "ATC", "Both lose separation.")
        told = "document.getElementById('alert').textContent"
        page.wait_for(f"{told} === 'WARNING: Both lose separation.'")


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


MAST = {
    "name": "mast", "carrier": None, "width_px": 64, "height_px": 48, "horizontal_fov_deg": 60.0,
}  # fmt: skip


DOCUMENT = """[...document.querySelectorAll('*')].flatMap((one) => [
    one.textContent, one.value ?? '', ...[...one.attributes].map(({ value }) => value),
]).join()"""
"""All texts, values and attributes of the page."""
NO_FRAMES = """new Promise((stopped) => {
    window.requestAnimationFrame = () => 0;
    setTimeout(stopped, 100);
})"""
"""Ends all that draws frame by frame."""


@pytest.mark.parametrize("seat", ["AAL123", "TOWER"])
def test_who_leaves_a_seat_leaves_nothing_of_it_anywhere_in_the_document(
    page: Page, seat: str
) -> None:
    with seated(page, seat) as run:
        carrier = None if seat == "TOWER" else seat
        of_camera, of_seat = Audience("camera", carrier), Audience("frequency", 119_100)
        run.pictures["ZZZ99", 1] = Picture(64, 48, bytes(64 * 48 * 3), of_camera)
        for name, east_m in ((seat, 0.0), ("ZZZ99", 9_000.0)):
            place = (1.0, east_m, 0.0, 34_900, [70.0, 0.0], 90.0, False, "")
            run.changes.add("state", name, "aircraft", "B737", *place, audience=of_seat)
        run.changes.add("camera", MAST | {"name": "ZZZ99", "carrier": carrier}, audience=of_camera)
        run.changes.add("picture", "ZZZ99", 1, 1.0, None, None, audience=of_camera)
        text = {"recipient": seat, "message": "ZZZ99 is near.", "recommendation": None}
        advisory = ADVISORY | {"traffic": [seat, "ZZZ99"], "texts": [text]}
        run.changes.add("advisory", advisory, audience=of_seat)
        run.changes.add("call", CALL | {"speaker": "ZZZ99"}, audience=of_seat)
        run.seats.add_task(seat, CARD.model_copy(update={"text": "ZZZ99, hold."}))
        cockpit(run, INSTRUMENTS)
        shown = ["#calls", "#advisories", "#own-advisories", "#tasks", "#traffic"]
        shown += ["#strips"] if seat == "TOWER" else []
        for part in shown:
            page.wait_for(f"document.querySelector('{part}').innerText.includes('ZZZ99')")
        described = ["plan"] if seat == "TOWER" else ["nd"]
        for display in described:
            page.wait_for(f"document.getElementById('{display}').ariaLabel.includes('ZZZ99')")
        page.wait_for("document.getElementById('camera-image').src.includes('ZZZ99')")
        page.wait_for("document.getElementById('instruments').textContent.includes('35,000')")
        for field in ("words", "panel-altitude"):
            page.evaluate(f"document.getElementById('{field}').value = 'ZZZ99 34560'")
        page.evaluate(NO_FRAMES)  # Nothing is left to the next frame, which a hidden page has not.
        page.evaluate("document.getElementById('seat-take').click()")
        page.wait_for("document.getElementById('talk').hidden")
        for word in ("ZZZ99", "35,000"):
            page.wait_for(f"!{DOCUMENT}.includes('{word}')")


def test_an_advisory_in_force_is_told_as_seen_for_each_person_who_takes_the_seat(
    page: Page,
) -> None:
    with seated(page, "TOWER") as run:
        advise(run, "ATC", "Both lose separation.")
        seen = PerceiveAdvisory(
            id="Both lose separation.", revision=1, recipient="ATC", way="seen", after_s=0.0
        )
        assert run.next().model_copy(update={"after_s": 0.0}) == seen
        # Lists come and go meanwhile, and move the button.
        page.evaluate("document.getElementById('seat-take').click()")
        page.wait_for("document.getElementById('talk').hidden")
        take_seat(page)
        assert run.next().model_copy(update={"after_s": 0.0}) == seen


def test_a_page_keeps_its_seat_when_it_is_loaded_again_and_a_duplicate_of_its_tab_has_none(
    page: Page, monkeypatch: pytest.MonkeyPatch
) -> None:
    identities: list[str] = []
    serve = Browsers.serve

    async def note(self: Browsers, socket: Any, begin: int, identity: str, *more: Any) -> None:
        identities.append(identity)
        await serve(self, socket, begin, identity, *more)

    monkeypatch.setattr(Browsers, "serve", note)
    with seated(page, "TOWER") as run:
        run.pictures["mast", 1] = Picture(64, 48, bytes(64 * 48 * 3), Audience("camera", None))
        place = f"{page.evaluate('location.href')}api/cameras/mast/1.jpg"
        # As a tab that is duplicated, one that is opened from here has a copy of the storage.
        duplicated = "window.duplicate = open(location.href); null"
        page.call("Runtime.evaluate", expression=duplicated, userGesture=True)
        page.wait_for("duplicate.document.getElementById('seat-state')?.textContent")
        page.call("Page.reload")
        page.wait_for("!window.duplicate && document.body?.dataset.seat === 'controller'")
        page.wait_for("document.getElementById('seat-uses').value === 'voice'")
        own, *others = (
            httpx.get(place, params={"browser": identity}, trust_env=False).status_code
            for identity in identities
        )
        assert (own, others) == (200, [403, 200])
        # Nothing is drawn in a tab that is behind another one.
        for target in page.call("Target.getTargets")["targetInfos"]:
            if target.get("openerId"):
                page.call("Target.closeTarget", targetId=target["targetId"])
        page.call("Page.bringToFront")
    page.complaints.clear()  # A browser complains of sound that it does not play before a click.


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


def test_a_call_that_came_while_the_page_had_no_sound_is_not_played_later(
    page: Page, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(browsers, "HOLD_S", PATIENCE_S)
    told = "document.getElementById('hearing').innerText"
    with seated(page, "TOWER") as run:
        page.evaluate("new Promise((done) => setTimeout(done, 1000))")
        page.call("Page.reload")
        page.wait_for("document.body?.dataset.seat === 'controller'")
        page.wait_for(f"{told}.includes('No sound: click or press a key.')")
        page.evaluate(COUNT_PIECES)
        run.call_on_air("meanwhile", piece(0.5), piece(0.4))
        run.stream("opened", id="later", frequency_khz=119_100)
        page.wait_for("document.getElementById('frequencies').innerText.includes('busy')")
        page.press("x", ord("X"))
        page.wait_for(f"!{told}.includes('No sound')")
        run.stream("samples", id="later", frequency_khz=119_100, pcm=piece(0.3))
        page.wait_for("window.pieces.length")
        assert page.evaluate(PIECES) == [0.3]
    page.complaints.clear()


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


def test_who_has_no_seat_is_not_told_that_nobody_has_said_anything(page: Page) -> None:
    calls = "document.getElementById('calls').textContent"
    with seat_page() as (_, url):
        page.open(url)
        page.wait_for("document.body.dataset.ready")
        assert page.evaluate(calls) == "Take a seat to see what is said there."
        take_seat(page)
        page.wait_for(f"{calls} === 'Nobody has said anything so far.'")


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
