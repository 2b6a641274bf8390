"""Timing of an alert: told once a severity has held, again when it rises, and at its end."""

from __future__ import annotations

from dataclasses import dataclass, field

from airhilt.messages import Severity
from airhilt.units import SECOND_NS


@dataclass(slots=True)
class Escalation:
    """The severity of one conflict from first suspicion to its end."""

    severity: Severity | None = None
    """Severity told last; None before the first advisory."""
    _since_ns: dict[Severity, int] = field(default_factory=dict)
    """Time since which the level has been that or higher, by severity."""
    _quiet_since_ns: int | None = None
    _tells_again: bool = False

    def rises(self, level: Severity, t_ns: int, persistence_s: float) -> bool:
        """Update with the present level, and return whether a higher severity is to be told.

        It is, once all levels for ``persistence_s`` were higher than the one told last; `severity`
        is the least of them.
        """
        self._quiet_since_ns = None
        self.observe(level, t_ns)
        held = [
            severity
            for severity, since_ns in self._since_ns.items()
            if self._is_news(severity) and t_ns - since_ns >= persistence_s * SECOND_NS
        ]
        if not held:
            return False
        self.severity = max(held, key=lambda severity: severity.rank)
        self._tells_again = False
        return True

    def observe(self, level: Severity | None, t_ns: int) -> None:
        """Note the level of a time at which nothing is told, None for no conflict.

        What has lasted is judged by the times of the evidence, however seldom something is told.
        """
        for severity in Severity:
            if level is None or severity.rank > level.rank:
                self._since_ns.pop(severity, None)
            else:
                self._since_ns.setdefault(severity, t_ns)

    def _is_news(self, severity: Severity) -> bool:
        is_higher = self.severity is None or severity.rank > self.severity.rank
        return severity is not Severity.INFO and (is_higher or self._tells_again)

    def stays(self) -> None:
        """Note that nothing is wrong now, but that the conflict is not over."""
        self._since_ns.clear()
        self._quiet_since_ns = None

    def stays_open(self, t_ns: int, release_s: float) -> None:
        """Note that nothing is wrong now, but that the conflict may come back.

        Once that has held for ``release_s``, a severity that was told before is told again.
        """
        if self.is_over(t_ns, release_s):
            self._tells_again = True

    def is_over(self, t_ns: int, release_s: float) -> bool:
        """Note that nothing is wrong now, and return whether that has held for ``release_s``."""
        self._since_ns.clear()
        if self._quiet_since_ns is None:
            self._quiet_since_ns = t_ns
        return t_ns - self._quiet_since_ns >= release_s * SECOND_NS
