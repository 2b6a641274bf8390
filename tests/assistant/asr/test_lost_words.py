"""A word that was heard and is not written makes those beside it uncertain."""

from __future__ import annotations

import numpy as np
import pytest

from airhilt.assistant.asr.beam_search import HeardUnit
from airhilt.assistant.asr.lost_words import LossCurve, unwritten

UNITS = 4


def posteriors(*heard: float) -> np.ndarray:
    """Return steps in which a piece was heard with these posteriors."""
    steps = np.zeros((len(heard), UNITS), np.float32)
    steps[:, 2] = heard
    steps[:, 0] = 1.0 - steps[:, 2]
    return steps


def words(*places: tuple[int, int]) -> list[list[HeardUnit]]:
    return [[HeardUnit(2, begin, end, begin, 0.9)] for begin, end in places]


def test_what_no_word_has_is_counted_before_each_word_and_behind_the_last() -> None:
    steps = posteriors(0.5, 0.9, 0.0, 0.6, 0.4, 0.9, 0.3)
    assert unwritten(steps, words((1, 2), (5, 6))) == pytest.approx([0.5, 1.0, 0.3])


def test_words_that_follow_each_other_have_nothing_between_them() -> None:
    assert unwritten(posteriors(0.9, 0.9), words((0, 1), (1, 2))) == pytest.approx([0, 0, 0])


def test_a_long_silence_is_nothing_that_was_heard() -> None:
    steps = posteriors(*[0.02] * 20_000, 0.9, *[0.02] * 20_000)
    assert unwritten(steps, words((20_000, 20_001))) == [0.0, 0.0]


def test_all_of_a_call_without_words_is_unwritten() -> None:
    assert unwritten(posteriors(0.5, 0.25), []) == pytest.approx([0.75])


def test_a_word_is_lost_the_likelier_the_more_was_heard() -> None:
    curve = LossCurve(slope=1.3, offset=-1.1)
    lost = [curve(heard) for heard in (0.0, 0.5, 2.0, 8.0)]
    assert lost == sorted(lost)
    assert lost[0] < 0.05 < 0.5 < lost[-1]
