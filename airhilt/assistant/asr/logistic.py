"""Logistic curves, which make probabilities of what a recogniser has heard (Platt, 1999)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Logistic:
    """Logistic curve of a number."""

    slope: float
    offset: float

    def at(self, x: float) -> float:
        """Return the probability at a number."""
        return float(1.0 / (1.0 + np.exp(-(self.slope * x + self.offset))))
