"""Tools of a seat besides the microphone: frequencies, phrases, questions, a gamepad."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from pathlib import Path

import httpx
import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from airhilt.audio.pcm import SAMPLE_RATE_HZ, to_pcm
from airhilt.messages import (
    Advisory,
    AdvisoryAudio,
    Evidence,
    NasaTlx,
    SeatConsent,
    SeatListening,
    Severity,
    SpokenWords,
)
from airhilt.record import Logged
from airhilt.station import browsers
from airhilt.station.audiences import EVERYBODY
from airhilt.station.live import LiveRun
from airhilt.station.page_files import page_version
from airhilt.station.subscription import Sound
from devtools import Page
from microphone import (
    BUTTON,
    NO_CONNECTION,
    SAY,
    microphone_file,
    open_microphone,
    page_with_microphone,
    playing,
    sit_down,
)
from stations import PATIENCE_S, TOWER, PretendedRun, seat_page, seats_given_back_at_once

ROSTER = {"AAL123": "aircraft", "OPS1": "vehicle"}
GAMEPAD = """
    const buttons = Array.from({length: 4}, () => ({pressed: false}));
    window.pads = [{connected: true, timestamp: 0, buttons}];
    navigator.getGamepads = () => window.pads;
    window.dispatchEvent(new Event('gamepadconnected'));
"""


@pytest.fixture(scope="module")
def served() -> Iterator[tuple[PretendedRun, str]]:
    with seat_page() as served:
        yield served


@pytest.fixture
def seat(served: tuple[PretendedRun, str]) -> Iterator[tuple[PretendedRun, str]]:
    with seats_given_back_at_once(served[0]):
        yield served


def opened(url: str, version: str = "", serving: str = "") -> ClientConnection:
    place = f"{url.replace('http', 'ws')}api/live?version={version}&serving={serving}"
    return connect(place, proxy=None)


def next_of(socket: ClientConnection, kind: str) -> list[list[object]]:
    while kind not in (message := json.loads(socket.recv(timeout=PATIENCE_S))):
        pass
    found: list[list[object]] = message[kind]
    return found


def test_a_person_hears_only_the_frequencies_of_the_seat_that_are_listened_to(
    seat: tuple[PretendedRun, str],
) -> None:
    run, url = seat
    with opened(url) as socket:
        for wish in ({"take": "TOWER"}, {"tune": [119_100]}, {"echo": 1.0}):
            socket.send(json.dumps(wish))
        next_of(socket, "echo")
        for khz in (121_700, 119_100):
            run.stream("opened", id=f"call {khz}", frequency_khz=khz)
        assert next_of(socket, "sounds") == [
            ["opened", {"id": "call 119100", "frequency_khz": 119_100}]
        ]


def test_the_run_is_told_what_is_listened_to_when_it_changes() -> None:
    """A page tells it anew after each loss of the connection."""
    with seat_page() as (run, url):
        for tuned in ("[119100] [119100] [] [119100]", "[119100]"):
            with opened(url) as socket:
                socket.send(json.dumps({"take": "TOWER"}))
                for frequencies in tuned.split():
                    socket.send(f'{{"tune": {frequencies}}}')
                socket.send(json.dumps({"echo": 1.0}))
                next_of(socket, "echo")
                socket.send(json.dumps({"leave": "TOWER"}))
                while run.presence.get(timeout=PATIENCE_S)[1]:
                    pass
        heard = [run.settings.get(timeout=PATIENCE_S) for _ in range(4)]
        assert [one.frequencies_khz for one in heard if isinstance(one, SeatListening)] == [
            (119_100,), (), (119_100,), (119_100,),
        ]  # fmt: skip
        assert run.settings.empty()


ASKED = "document.getElementById('consent').open"
WORDS = "document.getElementById('words').value"


def consent(run: PretendedRun) -> SeatConsent:
    """Return the next answer about voice or words."""
    while not isinstance(told := run.settings.get(timeout=PATIENCE_S), SeatConsent):
        assert isinstance(told, SeatListening)
    return told


def want_to_say(page: Page, url: str) -> None:
    """Sit down, and have words in the field about which the page asks."""
    sit_down(page, url)
    page.evaluate(f"{WORDS} = 'Ready.'")
    page.click("say-button")
    page.wait_for(ASKED)


def leave(page: Page) -> None:
    page.evaluate("document.getElementById('consent').close()")
    page.click("seat-take")
    page.wait_for("document.getElementById('say').hidden")


@pytest.mark.browser
@pytest.mark.parametrize(
    ("button", "is_given"), [("consent-agree", True), ("consent-decline", False)]
)
def test_the_run_is_told_if_the_person_agrees_to_the_use_of_the_voice(
    page: Page, seat: tuple[PretendedRun, str], button: str, is_given: bool
) -> None:
    run, url = seat
    sit_down(page, url)
    page.click("talk-button")
    page.wait_for(ASKED)
    page.click(button)
    assert consent(run) == SeatConsent(what="voice", is_given=is_given)
    page.evaluate(f"{WORDS} = 'Ready.'")
    page.click("say-button")
    if is_given:  # Who lets the voice be used may type.
        assert run.next() == SpokenWords(text="Ready.")
    else:
        page.wait_for(ASKED)
    leave(page)
    page.open("about:blank")


def hold_key(page: Page, key: str, code: int) -> None:
    """Press a key, hold it for a while, and let it go."""
    page.key("keyDown", key, code)
    page.wait_for(ASKED)
    for _ in range(3):
        page.key("keyDown", key, code, repeats=True)
    page.key("keyUp", key, code)


@pytest.mark.browser
@pytest.mark.parametrize(("key", "code"), [(" ", 32), ("Enter", 13)])
def test_a_key_that_was_held_before_the_question_does_not_answer_it(
    page: Page, seat: tuple[PretendedRun, str], key: str, code: int
) -> None:
    """The words of the question have the focus, so that they are read aloud, and no button."""
    run, url = seat
    run.deeds.clear()
    sit_down(page, url)
    if key == "Enter":
        page.evaluate(f"{WORDS} = 'Ready.'; document.getElementById('words').focus()")
    hold_key(page, key, code)
    page.wait_for(ASKED)
    assert page.evaluate("document.activeElement.id") == "consent-text"
    assert run.deeds == []
    page.press("Tab", 9)
    page.press(key, code)
    assert consent(run).is_given
    if key == "Enter":
        assert run.next() == SpokenWords(text="Ready.")
    leave(page)
    page.open("about:blank")


@pytest.mark.browser
def test_who_agrees_to_typing_is_asked_before_the_microphone_opens(
    page: Page, seat: tuple[PretendedRun, str]
) -> None:
    run, url = seat
    run.deeds.clear()
    want_to_say(page, url)
    page.click("consent-agree")
    assert consent(run) == SeatConsent(what="words", is_given=True)
    assert run.next() == SpokenWords(text="Ready.")
    assert run.deeds == ["consent to words", "say"]
    page.click("talk-button")
    page.wait_for(ASKED)
    leave(page)
    page.open("about:blank")


@pytest.mark.browser
@pytest.mark.parametrize("is_recorded", [True, False])
def test_the_question_says_if_the_voice_is_recorded(page: Page, is_recorded: bool) -> None:
    tower = TOWER.model_copy(update={"voice_is_recorded": is_recorded})
    with seat_page(PretendedRun((tower,))) as (_, url):
        sit_down(page, url)
        page.click("talk-button")
        page.wait_for(ASKED)
        text = page.evaluate("document.getElementById('consent').innerText")
        assert ("recorded in the folder" in text) is is_recorded
        assert ("sound is not recorded" in text) is not is_recorded
        page.open("about:blank")


@pytest.mark.browser
def test_consent_that_the_station_has_not_heard_is_asked_for_again(
    page: Page, seat: tuple[PretendedRun, str]
) -> None:
    run, url = seat
    run.deeds.clear()
    want_to_say(page, url)
    page.evaluate(f"{NO_CONNECTION}; null")
    page.click("consent-agree")
    page.wait_for("document.getElementById('seat-state').textContent.includes('Nothing was said')")
    page.evaluate("connect()")
    page.click("say-button")
    page.wait_for(ASKED)
    assert run.deeds == []
    page.click("consent-agree")
    assert consent(run) == SeatConsent(what="words", is_given=True)
    assert run.next() == SpokenWords(text="Ready.")
    leave(page)
    page.open("about:blank")


@pytest.mark.browser
def test_nobody_talks_or_types_once_the_run_is_over(page: Page) -> None:
    with seat_page() as (run, url):
        sit_down(page, url)
        page.click("talk-button")
        page.wait_for(ASKED)
        run.changes.add("clock", 9.0, "finished", "realtime")
        for name in ("talk", "say"):
            page.wait_for(f"document.getElementById({name!r}).hidden")
        assert not page.evaluate(ASKED)
        page.open("about:blank")


@pytest.mark.browser
def test_who_only_types_is_asked_once_before_anything_is_said(
    page: Page, seat: tuple[PretendedRun, str]
) -> None:
    run, url = seat
    want_to_say(page, url)
    assert "kept as text" in page.evaluate("document.getElementById('consent').innerText")
    page.click("consent-decline")
    assert consent(run) == SeatConsent(what="words", is_given=False)
    assert page.evaluate(WORDS) == "Ready."
    page.click("say-button")
    page.wait_for(ASKED)
    page.click("consent-agree")
    assert consent(run) == SeatConsent(what="words", is_given=True)
    assert run.next() == SpokenWords(text="Ready.")
    page.evaluate(f"{WORDS} = 'Ready again.'")
    page.click("say-button")
    assert run.next() == SpokenWords(text="Ready again.")
    leave(page)
    page.click("seat-take")  # The next person has not agreed to anything.
    page.wait_for("!document.getElementById('talk').hidden")
    page.evaluate(f"{WORDS} = 'Ready.'")
    page.click("say-button")
    page.wait_for(ASKED)
    leave(page)
    page.open("about:blank")


def test_a_page_of_another_version_is_refused_in_words_and_told(
    seat: tuple[PretendedRun, str],
) -> None:
    run, url = seat
    with opened(url, "0123456789ab") as socket:
        with pytest.raises(ConnectionClosed):
            socket.recv(timeout=PATIENCE_S)
        assert (socket.close_code, "Load it again" in (socket.close_reason or "")) == (4426, True)
    assert "refused a page of another version" in run.told
    with opened(url, page_version()) as socket:
        assert next_of(socket, "seats") is not None


def test_a_page_of_another_start_of_the_server_is_refused_in_words_and_told(
    seat: tuple[PretendedRun, str],
) -> None:
    """It has what that has numbered, and its person may have answered to another run."""
    run, url = seat
    with opened(url, serving="0123456789abcdef") as socket:
        with pytest.raises(ConnectionClosed):
            socket.recv(timeout=PATIENCE_S)
        assert (socket.close_code, "Load the page" in (socket.close_reason or "")) == (4426, True)
    assert "refused a page of another run, or of an earlier start of the server" in run.told


def test_a_situation_that_cannot_be_is_refused_in_words(seat: tuple[PretendedRun, str]) -> None:
    answer = httpx.post(f"{seat[1]}api/phrases", json={"speaker": "nobody"}, trust_env=False)
    assert (answer.status_code, "speaker" in answer.json()["error"]) == (400, True)


@pytest.mark.browser
def test_a_phrase_is_chosen_and_the_workload_is_rated(seat: tuple[PretendedRun, str]) -> None:
    run, url = seat
    run.changes.add("briefing", "TOWER", None, ROSTER)
    with page_with_microphone() as page:
        sit_down(page, url)
        page.evaluate("""
            document.getElementById('phrase-to').value = 'OPS1';
            document.getElementById('phrase-to').dispatchEvent(new Event('change'));
        """)
        hold = "[...document.querySelectorAll('#phrase-list button')]"
        page.wait_for(f"{hold}.some((one) => one.title === 'Ops one, hold position.')")
        page.evaluate(f"{hold}.find((one) => one.title === 'Ops one, hold position.').click()")
        page.press("Enter", 13)
        page.evaluate(SAY)
        assert run.next() == SpokenWords(text="Ops one, hold position.")
        run.seat.add("question", 1, "isa", 0.0)
        page.wait_for("!document.getElementById('isa').hidden")
        page.press("4", 52)
        rated = run.next()
        assert (rated.question, rated.isa) == (1, 4)
        page.wait_for("document.getElementById('isa').hidden")
        run.seat.add("question", 2, "nasa_tlx", 0.0)
        page.wait_for("document.getElementById('tlx-dialog').open")
        page.evaluate("document.getElementById('tlx').requestSubmit()")
        assert "Frustration" in page.evaluate("document.getElementById('tlx-state').textContent")
        page.evaluate("document.querySelectorAll('#tlx-items input').forEach((one) => one.click())")
        page.evaluate("document.getElementById('tlx').requestSubmit()")
        assert run.next().nasa_tlx == NasaTlx(**dict.fromkeys(NasaTlx.model_fields, 50))
        page.wait_for("!document.getElementById('tlx-dialog').open")
        run.seat.add("answered", 2)


@pytest.mark.browser
def test_an_advisory_is_not_told_to_be_heard_where_the_loudspeaker_is_down() -> None:
    told: dict[str, list[str]] = {}
    with seat_page() as (run, url), page_with_microphone() as page:
        run.changes.add("briefing", "TOWER", None, ROSTER)
        sit_down(page, url)
        for volume in ("0", "0.5"):
            page.evaluate(f"document.querySelector('#hearing input[max]').value = '{volume}'")
            warn(run, f"at-{volume}")
            told[volume] = [run.next().way for _ in range(1 if volume == "0" else 2)]
    assert told["0"] == ["seen"]
    assert sorted(told["0.5"]) == ["heard", "seen"]


@pytest.mark.browser
def test_a_voice_without_a_tone_is_told_to_be_heard_only_if_it_sounds() -> None:
    """A voice that cannot be had, of a run that has none for it, comes before one that sounds."""
    voice = Sound(to_pcm(np.full(SAMPLE_RATE_HZ // 10, 0.1, np.float32)), EVERYBODY)
    with seat_page() as (run, url), page_with_microphone() as page:
        run.kept["there-0-ATC"] = voice
        run.changes.add("briefing", "TOWER", None, ROSTER)
        sit_down(page, url)
        for name in ("missing", "there"):
            warn(run, name, Severity.ADVISORY, samples=len(voice.pcm) // 2)
        told = [run.next() for _ in range(3)]
    assert sorted((one.id, one.way) for one in told) == [
        ("missing", "seen"), ("there", "heard"), ("there", "seen"),
    ]  # fmt: skip


COUNT_TONES = """
    window.tones = [];
    const make = AudioContext.prototype.createOscillator;
    AudioContext.prototype.createOscillator = function () {
        const made = make.call(this);
        window.tones.push(made.frequency);
        return made;
    };
"""


@pytest.mark.browser
@pytest.mark.parametrize(
    ("severity", "tones"), [("ADVISORY", []), ("CAUTION", [700]), ("WARNING", [1100] * 3)]
)
def test_an_advisory_that_nobody_speaks_has_its_tone_and_is_heard_then(
    severity: str, tones: list[int]
) -> None:
    silent = PretendedRun((TOWER.model_copy(update={"spoken_from": None}),))
    with seat_page(silent) as (run, url), page_with_microphone() as page:
        run.changes.add("briefing", "TOWER", None, ROSTER)
        sit_down(page, url)
        page.evaluate(COUNT_TONES)
        warn(run, "unspoken", Severity(severity), has_voice=False)
        told = [run.next() for _ in range(2 if tones else 1)]
        sounded = page.evaluate("window.tones.map(({ value }) => value)")
    assert sounded == tones
    assert sorted(one.way for one in told) == (["heard", "seen"] if tones else ["seen"])


@pytest.mark.browser
def test_an_advisory_whose_voice_was_lost_has_its_tone_then_and_no_other_one_again() -> None:
    with seat_page() as (run, url), page_with_microphone() as page:
        run.changes.add("briefing", "TOWER", None, ROSTER)
        sit_down(page, url)
        page.evaluate(COUNT_TONES)
        warn(run, "spoken")
        assert sorted(run.next().way for _ in range(2)) == ["heard", "seen"]
        warn(run, "waiting", has_voice=False)
        assert run.next().way == "seen"
        assert page.evaluate("window.tones.length") == 3
        without = TOWER.model_copy(update={"spoken_from": None})
        run.seat.add("info", without.model_dump(mode="json", exclude={"t_ns"}))
        heard = run.next()
        assert (heard.id, heard.way) == ("waiting", "heard")
        assert page.evaluate("window.tones.length") == 6


def warn(
    run: PretendedRun,
    name: str,
    severity: Severity = Severity.WARNING,
    samples: int = 0,
    has_voice: bool = True,
) -> None:
    """Let the assistant warn the tower, with a tone for a warning, and a voice of some samples."""
    advised = Advisory(
        id=name, revision=0, recipient="ATC", recipients=("ATC",), kind="runway_conflict",
        severity=severity, traffic=("AAL123",), message="stop", t_ready_ns=0,
        evidence=Evidence(sources=("adsb",)), t_ns=1,
    )  # fmt: skip
    audio = AdvisoryAudio(
        id=name, revision=0, recipient="ATC", text="stop", t_dec_ns=0, engine="", samples=samples,
        sha256="", t_ns=1,
    )  # fmt: skip
    live = LiveRun(run.changes, run.of_seats, views=run.views)
    told = (("advisory/ATC", advised), (f"tts/{name}", audio))
    for key, message in told if has_voice else told[:1]:
        live.take(Logged(key, "", 1, message.model_dump_json().encode()))


@pytest.mark.browser
def test_a_button_of_a_gamepad_talks_as_the_space_bar_does(
    seat: tuple[PretendedRun, str], tmp_path: Path
) -> None:
    run, url = seat
    with page_with_microphone(*playing(microphone_file(tmp_path / "said.wav", "hello"))) as page:
        sit_down(page, url)
        open_microphone(page)
        page.evaluate(GAMEPAD)
        page.click("gamepad-choose")
        page.evaluate("window.pads[0].buttons[2].pressed = true")
        page.wait_for("document.getElementById('gamepad-state').textContent.startsWith('Button 3')")
        page.wait_for(f"{BUTTON} === 'On the air'")
        page.evaluate("window.pads[0].buttons[2].pressed = false")
        page.wait_for(f"{BUTTON} === 'Hold to talk'")
        pressed, _ = run.call()
    assert pressed.frequency_khz == 119_100


@pytest.mark.slow
@pytest.mark.browser
def test_a_station_that_stands_still_is_told_on_the_page_and_so_is_the_end_of_the_run(
    seat: tuple[PretendedRun, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, url = seat
    told = "document.getElementById('link').hidden ? '' : link.textContent"
    with page_with_microphone() as page:
        page.open(url)
        page.wait_for("document.getElementById('state').textContent.startsWith('running')")
        assert page.evaluate(told) == ""
        with monkeypatch.context() as patch:
            patch.setattr(browsers.Browsers, "_do", lambda *_: asyncio.sleep(0))
            page.wait_for(f"({told}).includes('What is shown is old')")
        page.wait_for(f"!({told})")
        run.changes.add("clock", 9.0, "finished", "realtime")
        page.wait_for(f"({told}).includes('The run is over')")
