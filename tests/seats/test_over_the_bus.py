"""Acts at the seats of a real run, by programs on its bus."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import pytest
import zenoh

from airhilt.bus.seat_client import SeatClient
from airhilt.bus.session import connect_client, find_run, free_endpoint
from airhilt.cosim.observer import Observer, Snapshot
from airhilt.cosim.replay import replay
from airhilt.cosim.simulation import run
from airhilt.messages import (
    AgreeToUses,
    FlyCommand,
    LeaveSeat,
    PressToTalk,
    SayText,
    SayVoice,
    SeatAnswer,
    SeatState,
    SetPace,
)
from airhilt.options import Options
from airhilt.record import Logged, open_run
from seats import acts, calls, contents, tower

TOWER = "Washington Tower"
CHUNK = "Washington_Tower"
WORDS = SayText(text="American one two three, turn left heading two seven zero")
PATIENCE_S = 30.0


class Station:
    """A program beside a run, as an operator."""

    def __init__(self, session: zenoh.Session, prefix: str, endpoint: str) -> None:
        self.session = session
        self.prefix = prefix
        self.endpoint = endpoint

    def client(self, seat: str = TOWER, secret: str | None = None) -> SeatClient:
        return SeatClient(self.session, self.prefix, seat, secret)

    def state(self, seat: str = CHUNK) -> SeatState:
        """Return what the run says of a seat."""
        (reply,) = self.session.get(f"{self.prefix}/seat/{seat}")
        assert reply.ok is not None
        return SeatState.model_validate_json(reply.ok.payload.to_bytes())

    def answer(self, content: bytes) -> str:
        """Return why a query is refused."""
        (reply,) = self.session.get(f"{self.prefix}/seat/{CHUNK}/do", payload=content)
        assert reply.ok is not None
        return SeatAnswer.model_validate_json(reply.ok.payload.to_bytes()).reason

    def wait_for(self, is_so: Callable[[SeatState], bool]) -> None:
        until_s = time.monotonic() + PATIENCE_S
        while not is_so(self.state()):
            assert time.monotonic() < until_s, self.state()
            time.sleep(0.02)


@contextmanager
def beside_a_run(out: Path, **options: Any) -> Iterator[Station]:
    """Let a run with a tower go on in real time until the block ends, and its log be complete."""
    endpoint = free_endpoint()
    ends = threading.Event()
    given = Options(
        out=out, seat=("tower",), pace="realtime", latency="fixed", assistant="none",
        speech=False, report=False, endpoint=endpoint, **options,
    )  # fmt: skip
    thread = threading.Thread(target=_run, args=(given, ends))
    thread.start()
    session = connect_client(endpoint, PATIENCE_S, None, "operator")
    try:
        station = Station(session, find_run(session, PATIENCE_S), endpoint)
        while not list(session.get(f"{station.prefix}/seat/{CHUNK}")):
            time.sleep(0.05)
        yield station
    finally:
        ends.set()
        thread.join()
        session.close()  # type: ignore[no-untyped-call]


def _run(options: Options, ends: threading.Event) -> None:
    class UntilTheEnd(Observer):
        def snapshot(self, snapshot: Snapshot) -> None:
            if ends.is_set():
                raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(tower(120.0), options, UntilTheEnd())


def log_of(out: Path) -> list[Logged]:
    return list(open_run(out).log())


def test_words_are_transmitted_only_of_who_has_the_seat_and_agrees(tmp_path: Path) -> None:
    """A program put text on the bus once, and it was said without anybody asking."""
    out = tmp_path / "run"
    with beside_a_run(out) as station:
        put = station.session.put
        put(f"{station.prefix}/speech/{CHUNK}", json.dumps({"text": "by the back door"}))
        put(f"{station.prefix}/seat/{CHUNK}/do", json.dumps({"text": "by the back door"}))
        with closing(station.client()) as person:
            assert person.act(WORDS) == f"nobody has the seat {TOWER}; take it first"
            assert person.take() == ""
            assert person.act(WORDS) == "you have not agreed to the use of what you type"
            assert person.act(AgreeToUses(uses=("words",))) == ""
            assert person.act(WORDS) == ""
            station.wait_for(lambda state: not state.tasks)  # They stand for the script's call.
    log = log_of(out)
    said = [call["text"] for call in calls(log) if call["speaker"] == TOWER]
    assert said == [WORDS.text]
    told = [one for one in contents(log, "truth/event") if one["kind"] == "refused"]
    assert [one["subject"] for one in told] == [f"seat/{CHUNK}/do"] * 2
    assert not any("two seven zero" in one["text"] or "door" in one["text"] for one in told)
    assert [one["do"] for one in acts(log, CHUNK)] == ["take", "agree", "text", "leave"]
    assert not any("secret" in one and one["secret"] for one in contents(log, f"seat/{CHUNK}/do"))
    verdict = replay(out)
    assert verdict.identical, str(verdict)


def test_a_seat_is_free_again_when_its_holder_is_gone(tmp_path: Path) -> None:
    """The holder goes in the middle of a word, without leaving."""
    with beside_a_run(tmp_path / "run") as station:
        person, other = station.client(), station.client()
        assert person.take() == ""
        assert person.act(AgreeToUses(uses=("voice", "words"))) == ""
        assert other.take() == f"somebody has the seat {TOWER} already"
        person.close()
        station.wait_for(lambda state: state.phase == "left")
        assert station.state().uses == ()
        assert person.act(WORDS).startswith("the liveliness token of the holder has ended")
        assert other.take() == ""
        other.close()


@pytest.mark.parametrize("chunk", [CHUNK, "ELSEWHERE"])
def test_nobody_ends_the_hold_of_another_one_by_a_token_of_the_same_name(
    chunk: str, tmp_path: Path
) -> None:
    with beside_a_run(tmp_path / "run") as station, closing(station.client()) as person:
        assert person.take() == ""
        with closing(connect_client(station.endpoint, PATIENCE_S, None, "operator")) as stranger:
            name = f"{station.prefix}/seat/{chunk}/holder/{person.holder}"
            stranger.liveliness().declare_token(name).undeclare()  # type: ignore[no-untyped-call]
            time.sleep(0.5)
            assert person.act(AgreeToUses(uses=("words",))) == ""
        time.sleep(0.5)
        assert person.act(WORDS) == ""


def test_a_seat_without_a_liveliness_token_is_not_given(tmp_path: Path) -> None:
    with beside_a_run(tmp_path / "run") as station:
        content = {
            "holder": "nobody-declared-it", "secret": "long enough a secret",
            "act": {"do": "take"},
        }  # fmt: skip
        assert "liveliness token" in station.answer(json.dumps(content).encode())


NO_ACTS = {
    b"": "json_invalid",
    b'{"holder": "a", "act": {"do": "dance with secret words"}}': "act: union_tag_invalid",
    b'{"holder": "a", "act": {"do": "say", "pcm": "AAAA"}}': "act/say/pcm",
    b" " * 70_000: "too many acts, or this one is too large",
}
"""Payloads of queries, each with the reason for which it is refused."""


def test_what_is_no_act_is_refused_without_its_words(tmp_path: Path) -> None:
    out = tmp_path / "run"
    with beside_a_run(out) as station:
        for content, reason in NO_ACTS.items():
            assert reason in station.answer(content)
    assert not any(b"secret words" in one.data for one in log_of(out))


def test_a_flood_of_acts_is_refused_and_counted_and_others_are_heard(tmp_path: Path) -> None:
    out = tmp_path / "run"
    with beside_a_run(out) as station:
        flooding, person = station.client("Nobody There"), station.client()
        refused = [flooding.act(LeaveSeat()) for _ in range(400)]
        assert {"there were too many acts, or this one is too large"} < set(refused)
        assert person.take() == ""
        assert person.act(SetPace(factor=0.5)) == ""
        assert person.act(FlyCommand.model_validate({"command": {"action": "go_around"}})) == (
            "the seat of a unit flies and drives nothing"
        )
        assert person.act(PressToTalk()) == "you have not agreed to the use of your voice"
        assert person.act(SayVoice(pcm=b"AAA=")) == "you have not agreed to the use of your voice"
        flooding.close()
        person.close()
    summary = json.loads((out / "summary.json").read_text())
    assert summary["messages_dropped"]["seat/*/do: rate"] > 0
    dropping = "messages on seat/*/do are dropped: more than 100 in a second"
    assert any(dropping.encode() in one.data for one in log_of(out) if one.key == "truth/event")
    of_tower = [call["id"] for call in calls(log_of(out)) if call["speaker"] == TOWER]
    assert set(of_tower) <= {"landing"}  # The script has it if nobody has come by then.
