"""Weighs each piece of a call against the others that may have been said there, or none.

A posterior tells how well a piece was heard, not whether another one would make sense there. "Go"
before "around" is nearly sure even if it was heard badly; a digit is not, because any other would
make as much sense.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from airhilt.assistant.asr.beam_search import BLANK, HeardUnit, Prior
from airhilt.assistant.asr.language import END
from airhilt.assistant.asr.logistic import log_odds_of, probability

LEAST_POSTERIOR = 1e-3
"""Posterior below which a unit is no alternative."""
LARGEST_LOG_ODDS = 14.0
"""Log-odds of one in a million; nothing is surer."""


@dataclass(frozen=True)
class WordCurve:
    """Probability that a word is right: a logistic curve over two log-odds."""

    heard: float
    """Slope over the log-odds of its posterior."""
    likely: float
    """Slope over its log-odds against alternatives."""
    offset: float

    def __call__(self, posterior: float, against: float) -> float:
        """Return the probability that a word is right.

        Parameters
        ----------
        posterior
            Least posterior of its pieces.
        against
            Least `log_odds` of them.
        """
        heard = self.heard * log_odds_of(posterior)
        return probability(heard + self.likely * against + self.offset)


def log_odds(
    posteriors: NDArray[np.float32], heard: Sequence[HeardUnit], prior: Prior, order: int
) -> list[float]:
    """Return the log-odds of each piece against all others, and none, with the rest of the call.

    Parameters
    ----------
    posteriors
        Posterior of the blank and of each piece, shape (steps, units).
    heard
        Pieces of the call, where they were heard.
    prior
        Log-likelihood of a piece after others.
    order
        Greatest number of pieces of which the prior knows how likely they follow each other.
    """
    units = tuple(each.unit for each in heard)
    found = []
    for at, (unit, _, _, surest, _) in enumerate(heard):
        here = posteriors[surest]
        before, after = units[:at], (*units, END)[at + 1 : at + order]
        likely = {
            other: float(np.log(here[other]))
            + _log_likelihood(before, (other, *after) if other != BLANK else after, prior)
            for other in {*np.flatnonzero(here >= LEAST_POSTERIOR).tolist(), unit}
        }
        own = likely.pop(unit)
        against = float(np.logaddexp.reduce([*likely.values(), own - LARGEST_LOG_ODDS]))
        found.append(max(own - against, -LARGEST_LOG_ODDS))
    return found


def _log_likelihood(before: tuple[int, ...], units: Iterable[int], prior: Prior) -> float:
    """Return how likely units follow others, by the prior."""
    total = 0.0
    for unit in units:
        total += prior(before, unit)
        before = (*before, unit)
    return total
