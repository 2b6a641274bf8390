"""Estimates over many runs, each with a 95 % confidence interval."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

CONFIDENCE = 0.95
RESAMPLES = 1999
"""Resamples of a bootstrap: 2.5 % of one more than their number is whole (Davison and Hinkley,
Bootstrap Methods and their Application, 1997)."""
FEWEST_RESAMPLED = 6
"""Number of runs below which a bootstrap gives no interval: it stays between the least and the
greatest value, which for n draws are on either side of the median with the probability
1 - 2^(1 - n) only (David and Nagaraja, Order Statistics, 2003, section 7.1): 50 % for 2."""
MOST_RESAMPLED = 200
"""Number of runs above which Student's t gives the interval of a mean: the mean of so many is close
to normal, and a bootstrap would take memory by the square of their number."""
SEED = 0
"""Seed of every bootstrap, so that the same table gives the same intervals."""


@dataclass(frozen=True)
class Estimate:
    """One number over `n` runs, with the limits of its 95 % interval.

    The value is None without runs, the limits if there are too few runs for an interval.
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


UNKNOWN = Estimate(None, None, None, 0)


def share_of(flags: Sequence[bool] | NDArray[np.bool_]) -> Estimate:
    """Return the share of true values, with the interval of Wilson (1927)."""
    from scipy.stats import binomtest

    n, count = len(flags), int(np.count_nonzero(flags))
    if n == 0:
        return UNKNOWN
    interval = binomtest(count, n).proportion_ci(CONFIDENCE, method="wilson")
    return Estimate(count / n, float(interval.low), float(interval.high), n)


def mean_of(values: Sequence[float] | Array, with_interval: bool = True) -> Estimate:
    """Return the mean, with the interval of a BCa bootstrap over the runs.

    The interval is None for fewer than `FEWEST_RESAMPLED` values, or if none is asked for. For more
    than `MOST_RESAMPLED` it is that of Student's t.
    """
    sample = np.asarray(values, dtype=np.float64)
    if sample.size == 0:
        return UNKNOWN
    mean = float(sample.mean())
    if sample.size < FEWEST_RESAMPLED or not with_interval:
        return Estimate(mean, None, None, sample.size)
    if np.ptp(sample) == 0.0:
        return Estimate(mean, mean, mean, sample.size)
    low, high = _interval_of_mean(sample)
    return Estimate(mean, low, high, sample.size)


def mean_of_groups(values: Sequence[float] | Array, groups: Sequence[int] | IntArray) -> Estimate:
    """Return the mean, with the interval of a bootstrap over groups of values that go together.

    Whole groups are drawn again (Davison and Hinkley, Bootstrap Methods and their Application,
    1997, section 3.8), so that values that depend on each other count as one. Where each value is a
    group it is `mean_of`. The interval is None for fewer than `FEWEST_RESAMPLED` groups. `groups`
    has the number of the group of each value, from 0 on without gaps.
    """
    sample = np.asarray(values, dtype=np.float64)
    counts = np.bincount(np.asarray(groups, dtype=np.int64)).astype(np.float64)
    if counts.size == sample.size:
        return mean_of(sample)
    mean = float(sample.mean())
    if counts.size < FEWEST_RESAMPLED:
        return Estimate(mean, None, None, sample.size)
    sums = np.bincount(np.asarray(groups, dtype=np.int64), weights=sample).astype(np.float64)
    low, high = _interval_of_ratio(sums, counts)
    return Estimate(mean, low, high, sample.size)


def median_of(values: Sequence[float] | Array) -> Estimate:
    """Return the median, with the interval of a percentile bootstrap over the runs.

    The interval is None for fewer than `FEWEST_RESAMPLED` values.
    """
    sample = np.asarray(values, dtype=np.float64)
    if sample.size == 0:
        return UNKNOWN
    median = float(np.median(sample))
    if sample.size < FEWEST_RESAMPLED:
        return Estimate(median, None, None, sample.size)
    low, high = _bootstrap(sample, np.median, "percentile")
    return Estimate(median, low, high, sample.size)


def rate_of(
    counts: Sequence[float] | Array,
    exposures: Sequence[float] | Array,
    with_interval: bool = True,
) -> Estimate:
    """Return a number of events by exposure, with the interval of a bootstrap over the runs.

    Where nothing happened, the upper limit is that of a Poisson count of 0 (Garwood, 1936).
    Otherwise the interval is None for fewer than `FEWEST_RESAMPLED` runs.
    """
    events = np.asarray(counts, dtype=np.float64)
    whole = np.asarray(exposures, dtype=np.float64)
    total = float(whole.sum())
    if events.size == 0 or total <= 0.0:
        return UNKNOWN
    rate = float(events.sum()) / total
    if not with_interval or (events.size < FEWEST_RESAMPLED and rate > 0.0):
        return Estimate(rate, None, None, events.size)
    if rate == 0.0:
        return Estimate(0.0, 0.0, -math.log((1.0 - CONFIDENCE) / 2.0) / total, events.size)
    low, high = _interval_of_ratio(events, whole)
    return Estimate(rate, low, high, events.size)


def of_clusters(sums: Array, statistic: Callable[[Array], Array], n: int) -> Estimate:
    """Return a statistic of sums over clusters, with the interval of a bootstrap over these.

    Parameters
    ----------
    sums
        Of each cluster (row) the sums that the statistic is made of (columns).
    statistic
        Returns its value from the sums over all clusters, in the last axis.
    n
        Number of runs.
    """
    if not n:
        return UNKNOWN
    value = float(statistic(sums.sum(axis=0)))
    if len(sums) < FEWEST_RESAMPLED or math.isnan(value):
        return Estimate(value, None, None, n)
    random = np.random.default_rng(SEED)
    drawn = random.multinomial(len(sums), np.full(len(sums), 1.0 / len(sums)), RESAMPLES)
    tails = (1.0 - CONFIDENCE) / 2.0, (1.0 + CONFIDENCE) / 2.0
    low, high = np.nanquantile(statistic(drawn @ sums), tails)
    return Estimate(value, float(low), float(high), n)


def _interval_of_ratio(above: Array, below: Array) -> tuple[float, float]:
    """Return the interval of the ratio of two sums, by a bootstrap over their parts."""
    random = np.random.default_rng(SEED)
    drawn = random.multinomial(above.size, np.full(above.size, 1.0 / above.size), RESAMPLES)
    tails = (1.0 - CONFIDENCE) / 2.0, (1.0 + CONFIDENCE) / 2.0
    low, high = np.quantile((drawn @ above) / (drawn @ below), tails)
    return float(low), float(high)


def _interval_of_mean(sample: Array) -> tuple[float, float]:
    from scipy.stats import t

    if sample.size <= MOST_RESAMPLED:
        return _bootstrap(sample, np.mean, "BCa")
    error = float(sample.std(ddof=1)) / math.sqrt(sample.size)
    low, high = t.interval(CONFIDENCE, sample.size - 1, float(sample.mean()), error)
    return float(low), float(high)


def _bootstrap(
    sample: Array, statistic: Callable[..., Any], method: Literal["BCa", "percentile"]
) -> tuple[float, float]:
    from scipy.stats import bootstrap

    found = bootstrap(
        (sample,),
        statistic,
        n_resamples=RESAMPLES,
        confidence_level=CONFIDENCE,
        method=method,
        random_state=np.random.default_rng(SEED),
    ).confidence_interval
    return float(found.low), float(found.high)
