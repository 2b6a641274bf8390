"""Statistics of pairs of runs that differ in one thing only."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from airhilt.metrics.estimates import CONFIDENCE, UNKNOWN, Estimate, mean_of_groups

MOST_FLIPPED = 14
"""Number of groups up to which all signs are tried; above, as many are drawn as 14 groups have."""
SIGNS_SEED = 0


@dataclass(frozen=True)
class McNemar:
    """McNemar's exact test on pairs of yes and no, with the pairs in which only one is yes.

    `p_value` is the probability of so uneven a split, or a more uneven one, if neither were more
    often yes, two-sided. Pairs that are independent: by the binomial distribution (McNemar, 1947;
    the exact form). Groups of pairs that go together: by changing the sides of whole groups, which
    for groups of one pair is the same.
    """

    only_first: int
    only_second: int
    p_value: float


def mcnemar(
    first: NDArray[np.bool_], second: NDArray[np.bool_], groups: NDArray[np.int64]
) -> McNemar:
    """Return the test for the pairs of two arrays of equal length.

    `groups` has the number of the group of each pair, from 0 on without gaps.
    """
    from scipy.stats import binomtest

    only_first = int(np.count_nonzero(first & ~second))
    only_second = int(np.count_nonzero(second & ~first))
    discordant = only_first + only_second
    if not discordant:
        return McNemar(only_first, only_second, 1.0)
    if _are_alone(groups):
        p_value = float(binomtest(only_first, discordant).pvalue)
    else:
        uneven = second.astype(np.float64) - first.astype(np.float64)
        p_value = _sign_test(np.bincount(groups, weights=uneven).astype(np.float64))
    return McNemar(only_first, only_second, p_value)


def mean_difference(
    first: Sequence[float] | NDArray[np.float64],
    second: Sequence[float] | NDArray[np.float64],
    groups: NDArray[np.int64],
) -> Estimate:
    """Return the mean of second less first, with the interval of a bootstrap over the groups."""
    difference = np.asarray(second, dtype=np.float64) - np.asarray(first, dtype=np.float64)
    return mean_of_groups(difference, groups) if len(difference) else UNKNOWN


def share_difference(
    first: NDArray[np.bool_], second: NDArray[np.bool_], groups: NDArray[np.int64]
) -> Estimate:
    """Return the share of second less that of first, with an interval for matched proportions.

    Where each pair is a group of its own, it is Wald's with half a pair added to each of the four
    kinds of pairs, as it also holds for few pairs, and for pairs that are all alike (Agresti and
    Min, Statistics in Medicine 24, 2005). Otherwise it is that of `mean_difference`.
    """
    from scipy.stats import norm

    n = len(first)
    if n == 0:
        return UNKNOWN
    if not _are_alone(groups):
        return mean_difference(first.astype(np.float64), second.astype(np.float64), groups)
    only_first = int(np.count_nonzero(first & ~second))
    only_second = int(np.count_nonzero(second & ~first))
    pairs, uneven = n + 2.0, only_second - only_first
    middle = uneven / pairs
    spread = math.sqrt(only_first + only_second + 1.0 - uneven**2 / pairs) / pairs
    half = float(norm.ppf((1.0 + CONFIDENCE) / 2.0)) * spread
    return Estimate(uneven / n, max(middle - half, -1.0), min(middle + half, 1.0), n)


def _are_alone(groups: NDArray[np.int64]) -> bool:
    return len(np.unique(groups)) == len(groups)


def _sign_test(uneven: NDArray[np.float64]) -> float:
    """Return the two-sided probability of a sum as far from zero if each sign were chance."""
    uneven = uneven[uneven != 0.0]
    observed = abs(float(uneven.sum()))
    if len(uneven) <= MOST_FLIPPED:
        signs = np.array(list(itertools.product((-1.0, 1.0), repeat=len(uneven))))
        return float(np.mean(np.abs(signs @ uneven) >= observed))
    random = np.random.default_rng(SIGNS_SEED)
    signs = random.choice((-1.0, 1.0), size=(2**MOST_FLIPPED, len(uneven)))
    as_far = int(np.count_nonzero(np.abs(signs @ uneven) >= observed))
    return (as_far + 1) / (len(signs) + 1)  # What was seen is one of them (Davison and Hinkley).
