"""Questions of a tower: they are answered, and nothing is done because of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from seats import logged, said
from tower_calls import SITUATIONS, Seen, scenario_of

LATER_S = 20.0
"""Time in s from a question until its answer has been heard, and nothing else has happened."""


def seen_after(situation: str, words: str, folder: Path) -> Seen:
    callsign, _, at_s = SITUATIONS[situation]
    scenario = scenario_of(situation, (), at_s + LATER_S)
    return Seen(
        logged(scenario, folder, ["tower"], [said("Washington_Tower", at_s, words)]),
        callsign,
        at_s,
    )


@pytest.mark.parametrize(
    ("situation", "words", "answer"),
    [
        ("en_route", "say altitude and heading", "eight thousand, heading zero zero one"),
        ("en_route", "say registration and souls on board",
         "unable to say registration or souls on board"),
        ("en_route", "say fuel remaining", "pounds"),
        ("en_route", "say type aircraft", "boeing seven thirty seven"),
        ("final", "Washington Tower, radio check, how do you read",
         "washington tower, american one twenty three, read you five"),
        ("final", "can you accept runway three three", "affirm"),
        ("final", "are you able to maintain one six zero knots", "affirm"),
        ("final", "are you able to maintain two one zero knots", "unable 210 kt, maximum 186 kt"),
        ("holding_short", "confirm you are holding short of runway one",
         "affirmative, holding short of runway one"),
        (
            "at_stand", "confirm you are holding short of runway one",
            "negative, at gate bravo one two",
        ),
        ("final", "verify holding short of runway one five", "negative, 5 miles south"),
        ("en_route", "verify level at six thousand", "eight thousand"),
        ("final", "did you have breakfast", "say again"),
    ],
)  # fmt: skip
def test_a_question_is_answered(situation: str, words: str, answer: str, tmp_path: Path) -> None:
    seen = seen_after(situation, f"American one two three, {words}?", tmp_path / "run")
    assert answer in seen.words


def test_nobody_turns_who_is_asked_whether_it_can(tmp_path: Path) -> None:
    words = "American one two three, can you turn left heading two seven zero?"
    seen = seen_after("en_route", words, tmp_path / "run")
    assert "affirmative" in seen.words
    assert seen.track(1.0)
