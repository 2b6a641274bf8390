"""The advisories of a run: their subjects, their course over revisions, and nuisance alerts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Set
from dataclasses import dataclass, field

from airhilt.messages import (
    CONTROLLER,
    SPEAK_MIN_LEVEL,
    Advisory,
    AdvisoryKind,
    Severity,
)
from airhilt.metrics.summary import AdvisorySummary, RunwayIncursion
from airhilt.units import SECOND_NS, ns_to_seconds
from airhilt.world.truth.conflicts import ConflictMonitor, Pair

JUSTIFIED_WITHIN_S = 300.0
"""An alert is no nuisance if its traffic will really lose separation within this time, in s."""
SEEN_WITHIN_NS = 10 * SECOND_NS
"""Time before an advisory, in ns, in which a camera must have shown what it is about."""


CLARIFICATION: AdvisoryKind = "clarification"


@dataclass
class AdvisoryRecord:
    """One advisory over its revisions."""

    first: Advisory
    """The advisory as it was published first."""
    loses_separation: bool
    """True if its traffic was then going to lose separation."""
    concerns_conflict: bool = False
    """True if a revision of it was about the annotated pair."""
    shown: frozenset[str] = frozenset()
    """Callsigns of the actors that cameras had really shown shortly before a revision."""
    severity: Severity = Severity.INFO
    """Highest severity of all revisions."""
    revisions: set[int] = field(default_factory=set)
    spoken_ns: int | None = None
    """Time at which its voice was first heard, None if it never was."""


class AdvisoryRecords:
    """All advisories of a run, by their ids.

    The callsigns of the actors are by all their names, as `Scenario.callsigns` has them. Without an
    annotated conflict there is no pair. `was_seen` tells whether a camera's detection really showed
    an actor since a time in ns.
    """

    def __init__(
        self,
        callsigns: Mapping[str, str],
        pair: Pair | None,
        monitor: ConflictMonitor,
        was_seen: Callable[[str, int], bool],
    ) -> None:
        self._callsigns = callsigns
        self._pair = pair
        self._monitor = monitor
        self._was_seen = was_seen
        self._records: dict[str, AdvisoryRecord] = {}

    def add(self, advisory: Advisory) -> bool:
        """Add an advisory; return true if it is a new revision."""
        record = self._records.get(advisory.id)
        if record is None:
            record = AdvisoryRecord(advisory, self._loses_separation(advisory))
            self._records[advisory.id] = record
        if advisory.revision in record.revisions:
            return False
        record.revisions.add(advisory.revision)
        record.severity = max(record.severity, advisory.severity, key=lambda one: one.rank)
        record.concerns_conflict |= self._concerns_conflict(advisory)
        record.shown |= self._shown(advisory)
        return True

    def add_voice(self, identity: str, t_ns: int) -> None:
        """Add when the voice of an advisory began."""
        record = self._records.get(identity)
        if record is not None and record.spoken_ns is None:
            record.spoken_ns = t_ns

    def warns_of_conflict(self, advisory: Advisory) -> bool:
        """Return true if an advisory warns somebody in the run of the annotated conflict."""
        reaches_somebody = advisory.recipient == CONTROLLER or advisory.recipient in self._callsigns
        return (
            advisory.active
            and advisory.kind != CLARIFICATION
            and advisory.severity.rank >= SPEAK_MIN_LEVEL.rank
            and reaches_somebody
            and self._concerns_conflict(advisory)
        )

    def nuisance_alerts(self, incursions: Iterable[RunwayIncursion]) -> int:
        """Return the number of alerts about traffic in no conflict, annotated or real."""
        involved = _involved(incursions)
        return sum(
            record.severity.rank >= SPEAK_MIN_LEVEL.rank and self._is_nuisance(record, involved)
            for record in self._records.values()
        )

    def clarifications(self) -> int:
        """Return the number of questions for what was heard in doubt."""
        return sum(record.first.kind == CLARIFICATION for record in self._records.values())

    def summaries(self, incursions: Iterable[RunwayIncursion]) -> list[AdvisorySummary]:
        """Return each advisory with its course."""
        involved = _involved(incursions)
        return [
            AdvisorySummary(
                id=record.first.id,
                kind=record.first.kind,
                traffic=self._traffic(record.first),
                t_first_s=record.first.t_ns / SECOND_NS,
                t_spoken_s=ns_to_seconds(record.spoken_ns),
                severity=record.severity,
                revisions=len(record.revisions),
                nuisance=self._is_nuisance(record, involved),
            )
            for record in self._records.values()
        ]

    def _concerns_conflict(self, advisory: Advisory) -> bool:
        pair = frozenset(self._pair or ())
        return self._concerns(advisory, pair, self._shown(advisory))

    def _concerns(self, advisory: Advisory, actors: Set[str], shown: Set[str]) -> bool:
        """Return true if an advisory is about some actors that are in one conflict.

        It names all of them, whoever else, or one and nothing else with a callsign. What rests on
        cameras must then have shown another one, whatever it was taken for; what rests on ADS-B
        alone must name all.
        """
        named = {name for name in self._traffic(advisory) if name in self._callsigns}
        if actors and actors <= named:
            return True
        if not named or not named <= actors:
            return False
        sources = advisory.evidence.sources
        if "vision" in sources:
            return not shown.isdisjoint(actors - named)
        return "radio" in sources

    def _shown(self, advisory: Advisory) -> frozenset[str]:
        since_ns = advisory.t_ns - SEEN_WITHIN_NS
        callsigns = set(self._callsigns.values())
        return frozenset(name for name in callsigns if self._was_seen(name, since_ns))

    def _traffic(self, advisory: Advisory) -> tuple[str, ...]:
        """Return the callsigns of an advisory's traffic, and names that no actor has."""
        return tuple(self._callsigns.get(name, name) for name in advisory.traffic)

    def _loses_separation(self, advisory: Advisory) -> bool:
        traffic = advisory.traffic
        if len(traffic) != 2 or not all(name in self._callsigns for name in traffic):
            return False
        first, second = self._traffic(advisory)
        loss_s = self._monitor.time_to_loss_s((first, second))
        return loss_s is not None and loss_s <= JUSTIFIED_WITHIN_S

    def _is_nuisance(self, record: AdvisoryRecord, involved: Iterable[frozenset[str]]) -> bool:
        """Return true if the traffic is in no conflict, annotated or real.

        In a scenario without a conflict, every alert is a nuisance whose conflict did not happen.
        """
        if record.concerns_conflict or record.first.kind == CLARIFICATION:
            return False
        if record.first.kind == "loss_of_separation":
            return self._pair is None or not record.loses_separation
        return not any(self._concerns(record.first, actors, record.shown) for actors in involved)


def _involved(incursions: Iterable[RunwayIncursion]) -> list[frozenset[str]]:
    return [
        frozenset(actor for actor in (one.user, one.intruder) if actor is not None)
        for one in incursions
    ]
