"""The controller's short-term conflict alert, as systems on the ground have it."""

from __future__ import annotations

from dataclasses import replace

from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.guard import ConfidenceGuard
from airhilt.assistant.decision.loss_prediction import SeparationConfig
from airhilt.assistant.decision.separation import COASTING_NS, SeparationWatch
from airhilt.engines import Engine
from airhilt.messages import CONTROLLER, AdsbReport, Briefing, Message

LOOK_AHEAD_S = 120.0
"""Time before a loss of separation, in s, from which there is an alert: about two minutes
(EUROCONTROL-GUID-159, edition 1.0)."""


class ConflictAlertEngine:
    """Warns the controller alone where two will lose separation within two minutes.

    Both are taken to fly straight on and to climb or descend as they do; clearances are not known.
    The alert has no recommendation: ICAO Doc 4444, 15.7.2, leaves the action to the controller.
    Assumptions: the minima are those of the briefing, the tracks are those of ADS-B, which the
    surveillance of a centre includes, and an alert must hold for a second.
    """

    name = "conflict_alert"
    reads: tuple[type[Message], ...] = (Briefing, AdsbReport)

    def __init__(self) -> None:
        config = SeparationConfig(
            advisory_s=LOOK_AHEAD_S, caution_s=LOOK_AHEAD_S, warning_s=LOOK_AHEAD_S
        )
        self._watch = SeparationWatch(config, ConfidenceGuard(), advises=False)

    def receive(self, received: ReceivedMessage) -> None:
        """Update tracks with a report, or the minima with the briefing."""
        match received.message:
            case AdsbReport() as report:
                self._watch.take_report(report, received.t_ns)
            case Briefing() as briefing:
                self._watch.take_briefing(briefing)

    def decide(self, t_ns: int) -> Decision:
        """Return the alerts that are new or over."""
        alerts = [replace(alert, recipients=(CONTROLLER,)) for alert in self._watch.judge(t_ns)]
        again_ns = t_ns + COASTING_NS if self._watch.has_conflict else None
        return Decision(alerts, again_ns=again_ns)


ENGINE = Engine(
    name="conflict_alert",
    summary="short-term conflict alert, which warns the controller two minutes before",
    create=lambda _: ConflictAlertEngine(),
)
