"""Crashes in a row with one cause end a sweep."""

from __future__ import annotations

import pytest

from airhilt.sweep.crashes import SAME_CRASHES, Crashes
from airhilt.sweep.outcome import Outcome
from fake_dask import outcome

FULL = "log.mcap: cannot be written any more: No space left on device"


def are_enough(*outcomes: Outcome) -> bool:
    crashes = Crashes()
    for each in outcomes:
        crashes.add(each)
    return crashes.are_enough


def crashed(cause: str = FULL, count: int = SAME_CRASHES) -> list[Outcome]:
    return [outcome(str(number), "crashed", cause) for number in range(count)]


def test_one_cause_again_and_again_is_enough() -> None:
    assert are_enough(*crashed())
    assert not are_enough(*crashed(count=SAME_CRASHES - 1))


def test_a_cause_may_tell_where_and_which() -> None:
    assert are_enough(
        *(outcome("k", "crashed", f"workers died, tcp://w:{port}") for port in range(SAME_CRASHES))
    )


@pytest.mark.parametrize(
    "between",
    [outcome("k", "over_time", FULL), outcome("k", "crashed", "its process ended")],
)
def test_anything_else_in_between_is_a_new_beginning(between: Outcome) -> None:
    half = crashed(count=SAME_CRASHES - 1)
    assert not are_enough(*half, between, *half)


def test_runs_that_fail_by_themselves_go_on() -> None:
    assert not are_enough(*(outcome("k", "failed", FULL) for _ in range(2 * SAME_CRASHES)))
