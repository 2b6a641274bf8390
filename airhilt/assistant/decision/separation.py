"""Conflicts in the air (S02A, S02B).

Losses of separation are foreseen from the tracks, and readbacks of levels are compared with
clearances. A conflict has one alert, which escalates.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from airhilt.assistant.decision.advice import Advice
from airhilt.assistant.decision.aerodrome import TrafficZone
from airhilt.assistant.decision.air_tracks import AirTracks, Pair, Reach
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.clarifications import Clarifications
from airhilt.assistant.decision.escalation import Escalation
from airhilt.assistant.decision.findings import LevelMisread, LossOfSeparation
from airhilt.assistant.decision.guard import ConfidenceGuard
from airhilt.assistant.decision.level_readbacks import LevelReadbacks
from airhilt.assistant.decision.loss_prediction import (
    Prediction,
    SeparationConfig,
    SeparationStandard,
    predict,
)
from airhilt.assistant.decision.resolution import CLOSE, Senses, margin_of, resolve
from airhilt.messages import (
    CONTROLLER,
    AdsbReport,
    Briefing,
    Evidence,
    MaintainLevel,
    Severity,
    Transcript,
)
from airhilt.units import FOOT, NAUTICAL_MILE, SECOND_NS

COASTING_NS = SECOND_NS
"""Time without a report, in ns, after which a conflict is judged by its extrapolated tracks."""


@dataclass(slots=True)
class _Conflict:
    """One conflict from first suspicion to its end."""

    pair: Pair
    escalation: Escalation
    advice: tuple[Advice, Advice] | None = None
    """Advice that the two crews were told last; None before that."""


class SeparationWatch:
    """Watches the aircraft in flight.

    Aircraft on the ground are no part of it, and neither are two that are both near an airport
    with a tower, which separates them by sight (FAA Order JO 7110.65, 7-2-1). Where it does not
    advise, it tells of conflicts alone, and not what to do.
    """

    def __init__(
        self, config: SeparationConfig, guard: ConfidenceGuard, *, advises: bool = True
    ) -> None:
        self.config = SeparationStandard(**config.model_dump())
        self._advises = advises
        self._zone: TrafficZone | None = None
        self._tracks = AirTracks()
        self._readbacks = LevelReadbacks(self._tracks, guard)
        self._clarifications = Clarifications("level")
        self._conflicts: dict[Pair, _Conflict] = {}
        self._misread: list[Alert] = []
        self._count = 0

    @property
    def has_conflict(self) -> bool:
        """True if there is a conflict to be judged again even without news."""
        return bool(self._conflicts)

    def take_briefing(self, briefing: Briefing) -> None:
        """Set the minima, and where a tower separates."""
        self.config = self.config.model_copy(
            update={
                "horizontal_m": briefing.horizontal_separation_nm * NAUTICAL_MILE,
                "vertical_m": briefing.vertical_separation_ft * FOOT,
            }
        )
        self._zone = TrafficZone.of(briefing.airport) if briefing.airport else None
        self._readbacks.take_roster(briefing.roster)

    def take_report(self, report: AdsbReport, t_ns: int) -> None:
        """Update the track of an aircraft at a time."""
        self._tracks.take_report(report, t_ns)

    def take_transcript(self, t_ns: int, t_in_ns: int, transcript: Transcript) -> None:
        """Update cleared levels with a call; a wrong readback is told when judged next."""
        misread = self._readbacks.take_transcript(t_ns, transcript, self.config)
        if misread is not None and "level_readback" in self.config.rules:
            self._misread.append(self._misread_alert(misread, t_in_ns))

    def _misread_alert(self, misread: LevelMisread, t_in_ns: int) -> Alert:
        self._count += 1
        return Alert(
            id=f"readback-{self._count}",
            revision=0,
            kind="readback_mismatch",
            severity=Severity.CAUTION,
            recipients=(misread.callsign, CONTROLLER),
            traffic=(misread.callsign, misread.traffic),
            evidence=Evidence(
                sources=("radio", "adsb"),
                note=misread.statement(),
                radio_ids=misread.radio_ids,
                tracks=self._tracks.addresses(misread.callsign, misread.traffic),
                rules=("level_readback",),
            ),
            finding=misread,
            recommendations={misread.callsign: MaintainLevel(altitude_ft=misread.cleared_ft)},
            t_ready_ns=t_in_ns,
        )

    def judge(self, t_ns: int) -> list[Alert]:
        """Return the alerts that are new, have risen, or are over."""
        alerts, self._misread = self._misread, []
        for doubt, traffic in self._readbacks.doubts(t_ns, self.config):
            alerts += self._clarifications.ask(t_ns, doubt, traffic)
        pairs = self._pairs_with_news(t_ns)
        for pair in [*pairs, *self._tracks.silent(self._conflicts, t_ns, COASTING_NS)]:
            alerts += self._judge(t_ns, pair)
        self._tracks.end_step()
        return alerts

    def observe(self, t_ns: int) -> None:
        """Note the conflicts at a time at which nothing is told; tracks with news keep it."""
        for pair in self._pairs_with_news(t_ns):
            level = self.config.severity_of(self._predict(t_ns, pair).time_to_loss_s)
            conflict = self._conflict_of(pair, level)
            if conflict is not None:
                conflict.escalation.observe(level, t_ns)

    def _pairs_with_news(self, t_ns: int) -> list[Pair]:
        config = self.config
        reach = Reach(config.horizontal_m, config.vertical_m, config.advisory_s + config.stale_s)
        return self._tracks.pairs_with_news(t_ns, reach, config.stale_s, self._conflicts)

    def _conflict_of(self, pair: Pair, level: Severity | None) -> _Conflict | None:
        conflict = self._conflicts.get(pair)
        if conflict is None and level is not None:
            self._count += 1
            conflict = _Conflict(pair, Escalation(f"separation-{self._count}"))
            self._conflicts[pair] = conflict
        return conflict

    def _judge(self, t_ns: int, pair: Pair) -> list[Alert]:
        prediction = self._predict(t_ns, pair)
        level = self.config.severity_of(prediction.time_to_loss_s)
        conflict = self._conflict_of(pair, level)
        if conflict is None:
            return []
        if level is None:
            return self._calm(t_ns, conflict, prediction)
        escalation = conflict.escalation
        has_risen = escalation.rises(level, t_ns, self.config.persistence_s)
        before, ignoring = conflict.advice, frozenset[str]()
        is_open = before is None or not prediction.draws_apart
        if self._advises and escalation.is_for_crews and is_open:
            ignoring = self._advise(t_ns, conflict, prediction, anew=has_risen)
        changed = zip(prediction.callsigns, before or (), conflict.advice or (), strict=False)
        other = [name for name, old, new in changed if old.recommendation != new.recommendation]
        news = escalation.changes(t_ns, other=other, ignoring=ignoring)
        if has_risen:
            return [self._alert(conflict, prediction)]
        return [self._alert(conflict, prediction, news)] if news else []

    def _advise(
        self, t_ns: int, conflict: _Conflict, prediction: Prediction, *, anew: bool
    ) -> frozenset[str]:
        """Judge the advice in force again, and return the crews that do not do as told.

        It is kept while what both crews do of it keeps separation, and while they have time to
        respond. It is replaced by what keeps markedly more, and where the severity has risen by the
        best (``anew``). Nobody is told to climb after a descent, or the other way round, unless the
        two come close by what they do.
        """
        tracks, before = (prediction.first, prediction.second), conflict.advice
        told, departs = None, (False, False)
        senses: Senses = (None, None)
        ignoring = frozenset[str]()
        if before is not None:
            first, second = (
                (track, *each.expected(track)) for track, each in zip(tracks, before, strict=True)
            )
            doing = [each.adherence(track) for track, each in zip(tracks, before, strict=True)]
            one, other = (each == "departs" for each in doing)
            named = zip(prediction.callsigns, doing, strict=True)
            ignoring = frozenset(name for name, each in named if each == "departs")
            is_fresh = conflict.escalation.is_fresh(t_ns) and not ignoring and not anew
            if is_fresh or margin_of(first, second, self.config.infringed) >= 1.0:
                return ignoring
            told, departs = (before[0].left(tracks[0]), before[1].left(tracks[1])), (one, other)
            if margin_of(first, second, CLOSE) >= 1.0:
                senses = before[0].sense, before[1].sense
        resolution = resolve(
            *tracks,
            [track.at(t_ns) for track in self._tracks if track.icao24 not in conflict.pair],
            self.config.standard,
            self.config.infringed,
            strong=told is not None and conflict.escalation.severity is Severity.WARNING,
            told=None if anew else told,
            departs=departs,
            senses=senses,
        )
        if resolution.manoeuvres != told:
            one_before, other_before = before or (None, None)
            one_flown, other_flown = resolution.manoeuvres
            conflict.advice = (
                Advice.of(resolution.first, one_flown, prediction.first, one_before),
                Advice.of(resolution.second, other_flown, prediction.second, other_before),
            )
        return ignoring

    def _predict(self, t_ns: int, pair: Pair) -> Prediction:
        first, second = (self._tracks.present(icao24, t_ns) for icao24 in pair)
        is_on_ground = self._tracks.is_grounded(first) or self._tracks.is_grounded(second)
        conflict = self._conflicts.get(pair)
        is_told = conflict is not None and conflict.escalation.is_for_crews
        return predict(first, second, self.config, self._zone, is_on_ground, is_told)

    def _calm(self, t_ns: int, conflict: _Conflict, prediction: Prediction) -> list[Alert]:
        """End a conflict once it is over for good.

        While a recommendation is followed, or one of the two turns, the prediction is clear, but
        going back would bring the conflict back: it stays until the two are past each other. If
        it does come back, it is told again.
        """
        if conflict.escalation.severity is None:
            del self._conflicts[conflict.pair]
            return []
        if not prediction.is_over and conflict.escalation.is_for_crews:
            conflict.escalation.stays_open(t_ns, self.config.release_s)
            return []
        if not conflict.escalation.is_over(t_ns, self.config.release_s):
            return []
        del self._conflicts[conflict.pair]
        return [self._alert(conflict, prediction, active=False)]

    def _alert(
        self,
        conflict: _Conflict,
        prediction: Prediction,
        crews: Collection[str] | None = None,
        *,
        active: bool = True,
    ) -> Alert:
        """Return the alert about a conflict; crews are told from CAUTION on, all unless given."""
        escalation, callsigns = conflict.escalation, prediction.callsigns
        told = tuple(name for name in callsigns if crews is None or name in crews)
        return escalation.alert(
            kind="loss_of_separation",
            recipients=(*told, CONTROLLER) if escalation.is_for_crews else (CONTROLLER,),
            traffic=callsigns,
            evidence=prediction.evidence(),
            finding=LossOfSeparation(callsigns, prediction.time_to_loss_s),
            recommendations={
                callsign: each.recommendation
                for callsign, each in zip(callsigns, conflict.advice or (), strict=False)
                if each.recommendation is not None
            },
            active=active,
        )
