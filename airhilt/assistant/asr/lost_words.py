"""Words that were said but are missing in a transcript, by the posteriors between its words.

A word that is left out leaves no trace in a transcript, and may turn what is said: "at LANDER,
turn left" becomes "turn left". The posteriors of the steps between two words show it, and whether
one more piece would make sense there: breath that sounds a little like "s" before a callsign
would make none.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from airhilt.assistant.asr.alternatives import LARGEST_LOG_ODDS
from airhilt.assistant.asr.beam_search import BLANK, HeardUnit, Prior, log_likelihood
from airhilt.assistant.asr.language import END
from airhilt.assistant.asr.logistic import probability

LEAST_HEARD = 0.05
"""Posterior of all pieces together below which a step is silence or noise; there may be many."""
MINUTE_HEARD = 0.1
"""Sum of posteriors, in steps, that is added before the logarithm: gaps far below are alike."""
LEAST_INSERTED = 0.01
"""Posterior below which a piece is not tried in a gap."""
NEVER_SAID = 1e-6
"""Posterior of the blank, whose logarithm is not taken below it."""


class Gap(NamedTuple):
    """What was heard before a word or behind the last one, and is not written."""

    heard: float
    """Sum of the posteriors of pieces, in steps."""
    inserted: float
    """Log-odds that one more piece was said there, against none."""


SILENCE = Gap(0.0, -LARGEST_LOG_ODDS)
"""A gap in which nothing was heard."""


@dataclass(frozen=True)
class LossCurve:
    """Probability that a word was lost in a gap: a logistic curve over `Gap`."""

    heard_slope: float
    """Slope over the logarithm of what was heard."""
    inserted_slope: float
    """Slope over the log-odds of one more piece."""
    offset: float

    def __call__(self, gap: Gap) -> float:
        """Return the probability that a word is lost in a gap."""
        return probability(
            self.heard_slope * log_heard(gap.heard)
            + self.inserted_slope * gap.inserted
            + self.offset
        )


def log_heard(heard: float) -> float:
    """Return the logarithm of what was heard in a gap, as a `LossCurve` takes it."""
    return float(np.log(heard + MINUTE_HEARD))


def gaps(
    posteriors: NDArray[np.float32], words: Sequence[Sequence[HeardUnit]], prior: Prior, order: int
) -> list[Gap]:
    """Return the gap before each word, and the one behind the last.

    Parameters
    ----------
    posteriors
        Posterior of the blank and of each piece, shape (steps, units).
    words
        Pieces of each word that is written.
    prior
        Log-likelihood of a piece after others.
    order
        Order of the n-grams of the prior: it depends on one piece less.
    """
    begins = [word[0].begin for word in words]
    ends = [word[-1].end for word in words]
    units = [[each.unit for each in word] for word in words]
    found = []
    for at, (end, begin) in enumerate(zip([0, *ends], [*begins, len(posteriors)], strict=True)):
        before = tuple(unit for word in units[:at] for unit in word)
        after = (*(unit for word in units[at:] for unit in word), END)[:order]
        found.append(_gap(posteriors[end:begin], before, after, prior))
    return found


def _gap(
    steps: NDArray[np.float32], before: tuple[int, ...], after: tuple[int, ...], prior: Prior
) -> Gap:
    heard = 1.0 - steps[:, BLANK].astype(np.float64)
    heard = heard[heard >= LEAST_HEARD]
    highest = steps.max(axis=0, initial=0.0)
    tried = [unit for unit in np.flatnonzero(highest >= LEAST_INSERTED).tolist() if unit != BLANK]
    if not tried:
        return Gap(float(heard.sum()), -LARGEST_LOG_ODDS)
    as_written = log_likelihood(before, after, prior)
    inserted = []
    for unit in tried:
        said, silent = steps[int(steps[:, unit].argmax())][[unit, BLANK]]
        sound = np.log(said) - np.log(max(silent, NEVER_SAID))
        inserted.append(sound + log_likelihood(before, (unit, *after), prior) - as_written)
    odds = float(np.logaddexp.reduce(inserted))
    return Gap(float(heard.sum()), max(odds, -LARGEST_LOG_ODDS))
