"""Questions for what was heard with too little confidence, as alerts to the controller."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.findings import Unclear
from airhilt.assistant.decision.guard import Doubt, Slot
from airhilt.messages import CONTROLLER, Confirm, Evidence, Severity
from airhilt.units import SECOND_NS

ASKED_AGAIN_NS = 60 * SECOND_NS
"""Least time between two questions about the same callsign, in ns: an estimate of
what a controller bears. An answer on a busy frequency takes 10 to 20 s."""


class Clarifications:
    """Asks once for each slot of a call in doubt.

    The controller is asked: one of the two who spoke, and not busy with flying. A question is an
    ADVISORY, because it tells of no conflict. The ids of the alerts begin with the scope.
    """

    def __init__(self, scope: str) -> None:
        self._scope = scope
        self._asked: set[tuple[str, Slot]] = set()
        """Ids of calls, and their slots, that were asked for."""
        self._asked_ns: dict[str, int] = {}
        """Time of the last question about a callsign."""

    def ask(
        self, t_ns: int, doubt: Doubt, traffic: str, runway: str | None = None
    ) -> Iterator[Alert]:
        """Yield the question about a doubt that matters because of traffic, once a minute."""
        call = (doubt.transcript.id, doubt.slot)
        asked_ns = self._asked_ns.get(doubt.callsign)
        if call in self._asked or (asked_ns is not None and t_ns - asked_ns < ASKED_AGAIN_NS):
            return
        self._asked.add(call)
        self._asked_ns[doubt.callsign] = t_ns
        finding = Unclear(doubt.callsign, doubt.slot, doubt.said, doubt.confidence, traffic)
        yield Alert(
            id=f"{self._scope}-clarification-{len(self._asked)}",
            revision=0,
            kind="clarification",
            severity=Severity.ADVISORY,
            recipients=(CONTROLLER,),
            traffic=(doubt.callsign, traffic),
            evidence=Evidence(
                sources=("radio", "adsb"),
                runway=runway,
                note=finding.statement(),
                radio_ids=(doubt.transcript.id,),
                rules=("guard",),
            ),
            finding=finding,
            recommendations={CONTROLLER: Confirm(callsign=doubt.callsign, slot=doubt.slot)},
        )
