"""Reports of a run to the program that started it, while it goes on."""

from __future__ import annotations

import time
import warnings
from dataclasses import dataclass

from airhilt.host.notebook import NotebookLine
from airhilt.messages import Advisory
from airhilt.metrics.summary_rows import factor
from airhilt.units import FOOT, NAUTICAL_MILE


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

    def texts(self, wall_s: float) -> list[str]:
        """Return the parts of a progress line but for the advisory, after so much wall time."""
        parts = [
            f"{self.t_s:6.1f} of at most {self.duration_s:.0f} s",
            f"{factor(self.t_s / max(wall_s, 1e-6))} x real time",
        ]
        if self.horizontal_m is not None and self.vertical_m is not None:
            apart = f"{self.horizontal_m / NAUTICAL_MILE:.1f} NM / {self.vertical_m / FOOT:.0f} ft"
            parts.append(f"{apart} apart")
        return parts


class Observer:
    """Is told how a run is doing; this one ignores it."""

    def snapshot(self, snapshot: Snapshot) -> None:
        """Take note of the run's state, about twice a simulated second."""

    def notice(self, text: str) -> None:
        """Take note of something that the user should know at once."""

    def machine_failed(self, cause: str) -> None:
        """Take note that the run goes on without something that another machine might have kept."""


class NotebookProgress(Observer):
    """Shows how a run is doing in the notebook that has begun it."""

    def __init__(self, title: str) -> None:
        self._line = NotebookLine()
        self._line.show(f"{title}: getting ready")
        self._begun = 0.0

    def snapshot(self, snapshot: Snapshot) -> None:
        """Show the run's state."""
        self._begun = self._begun or time.monotonic()
        parts = snapshot.texts(time.monotonic() - self._begun)
        if (advisory := snapshot.advisory) is not None:
            parts.append(f"{advisory.severity.value} {advisory.message}")
        self._line.show("  |  ".join(parts))

    def notice(self, text: str) -> None:
        """Show a line that stays."""
        self._line.notice(text)


class WarningObserver(Observer):
    """Lets Python warn of what the user should know at once."""

    def notice(self, text: str) -> None:
        """Warn."""
        warnings.warn(text, RuntimeWarning, stacklevel=2)
