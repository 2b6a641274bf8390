"""Statistics of pairs of runs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from airhilt.metrics.paired import mcnemar, mean_difference, share_difference


def alone(pairs: int) -> np.ndarray[Any, np.dtype[np.int64]]:
    """Clusters of one pair each."""
    return np.arange(pairs)


def test_the_exact_test_is_that_of_the_binomial_distribution() -> None:
    # 1 of 10 discordant pairs, two-sided: 2 (C(10,0) + C(10,1)) / 2^10.
    found = mcnemar(np.arange(12) < 1, (np.arange(12) >= 1) & (np.arange(12) < 10), alone(12))
    assert found.p_value == pytest.approx(22 / 1024)


def test_a_difference_that_all_pairs_share_is_sure_whatever_the_spread() -> None:
    random = np.random.default_rng(1)
    first = random.normal(0.0, 100.0, 30)
    found = mean_difference(first, first + random.normal(2.0, 0.1, 30), alone(30))
    assert found.value == pytest.approx(2.0, abs=0.1)
    assert found.low is not None
    assert found.low > 1.9


def test_a_difference_of_shares_has_the_interval_of_agresti_and_min() -> None:
    # 1600 voters are asked twice (Agresti, Categorical Data Analysis, 2002, table 10.1): 150 and 86
    # change their minds. Wald's own interval, which so many pairs leave nearly as it is, is -0.059
    # to -0.021 (section 10.1.1).
    first, second = np.zeros(1600, bool), np.zeros(1600, bool)
    first[:150] = second[150:236] = True
    found = share_difference(first, second, alone(1600))
    assert found.value == pytest.approx(-0.04)
    assert (found.low, found.high) == (
        pytest.approx(-0.0588, abs=1e-3),
        pytest.approx(-0.0212, abs=1e-3),
    )


def test_many_pairs_of_one_cluster_prove_no_more_than_one() -> None:
    first, second, cluster = np.zeros(10, bool), np.ones(10, bool), np.zeros(10, np.int64)
    assert mcnemar(first, second, cluster).p_value == 1.0
    found = share_difference(first, second, cluster)
    one = share_difference(first[:1], second[:1], alone(1))
    assert (found.value, found.low, found.high) == (1.0, one.low, one.high)
    assert one.low is not None
    assert one.low < 0.0


def test_copies_of_pairs_do_not_narrow_the_interval_of_a_difference() -> None:
    first, second = np.arange(12) < 2, np.arange(12) < 7
    once = share_difference(first, second, alone(12))
    thrice = share_difference(np.repeat(first, 3), np.repeat(second, 3), np.repeat(alone(12), 3))
    assert once.low is not None
    assert thrice.low is not None
    assert thrice.low == pytest.approx(once.low, abs=0.1)
    assert thrice.low <= once.low


def test_clusters_of_alike_pairs_have_the_p_of_one_pair_each() -> None:
    once = np.arange(8)
    first, second = once < 1, once >= 2
    expected = mcnemar(first, second, once).p_value
    many = mcnemar(np.repeat(first, 5), np.repeat(second, 5), np.repeat(once, 5))
    assert many.p_value == pytest.approx(expected)


def test_signs_that_are_drawn_come_close_to_all_of_them() -> None:
    once = np.arange(18)
    first, second = once < 4, once >= 4
    expected = mcnemar(first, second, once).p_value
    many = mcnemar(np.repeat(first, 2), np.repeat(second, 2), np.repeat(once, 2))
    assert many.p_value == pytest.approx(expected, abs=0.01)


@pytest.mark.parametrize(
    ("only_first", "only_second", "agree", "p_value"),
    [
        (4, 0, 0, 2 / 16),  # 2 of the 16 ways to give four clusters a sign.
        (0, 4, 0, 2 / 16),
        (4, 0, 3, 2 / 16),  # Clusters that agree prove nothing.
        (3, 1, 0, 10 / 16),
        (2, 2, 1, 1.0),
    ],
)
def test_clusters_are_one_sign_each(
    only_first: int, only_second: int, agree: int, p_value: float
) -> None:
    """Each cluster has two pairs, of which the second one agrees."""
    first = np.array([True] * only_first + [False] * (only_second + agree))
    second = np.array([False] * only_first + [True] * only_second + [False] * agree)
    none = np.zeros(len(first), bool)
    clusters = np.repeat(np.arange(len(first)), 2)
    one, other = (np.column_stack((each, none)).ravel() for each in (first, second))
    assert mcnemar(one, other, clusters).p_value == pytest.approx(p_value)


def test_what_was_seen_is_one_of_the_signs_that_are_drawn() -> None:
    """40 clusters that all differ alike: no draw is as far, and yet chance is not impossible."""
    first = np.tile([True, False], 40)
    found = mcnemar(first, np.zeros(80, bool), np.repeat(np.arange(40), 2))
    assert found.p_value == pytest.approx(1.0 / (2**14 + 1))
