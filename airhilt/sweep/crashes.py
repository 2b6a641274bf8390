"""Crashes in a row: what ends every run is not the runs' own, and the sweep ends with it."""

from __future__ import annotations

import re

from airhilt.sweep.outcome import Outcome

SAME_CRASHES = 20
"""Crashes in a row with one cause after which a sweep ends.

A disk that is full crashes every run, within seconds. A crash of the runs' own does too, but only
those of one scenario, assistant and value: twice as many as the ten seeds that these usually have.
An assumption.
"""
NUMBERS = re.compile(r"\d+")
"""Parts of a cause in which crashes with the same one differ: addresses, process numbers."""


class Crashes:
    """Counts crashes in a row with one and the same cause.

    Attributes
    ----------
    cause
        Cause of the last crash, empty if the last run did not crash.
    """

    def __init__(self) -> None:
        self.cause = ""
        self._count = 0

    def add(self, outcome: Outcome) -> None:
        """Take note of a run that has ended."""
        cause = outcome.cause if outcome.status == "crashed" else ""
        is_same = bool(cause) and NUMBERS.sub("", cause) == NUMBERS.sub("", self.cause)
        self._count = self._count + 1 if is_same else int(bool(cause))
        self.cause = cause

    @property
    def are_enough(self) -> bool:
        """True if every further run would most likely crash as well."""
        return self._count >= SAME_CRASHES
