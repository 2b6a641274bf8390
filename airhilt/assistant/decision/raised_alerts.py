"""Alerts of an engine whose hazards are judged anew each time: one alert for each hazard."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.escalation import Escalation
from airhilt.assistant.decision.findings import Finding
from airhilt.messages import AdvisoryKind, Evidence, Recommendation, Severity


@dataclass(frozen=True)
class Hazard:
    """Something that is wrong at one instant, and who is to be told.

    Attributes
    ----------
    key
        The same for the same hazard, from one instant to the next.
    """

    key: tuple[str, ...]
    severity: Severity
    kind: AdvisoryKind
    recipients: tuple[str, ...]
    traffic: tuple[str, ...]
    evidence: Evidence
    finding: Finding | None = None
    recommendations: Mapping[str, Recommendation] = field(default_factory=dict)


@dataclass
class _Ongoing:
    """One hazard from first suspicion to its end."""

    hazard: Hazard
    escalation: Escalation

    def alert(self, *, active: bool) -> Alert:
        """Return the next alert of it."""
        hazard = self.hazard
        return self.escalation.alert(
            hazard.kind,
            hazard.recipients,
            hazard.traffic,
            hazard.evidence,
            hazard.finding,
            hazard.recommendations,
            active=active,
        )


class RaisedAlerts:
    """Turns hazards into alerts: told once they have lasted, again when they rise, and at the end.

    Parameters
    ----------
    name
        First part of the ids of the alerts.
    persistence_s
        Time for which a severity must hold before it is told.
    release_s
        Time for which a hazard must be gone before that is told.
    """

    def __init__(self, name: str, persistence_s: float, release_s: float) -> None:
        self._name = name
        self._persistence_s = persistence_s
        self._release_s = release_s
        self._ongoing: dict[tuple[str, ...], _Ongoing] = {}
        self._count = 0

    @property
    def has_any(self) -> bool:
        """True if there is a hazard to be judged again even without news."""
        return bool(self._ongoing)

    def update(self, t_ns: int, hazards: Iterable[Hazard]) -> list[Alert]:
        """Return the alerts that are new, have risen, or are over at a time."""
        present: dict[tuple[str, ...], Hazard] = {}
        for hazard in hazards:
            known = present.get(hazard.key)
            if known is None or hazard.severity.rank > known.severity.rank:
                present[hazard.key] = hazard
        alerts = []
        for key, hazard in present.items():
            alerts += self._raise(t_ns, key, hazard)
        for key in [key for key in self._ongoing if key not in present]:
            alerts += self._calm(t_ns, key)
        return alerts

    def _raise(self, t_ns: int, key: tuple[str, ...], hazard: Hazard) -> list[Alert]:
        ongoing = self._ongoing.get(key)
        if ongoing is None:
            self._count += 1
            ongoing = _Ongoing(hazard, Escalation(f"{self._name}-{self._count}"))
            self._ongoing[key] = ongoing
        ongoing.hazard = hazard
        if not ongoing.escalation.rises(hazard.severity, t_ns, self._persistence_s):
            return []
        return [ongoing.alert(active=True)]

    def _calm(self, t_ns: int, key: tuple[str, ...]) -> list[Alert]:
        ongoing = self._ongoing[key]
        if ongoing.escalation.severity is None:
            del self._ongoing[key]
            return []
        if not ongoing.escalation.is_over(t_ns, self._release_s):
            return []
        del self._ongoing[key]
        return [ongoing.alert(active=False)]
