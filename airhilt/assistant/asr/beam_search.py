"""The likeliest pieces of a call: what was heard, together with what is usually said.

Prefix beam search over connectionist temporal classification (Hannun, Maas, Jurafsky and Ng,
2014, arXiv:1408.2873) with an n-gram model. A beginning counts by its likeliest alignment, not by
the sum over all: in a long silence the sum over many places makes up for a poor fit in each.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from airhilt.assistant.asr.language import END, Language

BLANK = 0
LEAST_POSTERIOR = 0.01
"""Posterior below which a unit is not tried, unless it is the likeliest."""
_NEVER = -math.inf
Prior = Callable[[tuple[int, ...], int], float]
"""Log-likelihood of a unit after others, by the language model and the reward."""


def log_likelihood(before: tuple[int, ...], units: Iterable[int], prior: Prior) -> float:
    """Return how likely units follow others, by a prior."""
    total = 0.0
    for unit in units:
        total += prior(before, unit)
        before = (*before, unit)
    return total


@dataclass(slots=True)
class _Prefix:
    """A way to begin the call.

    ``blank`` and ``unit`` are log-likelihoods of its best alignments that end with a blank and with
    its last unit; ``prior`` is what the language model and the reward say.
    """

    prior: float
    blank: float = _NEVER
    unit: float = _NEVER

    def total(self) -> float:
        return max(self.blank, self.unit) + self.prior


@dataclass(frozen=True)
class BeamSearch:
    """Finds the likeliest units."""

    language: Language
    weight: float
    """Weight of the language model's log-likelihood against the network's."""
    reward: float
    """Log-likelihood added for each unit, because each costs likelihood in the language model."""
    width: int = 12
    """Number of beginnings that are kept."""

    def units(self, posteriors: NDArray[np.float32]) -> tuple[int, ...]:
        """Return the likeliest units of posteriors, shape (steps, units)."""
        prior = self.prior()
        beam: dict[tuple[int, ...], _Prefix] = {(): _Prefix(0.0, blank=0.0)}
        is_tried = posteriors >= LEAST_POSTERIOR
        is_tried[np.arange(len(posteriors)), posteriors.argmax(axis=1)] = True
        log = np.log(np.maximum(posteriors, 1e-10))
        for step, tried in zip(log, is_tried, strict=True):
            units = [int(unit) for unit in np.flatnonzero(tried) if unit != BLANK]
            scores = [(unit, float(step[unit])) for unit in units]
            beam = self._next(beam, float(step[BLANK]), scores, prior)
        ended = {units: prefix.total() + prior(units, END) for units, prefix in beam.items()}
        return max(ended, key=lambda units: (ended[units], units))

    def _next(
        self,
        beam: dict[tuple[int, ...], _Prefix],
        blank: float,
        units: list[tuple[int, float]],
        prior: Prior,
    ) -> dict[tuple[int, ...], _Prefix]:
        grown: dict[tuple[int, ...], _Prefix] = {}
        for before, prefix in beam.items():
            heard = max(prefix.blank, prefix.unit)
            same = grown.setdefault(before, _Prefix(prefix.prior))
            same.blank = max(same.blank, heard + blank)
            last = before[-1] if before else BLANK
            for unit, score in units:
                if unit == last:
                    same.unit = max(same.unit, prefix.unit + score)
                    likelihood = prefix.blank + score
                else:
                    likelihood = heard + score
                if likelihood == _NEVER:
                    continue
                after = (*before, unit)
                longer = grown.get(after)
                if longer is None:
                    longer = grown[after] = _Prefix(prefix.prior + prior(before, unit))
                longer.unit = max(longer.unit, likelihood)
        if len(grown) <= self.width:
            return grown
        best = sorted(grown.items(), key=lambda each: (-each[1].total(), each[0]))
        return dict(best[: self.width])

    def prior(self) -> Prior:
        """Return the prior of units, which remembers what the language model said in a call."""
        known, before_most = cache(self.language.score), self.language.order - 1

        def prior(before: tuple[int, ...], unit: int) -> float:
            context = (END, *before)
            score = known(context[max(len(context) - before_most, 0) :], unit)
            return self.weight * score + (0.0 if unit == END else self.reward)

        return prior


class HeardUnit(NamedTuple):
    """Unit of a call, where it was heard."""

    unit: int
    begin: int
    """Step at which it begins."""
    end: int
    """Step behind its last one."""
    surest: int
    """Step of its highest posterior."""
    posterior: float
    """Its highest posterior."""


def aligned(posteriors: NDArray[np.float32], units: tuple[int, ...]) -> list[HeardUnit]:
    """Return where each unit of a call was heard.

    The likeliest alignment (Viterbi) of the units to the steps; there are at least as many steps
    as units and blanks between equal ones.
    """
    if not units:
        return []
    states = np.zeros(2 * len(units) + 1, np.intp)
    states[1::2] = units
    may_skip = np.zeros(len(states), bool)
    may_skip[3::2] = states[3::2] != states[1:-2:2]
    log = np.log(np.maximum(posteriors, 1e-10))[:, states]
    best = np.full(len(states), -np.inf, np.float32)
    best[:2] = log[0, :2]
    came = np.zeros(log.shape, np.int8)
    for at in range(1, len(log)):
        from_before = np.concatenate(([-np.inf], best[:-1]))
        from_skipped = np.where(may_skip, np.concatenate(([-np.inf, -np.inf], best[:-2])), -np.inf)
        ways = np.stack([best, from_before, from_skipped])
        came[at] = ways.argmax(axis=0)
        best = ways.max(axis=0) + log[at]
    state = len(states) - 1 if best[-1] >= best[-2] else len(states) - 2
    begins, ends, surest = [0] * len(units), [0] * len(units), [0] * len(units)
    for at in range(len(log) - 1, -1, -1):
        if state % 2:
            unit = state // 2
            begins[unit] = at
            ends[unit] = max(ends[unit], at + 1)
        state -= int(came[at, state])
    for unit, (begin, end) in enumerate(zip(begins, ends, strict=True)):
        surest[unit] = begin + int(posteriors[begin:end, units[unit]].argmax())
    highest = map(float, posteriors[surest, units])
    return list(map(HeardUnit, units, begins, ends, surest, highest))
