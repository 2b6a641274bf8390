"""Random streams by name, so that one more draw here never changes a draw there."""

from __future__ import annotations

import zlib

import numpy as np


def stream(seed: int, name: str, *counters: int) -> np.random.Generator:
    """Return the generator that belongs to a run's seed, a name, and optional counters."""
    return np.random.default_rng((seed, zlib.crc32(name.encode()), *counters))
