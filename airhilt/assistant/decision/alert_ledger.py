"""The alerts that were told, so that only what has changed is told again."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

from airhilt.assistant.decision.alerts import Alert
from airhilt.messages import Severity


class AlertLedger:
    """Turns all alerts that hold now into those that are to be published.

    An alert is published when it is new, when its severity, its recommendations or those concerned
    change, and a last time when it does not hold any more. Its note, its times and its words may
    change without that, because a voice says it again each time.
    """

    def __init__(self) -> None:
        self._told: dict[str, Alert] = {}

    def update(self, holding: Sequence[Alert], again: Collection[str] = ()) -> list[Alert]:
        """Return what is to be published; the revisions of the alerts are set here.

        Alerts whose ids are in `again` are told even if nothing has changed.
        """
        news: list[Alert] = []
        for alert in holding:
            told = self._told.get(alert.id)
            is_same = told is not None and told.active and _judgement(told) == _judgement(alert)
            if not is_same or alert.id in again:
                news.append(replace(alert, revision=0 if told is None else told.revision + 1))
        names = {alert.id for alert in holding}
        over = [told for told in self._told.values() if told.active and told.id not in names]
        for told in over:
            ended = replace(told, active=False, severity=Severity.INFO, recommendations={})
            news.append(replace(ended, revision=told.revision + 1, messages={}))
        self._told |= {alert.id: alert for alert in news}
        return news

    def holding(self) -> dict[str, Alert]:
        """Return the alerts that were told and are not over, by their ids."""
        return {name: alert for name, alert in self._told.items() if alert.active}


def _judgement(alert: Alert) -> tuple[object, ...]:
    """Return the parts of an alert whose change is told."""
    return (
        alert.kind,
        alert.severity,
        alert.recipients,
        alert.traffic,
        sorted((name, repr(each)) for name, each in alert.recommendations.items()),
    )
