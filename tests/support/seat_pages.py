"""The page at a seat of a run that is only pretended, and what happens in that run."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from pydantic import TypeAdapter

from airhilt.commands import Command
from airhilt.messages import (
    FlyCommand,
    SayText,
    TaskCard,
)
from devtools import Page
from microphone import SAY
from stations import (
    ADVISORY,
    TOWER,
    PretendedRun,
    seat_page,
    take_seat,
)

CATEGORIES = {"AAL123": "aircraft", "DAL456": "aircraft", "OPS1": "vehicle"}
KIND = {"TOWER": "controller", "AAL123": "pilot", "OPS1": "driver"}
INSTRUMENTS = {
    "callsign": "AAL123", "airspeed_kt": 265.0, "mach": 0.78, "altitude_ft": 35000,
    "vertical_speed_fpm": 0, "north": "true", "heading_deg": 90.0, "track_deg": 90.0,
    "ground_speed_kt": 480.0, "pitch_deg": 2.0, "roll_deg": 0.0, "gear": 0.0, "flaps": 0.0,
    "on_ground": False, "mode": "en_route", "radio_height_ft": None,
    "selected_altitude_ft": 35000, "selected_airspeed_kt": 265,
}  # fmt: skip
COMMAND: TypeAdapter[Command] = TypeAdapter(Command)
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


CALL = {
    "id": "c-1", "from": 0.2, "to": 0.8, "frequency_khz": 119_100, "snr_db": None,
    "speaker": None, "addressed": None, "said": None, "blocked_by": [], "transcripts": [],
    "hearings": [], "has_sound": False,
}  # fmt: skip
CARD = TaskCard(
    line="l-1", due_ns=0, addressed="TOWER", frequency_khz=119_100, text="American 123."
)
