"""The page of a run that goes on, with all of it in processes of their own."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import psutil
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from airhilt.cosim.replay import replay
from airhilt.record import open_run
from devtools import Page
from microphone import SAY
from stations import answer, do, opened, running, take_seat, wish

PATIENCE_S = 90.0


def page_process(run: subprocess.Popen[str]) -> psutil.Process:
    children = psutil.Process(run.pid).children(recursive=True)
    return next(child for child in children if "view" in child.cmdline())


def listening(url: str, origin: str | None = None, version: str = "") -> ClientConnection:
    given = None if origin is None else Origin(origin)
    place = url.replace("http", "ws") + f"api/live?version={version}"
    opened = connect(place, open_timeout=PATIENCE_S, origin=given, proxy=None)
    assert isinstance(opened, ClientConnection)
    return opened


def how_closed(socket: ClientConnection) -> int:
    """Return the code with which the server closes, and check that it says why."""
    try:
        for _ in socket:
            pass
    except ConnectionClosed:
        pass
    assert socket.close_reason
    return socket.close_code or 0


def states(socket: ClientConnection, most: int = 40) -> set[str]:
    """Return the names of the actors in the next messages that have any."""
    for _ in range(most):
        changes = json.loads(socket.recv(timeout=PATIENCE_S)).get("changes", ())
        if names := {change[1] for change in changes if change[0] == "state"}:
            return names
    return set()


@pytest.mark.slow
def test_the_run_goes_on_when_its_page_is_killed(brief_file: Path, tmp_path: Path) -> None:
    with running(brief_file, tmp_path / "run") as (process, url):
        with listening(url) as socket:
            assert states(socket)
        page_process(process).kill()
        assert process.wait(timeout=PATIENCE_S) == 0
    run = open_run(tmp_path / "run")
    assert run.info.phase == "finished"
    assert not run.info.unregistered_programs
    assert not any(
        logged.key == "truth/event" and b"unregistered" in logged.data for logged in run.log()
    )


def events(out: Path) -> list[dict[str, Any]]:
    messages = open_run(out).log()
    return [json.loads(one.data) for one in messages if one.key == "truth/event"]


@pytest.mark.slow
@pytest.mark.browser
def test_the_page_follows_the_run_until_somebody_goes_back(
    page: Page, encounter_file: Path, tmp_path: Path
) -> None:
    with running(encounter_file, tmp_path / "run", "--share-truth") as (_, url):
        page.open(url)
        page.wait_for("document.querySelectorAll('#traffic tbody tr').length === 2")
        page.wait_for("document.getElementById('state').textContent.startsWith('running')")
        page.wait_for("Number(document.getElementById('slider').value) > 3")
        assert (
            page.evaluate("document.getElementById('live').getAttribute('aria-pressed')") == "true"
        )
        page.press("Home", 36)
        assert page.evaluate("document.getElementById('slider').value") == "0"
        assert (
            page.evaluate("document.getElementById('live').getAttribute('aria-pressed')") == "false"
        )
        page.evaluate("document.getElementById('live').click()")
        page.wait_for(
            "document.getElementById('slider').value === document.getElementById('slider').max"
        )


def selected_altitude_ft(own: Any) -> int | None:
    """Return the selected altitude in what a seat is told; None if it has no instruments."""
    shown = [rest[-1]["selected_altitude_ft"] for kind, *rest in own if kind == "cockpit"]
    return shown[-1] if shown else None


@pytest.mark.slow
def test_a_seat_has_one_person_and_what_it_says_is_said(brief_file: Path, tmp_path: Path) -> None:
    out = tmp_path / "run"
    with running(brief_file, out, "--seat", "AAL123", "--share-truth") as (process, url):
        with opened(url, "own") as own, opened(url, "other") as other:
            assert "take one first" in do(own, "text", text="hello")
            assert do(own, "take", "AAL123") == ""
            assert do(other, "take", "AAL123") == "somebody has the seat AAL123 already"
            assert "take one first" in do(other, "fly", command={"action": "turn", "degrees": 30})
            with pytest.raises(InvalidStatus, match="403"):
                listening(url, origin="http://evil.example")
            with listening(url, version="0") as stale, listening(url) as garbage:
                assert how_closed(stale) == 4426
                wish(garbage, command=1)
                assert how_closed(garbage) == 1008
            assert "not agreed" in do(own, "text", text="hello")
            assert do(own, "agree", uses=["words"]) == ""
            assert do(own, "text", text="Washington Center, American one two three, hello") == ""
            climb = {"action": "altitude", "altitude_ft": 34000}
            assert do(own, "fly", command=climb) == ""
            while selected_altitude_ft(answer(own, "own")) != 34000:
                pass
        page_process(process).kill()
        assert process.wait(timeout=PATIENCE_S) == 0
    messages = list(open_run(out).log())
    acts = [json.loads(one.data)["act"]["do"] for one in messages if one.key == "seat/AAL123/do"]
    # The seat is left with the page that is killed, at the latest.
    assert acts == ["take", "agree", "text", "fly", "leave"]
    assert [one.key for one in messages].count("command/AAL123") == 1
    said = [json.loads(one.data) for one in messages if one.key.startswith("truth/radio/seat.")]
    assert said[0]["text"] == "Washington Center, American one two three, hello"
    refused = [one["text"] for one in events(out) if one["kind"] == "refused"]
    words = ["already", "evil.example", "another version", "of a browser", "not agreed"]
    assert [word in text for word, text in zip(words, refused, strict=True)] == [True] * len(words)
    assert replay(out).identical


@pytest.mark.browser
def test_a_person_takes_a_seat_and_says_what_the_script_has(
    page: Page, encounter_file: Path, tmp_path: Path
) -> None:
    with running(encounter_file, tmp_path / "run", "--seat", "AAL123") as (_, url):
        page.open(url, width=1280, height=720)
        page.wait_for("document.getElementById('state').textContent.startsWith('running')")
        take_seat(page)
        page.wait_for("document.querySelector('#tasks button')")
        page.wait_for("document.getElementById('instruments').textContent.includes('gear up')")
        assert page.evaluate(
            "document.getElementById('say-button').getBoundingClientRect().bottom < innerHeight"
        )
        names = "[...document.querySelectorAll('#traffic tbody th')].map((one) => one.textContent)"
        page.wait_for(f"{names}.sort().join() === 'AAL123,DAL456'")
        words = page.evaluate("document.querySelector('#tasks button').textContent")
        page.evaluate("document.querySelector('#tasks button').click()")
        assert page.evaluate("document.getElementById('words').value") == words
        page.evaluate(SAY)
        page.wait_for("document.querySelector('#calls button')")
        page.wait_for("!document.querySelector('#tasks button')")
