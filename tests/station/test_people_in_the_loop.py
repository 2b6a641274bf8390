"""People at seats, in real browsers with a microphone that plays a file, in runs of their own.

They take minutes: ``pytest -m slow tests/station/test_people_in_the_loop.py``.
"""

from __future__ import annotations

import itertools
import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.cosim.replay import replay
from airhilt.engine_families import RECOGNISERS
from airhilt.host.library import find
from airhilt.record import open_run
from devtools import Page
from loudspeaker import given_out, tap
from microphone import (
    BUTTON,
    microphone_file,
    open_microphone,
    page_with_microphone,
    playing,
    sit_down,
    talk,
)
from stations import url_of

pytestmark = [pytest.mark.slow, pytest.mark.browser]
PATIENCE_S = 300.0
CLIMB = "American one two three, climb and maintain three thousand"
GO_AROUND = "American one two three, go around, climb and maintain three thousand"
UNABLE = "Washington Tower, American one two three, unable, traffic on the runway"
HALF_SECOND = SAMPLE_RATE_HZ // 2
"""Number of samples."""
APPROACH = """(() => {
    document.getElementById('panel-runway').value = '01';
    [...document.querySelectorAll('#panel-runways button')]
        .find((one) => one.textContent === 'Approach').click();
})()"""
A_SECOND = "new Promise((done) => setTimeout(done, 1000))"
"""Time that the person in the tests takes to think, or to hear all of a call."""
CALL_COUNT = "document.querySelectorAll('#calls > li').length"
LAST_CALL = "document.querySelector('#calls > li:last-child').textContent"
RECOGNISED_COUNT = "document.getElementById('calls').textContent.split('Recognised').length"
SAYINGS = 4
"""Largest number of times that a person says the same."""


@contextmanager
def running(
    out: Path, scenario: str, duration_s: float, *options: str, **radio: Any
) -> Iterator[str]:
    """Start a run with sound and a page, yield the URL, and wait for the end of the run."""
    file = out.with_suffix(".json")
    content = json.loads(find("scenarios", scenario).read_text()) | {"duration_s": duration_s}
    content["radio"] |= radio
    file.write_text(json.dumps(content))
    command = [sys.executable, "-m", "airhilt", "cosim", "--scenario", str(file), "--no-cameras"]
    command += ["--no-browser", "--port", "0", "--latency", "fixed", "--out", str(out), *options]
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True
    )
    assert process.stderr is not None
    with process.stderr:
        try:
            yield url_of(process.stderr)
            end_page(process)
            process.stderr.read()
            assert process.wait(timeout=PATIENCE_S) == 0
        finally:
            if process.poll() is None:
                end_page(process)
                process.send_signal(signal.SIGINT)
                process.stderr.read()
                process.wait(timeout=PATIENCE_S)


def end_page(run: subprocess.Popen[str]) -> None:
    """End the server of the page, which waits for browsers, and let the run go on."""
    for child in psutil.Process(run.pid).children(recursive=True):
        if "view" in child.cmdline():
            child.kill()


def contents(out: Path, key: str) -> list[dict[str, Any]]:
    return [json.loads(one.data) for one in open_run(out).log() if one.key.startswith(key)]


def test_a_spoken_clearance_is_recognised_read_back_and_flown(tmp_path: Path) -> None:
    """As a person would, who is asked to, it is said again: the noise depends on the time."""
    out, file = tmp_path / "run", microphone_file(tmp_path / "said.wav", CLIMB)
    options = ("--seat", "tower", "--assistant", "none")
    with (
        running(out, "s01b_nominal", 100.0, *options) as url,
        page_with_microphone(*playing(file)) as page,
    ):
        sit_down(page, url)
        open_microphone(page)
        for count in range(2, 2 * SAYINGS + 1, 2):  # Each call, and what the crew answers.
            talk(page)
            page.wait_for(f"{CALL_COUNT} >= {count}")
            page.wait_for(f"{LAST_CALL}.includes('%')")  # It is recognised.
            if "climb" in page.evaluate(LAST_CALL):
                break
        page.wait_for("document.getElementById('state').textContent === 'finished'")
    *_, heard, readback = contents(out, "asr/")[:count]
    assert "climb and maintain three thousand" in heard["text"]
    assert readback["id"].endswith(".readback")
    commands = [one for one in contents(out, "truth/event") if one["kind"] == "command"]
    assert json.loads(commands[0]["text"])["action"] == "altitude"
    heights_m = [state["altitude_m"] for state in contents(out, "truth/state/AAL123")]
    assert heights_m[-1] > min(heights_m) + 50.0
    assert replay(out).identical


def test_two_people_hear_each_other_and_block_each_other_when_both_talk(tmp_path: Path) -> None:
    said_by_tower = microphone_file(tmp_path / "tower.wav", GO_AROUND)
    said_by_pilot = microphone_file(tmp_path / "pilot.wav", UNABLE)
    out, options = tmp_path / "run", ("--seat", "tower", "--seat", "AAL123", "--assistant", "none")
    with (
        running(out, "s01b_nominal", 150.0, *options) as url,
        page_with_microphone(*playing(said_by_tower)) as tower,
        page_with_microphone(*playing(said_by_pilot)) as pilot,
    ):
        for page in (tower, pilot):
            tap(page)
        sit_down(tower, url)
        sit_down(pilot, url, "AAL123")
        for page in (tower, pilot):
            open_microphone(page)
        for speaker, listener, words in ((tower, pilot, "go around"), (pilot, tower, "unable")):
            heard = said_until_written(speaker, listener, words)
            assert words in RECOGNISERS.create("embedded").recognise(heard, ("AAL123",)).text
        hold(tower)
        hold(pilot)
        pilot.wait_for("document.querySelector('.lamp').textContent.includes('busy')")
        for page in (tower, pilot):
            page.key("keyUp", " ", 32)
        for page in (tower, pilot):
            page.wait_for("document.getElementById('seat-state').textContent.includes('blocked')")
    calls = [one for one in contents(out, "truth/radio/") if one["is_from_microphone"]]
    is_blocked = [bool(one["blocked_by"]) for one in calls]
    one_by_one = calls[: is_blocked.index(True)]
    speakers = [speaker for speaker, _ in itertools.groupby(one["speaker"] for one in one_by_one)]
    assert speakers == ["Washington Tower", "AAL123"]
    people = json.loads((out / "summary.json").read_text())["people"]
    of_calls = {call["call"]: call for person in people for call in person["calls"]}
    for call in (of_calls[one["id"]] for one in one_by_one):
        assert call["heard_at"] == 1
        assert call["to_loudspeaker_s"] > call["to_air_s"]
    assert all(person["press_to_loudspeaker_s"] > 0.0 for person in people)
    together = calls[len(one_by_one) :]
    assert {one["speaker"] for one in together} == {"Washington Tower", "AAL123"}
    assert all(one["blocked_by"] for one in together)
    assert replay(out).identical


def said_until_written(speaker: Page, listener: Page, words: str) -> Audio:
    """Say the same again until the listener's page writes these words; return what was heard last.

    Each time the listener hears it, and the speaker hears nothing while transmitting.
    """
    for _ in range(SAYINGS):
        for page in (speaker, listener):
            given_out(page)
        before = listener.evaluate(RECOGNISED_COUNT)
        talk(speaker)
        listener.wait_for(f"{RECOGNISED_COUNT} > {before}")
        listener.evaluate(A_SECOND)  # The words are known before all of them are heard.
        heard, own = given_out(listener), given_out(speaker)
        assert loudness(heard) > 0.02
        assert loudness(own) < 0.001
        if words in listener.evaluate(LAST_CALL):
            return heard
    pytest.fail(f"{words!r} was not written of {SAYINGS} calls")


def hold(page: Page) -> None:
    page.key("keyDown", " ", 32)
    page.wait_for(f"{BUTTON} === 'On the air'")


def loudness(audio: Audio) -> float:
    """Return the root mean square of the loudest half second."""
    pieces = audio[: len(audio) // HALF_SECOND * HALF_SECOND].reshape(-1, HALF_SECOND)
    return float(np.sqrt(np.mean(pieces**2, axis=1)).max(initial=0.0))


def test_a_pilot_who_is_warned_goes_around(tmp_path: Path) -> None:
    out = tmp_path / "run"
    with (
        running(out, "s01b_noncompliance", 110.0, "--seat", "AAL123") as url,
        page_with_microphone() as page,
    ):
        sit_down(page, url)
        page.evaluate(APPROACH)  # Without it the aircraft goes around by itself.
        page.wait_for("document.getElementById('panel-state').textContent.includes('Set')")
        page.wait_for("document.getElementById('own-advisories').textContent.includes('WARNING')")
        page.evaluate(A_SECOND)
        page.click("panel-go-around")
        page.wait_for("document.getElementById('state').textContent === 'finished'")
    summary = json.loads((out / "summary.json").read_text())
    assert summary["avoided"]
    (person,) = summary["people"]
    warned = [one for one in person["reactions"] if one["advised"] == "go_around"]
    assert warned[0]["followed"]
    assert warned[0]["first_action"] == "go_around"
    assert warned[0]["t_heard_s"] > warned[0]["t_advisory_s"]
    assert 0.0 < warned[0]["reaction_time_s"] < 30.0
    assert replay(out).identical
