"""A word that was heard and is not written makes those beside it uncertain."""

from __future__ import annotations

import numpy as np
import pytest

from airhilt.assistant.asr.beam_search import HeardUnit
from airhilt.assistant.asr.confidences import (
    gaps,
)
from airhilt.assistant.asr.language import END

TURN, CLIMB, BREATH, UNITS = 1, 2, 3, 4
ORDER = 3


def posteriors(*heard: float, unit: int = CLIMB) -> np.ndarray:
    """Return steps in which a piece was heard with these posteriors."""
    steps = np.zeros((len(heard), UNITS), np.float32)
    steps[:, unit] = heard
    steps[:, 0] = 1.0 - steps[:, unit]
    return steps


def words(*places: tuple[int, int]) -> list[list[HeardUnit]]:
    return [[HeardUnit(CLIMB, begin, end, begin, 0.9)] for begin, end in places]


def alike(before: tuple[int, ...], unit: int) -> float:
    return 0.0


def no_breath(before: tuple[int, ...], unit: int) -> float:
    """Return a likelihood that knows only that nobody writes breath."""
    return -8.0 if unit == BREATH else 0.0


def heard(steps: np.ndarray, *places: tuple[int, int]) -> list[float]:
    return [each.heard for each in gaps(steps, words(*places), alike, ORDER)]


def test_what_no_word_has_is_counted_before_each_word_and_behind_the_last() -> None:
    steps = posteriors(0.5, 0.9, 0.0, 0.6, 0.4, 0.9, 0.3)
    assert heard(steps, (1, 2), (5, 6)) == pytest.approx([0.5, 1.0, 0.3])


def test_what_would_make_no_sense_there_was_hardly_said_however_well_it_was_heard() -> None:
    steps = posteriors(0.0, 0.6, unit=BREATH)
    steps[0] = [0.1, 0.0, 0.9, 0.0]
    _, sensible = gaps(steps, words((0, 1)), alike, ORDER)
    _, senseless = gaps(steps, words((0, 1)), no_breath, ORDER)
    assert sensible.heard == senseless.heard
    assert senseless.inserted == pytest.approx(sensible.inserted - 8.0)


def test_a_word_that_only_makes_sense_of_the_next_was_likely_lost() -> None:
    """The prior knows that "climb" comes after "turn" alone, and not at the end."""

    def climb_after_turn(before: tuple[int, ...], unit: int) -> float:
        if unit == END:
            return -2.0 if before[-1:] == (TURN,) else 0.0
        return -5.0 if unit == CLIMB and before[-1:] != (TURN,) else 0.0

    steps = posteriors(0.2, 0.0, 0.2, unit=TURN)
    steps[1] = [0.1, 0.0, 0.9, 0.0]
    before, behind = gaps(steps, words((1, 2)), climb_after_turn, ORDER)
    heard_so = np.log(0.2 / 0.8)
    assert before.inserted == pytest.approx(heard_so + 5.0, abs=1e-5)
    assert behind.inserted == pytest.approx(heard_so - 2.0, abs=1e-5)
