"""Things that wait until something is true of the world."""

from __future__ import annotations

from collections.abc import Callable

Test = Callable[[int], bool]
"""Tells whether a condition is true at a time in nanoseconds."""


class Triggers:
    """Actions, each done once, as soon as its test is true."""

    def __init__(self) -> None:
        self._waiting: list[tuple[Test, Callable[[], None]]] = []

    def once(self, test: Test, action: Callable[[], None]) -> None:
        """Do an action as soon as a test is true."""
        self._waiting.append((test, action))

    def look(self, now_ns: int) -> None:
        """Do what is due, in the order in which it began to wait."""
        waiting, self._waiting = self._waiting, []
        due = []
        for test, action in waiting:
            if test(now_ns):
                due.append(action)
            else:
                self._waiting.append((test, action))
        for action in due:
            action()
