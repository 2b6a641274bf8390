"""Manoeuvres, one for each of two aircraft, that keep them apart with the least disturbance."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from airhilt.assistant.decision.manoeuvres import (
    CHANGED_RESPONSE_S,
    HORIZON_S,
    NONE,
    RESPONSE_S,
    Manoeuvre,
    Paths,
    mirrored,
    paths,
    separations,
    straight_paths,
)
from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.relative_motion import Minima, Relative, relative
from airhilt.messages import Climb, MaintainLevel, Recommendation, Turn
from airhilt.surveillance.tcas_resolution import Sense
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, NAUTICAL_MILE

VERTICAL_RATE_FPM = 1500.0
"""Recommended rate, in ft/min: that of TCAS II's initial advisories (ICAO Doc 9863)."""
STRONG_VERTICAL_RATE_FPM = 2500.0
"""Recommended rate in a WARNING, or where the other one is not enough, in ft/min: that of TCAS
II's strengthened advisories."""
TURN_DEG = 30.0
WIDE_TURNS_DEG = (-30.0, 60.0, -60.0, 90.0, -90.0)
"""Turns, to the right if positive, where all else loses separation."""
BUFFER_FT = 200.0
"""Distance aimed at beyond the vertical minimum, in ft."""
LEAST_LEVEL_M = 600.0
"""Lowest level that an aircraft is told to descend to, in m above the sea; an assumption, because
the engine does not know the terrain."""
LEVEL_STEP_M = 100 * FOOT

CLOSE = Minima(0.5 * NAUTICAL_MILE, 300.0 * FOOT)
"""Distances that nobody is to be brought within who would pass farther apart: vertically the least
ALIM of TCAS II (ICAO Doc 9863); horizontally assumed."""

LAST_RESORT = 0.99
"""Greatest margin of a candidate that keeps the two apart and is dangerous for another reason."""
GAIN = 0.1
"""Separation, in units of the minima, that other advice must gain to replace what was told."""
Senses = tuple[Sense | None, Sense | None]
"""Sense of each of two aircraft; None if any will do."""
Candidate = tuple[Manoeuvre, Manoeuvre]
"""Manoeuvres of the upper aircraft and of the lower one."""


@dataclass(frozen=True)
class Resolution:
    """A recommendation for each of a pair; None for an aircraft that need do nothing."""

    first: Recommendation | None
    second: Recommendation | None
    manoeuvres: Candidate
    """Manoeuvres that the two are to fly by these."""
    margin: float
    """Least distance in units of the minima; 1 or more keeps separation."""


def resolve(
    first: Track,
    second: Track,
    others: Sequence[Track],
    standard: Minima,
    infringed: Minima,
    strong: bool,
    told: Candidate | None = None,
    departs: tuple[bool, bool] = (False, False),
    senses: Senses = (None, None),
) -> Resolution:
    """Return the first candidate that keeps separation, or the one that keeps most of it.

    It aims at ``standard``; separation counts as lost below ``infringed``, the same less a
    tolerance. A candidate that brings either into conflict with ``others`` is a last resort, and so
    is one that brings the two close if one of them flies on, or does the opposite.

    What they were ``told`` before stays unless something else keeps markedly more separation. Of
    those who depart from it (``departs``), nothing is expected: the other one's manoeuvre alone
    must do, and theirs as well, should they follow after all. Nobody who has one of the ``senses``
    is told to climb or descend in the other one.

    An aircraft in distress is told nothing: the other one gives way.

    Candidates are coordinated: of two that move vertically, the higher one climbs (of two at the
    same level the one with the higher address, so that the choice never flips).
    """
    first_is_upper = (first.altitude_m, first.icao24) > (second.altitude_m, second.icao24)
    if abs(first.altitude_m - second.altitude_m) < 0.5 * standard.vertical_m:
        first_is_upper = first.icao24 > second.icao24
    upper, lower = (first, second) if first_is_upper else (second, first)
    up_departs, down_departs = departs if first_is_upper else departs[::-1]
    up_sense, down_sense = senses if first_is_upper else senses[::-1]
    encounter = _Encounter(
        _Side(upper, up_departs, up_sense),
        _Side(lower, down_departs, down_sense),
        others,
        infringed,
        RESPONSE_S if told is None else CHANGED_RESPONSE_S,
    )
    stays = _Choice(-math.inf, NONE, NONE)
    if told is not None:
        stays = encounter.better(stays, [told if first_is_upper else told[::-1]])
    best = stays
    for candidates in _candidates(_Pair(upper, lower, standard), strong):
        fair = [
            (up, down)
            for up, down in candidates
            if encounter.up.may_fly(up) and encounter.down.may_fly(down)
        ]
        if best.margin >= 1.0:
            break
        best = encounter.better(best, fair)
    if told is not None and best.margin <= stays.margin + GAIN:
        best = stays
    for_upper, for_lower = _recommendation(upper, best.up), _recommendation(lower, best.down)
    if first_is_upper:
        return Resolution(for_upper, for_lower, (best.up, best.down), best.margin)
    return Resolution(for_lower, for_upper, (best.down, best.up), best.margin)


class _Pair:
    """Two aircraft in conflict, of which one is, or counts as, the upper one."""

    def __init__(self, upper: Track, lower: Track, standard: Minima) -> None:
        self.upper, self.lower, self.standard = upper, lower, standard
        aimed_at_m = standard.vertical_m + BUFFER_FT * FOOT
        interval = relative(upper, lower).interval_within(standard.horizontal_m) or (0.0, 0.0)
        near_s = max(interval[0], 0.0), min(max(interval[1], 0.0), HORIZON_S)
        highest_m = max(lower.profile().at(time_s) for time_s in near_s)
        lowest_m = min(upper.profile().at(time_s) for time_s in near_s)
        self.above_m = _flight_level_above(highest_m + aimed_at_m)
        """Level above the lower one, wherever that one gets to while the two are near."""
        self.below_m = _flight_level_below(lowest_m - aimed_at_m)
        """Level below the upper one, wherever that one gets to while the two are near."""
        self.share_m = 0.5 * (aimed_at_m - (upper.altitude_m - lower.altitude_m))
        """Distance by which each leaves its level if both do; at most 0 if theirs are enough."""


def _candidates(pair: _Pair, strong: bool) -> Iterator[list[Candidate]]:
    strongest = list(_verticals(pair, STRONG_VERTICAL_RATE_FPM))
    verticals = strongest if strong else list(_verticals(pair, VERTICAL_RATE_FPM))
    right = Manoeuvre(turn_rad=TURN_DEG * DEGREE)
    yield [*_stops(pair), *verticals]
    yield [(right, right), (NONE, right), (right, NONE)]
    if not strong:
        yield strongest
    wide = [Manoeuvre(turn_rad=degrees * DEGREE) for degrees in WIDE_TURNS_DEG]
    yield [each for turn in wide for each in ((NONE, turn), (turn, NONE))]
    yield [
        (_with_turn(up, degrees), _with_turn(down, degrees))
        for degrees in (TURN_DEG, *WIDE_TURNS_DEG)
        for up, down in strongest
    ]


def _stops(pair: _Pair) -> Iterator[Candidate]:
    """Yield that whoever climbs or descends towards the other stops short of it."""
    upper, lower, standard = pair.upper, pair.lower, pair.standard
    stop_lower = _flight_level_below(upper.altitude_m - standard.vertical_m)
    if _vertical(lower) > 0.0 and stop_lower > lower.altitude_m:
        yield NONE, Manoeuvre(stop_lower, _vertical(lower))
    stop_upper = _flight_level_above(lower.altitude_m + standard.vertical_m)
    if _vertical(upper) < 0.0 and stop_upper < upper.altitude_m:
        yield Manoeuvre(stop_upper, -_vertical(upper)), NONE


def _verticals(pair: _Pair, rate_fpm: float) -> Iterator[Candidate]:
    """Yield a climb and a descent that share what is missing, and then one of them alone."""
    rate_m_s = rate_fpm * FOOT_PER_MINUTE
    up_m = _flight_level_above(pair.upper.altitude_m + pair.share_m)
    down_m = _flight_level_below(pair.lower.altitude_m - pair.share_m)
    if pair.share_m > 0.0 and down_m >= LEAST_LEVEL_M:
        yield Manoeuvre(up_m, rate_m_s), Manoeuvre(down_m, rate_m_s)
    if pair.above_m > pair.upper.altitude_m:
        yield Manoeuvre(pair.above_m, rate_m_s), NONE
    if LEAST_LEVEL_M <= pair.below_m < pair.lower.altitude_m:
        yield NONE, Manoeuvre(pair.below_m, rate_m_s)
        if pair.above_m > pair.upper.altitude_m:
            yield Manoeuvre(pair.above_m, rate_m_s), Manoeuvre(pair.below_m, rate_m_s)


def _with_turn(manoeuvre: Manoeuvre, degrees: float) -> Manoeuvre:
    return manoeuvre if manoeuvre == NONE else manoeuvre._replace(turn_rad=degrees * DEGREE)


def _vertical(track: Track) -> float:
    return track.profile().rate_m_s


def _flight_level_above(altitude_m: float) -> float:
    return math.ceil(altitude_m / LEVEL_STEP_M - 1e-6) * LEVEL_STEP_M


def _flight_level_below(altitude_m: float) -> float:
    return math.floor(altitude_m / LEVEL_STEP_M + 1e-6) * LEVEL_STEP_M


class _Choice(NamedTuple):
    """A candidate with its margin, less 1 and below 1 if it is a last resort."""

    margin: float
    up: Manoeuvre
    down: Manoeuvre


class _Side(NamedTuple):
    """One of the two aircraft."""

    track: Track
    departs: bool
    """True if it does not do what it was told before."""
    sense: Sense | None
    """Sense that it may not leave; None if it may climb and descend."""

    def may_fly(self, manoeuvre: Manoeuvre) -> bool:
        """Return whether it may be told a manoeuvre; in distress none."""
        if manoeuvre == NONE:
            return True
        told = _recommendation(self.track, manoeuvre)
        reverses = isinstance(told, Climb) and self.sense not in (None, told.sense)
        return not self.track.in_distress and not reverses


class _Encounter:
    """Paths of two aircraft, and of the others, in the frame of the upper one."""

    def __init__(
        self, up: _Side, down: _Side, others: Sequence[Track], minima: Minima, response_s: float
    ) -> None:
        self.up, self.down = up, down
        self._minima, self._response_s = minima, response_s
        self._traffic = straight_paths(
            [_over_ground(up.track, each) for each in others], [each.profile() for each in others]
        )
        self._stays = self._paths(up, [NONE]), self._paths(down, [NONE])
        self._is_close = _is_within(CLOSE, *self._stays)

    def better(self, best: _Choice, candidates: Sequence[Candidate]) -> _Choice:
        if not candidates:
            return best
        ups, downs = (
            self._paths(side, manoeuvres)
            for side, manoeuvres in zip(
                (self.up, self.down), zip(*candidates, strict=True), strict=True
            )
        )
        margins = separations(ups, downs, self._minima)
        up_stays, down_stays = self._stays
        if self.up.departs:
            margins = np.minimum(margins, separations(up_stays, downs, self._minima))
        if self.down.departs:
            margins = np.minimum(margins, separations(ups, down_stays, self._minima))
        for row, (up, down) in enumerate(candidates):
            margin = float(margins[row])
            if margin <= best.margin:
                continue
            threatens = self._threatens(up, ups.soon(row)) or self._threatens(down, downs.soon(row))
            if threatens or self._endangers(up, down):
                margin = min(margin - 1.0, LAST_RESORT)
            if margin > best.margin:
                best = _Choice(margin, up, down)
            if margin >= 1.0:
                break
        return best

    def _paths(self, side: _Side, manoeuvres: Sequence[Manoeuvre]) -> Paths:
        motion = _over_ground(self.up.track, side.track)
        return paths(motion, side.track.profile(), manoeuvres, self._response_s)

    def _threatens(self, manoeuvre: Manoeuvre, flown: Paths) -> bool:
        if manoeuvre == NONE:
            return False
        return _is_within(self._minima, flown, self._traffic)

    def _endangers(self, up: Manoeuvre, down: Manoeuvre) -> bool:
        """Return whether two come close who would not, if one flies on or does the opposite."""
        if self._is_close:
            return False
        upper, lower = self.up.track, self.down.track
        ups = self._paths(self.up, [up, up, NONE, mirrored(up, upper.altitude_m)])
        downs = self._paths(self.down, [NONE, mirrored(down, lower.altitude_m), down, down])
        return _is_within(CLOSE, ups, downs)


def _is_within(minima: Minima, first: Paths, second: Paths) -> bool:
    return bool(np.any(separations(first, second, minima) < 1.0))


def _over_ground(origin: Track, track: Track) -> Relative:
    motion = relative(origin, track)
    return motion._replace(
        velocity_north_m_s=motion.velocity_north_m_s + origin.velocity_north_m_s,
        velocity_east_m_s=motion.velocity_east_m_s + origin.velocity_east_m_s,
    )


def _recommendation(track: Track, manoeuvre: Manoeuvre) -> Recommendation | None:
    """Return what is told of a manoeuvre: all of it.

    Whoever climbs or descends to a level at its present rate is told to maintain that level.
    """
    turn_deg = round(manoeuvre.turn_rad / DEGREE)
    if manoeuvre.target_m is None:
        return Turn(degrees=turn_deg) if turn_deg else None
    target_ft = round(manoeuvre.target_m / FOOT)
    to_go_m = manoeuvre.target_m - track.altitude_m
    is_stop = manoeuvre.rate_m_s == abs(_vertical(track)) and to_go_m * _vertical(track) > 0.0
    if is_stop and not turn_deg:
        return MaintainLevel(altitude_ft=target_ft)
    return Climb(
        sense="climb" if to_go_m > 0.0 else "descend",
        altitude_ft=target_ft,
        vertical_rate_fpm=round(manoeuvre.rate_m_s / FOOT_PER_MINUTE),
        turn_deg=turn_deg,
    )


def margin_of(
    first: tuple[Track, Manoeuvre, float], second: tuple[Track, Manoeuvre, float], minima: Minima
) -> float:
    """Return the least separation of two by what is expected of each, in units of the minima.

    Each has its track, its manoeuvre and the time to the begin of that, in s.
    """
    origin = first[0]
    one, other = (
        paths(_over_ground(origin, track), track.profile(), [manoeuvre], response_s)
        for track, manoeuvre, response_s in (first, second)
    )
    return float(separations(one, other, minima)[0])
