"""The microphone of a seat, in a real browser whose microphone plays a file."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed

from airhilt.audio.pcm import SAMPLE_RATE_HZ, from_pcm
from airhilt.messages import SayText
from breadth import mostly_slow
from devtools import Page
from loudspeaker import COUNT_PIECES, piece
from microphone import (
    BUTTON,
    FAKE,
    SAY,
    TALK_STATE,
    microphone_file,
    open_microphone,
    page_with_microphone,
    playing,
    sit_down,
    talk,
)
from seats import voice
from stations import PATIENCE_S, TOWER, PretendedRun, opened, seat_page, sit

SAY_PLACE = "document.getElementById('say-button').getBoundingClientRect().y"
ADVISORY = {
    "t": 1.0, "equipment": "", "id": "a-1", "revision": 1, "severity": "WARNING", "active": True,
    "kind": "runway_conflict", "traffic": ["AAL123"],
    "texts": [{"recipient": "ATC", "message": "Runway occupied.", "recommendation": None}],
    "evidence": {
        "sources": ["adsb"], "shares": {"adsb": 0.8}, "note": "", "rules": [], "runway": "01",
        "time_to_go_s": 7.0, "time_to_loss_s": None, "radio_ids": [], "camera_ids": [],
        "tracks": [], "inconsistencies": [],
    },
}  # fmt: skip
SPOKEN = {
    "id": "a-1", "revision": 1, "recipient": "ATC", "from": 1.0, "to": 2.0, "text": "",
    "sound": "a-1-1-ATC",
}  # fmt: skip
GRANTED = """(() => {
    const devices = navigator.mediaDevices, ask = devices.getUserMedia.bind(devices);
    const tracks = [], grant = new Promise((done) => { window.grant = done; });
    devices.getUserMedia = async (wanted) => {
        await grant;
        const stream = await ask(wanted);
        tracks.push(...stream.getTracks());
        return stream;
    };
    Object.defineProperty(window, 'granted', { get: () => tracks.map((one) => one.readyState) });
})()"""
"""Lets the microphone be granted once `grant` is called; `granted` has the states of its tracks."""
CHOOSE = """(() => {
    const uses = document.getElementById('seat-uses');
    uses.value = '%s';
    uses.dispatchEvent(new Event('change'));
})()"""
"""Script that chooses what of a person may be used."""
WORDS = "American one two three, cleared to land"
SLOW_LOUDSPEAKER = """
    Object.defineProperty(AudioContext.prototype, 'outputLatency', { get: () => 5.0 });
    null
"""
VOLUME = """(() => {
    const volume = document.querySelector('#hearing input');
    volume.value = %s;
    volume.dispatchEvent(new Event('input'));
})()"""
BUSY = "document.getElementById('frequencies').innerText.includes('busy')"


@pytest.fixture(scope="module")
def browser() -> Iterator[Page]:
    """A browser whose microphone beeps."""
    with page_with_microphone(*FAKE) as page:
        yield page


@pytest.mark.browser
def test_what_is_said_while_the_space_bar_is_held_comes_at_the_seat(
    seat: tuple[PretendedRun, str], tmp_path: Path
) -> None:
    run, url = seat
    file = microphone_file(tmp_path / "said.wav", WORDS)
    with page_with_microphone(*playing(file)) as page:
        sit_down(page, url)
        page.wait_for("document.activeElement.id === 'talk-button'")
        open_microphone(page)
        talk(page)
        pressed, pcm = run.call()
        page.key("keyDown", " ", 32)
        assert run.next().do == "press"
        run.seats.cut("TOWER", "Your call was cut after 60 s.")
        page.wait_for(f"{BUTTON} === 'Hold to talk'")  # Though the space bar is still held.
        page.key("keyUp", " ", 32)
    assert 0.0 <= pressed.delay_s < 60.0
    said, expected = from_pcm(pcm), voice(WORDS)
    assert len(said) > len(expected) - SAMPLE_RATE_HZ // 5
    loud = [np.sqrt(np.mean(sound[np.abs(sound) > 0.02] ** 2)) for sound in (said, expected)]
    assert loud[0] == pytest.approx(loud[1], rel=0.3)


@pytest.mark.browser
def test_an_advisory_to_the_seat_is_shown_sounded_and_reported_to_the_run(
    page: Page,
    seat: tuple[PretendedRun, str],
) -> None:
    run, url = seat
    run.changes.add("briefing", "TOWER", None, {})
    sit_down(page, url)
    run.changes.add("advisory", ADVISORY)
    assert run.next().way == "seen"
    shown = page.evaluate("document.getElementById('own-advisories').innerText")
    assert "WARNING" in shown
    assert "Runway occupied." in shown
    assert "rests on adsb 80" in shown
    run.changes.add("spoken", {**SPOKEN, "recipient": "AAL123"})
    run.changes.add("spoken", SPOKEN)
    heard = run.next()
    assert (heard.way, heard.id, heard.revision, heard.recipient) == ("heard", "a-1", 1, "ATC")


@pytest.mark.browser
def test_the_run_is_told_when_the_first_sample_of_a_transmission_is_audible(
    page: Page,
    seat: tuple[PretendedRun, str],
) -> None:
    """It is not told of what is not heard from its beginning."""
    run, url = seat
    sit_down(page, url)
    page.evaluate(SLOW_LOUDSPEAKER)
    page.evaluate(COUNT_PIECES)
    run.call_on_air("first", piece(0.3), piece(0.5))
    heard = run.heard.get(timeout=PATIENCE_S)
    assert heard.id == "first"
    assert heard.after_s > 4.0  # All but the way to the station.
    page.evaluate(VOLUME % 0)
    run.call_on_air("not audible", piece(0.3))
    page.wait_for("window.pieces.length === 3")
    page.evaluate(VOLUME % 0.8)
    run.stream("samples", id="begun before", frequency_khz=119_100, pcm=piece(0.5))
    page.wait_for("window.pieces.length === 4")
    open_microphone(page)
    page.key("keyDown", " ", 32)
    page.wait_for(f"{BUTTON} === 'On the air'")
    run.stream("opened", id="while talking", frequency_khz=119_100)
    page.wait_for(BUSY)
    page.key("keyUp", " ", 32)
    run.stream("samples", id="while talking", frequency_khz=119_100, pcm=piece(0.5))
    page.wait_for("window.pieces.length === 5")
    run.call_on_air("microphone.TOWER.1", piece(0.3))
    run.call_on_air("last", piece(0.3))
    assert run.heard.get(timeout=PATIENCE_S).id == "last"
    run.call()


@pytest.mark.browser
def test_who_is_denied_the_microphone_is_told_and_can_type(
    seat: tuple[PretendedRun, str],
) -> None:
    run, url = seat
    with page_with_microphone("--deny-permission-prompts") as page:
        sit_down(page, url)
        before = page.evaluate(SAY_PLACE)
        open_microphone(page)
        assert "Type what you want to say" in page.evaluate(TALK_STATE)
        assert page.evaluate(SAY_PLACE) == before  # It does not move under the hand.
        page.evaluate("document.getElementById('words').value = 'hello'")
        page.evaluate(SAY)
        assert run.next() == SayText(text="hello")


@pytest.mark.parametrize("sound", [b"\0", bytes(32_002)])
def test_what_is_no_sound_is_refused_in_words(seat: tuple[PretendedRun, str], sound: bytes) -> None:
    with opened(seat[1]) as socket:
        sit(socket)
        socket.send(sound)
        with suppress(ConnectionClosed):
            while socket.recv(timeout=60.0):
                pass
        assert "expected" in (socket.close_reason or "") or "at most" in (socket.close_reason or "")


@pytest.mark.browser
def test_who_is_heard_by_the_embedded_recogniser_is_told_that_it_hears_few_people_right(
    page: Page,
) -> None:
    run = PretendedRun([TOWER.model_copy(update={"recogniser": "embedded"})])
    with seat_page(run) as (_, url):
        sit_down(page, url)
        page.wait_for(f"{TALK_STATE}.includes('hears few people right')")


@pytest.mark.browser
def test_who_lets_only_words_be_used_has_no_microphone_until_the_voice_may_be_used_too(
    page: Page,
    seat: tuple[PretendedRun, str],
) -> None:
    run, url = seat
    run.deeds.clear()
    sit_down(page, url, uses="words")
    assert page.evaluate("document.getElementById('talk-button').disabled")
    assert "that your voice may be used" in page.evaluate(TALK_STATE)
    page.evaluate(CHOOSE % "voice")
    page.wait_for("!document.getElementById('talk-button').disabled")
    open_microphone(page)
    page.evaluate(CHOOSE % "none")
    page.wait_for("document.getElementById('words').disabled")
    page.wait_for("document.getElementById('talk-button').disabled")
    assert page.evaluate("document.getElementById('talk-level').hidden")
    assert run.deeds[:4] == ["take", "agree", "agree", "agree"]


def change_person(page: Page) -> None:
    """Leave the seat, and let the next person take it at the same page."""
    page.click("seat-take")
    page.wait_for("document.getElementById('talk').hidden")
    assert page.evaluate("document.getElementById('seat-uses').value") == ""
    page.evaluate("document.getElementById('seat-uses').value = 'voice'")
    page.click("seat-take")
    page.wait_for("!document.getElementById('talk').hidden")


@pytest.mark.browser
@pytest.mark.parametrize("is_late", mostly_slow([False, True], True), ids=["open", "being opened"])
def test_who_leaves_the_seat_has_no_open_microphone(
    page: Page, seat: tuple[PretendedRun, str], is_late: bool
) -> None:
    _, url = seat
    sit_down(page, url)
    page.evaluate(GRANTED)
    if is_late:
        page.click("talk-button")
        page.wait_for(f"{TALK_STATE} === 'Opening the microphone.'")
    else:
        page.evaluate("window.grant()")
        open_microphone(page)
    page.click("seat-take")
    page.wait_for("document.getElementById('talk').hidden")
    page.evaluate("window.grant()")
    page.wait_for("window.granted.length && window.granted.every((one) => one !== 'live')")


@pytest.mark.browser
def test_a_microphone_that_is_granted_late_does_not_open_for_the_next_person(
    page: Page,
    seat: tuple[PretendedRun, str],
) -> None:
    _, url = seat
    sit_down(page, url)
    page.evaluate(GRANTED)
    page.click("talk-button")
    change_person(page)
    page.evaluate("window.grant()")
    page.wait_for("window.granted.length && window.granted.every((one) => one !== 'live')")
    assert page.evaluate(BUTTON) == "Open the microphone"
    assert page.evaluate(TALK_STATE) == ""  # Nothing is told that somebody else has done.


@pytest.mark.browser
def test_a_microphone_that_is_denied_late_is_not_told_to_the_next_person(
    page: Page, seat: tuple[PretendedRun, str]
) -> None:
    _, url = seat
    sit_down(page, url)
    page.evaluate("""navigator.mediaDevices.getUserMedia = () => new Promise((_, fail) => {
        window.deny = () => fail(new DOMException('', 'NotAllowedError'));
    }); null""")
    page.click("talk-button")
    page.wait_for("Boolean(window.deny)")
    change_person(page)
    page.evaluate("window.deny(); new Promise((done) => setTimeout(done, 100))")
    assert page.evaluate(TALK_STATE) == ""


@pytest.mark.browser
@pytest.mark.parametrize("is_broken", [True, False], ids=["cannot be", "is being"])
def test_a_microphone_that_is_granted_and_not_heard_yet_is_closed(
    page: Page, seat: tuple[PretendedRun, str], is_broken: bool
) -> None:
    """Its reader cannot be loaded, or is not there when the voice may not be used any more."""
    _, url = seat
    reading = "Promise.reject(new Error('no network'))" if is_broken else "new Promise(() => {})"
    ended = "window.granted.length && window.granted.every((one) => one === 'ended')"
    sit_down(page, url)
    page.evaluate(GRANTED)
    page.evaluate(f"""window.contexts = 0;
        const close = AudioContext.prototype.close;
        AudioContext.prototype.close = function () {{
            window.contexts++;
            return close.call(this);
        }};
        window.read = AudioWorklet.prototype.addModule;
        AudioWorklet.prototype.addModule = () => {reading};
        window.grant()""")
    page.click("talk-button")
    if is_broken:
        page.wait_for(f"{TALK_STATE}.includes('no network')")
    else:
        page.wait_for("window.granted.length")
        page.evaluate(CHOOSE % "words")
    page.wait_for(f"{ended} && window.contexts === 1")
    page.evaluate("AudioWorklet.prototype.addModule = read")  # It can be opened after that.
    if not is_broken:
        page.evaluate(CHOOSE % "voice")
        page.wait_for("!document.getElementById('talk-button').disabled")
        page.click("talk-button")
        page.wait_for(f"{BUTTON} === 'Hold to talk'")
