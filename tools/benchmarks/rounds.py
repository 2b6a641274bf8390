"""Repeating a measurement, because other load on a machine only ever slows it."""

from __future__ import annotations

from collections.abc import Callable

ROUNDS = 5


def best(measure: Callable[[], float], rounds: int = ROUNDS) -> float:
    """Return the least of several measurements."""
    return min(measure() for _ in range(rounds))
