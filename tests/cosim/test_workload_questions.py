"""Questions about workload that people at seats are asked."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from airhilt.cosim import workload_questions
from airhilt.cosim.replay import replay
from airhilt.cosim.workload_questions import WorkloadQuestions
from airhilt.errors import AirhiltError
from airhilt.messages import Message, NasaTlx, WorkloadAnswer, WorkloadQuestion
from airhilt.sim import Director, Pace, Paused, Priority, RealTime, Virtual
from seats import contents, logged, message, tower

SEAT = "Washington_Tower"
ANSWER = WorkloadAnswer(question=1, nasa_tlx=NasaTlx(**dict.fromkeys(NasaTlx.model_fields, 25)))
SECOND = 1_000_000_000


class Ending:
    """A run that comes to its end after 1 s, with somebody at the tower."""

    def __init__(self, *, is_replay: bool = False, pace: Pace | None = None) -> None:
        self.director = Director(pace or RealTime(1000.0))
        self.asked: list[WorkloadQuestion] = []
        self.taken: list[str] = []
        self.questions = WorkloadQuestions(
            self.director,
            ["Washington Tower"],
            self._publish,
            isa_minutes=None,
            has_tlx=True,
            is_replay=is_replay,
            hold=lambda: self.director.change_pace(Paused()),
            take=self._take,
        )
        self.questions.occupy(SEAT, is_taken=True)
        self.director.at(SECOND, self.questions.end, Priority.OBSERVE)
        self.director.every(SECOND // 10, lambda: None, Priority.PHYSICS)

    def _publish(self, key: str, message: Message, *, raw: bytes | None = None) -> None:
        assert isinstance(message, WorkloadQuestion)
        self.asked.append(message)
        self.when_asked()

    def when_asked(self) -> None:
        """Let the person answer."""
        self.director.post(lambda: self.questions.answer(SEAT, ANSWER))

    def _take(self, key: str, data: bytes) -> None:
        self.taken.append(key)
        self.questions.answer(SEAT, WorkloadAnswer.model_validate_json(data))

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
    ending.when_asked = lambda: ending.director.post(
        lambda: ending.questions.occupy(SEAT, is_taken=False)
    )
    assert ending.run() < SECOND + 100


def test_who_does_not_answer_in_time_is_logged_as_giving_no_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(workload_questions, "PATIENCE_S", 0.01)
    ending = Ending()
    ending.when_asked = lambda: None
    assert ending.run() < SECOND + 100
    assert ending.taken == [f"workload/{SEAT}"]


def test_nobody_is_waited_for_where_time_does_not_pass_as_for_people() -> None:
    ending = Ending(pace=Virtual())
    assert ending.run() == SECOND
    assert not ending.asked


def test_a_replay_asks_and_ends_with_the_recorded_answer() -> None:
    ending = Ending(is_replay=True, pace=Virtual())
    assert ending.run() > SECOND
    assert len(ending.asked) == 1


def sat_down(t_s: float = 0.5) -> Any:
    return message(f"seat/{SEAT}", t_s, is_taken=True)


def test_who_sits_there_is_asked_regularly_and_the_answers_are_in_log_and_summary(
    tmp_path: Path,
) -> None:
    out = tmp_path / "run"
    said = [sat_down(), message(f"workload/{SEAT}", 8.0, question=1, isa=3)]
    log = logged(tower(14.0), out, ["tower"], said, isa_minutes=0.1)
    asked = contents(log, "question/")
    assert [(one["number"], one["t_ns"] / 1e9) for one in asked] == [(1, 6.0), (2, 12.0)]
    (person,) = json.loads((out / "summary.json").read_text())["people"]
    assert [one["rating"] for one in person["workload"]["isa"]] == [3, None]
    assert replay(out).identical


def test_nobody_is_asked_where_nobody_sits(tmp_path: Path) -> None:
    log = logged(tower(14.0), tmp_path / "run", ["tower"], isa_minutes=0.1, nasa_tlx=True)
    assert not contents(log, "question/")


def test_questions_without_a_seat_are_refused(tmp_path: Path) -> None:
    with pytest.raises(AirhiltError, match=r"--nasa-tlx would do nothing without --seat"):
        logged(tower(2.0), tmp_path / "run", [], nasa_tlx=True)


def test_an_answer_before_its_question_or_after_another_one_is_refused(tmp_path: Path) -> None:
    out = tmp_path / "run"
    answers = [
        message(f"workload/{SEAT}", t_s, question=1, isa=isa)
        for t_s, isa in ((2.0, 5), (8.0, 3), (9.0, 4))
    ]
    log = logged(tower(11.0), out, ["tower"], [sat_down(), *answers], isa_minutes=0.1)
    refused = [one for one in contents(log, "truth/event") if one["kind"] == "refused"]
    assert [one["t_ns"] for one in refused] == [2 * SECOND, 9 * SECOND]
    (of_tower,) = json.loads((out / "summary.json").read_text())["people"]
    assert [one["rating"] for one in of_tower["workload"]["isa"]] == [3]
    assert replay(out).identical
