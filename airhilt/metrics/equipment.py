"""Alerts of equipment that is in the world besides the assistant under test."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from airhilt.messages import EquipmentAlert
from airhilt.metrics.advisories import AdvisoryRecords
from airhilt.metrics.summary import EquipmentSummary, RunwayIncursion
from airhilt.units import SECOND_NS, ns_to_seconds


class EquipmentRecords:
    """Warnings of each piece of equipment, which is a decision engine, and their times."""

    def __init__(self, engines: Iterable[str], new_records: Callable[[], AdvisoryRecords]) -> None:
        names = [engine.partition(":")[0] for engine in engines]
        self._records: Mapping[str, AdvisoryRecords] = {name: new_records() for name in names}
        self._warned_ns: dict[str, int] = {}
        self._acted_ns: dict[str, int] = {}

    def take(self, alert: EquipmentAlert) -> None:
        """Receive an alert."""
        records = self._records.get(alert.equipment)
        if records is None:
            return
        advisory = alert.advisory.model_copy(update={"t_ns": alert.t_ns})
        records.add(advisory)
        if records.warns_of_conflict(advisory):
            self._warned_ns.setdefault(alert.equipment, alert.t_ns)
            if advisory.recommendation is not None:
                self._acted_ns.setdefault(alert.equipment, alert.t_ns)

    def acts_before(self, t_ns: int | None) -> bool:
        """Return true if any told somebody what to do before a time; None: before the end."""
        return any(t_ns is None or acted_ns < t_ns for acted_ns in self._acted_ns.values())

    def summaries(
        self, warning_ns: int | None, incursions: Iterable[RunwayIncursion]
    ) -> list[EquipmentSummary]:
        """Return what each piece did, and how long after the assistant's first warning."""
        incursions = list(incursions)
        return [
            EquipmentSummary(
                equipment=name,
                t_first_warning_s=ns_to_seconds(self._warned_ns.get(name)),
                t_first_action_s=ns_to_seconds(self._acted_ns.get(name)),
                margin_s=(
                    None
                    if warning_ns is None or name not in self._warned_ns
                    else (self._warned_ns[name] - warning_ns) / SECOND_NS
                ),
                alerts=records.summaries(incursions),
            )
            for name, records in self._records.items()
        ]
