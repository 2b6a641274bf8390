"""Estimates over many runs, and their intervals."""

from __future__ import annotations

import numpy as np
import pytest

from airhilt.metrics.estimates import UNKNOWN, Estimate, mean_of, median_of, rate_of, share_of


def test_nothing_is_known_of_no_runs() -> None:
    assert share_of([]) == mean_of([]) == rate_of([], []) == UNKNOWN


def test_a_share_has_the_interval_of_wilson() -> None:
    # Newcombe, Statistics in Medicine 17 (1998), table I: 81 of 263, and 0 of 20.
    found = share_of([True] * 81 + [False] * 182)
    assert (found.low, found.high) == (
        pytest.approx(0.2553, abs=1e-4),
        pytest.approx(0.3662, abs=1e-4),
    )
    assert share_of([False] * 20).high == pytest.approx(0.1611, abs=1e-4)


def test_the_interval_of_a_mean_holds_the_true_mean_as_often_as_it_says() -> None:
    random = np.random.default_rng(1)
    samples = [mean_of(random.exponential(2.0, 40)) for _ in range(200)]
    held = sum(found.low <= 2.0 <= found.high for found in samples)
    assert 0.88 * 200 < held < 0.99 * 200


def test_a_mean_of_many_has_nearly_the_interval_of_a_mean_of_few() -> None:
    random = np.random.default_rng(1)
    few = mean_of(random.normal(0.0, 1.0, 200))
    many = mean_of(random.normal(0.0, 1.0, 201))
    assert many.high - many.low == pytest.approx(few.high - few.low, rel=0.15)


@pytest.mark.parametrize("n", range(1, 6))
def test_a_few_runs_have_no_interval_since_theirs_would_be_too_narrow(n: int) -> None:
    assert mean_of(range(n)) == Estimate((n - 1) / 2, None, None, n)
    assert median_of(range(n)) == Estimate((n - 1) / 2, None, None, n)
    assert rate_of([1] * n, [0.5] * n) == Estimate(2.0, None, None, n)
    more = range(6)
    assert None not in (mean_of(more).low, median_of(more).low, rate_of(more, [1.0] * 6).low)


def test_equal_values_have_an_interval_without_width() -> None:
    assert mean_of([2.0] * 6) == Estimate(2.0, 2.0, 2.0, 6)


def test_a_rate_weighs_runs_by_their_length() -> None:
    found = rate_of([3, 0, 0] * 2, [1.0, 2.0, 3.0] * 2)
    assert found.value == pytest.approx(0.5)
    assert found.low is not None
    assert found.low <= 0.5 <= found.high


def test_what_did_not_happen_may_still_happen() -> None:
    # Garwood, Biometrika 28 (1936): 3.689 for a count of 0.
    assert rate_of([0, 0], [5.0, 5.0]).high == pytest.approx(0.3689, abs=1e-4)


def test_the_same_runs_give_the_same_interval() -> None:
    runs = [1.0, 2.0, 5.0, 7.0, 7.0, 9.0]
    assert mean_of(runs) == mean_of(runs)
    assert mean_of(runs).low is not None


def test_the_interval_of_a_median_holds_the_true_median_as_often_as_it_says() -> None:
    random = np.random.default_rng(2)
    samples = [median_of(random.exponential(2.0, 40)) for _ in range(100)]
    held = sum(found.low <= 2.0 * np.log(2.0) <= found.high for found in samples)
    assert 87 <= held <= 99


def test_a_median_is_known_of_one_run_and_not_of_none() -> None:
    assert median_of([]) == UNKNOWN
    assert median_of([3.0]).value == 3.0
    assert median_of([1.0, 2.0, 9.0]).value == 2.0
