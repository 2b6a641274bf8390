"""The advisories of the assistant as the page shows them, with the evidence that they rest on."""

from __future__ import annotations

from typing import Any

from airhilt.host.text import readable
from airhilt.messages import Advisory, EquipmentAlert
from airhilt.units import SECOND_NS

Json = dict[str, Any]


class AdvisoryRows:
    """Rows of advisories, one for all recipients of a revision."""

    def __init__(self) -> None:
        self._rows: dict[tuple[str, str, int], Json] = {}

    def add(self, message: Advisory | EquipmentAlert) -> Json:
        """Receive an advisory or an alert of equipment, and return its row as it is now."""
        if isinstance(message, EquipmentAlert):
            source, advisory = message.equipment, message.advisory
        else:
            source, advisory = "", message
        key = source, advisory.id, advisory.revision
        row = self._rows.setdefault(key, _row(source, advisory, message.t_ns))
        row["texts"].append(
            {
                "recipient": readable(advisory.recipient),
                "message": readable(advisory.message),
                "recommendation": None
                if advisory.recommendation is None
                else advisory.recommendation.model_dump(mode="json"),
            }
        )
        return row

    def as_json(self) -> list[Json]:
        """Return the rows in the order of their times."""
        return list(self._rows.values())


def _row(source: str, advisory: Advisory, t_ns: int) -> Json:
    return {
        "t": round(t_ns / SECOND_NS, 3),
        "equipment": readable(source),
        "id": readable(advisory.id),
        "revision": advisory.revision,
        "severity": advisory.severity,
        "active": advisory.active,
        "kind": advisory.kind,
        "traffic": [readable(name) for name in advisory.traffic],
        "texts": [],
        "evidence": _readable(advisory.evidence.model_dump(mode="json")),
    }


def _readable(value: Any) -> Any:
    match value:
        case str():
            return readable(value)
        case dict():
            return {readable(key): _readable(inner) for key, inner in value.items()}
        case list():
            return [_readable(inner) for inner in value]
    return value
