"""Statistics of pairs of runs that differ in one thing only."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from airhilt.metrics.estimates import CONFIDENCE, UNKNOWN, Estimate, mean_of


@dataclass(frozen=True)
class McNemar:
    """McNemar's exact test on pairs of yes and no.

    Attributes
    ----------
    only_first, only_second
        Pairs in which only the first, or only the second, is yes.
    p_value
        Probability of so uneven a split, or a more uneven one, if neither were more often yes:
        two-sided, by the binomial distribution (McNemar, 1947; the exact form).
    """

    only_first: int
    only_second: int
    p_value: float


def mcnemar(first: NDArray[np.bool_], second: NDArray[np.bool_]) -> McNemar:
    """Return the test for the pairs of two arrays of equal length."""
    from scipy.stats import binomtest

    only_first = int(np.count_nonzero(first & ~second))
    only_second = int(np.count_nonzero(second & ~first))
    discordant = only_first + only_second
    p_value = float(binomtest(only_first, discordant).pvalue) if discordant else 1.0
    return McNemar(only_first, only_second, p_value)


def mean_difference(
    first: Sequence[float] | NDArray[np.float64], second: Sequence[float] | NDArray[np.float64]
) -> Estimate:
    """Return the mean of second less first, with the interval of a bootstrap over the pairs."""
    return mean_of(np.asarray(second, dtype=np.float64) - np.asarray(first, dtype=np.float64))


def share_difference(first: NDArray[np.bool_], second: NDArray[np.bool_]) -> Estimate:
    """Return the share of second less that of first, with an interval for matched proportions.

    It is Wald's with half a pair added to each of the four kinds of pairs, as it also holds for few
    pairs, and for pairs that are all alike (Agresti and Min, Statistics in Medicine 24, 2005).
    """
    from scipy.stats import norm

    n = len(first)
    if n == 0:
        return UNKNOWN
    only_first = int(np.count_nonzero(first & ~second))
    only_second = int(np.count_nonzero(second & ~first))
    pairs, uneven = n + 2.0, only_second - only_first
    middle = uneven / pairs
    spread = math.sqrt(only_first + only_second + 1.0 - uneven**2 / pairs) / pairs
    half = float(norm.ppf((1.0 + CONFIDENCE) / 2.0)) * spread
    return Estimate(uneven / n, max(middle - half, -1.0), min(middle + half, 1.0), n)
