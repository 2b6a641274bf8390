"""The page at the seats of a pilot, a driver and a controller of a run that is only pretended."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from airhilt.messages import SpokenWords
from devtools import Page
from stations import TOWER, PretendedRun, seat_page

pytestmark = pytest.mark.browser
CATEGORIES = {"AAL123": "aircraft", "DAL456": "aircraft", "OPS1": "vehicle"}
KIND = {"TOWER": "controller", "AAL123": "pilot", "OPS1": "driver"}
KEYS = "[...document.querySelectorAll('#help-keys dd')].map((one) => one.textContent)"


@contextmanager
def seated(page: Page, seat: str, pace: str = "realtime") -> Iterator[PretendedRun]:
    """Open the page of a run, take its seat, and yield the run."""
    with seat_page(TOWER.model_copy(update={"seat": seat})) as (run, url):
        run.changes.add("briefing", "TOWER", None, CATEGORIES)
        run.changes.add("clock", 1.0, "running", pace)
        page.open(url, width=1280, height=720)
        page.wait_for("document.getElementById('state').textContent.startsWith('running')")
        page.click("seat-take")
        page.wait_for(f"document.body.dataset.seat === '{KIND[seat]}'")
        page.wait_for("!document.getElementById('talk').hidden")
        page.evaluate("document.activeElement.blur()")
        yield run
        page.open("about:blank")


def commands(run: PretendedRun, page: Page) -> list[str]:
    """Return the actions of the commands that the page has sent so far."""
    page.evaluate("document.getElementById('words').value = 'over'")
    page.evaluate("document.getElementById('say-button').click()")
    actions = []
    while not isinstance(wish := run.next(), SpokenWords):
        actions.append(wish.action)
    return actions


@pytest.mark.parametrize(
    ("seat", "actions"),
    [("TOWER", []), ("OPS1", ["hold_position"]), ("AAL123", ["go_around", "hold_position"])],
)
def test_a_key_of_the_cockpit_does_nothing_at_another_seat(
    page: Page, seat: str, actions: list[str]
) -> None:
    with seated(page, seat) as run:
        for key in "gbsha":
            page.press(key, ord(key.upper()))
            page.evaluate("document.activeElement.blur()")
        assert commands(run, page) == actions


def test_a_key_that_is_held_gives_its_command_once(page: Page) -> None:
    with seated(page, "AAL123") as run:
        for _ in range(3):
            page.call(
                "Input.dispatchKeyEvent",
                type="keyDown", key="g", windowsVirtualKeyCode=71, autoRepeat=_ > 0,
            )  # fmt: skip
        assert commands(run, page) == ["go_around"]


def test_the_list_of_keys_has_those_that_act_at_the_seat(page: Page) -> None:
    with seated(page, "TOWER"):
        page.press("?", 191)
        listed = page.evaluate(KEYS)
        assert "hold to talk" in listed
        assert not {"cockpit: go around", "brake, hold position", "1 s back"} & set(listed)


def test_enter_ticks_a_box_where_the_space_bar_is_to_talk(page: Page) -> None:
    ticked = "document.getElementById('plan-rings').checked"
    with seated(page, "TOWER"):
        page.evaluate("document.getElementById('plan-rings').focus()")
        page.press("Enter", 13)
        assert page.evaluate(ticked) is False
        page.press("Enter", 13)
        assert page.evaluate(ticked) is True
