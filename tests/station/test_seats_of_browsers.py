"""Seats of browsers: kept for a short loss of connection, and given back after it."""

from __future__ import annotations

import asyncio
import json
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, suppress

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

from airhilt.messages import SpokenWords
from airhilt.station import browsers, seat_book
from airhilt.station.wishes import Claimed
from stations import PATIENCE_S, TOWER, PretendedRun, agree, answer, browser, seat_page

TWO = (TOWER, TOWER.model_copy(update={"seat": "GROUND"}))


@pytest.fixture(scope="module")
def seat() -> Iterator[tuple[PretendedRun, str]]:
    with seat_page() as seat:
        yield seat


def take(socket: ClientConnection) -> None:
    socket.send(json.dumps({"take": "TOWER"}))


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


def test_what_was_said_while_the_connection_was_lost_is_not_heard_later() -> None:
    with seat_page() as (run, url):
        with browser(url, "one") as own:
            take(own)
            assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)
        run.call_on_air("meanwhile", "AAAA")
        with browser(url, "one") as own:
            own.send(json.dumps({"tune": [119_100]}))
            own.send(json.dumps({"echo": 1.0}))
            heard: list[str] = []
            while "later" not in heard:
                message = json.loads(own.recv(timeout=PATIENCE_S))
                heard += [about["id"] for _, about in message.get("sounds", [])]
                if "echo" in message:
                    run.call_on_air("later", "AAAA")
    assert set(heard) == {"later"}


def test_who_comes_back_before_the_old_connection_has_ended_has_the_seat_when_it_ends() -> None:
    with seat_page() as (run, url), ExitStack() as connection:
        old = connection.enter_context(browser(url, "one"))
        take(old)
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)
        with browser(url, "one") as back, browser(url, "two") as other:
            assert answer(back, "seats") == {"TOWER": "taken"}
            connection.close()
            while answer(back, "seats") != {"TOWER": "yours"}:
                pass
            take(other)
            assert "Somebody has the seat" in str(answer(other, "refused"))
            assert run.presence.empty()


def test_who_has_no_seat_does_not_use_up_what_is_told_of_a_seat() -> None:
    with seat_page() as (run, url), browser(url, "a") as own, browser(url, "b") as other:
        take(own)
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)
        for _ in range(60):
            other.send(json.dumps({"say": {"text": "hello"}}))
            answer(other, "refused")
        own.send(json.dumps({"tune": [120_000]}))
        answer(own, "refused")
    assert "a frequency" in run.told[-1]
    assert "further ones of browsers without a seat are not told" in run.told[-2]
    assert len(run.told) < 30


def test_a_button_that_is_let_go_after_the_seat_was_left_is_not_refused() -> None:
    with seat_page() as (run, url), browser(url, "a") as own:
        take(own)
        agree(own)
        own.send(json.dumps({"press": {}}))
        own.send(PIECE)
        own.send(json.dumps({"leave": "TOWER"}))
        own.send(json.dumps({"release": True}))
        own.send(json.dumps({"say": {"text": "hello"}}))
        assert "no seat" in str(answer(own, "refused"))
        assert run.call()[1] == PIECE
        assert len(run.told) == 1


def test_the_seat_of_who_does_not_come_back_is_given_back_and_all_are_told(
    seat: tuple[PretendedRun, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, url = seat
    monkeypatch.setattr(seat_book, "HOLD_S", 0.1)
    with browser(url, "two") as other:
        with browser(url, "one") as own:
            take(own)
            assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)
        while answer(other, "seats") != {"TOWER": "taken"}:
            pass
        while answer(other, "seats") != {"TOWER": "free"}:
            pass
    assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", False)


def test_a_seat_that_is_lost_again_is_kept_as_long_as_the_first_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with seat_page(PretendedRun(TWO)) as (run, url), ExitStack() as connection:
        other = connection.enter_context(browser(url, "b"))
        with browser(url, "a") as own:
            for socket, seat in ((own, "TOWER"), (other, "GROUND")):
                socket.send(json.dumps({"take": seat}))
                assert run.presence.get(timeout=PATIENCE_S) == (seat, True)
            monkeypatch.setattr(seat_book, "HOLD_S", 2.0)
        with browser(url, "a") as back:
            assert answer(back, "seats") == {"TOWER": "yours", "GROUND": "taken"}
            connection.close()
            answer(back, "seats")  # The seat of the other one is kept from now on.
            monkeypatch.setattr(seat_book, "HOLD_S", PATIENCE_S)
        assert run.presence.get(timeout=PATIENCE_S) == ("GROUND", False)
        with browser(url, "a") as own:
            assert answer(own, "seats") == {"TOWER": "yours", "GROUND": "free"}


def test_who_has_lost_two_seats_has_one_again_and_the_other_is_given_back(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seats = {"TOWER", "GROUND"}
    monkeypatch.setattr(seat_book, "HOLD_S", 2.0)
    with seat_page(PretendedRun(TWO)) as (run, url):
        with browser(url, "a") as first, browser(url, "a") as second:
            for socket, seat in ((first, "TOWER"), (second, "GROUND")):
                socket.send(json.dumps({"take": seat}))
                assert run.presence.get(timeout=PATIENCE_S) == (seat, True)
        with browser(url, "a") as back:
            shown = answer(back, "seats")
            assert isinstance(shown, dict)
            (given_back,) = [seat for seat in seats if shown[seat] == "yours"]
            (expired,) = seats - {given_back}
            assert run.presence.get(timeout=PATIENCE_S) == (expired, False)


def test_who_presses_twice_or_is_refused_another_seat_keeps_the_own_one() -> None:
    with (
        seat_page(PretendedRun(TWO)) as (run, url),
        browser(url, "a") as own,
        browser(url, "b") as other,
    ):
        for socket, seat in ((own, "TOWER"), (other, "GROUND")):
            socket.send(json.dumps({"take": seat}))
            assert run.presence.get(timeout=PATIENCE_S) == (seat, True)
        for seat in ("TOWER", "GROUND"):
            own.send(json.dumps({"take": seat}))
        assert "Somebody has" in str(answer(own, "refused"))
        own.send(json.dumps({"pace": {"factor": 1.0}}))
        assert run.next().factor == 1.0
        assert run.presence.empty()


def test_a_seat_that_somebody_has_at_another_page_is_refused() -> None:
    run = PretendedRun()
    run.elsewhere["TOWER"] = "taken"
    with seat_page(run) as (_, url), browser(url, "a") as own:
        take(own)
        assert "at another page" in str(answer(own, "refused"))
        run.elsewhere.clear()
        take(own)
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)


def test_who_cannot_have_a_seat_that_nobody_has_yet_is_told_to_try_again() -> None:
    run = PretendedRun()
    run.elsewhere["TOWER"] = "claimed"
    with seat_page(run) as (_, url), browser(url, "a") as own:
        take(own)
        refused = str(answer(own, "refused"))
        assert "Somebody has" not in refused
        assert "Try again" in refused


def test_who_moves_to_another_seat_leaves_the_first_one() -> None:
    with seat_page(PretendedRun(TWO)) as (run, url), browser(url, "a") as own:
        for seat in ("TOWER", "GROUND"):
            own.send(json.dumps({"take": seat}))
        told = [run.presence.get(timeout=PATIENCE_S) for _ in range(3)]
        assert told == [("TOWER", True), ("TOWER", False), ("GROUND", True)]


PIECE = bytes(3_200)
"""A piece of sound, of 0.1 s."""


def test_who_is_on_the_air_is_refused_another_seat_and_the_call_goes_on() -> None:
    with seat_page(PretendedRun(TWO)) as (run, url), browser(url, "a") as own:
        take(own)
        agree(own)
        own.send(json.dumps({"press": {}}))
        own.send(PIECE)
        for seat in ("GROUND", "TOWER"):
            own.send(json.dumps({"take": seat}))
        assert "You are on the air" in str(answer(own, "refused"))
        own.send(PIECE)
        own.send(json.dumps({"release": True}))
        assert run.call()[1] == 2 * PIECE
        own.send(json.dumps({"take": "GROUND"}))
        told = [run.presence.get(timeout=PATIENCE_S) for _ in range(3)]
        assert told == [("TOWER", True), ("TOWER", False), ("GROUND", True)]


def test_who_leaves_the_seat_while_on_the_air_ends_the_call() -> None:
    with seat_page(PretendedRun(TWO)) as (run, url), browser(url, "a") as own:
        take(own)
        agree(own)
        own.send(json.dumps({"press": {}}))
        own.send(PIECE)
        own.send(json.dumps({"leave": "TOWER"}))
        assert run.call()[1] == PIECE
        told = [run.presence.get(timeout=PATIENCE_S) for _ in range(2)]
        assert told == [("TOWER", True), ("TOWER", False)]


def test_who_is_on_the_air_keeps_seat_and_call_when_somebody_else_claims_the_seat() -> None:
    with (
        seat_page(PretendedRun(TWO)) as (run, url),
        browser(url, "a") as own,
        browser(url, "b") as other,
    ):
        take(own)
        agree(own)
        own.send(json.dumps({"press": {}}))
        own.send(PIECE)
        while run.done.qsize() < 2:
            time.sleep(0.01)
        take(other)
        assert "Somebody has the seat" in str(answer(other, "refused"))
        own.send(PIECE)
        own.send(json.dumps({"release": True}))
        assert run.call()[1] == 2 * PIECE
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)
        assert run.presence.empty()


class SlowRun(PretendedRun):
    """A run that takes longer to learn that a seat was left than that it was taken."""

    def occupy(self, seat: str, *, is_taken: bool) -> None:
        """Note it after a while."""
        if not is_taken:
            time.sleep(0.3)
        super().occupy(seat, is_taken=is_taken)


def test_the_run_learns_who_has_a_seat_in_the_order_in_which_it_was_taken() -> None:
    run = SlowRun()
    with (
        seat_page(run) as (_, url),
        browser(url, "a") as own,
        browser(url, "b") as other,
    ):
        take(own)
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)
        own.send(json.dumps({"leave": "TOWER"}))
        while (wish := json.dumps({"take": "TOWER"})) and run.presence.empty():
            other.send(wish)
            time.sleep(0.02)
        told = [run.presence.get(timeout=PATIENCE_S) for _ in range(2)]
        assert told == [("TOWER", False), ("TOWER", True)]


class WaitingRun(PretendedRun):
    """A run that learns that a seat was left once it may."""

    def __init__(self) -> None:
        super().__init__(TWO)
        self.is_learning, self.may_learn = threading.Event(), threading.Event()

    def occupy(self, seat: str, *, is_taken: bool) -> None:
        """Note it when it may be."""
        if not is_taken:
            self.is_learning.set()
            self.may_learn.wait(PATIENCE_S)
        super().occupy(seat, is_taken=is_taken)


def test_nobody_gets_the_seat_to_which_somebody_moves() -> None:
    run = WaitingRun()
    with (
        seat_page(run) as (_, url),
        browser(url, "a") as own,
        browser(url, "b") as other,
    ):
        try:
            take(own)
            own.send(json.dumps({"take": "GROUND"}))
            assert run.is_learning.wait(PATIENCE_S)
            answered = answer(other, "seats")
            other.send(json.dumps({"take": "GROUND"}))
            while isinstance(answered, dict):
                assert answered["GROUND"] != "yours"
                message = json.loads(other.recv(timeout=PATIENCE_S))
                answered = message.get("refused", message.get("seats", {"GROUND": ""}))
        finally:
            run.may_learn.set()
        assert "Somebody has the seat GROUND" in str(answered)


def go(run: PretendedRun, leaving: ClientConnection, other: ClientConnection) -> None:
    """Close a page, and wait until its server knows: it does when it sends something."""
    leaving.close()
    run.changes.add("clock", 0.0, "running", "realtime")
    while "seats" not in json.loads(other.recv(timeout=PATIENCE_S)):
        run.changes.add("clock", 0.0, "running", "realtime")


def test_the_run_learns_that_a_seat_was_left_though_the_page_is_closed_meanwhile() -> None:
    run = WaitingRun()
    with seat_page(run) as (_, url), browser(url, "a") as own, browser(url, "b") as other:
        for socket, seat in ((own, "TOWER"), (other, "GROUND")):
            socket.send(json.dumps({"take": seat}))
            assert run.presence.get(timeout=PATIENCE_S) == (seat, True)
        try:
            other.send(json.dumps({"leave": "GROUND"}))
            assert run.is_learning.wait(PATIENCE_S)
            own.send(json.dumps({"leave": "TOWER"}))
            while answer(other, "seats") != {"TOWER": "free", "GROUND": "free"}:
                pass
            go(run, own, other)
        finally:
            run.may_learn.set()
        told = [run.presence.get(timeout=PATIENCE_S) for _ in range(2)]
        assert told == [("GROUND", False), ("TOWER", False)]


def test_the_run_learns_who_has_come_back_to_a_seat_that_was_lost_when_it_was_taken() -> None:
    run = WaitingRun()
    with seat_page(run) as (_, url), browser(url, "a") as own, browser(url, "b") as other:
        other.send(json.dumps({"take": "GROUND"}))
        assert run.presence.get(timeout=PATIENCE_S) == ("GROUND", True)
        try:
            other.send(json.dumps({"leave": "GROUND"}))
            assert run.is_learning.wait(PATIENCE_S)
            take(own)
            while answer(other, "seats") != {"TOWER": "taken", "GROUND": "free"}:
                pass
            go(run, own, other)
            with browser(url, "a") as back:
                assert answer(back, "seats") == {"TOWER": "yours", "GROUND": "free"}
                run.may_learn.set()
                told = [run.presence.get(timeout=PATIENCE_S) for _ in range(2)]
                assert told == [("GROUND", False), ("TOWER", True)]
        finally:
            run.may_learn.set()


class BrokenRun(PretendedRun):
    """A run that cannot be told anything any more."""

    def say(self, seat: str, words: SpokenWords) -> None:
        """Fail.

        Raises
        ------
        OSError
            Always.
        """
        raise OSError("gone")


def test_a_seat_is_free_again_when_its_browser_could_not_be_served(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(seat_book, "HOLD_S", 0.0)
    with seat_page(BrokenRun()) as (run, url), browser(url, "b") as other:
        with browser(url, "a") as own:
            take(own)
            assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)
            agree(own)
            own.send(json.dumps({"say": {"text": "hello"}}))
            with suppress(ConnectionClosed):
                for _ in own:
                    pass
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", False)
        take(other)
        assert run.presence.get(timeout=PATIENCE_S) == ("TOWER", True)


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
    monkeypatch.setattr(seat_book, "HOLD_S", 0.0)
    run = PretendedRun()
    all_of_them = browsers.Browsers(run.changes, run, {"TOWER": run.seat})

    async def serve() -> None:
        await all_of_them.serve(StalledSocket())  # type: ignore[arg-type]
        await asyncio.to_thread(run.presence.get, timeout=PATIENCE_S)
        assert await asyncio.to_thread(run.presence.get, timeout=PATIENCE_S) == ("TOWER", False)

    asyncio.run(serve())


class ClaimedRun(PretendedRun):
    """A run that looks for other pages with a seat until it may give it."""

    def __init__(self) -> None:
        super().__init__()
        self.may_give, self.is_asked_twice = threading.Event(), threading.Event()
        self.waiting = 0
        self.is_claimed = False

    def claim(self, seat: str) -> Claimed:
        """Give the seat when it may be given."""
        self.waiting += 1
        if self.waiting > 1:
            self.is_asked_twice.set()
        assert self.may_give.wait(PATIENCE_S)
        self.waiting -= 1
        self.is_claimed = True
        return "ours"

    def occupy(self, seat: str, *, is_taken: bool) -> None:
        """Withdraw the claim."""
        self.is_claimed = False
        super().occupy(seat, is_taken=is_taken)


def test_a_claim_to_a_seat_is_withdrawn_when_its_browser_is_gone_meanwhile(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(browsers, "STALLED_S", 0.1)
    run = ClaimedRun()
    all_of_them = browsers.Browsers(run.changes, run, {"TOWER": run.seat})

    async def serve() -> None:
        await all_of_them.serve(StalledSocket())  # type: ignore[arg-type]
        run.may_give.set()
        told = await asyncio.to_thread(run.presence.get, timeout=PATIENCE_S)
        assert told == ("TOWER", False)

    asyncio.run(serve())
    assert not run.is_claimed


def test_who_waits_for_a_seat_gets_it_when_another_one_who_claimed_it_before_is_gone() -> None:
    run = ClaimedRun()
    with seat_page(run) as (_, url), browser(url, "a") as own, browser(url, "b") as other:
        try:
            take(own)
            while not run.waiting:
                time.sleep(0.01)
            assert answer(other, "seats") == {"TOWER": "free"}
            take(other)
            assert not run.is_asked_twice.wait(0.5)
            go(run, own, other)
        finally:
            run.may_give.set()
        told = [run.presence.get(timeout=PATIENCE_S) for _ in range(2)]
        assert told == [("TOWER", False), ("TOWER", True)]


def test_who_sits_down_is_not_told_what_was_told_there_before() -> None:
    run = PretendedRun()
    run.seat.add("notice", 1.0, "Nobody is at the seat.")
    run.seat.add("question", 2.0)
    with seat_page(run) as (_, url):
        with browser(url, "a") as own:
            take(own)
            told = answer(own, "own")
            assert isinstance(told, list)
            assert [kind for kind, *_ in told] == ["info", "question"]
            run.seat.add("notice", 3.0, "Unable.")
            assert answer(own, "own") == [["notice", 3.0, "Unable."]]
        with browser(url, "a") as own:
            told = answer(own, "own")
            assert isinstance(told, list)
            assert [change for change in told if change[0] == "notice"] == [
                ["notice", 3.0, "Unable."]
            ]


def test_who_sits_down_late_is_told_of_the_seat_its_open_tasks_and_questions() -> None:
    run = PretendedRun()

    def card(line: str, *, done: bool) -> dict[str, object]:
        return {"line": line, "seat": "TOWER", "t": 1.0, "text": "Hello.", "done": done}

    run.seat.add("task", card("made", done=False))
    run.seat.add("task", card("open", done=False))
    run.seat.add("question", 1, "isa", 1.0)
    run.seat.add("question", 2, "nasa_tlx", 1.0)
    run.seat.add("task", card("made", done=True))
    run.seat.add("answered", 1)
    minutes = 10
    for number in range(minutes * 60 * 5):
        run.seat.add("cockpit", {"number": number})
        run.seat.add("state", "TOWER", number)
    for _ in range(2):  # The second time the page is loaded anew.
        with seat_page(run) as (_, url), browser(url, "a") as own:
            take(own)
            told = answer(own, "own")
            assert isinstance(told, list)
            assert [kind for kind, *_ in told if kind not in ("cockpit", "state")] == [
                "info", "task", "question", "task", "answered",
            ]  # fmt: skip
            assert [change[1] for change in told if change[0] == "cockpit"] == [
                {"number": minutes * 60 * 5 - 1}
            ]
            own.send(json.dumps({"leave": "TOWER"}))


def test_any_person_at_a_seat_may_pause_the_run(seat: tuple[PretendedRun, str]) -> None:
    run, url = seat
    with browser(url, "three") as own:
        take(own)
        own.send(json.dumps({"pace": {"factor": 0.0}}))
        assert run.next().factor == 0.0


def test_nobody_at_a_seat_pauses_a_run_that_has_no_pause() -> None:
    run = PretendedRun([TOWER.model_copy(update={"may_pause": False})])
    with seat_page(run) as (_, url), browser(url, "three") as own:
        take(own)
        for factor in (0.0, 0.5, 1.0):
            own.send(json.dumps({"pace": {"factor": factor}}))
            assert answer(own, "refused") == "This run has no pause and no slow motion."
        agree(own, "words")
        own.send(json.dumps({"say": {"text": "hello"}}))
        assert run.next().text == "hello"


@pytest.mark.parametrize("after_s", ["1e300", "-1e300", "10.1", "-10.1", "NaN", "Infinity"])
@pytest.mark.parametrize(
    "wished",
    [
        '{"heard": {"id": "a", "after_s": %s}}',
        '{"perceived": {"id": "a", "revision": 0, "recipient": "ATC", "way": "heard", '
        '"after_s": %s}}',
    ],
    ids=["heard", "perceived"],
)
def test_a_time_at_which_nothing_can_have_been_audible_is_refused_in_words(
    wished: str, after_s: str
) -> None:
    with seat_page() as (run, url), browser(url, "a") as own:
        take(own)
        own.send(wished % after_s)
        with suppress(ConnectionClosed):
            for _ in own:
                pass
        assert "after_s: Input should be" in (own.close_reason or "")
        assert (run.heard.empty(), run.done.empty()) == (True, True)
        assert "after_s" in run.told[-1]


@pytest.mark.parametrize("after_s", [-10.0, 0.6, 10.0])
def test_a_time_at_which_a_call_can_have_been_audible_is_passed_on(after_s: float) -> None:
    with seat_page() as (run, url), browser(url, "a") as own:
        take(own)
        own.send(json.dumps({"heard": {"id": "a", "after_s": after_s}}))
        assert run.heard.get(timeout=PATIENCE_S).after_s == after_s
