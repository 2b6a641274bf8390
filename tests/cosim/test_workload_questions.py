"""Questions about workload that people at seats are asked."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import pytest

from airhilt.cosim import workload_questions
from airhilt.cosim.replay import replay
from airhilt.cosim.workload_questions import WorkloadQuestions
from airhilt.messages import (
    AnswerQuestion,
    LeaveSeat,
    NasaTlx,
    SeatAct,
    SeatAction,
    SeatState,
    TakeSeat,
    WorkloadQuestion,
)
from airhilt.options import Options
from airhilt.record import Logged
from airhilt.seats import Seats
from airhilt.sim import Director, Pace, Paused, Priority, RealTime, Virtual
from seats import act, logged, once, states, tower

if TYPE_CHECKING:
    from airhilt.cosim.context import RunContext
    from airhilt.cosim.pace_control import PaceControl

SEAT = "Washington_Tower"
DO = f"seat/{SEAT}/do"
ANSWER = AnswerQuestion(question=1, nasa_tlx=NasaTlx(**dict.fromkeys(NasaTlx.model_fields, 25)))
SECOND = 1_000_000_000


class Ending:
    """A run that comes to its end after 1 s, with somebody at the tower.

    It stands for the context of the run, for its router, which takes acts, and for the pace.
    """

    def __init__(self, *, is_replay: bool = False, pace: Pace | None = None) -> None:
        self.director = Director(pace or RealTime(1000.0))
        self.setup = SimpleNamespace(options=Options(nasa_tlx=True))
        self.is_replay = is_replay
        self.router = self
        self.asked: list[WorkloadQuestion] = []
        self.given: list[SeatAct] = []
        state = SeatState(
            seat="Washington Tower", frequencies_khz=(119_100,), tuned_khz=(119_100,),
            recogniser="none", voice_is_recorded=False,
        )  # fmt: skip
        self.seats = Seats([state], self._published, self.director)
        self.questions = WorkloadQuestions(
            cast("RunContext", self), self.seats, cast("PaceControl", self)
        )
        self.seats.open()
        self.act(TakeSeat())
        self.director.at(SECOND, self.questions.end, Priority.OBSERVE)
        self.director.every(SECOND // 10, lambda: None, Priority.PHYSICS)

    def act(self, act: SeatAct) -> None:
        self.heard(DO, SeatAction(holder="somebody", act=act), "unregistered")

    def heard(self, key: str, action: SeatAction, _publisher: str) -> None:
        self.given.append(action.act)
        self.seats.take(key, action, b"")
        self.questions.take(key, action, b"")

    def stand_still(self) -> None:
        self.director.change_pace(Paused())

    def _published(self, _key: str, state: SeatState) -> None:
        if state.question is not None:
            self.asked.append(state.question)
            self.when_asked()

    def when_asked(self) -> None:
        """Let the person answer."""
        self.director.post(lambda: self.act(ANSWER))

    def run(self) -> int:
        """Return when it was over, in ns."""
        self.director.run()
        return self.director.now_ns


def test_the_end_waits_for_the_ratings_and_the_time_stands_still() -> None:
    ending = Ending()
    assert SECOND < ending.run() < SECOND + 100
    assert [one.scale for one in ending.asked] == ["nasa_tlx"]


def test_who_leaves_the_seat_is_not_waited_for() -> None:
    ending = Ending()
    ending.when_asked = lambda: ending.director.post(lambda: ending.act(LeaveSeat()))
    assert ending.run() < SECOND + 100


def test_who_does_not_answer_in_time_is_logged_as_giving_no_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(workload_questions, "PATIENCE_S", 0.01)
    ending = Ending()
    ending.when_asked = lambda: None
    assert ending.run() < SECOND + 100
    assert ending.given[-1] == AnswerQuestion(question=1)


def test_nobody_is_waited_for_where_time_does_not_pass_as_for_people() -> None:
    ending = Ending(pace=Virtual())
    assert ending.run() == SECOND
    assert not ending.asked


def test_a_replay_asks_and_ends_with_the_recorded_answer() -> None:
    ending = Ending(is_replay=True, pace=Virtual())
    assert ending.run() > SECOND
    assert len(ending.asked) == 1


def sat_down(t_s: float = 0.5) -> Any:
    return act(SEAT, t_s, "take")


def asked_at_the_seat(log: list[Logged]) -> list[dict[str, Any]]:
    return once(one["question"] for one in states(log, SEAT) if one["question"])


def test_who_sits_there_is_asked_regularly_and_the_answers_are_in_log_and_summary(
    tmp_path: Path,
) -> None:
    out = tmp_path / "run"
    said = [sat_down(), act(SEAT, 8.0, "answer", question=1, isa=3)]
    log = logged(tower(14.0), out, ["tower"], said, isa_minutes=0.1)
    asked = asked_at_the_seat(log)
    assert [(one["number"], one["asked_ns"] / 1e9) for one in asked] == [(1, 6.0), (2, 12.0)]
    (person,) = json.loads((out / "summary.json").read_text())["people"]
    assert [one["rating"] for one in person["workload"]["isa"]] == [3, None]
    assert replay(out).identical


def test_nobody_is_asked_where_nobody_sits(tmp_path: Path) -> None:
    log = logged(tower(14.0), tmp_path / "run", ["tower"], isa_minutes=0.1, nasa_tlx=True)
    assert not asked_at_the_seat(log)
