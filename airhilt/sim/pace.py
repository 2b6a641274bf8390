"""Paces: how fast simulation time passes."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from threading import Event

from airhilt.errors import AirhiltError

PAUSE_S = 0.2
"""Longest time in s after which a run that is paused notices that it is interrupted."""


class Pace(ABC):
    """Holds the Director back until an event is due. Between events time stands still."""

    name: str
    """Spelling on the command line."""

    def start(self, t_ns: int) -> None:  # noqa: B027
        """Take the present instant as simulation time ``t_ns``, where that matters."""

    @abstractmethod
    def wait_until(self, t_ns: int, wake: Event) -> bool:
        """Return True when ``t_ns`` is due, or False earlier when ``wake`` is set."""

    def elapsed_ns(self, now_ns: int) -> int:
        """Return the simulation time now; ``now_ns`` is that of the last event."""
        return now_ns


class Virtual(Pace):
    """Simulation time passes as fast as the machine allows."""

    name = "virtual"

    def wait_until(self, t_ns: int, wake: Event) -> bool:  # noqa: ARG002
        """Return at once: everything is due."""
        return True


class RealTime(Pace):
    """Simulation time passes ``factor`` times as fast as the wall clock."""

    def __init__(self, factor: float = 1.0) -> None:
        self.name = "realtime" if factor == 1.0 else f"{factor:g}x"
        self.factor = factor
        self._origin_wall = time.perf_counter()
        self._origin_ns = 0

    def start(self, t_ns: int) -> None:
        """Take the present wall time as ``t_ns``."""
        self._origin_wall = time.perf_counter()
        self._origin_ns = t_ns

    def wait_until(self, t_ns: int, wake: Event) -> bool:
        """Sleep until the wall clock has come to ``t_ns`` or ``wake`` is set."""
        due = self._origin_wall + (t_ns - self._origin_ns) / 1e9 / self.factor
        remaining = due - time.perf_counter()
        return remaining <= 0.0 or not wake.wait(remaining)

    def elapsed_ns(self, now_ns: int) -> int:
        """Return simulation time by the wall clock."""
        wall = time.perf_counter() - self._origin_wall
        return max(now_ns, self._origin_ns + round(wall * self.factor * 1e9))


class Paused(Pace):
    """Simulation time stands still until the pace is changed."""

    name = "paused"

    def wait_until(self, t_ns: int, wake: Event) -> bool:  # noqa: ARG002
        """Sleep until ``wake`` is set, or for a moment, after which an interruption is noticed."""
        wake.wait(PAUSE_S)
        return False


def parse_pace(text: str) -> Pace:
    """Return the pace called ``virtual``, ``realtime``, or a factor such as ``4x``."""
    if text == "virtual":
        return Virtual()
    if text == "realtime":
        return RealTime()
    try:
        factor = float(text.removesuffix("x")) if text.endswith("x") else 0.0
    except ValueError:
        factor = 0.0
    if 0.0 < factor < 1e6:
        return RealTime(factor)
    raise AirhiltError(
        f"pace {text!r}: expected 'virtual', 'realtime' or a positive factor such as '4x'"
    )
