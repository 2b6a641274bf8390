"""How whoever started a run hears of it: while it goes on, and when it has ended."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from airhilt.messages import Advisory
from airhilt.metrics.summary import Summary


@dataclass(frozen=True)
class Result:
    """What a run left behind: the numbers of its summary, and its folder."""

    summary: Summary
    folder: Path


@dataclass(frozen=True)
class Snapshot:
    """How a run is doing, for a progress line.

    Attributes
    ----------
    horizontal_m, vertical_m
        Distances of the pair of the conflict; None without a pair, or when one has ended.
    advisory
        The last one that was told and is active.
    """

    t_s: float
    duration_s: float
    horizontal_m: float | None
    vertical_m: float | None
    advisory: Advisory | None


class Observer:
    """Is told how a run is doing; this one ignores it."""

    def snapshot(self, snapshot: Snapshot) -> None:
        """Take note of the run's state, about twice a simulated second."""

    def notice(self, text: str) -> None:
        """Take note of something that the user should know at once."""
