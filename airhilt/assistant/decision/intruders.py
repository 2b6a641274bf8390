"""Aircraft without a transponder (S02C), seen by cameras of aircraft in flight.

An aircraft that stays in one direction and grows is on a collision course. Its distance cannot be
told without its size; the time to contact can.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from pydantic import Field, model_validator

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.approach import Approach, approach_of, may_stand, stays_in_place
from airhilt.assistant.decision.escalation import Escalation
from airhilt.assistant.decision.findings import Intruder, Where
from airhilt.assistant.decision.line_of_sight import Ray
from airhilt.assistant.decision.resolution import BUFFER_FT, STRONG_VERTICAL_RATE_FPM, TURN_DEG
from airhilt.assistant.decision.threats import UNIDENTIFIED, WILDLIFE
from airhilt.assistant.decision.visual_tracks import BLIND_NS, VisualTrack, VisualTracks
from airhilt.configuration import Configuration, Seconds, require_order
from airhilt.geodesy.relative_motion import Minima
from airhilt.messages import (
    CONTROLLER,
    AdsbReport,
    Climb,
    Evidence,
    GoAround,
    Recommendation,
    Severity,
    Turn,
)
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, SECOND_NS, wrap_angle

SAME_DIRECTION_RAD = 4.0 * DEGREE
"""Angle, in rad, within which a new track is the same aircraft as one that was lost."""
GROUNDED_M = 20.0
"""Height, in m, below which the carrier of a camera stands on the ground if it has no ADS-B."""
AHEAD_RAD = 15.0 * DEGREE
BESIDE_RAD = 60.0 * DEGREE
BEHIND_RAD = 120.0 * DEGREE
BIRDS = Minima(0.0, 300.0 * FOOT)
"""Distances to keep from birds, to which no separation minima apply; chosen."""
EVEN_ODDS = 0.5
"""Belief of one look above which something is rather there than not."""
UNRELIABLE_S = 90.0
"""Longest time to contact that is told, in s."""
SMALLEST_M = 8.0
"""Least span of an aircraft, in m; an assumption."""
LONGEST_S = 180.0
"""Longest time for which an intruder that is no longer seen is avoided, in s; chosen."""
LEVEL_STEP_FT = 100.0
LEAST_HEIGHT_M = 600.0
"""Height, in m, below which nobody is recommended to descend."""
LEVEL_RAD = 0.5 * DEGREE
"""Angle from the horizon, in rad, within which an aircraft is at about the same level."""
ABOVE_SIZES = 1.0
"""Height in its own sizes from which an aircraft passes above."""


class IntruderConfig(Configuration):
    """Thresholds for aircraft that only cameras show.

    An airliner's camera finds a light aircraft at some 2 or 3 km: there is a quarter of a minute
    until the encounter, of which a crew takes 5 s to react. So a CAUTION soon becomes a WARNING,
    and a doubtful WARNING is told.
    """

    advisory_s: Seconds = Field(
        90.0, description="time to contact from which it is an ADVISORY, in s; chosen"
    )
    caution_s: Seconds = Field(60.0, description="likewise for a CAUTION, in s; chosen")
    warning_s: Seconds = Field(25.0, description="likewise for a WARNING, in s; chosen")
    near_sizes: float = Field(
        25.0,
        gt=0.0,
        le=1000.0,
        description="distance in its own sizes at which an aircraft passes near: 275 m for a light "
        "one; chosen",
    )
    warning_sizes: float = Field(
        12.0,
        gt=0.0,
        le=1000.0,
        description="likewise for a WARNING: 130 m, less than the 500 ft between VFR and IFR "
        "levels (14 CFR 91.159)",
    )
    persistence_s: Seconds = Field(
        0.4, description="time for which a severity must hold before it is told, in s; chosen"
    )
    release_s: Seconds = Field(
        20.0,
        description="time for which it must be past before that is told, in s: overtaking is slow; "
        "chosen",
    )

    @model_validator(mode="after")
    def _in_order(self) -> IntruderConfig:
        require_order(self, "warning_s", "caution_s", "advisory_s")
        require_order(self, "warning_sizes", "near_sizes")
        return self


class _Encounter(NamedTuple):
    """Something that comes towards an aircraft with a camera, as of now."""

    carrier: str
    track: VisualTrack
    approach: Approach
    severity: Severity | None
    """None if it passes by or is far."""

    @property
    def ray(self) -> Ray:
        return self.track.last.ray

    @property
    def rank(self) -> int:
        return -1 if self.severity is None else self.severity.rank

    def past_ns(self, minima: Minima) -> int:
        """Return the time at which the two are past each other by the horizontal minimum.

        It is the latest such time by the errors. The distance to something of a size in the
        picture is at least that of the smallest aircraft, so the two draw apart at least as fast
        as that distance over the longest time to contact.
        """
        contact_s = min(self.approach.longest_s, UNRELIABLE_S)
        distance_m = SMALLEST_M / self.approach.size_rad
        apart_s = contact_s * minima.horizontal_m / distance_m
        left_s = min(contact_s + apart_s, LONGEST_S)
        return self.track.last.t_ns + round(left_s * SECOND_NS)


@dataclass(slots=True, eq=False)
class _Ongoing:
    """One encounter from first suspicion to its end."""

    encounter: _Encounter
    escalation: Escalation
    recommendation: Recommendation | None = None
    past_ns: int = 0

    def is_of(self, encounter: _Encounter) -> bool:
        last = self.encounter
        return last.carrier == encounter.carrier and (
            last.track is encounter.track or last.ray.angle_to(encounter.ray) <= SAME_DIRECTION_RAD
        )


class IntruderWatch:
    """Watches what cameras of aircraft in flight show and no transponder explains.

    Parameters
    ----------
    runway_of
        Returns the runway for which a callsign is on final; None if it is not.
    minima
        Returns the separation minima, which the briefing sets.
    """

    def __init__(
        self,
        config: IntruderConfig,
        visual_tracks: VisualTracks,
        runway_of: Callable[[str], str | None],
        minima: Callable[[], Minima],
    ) -> None:
        self.config = config
        self._visual_tracks = visual_tracks
        self._runway_of = runway_of
        self._minima = minima
        self._ongoing: list[_Ongoing] = []
        self._count = 0

    @property
    def has_conflict(self) -> bool:
        """True if there is an encounter to be judged again even without news."""
        return bool(self._ongoing)

    def judge(self, t_ns: int) -> list[Alert]:
        """Return the alerts that are new, have risen, or are over."""
        told: list[Alert] = []
        threatened: list[_Ongoing] = []
        for encounter in self._encounters(t_ns):
            ongoing = next((each for each in self._ongoing if each.is_of(encounter)), None)
            if ongoing is None and encounter.severity is not None:
                self._count += 1
                ongoing = _Ongoing(encounter, Escalation(f"intruder-{self._count}"))
                ongoing.past_ns = encounter.past_ns(self._minima_from(encounter.track))
                self._ongoing.append(ongoing)
            elif ongoing is not None and encounter.approach.closing > 0.0:
                ongoing.past_ns = encounter.past_ns(self._minima_from(encounter.track))
            if ongoing is None or encounter.severity is None or ongoing in threatened:
                continue
            threatened.append(ongoing)
            ongoing.encounter = encounter
            has_risen = ongoing.escalation.rises(
                encounter.severity, t_ns, self.config.persistence_s
            )
            own, other = (encounter.carrier,), False
            is_warning = encounter.severity is Severity.WARNING
            if is_warning and ongoing.escalation.severity is Severity.WARNING:
                before, ongoing.recommendation = (
                    ongoing.recommendation,
                    self._recommended(t_ns, ongoing),
                )
                other = ongoing.recommendation != before
            # What is seen to come on as before was not avoided.
            news = ongoing.escalation.changes(
                t_ns, other=own if other else (), ignoring=own if is_warning else ()
            )
            if has_risen or news:
                told.append(self._alert(t_ns, ongoing))
        for ongoing in [each for each in self._ongoing if each not in threatened]:
            told += self._calm(t_ns, ongoing)
        return told

    def _encounters(self, t_ns: int) -> list[_Encounter]:
        """Return what is seen in the air, the most urgent first.

        If both the carrier of a camera and what it sees have a transponder, the watch for
        separation keeps them apart.
        """
        found = []
        for track in self._visual_tracks:
            view, carrier = track.last.geometry.view, track.carrier
            report = self._visual_tracks.traffic.carrier(view)
            is_flying = view.height_m > GROUNDED_M if report is None else not report.on_ground
            is_unknown = track.explained_by is None or report is None
            if carrier is None or not is_flying or not is_unknown or may_stand(track):
                continue
            approach = approach_of(track.observations)
            if approach is not None and not stays_in_place(track, approach):
                severity = self._grade(track, approach, t_ns)
                found.append(_Encounter(carrier, track, approach, severity))
        found.sort(key=lambda each: (-each.rank, each.approach.time_s))
        return found

    def _grade(self, track: VisualTrack, approach: Approach, t_ns: int) -> Severity | None:
        """Return the severity of an approach; None if it passes by or is far.

        The pictures of something that stays in one direction are alike, and so are the errors of a
        detector in them: many doubtful ones make no certain one.
        """
        config, miss = self.config, approach.least_miss()
        left_s = approach.time_s - (t_ns - track.last.t_ns) / SECOND_NS
        passes = miss > config.near_sizes or approach.closing < approach.closing_error
        if passes or left_s < 0.0:
            return None
        is_there = track.belief_of_one_look > EVEN_ODDS and self._visual_tracks.shows((track,))
        if is_there and approach.is_growing:
            if left_s <= config.warning_s and miss <= config.warning_sizes:
                return Severity.WARNING
            if left_s <= config.caution_s:
                return Severity.CAUTION
        return Severity.ADVISORY if left_s <= config.advisory_s else None

    def _calm(self, t_ns: int, ongoing: _Ongoing) -> list[Alert]:
        """End an encounter once it is past, so that nobody goes back before."""
        escalation = ongoing.escalation
        has_alert = escalation.severity is not None
        if has_alert and t_ns < ongoing.past_ns:
            escalation.stays()
            return []
        quiet_s = self.config.release_s if has_alert else BLIND_NS / SECOND_NS
        if not escalation.is_over(t_ns, quiet_s):
            return []
        self._ongoing.remove(ongoing)
        return [self._alert(t_ns, ongoing, active=False)] if has_alert else []

    def _recommended(self, t_ns: int, ongoing: _Ongoing) -> Recommendation:
        """Return what the crew is to do; what it was told stays while it has time to respond."""
        encounter, told = ongoing.encounter, ongoing.recommendation
        if told is not None and ongoing.escalation.is_fresh(t_ns):
            return told
        track, runway = encounter.track, self._runway_of(encounter.carrier)
        if runway is not None and not isinstance(told, Climb | Turn):
            return GoAround(runway=runway)
        report = self._visual_tracks.traffic.carrier(track.last.geometry.view)
        vertical_m = self._minima_from(track).vertical_m
        return evasion(track, encounter.approach, report, vertical_m, told)

    def _minima_from(self, track: VisualTrack) -> Minima:
        return BIRDS if track.label == "bird" else self._minima()

    def _alert(self, t_ns: int, ongoing: _Ongoing, active: bool = True) -> Alert:
        """Return the alert about an encounter; crews are told from CAUTION on."""
        encounter, escalation = ongoing.encounter, ongoing.escalation
        carrier, track = encounter.carrier, encounter.track
        since_s = (t_ns - track.last.t_ns) / SECOND_NS
        left_s = min(max(encounter.approach.time_s - since_s, 0.0), UNRELIABLE_S)
        advice = ongoing.recommendation
        unnamed = WILDLIFE if track.label == "bird" else UNIDENTIFIED
        return escalation.alert(
            kind="loss_of_separation",
            recipients=(carrier, CONTROLLER) if escalation.is_for_crews else (CONTROLLER,),
            traffic=(carrier, track.explained_by or unnamed),
            evidence=Evidence(
                sources=("vision", "adsb") if track.explained_by else ("vision",),
                time_to_closest_approach_s=left_s,
                note=_note(encounter),
                camera_ids=(track.camera,),
                tracks=self._visual_tracks.traffic.addresses(track.explained_by),
                rules=("time_to_contact",),
                shares={} if track.explained_by else {"vision": 1.0},
            ),
            finding=Intruder(
                carrier=carrier,
                is_birds=track.label == "bird",  # Nothing else flies, whatever it is taken for.
                callsign=track.explained_by,
                where=_where(encounter),
                contact_s=left_s if left_s < UNRELIABLE_S else None,
            ),
            recommendations={} if advice is None else {carrier: advice},
            active=active,
        )


def _where(encounter: _Encounter) -> Where:
    heading_rad = encounter.track.last.geometry.view.heading_deg * DEGREE
    right_rad = wrap_angle(encounter.ray.azimuth_rad - heading_rad)
    is_right = right_rad > 0.0
    if abs(right_rad) <= AHEAD_RAD:
        return "ahead"
    if abs(right_rad) <= BESIDE_RAD:
        return "ahead to the right" if is_right else "ahead to the left"
    if abs(right_rad) <= BEHIND_RAD:
        return "to the right" if is_right else "to the left"
    return "behind"


def _note(encounter: _Encounter) -> str:
    approach, track = encounter.approach, encounter.track
    turning = math.hypot(*approach.turning_rad_s) / DEGREE
    error_s = math.hypot(approach.closing_error, approach.lasting_error) * approach.time_s**2
    return (
        f"{track.camera}: contact in {approach.time_s:.0f} s, give or take {error_s:.0f} s; "
        f"direction turns by {turning:.2f} degrees/s"
    )


def evasion(
    track: VisualTrack,
    approach: Approach,
    report: AdsbReport | None,
    vertical_m: float,
    told: Recommendation | None = None,
) -> Climb | Turn:
    """Return how to stay clear of something: climb or descend away from it, or turn right.

    Within half a minute more distance is gained vertically, and less of it is needed: the vertical
    minimum. `BUFFER_FT` beyond it is what a direction that is wrong by `LEVEL_RAD` makes of 7 km,
    from where no light aircraft is seen. Aircraft that meet head-on, and one that overtakes, turn
    right (14 CFR 91.113).

    What the crew was told before stays. It is told another level once it has reached that one, and
    to climb after a descent, or the other way round, only if the other one is seen to pass on the
    side that it moves to.

    Parameters
    ----------
    report
        Last report of the aircraft that the camera is on; None if there is none.
    vertical_m
        Vertical distance to keep, in m.
    told
        What the crew was told last; None if it was told nothing.
    """
    if isinstance(told, Turn):
        return told
    if report is None or report.altitude_ft is None:
        return told if isinstance(told, Climb) else Turn(degrees=TURN_DEG)
    sense = (
        _measured_sense(approach)
        or _sense_of(told)
        or _sense(track, report.vertical_rate_fpm * FOOT_PER_MINUTE)
    )
    if isinstance(told, Climb) and sense == _sense_of(told):
        to_go_ft = sense * (told.altitude_ft - report.altitude_ft)
        if to_go_ft > LEVEL_STEP_FT:
            return told
    climb_ft = vertical_m / FOOT + BUFFER_FT
    if sense < 0 and track.last.geometry.view.height_m - climb_ft * FOOT < LEAST_HEIGHT_M:
        return Turn(degrees=TURN_DEG)
    level = (report.altitude_ft + sense * climb_ft) / LEVEL_STEP_FT
    rounded = math.ceil(level) if sense > 0 else math.floor(level)
    return Climb(
        sense="climb" if sense > 0 else "descend",
        altitude_ft=rounded * LEVEL_STEP_FT,
        vertical_rate_fpm=STRONG_VERTICAL_RATE_FPM,
    )


def _sense_of(told: Recommendation | None) -> int:
    """Return 1 for a climb, -1 for a descent, 0 for neither."""
    if isinstance(told, Climb):
        return 1 if told.sense == "climb" else -1
    return 1 if isinstance(told, GoAround) else 0


def _measured_sense(approach: Approach) -> int:
    """Return the sense away from where something is seen to pass; 0 if that cannot be told."""
    above = approach.passes_above()
    turns = abs(approach.turning_rad_s[1]) > 2.0 * approach.turning_error
    if abs(above) <= ABOVE_SIZES or not turns:
        return 0
    return -1 if above > 0.0 else 1


def _sense(track: VisualTrack, vertical_rate_m_s: float) -> int:
    """Return the sense away from where something is now."""
    if track.label == "bird":
        return 1  # Birds that take fright dive.
    elevation_rad = track.last.ray.elevation_rad
    if abs(elevation_rad) > LEVEL_RAD:
        return -1 if elevation_rad > 0.0 else 1
    return -1 if vertical_rate_m_s < 0.0 else 1
