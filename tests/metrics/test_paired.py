"""Statistics of pairs of runs."""

from __future__ import annotations

import numpy as np
import pytest

from airhilt.metrics.paired import mcnemar, mean_difference


def test_mcnemar_counts_the_pairs_that_differ() -> None:
    first = np.array([True, True, True, False, False])
    second = np.array([True, False, False, True, False])
    found = mcnemar(first, second)
    assert (found.only_first, found.only_second) == (2, 1)


def test_the_exact_test_is_that_of_the_binomial_distribution() -> None:
    # 1 of 10 discordant pairs, two-sided: 2 (C(10,0) + C(10,1)) / 2^10.
    found = mcnemar(np.arange(12) < 1, (np.arange(12) >= 1) & (np.arange(12) < 10))
    assert found.p_value == pytest.approx(22 / 1024)


def test_pairs_that_agree_prove_nothing() -> None:
    assert mcnemar(np.array([True]), np.array([True])).p_value == 1.0


def test_a_difference_that_all_pairs_share_is_sure_whatever_the_spread() -> None:
    random = np.random.default_rng(1)
    first = random.normal(0.0, 100.0, 30)
    found = mean_difference(first, first + random.normal(2.0, 0.1, 30))
    assert found.value == pytest.approx(2.0, abs=0.1)
    assert found.low is not None
    assert found.low > 1.9
