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
    """Something that is wrong at one instant, and who is to be told."""

    key: tuple[str, ...]
    """The same for the same hazard, from one instant to the next."""
    severity: Severity
    kind: AdvisoryKind
    recipients: tuple[str, ...]
    traffic: tuple[str, ...]
    evidence: Evidence
    finding: Finding | None = None
    recommendations: Mapping[str, Recommendation] = field(default_factory=dict)


class RaisedAlerts:
    """Turns hazards into alerts: told once they have lasted, again when they rise, and at the end.

    A severity must hold for ``persistence_s`` before it is told, and a hazard be gone for
    ``release_s``. The ids of the alerts begin with the name.
    """

    def __init__(self, name: str, persistence_s: float, release_s: float) -> None:
        self._name = name
        self._persistence_s = persistence_s
        self._release_s = release_s
        self._ongoing: dict[tuple[str, ...], tuple[Escalation, Hazard]] = {}
        """Each hazard from first suspicion to its end, as it was last."""
        self._count = 0

    @property
    def has_any(self) -> bool:
        """True if there is a hazard to be judged again even without news."""
        return bool(self._ongoing)

    def update(self, t_ns: int, hazards: Iterable[Hazard]) -> list[Alert]:
        """Return the alerts that are new, have risen, or are over at a time."""
        present: dict[tuple[str, ...], Hazard] = {}
        for hazard in hazards:
            known = present.setdefault(hazard.key, hazard)
            if hazard.severity.rank > known.severity.rank:
                present[hazard.key] = hazard
        alerts = []
        for key, hazard in present.items():
            if key not in self._ongoing:
                self._count += 1
                self._ongoing[key] = Escalation(f"{self._name}-{self._count}"), hazard
            escalation, _ = self._ongoing[key]
            self._ongoing[key] = escalation, hazard
            if escalation.rises(hazard.severity, t_ns, self._persistence_s):
                alerts.append(_alert(escalation, hazard, active=True))
        for key in [key for key in self._ongoing if key not in present]:
            escalation, hazard = self._ongoing[key]
            if escalation.severity is None:
                del self._ongoing[key]
            elif escalation.is_over(t_ns, self._release_s):
                del self._ongoing[key]
                alerts.append(_alert(escalation, hazard, active=False))
        return alerts


def _alert(escalation: Escalation, hazard: Hazard, *, active: bool) -> Alert:
    return escalation.alert(
        hazard.kind,
        hazard.recipients,
        hazard.traffic,
        hazard.evidence,
        hazard.finding,
        hazard.recommendations,
        active=active,
    )
