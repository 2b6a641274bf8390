"""Tools of a seat besides the microphone: frequencies, phrases, questions, a gamepad."""

from __future__ import annotations

import json
import threading
import time
from pathlib import Path

import httpx
import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

from airhilt.audio.pcm import SAMPLE_RATE_HZ, to_pcm
from airhilt.messages import (
    Advisory,
    AdvisoryAudio,
    AgreeToUses,
    Evidence,
    NasaTlx,
    SayText,
    Severity,
    WorkloadQuestion,
)
from airhilt.record import Logged
from airhilt.station.audiences import EVERYBODY
from airhilt.station.browsers import PageMessage
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
from stations import (
    PATIENCE_S,
    TOWER,
    PretendedRun,
    do,
    opened,
    seat_page,
    sit,
)

ROSTER = {"AAL123": "aircraft", "OPS1": "vehicle"}
GAMEPAD = """
    const buttons = Array.from({length: 4}, () => ({pressed: false}));
    window.pads = [{connected: true, timestamp: 0, buttons}];
    navigator.getGamepads = () => window.pads;
    window.dispatchEvent(new Event('gamepadconnected'));
"""


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
        sit(socket)
        for khz in (121_700, 119_100):
            run.stream("opened", id=f"call {khz}", frequency_khz=khz)
        assert next_of(socket, "sounds") == [
            ["opened", {"id": "call 119100", "frequency_khz": 119_100}]
        ]
        assert do(socket, "tune", frequencies_khz=[]) == ""
        run.stream("opened", id="not heard", frequency_khz=119_100)
        time.sleep(0.2)  # What is said is passed on by then.
        assert do(socket, "tune", frequencies_khz=[119_100]) == ""
        run.stream("opened", id="heard", frequency_khz=119_100)
        assert next_of(socket, "sounds")[-1][1] == {"id": "heard", "frequency_khz": 119_100}


WORDS = "document.getElementById('words').value"
HINT = "document.getElementById('seat-hint').textContent"


@pytest.mark.browser
def test_what_may_be_used_is_chosen_in_the_form_in_which_the_seat_is_taken(
    page: Page, seat: tuple[PretendedRun, str]
) -> None:
    run, url = seat
    run.deeds.clear()
    page.open(url, width=1280, height=720)
    page.wait_for("document.getElementById('state').textContent.startsWith('running')")
    assert "kept as text" in page.evaluate(HINT)
    page.click("seat-take")  # Nothing is chosen yet.
    page.evaluate("document.getElementById('seat-uses').value = 'words'")
    page.click("seat-take")
    page.wait_for("!document.getElementById('say').hidden")
    page.wait_for("!document.getElementById('words').disabled")
    page.evaluate(f"{WORDS} = 'Ready.'")
    page.evaluate(SAY)
    assert run.next() == SayText(text="Ready.")
    assert run.deeds == ["take", "agree", "text"]
    *_, last = run.settings.queue
    assert last == AgreeToUses(uses=("words",))


@pytest.mark.browser
@pytest.mark.parametrize("is_recorded", [True, False])
def test_the_form_says_if_the_voice_is_recorded(page: Page, is_recorded: bool) -> None:
    tower = TOWER.model_copy(update={"voice_is_recorded": is_recorded})
    with seat_page(PretendedRun((tower,))) as (_, url):
        page.open(url)
        page.wait_for(f"{HINT}.includes('recorded')")
        silent = str(not is_recorded).lower()
        page.wait_for(f"{HINT}.includes('sound is not recorded') === {silent}")


@pytest.mark.browser
def test_words_that_the_run_may_not_have_heard_are_given_back(
    page: Page, seat: tuple[PretendedRun, str]
) -> None:
    run, url = seat
    sit_down(page, url)
    run.deeds.clear()
    page.wait_for("!document.getElementById('words').disabled")
    page.evaluate(f"{NO_CONNECTION}; {WORDS} = 'Ready.'; null")
    page.evaluate(SAY)
    page.wait_for("document.getElementById('seat-state').textContent.includes('Nothing was said')")
    assert page.evaluate(WORDS) == "Ready."
    page.evaluate("connect()")
    page.evaluate(SAY)
    assert run.next() == SayText(text="Ready.")


@pytest.mark.browser
def test_nobody_talks_or_types_once_the_run_is_over(page: Page) -> None:
    with seat_page() as (run, url):
        sit_down(page, url)
        run.changes.add("clock", 9.0, "finished", "realtime")
        for name in ("talk", "say"):
            page.wait_for(f"document.getElementById({name!r}).hidden")


@pytest.mark.parametrize("version", ["0123456789ab pretended", "{page} another-run"])
def test_a_page_of_another_version_or_run_is_refused_in_words_and_told(
    seat: tuple[PretendedRun, str], version: str
) -> None:
    run, url = seat
    with opened(url, version=version.format(page=page_version())) as socket:
        with pytest.raises(ConnectionClosed):
            socket.recv(timeout=PATIENCE_S)
        assert (socket.close_code, "Load it again" in (socket.close_reason or "")) == (4426, True)
    assert "refused a page of another version or run" in run.told
    with opened(url, version=f"{page_version()} pretended") as socket:
        assert next_of(socket, "seats") is not None


def test_a_situation_that_cannot_be_is_refused_in_words(seat: tuple[PretendedRun, str]) -> None:
    answer = httpx.post(f"{seat[1]}api/phrases", json={"speaker": "nobody"}, trust_env=False)
    assert (answer.status_code, "speaker" in answer.json()["error"]) == (400, True)


@pytest.mark.browser
def test_a_phrase_is_chosen_and_the_workload_is_rated(
    page: Page, seat: tuple[PretendedRun, str]
) -> None:
    run, url = seat
    run.changes.add("briefing", "TOWER", None, ROSTER)
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
    assert run.next() == SayText(text="Ops one, hold position.")
    run.seats.ask("TOWER", WorkloadQuestion(number=1, scale="isa", asked_ns=0))
    page.wait_for("!document.getElementById('isa').hidden")
    page.press("4", 52)
    rated = run.next()
    assert (rated.question, rated.isa) == (1, 4)
    page.wait_for("document.getElementById('isa').hidden")
    run.seats.ask("TOWER", WorkloadQuestion(number=2, scale="nasa_tlx", asked_ns=0))
    page.wait_for("document.getElementById('tlx-dialog').open")
    page.evaluate("document.getElementById('tlx').requestSubmit()")
    assert "Frustration" in page.evaluate("document.getElementById('tlx-state').textContent")
    page.evaluate("document.querySelectorAll('#tlx-items input').forEach((one) => one.click())")
    page.evaluate("document.getElementById('tlx').requestSubmit()")
    assert run.next().nasa_tlx == NasaTlx(**dict.fromkeys(NasaTlx.model_fields, 50))
    page.wait_for("!document.getElementById('tlx-dialog').open")


@pytest.mark.browser
def test_an_advisory_is_not_told_to_be_heard_where_the_loudspeaker_is_down(
    page: Page,
) -> None:
    told: dict[str, list[str]] = {}
    with seat_page() as (run, url):
        run.changes.add("briefing", "TOWER", None, ROSTER)
        sit_down(page, url)
        for volume in ("0", "0.5"):
            page.evaluate(f"document.querySelector('#hearing input[max]').value = '{volume}'")
            warn(run, f"at-{volume}")
            told[volume] = [run.next().way for _ in range(1 if volume == "0" else 2)]
    assert told["0"] == ["seen"]
    assert sorted(told["0.5"]) == ["heard", "seen"]


@pytest.mark.browser
def test_a_voice_without_a_tone_is_told_to_be_heard_only_if_it_sounds(
    page: Page,
) -> None:
    """A voice that cannot be had, of a run that has none for it, comes before one that sounds."""
    voice = Sound(to_pcm(np.full(SAMPLE_RATE_HZ // 10, 0.1, np.float32)), EVERYBODY)
    with seat_page() as (run, url):
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
    page: Page, severity: str, tones: list[int]
) -> None:
    silent = PretendedRun((TOWER.model_copy(update={"spoken_from": None}),))
    with seat_page(silent) as (run, url):
        run.changes.add("briefing", "TOWER", None, ROSTER)
        sit_down(page, url)
        page.evaluate(COUNT_TONES)
        warn(run, "unspoken", Severity(severity), has_voice=False)
        told = [run.next() for _ in range(2 if tones else 1)]
        sounded = page.evaluate("window.tones.map(({ value }) => value)")
    assert sounded == tones
    assert sorted(one.way for one in told) == (["heard", "seen"] if tones else ["seen"])


@pytest.mark.browser
def test_an_advisory_whose_voice_was_lost_has_its_tone_then_and_no_other_one_again(
    page: Page,
) -> None:
    with seat_page() as (run, url):
        run.changes.add("briefing", "TOWER", None, ROSTER)
        sit_down(page, url)
        page.evaluate(COUNT_TONES)
        warn(run, "spoken")
        assert sorted(run.next().way for _ in range(2)) == ["heard", "seen"]
        warn(run, "waiting", has_voice=False)
        assert run.next().way == "seen"
        assert page.evaluate("window.tones.length") == 3
        run.seats.change_all(spoken_from=None)
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
    live = LiveRun(run.changes, run.views, print)
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
    page: Page, seat: tuple[PretendedRun, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, url = seat
    told = "document.getElementById('link').hidden ? '' : link.textContent"
    page.open(url)
    page.wait_for("document.getElementById('state').textContent.startsWith('running')")
    assert page.evaluate(told) == ""
    goes_on, validate = threading.Event(), PageMessage.model_validate_json

    def stand_still(text: str) -> PageMessage:
        goes_on.wait(PATIENCE_S)
        return validate(text)

    monkeypatch.setattr(PageMessage, "model_validate_json", stand_still)
    page.wait_for(f"({told}).includes('Connection lost')")
    goes_on.set()
    page.wait_for(f"!({told})")
    run.changes.add("clock", 9.0, "finished", "realtime")
    page.wait_for(f"({told}).includes('The run is over')")
