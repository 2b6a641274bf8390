"""Confidence in the words of a call: by what else may have been said there, and what may be lost.

A posterior tells how well a piece was heard, not whether another one would make sense there. "Go"
before "around" is nearly sure even if it was heard badly; a digit is not, because any other would
make as much sense.

A word that is left out leaves no trace in a transcript, and may turn what is said: "at LANDER,
turn left" becomes "turn left". The posteriors of the steps between two words show it, and whether
one more piece would make sense there: breath that sounds a little like "s" before a callsign
would make none.

Logistic curves make probabilities of both (Platt, 1999).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from airhilt.assistant.asr.beam_search import BLANK, HeardUnit, Prior, log_likelihood
from airhilt.assistant.asr.language import END
from airhilt.assistant.asr.pieces import Pieces
from airhilt.assistant.asr.spotting import SAME

LEAST_PROBABILITY = 1e-6
"""Least distance of a probability from 0 and from 1 in its log-odds."""
SAME_WORDING = (*SAME, ("clear", "cleared"))
"""Words between which nothing is at stake: digits in two ways, and "cleared to land", which sounds
like "clear to land" and is read as the same clearance. "Clear of" is no clearance with either."""
LEAST_POSTERIOR = 1e-3
"""Posterior below which a unit is no alternative."""
NO_POSTERIOR = 1e-10
"""Posterior of a unit that was not heard at all, whose logarithm is not taken."""
LEAST_HEARD = 0.05
"""Posterior of all pieces together below which a step is silence or noise; there may be many."""
MINUTE_HEARD = 0.1
"""Sum of posteriors, in steps, that is added before the logarithm: gaps far below are alike."""
LEAST_INSERTED = 0.01
"""Posterior below which a piece is not tried in a gap."""
NEVER_SAID = 1e-6
"""Posterior of the blank, whose logarithm is not taken below it."""


def probability(log_odds: float) -> float:
    """Return the probability of log-odds."""
    return float(1.0 / (1.0 + np.exp(-log_odds)))


def log_odds_of(probability: float) -> float:
    """Return the log-odds of a probability, within those of `LEAST_PROBABILITY`."""
    bounded = min(max(probability, LEAST_PROBABILITY), 1.0 - LEAST_PROBABILITY)
    return float(np.log(bounded / (1.0 - bounded)))


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
        """Return the probability by the least posterior of the pieces, and their least log-odds."""
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


class Gap(NamedTuple):
    """Sounds before a word or behind the last one that are not written."""

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
