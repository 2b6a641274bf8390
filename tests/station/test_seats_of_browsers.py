"""Seats of browsers: kept for a short loss of connection, and given back after it."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from websockets.sync.client import ClientConnection, connect

from airhilt.station import browsers
from stations import PATIENCE_S, PretendedRun, seat_page


@pytest.fixture(scope="module")
def seat() -> Iterator[tuple[PretendedRun, str]]:
    with seat_page() as seat:
        yield seat


@contextmanager
def browser(url: str, identity: str) -> Iterator[ClientConnection]:
    place = f"{url.replace('http', 'ws')}api/live?browser={identity}"
    with connect(place, proxy=None) as socket:
        yield socket


def take(socket: ClientConnection) -> None:
    socket.send(json.dumps({"take": "TOWER"}))


def answer(socket: ClientConnection, kind: str) -> object:
    while kind not in (message := json.loads(socket.recv(timeout=PATIENCE_S))):
        pass
    return message[kind]


def test_who_comes_back_at_once_has_the_seat_again_and_nobody_else_gets_it(
    seat: tuple[PretendedRun, str],
) -> None:
    run, url = seat
    with browser(url, "one") as own:
        take(own)
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)
    with browser(url, "two") as other:
        take(other)
        assert "is kept for" in str(answer(other, "refused"))
    with browser(url, "one") as own:
        assert answer(own, "seats") == {"TOWER": "yours"}
        own.send(json.dumps({"leave": "TOWER"}))
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", False)


def test_the_seat_of_who_does_not_come_back_is_given_back_and_all_are_told(
    seat: tuple[PretendedRun, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, url = seat
    monkeypatch.setattr(browsers, "HOLD_S", 0.1)
    with browser(url, "two") as other:
        with browser(url, "one") as own:
            take(own)
            assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)
        while answer(other, "seats") != {"TOWER": "taken"}:
            pass
        while answer(other, "seats") != {"TOWER": "free"}:
            pass
    assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", False)


class StalledSocket:
    """A connection over which a browser takes a seat, and nothing passes after that."""

    def __init__(self) -> None:
        self.wishes = [json.dumps({"take": "TOWER"})]

    async def accept(self) -> None:
        """Do nothing."""

    async def receive(self) -> dict[str, str]:
        """Return the next wish, and wait for another one in vain."""
        while not self.wishes:
            await asyncio.sleep(1.0)
        return {"type": "websocket.receive", "text": self.wishes.pop()}

    async def send_text(self, text: str) -> None:
        """Wait in vain until the message can be sent."""
        await asyncio.Event().wait()


def test_who_takes_nothing_of_what_is_sent_is_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(browsers, "STALLED_S", 0.1)
    monkeypatch.setattr(browsers, "HOLD_S", 0.0)
    run = PretendedRun()
    all_of_them = browsers.Browsers(run.changes, run, {"TOWER": run.seat})

    async def serve() -> None:
        await all_of_them.serve(StalledSocket())  # type: ignore[arg-type]
        await asyncio.to_thread(run.presence.get, timeout=PATIENCE_S)
        assert await asyncio.to_thread(run.presence.get, timeout=PATIENCE_S) == ("TOWER", False)

    asyncio.run(serve())


def test_any_person_at_a_seat_may_pause_the_run(seat: tuple[PretendedRun, str]) -> None:
    run, url = seat
    with browser(url, "three") as own:
        take(own)
        own.send(json.dumps({"pace": {"factor": 0.0}}))
        assert run.next().factor == 0.0
