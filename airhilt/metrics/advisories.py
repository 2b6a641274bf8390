"""The advisories of a run: their subjects, their course over revisions, and nuisance alerts."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from itertools import combinations
from typing import NamedTuple

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


class _Telling(NamedTuple):
    """Content of one telling of an advisory, and the truth at that time."""

    kind: AdvisoryKind
    sources: tuple[str, ...]
    traffic: tuple[str, ...]
    named: tuple[str, ...]
    """Whom it names as traffic, or tells what to do."""
    losing: frozenset[str]
    """Callsigns of its traffic that were going to lose separation from another of it."""
    to_be_seen: frozenset[frozenset[str]]
    """Pairs with somebody of its traffic of which a conflict had begun, or was to be seen."""
    concerns_conflict: bool
    """True if it was about the annotated pair."""
    shown: frozenset[str]
    """Callsigns of the actors that cameras had really shown shortly before."""


@dataclass
class _Alert:
    """An advisory from when it becomes active until it ends."""

    tellings: list[_Telling] = field(default_factory=list)
    last_s: float = 0.0
    """Time of its last revision."""


@dataclass
class AdvisoryRecord:
    """One advisory over its revisions."""

    first: Advisory
    """The advisory as it was published first."""
    alerts: list[_Alert] = field(default_factory=list)
    """Its times of being active; the last one goes on while it is."""
    is_active: bool = False
    severity: Severity = Severity.INFO
    """Highest severity of all revisions."""
    revisions: set[int] = field(default_factory=set)
    is_question: bool = True
    """True if all that it asks of anybody is to confirm what was heard."""
    unfounded: dict[str, None] = field(default_factory=dict)
    """Names that it says that it rests on and cannot, in their order."""
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
        is_new = advisory.revision not in record.revisions
        record.revisions.add(advisory.revision)
        record.is_question &= _is_question(advisory)
        record.unfounded |= dict.fromkeys(unfounded)
        record.severity = max(record.severity, advisory.severity, key=lambda one: one.rank)
        if advisory.active and not record.is_active:
            record.alerts.append(_Alert())
        record.is_active = advisory.active
        if advisory.active:
            record.alerts[-1].last_s = advisory.t_ns / SECOND_NS
            if advisory.severity.rank >= SPEAK_MIN_LEVEL.rank and not _is_question(advisory):
                telling = self._telling(advisory)
                if telling not in record.alerts[-1].tellings[-1:]:
                    record.alerts[-1].tellings.append(telling)
        return is_new

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
        """Return how often an alert concerns somebody in no conflict, annotated or real.

        It counts once for each whom it names or tells what to do, each time that it is active.
        """
        involved = _involved(incursions)
        return sum(
            len(self._nuisance_to(alert, involved))
            for record in self._records.values()
            for alert in record.alerts
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
                nuisance_to=tuple(
                    dict.fromkeys(
                        name
                        for alert in record.alerts
                        for name in self._nuisance_to(alert, involved)
                    )
                ),
                unfounded=tuple(record.unfounded),
            )
            for record in self._records.values()
        ]

    def _telling(self, advisory: Advisory) -> _Telling:
        traffic = self._traffic(advisory)
        everybody = set(self._callsigns.values())
        known = everybody.intersection(traffic)
        pairs = ((one, other) for one in known for other in everybody - {one})
        return _Telling(
            kind=advisory.kind,
            sources=advisory.evidence.sources,
            traffic=traffic,
            named=tuple(dict.fromkeys((*traffic, *self._ordered(advisory)))),
            losing=self._losing(advisory),
            to_be_seen=frozenset(frozenset(pair) for pair in pairs if self._shows(pair)),
            concerns_conflict=self._concerns_conflict(advisory),
            shown=self._shown(advisory),
        )

    def _ordered(self, advisory: Advisory) -> Iterator[str]:
        """Yield the callsigns of those whom an advisory tells what to do."""
        told = {advisory.recipient: advisory.recommendation, **advisory.recommendations}
        for name, order in told.items():
            if name in self._callsigns and not isinstance(order, Confirm | None):
                yield self._callsigns[name]

    def _concerns_conflict(self, advisory: Advisory) -> bool:
        pair = frozenset(self._pair or ())
        is_of_pair = self._concerns(
            self._traffic(advisory), advisory.evidence.sources, pair, self._shown(advisory)
        )
        return self._pair is not None and is_of_pair and self._shows(self._pair)

    def _concerns(
        self, traffic: Iterable[str], sources: Collection[str], actors: Set[str], shown: Set[str]
    ) -> bool:
        """Return true if an advisory of some traffic is about actors that are in one conflict.

        It names all of them, whoever else, or one and nothing else with a callsign. What rests on
        cameras must then have shown another one, whatever it was taken for; what rests on ADS-B
        alone must name all.
        """
        named = {name for name in traffic if name in self._callsigns}
        if actors and actors <= named:
            return True
        if not named or not named <= actors:
            return False
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

    def _nuisance_to(self, alert: _Alert, involved: Sequence[Involved]) -> tuple[str, ...]:
        """Return whom an alert concerns that was in no conflict by then, annotated or real.

        In a scenario without a conflict, that are all whom an alert names whose conflict did not
        happen. What is told before a conflict shows is not excused by what is told afterwards.
        """
        in_conflict: set[str] = set()
        found: dict[str, None] = {}
        for telling in alert.tellings:
            in_conflict |= self._in_conflict(telling, involved, alert.last_s)
            if in_conflict:
                strangers = [name for name in telling.named if name in self._callsigns]
                found |= dict.fromkeys(name for name in strangers if name not in in_conflict)
            else:
                found |= dict.fromkeys(telling.named or (NOBODY,))
        return tuple(found)

    def _in_conflict(
        self, telling: _Telling, involved: Iterable[Involved], last_s: float
    ) -> set[str]:
        """Return who is in a conflict that is told of, annotated or real."""
        found: set[str] = set()
        if telling.concerns_conflict:
            found.update(self._pair or ())
        if telling.kind != "loss_of_separation":
            for actors, t_s in involved:
                is_seen = actors in telling.to_be_seen if len(actors) > 1 else t_s <= last_s
                about = telling.traffic, telling.sources, actors, telling.shown
                if is_seen and self._concerns(*about):
                    found |= actors
        elif self._pair is not None:
            found |= telling.losing
        return found


def _is_question(advisory: Advisory) -> bool:
    """Return whether an advisory is a clarification, and tells nobody to do anything else."""
    told = (advisory.recommendation, *advisory.recommendations.values())
    return advisory.kind == CLARIFICATION and all(isinstance(one, Confirm | None) for one in told)


def _involved(incursions: Iterable[RunwayIncursion]) -> list[Involved]:
    return [
        (frozenset(actor for actor in (one.user, one.intruder) if actor is not None), one.t_s)
        for one in incursions
    ]
