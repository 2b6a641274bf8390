"""The network between a page and its station is cut, and mended again."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from airhilt.station import browsers, server
from cut_network import Network, forgive, through_network
from devtools import Page
from loudspeaker import COUNT_PIECES, PIECES, piece
from microphone import (
    BUTTON,
    microphone_file,
    open_microphone,
    page_with_microphone,
    playing,
    sit_down,
)
from stations import PATIENCE_S, PretendedRun, seat_page, take_seat

pytestmark = pytest.mark.browser
WARNING = (
    "(document.getElementById('link').hidden ? '' : document.getElementById('link').innerText)"
)
HAS_SEAT = "document.getElementById('seat-take').textContent === 'Leave the seat'"


@contextmanager
def seated(microphone: Path) -> Iterator[tuple[PretendedRun, Network, Page]]:
    """A person at the seat of a page behind a network, who speaks."""
    said = playing(microphone_file(microphone, "American one two three, hold position"))
    with (
        seat_page() as (run, url),
        through_network(url) as (network, url_through),
        page_with_microphone(*said) as page,
    ):
        sit_down(page, url_through)
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)
        open_microphone(page)
        press_again(page)
        assert run.next().do == "press"
        yield run, network, page
        forgive(page)


def press_again(page: Page) -> None:
    for kind in ("keyUp", "keyDown"):
        page.key(kind, " ", 32)


def is_heard(run: PretendedRun, page: Page) -> bool:
    """Press the button again, and return true once the run knows it."""
    press_again(page)
    while run.next().do != "press":
        pass
    return True


def test_who_is_cut_off_for_a_moment_is_told_and_keeps_the_seat_and_hears_nothing_later(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "PATIENCE_S", 60.0)
    with seated(tmp_path / "said.wav") as (run, network, page):
        page.key("keyUp", " ", 32)  # Nothing is heard while one transmits.
        page.evaluate(COUNT_PIECES)
        run.call_on_air("before", piece(0.5))
        page.wait_for("window.pieces.length")
        network.cut()
        run.call_on_air("meanwhile", *[piece(0.4)] * 3)
        page.wait_for(f"{WARNING}.includes('nobody hears you')")
        assert page.evaluate(f"{BUTTON} === 'Hold to talk'")
        press_again(page)
        assert "Nobody hears you" in page.evaluate(
            "document.getElementById('talk-state').innerText"
        )
        network.mend()
        page.wait_for(f"{WARNING} === ''")
        assert is_heard(run, page)
        page.key("keyUp", " ", 32)
        run.call_on_air("after", piece(0.3))
        page.wait_for("window.pieces.at(-1) < 0.35")
        assert page.evaluate(PIECES) == [0.5, 0.3]
        assert ("TOWER", False) not in run.presence.queue


@pytest.mark.slow
def test_who_has_the_seat_of_a_server_that_has_ended_is_told_what_becomes_of_it(page: Page) -> None:
    with seat_page() as (_, url):
        sit_down(page, url)
    page.wait_for(f"{WARNING}.includes('your seat may have been given back')")
    forgive(page)


@pytest.mark.slow
def test_the_seat_of_who_stays_away_is_given_back_and_the_page_returns_by_itself(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "PING_S", 0.5)
    monkeypatch.setattr(server, "PATIENCE_S", 1.0)
    monkeypatch.setattr(browsers, "HOLD_S", 0.5)
    with seated(tmp_path / "said.wav") as (run, network, page):
        network.cut()
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", False)
        network.mend()
        page.wait_for(f"{WARNING} === ''")
        # The page wants the seat still, and says so at each connection.
        page.wait_for(HAS_SEAT)
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)


@pytest.mark.slow
def test_a_page_whose_scripts_are_busy_for_longer_than_the_patience_keeps_its_seat(
    page: Page, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "PING_S", 0.2)
    monkeypatch.setattr(server, "PATIENCE_S", 0.6)
    monkeypatch.setattr(browsers, "HOLD_S", 0.1)
    busy = "for (const from = performance.now(); performance.now() - from < 3000;);"
    with seat_page() as (run, url):
        page.open(url)
        page.wait_for("document.getElementById('state').textContent.startsWith('running')")
        take_seat(page)
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)
        page.evaluate(busy)
        run.changes.add("clock", 2.0, "running", "4x")
        page.wait_for("document.getElementById('state').textContent === 'running, 4x'")
        assert page.evaluate(HAS_SEAT)
        assert run.presence.empty()


@pytest.mark.slow
def test_a_connection_that_does_not_end_keeps_the_seat_from_nobody_who_had_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "PATIENCE_S", 600.0)
    with seated(tmp_path / "said.wav") as (run, network, page):
        network.cut()
        page.evaluate("new Promise((done) => setTimeout(done, 9000))")  # It opens another one.
        network.forget()
        network.mend()
        page.wait_for(f"{WARNING} === ''")
        assert is_heard(run, page)
        assert ("TOWER", False) not in run.presence.queue
