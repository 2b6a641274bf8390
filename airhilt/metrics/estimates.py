"""Estimates over many runs, each with a 95 % confidence interval by clusters of runs.

Seeds of one scenario are often alike, or the same run. So a cluster is all runs of a scenario; if
there is only one scenario, all runs of a seed. docs/sweep-results.md has the reasons.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

CONFIDENCE = 0.95
FEWEST_CLUSTERS = 3
"""Number of clusters below which a mean or a rate has no interval: Student's t of two is 12.7
standard errors wide on either side."""
RESAMPLES = 1999
"""Resamples of a bootstrap: 2.5 % of one more than their number is whole (Davison and Hinkley,
Bootstrap Methods and their Application, 1997)."""
FEWEST_RESAMPLED = 6
"""Number of clusters below which a bootstrap gives no interval: it stays between the least and the
greatest value, which for n draws are on either side of the median with the probability
1 - 2^(1 - n) only (David and Nagaraja, Order Statistics, 2003, section 7.1): 50 % for 2."""
SEED = 0
"""Seed of every bootstrap, so that the same table gives the same intervals."""
ROUNDING = 1e-9
"""Standard error, relative to the values, below which clusters agree but for rounding."""


@dataclass(frozen=True)
class Estimate:
    """One number over `n` runs, with the limits of its 95 % interval.

    The value is None without runs, the limits if there are too few clusters for an interval.
    """

    value: float | None
    low: float | None
    high: float | None
    n: int

    def times(self, factor: float) -> Estimate:
        """Return the estimate in another unit."""
        value, low, high = (
            None if one is None else one * factor for one in (self.value, self.low, self.high)
        )
        return Estimate(value, low, high, self.n)

    def plus(self, summand: float) -> Estimate:
        """Return the estimate of a number that is greater by a constant."""
        value, low, high = (
            None if one is None else one + summand for one in (self.value, self.low, self.high)
        )
        return Estimate(value, low, high, self.n)

    def within(self, least: float, greatest: float) -> Estimate:
        """Return the estimate with its limits in the range that is possible."""
        low, high = (
            None if one is None else min(max(one, least), greatest) for one in (self.low, self.high)
        )
        return Estimate(self.value, low, high, self.n)


UNKNOWN = Estimate(None, None, None, 0)


def clusters_of(scenarios: Sequence[Any], seeds: Sequence[Any]) -> IntArray:
    """Return the cluster of each run, from 0 on: its scenario; if all have one, its seed."""
    labels = np.asarray(scenarios, dtype=str)
    if len(np.unique(labels)) < 2:
        labels = np.asarray(seeds, dtype=str)
    return np.unique(labels, return_inverse=True)[1].astype(np.int64)


def share_of(
    flags: Sequence[bool] | NDArray[np.bool_],
    clusters: IntArray,
    weights: Sequence[float] | Array | None = None,
) -> Estimate:
    """Return the share of true values by weight, with Wilson's interval (1927) by clusters.

    In place of the number of values it has the `effective_number`.
    """
    values = np.asarray(flags, dtype=np.float64)
    if values.size == 0:
        return UNKNOWN
    heavy = np.ones(values.size) if weights is None else np.asarray(weights, dtype=np.float64)
    share = float(np.average(values, weights=heavy))
    low, high = _wilson(share, effective_number(values, clusters, heavy))
    return Estimate(share, low, high, values.size)


def mean_of(values: Sequence[float] | Array, clusters: IntArray) -> Estimate:
    """Return the mean, with the interval of Student's t over the clusters.

    The interval is None for fewer than `FEWEST_CLUSTERS`, and if all clusters have the same mean.
    """
    sample = np.asarray(values, dtype=np.float64)
    if sample.size == 0:
        return UNKNOWN
    return _ratio(sample, np.ones(sample.size), clusters)


def rate_of(
    counts: Sequence[float] | Array, exposures: Sequence[float] | Array, clusters: IntArray
) -> Estimate:
    """Return a number of events by exposure, with an interval as of `mean_of`, from 0 on.

    Where nothing happened, the upper limit is that of a Poisson count of 0 (Garwood, 1936), in the
    exposure of one run a cluster.
    """
    events = np.asarray(counts, dtype=np.float64)
    whole = np.asarray(exposures, dtype=np.float64)
    total = float(whole.sum())
    if events.size == 0 or total <= 0.0:
        return UNKNOWN
    if not events.any():
        exposure = total * len(np.unique(clusters)) / events.size
        return Estimate(0.0, 0.0, -math.log((1.0 - CONFIDENCE) / 2.0) / exposure, events.size)
    found = _ratio(events, whole, clusters)
    low = None if found.low is None else max(found.low, 0.0)
    return Estimate(found.value, low, found.high, found.n)


def sum_of_ratios(above: Array, below: Array, n: int) -> Estimate:
    """Return the sum of ratios of sums over clusters, with the interval of Student's t.

    The interval is None for fewer than `FEWEST_CLUSTERS`, and if all clusters agree.

    Parameters
    ----------
    above, below
        Sums of each cluster (rows) for each ratio (columns).
    n
        Number of runs.
    """
    whole = below.sum(axis=0)
    if not len(above) or not whole.all():
        return UNKNOWN
    value = float((above.sum(axis=0) / whole).sum())
    error = _error_of_ratios(above, below)
    if len(above) < FEWEST_CLUSTERS or error <= ROUNDING * abs(value):
        return Estimate(value, None, None, n)
    half = _student(len(above)) * error
    return Estimate(value, value - half, value + half, n)


def median_of(values: Sequence[float] | Array, clusters: IntArray) -> Estimate:
    """Return the median, with the interval of a percentile bootstrap over the clusters.

    The interval is None for fewer than `FEWEST_RESAMPLED` clusters.
    """
    from scipy.stats import bootstrap

    sample = np.asarray(values, dtype=np.float64)
    if sample.size == 0:
        return UNKNOWN
    median = float(np.median(sample))
    parts = [sample[clusters == one] for one in np.unique(clusters)]
    if len(parts) < FEWEST_RESAMPLED:
        return Estimate(median, None, None, sample.size)

    def statistic(drawn: IntArray) -> float:
        return float(np.median(np.concatenate([parts[one] for one in drawn])))

    found = bootstrap(
        (np.arange(len(parts)),),
        statistic,
        vectorized=False,
        n_resamples=RESAMPLES,
        confidence_level=CONFIDENCE,
        method="percentile",
        random_state=np.random.default_rng(SEED),
    ).confidence_interval
    return Estimate(median, float(found.low), float(found.high), sample.size)


def effective_number(values: Array, clusters: IntArray, weights: Array | None = None) -> float:
    """Return how many independent values would give the mean of clusters of values as surely.

    It is the variance of the values by the squared standard error of their mean, less what few
    clusters know of that error (Korn and Graubard, Survey Methodology 24, 1998), and at most the
    number of values. If each value is a cluster, or all clusters have the same mean, it is the
    number of clusters.
    """
    from scipy.stats import norm

    heavy = np.ones(values.size) if weights is None else weights
    mean = float(np.average(values, weights=heavy))
    variance = float(np.average((values - mean) ** 2, weights=heavy))
    error = _standard_error(values * heavy, heavy, clusters)
    number = len(np.unique(clusters))
    if number == values.size or error <= ROUNDING:
        return float(number)
    certainty = norm.ppf((1.0 + CONFIDENCE) / 2.0) / _student(number)
    return min(variance / error**2 * float(certainty) ** 2, float(values.size))


def _ratio(above: Array, below: Array, clusters: IntArray) -> Estimate:
    """Return the ratio of two sums, with the interval of Student's t over the clusters."""
    sums_above, sums_below = _by_cluster(above, clusters), _by_cluster(below, clusters)
    return sum_of_ratios(sums_above, sums_below, above.size)


def _standard_error(above: Array, below: Array, clusters: IntArray) -> float:
    return _error_of_ratios(_by_cluster(above, clusters), _by_cluster(below, clusters))


def _by_cluster(numbers: Array, clusters: IntArray) -> Array:
    """Return the sum of numbers in each cluster, as the column of one ratio."""
    numbered = np.unique(clusters, return_inverse=True)[1]
    return np.bincount(numbered, weights=numbers).astype(np.float64)[:, np.newaxis]


def _error_of_ratios(above: Array, below: Array) -> float:
    """Return the standard error of the sum of ratios of sums over clusters that are drawn.

    Cochran, Sampling Techniques, 1977, section 6.4. One cluster has none: it is 0.
    """
    if len(above) < 2:
        return 0.0
    whole = below.sum(axis=0)
    residuals = ((above - above.sum(axis=0) / whole * below) / whole).sum(axis=1)
    return math.sqrt(len(above) / (len(above) - 1) * float((residuals**2).sum()))


def _student(clusters: int) -> float:
    from scipy.stats import t

    return float(t.ppf((1.0 + CONFIDENCE) / 2.0, clusters - 1))


def _wilson(share: float, number: float) -> tuple[float, float]:
    """Return Wilson's interval of a share of a number of values, which need not be whole."""
    from scipy.stats import norm

    z = float(norm.ppf((1.0 + CONFIDENCE) / 2.0))
    middle = share + z**2 / (2.0 * number)
    half = z * math.sqrt(share * (1.0 - share) / number + (z / (2.0 * number)) ** 2)
    whole = 1.0 + z**2 / number
    return max((middle - half) / whole, 0.0), min((middle + half) / whole, 1.0)
