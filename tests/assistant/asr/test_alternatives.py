"""A piece is the surer the less sense another one would make in its place."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.assistant.asr.beam_search import BLANK, Prior, aligned
from airhilt.assistant.asr.confidences import (
    LARGEST_LOG_ODDS,
    LEAST_POSTERIOR,
    log_odds,
    same_units,
    with_same,
)
from airhilt.assistant.asr.language import END
from airhilt.assistant.asr.pieces import Pieces

GO, NO, AROUND, UNITS = 1, 2, 3, 4
ORDER = 3
LIKELIHOODS = np.random.default_rng(7).uniform(-6.0, 0.0, (UNITS, UNITS, UNITS))


def prior(before: tuple[int, ...], unit: int) -> float:
    """Return how likely a unit follows the last two, which is nothing but a table."""
    first, second = (END, END, *before)[-2:]
    return float(LIKELIHOODS[first, second, unit])


def alike(before: tuple[int, ...], unit: int) -> float:
    return 0.0


def go_before_around(before: tuple[int, ...], unit: int) -> float:
    """Return a likelihood that knows only that "around" comes after "go"."""
    return -6.0 if unit == AROUND and before[-1:] != (GO,) else 0.0


def odds(steps: np.ndarray, units: tuple[int, ...], how_likely: Prior) -> list[float]:
    return log_odds(steps, aligned(steps, units), how_likely, ORDER)


def test_a_word_that_was_heard_badly_is_sure_if_the_next_makes_sense_only_after_it() -> None:
    steps = np.array([[0.1, 0.5, 0.4, 0.0], [0.05, 0.0, 0.05, 0.9]], np.float32)
    alone, _ = odds(steps, (GO, AROUND), alike)
    together, _ = odds(steps, (GO, AROUND), go_before_around)
    assert alone == pytest.approx(0.0, abs=1e-4)
    assert together == pytest.approx(6.0, abs=1e-3)


def test_a_digit_that_may_have_been_said_in_another_way_is_no_less_sure() -> None:
    pieces = Pieces(["_five", "_fife", "_nine", "_niner", "_go"])
    same = same_units(pieces)
    assert same == {1: [2], 2: [1], 3: [4], 4: [3]}
    steps = np.array([[0.0, 0.6, 0.3, 0.1, 0.0, 0.0], [0.0, 0.0, 0.0, 0.2, 0.5, 0.3]], np.float32)
    heard = aligned(steps, (1, 4))
    added, (five, niner) = with_same(steps, heard, same)
    assert (five.posterior, niner.posterior) == (pytest.approx(0.9), pytest.approx(0.7))
    assert added.sum(axis=1) == pytest.approx([1.0, 1.0])
    before, after = (
        log_odds(*each, alike, ORDER) for each in ((steps, heard), (added, [five, niner]))
    )
    assert before == pytest.approx([np.log(0.6 / 0.4), 0.0], abs=1e-3)
    assert after == pytest.approx([np.log(0.9 / 0.1), np.log(0.7 / 0.3)], abs=1e-3)


def test_clear_is_no_other_word_than_cleared() -> None:
    """Before "to land" they sound alike, and the same clearance is read in both."""
    same = same_units(Pieces(["_clear", "_cleared", "_cross"]))
    assert same == {1: [2], 2: [1]}


def test_a_piece_beside_another_may_be_no_more_than_a_longer_one() -> None:
    """Without a blank between them, the same unit twice is one unit."""
    steps = np.array([[0.0, 0.1, 0.0, 0.9], [0.0, 0.55, 0.0, 0.45]], np.float32)

    def never_twice(before: tuple[int, ...], unit: int) -> float:
        return -20.0 if before[-1:] == (unit,) else 0.0

    _, go = odds(steps, (AROUND, GO), never_twice)
    assert go == pytest.approx(np.log(0.55 / 0.45), abs=1e-4)
    go, _ = odds(steps[::-1], (GO, AROUND), never_twice)
    assert go == pytest.approx(np.log(0.55 / 0.45), abs=1e-4)


@given(
    st.lists(st.tuples(st.integers(1, UNITS - 1), st.booleans()), min_size=1, max_size=6),
    st.integers(0, 1000),
)
def test_the_odds_are_those_of_whole_calls_in_which_one_piece_differs(
    said: list[tuple[int, bool]], seed: int
) -> None:
    """Some pieces have a blank behind them, and all equal ones."""
    units = [unit for unit, _ in said]
    spoken: list[int] = []
    steps_of: list[int] = []
    for unit, has_pause in said:
        if spoken[-1:] == [unit]:
            spoken.append(BLANK)
        steps_of.append(len(spoken))
        spoken += [unit, BLANK] if has_pause else [unit]
    rng = np.random.default_rng(seed)
    steps = rng.dirichlet(np.ones(UNITS), len(spoken))
    steps[range(len(spoken)), spoken] += 3.0
    steps = (steps / steps.sum(axis=1, keepdims=True)).astype(np.float32)

    def whole(step: int, other: int) -> float:
        path = [*spoken[:step], other, *spoken[step + 1 :]]
        call = [unit for unit, _ in itertools.groupby(path) if unit != BLANK]
        return float(np.log(steps[step, other])) + sum(
            prior(tuple(call[:at]), unit) for at, unit in enumerate([*call, END])
        )

    for step, found in zip(steps_of, odds(steps, tuple(units), prior), strict=True):
        each = {
            other: whole(step, other)
            for other in range(UNITS)
            if steps[step, other] >= LEAST_POSTERIOR
        }
        own = each.pop(spoken[step])
        against = np.logaddexp.reduce([*each.values(), own - LARGEST_LOG_ODDS])
        assert found == pytest.approx(max(own - against, -LARGEST_LOG_ODDS), abs=1e-4)
