"""The page at a seat of a run that is only pretended: lists, advisories, words, connection."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import httpx
import pytest

from airhilt.messages import (
    PerceiveAdvisory,
    SeatAct,
)
from airhilt.station import browsers
from airhilt.station.audiences import Audience
from airhilt.station.browsers import Browsers
from airhilt.station.pictures import Picture
from devtools import Page
from loudspeaker import COUNT_PIECES, PIECES, piece
from microphone import NO_CONNECTION, SAY
from seat_pages import (
    CALL,
    CARD,
    INSTRUMENTS,
    advise,
    cockpit,
    commands,
    fly,
    seated,
)
from stations import (
    ADVISORY,
    PATIENCE_S,
    PretendedClient,
    PretendedRun,
    seat_page,
    take_seat,
)

pytestmark = pytest.mark.browser
KEYS = "[...document.querySelectorAll('#help-keys dd')].map((one) => one.textContent)"


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
        page.activate("seat-take")
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


def test_enter_ticks_a_box_where_the_space_bar_is_to_talk(page: Page) -> None:
    ticked = "document.getElementById('plan-rings').checked"
    with seated(page, "TOWER"):
        page.evaluate("document.getElementById('plan-rings').focus()")
        page.press("Enter", 13)
        assert page.evaluate(ticked) is False
        page.press("Enter", 13)
        assert page.evaluate(ticked) is True


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
        page.activate("seat-take")
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


def test_who_has_no_seat_is_not_told_that_nobody_has_said_anything(page: Page) -> None:
    calls = "document.getElementById('calls').textContent"
    with seat_page() as (_, url):
        page.open(url)
        page.wait_for("document.body.dataset.ready")
        assert page.evaluate(calls) == "Take a seat to see what is said there."
        take_seat(page)
        page.wait_for(f"{calls} === 'Nobody has said anything so far.'")
