"""Seats of browsers: kept for a short loss of connection, and given back after it."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Iterator
from typing import Any, cast

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

from airhilt.messages import TaskCard, WorkloadQuestion
from airhilt.station import browsers
from stations import PATIENCE_S, TOWER, PretendedRun, answer, browser, do, seat_page, sit

GROUND = TOWER.model_copy(update={"seat": "GROUND"})
PIECE = bytes(2 * 1600)
"""A tenth of a second of sound."""


@pytest.fixture
def seat() -> Iterator[tuple[PretendedRun, str]]:
    with seat_page(PretendedRun((TOWER, GROUND))) as seat:
        yield seat


def until(socket: ClientConnection, kind: str, is_so: Callable[[Any], bool]) -> Any:
    """Return the next message of a kind that is so."""
    while not is_so(found := answer(socket, kind)):
        pass
    return found


def shows(socket: ClientConnection, **seats: str) -> None:
    """Wait until a browser is told that seats are so."""
    until(socket, "seats", lambda told: all(told[one]["is"] == so for one, so in seats.items()))


def closing_of(socket: ClientConnection) -> tuple[int, str]:
    """Return code and reason with which the server closes a connection."""

    def read_all() -> None:
        while True:
            socket.recv(timeout=PATIENCE_S)

    with pytest.raises(ConnectionClosed) as closed:
        read_all()
    assert closed.value.rcvd is not None
    return closed.value.rcvd.code, closed.value.rcvd.reason


def present(run: PretendedRun) -> tuple[str, bool]:
    return run.presence.get(timeout=PATIENCE_S)


def test_who_comes_back_at_once_goes_on_and_nobody_else_gets_the_seat(
    seat: tuple[PretendedRun, str],
) -> None:
    run, url = seat
    with browser(url, "one") as own:
        sit(own)
    with browser(url, "two") as other:
        assert do(other, "take", "TOWER") == "somebody has the seat TOWER already"
    with browser(url, "one") as own:
        shows(own, TOWER="yours")
        assert do(own, "take", "TOWER") == ""  # A page sends all that it wants at each connection.
        assert do(own, "text", text="hello") == ""
        assert do(own, "leave") == ""
    assert run.deeds.count("leave") == 1


def test_the_seat_of_who_does_not_come_back_is_given_back_and_all_are_told(
    seat: tuple[PretendedRun, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, url = seat
    monkeypatch.setattr(browsers, "HOLD_S", 0.1)
    with browser(url, "two") as other:
        with browser(url, "one") as own:
            sit(own)
            assert present(run) == ("TOWER", True)
            shows(other, TOWER="taken")
        shows(other, TOWER="free")
    assert present(run) == ("TOWER", False)


def test_a_new_connection_of_a_page_takes_the_place_of_the_old_one(
    seat: tuple[PretendedRun, str],
) -> None:
    """The network was cut: the old connection has not ended yet."""
    run, url = seat
    with browser(url, "one") as old:
        sit(old)
        with browser(url, "one") as new:
            shows(new, TOWER="yours")
            assert closing_of(old)[0] == browsers.REPLACED
            assert do(new, "text", text="hello") == ""
    assert run.deeds.count("take") == 1


def test_who_moves_to_another_seat_leaves_the_first_one(seat: tuple[PretendedRun, str]) -> None:
    run, url = seat
    with browser(url, "one") as own:
        sit(own)
        assert do(own, "take", "GROUND") == ""
        assert [present(run) for _ in range(3)] == [
            ("TOWER", True), ("GROUND", True), ("TOWER", False),
        ]  # fmt: skip
        assert do(own, "text", text="hello") == "you have not agreed to the use of what you type"


def test_who_is_refused_another_seat_keeps_the_own_one(seat: tuple[PretendedRun, str]) -> None:
    _, url = seat
    with browser(url, "one") as own, browser(url, "two") as other:
        sit(own)
        sit(other, "GROUND")
        assert do(own, "take", "GROUND") == "somebody has the seat GROUND already"
        assert do(own, "take", "NOWHERE") == "NOWHERE is no seat of this page"
        assert do(own, "text", text="hello") == ""


def test_who_is_gone_while_on_the_air_ends_the_call(seat: tuple[PretendedRun, str]) -> None:
    run, url = seat
    with browser(url, "one") as own:
        sit(own)
        assert do(own, "press") == ""
        own.send(PIECE)
        assert do(own, "perceive", id="a", revision=0, recipient="TOWER", way="seen") == ""
    assert [run.next().do for _ in range(4)] == ["press", "say", "perceive", "release"]


def test_sound_that_is_refused_is_told_once_a_call(seat: tuple[PretendedRun, str]) -> None:
    run, url = seat
    with browser(url, "one") as own:
        sit(own)
        assert do(own, "press") == ""
        run.seats.cut("TOWER", "Your call was cut after 60 s.")
        own.send(PIECE)
        own.send(PIECE)
        assert answer(own, "cut") == "your call was cut"
        assert do(own, "press") == ""
        own.send(PIECE)
        assert do(own, "release") == ""
    assert [act.do for act in run.done.queue] == ["press", "press", "say", "release"]


def test_what_was_said_while_the_connection_was_lost_is_not_heard_later(
    seat: tuple[PretendedRun, str],
) -> None:
    run, url = seat
    with browser(url, "one") as own:
        sit(own)
    run.call_on_air("meanwhile", "AAAA")
    with browser(url, "one") as own:
        own.send(json.dumps({"echo": 1.0}))
        heard: list[str] = []
        while "later" not in heard:
            message = json.loads(own.recv(timeout=PATIENCE_S))
            heard += [about["id"] for _, about in message.get("sounds", [])]
            if "echo" in message:
                run.call_on_air("later", "AAAA")
    assert set(heard) == {"later"}


def test_who_sits_down_late_is_told_all_of_the_seat_and_nothing_of_the_last_person(
    seat: tuple[PretendedRun, str],
) -> None:
    run, url = seat
    with browser(url, "one") as own:
        sit(own)
        run.seats.notify("TOWER", "This is for the first person.")
        run.seats.add_task(
            "TOWER",
            TaskCard(line="due", due_ns=0, addressed="AAL1", frequency_khz=119_100, text="climb"),
        )
        assert do(own, "leave") == ""
    with browser(url, "two") as late:
        assert do(late, "take", "TOWER") == ""
        run.seats.ask("TOWER", WorkloadQuestion(number=1, scale="isa", asked_ns=10**9))
        own_state = until(late, "own", lambda told: told[0][1]["question"] is not None)[0][1]
    assert [card["line"] for card in own_state["tasks"]] == ["due"]
    assert own_state["question"]["t"] == 1.0
    assert own_state["notice"] is None
    assert own_state["uses"] == []


def test_a_seat_of_another_browser_is_shown_as_taken_with_nothing_else(
    seat: tuple[PretendedRun, str],
) -> None:
    _, url = seat
    with browser(url, "one") as own, browser(url, "two") as other:
        sit(own)
        told = until(other, "seats", lambda told: told["TOWER"]["is"] == "taken")
        other.send(json.dumps({"echo": 1.0}))
        while "echo" not in (message := json.loads(other.recv(timeout=PATIENCE_S))):
            assert "own" not in message
    assert told["TOWER"] == {"is": "taken", "recorded": True}


def test_who_has_no_seat_is_refused_in_words(seat: tuple[PretendedRun, str]) -> None:
    _, url = seat
    with browser(url, "one") as stranger:
        for act in ({"text": "hello"}, {"factor": 0.0}):
            name = "text" if "text" in act else "pace"
            assert do(stranger, name, **act) == "you have no seat; take one first"


@pytest.mark.parametrize("message", [{}, {"act": {"do": "dance"}}, {"watch": "a/b"}])
def test_what_is_no_message_ends_the_connection_with_the_reason(
    seat: tuple[PretendedRun, str], message: Any
) -> None:
    run, url = seat
    with browser(url, "one") as socket:
        socket.send(json.dumps(message))
        code, reason = closing_of(socket)
    assert code == browsers.POLICY_VIOLATION
    assert reason
    assert "refused a message of a browser" in run.told[0]


class Frozen:
    """A connection that takes nothing of what is sent."""

    async def accept(self) -> None: ...

    async def close(self, *_: Any) -> None: ...

    async def send_text(self, _: str) -> None:
        await asyncio.sleep(PATIENCE_S)

    async def receive(self) -> dict[str, str]:
        await asyncio.sleep(PATIENCE_S)
        return {"type": "websocket.disconnect"}


def test_who_takes_nothing_of_what_is_sent_is_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(browsers, "STALLED_S", 0.05)
    run = PretendedRun()
    served = browsers.Browsers(run.changes, cast(Any, run), run.views, run.sounds, print)

    async def serve() -> None:
        await asyncio.wait_for(served.serve(cast(Any, Frozen()), 0, "one", "", None), 5.0)

    asyncio.run(serve())
    assert served.has_been_empty(0.0)
