"""The same calls of a tower, typed or spoken at its seat in a browser, in runs in real time.

All of them take hours, one after another: ``pytest -m slow -n 6 --dist load -k typed`` with this
file; each run needs little of a processor.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import pytest

from airhilt.record import open_run
from airhilt.units import SECOND_NS
from devtools import Page
from microphone import (
    SAY,
    microphone_file,
    open_microphone,
    page_with_microphone,
    playing,
    sit_down,
    talk,
)
from seats import contents
from stations import running
from tower_calls import CALLS, SITUATIONS, Seen, scenario_of

OPTIONS = (
    "--seat",
    "tower",
    "--wait-for-seats",
    "--assistant",
    "none",
    "--no-cameras",
    "--no-report",
)
SPOKEN = (
    "cleared-to-land", "immediate-from-hold", "taxi-papa-one-five", "monitor-ground-again",
    "taxi-cross-hold-short", "go-around-vehicle", "go-around-left-turn", "contact-departure",
    "line-up-at-delta", "touch-and-go",
)  # fmt: skip
"""Landing, take-off, taxi, hold short, cross, go around, heading and level, contact, circuit."""
SAYINGS = 3
"""Most times that somebody says the same who is asked to, or whom nobody answers."""
ANSWERED_S = 30.0
SPOKEN_FOR_S = 90.0
"""Time in s that saying it again may take."""
TIME_S = (
    "document.getElementById('time').textContent.split(' ')[0].split(':')"
    ".reduce((minutes, next) => 60 * minutes + Number(next), 0)"
)
STATE = "document.getElementById('state').textContent"
RECOGNISED = (
    "[...document.querySelectorAll('#calls > li')].filter((one) => one.innerText.includes('%'))"
)


def seen_of(call: dict[str, Any], out: Path) -> Seen:
    """Return what the addressee of a call is seen to do from the moment of saying on."""
    log = list(open_run(out).log())
    acts = contents(log, "seat/Washington_Tower/do")
    said = [act["t_ns"] for act in acts if act["act"]["do"] in ("text", "press")]
    first = said[-1 - len(call.get("then", ()))]
    return Seen(log, SITUATIONS[call["situation"]][0], first / SECOND_NS)


def wait_until(page: Page, at_s: float) -> None:
    page.wait_for(f"{STATE} === 'finished' || {TIME_S} >= {at_s}")


def watch_to_end(page: Page) -> None:
    """Wait for the end of the run, which its page outlasts; that is minutes off."""
    while page.evaluate(STATE) != "finished":
        time.sleep(1.0)


def scenario_file(call: dict[str, Any], path: Path, more_s: float) -> Path:
    at_s = SITUATIONS[call["situation"]][2]
    lasts_s = at_s + call["within_s"] + more_s
    scenario = scenario_of(call["situation"], call.get("traffic", ()), lasts_s)
    path.write_text(scenario.model_dump_json(exclude_unset=True))
    return path


@pytest.mark.slow
@pytest.mark.parametrize("call", CALLS, ids=[call["id"] for call in CALLS])
def test_what_is_typed_at_the_seat_of_a_tower_is_done_or_refused(
    call: dict[str, Any], tmp_path: Path
) -> None:
    file, out = scenario_file(call, tmp_path / "call.json", 10.0), tmp_path / "run"
    with (
        running(file, out, *OPTIONS, speech=True) as (_, url),
        page_with_microphone() as page,
    ):
        sit_down(page, url, uses="words")
        for each in (call, *call.get("then", ())):
            page.evaluate(f"document.getElementById('words').value = {each['text']!r}")
            wait_until(page, SITUATIONS[call["situation"]][2] + each.get("after_s", 0.0))
            page.evaluate(SAY)
        watch_to_end(page)
    seen = seen_of(call, out)
    for expected in call["expected"]:
        assert seen.check(**expected), (expected, seen.words)


@pytest.mark.slow
@pytest.mark.parametrize("name", SPOKEN)
def test_what_is_spoken_at_the_seat_of_a_tower_is_done_or_refused_or_asked_about(
    name: str, tmp_path: Path
) -> None:
    """A crew that does not understand it after some sayings still asks, and does nothing of it."""
    call = next(each for each in CALLS if each["id"] == name)
    file, out = scenario_file(call, tmp_path / "call.json", SPOKEN_FOR_S), tmp_path / "run"
    said = playing(microphone_file(tmp_path / "said.wav", call["text"]))
    with (
        running(file, out, *OPTIONS, speech=True) as (_, url),
        page_with_microphone(*said) as page,
    ):
        sit_down(page, url)
        open_microphone(page)
        wait_until(page, SITUATIONS[call["situation"]][2])
        last = ""
        for _ in range(SAYINGS):
            before, now_s = page.evaluate(f"{RECOGNISED}.length"), page.evaluate(TIME_S)
            talk(page)
            until = f"{RECOGNISED}.length >= {before + 2} || {TIME_S} > {now_s + ANSWERED_S}"
            page.wait_for(f"{until} || {STATE} === 'finished'")
            last = str(page.evaluate(f"{RECOGNISED}.at(-1)?.innerText ?? ''")).lower()
            if page.evaluate(f"{RECOGNISED}.length") >= before + 2 and "say again" not in last:
                break
        watch_to_end(page)
    seen = seen_of(call, out)
    if "say again" in last:
        assert seen.asks()
        assert commands_of(SITUATIONS[call["situation"]][0], out) == []
        return
    for expected in call["expected"]:
        assert seen.check(**expected), (expected, seen.words)


def commands_of(callsign: str, out: Path) -> list[dict[str, Any]]:
    """Return what somebody did of the calls of a run."""
    events = contents(list(open_run(out).log()), "truth/event")
    return [each for each in events if (each["kind"], each["subject"]) == ("command", callsign)]
