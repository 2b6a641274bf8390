"""Manoeuvres, one for each of two aircraft, that keep them apart with the least disturbance."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.relative_motion import Minima, VerticalProfile, relative, time_to_loss_s
from airhilt.messages import Climb, MaintainLevel, Recommendation, Turn
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE

VERTICAL_RATE_FPM = 1500.0
"""Recommended rate, in ft/min: that of TCAS II's initial advisories (ICAO Doc 9863)."""
STRONG_VERTICAL_RATE_FPM = 2500.0
"""Recommended rate in a WARNING, in ft/min: that of TCAS II's strengthened advisories."""
TURN_DEG = 30.0
WIDE_TURNS_DEG = (-30.0, 60.0, -60.0, 90.0, -90.0)
"""Turns, to the right if positive, where all else loses separation."""
RESPONSE_S = 10.0
"""Time allowed for speech and for the reactions of crew and aircraft, in s."""
BUFFER_FT = 200.0
"""Distance aimed at beyond the vertical minimum, in ft."""
STEP_S = 2.0
HORIZON_S = 600.0
LEVEL_STEP_M = 100 * FOOT


class Manoeuvre(NamedTuple):
    """A manoeuvre of one aircraft: a level to fly to at a rate, and a turn."""

    target_m: float | None = None
    rate_m_s: float = 0.0
    turn_rad: float = 0.0


NONE = Manoeuvre()


@dataclass(frozen=True)
class Resolution:
    """A recommendation for each of a pair; None for an aircraft that need do nothing."""

    first: Recommendation | None
    second: Recommendation | None
    margin: float
    """Least distance in units of the minima; 1 or more keeps separation."""


def resolve(
    first: Track,
    second: Track,
    others: Sequence[Track],
    standard: Minima,
    infringed: Minima,
    strong: bool,
) -> Resolution:
    """Return the first candidate that keeps separation, or the one that keeps most of it.

    It aims at ``standard``; separation counts as lost below ``infringed``, the same less a
    tolerance. A candidate that brings either into conflict with ``others`` is a last resort.

    An aircraft in distress is told nothing: the other one gives way.

    Candidates are coordinated: of two that move vertically, the higher one climbs (of two at the
    same level the one with the higher address, so that the choice never flips).
    """
    rate_fpm = STRONG_VERTICAL_RATE_FPM if strong else VERTICAL_RATE_FPM
    best: tuple[float, Manoeuvre, Manoeuvre] | None = None
    for own, other in _candidates(first, second, standard, rate_fpm * FOOT_PER_MINUTE):
        if (first.in_distress and own != NONE) or (second.in_distress and other != NONE):
            continue
        margin = _least_margin(first, second, own, other, infringed)
        if _threatens(first, own, others, infringed) or _threatens(
            second, other, others, infringed
        ):
            margin -= 1.0
        if best is None or margin > best[0]:
            best = (margin, own, other)
        if margin >= 1.0:
            break
    if best is None:
        return Resolution(None, None, 0.0)
    margin, own, other = best
    return Resolution(
        _recommendation(first, own, rate_fpm), _recommendation(second, other, rate_fpm), margin
    )


def _candidates(
    first: Track, second: Track, standard: Minima, rate_m_s: float
) -> Iterator[tuple[Manoeuvre, Manoeuvre]]:
    """Yield pairs of manoeuvres, the least disturbing first."""
    first_is_upper = (first.altitude_m, first.icao24) > (second.altitude_m, second.icao24)
    if abs(first.altitude_m - second.altitude_m) < 0.5 * standard.vertical_m:
        first_is_upper = first.icao24 > second.icao24
    upper, lower = (first, second) if first_is_upper else (second, first)

    def ordered(up: Manoeuvre, down: Manoeuvre) -> tuple[Manoeuvre, Manoeuvre]:
        return (up, down) if first_is_upper else (down, up)

    # Who climbs or descends towards the other stops short of it.
    stop_lower = _flight_level_below(upper.altitude_m - standard.vertical_m)
    if _vertical(lower) > 0.0 and stop_lower > lower.altitude_m:
        yield ordered(NONE, Manoeuvre(stop_lower, _vertical(lower)))
    stop_upper = _flight_level_above(lower.altitude_m + standard.vertical_m)
    if _vertical(upper) < 0.0 and stop_upper < upper.altitude_m:
        yield ordered(Manoeuvre(stop_upper, -_vertical(upper)), NONE)

    # Both share what is missing; then one alone, then turns to the right.
    gap = upper.altitude_m - lower.altitude_m
    missing = standard.vertical_m + BUFFER_FT * FOOT - gap
    up_half = Manoeuvre(_flight_level_above(upper.altitude_m + 0.5 * missing), rate_m_s)
    down_half = Manoeuvre(_flight_level_below(lower.altitude_m - 0.5 * missing), rate_m_s)
    yield ordered(up_half, down_half)
    yield ordered(Manoeuvre(_flight_level_above(upper.altitude_m + missing), rate_m_s), NONE)
    yield ordered(NONE, Manoeuvre(_flight_level_below(lower.altitude_m - missing), rate_m_s))
    turn = Manoeuvre(turn_rad=TURN_DEG * DEGREE)
    yield turn, turn
    yield ordered(NONE, turn)
    yield ordered(turn, NONE)
    yield ordered(
        up_half._replace(turn_rad=TURN_DEG * DEGREE),
        down_half._replace(turn_rad=TURN_DEG * DEGREE),
    )
    for degrees in WIDE_TURNS_DEG:
        wide = Manoeuvre(turn_rad=degrees * DEGREE)
        yield NONE, wide
        yield wide, NONE


def _vertical(track: Track) -> float:
    return track.profile().rate_m_s


def _flight_level_above(altitude_m: float) -> float:
    return math.ceil(altitude_m / LEVEL_STEP_M - 1e-6) * LEVEL_STEP_M


def _flight_level_below(altitude_m: float) -> float:
    return math.floor(altitude_m / LEVEL_STEP_M + 1e-6) * LEVEL_STEP_M


def _least_margin(
    first: Track, second: Track, own: Manoeuvre, other: Manoeuvre, minima: Minima
) -> float:
    """Return the least of max(horizontal, vertical) distance in units of the minima."""
    before = relative(first, second)
    after = relative(_turned(first, own), _turned(second, other))
    profiles = (first.profile(), second.profile())
    turning = before.at(RESPONSE_S)
    least = math.inf
    for step in range(int(HORIZON_S / STEP_S)):
        time_s = step * STEP_S
        flown = time_s - RESPONSE_S
        if flown <= 0.0:
            horizontal = before.at(time_s).distance_m
        else:
            horizontal = math.hypot(
                turning.north_m + after.velocity_north_m_s * flown,
                turning.east_m + after.velocity_east_m_s * flown,
            )
        vertical = abs(_altitude(profiles[0], own, time_s) - _altitude(profiles[1], other, time_s))
        ratio = max(horizontal / minima.horizontal_m, vertical / minima.vertical_m)
        least = min(least, ratio)
    return least


def _threatens(track: Track, manoeuvre: Manoeuvre, others: Sequence[Track], minima: Minima) -> bool:
    """Return whether a manoeuvre brings an aircraft into conflict with somebody else."""
    if manoeuvre == NONE:
        return False
    turned = _turned(track, manoeuvre)
    profile = track.profile()
    if manoeuvre.target_m is not None:
        rate = math.copysign(manoeuvre.rate_m_s, manoeuvre.target_m - track.altitude_m)
        profile = VerticalProfile(track.altitude_m, rate, manoeuvre.target_m)
    return any(
        time_to_loss_s(relative(turned, other), profile, other.profile(), minima) is not None
        for other in others
    )


def _turned(track: Track, manoeuvre: Manoeuvre) -> Track:
    cos_t, sin_t = math.cos(manoeuvre.turn_rad), math.sin(manoeuvre.turn_rad)
    north, east = track.velocity_north_m_s, track.velocity_east_m_s
    turned = track.at(track.t_ns)
    turned.velocity_north_m_s = north * cos_t - east * sin_t
    turned.velocity_east_m_s = north * sin_t + east * cos_t
    return turned


def _altitude(profile: VerticalProfile, manoeuvre: Manoeuvre, time_s: float) -> float:
    if manoeuvre.target_m is None or time_s <= RESPONSE_S:
        return profile.at(time_s)
    begun = profile.at(RESPONSE_S)
    moved = manoeuvre.rate_m_s * (time_s - RESPONSE_S)
    to_go = manoeuvre.target_m - begun
    return begun + math.copysign(min(abs(to_go), moved), to_go)


def _recommendation(track: Track, manoeuvre: Manoeuvre, rate_fpm: float) -> Recommendation | None:
    if manoeuvre.target_m is not None:
        target_ft = round(manoeuvre.target_m / FOOT)
        if (manoeuvre.target_m - track.altitude_m) * _vertical(track) > 0.0:
            return MaintainLevel(altitude_ft=target_ft)
        return Climb(
            sense="climb" if manoeuvre.target_m > track.altitude_m else "descend",
            altitude_ft=target_ft,
            vertical_rate_fpm=rate_fpm,
        )
    if manoeuvre.turn_rad != 0.0:
        return Turn(degrees=round(manoeuvre.turn_rad / DEGREE))
    return None
