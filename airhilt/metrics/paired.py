"""Statistics of pairs of runs that differ in one thing only."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from airhilt.metrics.estimates import CONFIDENCE, UNKNOWN, Estimate, effective_number, mean_of

MOST_FLIPPED = 14
"""Number of clusters up to which all signs are tried; above, as many are drawn as 14 have."""
SIGNS_SEED = 0


@dataclass(frozen=True)
class McNemar:
    """McNemar's exact test on pairs of yes and no, with the pairs in which only one is yes.

    `p_value` is the probability of so uneven a split, or a more uneven one, if neither were more
    often yes, two-sided. Pairs that are independent: by the binomial distribution (McNemar, 1947;
    the exact form). Clusters of pairs: by changing the sides of whole clusters, which for clusters
    of one pair is the same.
    """

    only_first: int
    only_second: int
    p_value: float


def mcnemar(
    first: NDArray[np.bool_], second: NDArray[np.bool_], clusters: NDArray[np.int64]
) -> McNemar:
    """Return the test for the pairs of two arrays of equal length.

    `clusters` has the number of the cluster of each pair, from 0 on without gaps.
    """
    from scipy.stats import binomtest

    only_first = int(np.count_nonzero(first & ~second))
    only_second = int(np.count_nonzero(second & ~first))
    discordant = only_first + only_second
    if not discordant:
        return McNemar(only_first, only_second, 1.0)
    if _are_alone(clusters):
        p_value = float(binomtest(only_first, discordant).pvalue)
    else:
        uneven = second.astype(np.float64) - first.astype(np.float64)
        p_value = _sign_test(np.bincount(clusters, weights=uneven).astype(np.float64))
    return McNemar(only_first, only_second, p_value)


def mean_difference(
    first: Sequence[float] | NDArray[np.float64],
    second: Sequence[float] | NDArray[np.float64],
    clusters: NDArray[np.int64],
) -> Estimate:
    """Return the mean of second less first, as `mean_of`."""
    difference = np.asarray(second, dtype=np.float64) - np.asarray(first, dtype=np.float64)
    return mean_of(difference, clusters)


def share_difference(
    first: NDArray[np.bool_], second: NDArray[np.bool_], clusters: NDArray[np.int64]
) -> Estimate:
    """Return the share of second less that of first, with an interval for matched proportions.

    It is Wald's with half a pair added to each of the four kinds of pairs, as it also holds for few
    pairs, and for pairs that are all alike (Agresti and Min, Statistics in Medicine 24, 2005). The
    number of pairs is the `effective_number` of these clusters.
    """
    from scipy.stats import norm

    n = len(first)
    if n == 0:
        return UNKNOWN
    change = second.astype(np.float64) - first.astype(np.float64)
    number = effective_number(change, clusters)
    uneven, discordant = float(change.mean()), float((change != 0.0).mean())
    pairs = number + 2.0
    middle = uneven * number / pairs
    spread = math.sqrt(discordant * number + 1.0 - (uneven * number) ** 2 / pairs) / pairs
    half = float(norm.ppf((1.0 + CONFIDENCE) / 2.0)) * spread
    return Estimate(uneven, max(middle - half, -1.0), min(middle + half, 1.0), n)


def _are_alone(clusters: NDArray[np.int64]) -> bool:
    return len(np.unique(clusters)) == len(clusters)


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
