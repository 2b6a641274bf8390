"""Follows a run by its messages, and makes the summary of it."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from airhilt.messages import (
    ADVISORY_CALL,
    CONTROLLER,
    ActorTruth,
    Advisory,
    AdvisoryAudio,
    ConflictTruth,
    EquipmentAlert,
    Event,
    HearingTruth,
    Message,
    Modality,
    ModalityState,
    ModelExchange,
    Status,
)
from airhilt.metrics.advisories import JUSTIFIED_WITHIN_S, AdvisoryRecords
from airhilt.metrics.calls import CallRecords
from airhilt.metrics.costs import CostRecords
from airhilt.metrics.deliveries import Deliveries
from airhilt.metrics.detection_scores import DetectionScores
from airhilt.metrics.equipment import EquipmentRecords
from airhilt.metrics.evidence_ages import EvidenceAges
from airhilt.metrics.first_warning import FirstWarning
from airhilt.metrics.latencies import StageLatencies
from airhilt.metrics.outcome import INFRINGEMENTS, Outcome
from airhilt.metrics.people import REAL_TIME, PeopleRecords
from airhilt.metrics.plans import Plans
from airhilt.metrics.summary import LanguageModelStatistics, Summary, WarningParts
from airhilt.metrics.warning_parts import parts_of, supporting_transcript
from airhilt.options import MODALITIES
from airhilt.scenario.models import LineBegun, Scenario
from airhilt.sim import StepRecord
from airhilt.sim.payload import Payload
from airhilt.units import SECOND_NS, ns_to_seconds
from airhilt.world.truth.conflicts import ConflictMonitor, Pair
from airhilt.world.truth.runways import RunwayMonitor

EMPTY: Mapping[str, Sequence[str]] = {}


@dataclass
class WindowTimes:
    """Times at which the annotated conflict began, and its window opened and closed."""

    begun_ns: int | None = None
    opened_ns: int | None = None
    closed_ns: int | None = None

    def end_ns(self, now_ns: int) -> int | None:
        """Return when the window closed, or now if it is open; None if it never opened."""
        if self.opened_ns is None:
            return None
        return now_ns if self.closed_ns is None else self.closed_ns


class Collector:
    """Collects the numbers of a run.

    The height of the ground is in m above WGS84; away from airports there is no monitor of runways.
    `deciders` are the workers that decide, by name, with the patterns of the keys that they
    subscribe to, `given` the modalities that they are given,
    `seats` the units and callsigns that are left to people. The run begins with the `pace`.
    """

    def __init__(
        self,
        scenario: Scenario,
        ground_m: float,
        monitor: ConflictMonitor,
        runways: RunwayMonitor | None,
        plans: Plans,
        is_on_frequency: bool = False,
        deciders: Mapping[str, Sequence[str]] = EMPTY,
        given: Collection[str] = MODALITIES,
        seats: Collection[str] = (),
        pace: str = REAL_TIME,
    ) -> None:
        self.window = WindowTimes()
        self.modalities: dict[Modality, ModalityState] = {}
        """Last state of each modality."""
        self.ended_actors: dict[str, str] = {}
        """Cause by the callsign of each actor that ended before the run did."""
        self.last_advisory: Advisory | None = None
        """The advisory that was published last and is active, None before the first."""
        self._scenario = scenario
        self._is_on_frequency = is_on_frequency
        pair = scenario.pair
        self._monitor, self._runways = monitor, runways
        self._outcome = Outcome(monitor, runways, pair, scenario.causes)
        self._first_warning = FirstWarning(pair, monitor, plans, ground_m)
        self._latencies = StageLatencies()
        self._calls = CallRecords()
        self._evidence = EvidenceAges(deciders, given)
        self._detections = DetectionScores()
        self._deliveries = Deliveries(
            deciders, scenario.callsigns, scenario.roster, self._detections.was_seen
        )
        self._exchanges: list[ModelExchange] = []
        self._costs = CostRecords(plans)
        self._people = PeopleRecords(seats, [one.callsign for one in scenario.actors], pace)
        new_records = partial(
            AdvisoryRecords,
            scenario.callsigns,
            pair,
            monitor,
            self._detections.was_seen,
            self._shows,
        )
        self._advisories = new_records()
        self._equipment = EquipmentRecords(scenario.equipment, new_records)

    def take(self, key: str, message: Message, data: Payload) -> None:  # noqa: ARG002
        """Receive a published message."""
        if isinstance(message, ActorTruth):
            self._people.take_state(message)
            self._costs.take_state(message)
            return  # The most frequent message: the monitors follow the actors themselves.
        match message:
            case ConflictTruth(phase="begun", t_ns=now_ns):
                self.window.begun_ns = now_ns
            case ConflictTruth(phase="opened", t_ns=now_ns):
                self.window.opened_ns = now_ns
            case ConflictTruth(phase="closed", t_ns=now_ns):
                self.window.closed_ns = now_ns
            case Event(kind="actor_ended", subject=callsign, text=cause):
                self.ended_actors[callsign] = cause
            case Advisory():
                self._take_advisory(message)
            case EquipmentAlert():
                self._equipment.take(message)
            case AdvisoryAudio() if not self._is_called(message.recipient):
                self._told(message.id, message.revision, message.recipient, message.t_ns)
            case ModelExchange():
                self._exchanges.append(message)
            case HearingTruth(id=name, outcome="understood") if name.startswith(ADVISORY_CALL):
                self._take_advisory_call(name)
            case Status(modality=modality, state=state, t_ns=now_ns):
                self.modalities[modality] = state
                if modality == "tts" and state == "lost":
                    self._first_warning.voice_lost(now_ns)
        self._latencies.take(message)
        self._calls.take(message)
        self._evidence.take(message)
        self._detections.take(message)
        self._deliveries.take(key, message)
        self._people.take(key, message)

    def step(self, record: StepRecord) -> None:
        """Receive a finished step of a worker."""
        self._latencies.step(record)
        self._evidence.step(record)
        self._deliveries.step(record)

    def _take_advisory(self, advisory: Advisory) -> None:
        if self._advisories.add(advisory, self._deliveries.unfounded(advisory)):
            self._latencies.add("decision", advisory.t_ready_ns, advisory.t_ns)
        self._costs.take_advisory(advisory)
        if advisory.active:
            self.last_advisory = advisory
        else:
            self._first_warning.ended(advisory.id)
        pair = self._scenario.pair or ()
        if self._advisories.warns_of_conflict(advisory) and self._deliveries.is_founded(
            advisory, pair
        ):
            is_voiced = self.modalities.get("tts") == "on" or self._is_called(advisory.recipient)
            self._first_warning.warned(advisory, is_voiced)

    def _shows(self, pair: Pair) -> bool:
        """Return whether a conflict has begun as annotated, or is to be seen.

        It is in the tracks of two, or where they are on runways.
        """
        annotated = set(self._scenario.pair or ())
        if annotated == set(pair) and self.window.begun_ns is not None:
            return True
        loss_s = self._monitor.time_to_loss_s(pair)
        if loss_s is not None and loss_s <= JUSTIFIED_WITHIN_S:
            return True
        return self._runways is not None and self._runways.share_runway(*pair)

    def _is_called(self, recipient: str) -> bool:
        """Return whether a recipient hears advisories on its frequency."""
        return self._is_on_frequency and recipient != CONTROLLER

    def _take_advisory_call(self, name: str) -> None:
        identity, revision, recipient = name.removeprefix(ADVISORY_CALL).rsplit(".", 2)
        call = self._calls.get(name)
        if call is not None and call.said is not None:
            self._told(identity, int(revision), recipient, call.said.t_tx_ns)

    def _told(self, identity: str, revision: int, recipient: str, t_ns: int) -> None:
        self._advisories.add_voice(identity, t_ns)
        self._first_warning.heard((identity, recipient, revision), t_ns)

    # --- the summary ------------------------------------------------------------------------

    def summary(self, run: Mapping[str, Any], now_ns: int) -> Summary:
        """Return the summary; ``run`` holds the fields that only the run knows."""
        incursions = self._outcome.incursions()
        vision = self._detections.statistics(run["inputs_dropped"])
        advisories = self._advisories.summaries(incursions)
        return Summary(
            scenario=self._scenario.name,
            duration_s=now_ns / SECOND_NS,
            conflict_actors=self._scenario.pair or (),
            **self._warning_fields(now_ns),
            **self._outcome_fields(),
            unassisted_as_declared=self._as_declared(run["assistant"]),
            nuisance_alerts=(
                None if vision.exposures_left_out else self._advisories.nuisance_alerts(incursions)
            ),
            clarifications=self._advisories.clarifications(),
            advisories=advisories,
            equipment=self._equipment.summaries(self._first_warning.t_ns, incursions),
            costs=self._costs.summary(
                len(advisories),
                self._calls.advice_spoken_s(self._is_called),
                now_ns / SECOND_NS,
            ),
            people=self._people.summaries(now_ns),
            radio=self._calls.statistics(
                self._scenario.roster,
                is_recognised=self.modalities.get("asr") in ("on", "lost"),
            ),
            vision=vision,
            language_model=_language_model(self._exchanges),
            latencies=self._latencies.statistics(),
            evidence=self._evidence.statistics(now_ns),
            modalities={**self.modalities},
            ended_actors=self.ended_actors,
            **run,
        )

    def _warning_fields(self, now_ns: int) -> dict[str, Any]:
        conflict_s = ns_to_seconds(self.window.begun_ns)
        warning_s = ns_to_seconds(self._first_warning.t_ns)
        is_in_time = self._is_warned_in_time()
        truth = self._outcome.pair_truth
        closest = self._outcome.closest_approach
        return {
            "t_conflict_s": conflict_s,
            "t_window_s": ns_to_seconds(self.window.opened_ns),
            "t_conflict_end_s": ns_to_seconds(self.window.end_ns(now_ns)),
            "t_first_warning_s": warning_s,
            "time_to_first_warning_s": _difference(warning_s, conflict_s),
            "time_to_first_warning_after_window_s": _difference(
                warning_s, ns_to_seconds(self.window.opened_ns)
            ),
            "time_to_first_warning_after_call_s": _difference(
                warning_s, ns_to_seconds(self._call_ended_ns())
            ),
            "first_warning_parts": self._warning_parts(),
            "lead_before_closest_approach_s": _difference(
                closest.t_s if closest else None, warning_s if is_in_time else None
            ),
            "margin_over_tcas_ta_s": self._first_warning.margin_s("tcas_ta", truth),
            "margin_over_tcas_ra_s": self._first_warning.margin_s("tcas_ra", truth),
        }

    def _beginning_call(self) -> str | None:
        conflict = self._scenario.conflict
        begins = None if conflict is None else conflict.begins
        return begins.line if isinstance(begins, LineBegun) else None

    def _call_ended_ns(self) -> int | None:
        name = self._beginning_call()
        call = None if name is None else self._calls.get(name)
        return None if call is None or call.said is None else call.said.t_end_ns

    def _warning_parts(self) -> WarningParts | None:
        warning, begun_ns = self._first_warning, self.window.begun_ns
        if warning.t_ns is None or warning.advisory is None or begun_ns is None:
            return None
        transcript = supporting_transcript(
            warning.advisory, self._beginning_call(), self._calls.get
        )
        return parts_of(begun_ns, warning.t_ns, warning.advisory, transcript)

    def _is_warned_in_time(self) -> bool:
        warning_ns, closed_ns = self._first_warning.t_ns, self.window.closed_ns
        return warning_ns is not None and (closed_ns is None or warning_ns <= closed_ns)

    def _as_declared(self, assistant: str) -> bool | None:
        """Return whether what the scenario declares came about without an assistant.

        None if there was one, or the scenario declares no conflict, or equipment has averted it.
        """
        conflict = self._scenario.conflict
        if conflict is None or assistant != "none":
            return None
        if self.window.opened_ns is not None and self._outcome.came_about(conflict.unassisted):
            return True
        return None if self._equipment.acts_before(None) else False

    def _outcome_fields(self) -> dict[str, Any]:
        outcome, truth = self._outcome, self._outcome.pair_truth
        # A warning counts that came before equipment told anybody what to do.
        was_warned = self._is_warned_in_time()
        is_credited = was_warned and not self._equipment.acts_before(self._first_warning.t_ns)
        return {
            "min_horizontal_separation_m": truth.least_horizontal_m if truth else None,
            "min_vertical_separation_m": truth.least_vertical_m if truth else None,
            "closest_approach": outcome.closest_approach,
            **{phase: outcome.happened(phase) for phase in INFRINGEMENTS},
            "runway_incursions": outcome.incursions(),
            "runway_incursion_category": outcome.worst_category(),
            "avoided": outcome.avoided(was_warned=is_credited),
            "conflict_outcome": outcome.conflict(
                was_warned, self.window.opened_ns is not None, is_credited
            ),
        }


def _language_model(exchanges: Sequence[ModelExchange]) -> LanguageModelStatistics | None:
    if not exchanges:
        return None
    return LanguageModelStatistics(
        model=exchanges[0].model,
        questions=len(exchanges),
        failures=sum(bool(each.failure) for each in exchanges),
        rejections=sum(len(each.rejections) for each in exchanges),
    )


def _difference(later_s: float | None, earlier_s: float | None) -> float | None:
    return None if later_s is None or earlier_s is None else later_s - earlier_s
