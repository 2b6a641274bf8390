"""Alerts of a decision engine: one a conflict, as structure, for all its recipients."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from airhilt.assistant.decision.findings import Finding
from airhilt.messages import AdvisoryKind, Evidence, Recommendation, Severity


@dataclass(frozen=True)
class Alert:
    """One conflict as an engine judges it now. Its worker makes an advisory for each recipient.

    Attributes
    ----------
    id
        Name of the conflict, the same from its first alert to its last. The worker puts its own
        name before it.
    revision
        0 for the first alert of a conflict, and 1 more for each that follows.
    severity
        INFO where the conflict is over.
    recipients
        Callsigns, and `airhilt.messages.CONTROLLER`.
    traffic
        Callsigns of those in conflict.
    finding
        The hazard in words. Without it, a wording has kind, traffic and the note of the evidence.
    recommendations
        Recommended action of each recipient that should act, by callsign.
    messages
        Text of each recipient that has one of the engine's own; a wording words the others.
    active
        False where the conflict is over.
    t_ready_ns
        Arrival time of the last input that it rests on; None for the last input of all.
    """

    id: str
    revision: int
    kind: AdvisoryKind
    severity: Severity
    recipients: tuple[str, ...]
    traffic: tuple[str, ...]
    evidence: Evidence
    finding: Finding | None = None
    recommendations: Mapping[str, Recommendation] = field(default_factory=dict)
    messages: Mapping[str, str] = field(default_factory=dict)
    active: bool = True
    t_ready_ns: int | None = None
