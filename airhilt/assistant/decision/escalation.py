"""Timing of an alert: told once a severity has held, again when it rises, and at its end."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.findings import Finding
from airhilt.assistant.decision.manoeuvres import RESPONSE_S
from airhilt.messages import AdvisoryKind, Evidence, Recommendation, Severity
from airhilt.units import SECOND_NS

AGAIN_S = RESPONSE_S + 7.0
"""Time after which who does not do as told is told again, in s: that of a response, and the period
of a terrain caution (EASA, AMC1 ACNS.E.TAWS.075, table 2)."""


@dataclass(slots=True)
class Escalation:
    """The severity and the alerts of one conflict, from first suspicion to its end."""

    id: str
    """Id of its alerts."""
    severity: Severity | None = None
    """Severity of its last alert; None before the first one."""
    _revision: int = 0
    _since_ns: dict[Severity, int] = field(default_factory=dict)
    """Time since which the level has been that or higher, by severity."""
    _told_ns: int | None = None
    _quiet_since_ns: int | None = None
    _tells_again: bool = False

    @property
    def is_for_crews(self) -> bool:
        """True if crews and drivers are told of it: from a CAUTION on."""
        return self.severity is not None and self.severity.rank >= Severity.CAUTION.rank

    def rises(self, level: Severity, t_ns: int, persistence_s: float) -> bool:
        """Update with the present level, and return whether a higher severity is to be told.

        It is to be told once all levels of the last ``persistence_s`` were higher than the severity
        told last. `severity` then becomes the lowest of these levels.
        """
        self._quiet_since_ns = None
        self.observe(level, t_ns)
        told_rank = -1 if self.severity is None or self._tells_again else self.severity.rank
        held = [
            severity
            for severity, since_ns in self._since_ns.items()
            if severity is not Severity.INFO
            and severity.rank > told_rank
            and t_ns - since_ns >= persistence_s * SECOND_NS
        ]
        if not held:
            return False
        self.severity = max(held, key=lambda severity: severity.rank)
        self._tells_again = False
        self._told_ns = t_ns
        return True

    def is_fresh(self, t_ns: int, response_s: float = RESPONSE_S) -> bool:
        """Return whether its last alert leaves time to respond to it yet."""
        return self._told_ns is not None and t_ns - self._told_ns < response_s * SECOND_NS

    def changes(
        self, t_ns: int, *, other: Collection[str], ignoring: Collection[str]
    ) -> frozenset[str]:
        """Return who is to be told something though the severity has not risen.

        Parameters
        ----------
        other
            Callsigns whose advice is other than they were told last.
        ignoring
            Callsigns that do not do what they were told last: a WARNING is told again then.
        """
        if not self.is_for_crews or self._told_ns is None:
            return frozenset()
        is_warning = self.severity is Severity.WARNING
        is_due = is_warning and t_ns - self._told_ns >= AGAIN_S * SECOND_NS
        news = frozenset((*other, *(ignoring if is_due else ())))
        if news:
            self._told_ns = t_ns
        return news

    def observe(self, level: Severity | None, t_ns: int) -> None:
        """Update how long each level has held, without telling anything; None for no conflict.

        How long a level has held is counted by the times of the evidence, not by those of alerts.
        """
        for severity in Severity:
            if level is None or severity.rank > level.rank:
                self._since_ns.pop(severity, None)
            else:
                self._since_ns.setdefault(severity, t_ns)

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

    def alert(
        self,
        kind: AdvisoryKind,
        recipients: tuple[str, ...],
        traffic: tuple[str, ...],
        evidence: Evidence,
        finding: Finding | None,
        recommendations: Mapping[str, Recommendation],
        *,
        active: bool = True,
    ) -> Alert:
        """Return the next alert; the last one is not active, and has no recommendations."""
        revision, self._revision = self._revision, self._revision + 1
        return Alert(
            id=self.id,
            revision=revision,
            kind=kind,
            severity=self.severity if self.severity is not None and active else Severity.INFO,
            recipients=recipients,
            traffic=traffic,
            evidence=evidence,
            finding=finding,
            recommendations=recommendations if active else {},
            active=active,
        )
