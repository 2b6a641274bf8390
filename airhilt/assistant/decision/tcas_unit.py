"""TCAS II of one aircraft: from replies and own instruments to traffic and resolution advisories.

Thresholds and inhibits are those of `airhilt.surveillance.tcas`, sense and strength those of
`airhilt.surveillance.tcas_resolution`. One cycle a second looks at each intruder's track.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from airhilt.assistant.decision.advice import SEEN_S
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
from airhilt.surveillance.tcas import RangeMotion
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
    reversal,
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


Senses = dict[tuple[str, str], Sense]
"""Sense that the aircraft with the first address has told the second one by Mode S.

Who chooses first is followed. Of two that choose in one cycle the lower address comes first, as in
TCAS II, where the higher one gives way. The lower address alone reverses its sense, once in an
encounter, and the other one follows."""


@dataclass(slots=True)
class _Encounter:
    """One intruder from the first advisory about it to the last."""

    id: str
    revision: int = 0
    severity: Severity = Severity.CAUTION
    resolution: Resolution | None = None
    changed_ns: int = 0
    """Time of the last change of the resolution advisory."""
    is_reversed: bool = False
    calm_since_ns: int | None = None
    is_over: bool = False


class _Look(NamedTuple):
    """One intruder and the own aircraft as of one cycle."""

    track: IntruderTrack
    motion: RangeMotion
    intruder: Vertical
    own: Vertical
    height_m: float
    """Own height; infinite above the reach of the radio altimeter."""

    @property
    def level(self) -> tcas.SensitivityLevel:
        return tcas.sensitivity_level(self.own.altitude_m, self.height_m)

    @property
    def is_closing(self) -> bool:
        return self.motion.rate_m_s < 0.0

    @property
    def approach_s(self) -> float:
        """Time to the closest approach, in s; 0 if it is past."""
        return self.motion.range_m / -self.motion.rate_m_s if self.is_closing else 0.0

    @property
    def time_s(self) -> float:
        """Time to the closest approach that an advisory is modelled for, in s."""
        thresholds = self.level.resolution
        return min(self.approach_s, 0.0 if thresholds is None else thresholds.tau_s)

    def said(self, filters_misses: bool) -> tcas.Alert | None:
        """Return the alert that thresholds, inhibits and the filter give."""
        if self.track.on_ground:
            return None
        gap_m = self.intruder.altitude_m - self.own.altitude_m
        state = tcas.Own(self.own.altitude_m, self.height_m, self.height_m + gap_m)
        gap_rate_m_s = self.intruder.rate_m_s - self.own.rate_m_s
        said = tcas.alert_at(self.motion, gap_m, gap_rate_m_s, state)
        thresholds = self.level.resolution
        if said == "tcas_ra" and filters_misses and thresholds is not None:
            miss_m = math.sqrt(max(self.track.miss_distance_m() ** 2 - gap_m**2, 0.0))
            return "tcas_ta" if miss_m > thresholds.dmod_m else said
        return said


class TcasUnit:
    """TCAS II of one aircraft.

    Parameters
    ----------
    senses
        Senses that equipped aircraft have told each other.
    filters_misses
        True for the horizontal miss distance filter: no resolution advisory against an intruder
        whose miss distance is beyond DMOD.
    """

    def __init__(self, callsign: str, icao24: str, senses: Senses, *, filters_misses: bool) -> None:
        self.callsign = callsign
        self.icao24 = icao24
        self._senses = senses
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
        own, height_m = _own_state(self._own, t_ns)
        alerts = [alert for track in self._tracks.forget(t_ns) for alert in self._end(track)]
        for track in self._tracks:
            if track.is_settled:
                look = _Look(track, track.motion(t_ns), track.vertical(t_ns), own, height_m)
                alerts += self._judge(look, t_ns)
        return alerts

    def _judge(self, look: _Look, t_ns: int) -> Iterator[Alert]:
        said = look.said(self._filters_misses)
        encounter = self._encounters.get(look.track)
        if encounter is not None and encounter.is_over:
            if said is not None and not (said == "tcas_ra" and look.is_closing):
                return
            del self._encounters[look.track]
            encounter = None
        if encounter is None:
            if said is None or not look.is_closing:
                return
            self._count += 1
            encounter = _Encounter(f"{self.callsign}-{self._count}")
            self._encounters[look.track] = encounter
            if said == "tcas_ta":
                yield self._alert(look, encounter, "traffic, traffic")
        if encounter.resolution is None:
            changed = self._first_resolution(look) if said == "tcas_ra" else None
        else:
            changed = self._changed(encounter, encounter.resolution, look, t_ns)
        if changed is not None:
            before, encounter.resolution = encounter.resolution, changed
            encounter.severity, encounter.changed_ns = Severity.WARNING, t_ns
            encounter.is_reversed |= before is not None and before.sense != changed.sense
            self._tell_sense(look.track, changed.sense)
            yield self._alert(look, encounter, _aural(before, changed, look.own))
        elif _is_over(encounter, look, said, t_ns):
            yield from self._end(look.track)

    def _first_resolution(self, look: _Look) -> Resolution:
        in_force = self._in_force()
        return select(
            look.own,
            look.intruder,
            look.time_s,
            look.level.alim_m,
            required=in_force[0].sense if in_force else self._required(look.track),
            may_descend=_may_fly("descend", look),
        )

    def _changed(
        self, encounter: _Encounter, present: Resolution, look: _Look, t_ns: int
    ) -> Resolution | None:
        """Return another advisory; None if the present one stays."""
        if not look.is_closing or look.level.resolution is None:
            return None
        is_alone, comes_first = len(self._in_force()) == 1, self._comes_first(look.track)
        required = self._required(look.track)
        if is_alone and not comes_first and required == opposite(present.sense):
            return Resolution(required, RATE_M_S if _may_fly(required, look) else 0.0)
        elapsed_s = (t_ns - encounter.changed_ns) / SECOND_NS
        if elapsed_s < RESPONSE_S:
            return None
        if is_alone and comes_first and not encounter.is_reversed:
            departs = elapsed_s >= RESPONSE_S + SEEN_S and _departs(present, look.own)
            found = _reversal(present, look, departs=departs)
            if found is not None:
                return found
        return _adjusted(present, look)

    def _in_force(self) -> list[Resolution]:
        return [
            each.resolution
            for each in self._encounters.values()
            if each.resolution is not None and not each.is_over
        ]

    def _required(self, track: IntruderTrack) -> Sense | None:
        """Return the sense that the intruder's leaves; None if it has told none."""
        told = None if track.icao24 is None else self._senses.get((track.icao24, self.icao24))
        return None if told is None else opposite(told)

    def _comes_first(self, track: IntruderTrack) -> bool:
        """Return whether the own sense goes before that of an intruder."""
        return not track.has_tcas or track.icao24 is None or self.icao24 < track.icao24

    def _tell_sense(self, track: IntruderTrack, sense: Sense) -> None:
        if track.has_tcas and track.icao24 is not None:
            self._senses[self.icao24, track.icao24] = sense

    def _end(self, track: IntruderTrack) -> Iterator[Alert]:
        encounter = self._encounters.get(track)
        if track.icao24 is not None:
            self._senses.pop((self.icao24, track.icao24), None)
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

    def _traffic(self, track: IntruderTrack) -> tuple[str, ...]:
        return (self.callsign,) if track.icao24 is None else (self.callsign, track.icao24)

    def _alert(self, look: _Look, encounter: _Encounter, aural: str) -> Alert:
        approach_s, resolution = look.approach_s, encounter.resolution
        gap_m = look.intruder.at(approach_s) - look.own.at(approach_s)
        advice = None if resolution is None else _recommendation(resolution, look)
        revision, encounter.revision = encounter.revision, encounter.revision + 1
        return Alert(
            id=encounter.id,
            revision=revision,
            kind="loss_of_separation",
            severity=encounter.severity,
            recipients=(self.callsign,),
            traffic=self._traffic(look.track),
            evidence=Evidence(
                sources=("tcas",),
                time_to_closest_approach_s=approach_s,
                vertical_at_closest_approach_m=abs(gap_m),
                note=aural,
                tracks=() if look.track.icao24 is None else (look.track.icao24,),
                rules=("traffic_advisory" if resolution is None else "resolution_advisory",),
            ),
            finding=Announcement(aural),
            recommendations={} if advice is None else {self.callsign: advice},
        )


def _own_state(instruments: CockpitInstruments, t_ns: int) -> tuple[Vertical, float]:
    elapsed_s = (t_ns - instruments.t_ns) / SECOND_NS
    rate_m_s = instruments.vertical_speed_fpm * FOOT_PER_MINUTE
    altitude_m = instruments.altitude_ft * FOOT + rate_m_s * elapsed_s
    height_ft = 0 if instruments.on_ground else instruments.radio_height_ft
    height_m = math.inf if height_ft is None else height_ft * FOOT + rate_m_s * elapsed_s
    return Vertical(altitude_m, rate_m_s), height_m


def _may_fly(sense: Sense, look: _Look) -> bool:
    return sense == "climb" or look.height_m > NO_DESCENT_BELOW_M


def _departs(present: Resolution, own: Vertical) -> bool:
    """Return whether a crew climbs in place of descending, or the other way round."""
    against_m_s = -own.rate_m_s if present.sense == "climb" else own.rate_m_s
    return against_m_s >= LEVEL_BELOW_M_S


def _stronger(present: Resolution, look: _Look) -> Resolution | None:
    """Return the next stronger advisory of the same sense; None if there is none."""
    sense, rate_m_s = present
    lowest_m = NO_DESCENT_BELOW_M if rate_m_s < RATE_M_S else NO_INCREASED_DESCENT_BELOW_M
    stronger_m_s = RATE_M_S if rate_m_s < RATE_M_S else INCREASED_RATE_M_S
    may_strengthen = sense == "climb" or look.height_m > lowest_m
    return Resolution(sense, stronger_m_s) if rate_m_s < stronger_m_s and may_strengthen else None


def _reversal(present: Resolution, look: _Look, *, departs: bool) -> Resolution | None:
    """Return an advisory of the other sense; None if the present one stays."""
    if not _may_fly(opposite(present.sense), look):
        return None
    return reversal(
        look.own,
        look.intruder,
        _stronger(present, look) or present,
        look.time_s,
        departs=departs,
        coordinates=look.track.has_tcas,
    )


def _adjusted(present: Resolution, look: _Look) -> Resolution | None:
    """Return a stronger or a weaker advisory of the same sense; None if the present one stays."""
    time_s, alim_m = look.time_s, look.level.alim_m
    if is_insufficient(look.own, look.intruder, present, time_s, alim_m):
        return _stronger(present, look)
    if present.rate_m_s > 0.0 and may_weaken(
        look.own, look.intruder, present.sense, time_s, alim_m
    ):
        return Resolution(present.sense, 0.0)
    return None


def _is_over(encounter: _Encounter, look: _Look, said: tcas.Alert | None, t_ns: int) -> bool:
    """Note whether anything is wrong now, and return whether nothing was for long enough.

    A threat stays one while it closes within the limits by range, whatever its altitude: the
    advisory itself opens the vertical distance.
    """
    if encounter.resolution is None:
        hold_s, is_wrong = TRAFFIC_HOLD_S, said is not None
    else:
        hold_s, thresholds = RESOLUTION_HOLD_S, look.level.resolution
        is_wrong = thresholds is not None and tcas.range_test(look.motion, thresholds)
    if is_wrong and look.is_closing:
        encounter.calm_since_ns = None
        return False
    if encounter.calm_since_ns is None:
        encounter.calm_since_ns = t_ns
    return t_ns - encounter.calm_since_ns >= hold_s * SECOND_NS


def _aural(before: Resolution | None, resolution: Resolution, own: Vertical) -> str:
    """Return the announcement of an advisory (FAA, Introduction to TCAS II, table 4)."""
    sense, rate_m_s = resolution
    if rate_m_s == 0.0:
        is_level = abs(own.rate_m_s) < LEVEL_BELOW_M_S
        return "monitor vertical speed" if is_level else "level off, level off"
    if rate_m_s == INCREASED_RATE_M_S:
        word = "climb" if sense == "climb" else "descent"
        return f"increase {word}, increase {word}"
    said = f"{sense}, {sense}"
    is_reversal = before is not None and before.sense != sense
    return f"{said} now, {said} now" if is_reversal else said


def _recommendation(resolution: Resolution, look: _Look) -> Recommendation:
    """Return what a crew is to fly: a level, because an autopilot is flown to one."""
    altitude_m, rate_m_s = look.own
    if resolution.rate_m_s == 0.0:
        if abs(rate_m_s) >= LEVEL_BELOW_M_S:
            stopping_s = RESPONSE_S + 0.5 * abs(rate_m_s) / ACCELERATION_M_S2
            altitude_m += rate_m_s * stopping_s
        return MaintainLevel(altitude_ft=_to_hundreds_ft(altitude_m))
    change_m = resolution.rate_m_s * ADVISED_FOR_S
    if resolution.sense == "descend":
        change_m = -min(change_m, max(look.height_m - tcas.RESOLUTION_INHIBITED_BELOW_M, 0.0))
    return Climb(
        sense=resolution.sense,
        altitude_ft=_to_hundreds_ft(altitude_m + change_m),
        vertical_rate_fpm=round(resolution.rate_m_s / FOOT_PER_MINUTE),
    )


def _to_hundreds_ft(altitude_m: float) -> float:
    return 100.0 * round(altitude_m / FOOT / 100.0)
