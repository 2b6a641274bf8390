"""Log-odds of each recognised piece of a call against its alternatives.

A posterior tells how well a piece was heard, not whether another one would make sense there. "Go"
before "around" is nearly sure even if it was heard badly; a digit is not, because any other would
make as much sense.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from airhilt.assistant.asr.beam_search import BLANK, HeardUnit, Prior, log_likelihood
from airhilt.assistant.asr.language import END
from airhilt.assistant.asr.logistic import log_odds_of, probability
from airhilt.assistant.asr.pieces import Pieces
from airhilt.assistant.asr.spotting import SAME

SAME_WORDING = (*SAME, ("clear", "cleared"))
"""Words between which nothing is at stake: digits in two ways, and "cleared to land", which sounds
like "clear to land" and is read as the same clearance. "Clear of" is no clearance with either."""
LEAST_POSTERIOR = 1e-3
"""Posterior below which a unit is no alternative."""
NO_POSTERIOR = 1e-10
"""Posterior of a unit that was not heard at all, whose logarithm is not taken."""
LARGEST_LOG_ODDS = log_odds_of(1.0)
"""Largest log-odds of a piece, and of its alternatives."""


@dataclass(frozen=True)
class WordCurve:
    """Probability that a word is right: a logistic curve over two log-odds."""

    posterior_slope: float
    """Slope over the log-odds of its posterior."""
    alternatives_slope: float
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
        heard = self.posterior_slope * log_odds_of(posterior)
        return probability(heard + self.alternatives_slope * against + self.offset)


def same_units(pieces: Pieces) -> dict[int, list[int]]:
    """Return the units that say the same as a unit, as "fife" for "five"."""
    found: dict[int, list[int]] = {}
    for words in SAME_WORDING:
        one, other = map(pieces.unit, words)
        if one is not None and other is not None:
            found |= {one: [other], other: [one]}
    return found


def with_same(
    posteriors: NDArray[np.float32], heard: Sequence[HeardUnit], same: Mapping[int, Sequence[int]]
) -> tuple[NDArray[np.float32], list[HeardUnit]]:
    """Return posteriors and heard units, to which those add that say the same.

    They are no alternatives: "niner" is no less sure because it may have been "nine".
    """
    added = posteriors.copy()
    found = []
    for each in heard:
        if others := same.get(each.unit):
            steps = slice(each.begin, each.end)
            added[steps, each.unit] += added[steps, others].sum(axis=1)
            added[steps, others] = 0.0
            surest = each.begin + int(added[steps, each.unit].argmax())
            each = each._replace(surest=surest, posterior=float(added[surest, each.unit]))
        found.append(each)
    return added, found


def log_odds(
    posteriors: NDArray[np.float32], heard: Sequence[HeardUnit], prior: Prior, order: int
) -> list[float]:
    """Return the log-odds of each piece against everything else that may have been said there.

    Every other piece is an alternative, and so is nothing; the rest of the call stays as it is.

    Parameters
    ----------
    posteriors
        Posterior of the blank and of each piece, shape (steps, units).
    heard
        Pieces of the call, where they were heard.
    prior
        Log-likelihood of a piece after others.
    order
        Order of the n-grams of the prior: it depends on one piece less.
    """
    ended = (*(each.unit for each in heard), END)
    found = []
    for at, each in enumerate(heard):
        here = posteriors[each.surest]
        first, last = max(at - 1, 0), min(at + 2, len(heard))
        before, after = ended[:first], ended[last : at + order]
        likely = {
            unit: float(np.log(max(here[unit], NO_POSTERIOR)))
            + log_likelihood(before, (*_with(heard[first:last], each, unit), *after), prior)
            for unit in {*np.flatnonzero(here >= LEAST_POSTERIOR).tolist(), each.unit}
        }
        own = likely.pop(each.unit)
        against = float(np.logaddexp.reduce([*likely.values(), own - LARGEST_LOG_ODDS]))
        found.append(max(own - against, -LARGEST_LOG_ODDS))
    return found


def _with(heard: Sequence[HeardUnit], changed: HeardUnit, unit: int) -> list[int]:
    """Return units of which one is another, or the blank.

    Equal units without a blank between them are one.
    """
    path: list[int] = []
    for at, each in enumerate(heard):
        if at > 0 and heard[at - 1].end < each.begin:
            path.append(BLANK)
        path.append(unit if each is changed else each.unit)
    return [unit for unit, _ in groupby(path) if unit != BLANK]
