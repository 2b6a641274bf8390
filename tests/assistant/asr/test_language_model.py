"""The language model of calls: likelihoods that sum to one, and what it has seen is likelier."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import learn_language
from airhilt.assistant.asr.language import END, Language

CALLS = [(END, 1, 2, 3, END), (END, 1, 2, 2, END), (END, 2, 3, END), (END, 1, 2, 3, 3, END)] * 3
UNITS = 5


@pytest.fixture
def language(tmp_path: Path) -> Language:
    found = learn_language.tables(learn_language.counts_of(CALLS), UNITS)
    learn_language.write(tmp_path / "language.npz", found)
    return Language(tmp_path / "language.npz", UNITS)


@pytest.mark.parametrize("before", [(END,), (END, 1), (END, 1, 2), (1, 2, 3), (2,), (4,), (4, 4)])
def test_the_likelihoods_of_all_next_pieces_sum_to_one(
    before: tuple[int, ...], language: Language
) -> None:
    total = sum(math.exp(language.score(before, unit)) for unit in range(UNITS))
    assert total == pytest.approx(1.0, abs=2e-3)


def test_what_follows_often_is_likelier(language: Language) -> None:
    assert language.score((END, 1), 2) > math.log(0.7)
    assert language.score((END, 1), 3) < math.log(0.1)


def test_only_the_last_pieces_count(language: Language) -> None:
    assert language.score((3, 3, END, 1, 2), 3) == language.score((END, 1, 2), 3)
