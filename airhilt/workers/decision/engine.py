"""The reference decision engine for airborne conflicts (S02A).

It keeps a track of each aircraft, foresees losses of separation, compares readbacks with
clearances, and tells the crews and the controller: one advisory a conflict, which escalates.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from airhilt.messages import (
    CONTROLLER,
    AdsbReport,
    Advisory,
    Briefing,
    Climb,
    DeclaredLatency,
    Evidence,
    InputSpec,
    MaintainLevel,
    Recommendation,
    Severity,
    Transcript,
    Turn,
    WorkerDescription,
)
from airhilt.radio.phraseology import Call, parse_call
from airhilt.sim.worker import Input, Output
from airhilt.surveillance.kinematics import (
    LEAST_CURVATURE_RADIUS_M,
    Minima,
    VerticalProfile,
    relative,
    time_to_loss_s,
)
from airhilt.units import FOOT, NAUTICAL_MILE, SECOND_NS
from airhilt.workers.decision.resolution import resolve
from airhilt.workers.decision.tracks import Track
from airhilt.workers.protocol import Step

ACTIVITY_S = 600.0
"""Traffic that comes within the horizontal minimum in this time counts as activity."""
COASTING_NS = SECOND_NS
"""Without any report for so long, conflicts are judged again by the tracks carried on."""


@dataclass(frozen=True)
class DecisionConfig:
    """Thresholds of the reference decision engine.

    The look-ahead times follow those of ground-based short-term conflict alert, about two
    minutes (EUROCONTROL-GUID-159, edition 1.0), with an earlier ADVISORY and a later WARNING.
    """

    horizontal_m: float = 5.0 * NAUTICAL_MILE
    vertical_m: float = 1000.0 * FOOT
    vertical_tolerance_m: float = 150.0 * FOOT
    """Level keeping, the 25 ft steps of ADS-B and the spread of its vertical rate."""
    advisory_s: float = 180.0
    caution_s: float = 120.0
    warning_s: float = 60.0
    persistence_s: float = 1.0
    """How long a severity must hold before it is told."""
    release_s: float = 8.0
    """How long a conflict must be over before it is told so."""
    stale_s: float = 15.0
    """Age at which a track is dropped."""
    readback_window_s: float = 30.0
    """A readback later than this after its clearance belongs to something else."""

    @property
    def standard(self) -> Minima:
        """The separation minima."""
        return Minima(self.horizontal_m, self.vertical_m)

    @property
    def infringed(self) -> Minima:
        """Where separation counts as lost."""
        return Minima(self.horizontal_m, self.vertical_m - self.vertical_tolerance_m)


@dataclass(slots=True)
class _Conflict:
    """One conflict from first suspicion to its end."""

    id: str
    pair: tuple[str, str]
    severity: Severity | None = None
    """Told last; None before the first advisory."""
    revision: int = 0
    rising: Severity | None = None
    rising_since_ns: int = 0
    quiet_since_ns: int | None = None
    recommendations: tuple[Recommendation | None, Recommendation | None] = (None, None)


@dataclass(slots=True)
class _Clearance:
    """The last level that the controller gave to an aircraft."""

    altitude_ft: float
    t_end_ns: int


class _Prediction(NamedTuple):
    """What lies ahead of a pair, as it is now."""

    first: Track
    second: Track
    time_to_loss_s: float | None
    time_to_closest_approach_s: float
    horizontal_m: float
    vertical_m: float
    is_past: bool
    """The two will not come within the horizontal minimum again."""

    def evidence(self) -> Evidence:
        """Return it as an advisory gives it."""
        return Evidence(
            sources=("adsb",),
            time_to_loss_s=self.time_to_loss_s,
            time_to_closest_approach_s=self.time_to_closest_approach_s,
            horizontal_at_closest_approach_m=self.horizontal_m,
            vertical_at_closest_approach_m=self.vertical_m,
        )


class DecisionWorker:
    """Implements `airhilt.workers.Worker` for conflicts in the air."""

    def __init__(self, config: DecisionConfig | None = None, name: str = "decision") -> None:
        self.config = config or DecisionConfig()
        self.description = WorkerDescription(
            name=name,
            modality="decision",
            inputs=(
                InputSpec(key="briefing", policy="batch"),
                InputSpec(key="adsb/*", policy="batch"),
                InputSpec(key="asr/*", policy="batch"),
            ),
            latency=DeclaredLatency(median_s=0.15, sigma=0.3),
        )
        self._infringed = self.config.infringed
        self._tracks: dict[str, Track] = {}
        self._clearances: dict[str, _Clearance] = {}
        self._conflicts: dict[tuple[str, str], _Conflict] = {}
        self._carried: dict[str, Track] = {}
        self._told = 0

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        """Take in reports and transcripts; tell what has changed."""
        updated: dict[str, None] = {}
        advisories: list[Advisory] = []
        for item in inputs:
            if item.key.startswith("adsb/"):
                updated[self._take_report(AdsbReport.model_validate_json(item.payload))] = None
            elif item.key == "briefing":
                self._take_briefing(Briefing.model_validate_json(item.payload))
            else:
                transcript = Transcript.model_validate_json(item.payload)
                advisories += self._take_transcript(t_ns, item.t_in_ns, transcript)
        self._carried.clear()
        t_ready_ns = max((item.t_in_ns for item in inputs), default=t_ns)
        self._drop_stale(t_ns)
        for pair in [*self._pairs_of(updated), *self._coasting(t_ns)]:
            advisories += self._judge(t_ns, t_ready_ns, pair)
        return Step(
            tuple(
                Output(f"advisory/{advisory.recipient}", advisory.model_dump_json().encode())
                for advisory in advisories
            ),
            wake_ns=t_ns + COASTING_NS if self._conflicts else None,
        )

    # --- what is known ----------------------------------------------------------------------

    def _take_briefing(self, briefing: Briefing) -> None:
        self.config = replace(
            self.config,
            horizontal_m=briefing.horizontal_separation_nm * NAUTICAL_MILE,
            vertical_m=briefing.vertical_separation_ft * FOOT,
        )
        self._infringed = self.config.infringed

    def _take_report(self, report: AdsbReport) -> str:
        track = self._tracks.get(report.icao24)
        if track is None:
            self._tracks[report.icao24] = Track.of(report)
        else:
            track.update(report)
        return report.icao24

    def _drop_stale(self, t_ns: int) -> None:
        """Drop tracks without news, but coast those in conflict until it is over."""
        oldest = t_ns - round(self.config.stale_s * SECOND_NS)
        stale = [icao24 for icao24, track in self._tracks.items() if track.t_ns < oldest]
        coasting = {icao24 for pair in self._conflicts for icao24 in pair} if stale else set()
        for icao24 in stale:
            if icao24 not in coasting:
                del self._tracks[icao24]

    def _pairs_of(self, updated: dict[str, None]) -> Iterator[tuple[str, str]]:
        """Yield the pairs that have news and are in conflict or could come into one.

        Most pairs of a busy sky are too far apart in level or latitude to meet within the
        look-ahead; they are left out here, where it is cheap.
        """
        config, conflicts = self.config, self._conflicts
        reach_s = config.advisory_s + config.stale_s
        seen = set()
        for icao24 in updated:
            own = self._tracks.get(icao24)
            if own is None:
                continue
            level_m = config.vertical_m + abs(own.vertical_rate_m_s) * reach_s
            north_m = config.horizontal_m + abs(own.velocity_north_m_s) * reach_s
            for name, other in self._tracks.items():
                pair = (icao24, name) if icao24 < name else (name, icao24)
                if name == icao24 or pair in seen:
                    continue
                gap_m = abs(own.altitude_m - other.altitude_m)
                apart_m = abs(own.latitude_rad - other.latitude_rad) * LEAST_CURVATURE_RADIUS_M
                if pair in conflicts or (
                    gap_m <= level_m + abs(other.vertical_rate_m_s) * reach_s
                    and apart_m <= north_m + abs(other.velocity_north_m_s) * reach_s
                ):
                    seen.add(pair)
                    yield pair

    def _coasting(self, t_ns: int) -> list[tuple[str, str]]:
        """Return the pairs in conflict of which nothing was heard for a while."""
        return [
            pair
            for pair in self._conflicts
            if t_ns - max(self._tracks[icao24].t_ns for icao24 in pair) >= COASTING_NS
        ]

    def _by_callsign(self, callsign: str) -> Track | None:
        return next((t for t in self._tracks.values() if t.callsign == callsign), None)

    # --- readbacks --------------------------------------------------------------------------

    def _take_transcript(self, t_ns: int, t_in_ns: int, transcript: Transcript) -> list[Advisory]:
        call = parse_call(transcript.text, [t.callsign for t in self._tracks.values()])
        track = self._by_callsign(call.callsign) if call.callsign else None
        if track is None or call.altitude_ft is None:
            return []
        if call.addressed_first:
            self._clearances[track.callsign] = _Clearance(call.altitude_ft, transcript.t_end_ns)
            return []
        given = self._clearances.get(track.callsign)
        track.cleared_m = call.altitude_ft * FOOT
        if (
            given is None
            or call.altitude_ft == given.altitude_ft
            or transcript.t_tx_ns - given.t_end_ns > self.config.readback_window_s * SECOND_NS
        ):
            return []
        return self._tell_mismatch(t_ns, t_in_ns, track, call, given.altitude_ft)

    def _tell_mismatch(
        self, t_ns: int, t_in_ns: int, track: Track, call: Call, cleared_ft: float
    ) -> list[Advisory]:
        """Readback mismatch with activity at the wrong level: CAUTION (the ladder's step a)."""
        threatened = self._threatened(t_ns, track, call)
        if threatened is None:
            return []
        self._told += 1
        track.cleared_m = cleared_ft * FOOT
        recommendation = MaintainLevel(altitude_ft=cleared_ft)
        traffic = (track.callsign, threatened.callsign)
        text = (
            f"read back {call.altitude_ft or 0.0:.0f} ft, cleared {cleared_ft:.0f} ft, "
            f"traffic {threatened.callsign}"
        )
        return [
            Advisory(
                id=f"{self.description.name}-readback-{self._told}",
                revision=0,
                recipient=recipient,
                recipients=(track.callsign, CONTROLLER),
                kind="readback_mismatch",
                severity=Severity.CAUTION,
                traffic=traffic,
                message=f"{track.callsign} {text}",
                recommendation=recommendation if recipient == track.callsign else None,
                evidence=Evidence(sources=("radio", "adsb"), note=text),
                t_ready_ns=t_in_ns,
            )
            for recipient in (track.callsign, CONTROLLER)
        ]

    def _threatened(self, t_ns: int, track: Track, call: Call) -> Track | None:
        """Return who would lose separation if the aircraft flew to the level read back."""
        own = track.at(t_ns)
        target_m = (call.altitude_ft or 0.0) * FOOT
        low, high = sorted((own.altitude_m, target_m))
        for other in self._tracks.values():
            if other.icao24 == track.icao24:
                continue
            ahead = other.at(t_ns)
            interval = relative(own, ahead).interval_within(self.config.horizontal_m)
            near = interval is not None and interval[1] > 0.0 and interval[0] < ACTIVITY_S
            level = ahead.profile().at(60.0)
            if near and low - self.config.vertical_m < level < high + self.config.vertical_m:
                return ahead
        return None

    # --- losses of separation ---------------------------------------------------------------

    def _judge(self, t_ns: int, t_ready_ns: int, pair: tuple[str, str]) -> list[Advisory]:
        """Predict one pair, and tell it if that changes what is known of its conflict."""
        conflict = self._conflicts.get(pair)
        first, second = (self._present(icao24, t_ns) for icao24 in pair)
        prediction = self._predict(first, second)
        level = self._grade(prediction.time_to_loss_s)
        if conflict is None:
            if level is None:
                return []
            self._told += 1
            conflict = _Conflict(f"{self.description.name}-separation-{self._told}", pair)
            self._conflicts[pair] = conflict
        if level is None:
            return self._calm(t_ns, t_ready_ns, conflict, prediction)
        conflict.quiet_since_ns = None
        if conflict.severity is not None and level.rank <= conflict.severity.rank:
            conflict.rising = None
            return []
        if conflict.rising is None or level.rank < conflict.rising.rank:
            conflict.rising, conflict.rising_since_ns = level, t_ns
        if t_ns - conflict.rising_since_ns < self.config.persistence_s * SECOND_NS:
            return []
        conflict.severity, conflict.rising = conflict.rising, None
        return self._tell(t_ready_ns, conflict, prediction)

    def _present(self, icao24: str, t_ns: int) -> Track:
        """Return a track carried on to now, computed once a step."""
        track = self._carried.get(icao24)
        if track is None:
            track = self._carried[icao24] = self._tracks[icao24].at(t_ns)
        return track

    def _predict(self, first: Track, second: Track) -> _Prediction:
        motion = relative(first, second)
        profiles = (first.profile(), second.profile())
        interval = motion.interval_within(self.config.horizontal_m)
        is_past = interval is None or interval[1] <= 0.0 or interval[0] > self.config.advisory_s
        approach = max(motion.time_to_closest_approach_s(), 0.0)
        return _Prediction(
            first,
            second,
            None if is_past else time_to_loss_s(motion, *profiles, self._infringed),
            approach,
            motion.at(approach).distance_m,
            _gap(profiles, approach),
            is_past,
        )

    def _grade(self, time_to_loss: float | None) -> Severity | None:
        config = self.config
        if time_to_loss is None or time_to_loss > config.advisory_s:
            return None
        if time_to_loss <= config.warning_s:
            return Severity.WARNING
        return Severity.CAUTION if time_to_loss <= config.caution_s else Severity.ADVISORY

    def _calm(
        self, t_ns: int, t_ready_ns: int, conflict: _Conflict, prediction: _Prediction
    ) -> list[Advisory]:
        """End a conflict once it is over for good.

        While a recommendation is being followed the prediction is clear, but going back to the
        old level would bring the conflict back: it stays until the two are past each other.
        """
        conflict.rising = None
        if conflict.severity is None:
            del self._conflicts[conflict.pair]
            return []
        if not prediction.is_past and conflict.severity.rank >= Severity.CAUTION.rank:
            conflict.quiet_since_ns = None
            return []
        if conflict.quiet_since_ns is None:
            conflict.quiet_since_ns = t_ns
        if t_ns - conflict.quiet_since_ns < self.config.release_s * SECOND_NS:
            return []
        del self._conflicts[conflict.pair]
        return self._advisories(t_ready_ns, conflict, prediction, active=False)

    def _tell(
        self, t_ready_ns: int, conflict: _Conflict, prediction: _Prediction
    ) -> list[Advisory]:
        if conflict.severity in (Severity.CAUTION, Severity.WARNING):
            others = [
                track.at(prediction.first.t_ns)
                for icao24, track in self._tracks.items()
                if icao24 not in conflict.pair
            ]
            resolution = resolve(
                prediction.first,
                prediction.second,
                others,
                self.config.standard,
                self._infringed,
                strong=conflict.severity is Severity.WARNING and conflict.revision > 0,
            )
            conflict.recommendations = (resolution.first, resolution.second)
            for icao24, recommended in zip(conflict.pair, conflict.recommendations, strict=True):
                if isinstance(recommended, Climb | MaintainLevel):
                    self._tracks[icao24].cleared_m = recommended.altitude_ft * FOOT
        return self._advisories(t_ready_ns, conflict, prediction, active=True)

    def _advisories(
        self, t_ready_ns: int, conflict: _Conflict, prediction: _Prediction, active: bool
    ) -> list[Advisory]:
        """Return the advisory for each recipient; crews hear from CAUTION on."""
        severity = conflict.severity or Severity.INFO
        to_crews = severity.rank >= Severity.CAUTION.rank
        callsigns = (prediction.first.callsign, prediction.second.callsign)
        recipients = (*callsigns, CONTROLLER) if to_crews else (CONTROLLER,)
        recommended = dict(zip(callsigns, conflict.recommendations, strict=True))
        told = []
        for recipient in recipients:
            recommendation = recommended.get(recipient) if active else None
            told.append(
                Advisory(
                    id=conflict.id,
                    revision=conflict.revision,
                    recipient=recipient,
                    recipients=recipients,
                    kind="loss_of_separation",
                    severity=severity if active else Severity.INFO,
                    active=active,
                    traffic=callsigns,
                    message=_words(recipient, callsigns, recommended, prediction, active),
                    recommendation=recommendation,
                    evidence=prediction.evidence(),
                    t_ready_ns=t_ready_ns,
                )
            )
        conflict.revision += 1
        return told


def _gap(profiles: tuple[VerticalProfile, VerticalProfile], time_s: float) -> float:
    return abs(profiles[0].at(time_s) - profiles[1].at(time_s))


def _words(
    recipient: str,
    callsigns: tuple[str, str],
    recommended: dict[str, Recommendation | None],
    prediction: _Prediction,
    active: bool,
) -> str:
    if not active:
        return "clear of conflict"
    loss = prediction.time_to_loss_s or 0.0
    if recipient not in callsigns:
        advice = "; ".join(
            f"{callsign} {_advice(recommendation)}"
            for callsign, recommendation in recommended.items()
            if recommendation is not None
        )
        text = f"{callsigns[0]} and {callsigns[1]} lose separation in {loss:.0f} s"
        return f"{text}; {advice}" if advice else text
    other = callsigns[1] if recipient == callsigns[0] else callsigns[0]
    advice = _advice(recommended[recipient])
    return f"{recipient} traffic {other}, loss of separation in {loss:.0f} s, {advice}"


def _advice(recommendation: Recommendation | None) -> str:
    match recommendation:
        case Climb(sense=sense, altitude_ft=altitude, vertical_rate_fpm=rate):
            return f"{sense} to {altitude:.0f} ft at {rate:.0f} ft/min"
        case MaintainLevel(altitude_ft=altitude):
            return f"maintain {altitude:.0f} ft"
        case Turn(degrees=degrees):
            return f"turn {'right' if degrees >= 0 else 'left'} {abs(degrees):.0f} degrees"
        case None:
            return "maintain present level and track"
