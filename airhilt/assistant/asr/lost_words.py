"""Words that were said and are not written: more was heard between two words than they have.

A word that is left out leaves no trace in a transcript, and may turn what is said: "at LANDER,
turn left" becomes "turn left". The posteriors of the steps between two words show it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from airhilt.assistant.asr.beam_search import BLANK, HeardUnit
from airhilt.assistant.asr.logistic import Logistic

LEAST_HEARD = 0.05
"""Posterior of all pieces together below which a step is silence or noise; there may be many."""
MINUTE_HEARD = 0.1
"""Sum of posteriors, in steps, far below which gaps differ no more."""


@dataclass(frozen=True)
class LossCurve(Logistic):
    """Probability that a word was lost: a logistic curve over the logarithm of what was heard."""

    def __call__(self, heard: float) -> float:
        """Return the probability that a word is lost where this much was heard and not written."""
        return self.at(log_heard(heard))


def log_heard(heard: float) -> float:
    """Return the logarithm of what was heard in a gap, as a `LossCurve` takes it."""
    return float(np.log(heard + MINUTE_HEARD))


def unwritten(posteriors: NDArray[np.float32], words: Sequence[Sequence[HeardUnit]]) -> list[float]:
    """Return what was heard before each word and behind the last: sums of posteriors of pieces.

    Parameters
    ----------
    posteriors
        Posterior of the blank and of each piece, shape (steps, units).
    words
        Pieces of each word that is written.
    """
    heard = 1.0 - posteriors[:, BLANK].astype(np.float64)
    until = np.concatenate(([0.0], np.cumsum(np.where(heard < LEAST_HEARD, 0.0, heard))))
    begins = [word[0].begin for word in words]
    ends = [word[-1].end for word in words]
    return [
        float(until[begin] - until[end])
        for end, begin in zip([0, *ends], [*begins, len(posteriors)], strict=True)
    ]
