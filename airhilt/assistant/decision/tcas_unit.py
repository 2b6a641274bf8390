"""TCAS II of one aircraft: from replies and own instruments to traffic and resolution advisories.

Thresholds and inhibits are those of `airhilt.surveillance.tcas`, sense and strength those of
`airhilt.surveillance.tcas_resolution`. One cycle a second looks at each intruder's track.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.findings import Announcement
from airhilt.assistant.decision.tcas_tracks import IntruderTrack, IntruderTracks
from airhilt.messages import (
    Climb,
    CockpitInstruments,
    Evidence,
    MaintainLevel,
    Recommendation,
    Severity,
    TcasReply,
)
from airhilt.surveillance import tcas
from airhilt.surveillance.tcas_resolution import (
    ACCELERATION_M_S2,
    INCREASED_RATE_M_S,
    NO_DESCENT_BELOW_M,
    NO_INCREASED_DESCENT_BELOW_M,
    RATE_M_S,
    RESPONSE_S,
    Resolution,
    Sense,
    Vertical,
    is_insufficient,
    may_weaken,
    opposite,
    select,
)
from airhilt.units import FOOT, FOOT_PER_MINUTE, SECOND_NS

SILENT_CYCLE_NS = 3 * SECOND_NS // 2
"""Time after a cycle, in ns, after which the next one begins even if nobody has replied."""
TRAFFIC_HOLD_S = 8.0
"""Time for which nothing must be wrong before a traffic advisory ends, in s: the least duration of
one (FAA, Introduction to TCAS II)."""
RESOLUTION_HOLD_S = 3.0
"""Time for which nothing must be wrong before a resolution advisory ends, in s; an assumption."""
ADVISED_FOR_S = 120.0
"""Time at the advised rate that gives the level of a recommendation, in s. An advisory has a rate
and no level; this one is further away than an advisory lasts."""
LEVEL_BELOW_M_S = 300 * FOOT_PER_MINUTE
"""Vertical rate, in m/s, below which an aircraft counts as level already."""


class Coordination:
    """Senses that equipped aircraft have told each other by Mode S.

    Who chooses first is followed. Of two that choose in one cycle the lower address comes first, as
    in TCAS II, where the higher one gives way.
    """

    def __init__(self) -> None:
        self._chosen: dict[tuple[str, str], Sense] = {}

    def required(self, own: str, other: str | None) -> Sense | None:
        """Return the sense that another aircraft's choice against the own one leaves."""
        chosen = None if other is None else self._chosen.get((other, own))
        return None if chosen is None else opposite(chosen)

    def tell(self, own: str, other: str, sense: Sense) -> None:
        """Tell another aircraft the own sense against it."""
        self._chosen[own, other] = sense

    def withdraw(self, own: str, other: str | None) -> None:
        """Tell another aircraft that there is no advisory against it any more."""
        if other is not None:
            self._chosen.pop((own, other), None)


class OwnState(NamedTuple):
    """The own aircraft by its instruments; the height is infinite above the radio altimeter."""

    vertical: Vertical
    height_m: float


@dataclass(slots=True)
class _Encounter:
    """One intruder from the first advisory about it to the last."""

    id: str
    revision: int = 0
    severity: Severity = Severity.CAUTION
    resolution: Resolution | None = None
    changed_ns: int = 0
    """Time of the last change of the resolution advisory."""
    calm_since_ns: int | None = None
    is_over: bool = False


class TcasUnit:
    """TCAS II of one aircraft.

    Parameters
    ----------
    callsign, icao24
        Callsign and address of the own aircraft.
    filters_misses
        True for the horizontal miss distance filter: no resolution advisory against an intruder
        whose miss distance is beyond DMOD.
    """

    def __init__(
        self, callsign: str, icao24: str, coordination: Coordination, *, filters_misses: bool
    ) -> None:
        self.callsign = callsign
        self.icao24 = icao24
        self._coordination = coordination
        self._filters_misses = filters_misses
        self._tracks = IntruderTracks()
        self._encounters: dict[IntruderTrack, _Encounter] = {}
        self._own: CockpitInstruments | None = None
        self._has_replies = False
        self._cycle_ns: int | None = None
        self._count = 0

    def take_instruments(self, instruments: CockpitInstruments) -> None:
        """Update altitude, vertical speed and radio height."""
        if self._own is None or instruments.t_ns >= self._own.t_ns:
            self._own = instruments

    def take_reply(self, reply: TcasReply) -> None:
        """Update the tracks with a reply."""
        self._tracks.take_reply(reply)
        self._has_replies = True

    @property
    def due_ns(self) -> int | None:
        """Time of the next cycle if no reply comes before; None if there is nobody to follow."""
        if self._cycle_ns is None or not any(True for _ in self._tracks):
            return None
        return self._cycle_ns + SILENT_CYCLE_NS

    def judge(self, t_ns: int) -> list[Alert]:
        """Return what a cycle brings, if one is due."""
        due_ns = self.due_ns
        if self._own is None or not (self._has_replies or (due_ns is not None and t_ns >= due_ns)):
            return []
        self._has_replies, self._cycle_ns = False, t_ns
        own = _own_state(self._own, t_ns)
        alerts = [alert for track in self._tracks.forget(t_ns) for alert in self._end(track)]
        for track in self._tracks:
            if track.is_settled:
                alerts += self._judge(track, own, t_ns)
        return alerts

    def _judge(self, track: IntruderTrack, own: OwnState, t_ns: int) -> Iterator[Alert]:
        """Yield the alert about one intruder if it is new or has changed."""
        said = self._said(track, own, t_ns)
        encounter = self._encounters.get(track)
        is_closing = track.motion(t_ns).rate_m_s < 0.0
        if encounter is not None and encounter.is_over:
            if said is not None and not (said == "tcas_ra" and is_closing):
                return
            del self._encounters[track]
            encounter = None
        if encounter is None:
            if said is None or not is_closing:
                return
            self._count += 1
            encounter = _Encounter(f"{self.callsign}-{self._count}")
            self._encounters[track] = encounter
            if said == "tcas_ta":
                yield self._alert(track, encounter, own, t_ns, "traffic, traffic")
        changed = self._resolution(track, encounter, said, own, t_ns)
        if changed is not None:
            encounter.severity = Severity.WARNING
            encounter.resolution, encounter.changed_ns = changed, t_ns
            yield self._alert(track, encounter, own, t_ns, _aural(changed, own))
        elif self._is_over(track, encounter, said, own, t_ns):
            yield from self._end(track)

    def _resolution(
        self,
        track: IntruderTrack,
        encounter: _Encounter,
        said: tcas.Alert | None,
        own: OwnState,
        t_ns: int,
    ) -> Resolution | None:
        """Return a resolution advisory that is new or has changed; None if neither."""
        present = encounter.resolution
        if present is None:
            return self._first_resolution(track, own, t_ns) if said == "tcas_ra" else None
        has_responded = t_ns - encounter.changed_ns >= RESPONSE_S * SECOND_NS
        if not has_responded or track.motion(t_ns).rate_m_s >= 0.0:
            return None
        encountered = (own.vertical, track.vertical(t_ns))
        time_s, alim_m = self._time_s(track, own, t_ns), self._level(own).alim_m
        if is_insufficient(*encountered, present, time_s, alim_m):
            return _stronger(present, own)
        if present.rate_m_s > 0.0 and may_weaken(*encountered, present.sense, time_s, alim_m):
            return Resolution(present.sense, 0.0)
        return None

    def _said(self, track: IntruderTrack, own: OwnState, t_ns: int) -> tcas.Alert | None:
        """Return the alert that thresholds, inhibits and the filter give now."""
        if track.on_ground:
            return None
        intruder = track.vertical(t_ns)
        gap_m = intruder.altitude_m - own.vertical.altitude_m
        state = tcas.Own(own.vertical.altitude_m, own.height_m, own.height_m + gap_m)
        gap_rate_m_s = intruder.rate_m_s - own.vertical.rate_m_s
        said = tcas.alert_at(track.motion(t_ns), gap_m, gap_rate_m_s, state)
        thresholds = self._level(own).resolution
        if said == "tcas_ra" and self._filters_misses and thresholds is not None:
            miss_m = math.sqrt(max(track.miss_distance_m() ** 2 - gap_m**2, 0.0))
            return "tcas_ta" if miss_m > thresholds.dmod_m else said
        return said

    def _level(self, own: OwnState) -> tcas.SensitivityLevel:
        return tcas.sensitivity_level(own.vertical.altitude_m, own.height_m)

    def _first_resolution(self, track: IntruderTrack, own: OwnState, t_ns: int) -> Resolution:
        """Choose the first resolution advisory, and coordinate it."""
        in_force = [
            other.resolution.sense
            for other in self._encounters.values()
            if other.resolution is not None and not other.is_over
        ]
        required = self._coordination.required(self.icao24, track.icao24)
        resolution = select(
            own.vertical,
            track.vertical(t_ns),
            self._time_s(track, own, t_ns),
            self._level(own).alim_m,
            required=in_force[0] if in_force else required,
            may_descend=own.height_m > NO_DESCENT_BELOW_M,
        )
        if track.has_tcas and track.icao24 is not None:
            self._coordination.tell(self.icao24, track.icao24, resolution.sense)
        return resolution

    def _is_over(
        self,
        track: IntruderTrack,
        encounter: _Encounter,
        said: tcas.Alert | None,
        own: OwnState,
        t_ns: int,
    ) -> bool:
        """Note whether anything is wrong now, and return whether nothing was for long enough.

        A threat stays one while it closes within the limits by range, whatever its altitude: the
        advisory itself opens the vertical distance.
        """
        motion, thresholds = track.motion(t_ns), self._level(own).resolution
        if encounter.resolution is None:
            hold_s, is_wrong = TRAFFIC_HOLD_S, said is not None
        else:
            hold_s = RESOLUTION_HOLD_S
            is_wrong = thresholds is not None and tcas.range_test(motion, thresholds)
        if is_wrong and motion.rate_m_s < 0.0:
            encounter.calm_since_ns = None
            return False
        if encounter.calm_since_ns is None:
            encounter.calm_since_ns = t_ns
        return t_ns - encounter.calm_since_ns >= hold_s * SECOND_NS

    def _end(self, track: IntruderTrack) -> Iterator[Alert]:
        """Yield the last alert about an intruder, if there was one before."""
        encounter = self._encounters.get(track)
        self._coordination.withdraw(self.icao24, track.icao24)
        if encounter is None or encounter.is_over:
            return
        encounter.is_over = True
        yield Alert(
            id=encounter.id,
            revision=encounter.revision,
            kind="loss_of_separation",
            severity=Severity.INFO,
            recipients=(self.callsign,),
            traffic=self._traffic(track),
            evidence=Evidence(sources=("tcas",), note="clear of conflict"),
            active=False,
        )

    def _time_s(self, track: IntruderTrack, own: OwnState, t_ns: int) -> float:
        """Return the time to the closest approach that an advisory is modelled for."""
        range_m, rate_m_s = track.motion(t_ns)
        thresholds = self._level(own).resolution
        most_s = 0.0 if thresholds is None else thresholds.tau_s
        return min(range_m / -rate_m_s, most_s) if rate_m_s < 0.0 else 0.0

    def _traffic(self, track: IntruderTrack) -> tuple[str, ...]:
        return (self.callsign,) if track.icao24 is None else (self.callsign, track.icao24)

    def _alert(
        self, track: IntruderTrack, encounter: _Encounter, own: OwnState, t_ns: int, aural: str
    ) -> Alert:
        range_m, rate_m_s = track.motion(t_ns)
        approach_s = range_m / -rate_m_s if rate_m_s < 0.0 else 0.0
        gap_m = track.vertical(t_ns).at(approach_s) - own.vertical.at(approach_s)
        resolution = encounter.resolution
        revision, encounter.revision = encounter.revision, encounter.revision + 1
        return Alert(
            id=encounter.id,
            revision=revision,
            kind="loss_of_separation",
            severity=encounter.severity,
            recipients=(self.callsign,),
            traffic=self._traffic(track),
            evidence=Evidence(
                sources=("tcas",),
                time_to_closest_approach_s=approach_s,
                vertical_at_closest_approach_m=abs(gap_m),
                note=aural,
                tracks=() if track.icao24 is None else (track.icao24,),
                rules=("traffic_advisory" if resolution is None else "resolution_advisory",),
            ),
            finding=Announcement(aural),
            recommendations=(
                {} if resolution is None else {self.callsign: _recommendation(resolution, own)}
            ),
        )


def _own_state(instruments: CockpitInstruments, t_ns: int) -> OwnState:
    """Return the own state now, from the latest instruments."""
    elapsed_s = (t_ns - instruments.t_ns) / SECOND_NS
    rate_m_s = instruments.vertical_speed_fpm * FOOT_PER_MINUTE
    altitude_m = instruments.altitude_ft * FOOT + rate_m_s * elapsed_s
    height_ft = 0 if instruments.on_ground else instruments.radio_height_ft
    return OwnState(
        Vertical(altitude_m, rate_m_s),
        math.inf if height_ft is None else height_ft * FOOT + rate_m_s * elapsed_s,
    )


def _stronger(resolution: Resolution, own: OwnState) -> Resolution | None:
    """Return the next stronger advisory of the same sense; None if there is none."""
    sense, rate_m_s = resolution
    if rate_m_s < RATE_M_S:
        may_begin = sense == "climb" or own.height_m > NO_DESCENT_BELOW_M
        return Resolution(sense, RATE_M_S) if may_begin else None
    may_increase = sense == "climb" or own.height_m > NO_INCREASED_DESCENT_BELOW_M
    if rate_m_s < INCREASED_RATE_M_S and may_increase:
        return Resolution(sense, INCREASED_RATE_M_S)
    return None


def _aural(resolution: Resolution, own: OwnState) -> str:
    """Return the announcement of an advisory (FAA, Introduction to TCAS II, table 4)."""
    sense, rate_m_s = resolution
    if rate_m_s == 0.0:
        is_level = abs(own.vertical.rate_m_s) < LEVEL_BELOW_M_S
        return "monitor vertical speed" if is_level else "level off, level off"
    if rate_m_s == INCREASED_RATE_M_S:
        word = "climb" if sense == "climb" else "descent"
        return f"increase {word}, increase {word}"
    return f"{sense}, {sense}"


def _recommendation(resolution: Resolution, own: OwnState) -> Recommendation:
    """Return what a crew is to fly: a level, because an autopilot is flown to one."""
    altitude_m, rate_m_s = own.vertical
    if resolution.rate_m_s == 0.0:
        if abs(rate_m_s) >= LEVEL_BELOW_M_S:
            stopping_s = RESPONSE_S + 0.5 * abs(rate_m_s) / ACCELERATION_M_S2
            altitude_m += rate_m_s * stopping_s
        return MaintainLevel(altitude_ft=_to_hundreds_ft(altitude_m))
    change_m = resolution.rate_m_s * ADVISED_FOR_S
    if resolution.sense == "descend":
        change_m = -min(change_m, max(own.height_m - tcas.RESOLUTION_INHIBITED_BELOW_M, 0.0))
    return Climb(
        sense=resolution.sense,
        altitude_ft=_to_hundreds_ft(altitude_m + change_m),
        vertical_rate_fpm=round(resolution.rate_m_s / FOOT_PER_MINUTE),
    )


def _to_hundreds_ft(altitude_m: float) -> float:
    return 100.0 * round(altitude_m / FOOT / 100.0)
