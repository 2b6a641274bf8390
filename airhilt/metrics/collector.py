"""Gathers what a run says of itself, and makes the summary of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from airhilt.messages import (
    CONTROLLER,
    SPEAK_MIN_LEVEL,
    AdsbReport,
    Advisory,
    AdvisoryAudio,
    ConflictTruth,
    Detections,
    Event,
    Message,
    Modality,
    ModalityState,
    Severity,
    Status,
    Transcript,
)
from airhilt.metrics.calls import TEXT, CallRecords
from airhilt.metrics.detection_scores import DetectionScores
from airhilt.metrics.plans import Plans
from airhilt.metrics.summary import (
    ClosestApproach,
    LatencyStatistics,
    RunwayIncursion,
    Summary,
    ToldAdvisory,
    severest,
)
from airhilt.scenario.models import AircraftSpec, Scenario, VehicleSpec, WildlifeSpec
from airhilt.sim import StepRecord
from airhilt.surveillance import tcas
from airhilt.units import SECOND_NS
from airhilt.world.truth.conflicts import ConflictMonitor, Pair, PairTruth
from airhilt.world.truth.runways import IncursionCategory, RunwayMonitor

JUSTIFIED_WITHIN_S = 300.0
"""An alert about other traffic is no nuisance if that traffic will really lose separation within
this time."""
SEVEREST_FIRST: tuple[IncursionCategory, ...] = ("accident", "A", "B", "C", "D")
SERIOUS = frozenset(SEVEREST_FIRST[:3])


@dataclass
class _Told:
    """One advisory over its revisions."""

    advisory: Advisory
    loses_separation: bool
    """Whether its traffic was going to, when it was told."""
    severities: list[Severity] = field(default_factory=list)
    revisions: set[int] = field(default_factory=set)
    spoken_ns: int | None = None


@dataclass
class ConflictWindow:
    """When the annotated conflict opened and closed."""

    opened_ns: int | None = None
    closed_ns: int | None = None


class Collector:
    """Listens to a run.

    Attributes
    ----------
    window
        Kept by the run, which knows the annotation.
    modalities
        Kept by the run.
    """

    def __init__(
        self,
        scenario: Scenario,
        ground_m: float,
        monitor: ConflictMonitor,
        runways: RunwayMonitor | None,
        plans: Plans,
    ) -> None:
        self.window = ConflictWindow()
        self.modalities: dict[Modality, ModalityState] = {}
        self.ended_actors: dict[str, str] = {}
        self.last_advisory: Advisory | None = None
        self._scenario = scenario
        self._ground_m = ground_m
        self._monitor = monitor
        self._runways = runways
        self._plans = plans
        self._pair = pair_of(scenario)
        self._callsigns = {actor.callsign: actor.callsign for actor in scenario.actors} | {
            actor.icao24: actor.callsign
            for actor in scenario.actors
            if not isinstance(actor, WildlifeSpec)
        }
        self._told: dict[str, _Told] = {}
        self._calls = CallRecords()
        self._sight = DetectionScores()
        self._latencies_s: dict[str, list[float]] = {
            stage: [] for stage in ("adsb", "asr", "asr_after_end", "vision", "decision", "tts")
        }
        self._unspoken: set[tuple[str, str, int]] = set()
        """Warnings of the conflict that wait for their voice, by id, recipient and revision."""
        self._first_warning_ns: int | None = None
        self._projection: tcas.Projection | None = None

    def take(self, key: str, message: Message, data: bytes) -> None:  # noqa: ARG002
        """Take in a published message."""
        match message:
            case ConflictTruth(phase="opened", t_ns=now_ns):
                self.window.opened_ns = now_ns
            case ConflictTruth(phase="closed", t_ns=now_ns):
                self.window.closed_ns = now_ns
            case Event(kind="actor_ended", subject=callsign, text=cause):
                self.ended_actors[callsign] = cause
            case AdsbReport(t_adsb_in_ns=begin, t_adsb_out_ns=end):
                self._late("adsb", begin, end)
            case Advisory():
                self._take_advisory(message)
            case AdvisoryAudio():
                self._take_voice(message)
            case Detections(t_frame_ns=begin, t_ns=end, missed=""):
                self._late("vision", begin, end)
            case Status(modality=modality, state=state, t_ns=now_ns):
                self.modalities[modality] = state
                if modality == "tts" and state == "lost" and self._unspoken:
                    self._warned(now_ns)
            case Transcript(t_tx_ns=begin, t_end_ns=said, t_ns=end, engine=engine):
                if engine != TEXT:
                    self._late("asr", begin, end)
                    self._late("asr_after_end", said, end)
        self._calls.take(message)
        self._sight.take(message)

    def _late(self, stage: str, begin_ns: int, end_ns: int) -> None:
        self._latencies_s[stage].append((end_ns - begin_ns) / SECOND_NS)

    def step(self, record: StepRecord) -> None:
        """Take in a finished step of a worker."""
        waited_ns = record.t_start_ns - record.t_in_ns + record.latency_ns
        self._latencies_s.setdefault(f"{record.worker}_step", []).append(waited_ns / SECOND_NS)

    def _take_advisory(self, advisory: Advisory) -> None:
        told = self._told.get(advisory.id)
        if told is None:
            told = _Told(advisory, self._loses_separation(advisory))
            self._told[advisory.id] = told
        if advisory.revision not in told.revisions:
            told.revisions.add(advisory.revision)
            told.severities.append(advisory.severity)
            self._late("decision", advisory.t_ready_ns, advisory.t_ns)
        if not advisory.active:
            return
        self.last_advisory = advisory
        if (
            self._first_warning_ns is None
            and advisory.severity.rank >= SPEAK_MIN_LEVEL.rank
            and self._reaches_somebody(advisory)
            and self._concerns_conflict(advisory)
        ):
            if self.modalities.get("tts") == "on":
                self._unspoken.add((advisory.id, advisory.recipient, advisory.revision))
            else:
                self._warned(advisory.t_ns)

    def _take_voice(self, audio: AdvisoryAudio) -> None:
        self._late("tts", audio.t_dec_ns, audio.t_ns)
        told = self._told.get(audio.id)
        if told is not None and told.spoken_ns is None:
            told.spoken_ns = audio.t_ns
        if (audio.id, audio.recipient, audio.revision) in self._unspoken:
            self._warned(audio.t_ns)

    def _warned(self, now_ns: int) -> None:
        """Take note of the first warning of the conflict; without a voice it is read."""
        self._unspoken.clear()
        if self._first_warning_ns is not None:
            return
        self._first_warning_ns = now_ns
        pair = self._pair
        if pair and self._monitor.flying(pair) and self._monitor.is_seen_by_tcas(pair):
            self._projection = self._project(pair, now_ns)

    def _project(self, pair: Pair, now_ns: int) -> tcas.Projection:
        """Return when TCAS II would speak, had nobody been warned: by what the script plans."""
        motion, first, second = self._monitor.motion(pair)
        first_m = self._plans.altitude_at(pair[0], now_ns, first)
        second_m = self._plans.altitude_at(pair[1], now_ns, second)
        ground_m = self._ground_m
        return tcas.earliest(
            tcas.project(motion, first_m, second_m, ground_m),
            tcas.project(motion, second_m, first_m, ground_m),
        )

    def _reaches_somebody(self, advisory: Advisory) -> bool:
        return advisory.recipient == CONTROLLER or advisory.recipient in self._callsigns

    def _concerns_conflict(self, advisory: Advisory) -> bool:
        """Return whether its traffic is the annotated pair's.

        On a runway an assistant may name what it has no callsign for, such as a deer.
        """
        named = set(self._traffic(advisory))
        if advisory.kind == "runway_conflict":
            named &= set(self._callsigns)
        return self._pair is not None and bool(named) and named <= set(self._pair)

    def _traffic(self, advisory: Advisory) -> tuple[str, ...]:
        """Return who an advisory is about; before it has a callsign, traffic goes by icao24."""
        return tuple(self._callsigns.get(name, name) for name in advisory.traffic)

    def _loses_separation(self, advisory: Advisory) -> bool:
        """Return whether the two named, if they are two, will really lose separation soon."""
        traffic = advisory.traffic
        if len(traffic) != 2 or not all(name in self._callsigns for name in traffic):
            return False
        first, second = self._traffic(advisory)
        loss = self._monitor.time_to_loss_s((first, second))
        return loss is not None and loss <= JUSTIFIED_WITHIN_S

    def _is_nuisance(self, told: _Told) -> bool:
        """Return whether the traffic named is in no conflict, declared or real.

        In a scenario without a conflict everything is a nuisance but what came true.
        """
        advisory = told.advisory
        if self._concerns_conflict(advisory):
            return False
        if advisory.kind == "loss_of_separation":
            return self._pair is None or not told.loses_separation
        named = set(self._traffic(advisory))
        return not any(
            named & {incursion.user, incursion.intruder} for incursion in self._incursions()
        )

    # --- the summary ------------------------------------------------------------------------

    def summary(self, run: Mapping[str, Any], now_ns: int) -> Summary:
        """Return the summary; ``run`` holds the fields that only the run knows."""
        truth = self._truth()
        conflict_s = _seconds(self.window.opened_ns)
        warning_s = _seconds(self._first_warning_ns)
        closest = truth.closest if truth else None
        return Summary(
            scenario=self._scenario.name,
            duration_s=now_ns / SECOND_NS,
            t_conflict_s=conflict_s,
            t_conflict_end_s=_seconds(self._window_end_ns(now_ns)),
            t_first_warning_s=warning_s,
            time_to_first_warning_s=_difference(warning_s, conflict_s),
            lead_before_closest_approach_s=_difference(
                _seconds(closest.t_ns) if closest else None, warning_s
            ),
            margin_over_tcas_ta_s=self._margin("tcas_ta"),
            margin_over_tcas_ra_s=self._margin("tcas_ra"),
            min_horizontal_separation_m=truth.least_horizontal_m if truth else None,
            min_vertical_separation_m=truth.least_vertical_m if truth else None,
            closest_approach=ClosestApproach(
                t_s=closest.t_ns / SECOND_NS,
                horizontal_m=closest.horizontal_m,
                vertical_m=closest.vertical_m,
            )
            if closest
            else None,
            loss_of_separation=self._happened("loss_of_separation"),
            nmac=self._happened("nmac"),
            collision=self._happened("collision"),
            runway_incursions=self._incursions(),
            runway_incursion_category=_severest_category(self._incursions()),
            avoided=self._avoided(truth),
            nuisance_alerts=sum(
                severest(told.severities).rank >= SPEAK_MIN_LEVEL.rank and self._is_nuisance(told)
                for told in self._told.values()
            ),
            advisories=[
                ToldAdvisory(
                    id=told.advisory.id,
                    kind=told.advisory.kind,
                    traffic=self._traffic(told.advisory),
                    t_first_s=told.advisory.t_ns / SECOND_NS,
                    t_spoken_s=_seconds(told.spoken_ns),
                    severity=severest(told.severities),
                    revisions=len(told.revisions),
                    nuisance=self._is_nuisance(told),
                )
                for told in self._told.values()
            ],
            radio=self._calls.statistics(
                roster_of(self._scenario),
                is_recognised=self.modalities.get("asr") in ("on", "lost"),
            ),
            vision=self._sight.statistics(run["inputs_dropped"]),
            latencies={
                stage: LatencyStatistics.of(samples) for stage, samples in self._latencies_s.items()
            },
            modalities={**self.modalities},
            ended_actors=self.ended_actors,
            **run,
        )

    def _truth(self) -> PairTruth | None:
        """Return the truth of the annotated pair, or of the pair that came nearest."""
        pairs = self._monitor.pairs
        if self._pair is not None:
            return pairs.get(self._pair)
        near = [truth for truth in pairs.values() if truth.closest is not None]
        return min(near, key=lambda t: t.closest.slant_m if t.closest else 0.0, default=None)

    def _happened(self, phase: str) -> bool:
        return any(phase in truth.first_ns for truth in self._monitor.pairs.values())

    def _window_end_ns(self, now_ns: int) -> int | None:
        if self.window.opened_ns is None:
            return None
        return now_ns if self.window.closed_ns is None else self.window.closed_ns

    def _incursions(self) -> list[RunwayIncursion]:
        if self._runways is None:
            return []
        return [
            RunwayIncursion(
                t_s=incursion.t_ns / SECOND_NS,
                runway=incursion.runway,
                user=incursion.user,
                intruder=incursion.intruder,
                category=incursion.category,
                closest_m=None if incursion.closest is None else incursion.closest.slant_m,
            )
            for incursion in self._runways.incursions.values()
        ]

    def _avoided(self, truth: PairTruth | None) -> bool | None:
        if truth is not None and truth.first_ns.keys() & {
            "loss_of_separation",
            "nmac",
            "collision",
        }:
            return False
        pair = set(self._pair or ())
        if any(
            incursion.category in SERIOUS and {incursion.user, incursion.intruder} <= pair
            for incursion in self._incursions()
        ):
            return False
        return None if self._first_warning_ns is None else True

    def _margin(self, alert: tcas.Alert) -> float | None:
        """Return how long after the first warning TCAS II would have spoken.

        Had it spoken before, the margin is negative.
        """
        if self._first_warning_ns is None or self._projection is None or self._pair is None:
            return None
        truth = self._truth()
        said_ns = truth.first_ns.get(alert) if truth else None
        if said_ns is not None and said_ns <= self._first_warning_ns:
            return (said_ns - self._first_warning_ns) / SECOND_NS
        projection = self._projection
        return projection.traffic_s if alert == "tcas_ta" else projection.resolution_s


def _severest_category(incursions: list[RunwayIncursion]) -> IncursionCategory | None:
    categories = [incursion.category for incursion in incursions]
    return min(categories, key=SEVEREST_FIRST.index, default=None)


def roster_of(scenario: Scenario) -> tuple[str, ...]:
    """Return the callsigns that the briefing has on its roster."""
    return tuple(
        actor.callsign
        for actor in scenario.actors
        if isinstance(actor, VehicleSpec) or (isinstance(actor, AircraftSpec) and actor.on_roster)
    )


def pair_of(scenario: Scenario) -> Pair | None:
    """Return the annotated pair in the order in which the actors are listed."""
    if scenario.conflict is None:
        return None
    order = [actor.callsign for actor in scenario.actors]
    first, second = sorted(scenario.conflict.actors, key=order.index)
    return first, second


def _seconds(t_ns: int | None) -> float | None:
    return None if t_ns is None else t_ns / SECOND_NS


def _difference(later: float | None, earlier: float | None) -> float | None:
    return None if later is None or earlier is None else later - earlier
