"""The comparison of the guard counts what somebody believes who hears the calls."""

from __future__ import annotations

import pytest

from decisions import transcript
from guard.beliefs import Beliefs

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
