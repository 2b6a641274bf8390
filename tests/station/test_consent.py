"""Consent to the use of voice and words: the server refuses what a person has not agreed to."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from unittest.mock import AsyncMock

import pytest
from websockets.sync.client import ClientConnection

from airhilt.messages import SeatConsent, SpokenWords, Use
from airhilt.station import browsers, seat_book
from airhilt.station.browsers import Browsers
from airhilt.station.consents import NO_VOICE, NO_WORDS, Consents
from devtools import Page
from microphone import (
    BUTTON,
    FAKE,
    NO_CONNECTION,
    TALK_STATE,
    open_microphone,
    page_with_microphone,
    sit_down,
)
from stations import PATIENCE_S, TOWER, PretendedRun, agree, answer, browser, seat_page, wish

PIECE = bytes(3_200)
"""A piece of sound, of 0.1 s."""
TWO = (TOWER, TOWER.model_copy(update={"seat": "GROUND"}))


def take(run: PretendedRun, socket: ClientConnection, seat: str = "TOWER") -> None:
    wish(socket, take=seat)
    while run.presence.get(timeout=PATIENCE_S) != (seat, True):
        pass


def leave(run: PretendedRun, socket: ClientConnection, seat: str = "TOWER") -> None:
    wish(socket, leave=seat)
    while run.presence.get(timeout=PATIENCE_S) != (seat, False):
        pass


def sit_and_agree(run: PretendedRun, socket: ClientConnection) -> None:
    """Take the seat, agree to the use of the voice, and wait until the station knows it."""
    take(run, socket)
    agree(socket)
    while agreed(socket) != ["voice"]:
        pass


def agreed(socket: ClientConnection) -> Any:
    """Return to what the person agrees, as the station tells next."""
    return answer(socket, "consent")["given"]


def call(socket: ClientConnection) -> None:
    """Press the button, speak for 0.3 s, and let it go."""
    wish(socket, press={})
    for _ in range(3):
        socket.send(PIECE)
    wish(socket, release=True)


def refusals(socket: ClientConnection) -> list[str]:
    """Return what is refused of all that was wished until now."""
    wish(socket, watch="none")  # It is refused after all that, and marks the end.
    told = []
    while "camera" not in (text := str(answer(socket, "refused"))):
        told.append(text)
    return told


@pytest.mark.parametrize("is_recorded", [True, False])
def test_a_voice_that_is_not_agreed_to_is_refused_and_never_reaches_the_run(
    is_recorded: bool,
) -> None:
    """Also where voices are not recorded: the words are, and everybody hears it."""
    run = PretendedRun([TOWER.model_copy(update={"voice_is_recorded": is_recorded})])
    with seat_page(run) as (_, url), browser(url, "a") as own:
        take(run, own)
        call(own)
        assert refusals(own) == [NO_VOICE]
        agree(own, is_given=False)
        call(own)
        assert refusals(own) == [NO_VOICE]
        agree(own, "words")
        call(own)
        assert refusals(own) == [NO_VOICE]
        assert run.done.empty()
        agree(own)
        call(own)
        assert run.call()[1] == 3 * PIECE
        assert refusals(own) == []
    assert [text for text in run.told if "camera" not in text] == [
        f"refused a wish of a browser: {NO_VOICE}"
    ] * 3


def test_sound_without_a_call_is_refused_too_unless_it_is_agreed_to() -> None:
    with seat_page() as (run, url), browser(url, "a") as own:
        take(run, own)
        for _ in range(3):
            own.send(PIECE)
        assert refusals(own) == [NO_VOICE]
        agree(own)
        own.send(PIECE)
        assert refusals(own) == []
        assert run.done.empty()


@pytest.mark.parametrize(
    ("answers", "is_said"),
    [
        ([], False),
        ([("words", True)], True),
        ([("words", False)], False),
        ([("voice", True)], True),
        ([("voice", True), ("voice", False)], False),
        ([("words", True), ("voice", False)], True),
        ([("voice", True), ("words", False)], False),
    ],
)
def test_words_are_said_if_their_use_or_that_of_the_voice_is_agreed_to(
    answers: list[tuple[str, bool]], is_said: bool
) -> None:
    with seat_page() as (run, url), browser(url, "a") as own:
        take(run, own)
        for what, is_given in answers:
            agree(own, what, is_given=is_given)
        wish(own, say={"text": "hello"})
        assert refusals(own) == ([] if is_said else [NO_WORDS])
        said = [] if run.done.empty() else [run.next()]
        assert said == [SpokenWords(text="hello")] * is_said


def test_who_takes_consent_back_while_speaking_ends_the_call() -> None:
    with seat_page() as (run, url), browser(url, "a") as own:
        take(run, own)
        agree(own)
        wish(own, press={})
        own.send(PIECE)
        agree(own, is_given=False)
        assert run.call()[1] == PIECE
        own.send(PIECE)
        assert refusals(own) == [NO_VOICE]
        assert run.done.empty()


def test_commands_and_answers_need_no_consent() -> None:
    with seat_page() as (run, url), browser(url, "a") as own:
        take(run, own)
        wish(own, pace={"factor": 0.5})
        assert run.next().factor == 0.5


def test_consent_is_over_when_the_seat_is_left_by_whomever_it_is_taken_then() -> None:
    with seat_page() as (run, url), browser(url, "a") as own, browser(url, "b") as other:
        take(run, own)
        agree(own)
        leave(run, own)
        for next_person in (own, other):
            take(run, next_person)
            call(next_person)
            assert refusals(next_person) == [NO_VOICE]
            leave(run, next_person)
        assert run.done.empty()


def test_consent_at_one_seat_is_none_at_another() -> None:
    with (
        seat_page(PretendedRun(TWO)) as (run, url),
        browser(url, "a") as own,
        browser(url, "b") as other,
    ):
        take(run, own)
        take(run, other, "GROUND")
        agree(own)
        call(other)
        assert refusals(other) == [NO_VOICE]
        leave(run, other, "GROUND")
        take(run, own, "GROUND")  # It leaves the tower.
        call(own)
        assert refusals(own) == [NO_VOICE]
        assert run.done.empty()


@pytest.mark.parametrize(("shown_seat", "is_kept"), [("TOWER", True), (None, False)])
def test_consent_outlasts_a_lost_connection_but_not_a_page_that_is_loaded_again(
    shown_seat: str | None, is_kept: bool
) -> None:
    with seat_page() as (run, url), browser(url, "b") as other:
        with browser(url, "a") as own:
            sit_and_agree(run, own)
        for _ in range(2):  # The second time, since the connection has ended.
            while answer(other, "seats") != {"TOWER": "taken"}:
                pass
        with browser(url, "a", shown_seat) as back:
            assert answer(back, "seats") == {"TOWER": "yours"}
            assert agreed(back) == ["voice"] * is_kept
            call(back)
            assert refusals(back) == [NO_VOICE] * (not is_kept)
            assert run.done.qsize() == (5 if is_kept else 0)


def test_consent_is_over_when_the_page_was_told_that_it_has_no_seat() -> None:
    """It comes back before its old connection has ended, and asks its person again."""
    with seat_page() as (run, url), browser(url, "a") as old:
        sit_and_agree(run, old)
        with browser(url, "a", "TOWER") as back:
            assert answer(back, "seats") == {"TOWER": "taken"}
            assert agreed(back) == []
            old.close()
            told: list[Any] = []
            while not any("consent" in message for message in told):
                told.append(json.loads(back.recv(timeout=PATIENCE_S)))
            assert {"seats": {"TOWER": "yours"}} in told  # First: it forgets what was agreed to.
            call(back)
            assert refusals(back) == [NO_VOICE]


def test_a_page_that_comes_back_over_a_cut_network_need_not_ask_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(browsers, "SILENT_S", -1.0)
    with seat_page() as (run, url), browser(url, "a") as old:
        sit_and_agree(run, old)
        with browser(url, "a", "TOWER") as back:
            assert answer(back, "seats") == {"TOWER": "yours"}
            old.send(PIECE)  # The old connection has no seat any more.
            call(back)
            assert run.call()[1] == 3 * PIECE


def test_consent_is_over_when_nobody_came_back(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(seat_book, "HOLD_S", 0.0)
    with seat_page() as (run, url):
        with browser(url, "a") as own:
            sit_and_agree(run, own)
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", False)
        with browser(url, "a", "TOWER") as back:
            take(run, back)
            call(back)
            assert refusals(back) == [NO_VOICE]


def test_a_page_is_told_what_the_station_knows_to_be_agreed_to() -> None:
    with seat_page() as (run, url), browser(url, "a") as own:
        assert agreed(own) == []
        take(run, own)
        assert agreed(own) == []
        for what, expected in (("words", ["words"]), ("voice", ["voice", "words"])):
            agree(own, what)
            assert agreed(own) == expected
        wish(own, leave="TOWER")
        assert agreed(own) == []


def test_a_page_is_told_what_is_agreed_to_after_which_of_its_answers() -> None:
    """Else it would take the word on an answer for that on a later one."""
    given: set[str] = set()
    answers = [("voice", True), ("words", False), ("words", True), ("voice", True)] * 5
    states = [sorted(given)]
    with seat_page() as (run, url), browser(url, "a") as own:
        take(run, own)
        for number, (what, is_given) in enumerate(answers, 1):
            wish(own, consent={"answer": {"what": what, "is_given": is_given}, "number": number})
            given = given | {what} if is_given else set()
            states.append(sorted(given))
        counted: list[int] = []
        while len(counted) < len(answers):
            told = answer(own, "consent")
            counted += told["answered"]
            assert told["given"] in states[len(counted) : len(counted) + 2]  # Perhaps of the next.
        assert told["given"] == states[-1]
        assert counted == list(range(1, len(answers) + 1))


def test_an_answer_of_who_has_no_seat_counts_as_not_taken_in() -> None:
    with seat_page() as (run, url), browser(url, "a") as own:
        for number in (1, 2):
            yes = {"what": "voice", "is_given": True}
            wish(own, consent={"answer": yes, "number": number})
            if number == 1:
                take(run, own)
        counted: list[int] = []
        while not counted:
            counted = answer(own, "consent")["answered"]
        assert counted == [2]


def test_the_run_has_the_answer_before_what_it_lets_through() -> None:
    with seat_page() as (run, url), browser(url, "a") as own:
        take(run, own)
        agree(own)
        call(own)
        run.call()
    assert run.deeds == ["consent to voice", "pressed", *["samples"] * 3, "released"]


def test_who_has_agreed_before_need_not_be_asked_at_the_seat_and_the_run_is_told() -> None:
    with (
        seat_page(PretendedRun(TWO), agreed={"TOWER": "voice"}) as (run, url),
        browser(url, "a") as own,
    ):
        take(run, own)
        while agreed(own) != ["voice"]:
            pass
        assert run.settings.get(timeout=PATIENCE_S) == SeatConsent(what="voice", is_given=True)
        call(own)
        assert run.call()[1] == 3 * PIECE
        leave(run, own)
        take(run, own, "GROUND")
        call(own)
        assert refusals(own) == [NO_VOICE]


def test_who_takes_a_seat_that_somebody_had_at_another_page_has_not_agreed_before() -> None:
    with seat_page(agreed={"TOWER": "voice"}) as (run, url), browser(url, "a") as own:
        run.elsewhere["TOWER"] = "taken"
        wish(own, take="TOWER")
        assert "at another page" in str(answer(own, "refused"))
        del run.elsewhere["TOWER"]
        take(run, own)
        call(own)
        assert refusals(own) == [NO_VOICE]
        assert run.settings.empty()


@pytest.mark.parametrize("is_gone", [False, True], ids=["left", "gone"])
def test_who_takes_a_seat_next_has_not_agreed_before(
    monkeypatch: pytest.MonkeyPatch, is_gone: bool
) -> None:
    monkeypatch.setattr(seat_book, "HOLD_S", 0.0)
    with seat_page(agreed={"TOWER": "voice"}) as (run, url), browser(url, "b") as other:
        with browser(url, "a") as own:
            take(run, own)
            if not is_gone:
                leave(run, own)
        if is_gone:
            assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", False)
        run.settings.get(timeout=PATIENCE_S)
        take(run, other)
        call(other)
        assert refusals(other) == [NO_VOICE]
        assert run.settings.empty()


@pytest.mark.parametrize(
    ("before", "declined", "left"),
    [
        ("words", None, ["words"]),
        ("voice", None, ["voice"]),
        ("words", "voice", ["words"]),
        ("words", "words", []),
        ("voice", "voice", []),
        ("voice", "words", []),
    ],
)
def test_a_page_that_is_loaded_again_asks_who_has_taken_back_what_was_agreed_before(
    before: Use, declined: str | None, left: list[str]
) -> None:
    """Somebody who has not need not be asked."""
    with seat_page(agreed={"TOWER": before}) as (run, url):
        with browser(url, "a") as own:
            take(run, own)
            if declined is not None:
                agree(own, declined, is_given=False)
                refusals(own)
        with browser(url, "a") as back:
            while answer(back, "seats") != {"TOWER": "yours"}:
                pass
            assert agreed(back) == left


def test_what_is_agreed_to_beyond_what_was_before_is_over_when_the_page_is_loaded_again() -> None:
    consents = Consents({"TOWER": "words"})
    consents.begin("TOWER")
    consents.take("TOWER", SeatConsent(what="voice", is_given=True))
    assert consents.given_at("TOWER") == ("voice", "words")
    consents.begin("TOWER")
    assert consents.given_at("TOWER") == ("words",)


def test_without_a_seat_nothing_is_agreed_to() -> None:
    consents = Consents()
    consents.take("TOWER", SeatConsent(what="voice", is_given=True))
    assert (consents.admits_voice(None), consents.admits_words(None)) == (False, False)
    consents.end("GROUND")
    assert consents.given_at("TOWER") == ("voice",)


ASKED = "document.getElementById('consent').open"
SEAT_STATE = "document.getElementById('seat-state').textContent"
CUT = """(() => {
    const send = WebSocket.prototype.send;
    WebSocket.prototype.send = function (...sent) {
        WebSocket.prototype.send = send;
        this.close();
    };
})()"""
"""Closes the connection of the page at the next thing that it sends."""


def consent(run: PretendedRun) -> SeatConsent:
    """Return the next answer about consent of which the run is told."""
    while not isinstance(told := run.settings.get(timeout=PATIENCE_S), SeatConsent):
        pass
    return told


@contextmanager
def at_a_seat_with_consent() -> Iterator[tuple[PretendedRun, str, Page]]:
    """Take a seat whose person has agreed to the use of the voice before."""
    with (
        seat_page(agreed={"TOWER": "voice"}) as (run, url),
        page_with_microphone(*FAKE) as page,
    ):
        sit_down(page, url)
        page.wait_for("!document.getElementById('consent-back').hidden")
        yield run, url, page


def end_untold(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a connection end when the station has taken in an answer, and before it says so."""
    do = Browsers._do_at_seat

    async def do_and_end(self: Browsers, own: Any, seat: str, told: Any) -> None:
        await do(self, own, seat, told)
        if told.consent is not None:
            monkeypatch.undo()
            raise RuntimeError("the connection has ended")

    monkeypatch.setattr(Browsers, "_do_at_seat", do_and_end)
    monkeypatch.setattr(Browsers, "_tell_consent", lambda *_: None)


def held_back(monkeypatch: pytest.MonkeyPatch) -> tuple[threading.Event, threading.Event]:
    """Hold back answers; return an event that tells of one, and one that lets them be taken in."""
    take_consent = Browsers._take_consent
    has_come, may_take = threading.Event(), threading.Event()

    async def take_late(*given: Any) -> None:
        has_come.set()
        await asyncio.to_thread(may_take.wait, PATIENCE_S)
        await take_consent(*given)

    monkeypatch.setattr(Browsers, "_take_consent", take_late)
    return has_come, may_take


def clicked(*names: str) -> str:
    """Return a script that clicks on buttons one after the other, with nothing in between."""
    return "".join(f"document.getElementById({name!r}).click();" for name in names)


def take_at(page: Page, seat: str) -> None:
    """Take a seat at the page, once it is free."""
    page.wait_for("!document.getElementById('seat-name').disabled")
    page.evaluate(f"document.getElementById('seat-name').value = {seat!r}")
    page.wait_for("document.getElementById('seat-take').textContent === 'Take the seat'")
    page.click("seat-take")
    page.wait_for("!document.getElementById('talk').hidden")


def want_to_say(page: Page, words: str) -> None:
    page.evaluate(f"document.getElementById('words').value = {words!r}")
    page.click("say-button")


@pytest.mark.browser
def test_who_has_agreed_is_not_asked_again_after_a_lost_connection(page: Page) -> None:
    with seat_page() as (run, url):
        sit_down(page, url)
        want_to_say(page, "Ready.")
        page.wait_for(ASKED)
        page.click("consent-agree")
        assert run.next() == SpokenWords(text="Ready.")
        page.evaluate(CUT)
        page.wait_for("!document.getElementById('link').hidden")
        page.wait_for("document.getElementById('link').hidden")
        want_to_say(page, "Ready again.")
        assert run.next() == SpokenWords(text="Ready again.")
        assert not page.evaluate(ASKED)
        page.open("about:blank")


@pytest.mark.browser
def test_consent_is_taken_back_at_the_page_which_closes_the_microphone_and_asks_again() -> None:
    back = "document.getElementById('consent-back').hidden"
    with (
        seat_page(agreed={"TOWER": "voice"}) as (run, url),
        page_with_microphone(*FAKE) as page,
    ):
        sit_down(page, url)
        page.wait_for(f"!{back}")
        page.click("talk-button")  # It need not ask.
        page.wait_for(f"{BUTTON} === 'Hold to talk'")
        page.click("consent-back")
        page.wait_for(f"{BUTTON} === 'Open the microphone' && {back}")
        assert "taken back your consent" in page.evaluate(TALK_STATE)
        assert consent(run) == SeatConsent(what="voice", is_given=True)
        assert consent(run) == SeatConsent(what="words", is_given=False)
        page.click("talk-button")
        page.wait_for(ASKED)


@pytest.mark.browser
def test_consent_that_is_taken_back_without_a_connection_ends_when_it_is_there_again() -> None:
    with at_a_seat_with_consent() as (run, _, page):
        page.click("talk-button")
        page.wait_for(f"{BUTTON} === 'Hold to talk'")
        assert consent(run) == SeatConsent(what="voice", is_given=True)
        page.evaluate(CUT)
        page.click("consent-back")
        assert page.evaluate(BUTTON) == "Open the microphone"  # Whatever the station knows.
        page.click("talk-button")
        page.wait_for(ASKED)
        assert consent(run) == SeatConsent(what="words", is_given=False)
        page.click("consent-agree")
        assert consent(run) == SeatConsent(what="voice", is_given=True)
        page.wait_for(f"{BUTTON} === 'Hold to talk'")


@pytest.mark.browser
@pytest.mark.parametrize("answered", ["agree", "decline"])
def test_an_answer_that_is_lost_leaves_consent_taken_back(answered: str) -> None:
    with at_a_seat_with_consent() as (run, _, page):
        assert consent(run) == SeatConsent(what="voice", is_given=True)
        page.evaluate(CUT)
        page.evaluate(clicked("consent-back", "talk-button", f"consent-{answered}"))
        page.wait_for(f"{SEAT_STATE}.includes('may not know')")
        assert "closed: the connection is lost" in page.evaluate(TALK_STATE)
        assert consent(run) == SeatConsent(what="words", is_given=False)
        page.wait_for(f"{SEAT_STATE}.includes('knows now')")
        assert page.evaluate("document.getElementById('consent-back').hidden")
        page.click("talk-button")
        page.wait_for(ASKED)


@pytest.mark.browser
def test_consent_is_taken_back_before_it_is_given_again_over_a_new_connection(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Also if the page has not heard yet what the station knows."""
    with at_a_seat_with_consent() as (run, _, page):
        monkeypatch.setattr(Browsers, "_tell_consent", lambda *_: None)
        page.evaluate(CUT)
        page.click("consent-back")
        page.wait_for(f"{SEAT_STATE}.includes('may not know')")
        page.wait_for("document.getElementById('link').hidden")
        page.evaluate(clicked("talk-button", "consent-agree"))
        told = [(one.what, one.is_given) for one in (consent(run), consent(run), consent(run))]
        assert told == [("voice", True), ("words", False), ("voice", True)]


@pytest.mark.browser
def test_who_says_no_once_more_hears_that_the_station_knows_it_now(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with at_a_seat_with_consent() as (run, _, page):
        has_come, may_take = held_back(monkeypatch)
        page.evaluate(CUT)
        page.click("consent-back")
        page.wait_for(f"{SEAT_STATE}.includes('may not know')")
        assert has_come.wait(PATIENCE_S)
        page.evaluate(clicked("talk-button", "consent-decline"))
        may_take.set()
        page.wait_for(f"{SEAT_STATE}.includes('knows now')")
        assert [consent(run).is_given for _ in range(3)] == [True, False, False]


@pytest.mark.browser
def test_who_says_no_after_a_yes_that_may_be_lost_is_asked_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The yes was not lost: the station took it in, and the no came when nobody heard it."""
    with seat_page() as (run, url), page_with_microphone(*FAKE) as page:
        sit_down(page, url)
        end_untold(monkeypatch)
        page.evaluate(clicked("talk-button", "consent-agree"))
        no = clicked("talk-button", "consent-decline")
        page.evaluate(f"""new Promise((done) => {{
            const look = setInterval(() => {{
                if (!{TALK_STATE}.includes('the connection is lost')) return;
                clearInterval(look);
                {no}
                done(true);
            }}, 10);
        }})""")
        assert consent(run) == SeatConsent(what="voice", is_given=True)
        assert consent(run) == SeatConsent(what="voice", is_given=False)
        page.wait_for(f"{SEAT_STATE}.includes('knows now')")
        assert page.evaluate("document.getElementById('consent-back').hidden")
        page.click("talk-button")
        page.wait_for(ASKED)


@pytest.mark.browser
def test_a_voice_that_is_declined_admits_no_words_before_the_station_knows(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It has taken in the yes before, that covers words, and has said so."""
    with seat_page(agreed={"TOWER": "voice"}) as (_, url), page_with_microphone(*FAKE) as page:
        denied = "JSON.stringify({ serving: run.serving, denied: [['TOWER', 'voice']] })"
        page.open(url, width=1280, height=720)
        page.evaluate(f"""fetch('api/run').then((run) => run.json()).then(
            (run) => sessionStorage.setItem('consent-denied', {denied}))""")
        monkeypatch.setattr(Browsers, "_take_consent", AsyncMock())  # It hears of no answer.
        sit_down(page, url)
        want_to_say(page, "Ready.")
        page.wait_for(ASKED)
        assert page.evaluate("document.getElementById('consent-back').hidden")


@pytest.mark.browser
def test_what_the_last_person_has_taken_back_is_not_taken_back_from_the_next() -> None:
    with at_a_seat_with_consent() as (run, _, page):
        page.evaluate(clicked("consent-back", "seat-take"))
        page.wait_for("document.getElementById('talk').hidden")
        page.click("seat-take")
        page.wait_for("!document.getElementById('talk').hidden")
        assert page.evaluate(TALK_STATE) == ""
        page.click("talk-button")
        page.click("consent-agree")
        page.wait_for(f"{BUTTON} === 'Hold to talk'")
        assert [consent(run).is_given for _ in range(3)] == [True, False, True]


@pytest.mark.browser
def test_what_was_taken_back_in_one_run_is_not_taken_back_in_another() -> None:
    denied = json.dumps({"serving": "another", "denied": [["TOWER", "words"]]})
    with at_a_seat_with_consent() as (run, url, page):
        assert consent(run).is_given
        page.evaluate(f"sessionStorage.setItem('consent-denied', {denied!r})")
        page.open(url, width=1280, height=720)
        page.wait_for(f"{SEAT_STATE}.includes('does not know that consent was denied at TOWER')")
        page.wait_for("!document.getElementById('talk').hidden")
        page.wait_for("!document.getElementById('consent-back').hidden")
        page.complaints.clear()  # A page that was loaded again plays nothing before a click.


@pytest.mark.slow
@pytest.mark.browser
def test_the_run_is_told_of_each_seat_at_which_consent_was_taken_back(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Both seats were lost before it could be told."""
    monkeypatch.setattr(seat_book, "HOLD_S", 0.0)
    with (
        seat_page(PretendedRun(TWO), agreed={"TOWER": "voice", "GROUND": "voice"}) as (run, url),
        page_with_microphone(*FAKE) as page,
    ):
        page.open(url, width=1280, height=720)
        page.wait_for("document.getElementById('state').textContent.startsWith('running')")
        for seat in ("TOWER", "GROUND"):
            take_at(page, seat)
            page.wait_for("!document.getElementById('consent-back').hidden")
            assert consent(run).is_given
            page.evaluate(CUT)
            page.click("consent-back")
            page.wait_for("document.getElementById('talk').hidden")
        for seat in ("TOWER", "GROUND"):
            take_at(page, seat)
            assert not consent(run).is_given
            page.wait_for(f"{SEAT_STATE}.includes('knows now')")
            page.click("seat-take")
            page.wait_for("document.getElementById('talk').hidden")


@pytest.mark.browser
def test_each_question_comes_after_the_answer_to_the_one_before_and_words_are_said_once() -> None:
    with seat_page() as (run, url), page_with_microphone(*FAKE) as page:
        sit_down(page, url)
        page.evaluate("document.getElementById('words').value = 'Ready.'")
        page.evaluate(clicked("talk-button", "consent-decline", "say-button", "talk-button"))
        page.wait_for(ASKED)
        page.evaluate(clicked("consent-agree", "say-button"))
        page.wait_for(f"{ASKED} && document.getElementById('words').value === ''")
        page.click("consent-decline")
        told = [(one.what, one.is_given) for one in (consent(run), consent(run), consent(run))]
        assert told == [("voice", False), ("words", True), ("voice", False)]
        page.wait_for(f"{TALK_STATE} === 'The microphone is closed.'")
        assert run.next() == SpokenWords(text="Ready.")
        assert run.done.empty()


@pytest.mark.browser
def test_what_is_typed_before_the_station_has_heard_the_answer_is_not_said(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    _, may_take = held_back(monkeypatch)
    with seat_page() as (run, url), page_with_microphone(*FAKE) as page:
        sit_down(page, url)
        want_to_say(page, "Ready.")
        page.click("consent-agree")
        page.evaluate("document.getElementById('words').value = 'I think that'")
        may_take.set()
        page.wait_for(f"{SEAT_STATE}.includes('has changed')")
        assert page.evaluate("document.getElementById('words').value") == "I think that"
        assert run.done.empty()


@pytest.mark.browser
def test_who_has_taken_back_what_the_run_may_not_know_at_its_end_is_told_so(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with at_a_seat_with_consent() as (run, _, page):
        monkeypatch.setattr(Browsers, "_tell_consent", lambda *_: None)
        page.click("consent-back")
        assert consent(run).is_given
        assert not consent(run).is_given  # The station has not said yet that it knows it.
        run.changes.add("clock", 9.0, "finished", "realtime")
        page.wait_for(f"{SEAT_STATE}.includes('The run is over')")
        page.complaints.clear()


@pytest.mark.browser
def test_no_sound_is_sent_once_consent_is_taken_back() -> None:
    with seat_page() as (_, url), page_with_microphone(*FAKE) as page:
        sit_down(page, url)
        open_microphone(page)
        page.key("keyDown", " ", 32)
        page.wait_for("document.getElementById('talk-level').value > 0")
        page.evaluate(
            """(() => {
                const send = WebSocket.prototype.send;
                window.sent = [];
                WebSocket.prototype.send = function (what) {
                    window.sent.push(typeof what === 'string' ? what : 'sound');
                    send.call(this, what);
                };
            })();"""
            + clicked("consent-back")
        )
        page.wait_for("window.sent.includes('{\"release\":true}')")
        page.key("keyUp", " ", 32)
        assert "sound" not in page.evaluate("window.sent")


@pytest.mark.browser
def test_consent_that_is_taken_back_before_the_station_has_heard_of_it_opens_nothing() -> None:
    with seat_page(agreed={"TOWER": "words"}) as (run, url), page_with_microphone(*FAKE) as page:
        sit_down(page, url)
        page.wait_for("!document.getElementById('consent-back').hidden")
        page.evaluate(clicked("talk-button", "consent-agree", "consent-back"))
        page.wait_for(f"{TALK_STATE} === 'The microphone is closed.'")
        told = [(one.what, one.is_given) for one in (consent(run), consent(run), consent(run))]
        assert told == [("words", True), ("voice", True), ("words", False)]
        assert page.evaluate("document.getElementById('consent-back').hidden")
        page.click("talk-button")
        page.wait_for(ASKED)


@pytest.mark.browser
def test_consent_that_is_given_after_it_was_taken_back_is_not_taken_back_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with at_a_seat_with_consent() as (run, _, page):
        end_untold(monkeypatch)
        page.click("consent-back")
        for told in (True, False, False):  # It is told once more, because it may not be known.
            assert consent(run).is_given is told
        page.click("talk-button")
        page.wait_for(ASKED)
        page.click("consent-agree")
        assert consent(run) == SeatConsent(what="voice", is_given=True)
        page.wait_for(f"{BUTTON} === 'Hold to talk'")
        page.wait_for("!document.getElementById('consent-back').hidden")


@pytest.mark.browser
def test_the_run_is_told_what_was_taken_back_when_the_page_was_loaded_again_meanwhile() -> None:
    with at_a_seat_with_consent() as (run, url, page):
        assert consent(run).is_given
        page.evaluate(f"{NO_CONNECTION}; null")
        page.click("consent-back")
        page.wait_for(f"{SEAT_STATE}.includes('may not know')")
        page.open(url, width=1280, height=720)
        assert consent(run) == SeatConsent(what="words", is_given=False)
        page.wait_for("!document.getElementById('talk').hidden")
        page.wait_for("document.getElementById('consent-back').hidden")
        page.complaints.clear()  # A page that was loaded again plays nothing before a click.


@pytest.mark.browser
def test_the_run_is_told_what_was_taken_back_when_the_seat_was_lost_meanwhile(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(seat_book, "HOLD_S", 0.0)
    with at_a_seat_with_consent() as (run, _, page):
        assert consent(run).is_given
        page.evaluate(CUT)
        page.click("consent-back")
        page.wait_for("document.getElementById('talk').hidden")
        page.click("seat-take")
        assert consent(run) == SeatConsent(what="words", is_given=False)


@pytest.mark.browser
def test_a_page_asks_again_for_consent_that_the_station_does_not_know(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with seat_page() as (run, url), page_with_microphone(*FAKE) as page:
        sit_down(page, url)
        open_microphone(page)
        monkeypatch.setattr(Consents, "given_at", lambda *_: ())
        page.key("keyDown", " ", 32)
        page.wait_for(f"{BUTTON} === 'Open the microphone'")
        page.key("keyUp", " ", 32)
        assert page.evaluate(SEAT_STATE) == NO_VOICE
        monkeypatch.undo()
        page.click("talk-button")
        page.wait_for(f"{BUTTON} === 'Hold to talk' || {ASKED}")
        assert page.evaluate(ASKED)
        assert run.done.empty()
