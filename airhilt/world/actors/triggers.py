"""Actions that wait for a condition on the true state."""

from __future__ import annotations

from collections.abc import Callable

Test = Callable[[int], bool]
"""Returns whether a condition is true at a time in ns."""


class Triggers:
    """Actions that each run once, as soon as their condition is true."""

    def __init__(self) -> None:
        self._waiting: list[tuple[Test, Callable[[], None]]] = []

    def once(self, test: Test, action: Callable[[], None]) -> None:
        """Run an action as soon as a test is true."""
        self._waiting.append((test, action))

    def clear(self) -> None:
        """Forget the actions that are left."""
        self._waiting.clear()

    def evaluate(self, now_ns: int) -> None:
        """Evaluate the pending triggers; run the due actions in the order of their registration."""
        waiting, self._waiting = self._waiting, []
        due = []
        for test, action in waiting:
            if test(now_ns):
                due.append(action)
            else:
                self._waiting.append((test, action))
        for action in due:
            action()
