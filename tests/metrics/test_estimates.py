"""Estimates over many runs, and their intervals by clusters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.metrics.estimates import (
    UNKNOWN,
    Estimate,
    IntArray,
    clusters_of,
    mean_of,
    median_of,
    rate_of,
    share_of,
)

NONE = np.zeros(0, dtype=np.int64)
SEEDS = 3


def alone(n: int) -> IntArray:
    """Clusters of one run each."""
    return np.arange(n)


def hourly(counts: Sequence[float], clusters: IntArray) -> Estimate:
    """The rate of runs of an hour each."""
    return rate_of(counts, [1.0] * len(counts), clusters)


def width(found: Estimate) -> float:
    assert found.low is not None
    assert found.high is not None
    return found.high - found.low


def test_nothing_is_known_of_no_runs() -> None:
    assert share_of([], NONE) == mean_of([], NONE) == rate_of([], [], NONE) == UNKNOWN
    assert median_of([], NONE) == UNKNOWN
    assert rate_of([1.0], [0.0], alone(1)) == UNKNOWN


def test_runs_of_a_scenario_are_a_cluster_and_in_one_scenario_those_of_a_seed() -> None:
    assert clusters_of(["b", "a", "b"], [0, 0, 1]).tolist() == [1, 0, 1]
    assert clusters_of(["a", "a", "a"], [7, 3, 7]).tolist() == [1, 0, 1]
    assert clusters_of([], []).tolist() == []


@pytest.mark.parametrize("n", range(1, 3))
def test_one_or_two_clusters_give_a_mean_or_a_rate_no_interval(n: int) -> None:
    values, clusters = [1.0, 2.0, 6.0] * 2, np.arange(6) % n
    assert mean_of(values, clusters) == Estimate(3.0, None, None, 6)
    assert hourly(values, clusters) == Estimate(3.0, None, None, 6)
    assert median_of(values, clusters) == Estimate(2.0, None, None, 6)


def test_runs_that_are_clusters_of_their_own_have_the_intervals_of_wilson_and_student() -> None:
    """Wilson: 7 of 10, 0.397 to 0.892. Student: 2.228 standard errors for 11 values."""
    share = share_of([True] * 7 + [False] * 3, alone(10))
    assert (share.low, share.high) == pytest.approx((0.3968, 0.8922), abs=1e-4)
    values = np.arange(11.0)
    half = 2.2281 * values.std(ddof=1) / np.sqrt(11)
    found = mean_of(values, alone(11))
    assert (found.low, found.high) == pytest.approx((5.0 - half, 5.0 + half), abs=1e-3)


def test_what_did_not_happen_may_still_happen() -> None:
    """Garwood, Biometrika 28 (1936): 3.689 for a count of 0; Wilson: 0 of 5 is up to 0.434."""
    found = rate_of([0, 0], [5.0, 5.0], alone(2))
    assert (found.value, found.low, found.high) == (0.0, 0.0, pytest.approx(0.3689, abs=1e-4))
    five = np.repeat(np.arange(5), 4)
    assert share_of([False] * 20, five).high == pytest.approx(0.4345, abs=1e-4)
    assert share_of([True] * 20, five).low == pytest.approx(1 - 0.4345, abs=1e-4)


def test_clusters_that_all_agree_on_a_number_say_nothing_of_its_spread() -> None:
    assert mean_of([0.15] * 8, np.arange(8) // 2) == Estimate(0.15, None, None, 8)


def test_an_estimate_is_told_in_another_unit_with_its_limits() -> None:
    assert Estimate(2.0, 1.0, 4.0, 7).times(60.0) == Estimate(120.0, 60.0, 240.0, 7)
    assert Estimate(2.0, None, None, 1).times(0.5) == Estimate(1.0, None, None, 1)
    assert UNKNOWN.times(3.0) == UNKNOWN


ESTIMATES: dict[str, Callable[[Any, IntArray], Estimate]] = {
    "share": lambda values, clusters: share_of(np.asarray(values) > 5.0, clusters),
    "mean": mean_of,
    "rate": hourly,
}


@pytest.mark.parametrize("kind", ESTIMATES)
@given(
    by_scenario=st.lists(st.integers(0, 10), min_size=6, max_size=12),
    seeds=st.integers(1, 4),
    times=st.integers(2, 5),
)
def test_more_seeds_of_what_only_the_scenario_decides_do_not_narrow_its_interval(
    kind: str, by_scenario: list[int], seeds: int, times: int
) -> None:
    """Copies of runs add nothing: the interval is as wide as before, or wider."""
    few, many = (
        ESTIMATES[kind](
            np.repeat(np.array(by_scenario, dtype=np.float64), n),
            np.repeat(np.arange(len(by_scenario)), n),
        )
        for n in (seeds, seeds * times)
    )
    assert many.value == pytest.approx(few.value)
    if few.low is None:
        assert many.low is None
    else:
        assert width(many) >= width(few) * (1.0 - 1e-9)


def test_more_seeds_of_what_only_the_scenario_decides_do_not_narrow_that_of_a_median() -> None:
    values, scenarios = np.array([1.0, 2.0, 3.0, 5.0, 8.0, 13.0, 21.0]), np.arange(7)
    few = median_of(values, scenarios)
    many = median_of(np.repeat(values, 4), np.repeat(scenarios, 4))
    assert many.value == few.value == 5.0
    assert width(many) >= width(few) > 0.0


def of_clusters(kind: str, number: int, random: np.random.Generator) -> Any:
    """Return values of clusters that differ, with seeds in each that differ too."""
    match kind:
        case "share that the scenario decides":
            return np.repeat(random.random(number) < 0.7, SEEDS)
        case "share":
            likely = random.beta(1.4, 0.6, (number, 1))
            return (random.random((number, SEEDS)) < likely).ravel()
        case "rate":
            rates = random.gamma(4.0, 0.5, (number, 1)) * np.ones((number, SEEDS))
            return random.poisson(rates).astype(np.float64).ravel()
        case _:
            means = random.normal(2.0, 1.0, (number, 1))
            return (means + random.normal(0.0, 0.5, (number, SEEDS))).ravel()


@pytest.mark.parametrize("number", [4, 8, 25])
@pytest.mark.parametrize(
    ("kind", "true", "estimate"),
    [
        ("share that the scenario decides", 0.7, share_of),
        ("share", 0.7, share_of),
        ("rate", 2.0, hourly),
        ("mean", 2.0, mean_of),
    ],
)
def test_the_interval_holds_the_true_number_as_often_as_it_says(
    kind: str, true: float, estimate: Callable[[Any, IntArray], Estimate], number: int
) -> None:
    """In 300 made-up sweeps each; shares of few clusters are held more often."""
    random = np.random.default_rng(5)
    clusters = np.repeat(np.arange(number), SEEDS)
    found = [estimate(of_clusters(kind, number, random), clusters) for _ in range(300)]
    held = np.mean([one.low is not None and one.low <= true <= one.high for one in found])
    assert held >= 0.91
