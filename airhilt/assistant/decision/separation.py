"""Conflicts in the air (S02A, S02B).

It keeps a track of each aircraft, foresees losses of separation, compares readbacks of levels
with clearances, and tells the crews and the controller: one advisory a conflict, which escalates.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from airhilt.assistant.decision.aerodrome import TrafficZone
from airhilt.assistant.decision.escalation import Escalation
from airhilt.assistant.decision.manoeuvres import in_words
from airhilt.assistant.decision.resolution import resolve
from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.relative_motion import Minima, VerticalProfile, relative, time_to_loss_s
from airhilt.geodesy.wgs84 import LEAST_CURVATURE_RADIUS_M
from airhilt.messages import (
    CONTROLLER,
    AdsbReport,
    Advisory,
    Briefing,
    Climb,
    Evidence,
    MaintainLevel,
    Recommendation,
    Severity,
    Transcript,
)
from airhilt.phraseology import Call, parse_call
from airhilt.units import FOOT, NAUTICAL_MILE, SECOND_NS

ACTIVITY_S = 600.0
"""Traffic that comes within the horizontal minimum in this time counts as activity."""
COASTING_NS = SECOND_NS
"""Without any report for so long, conflicts are judged again by the tracks carried on."""


@dataclass(frozen=True)
class SeparationConfig:
    """Thresholds for conflicts in the air.

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
    escalation: Escalation = field(default_factory=Escalation)
    revision: int = 0
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


class SeparationWatch:
    """Watches the aircraft in flight.

    Who is on the ground is no part of it, and neither are two that are both near an airport with a
    tower, which separates them by sight (FAA Order JO 7110.65, 7-2-1).
    """

    def __init__(self, config: SeparationConfig, name: str) -> None:
        self.config = config
        self._name = name
        self._infringed = config.infringed
        self._zone: TrafficZone | None = None
        self._tracks: dict[str, Track] = {}
        self._grounded: set[str] = set()
        self._clearances: dict[str, _Clearance] = {}
        self._conflicts: dict[tuple[str, str], _Conflict] = {}
        self._updated: dict[str, None] = {}
        self._carried: dict[str, Track] = {}
        self._told = 0

    @property
    def is_alert(self) -> bool:
        """Whether there is a conflict to be judged again even without news."""
        return bool(self._conflicts)

    def judge(self, t_ns: int, t_ready_ns: int) -> list[Advisory]:
        """Return what is to be told after all that was taken in."""
        self._carried.clear()
        self._drop_stale(t_ns)
        advisories = []
        for pair in [*self._pairs_of(self._updated), *self._coasting(t_ns)]:
            advisories += self._judge(t_ns, t_ready_ns, pair)
        self._updated.clear()
        return advisories

    # --- what is known ----------------------------------------------------------------------

    def take_briefing(self, briefing: Briefing) -> None:
        """Take in the minima, and where a tower separates."""
        self.config = replace(
            self.config,
            horizontal_m=briefing.horizontal_separation_nm * NAUTICAL_MILE,
            vertical_m=briefing.vertical_separation_ft * FOOT,
        )
        self._infringed = self.config.infringed
        self._zone = TrafficZone.of(briefing.airport) if briefing.airport else None

    def take_report(self, report: AdsbReport) -> None:
        """Take in where an aircraft is."""
        if report.altitude_ft is None:
            self._grounded.add(report.icao24)
            return
        self._grounded.discard(report.icao24)
        self._updated[report.icao24] = None
        track = self._tracks.get(report.icao24)
        if track is None:
            self._tracks[report.icao24] = Track.of(report, report.altitude_ft)
        else:
            track.update(report, report.altitude_ft)

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

    def take_transcript(self, t_ns: int, t_in_ns: int, transcript: Transcript) -> list[Advisory]:
        """Take in a call; return what is to be told about a wrong readback."""
        call = parse_call(transcript.text, [t.callsign for t in self._tracks.values()])
        track = self._by_callsign(call.callsign) if call.callsign else None
        if track is not None and call.distress:
            track.in_distress = True
            track.cleared_m = None
            return []
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
                id=f"{self._name}-readback-{self._told}",
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
            conflict = _Conflict(f"{self._name}-separation-{self._told}", pair)
            self._conflicts[pair] = conflict
        if level is None:
            return self._calm(t_ns, t_ready_ns, conflict, prediction)
        if not conflict.escalation.rises(level, t_ns, self.config.persistence_s):
            return []
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
        loss_s = None if is_past else time_to_loss_s(motion, *profiles, self._infringed)
        if self._is_towers(first, second, loss_s):
            is_past, loss_s = True, None
        approach = max(motion.time_to_closest_approach_s(), 0.0)
        return _Prediction(
            first,
            second,
            loss_s,
            approach,
            motion.at(approach).distance_m,
            _gap(profiles, approach),
            is_past,
        )

    def _is_towers(self, first: Track, second: Track, loss_s: float | None) -> bool:
        """Return whether a tower keeps two apart, now or when they would lose separation."""
        if first.icao24 in self._grounded or second.icao24 in self._grounded:
            return True
        zone = self._zone
        if zone is None:
            return False
        if zone.contains(first) and zone.contains(second):
            return True
        if loss_s is None:
            return False
        then_ns = first.t_ns + round(loss_s * SECOND_NS)
        return zone.contains(first.at(then_ns)) and zone.contains(second.at(then_ns))

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
        severity = conflict.escalation.severity
        if severity is None:
            del self._conflicts[conflict.pair]
            return []
        if not prediction.is_past and severity.rank >= Severity.CAUTION.rank:
            conflict.escalation.stays()
            return []
        if not conflict.escalation.is_over(t_ns, self.config.release_s):
            return []
        del self._conflicts[conflict.pair]
        return self._advisories(t_ready_ns, conflict, prediction, active=False)

    def _tell(
        self, t_ready_ns: int, conflict: _Conflict, prediction: _Prediction
    ) -> list[Advisory]:
        severity = conflict.escalation.severity
        if severity in (Severity.CAUTION, Severity.WARNING):
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
                strong=severity is Severity.WARNING and conflict.revision > 0,
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
        severity = conflict.escalation.severity or Severity.INFO
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
            f"{callsign} {in_words(recommendation)}"
            for callsign, recommendation in recommended.items()
            if recommendation is not None
        )
        text = f"{callsigns[0]} and {callsigns[1]} lose separation in {loss:.0f} s"
        return f"{text}; {advice}" if advice else text
    other = callsigns[1] if recipient == callsigns[0] else callsigns[0]
    advice = in_words(recommended[recipient])
    return f"{recipient} traffic {other}, loss of separation in {loss:.0f} s, {advice}"
