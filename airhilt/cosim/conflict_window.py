"""The window of the conflict that a scenario declares: when it opens and when it closes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from airhilt.world.truth.conflicts import ConflictMonitor, Pair

Told = Callable[[Literal["opened", "closed"], Pair], None]


class ConflictWindow:
    """Opens on the scenario's condition; closes once the pair of the conflict is past it.

    Parameters
    ----------
    pair
        The actors of the conflict; None if the scenario declares none.
    opens
        Tells whether the scenario's condition is true at a time in ns.
    told
        Called with ``opened`` or ``closed`` and the pair.
    """

    def __init__(
        self,
        pair: Pair | None,
        opens: Callable[[int], bool] | None,
        monitor: ConflictMonitor,
        told: Told,
    ) -> None:
        self._pair = pair
        self._opens = opens
        self._monitor = monitor
        self._told = told
        self._phase: Literal["before", "open", "after"] = "before"

    def look(self, now_ns: int) -> None:
        """Open or close the window if it is time to."""
        if self._opens is None or self._pair is None:
            return
        if self._phase == "before" and self._opens(now_ns):
            self._phase = "open"
            self._monitor.open_window(self._pair, now_ns)
            self._told("opened", self._pair)
        elif self._phase == "open" and self._has_passed(self._pair):
            self._phase = "after"
            self._monitor.close_window(self._pair)
            self._told("closed", self._pair)

    def _has_passed(self, pair: Pair) -> bool:
        """Return whether a pair moves apart and will not lose separation, or one has ended."""
        if not self._monitor.flying(pair):
            return True
        motion, _, _ = self._monitor.motion(pair)
        is_receding = motion.time_to_closest_approach_s() < 0.0
        return is_receding and self._monitor.time_to_loss_s(pair) is None
