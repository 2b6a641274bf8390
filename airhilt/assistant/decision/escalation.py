"""Timing of an alert: told once a severity has held, again when it rises, and at its end."""

from __future__ import annotations

from dataclasses import dataclass

from airhilt.messages import Severity
from airhilt.units import SECOND_NS


@dataclass(slots=True)
class Escalation:
    """The severity of one conflict from first suspicion to its end."""

    severity: Severity | None = None
    """Severity told last; None before the first advisory."""
    _rising: Severity | None = None
    _rising_since_ns: int = 0
    _quiet_since_ns: int | None = None
    _tells_again: bool = False

    def rises(self, level: Severity, t_ns: int, persistence_s: float) -> bool:
        """Update with the present level, and return whether a higher severity is to be told.

        It is, once all levels for ``persistence_s`` were higher than the one told last; `severity`
        is the least of them.
        """
        self._quiet_since_ns = None
        if self.severity is not None and not self._tells_again and level.rank <= self.severity.rank:
            self._rising = None
            return False
        if self._rising is None or level.rank < self._rising.rank:
            self._rising, self._rising_since_ns = level, t_ns
        if t_ns - self._rising_since_ns < persistence_s * SECOND_NS:
            return False
        self.severity, self._rising = self._rising, None
        self._tells_again = False
        return True

    def stays(self) -> None:
        """Note that nothing is wrong now, but that the conflict is not over."""
        self._rising = self._quiet_since_ns = None

    def stays_open(self, t_ns: int, release_s: float) -> None:
        """Note that nothing is wrong now, but that the conflict may come back.

        Once that has held for ``release_s``, a severity that was told before is told again.
        """
        if self.is_over(t_ns, release_s):
            self._tells_again = True

    def is_over(self, t_ns: int, release_s: float) -> bool:
        """Note that nothing is wrong now, and return whether that has held for ``release_s``."""
        self._rising = None
        if self._quiet_since_ns is None:
            self._quiet_since_ns = t_ns
        return t_ns - self._quiet_since_ns >= release_s * SECOND_NS
