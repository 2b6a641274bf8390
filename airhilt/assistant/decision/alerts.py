"""Alerts of a decision engine. Each holds one conflict, for all its recipients."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from airhilt.assistant.decision.findings import Finding
from airhilt.messages import AdvisoryKind, Evidence, Recommendation, Severity


@dataclass(frozen=True)
class Alert:
    """One conflict as an engine judges it now. Its worker makes an advisory for each recipient."""

    id: str
    """Name of the conflict, the same for all its alerts. The worker puts its own name before it."""
    revision: int
    """0 for the first alert of a conflict, and 1 more for each that follows."""
    kind: AdvisoryKind
    severity: Severity
    """INFO where the conflict is over."""
    recipients: tuple[str, ...]
    """Callsigns, and `airhilt.messages.CONTROLLER`."""
    traffic: tuple[str, ...]
    """Callsigns of those in conflict."""
    evidence: Evidence
    finding: Finding | None = None
    """The hazard. Without it, a wording has kind, traffic and the note of the evidence."""
    recommendations: Mapping[str, Recommendation] = field(default_factory=dict)
    """Recommended action of each recipient that should act, by callsign."""
    messages: Mapping[str, str] = field(default_factory=dict)
    """Text of each recipient that has one of the engine's own; a wording words the others."""
    active: bool = True
    """False where the conflict is over."""
    t_ready_ns: int | None = None
    """Arrival time of the last input that it rests on; None for the last input of all."""
