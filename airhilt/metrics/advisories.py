"""The advisories of a run: their subjects, their course over revisions, and nuisance alerts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Set
from dataclasses import dataclass, field
from itertools import combinations

from airhilt.messages import (
    CONTROLLER,
    SPEAK_MIN_LEVEL,
    Advisory,
    AdvisoryKind,
    Confirm,
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
Involved = tuple[frozenset[str], float]
"""Actors of a runway incursion, of whom one may be alone, and its begin in s."""
NOBODY = "nobody"
"""Whom an alert is a nuisance to that names nobody."""


@dataclass
class AdvisoryRecord:
    """One advisory over its revisions."""

    first: Advisory
    """The advisory as it was published first."""
    traffic: dict[str, None] = field(default_factory=dict)
    """Whom it has named, in their order."""
    losing: frozenset[str] = frozenset()
    """Callsigns of these that were then going to lose separation from another of them."""
    to_be_seen: frozenset[frozenset[str]] = frozenset()
    """Pairs with somebody of these of which a conflict had begun then, or was to be seen."""
    concerns_conflict: bool = False
    """True if a revision of it was about the annotated pair."""
    shown: frozenset[str] = frozenset()
    """Callsigns of the actors that cameras had really shown shortly before a revision."""
    severity: Severity = Severity.INFO
    """Highest severity of all revisions."""
    revisions: set[int] = field(default_factory=set)
    is_question: bool = True
    """True if all that it asks of anybody is to confirm what was heard."""
    unfounded: dict[str, None] = field(default_factory=dict)
    """Names that it says that it rests on and cannot, in their order."""
    last_s: float = 0.0
    """Time of its last revision."""
    spoken_ns: int | None = None
    """Time at which its voice was first heard, None if it never was."""


class AdvisoryRecords:
    """All advisories of a run, by their ids.

    The callsigns of the actors are by all their names, as `Scenario.callsigns` has them. Without an
    annotated conflict there is no pair. `was_seen` tells whether a camera's detection really showed
    an actor since a time in ns, and `shows` whether a conflict of two has begun, or is to be seen
    by now: who warns of it before that does not know it.
    """

    def __init__(
        self,
        callsigns: Mapping[str, str],
        pair: Pair | None,
        monitor: ConflictMonitor,
        was_seen: Callable[[str, int], bool],
        shows: Callable[[Pair], bool],
    ) -> None:
        self._callsigns = callsigns
        self._pair = pair
        self._monitor = monitor
        self._was_seen = was_seen
        self._shows = shows
        self._records: dict[str, AdvisoryRecord] = {}

    def add(self, advisory: Advisory, unfounded: Iterable[str] = ()) -> bool:
        """Add an advisory and what it cannot rest on; return true if it is a new revision."""
        record = self._records.get(advisory.id)
        if record is None:
            record = AdvisoryRecord(advisory)
            self._records[advisory.id] = record
        if advisory.revision in record.revisions:
            return False
        record.revisions.add(advisory.revision)
        record.is_question &= _is_question(advisory)
        record.unfounded |= dict.fromkeys(unfounded)
        record.last_s = advisory.t_ns / SECOND_NS
        record.severity = max(record.severity, advisory.severity, key=lambda one: one.rank)
        record.traffic |= dict.fromkeys(self._traffic(advisory))
        record.losing |= self._losing(advisory)
        everybody = set(self._callsigns.values())
        named = everybody.intersection(self._traffic(advisory))
        pairs = ((one, other) for one in named for other in everybody - {one})
        record.to_be_seen |= {frozenset(pair) for pair in pairs if self._shows(pair)}
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
            and not _is_question(advisory)
            and advisory.severity.rank >= SPEAK_MIN_LEVEL.rank
            and reaches_somebody
            and self._concerns_conflict(advisory)
        )

    def nuisance_alerts(self, incursions: Iterable[RunwayIncursion]) -> int:
        """Return how often an alert names somebody in no conflict, annotated or real."""
        involved = _involved(incursions)
        return sum(
            len(self._nuisance_to(record, involved))
            for record in self._records.values()
            if record.severity.rank >= SPEAK_MIN_LEVEL.rank
        )

    def clarifications(self) -> int:
        """Return the number of questions for what was heard in doubt."""
        return sum(record.is_question for record in self._records.values())

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
                nuisance_to=self._nuisance_to(record, involved),
                unfounded=tuple(record.unfounded),
            )
            for record in self._records.values()
        ]

    def _concerns_conflict(self, advisory: Advisory) -> bool:
        pair = frozenset(self._pair or ())
        is_of_pair = self._concerns(advisory, pair, self._shown(advisory))
        return self._pair is not None and is_of_pair and self._shows(self._pair)

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

    def _losing(self, advisory: Advisory) -> frozenset[str]:
        known = {name for name in self._traffic(advisory) if name in self._callsigns}
        pairs = combinations(sorted(known), 2)
        return frozenset(name for pair in pairs if self._will_lose(pair) for name in pair)

    def _will_lose(self, pair: Pair) -> bool:
        loss_s = self._monitor.time_to_loss_s(pair)
        return loss_s is not None and loss_s <= JUSTIFIED_WITHIN_S

    def _nuisance_to(self, record: AdvisoryRecord, involved: Iterable[Involved]) -> tuple[str, ...]:
        """Return whom an alert names that is in no conflict, annotated or real.

        In a scenario without a conflict, that are all whom an alert names whose conflict did not
        happen.
        """
        traffic = tuple(record.traffic)
        if record.is_question:
            return ()
        in_conflict: set[str] = set()
        if record.concerns_conflict:
            in_conflict.update(self._pair or ())
        if record.first.kind != "loss_of_separation":
            for actors, t_s in involved:
                is_seen = actors in record.to_be_seen if len(actors) > 1 else t_s <= record.last_s
                if is_seen and self._concerns(record.first, actors, record.shown):
                    in_conflict |= actors
        elif self._pair is not None:
            in_conflict |= record.losing
        if not in_conflict:
            return traffic or (NOBODY,)
        return tuple(
            name for name in traffic if name in self._callsigns and name not in in_conflict
        )


def _is_question(advisory: Advisory) -> bool:
    """Return whether an advisory is a clarification, and tells nobody to do anything else."""
    told = (advisory.recommendation, *advisory.recommendations.values())
    return advisory.kind == CLARIFICATION and all(isinstance(one, Confirm | None) for one in told)


def _involved(incursions: Iterable[RunwayIncursion]) -> list[Involved]:
    return [
        (frozenset(actor for actor in (one.user, one.intruder) if actor is not None), one.t_s)
        for one in incursions
    ]
