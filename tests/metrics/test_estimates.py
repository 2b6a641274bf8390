"""Estimates over many runs, and their intervals."""

from __future__ import annotations

import numpy as np
import pytest

from airhilt.metrics.estimates import (
    UNKNOWN,
    Estimate,
    mean_of,
    mean_of_groups,
    median_of,
    rate_of,
    share_of,
)


def test_nothing_is_known_of_no_runs() -> None:
    assert share_of([]) == mean_of([]) == rate_of([], []) == UNKNOWN


@pytest.mark.parametrize("n", range(1, 6))
def test_a_few_runs_have_no_interval_since_theirs_would_be_too_narrow(n: int) -> None:
    assert mean_of(range(n)) == Estimate((n - 1) / 2, None, None, n)
    assert median_of(range(n)) == Estimate((n - 1) / 2, None, None, n)
    assert rate_of([1] * n, [0.5] * n) == Estimate(2.0, None, None, n)
    more = range(6)
    assert None not in (mean_of(more).low, median_of(more).low, rate_of(more, [1.0] * 6).low)


def test_what_did_not_happen_may_still_happen() -> None:
    # Garwood, Biometrika 28 (1936): 3.689 for a count of 0.
    found = rate_of([0, 0], [5.0, 5.0])
    assert found.high == pytest.approx(0.3689, abs=1e-4)
    assert (found.value, found.low, found.n) == (0.0, 0.0, 2)


def test_the_mean_of_many_has_the_interval_of_student() -> None:
    """For 201 values: 1.9719 standard errors on either side."""
    values = [0.0] * 100 + [1.0] * 101
    found, share = mean_of(values), 101 / 201
    half = 1.9719 * np.sqrt(share * (1.0 - share) / 200)
    assert found.low == pytest.approx(share - half, abs=1e-6)
    assert found.high == pytest.approx(share + half, abs=1e-6)


def test_an_estimate_is_told_in_another_unit_with_its_limits() -> None:
    assert Estimate(2.0, 1.0, 4.0, 7).times(60.0) == Estimate(120.0, 60.0, 240.0, 7)
    assert Estimate(2.0, None, None, 1).times(0.5) == Estimate(1.0, None, None, 1)
    assert UNKNOWN.times(3.0) == UNKNOWN


def test_values_of_a_group_count_as_one_in_the_interval_of_their_mean() -> None:
    values = [1.0, 2.0, 5.0, 7.0, 7.0, 9.0]
    groups = [0, 1, 2, 3, 4, 5]
    alone = mean_of_groups(values, groups)
    assert alone == mean_of(values)
    twice = mean_of_groups(values * 2, groups * 2)
    assert (twice.value, twice.n) == (alone.value, 12)
    assert twice.high - twice.low > 0.7 * (alone.high - alone.low)
    few = mean_of_groups(values * 2, [0, 1, 2, 3, 4, 4] * 2)
    assert few == Estimate(alone.value, None, None, 12)


def test_the_interval_of_a_rate_holds_the_true_rate_as_often_as_it_says() -> None:
    random = np.random.default_rng(3)
    hours = np.array([0.5, 1.0, 2.0] * 15)
    samples = [rate_of(random.poisson(2.0 * hours).astype(np.float64), hours) for _ in range(200)]
    held = sum(found.low <= 2.0 <= found.high for found in samples)
    assert 0.88 * 200 < held < 0.99 * 200


def test_a_rate_without_time_is_not_known_and_one_without_an_interval_has_none() -> None:
    assert rate_of([1.0], [0.0]) == UNKNOWN
    assert rate_of([0.0] * 8, [2.0] * 8, with_interval=False) == Estimate(0.0, None, None, 8)
    assert mean_of([1.0] * 3 + [2.0] * 3, with_interval=False) == Estimate(1.5, None, None, 6)
