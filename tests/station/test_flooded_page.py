"""The page of a run that a program floods: what it keeps has a bound, and it goes on."""

from __future__ import annotations

import time
from typing import Any

import pytest

from airhilt.messages import SayText
from breadth import mostly_slow
from devtools import Page
from microphone import SAY
from stations import PATIENCE_S, PretendedRun, seat_page, take_seat

pytestmark = pytest.mark.browser
CALLS = 200
"""Number of calls that are listed."""
SHOWN = """({
    actors: document.querySelectorAll('#traffic tbody tr').length,
    strips: document.querySelectorAll('.flight-strip').length,
    calls: document.querySelectorAll('#calls > li').length,
    advisories: document.querySelectorAll('#advisories > li').length,
    own: document.querySelectorAll('.own-advisory').length,
    cards: document.querySelectorAll('#tasks > li').length,
    events: document.getElementById('events').options.length,
})"""


def flood(run: PretendedRun, messages: int) -> None:
    """Let a program publish what no run has so much of, all of each kind with other names."""
    evidence: dict[str, Any] = {
        "sources": [], "shares": {}, "note": "", "rules": [], "runway": None,
        "time_to_go_s": None, "time_to_loss_s": None, "radio_ids": [], "camera_ids": [],
        "tracks": [], "inconsistencies": [],
    }  # fmt: skip
    for i in range(messages):
        name, t_s = f"X{i}", i / messages
        place = (t_s, 10.0 * i, 10.0 * i, 1000, [100.0, 0.0], 90.0, False, "")
        run.changes.add("state", name, "aircraft", "", *place)
        camera = {"name": name, "carrier": None, "width_px": 640, "height_px": 360}
        run.changes.add("camera", camera | {"horizontal_fov_deg": 60.0})
        call = {"id": name, "from": t_s, "to": t_s, "frequency_khz": 119_100, "snr_db": None}
        call |= {"speaker": None, "addressed": None, "said": "word " * 100, "blocked_by": []}
        run.changes.add("call", call | {"transcripts": [], "hearings": [], "has_sound": False})
        text = {"recipient": "ATC", "message": "word " * 100, "recommendation": None}
        row = {"t": t_s, "equipment": "", "id": name, "revision": 0, "severity": "WARNING"}
        row |= {"active": True, "kind": "runway_conflict", "traffic": [name], "texts": [text]}
        run.changes.add("advisory", row | {"evidence": evidence})
        run.changes.add("event", {"t": t_s, "kind": "status", "who": name, "text": "", "state": ""})
        run.stream("opened", id=name, frequency_khz=119_100)


@pytest.mark.parametrize("messages", mostly_slow([600, 6_000], 600))
def test_a_flooded_page_shows_the_newest_of_all_and_can_be_used(page: Page, messages: int) -> None:
    with seat_page() as (run, url):
        run.changes.add("briefing", "TOWER", None, {})
        page.open(url, width=1280, height=720)
        page.wait_for("document.getElementById('state').textContent.startsWith('running')")
        take_seat(page)
        page.wait_for("document.body.dataset.seat === 'controller'")
        flood(run, messages)
        run.changes.add("clock", 2.0, "paused", "paused")
        page.wait_for("document.getElementById('state').textContent === 'paused'")
        newest = f"document.querySelector('#strips [data-callsign=X{messages - 1}]')"
        page.wait_for(f"{newest} && document.getElementById('calls').childElementCount > 1")
        shown = page.evaluate(SHOWN)
        most = {
            "actors": 200, "strips": 200, "calls": CALLS, "advisories": 200, "own": 10,
            "cards": 0, "events": 301,
        }  # fmt: skip
        assert {kind: number for kind, number in shown.items() if number > most[kind]} == {}
        page.evaluate("document.getElementById('words').value = 'American 123, hold.'")
        # A page that was flooded may have to connect again, and gives back words that were lost.
        words = None
        until_s = time.monotonic() + PATIENCE_S
        while words is None and time.monotonic() < until_s:
            page.evaluate(SAY)
            done = [run.next() for _ in range(run.done.qsize())]
            words = next((one.text for one in done if isinstance(one, SayText)), None)
            time.sleep(0.05)
        assert words == "American 123, hold."
        assert page.evaluate("document.documentElement.scrollHeight <= innerHeight")
