"""Logistic curves, which make probabilities of what a recogniser has heard (Platt, 1999)."""

from __future__ import annotations

import numpy as np

LEAST_PROBABILITY = 1e-6
"""Least distance of a probability from 0 and from 1 in its log-odds."""


def probability(log_odds: float) -> float:
    """Return the probability of log-odds."""
    return float(1.0 / (1.0 + np.exp(-log_odds)))


def log_odds_of(probability: float) -> float:
    """Return the log-odds of a probability, within those of `LEAST_PROBABILITY`."""
    bounded = min(max(probability, LEAST_PROBABILITY), 1.0 - LEAST_PROBABILITY)
    return float(np.log(bounded / (1.0 - bounded)))
