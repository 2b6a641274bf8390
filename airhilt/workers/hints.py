"""Hints for authors of workers: they name advisories on which nobody acts."""

from __future__ import annotations

from collections.abc import Callable

from airhilt.engine_families import ASSISTANTS
from airhilt.messages import (
    CONTROLLER,
    SPEAK_MIN_LEVEL,
    Advisory,
    Recommendation,
    WorkerDescription,
)

PAGE = "docs/workers.md#what-makes-somebody-act"


def is_reference(description: WorkerDescription) -> bool:
    """Return whether a worker decides by the reference engine, whose advisories need no hint."""
    return description.engine == ASSISTANTS.default


def no_action(advisory: Advisory, follows: Callable[[Recommendation], bool] | None) -> str | None:
    """Return why nobody acts on a warning; None if somebody may act, or if it is for ATC.

    Parameters
    ----------
    follows
        Tells whether the recipient follows recommendations of a kind; None if there is no such
        recipient.
    """
    if (
        not advisory.active
        or advisory.severity.rank < SPEAK_MIN_LEVEL.rank
        or advisory.recipient == CONTROLLER
    ):
        return None
    recipient, recommendation = advisory.recipient, advisory.recommendation
    told = f"its {advisory.severity.value} to {recipient}"
    if follows is None:
        return (
            f"{told}: nobody has that name, so nobody acts on it; expected a callsign or "
            f"{CONTROLLER}; see {PAGE}"
        )
    if recommendation is None:
        return f"{told} has no recommendation: nobody acts on it; see {PAGE}"
    if not follows(recommendation):
        return (
            f"{told} recommends {recommendation.action}, which {recipient} does not follow: "
            f"nobody acts on it; see {PAGE}"
        )
    return None
