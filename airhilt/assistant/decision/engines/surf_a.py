"""The baseline in the cockpit for runways: alerts from ADS-B In, in the manner of SURF-A."""

from __future__ import annotations

from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.raised_alerts import RaisedAlerts
from airhilt.assistant.decision.situation import RunwaySituation
from airhilt.assistant.decision.surface_alerts import SurfaceAlertConfig, predicted_collisions
from airhilt.engines import Engine
from airhilt.errors import AirhiltError
from airhilt.messages import AdsbReport, Briefing, Message, Severity
from airhilt.units import SECOND_NS

AGAIN_NS = SECOND_NS
"""Period at which a conflict is judged again without news, in ns."""


class SurfaceAlertEngine:
    """Alerts the crew that takes off or lands of traffic on its runway, and nobody else.

    All aircraft with a transponder are taken to have the system. What has no ADS-B is not seen.

    Parameters
    ----------
    responds_from
        Severity from which crews respond: WARNING after AC 25.1322-1; an assumption.
    """

    name = "surf_a"
    reads: tuple[type[Message], ...] = (Briefing, AdsbReport)

    def __init__(
        self,
        configuration: SurfaceAlertConfig | None = None,
        responds_from: Severity = Severity.WARNING,
    ) -> None:
        self.configuration = config = configuration or SurfaceAlertConfig()
        self._responds_from = responds_from
        self._situation: RunwaySituation | None = None
        self._alerts = RaisedAlerts("surf", config.persistence_s, config.release_s)

    def receive(self, received: ReceivedMessage) -> None:
        """Update the traffic with one message."""
        match received.message:
            case Briefing(airport=airport) as briefing if airport is not None and airport.runways:
                self._situation = RunwaySituation(airport, briefing)
            case AdsbReport() as report if self._situation is not None:
                self._situation.take_report(report, received.t_ns)

    def decide(self, t_ns: int) -> Decision:
        """Return the alerts that are new, have risen, or are over."""
        if self._situation is None:
            return Decision()
        self._situation.forget(t_ns)
        found = predicted_collisions(self._situation, self.configuration, self._responds_from, t_ns)
        alerts = self._alerts.update(t_ns, found)
        return Decision(alerts, again_ns=t_ns + AGAIN_NS if self._alerts.has_any else None)


def _engine(argument: str, configuration: SurfaceAlertConfig) -> SurfaceAlertEngine:
    """Return the engine; the argument is the severity from which crews respond.

    Raises
    ------
    AirhiltError
        There are no alerts of that severity.
    """
    severities = {each.value.lower(): each for each in (Severity.CAUTION, Severity.WARNING)}
    severity = severities.get(argument or "warning")
    if severity is None:
        raise AirhiltError(
            f"assistant 'surf_a:{argument}': expected surf_a:{' or surf_a:'.join(severities)}"
        )
    return SurfaceAlertEngine(configuration, severity)


ENGINE = Engine(
    name="surf_a",
    summary="alerts crews of traffic on their runway by ADS-B, in the manner of SURF-A",
    create=_engine,
    argument="SEVERITY",
    configuration=SurfaceAlertConfig,
)
