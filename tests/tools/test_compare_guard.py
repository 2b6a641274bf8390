"""The comparison of the guard counts what somebody believes who hears the calls."""

from __future__ import annotations

import pytest

from decisions import transcript
from guard.beliefs import Beliefs, wrong

RIGHT = ("AAL123", "cleared_to_land", "01")


@pytest.mark.parametrize(
    ("tau_asr", "text", "held"),
    [
        (0.8, "American one two three, runway zero one, cleared to land.", {RIGHT}),
        (0.8, "American one two three, runway zero? one, cleared to land.", set()),
        (0.0, "American one two three, runway zero? one, cleared to land.", {RIGHT}),
    ],
)
def test_a_belief_is_what_is_certain_enough(
    tau_asr: float, text: str, held: set[tuple[str, str, str]]
) -> None:
    beliefs = Beliefs(tau_asr, ["AAL123"])
    beliefs.take(transcript("1", 119100, 0, 1, text))
    assert beliefs.held == held


def test_a_belief_with_another_runway_is_wrong_and_one_without_a_runway_is_not() -> None:
    other, bare = ("AAL123", "cleared_to_land", "19"), ("AAL123", "cleared_to_land", "")
    assert wrong({other, bare}, {RIGHT}) == {other}
    assert wrong({bare}, set()) == {bare}
