"""The search weighs the posteriors of pieces against the language model."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from airhilt.assistant.asr.beam_search import BeamSearch, aligned
from airhilt.assistant.asr.language import END, Language, key


def language(folder: Path, bigrams: dict[tuple[int, int], float], units: int = 4) -> Language:
    """Return a model in which some bigrams have a likelihood, and all units are alike elsewhere."""
    ordered = sorted(bigrams.items(), key=lambda each: key(each[0]))
    path = folder / "language.npz"
    np.savez(
        path,
        keys1=np.arange(units, dtype=np.uint64),
        scores1=np.full(units, -np.log(units)),
        backoffs1=np.zeros(units),
        keys2=np.array([key(gram) for gram, _ in ordered], np.uint64),
        scores2=np.log([likelihood for _, likelihood in ordered]),
        backoffs2=np.zeros(len(ordered)),
    )
    return Language(path, units)


def collapsed(units: tuple[int, ...]) -> tuple[int, ...]:
    kept = [unit for at, unit in enumerate(units) if at == 0 or unit != units[at - 1]]
    return tuple(unit for unit in kept if unit)


def likeliest_of_all(posteriors: NDArray[np.float32]) -> tuple[int, ...]:
    """Return the units of the likeliest of all alignments."""
    steps, units = posteriors.shape
    best = max(
        product(range(units), repeat=steps),
        key=lambda path: float(np.prod(posteriors[np.arange(steps), path])),
    )
    return collapsed(best)


def test_without_a_language_model_the_likeliest_alignment_decides(tmp_path: Path) -> None:
    search = BeamSearch(language(tmp_path, {}), 0.0, 0.0, width=500)
    for seed in range(12):
        posteriors = np.random.default_rng(seed).dirichlet(np.full(4, 0.5), 6).astype(np.float32)
        assert search.units(posteriors) == likeliest_of_all(posteriors)


def test_of_two_that_sound_alike_the_usual_one_is_taken(tmp_path: Path) -> None:
    said = np.array([[0.1, 0.9, 0, 0], [0.9, 0.1, 0, 0], [0.1, 0, 0.4, 0.5]], np.float32)
    usual = language(tmp_path, {(1, 2): 0.9, (1, 3): 0.01})
    assert BeamSearch(usual, 0.0, 0.0).units(said) == (1, 3)
    assert BeamSearch(usual, 1.0, 0.0).units(said) == (1, 2)


def test_what_is_clearly_heard_is_kept_though_it_is_unusual(tmp_path: Path) -> None:
    said = np.array([[0.01, 0.99, 0, 0], [0.01, 0, 0.0001, 0.9899]], np.float32)
    usual = language(tmp_path, {(1, 2): 0.9, (1, 3): 0.01})
    assert BeamSearch(usual, 0.5, 0.0).units(said) == (1, 3)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_the_language_model_is_asked_about_as_many_units_before_as_it_knows(
    order: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    call = (1, 2, 3)
    asked: list[tuple[int, ...]] = []

    def score(before: tuple[int, ...], unit: int) -> float:
        asked.append(before)
        return 0.0

    model = language(tmp_path, {})
    monkeypatch.setattr(model, "order", order)
    monkeypatch.setattr(model, "score", score)
    prior = BeamSearch(model, 1.0, 0.0).prior()
    for at, unit in enumerate((*call, END)):
        prior(call[:at], unit)
    expected = [(END, *call)[max(at + 2 - order, 0) : at + 1] for at in range(len(call) + 1)]
    assert asked == expected


def test_a_long_silence_does_not_become_a_word(tmp_path: Path) -> None:
    silence = np.tile(np.array([0.94, 0.02, 0.02, 0.02], np.float32), (1_000, 1))
    assert BeamSearch(language(tmp_path, {}), 0.5, 1.5).units(silence) == ()


def test_each_unit_is_found_where_it_was_said() -> None:
    said = np.full((7, 3), 0.02, np.float32)
    said[:, 0] = 0.96
    for step, unit, posterior in ((1, 1, 0.7), (2, 1, 0.8), (4, 1, 0.8), (5, 2, 0.8)):
        said[step] = 0.1
        said[step, unit] = posterior
    found = aligned(said, (1, 1, 2))
    assert [each.unit for each in found] == [1, 1, 2]
    assert [each.surest for each in found] == [2, 4, 5]
    assert [(each.begin, each.end) for each in found] == [(1, 3), (4, 5), (5, 6)]
    assert [each.posterior for each in found] == pytest.approx([0.8] * 3)
    assert aligned(said, ()) == []
