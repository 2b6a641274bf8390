"""Reports of a run to the program that started it: while it goes on, and at its end."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path

from airhilt.messages import Advisory
from airhilt.metrics.summary import Summary


@dataclass(frozen=True)
class Result:
    """The outcome of a run: the numbers of its summary, and its folder."""

    summary: Summary
    folder: Path


@dataclass(frozen=True)
class Snapshot:
    """The state of a run, for a progress line.

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

    def machine_failed(self, cause: str) -> None:
        """Take note that the run goes on without something that another machine might have kept."""


class WarningObserver(Observer):
    """Lets Python warn of what the user should know at once."""

    def notice(self, text: str) -> None:
        """Warn."""
        warnings.warn(text, RuntimeWarning, stacklevel=2)
