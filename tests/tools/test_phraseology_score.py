"""The score of a corpus counts what is right, wrong and invented, with every value."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import phraseology_judge
from phraseology_judge.score import Score, score

ROSTER = ["DAL456", "UAL12", "N172SP"]


def item(kind: str, value: Any = None, **more: Any) -> dict[str, Any]:
    nothing = {"unit": None, "manner": None, "begins": None, "ends": None}
    return {"kind": kind, "value": value, "status": "now", **nothing, **more}


def scored(text: str, *items: dict[str, Any], callsign: str | None = "DAL456") -> Score:
    line = {"text": text, "roster": ROSTER, "callsign": callsign, "items": list(items)}
    return score([line])


HEADING = item("heading", 270, unit="deg", manner="left")
TURN = "delta four five six turn left heading two seven zero"


def test_an_instruction_is_right_with_all_its_values() -> None:
    counts = scored(TURN, HEADING)
    assert (counts.items, counts.items_right, counts.wrong_and_confident) == (1, 1, 0)
    assert counts.callsign_right == 1


@pytest.mark.parametrize("truth", [{"value": 280}, {"manner": "right"}, {"manner": None}])
def test_an_instruction_with_another_value_is_wrong_and_confident(truth: dict[str, Any]) -> None:
    counts = scored(TURN, {**HEADING, **truth})
    assert (counts.items_right, counts.wrong_and_confident) == (0, 1)


@pytest.mark.parametrize("status", ["request", "withdrawn", "conditional"])
def test_what_is_not_in_effect_may_not_be_read_as_if_it_were(status: str) -> None:
    begins = "after departure" if status == "conditional" else None
    counts = scored(TURN, {**HEADING, "status": status, "begins": begins})
    assert (counts.items_right, counts.wrong_and_confident) == (0, 1)


def test_what_a_pilot_reports_may_be_read_and_is_not_counted() -> None:
    counts = scored(TURN, {**HEADING, "status": "report"})
    assert (counts.items, counts.wrong_and_confident) == (0, 0)


def test_a_clearance_without_truth_is_invented() -> None:
    counts = scored("delta four five six runway two seven cleared to land")
    assert (counts.invented, counts.invented_and_confident) == (1, 1)


def test_a_wrong_callsign_is_wrong_and_confident() -> None:
    counts = scored(TURN, HEADING, callsign="UAL12")
    assert (counts.callsign_right, counts.wrong_callsigns, counts.wrong_and_confident) == (0, 1, 1)


def test_kinds_out_of_scope_are_listed_and_not_missed() -> None:
    counts = scored("delta four five six information bravo", item("atis", "B"))
    assert (counts.items, counts.out_of_scope["atis"]) == (0, 1)


def test_a_call_is_acted_upon_if_what_it_says_was_heard_with_confidence() -> None:
    line = {"text": TURN, "roster": ROSTER, "callsign": "DAL456", "items": [HEADING]}
    words = len(TURN.split())
    sure = score([line | {"word_confidences": [0.95] * words}])
    doubtful = score([line | {"word_confidences": [0.5] * words}])
    assert (sure.acted_upon, sure.acted_upon_wrongly) == (1, 0)
    assert (doubtful.items_right, doubtful.acted_upon) == (1, 0)


def test_a_call_is_acted_upon_wrongly_if_something_else_was_said() -> None:
    counts = scored(TURN, {**HEADING, "value": 280})
    assert (counts.acted_upon, counts.acted_upon_wrongly) == (1, 1)


def test_of_calls_as_people_make_them_no_clearance_is_invented_with_confidence() -> None:
    corpus = Path(phraseology_judge.__file__).parent / "colloquial.jsonl"
    counts = score(json.loads(line) for line in corpus.read_text().splitlines())
    assert counts.calls == 200
    assert counts.wrong_callsigns == 0
    assert counts.invented_and_confident == 0


def test_what_the_vocabulary_has_no_kind_for_is_wrong_and_shown_apart() -> None:
    onto = "proceed onto runway two seven"
    counts = scored(f"delta four five six {onto}")
    assert (counts.wrong_and_confident, counts.only_unnamed) == (1, 1)
    counts = scored(f"delta four five six turn left heading two seven zero {onto}")
    assert (counts.wrong_and_confident, counts.only_unnamed) == (1, 0)


@pytest.mark.parametrize("status", ["report", "information"])
def test_wildlife_is_to_be_read_whoever_tells_of_it(status: str) -> None:
    seen = item("wildlife", "27", status=status)
    counts = scored("delta four five six caution deer on runway two seven", seen)
    assert (counts.items, counts.items_right, counts.wrong_and_confident) == (1, 1, 0)
    other = item("wildlife", "09", status=status)
    counts = scored("delta four five six caution deer on runway two seven", other)
    assert (counts.items_right, counts.wrong_and_confident) == (0, 1)


@pytest.mark.parametrize("status", ["now", "conditional"])
def test_a_level_at_the_pilots_discretion_is_right_in_both_ways_to_write_it(status: str) -> None:
    begins = "at pilot's discretion" if status == "conditional" else None
    level = item("altitude", 6000, status=status, unit="ft", manner="descend", begins=begins)
    text = "delta four five six descend at pilot's discretion maintain six thousand"
    counts = scored(text, level)
    assert (counts.items_right, counts.wrong_and_confident) == (1, 0)
