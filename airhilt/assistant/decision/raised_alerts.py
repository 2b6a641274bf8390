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


@dataclass(slots=True)
class _Ongoing:
    """One hazard from first suspicion to its end."""

    escalation: Escalation
    hazard: Hazard
    """The hazard as it was last."""
    told: Mapping[str, Recommendation] = field(default_factory=dict)
    """Recommendation that each was told last."""


class RaisedAlerts:
    """Turns hazards into alerts: told once they have lasted, again when they rise, and at the end.

    A hazard has a recommendation for those alone who do not do so already: they are told when it
    changes, and a WARNING again. A severity must hold for ``persistence_s`` before it is told, and
    a hazard be gone for ``release_s``. The ids of the alerts begin with the name.
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
            known = present.setdefault(hazard.key, hazard)
            if hazard.severity.rank > known.severity.rank:
                present[hazard.key] = hazard
        alerts = []
        for key, hazard in present.items():
            if key not in self._ongoing:
                self._count += 1
                self._ongoing[key] = _Ongoing(Escalation(f"{self._name}-{self._count}"), hazard)
            ongoing, advice = self._ongoing[key], hazard.recommendations
            ongoing.hazard = hazard
            has_risen = ongoing.escalation.rises(hazard.severity, t_ns, self._persistence_s)
            news = ongoing.escalation.changes(
                t_ns,
                other=[name for name in advice if advice[name] != ongoing.told.get(name)],
                ignoring=tuple(advice),
            )
            if has_risen or news:
                ongoing.told = {**ongoing.told, **advice}
                alerts.append(_alert(ongoing, active=True))
        for key in [key for key in self._ongoing if key not in present]:
            ongoing = self._ongoing[key]
            if ongoing.escalation.severity is None:
                del self._ongoing[key]
            elif ongoing.escalation.is_over(t_ns, self._release_s):
                del self._ongoing[key]
                alerts.append(_alert(ongoing, active=False))
        return alerts


def _alert(ongoing: _Ongoing, *, active: bool) -> Alert:
    hazard = ongoing.hazard
    return ongoing.escalation.alert(
        hazard.kind,
        hazard.recipients,
        hazard.traffic,
        hazard.evidence,
        hazard.finding,
        hazard.recommendations,
        active=active,
    )
