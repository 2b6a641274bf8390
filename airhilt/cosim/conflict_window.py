"""The conflict that a scenario declares: when it begins, and when its window opens and closes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Literal

from airhilt.world.truth.conflicts import ConflictMonitor, Pair

Step = Literal["begun", "opened", "closed"]
Test = Callable[[int], bool]
"""Returns whether a condition is true at a time in ns."""


class ConflictWindow:
    """Opens on the scenario's condition; closes once the pair of the conflict is past it.

    Parameters
    ----------
    pair
        The actors of the conflict.
    begins, opens
        Tests of the event that begins the conflict, and of the condition that opens its window.
    """

    def __init__(self, pair: Pair, begins: Test, opens: Test, monitor: ConflictMonitor) -> None:
        self._pair = pair
        self._begins = begins
        self._opens = opens
        self._monitor = monitor
        self._has_begun = False
        self._phase: Literal["before", "open", "after"] = "before"

    def begin_if_due(self, now_ns: int) -> Iterator[Step]:
        """Begin the conflict if its event has happened, and yield that."""
        if not self._has_begun and self._begins(now_ns):
            self._has_begun = True
            yield "begun"

    def look(self, now_ns: int) -> Iterator[Step]:
        """Begin the conflict, open the window or close it, if it is time to; yield each step."""
        yield from self.begin_if_due(now_ns)
        if self._phase == "before" and self._opens(now_ns):
            self._phase = "open"
            self._monitor.open_window(self._pair, now_ns)
            yield "opened"
        elif self._phase == "open" and self._has_passed():
            self._phase = "after"
            self._monitor.close_window(self._pair)
            yield "closed"

    def _has_passed(self) -> bool:
        """Return whether the pair moves apart and will not lose separation, or one has ended."""
        if not self._monitor.flying(self._pair):
            return True
        is_receding = self._monitor.motion(self._pair).time_to_closest_approach_s() < 0.0
        return is_receding and self._monitor.time_to_loss_s(self._pair) is None
