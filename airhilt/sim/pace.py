"""Paces: how fast simulation time passes."""

from __future__ import annotations

import time
from threading import Event
from typing import Protocol

from airhilt.errors import AirhiltError

PAUSE_S = 0.2
"""Longest time in s after which a run that is paused notices that it is interrupted."""


class Pace(Protocol):
    """Holds the Director back until an event is due."""

    @property
    def name(self) -> str:
        """Spelling on the command line."""
        ...

    def start(self, t_ns: int) -> None:
        """Take the present instant as simulation time ``t_ns``."""
        ...

    def wait_until(self, t_ns: int, wake: Event) -> bool:
        """Return True when ``t_ns`` is due, or False earlier when ``wake`` is set."""
        ...

    def elapsed_ns(self, now_ns: int) -> int:
        """Return the simulation time now; ``now_ns`` is that of the last event."""
        ...


class Virtual:
    """Simulation time passes as fast as the machine allows."""

    name = "virtual"

    def start(self, t_ns: int) -> None:
        """Do nothing: virtual time needs no origin."""

    def wait_until(self, t_ns: int, wake: Event) -> bool:  # noqa: ARG002
        """Return at once: everything is due."""
        return True

    def elapsed_ns(self, now_ns: int) -> int:
        """Return ``now_ns``: between events virtual time stands still."""
        return now_ns


class RealTime:
    """Simulation time passes ``factor`` times as fast as the wall clock."""

    def __init__(self, factor: float = 1.0) -> None:
        self.factor = factor
        self._origin_wall = time.perf_counter()
        self._origin_ns = 0

    @property
    def name(self) -> str:
        """``realtime``, or the factor as in ``4x``."""
        return "realtime" if self.factor == 1.0 else f"{self.factor:g}x"

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


class Paused:
    """Simulation time stands still until the pace is changed."""

    name = "paused"

    def start(self, t_ns: int) -> None:
        """Do nothing: there is no time to measure."""

    def wait_until(self, t_ns: int, wake: Event) -> bool:  # noqa: ARG002
        """Sleep until ``wake`` is set, or for a moment, after which an interruption is noticed."""
        wake.wait(PAUSE_S)
        return False

    def elapsed_ns(self, now_ns: int) -> int:
        """Return ``now_ns``."""
        return now_ns


def parse_pace(text: str) -> Pace:
    """Return the pace called ``virtual``, ``realtime``, or a factor such as ``4x``.

    Raises
    ------
    AirhiltError
        It is none of these.
    """
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
