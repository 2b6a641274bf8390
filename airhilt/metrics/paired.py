"""Statistics of pairs of runs that differ in one thing only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from airhilt.metrics.estimates import Estimate, mean_of


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
