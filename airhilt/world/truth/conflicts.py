"""Conflicts of each pair of actors: separation, near mid-air collisions, collisions and TCAS."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from airhilt.geodesy.relative_motion import (
    Kinematics,
    Minima,
    Relative,
    VerticalProfile,
    horizontal_distance_m,
    relative,
    time_to_loss_s,
)
from airhilt.geodesy.wgs84 import LEAST_CURVATURE_RADIUS_M
from airhilt.messages import ConflictPhase
from airhilt.surveillance import tcas
from airhilt.units import FOOT, NAUTICAL_MILE, SECOND_NS, seconds_to_ns
from airhilt.world.flight import Aircraft
from airhilt.world.mover import Mover
from airhilt.world.truth.gaps import NARROW_M, gap, radius_m

NMAC = Minima(500 * FOOT, 100 * FOOT)
"""Minima of a near mid-air collision: 500 ft horizontally and 100 ft vertically (RTCA DO-365)."""
LEVEL_WITHIN_M = 100 * FOOT
"""Distance to the target altitude, in m, within which an aircraft counts as level there."""
ZONE_RADIUS_M = 5.0 * NAUTICAL_MILE
"""Radius of the zone of an airport's tower, in m: about a class D airspace (FAA Order JO 7400.2,
17-1-3). The tower separates by sight in the zone (FAA Order JO 7110.65, 7-2-1): separation cannot
be lost there, but near mid-air collisions, collisions and runway incursions count."""
ZONE_HEIGHT_M = 2_500.0 * FOOT
"""Height of the zone above the ground, in m."""
TCAS_RANGE_M = 40_000.0
"""Horizontal distance in m beyond which no pair is within a TCAS threshold."""
TCAS_HEIGHT_M = 3_000.0
"""Vertical distance in m beyond which no pair is within a TCAS threshold."""


Pair = tuple[str, str]


class _Moving(NamedTuple):
    """Mobile with its state now, and whether it is in flight."""

    name: str
    body: Mover
    state: Kinematics
    is_in_flight: bool


class Approach(NamedTuple):
    """Closest approach of a pair, at the horizontally closest instant of a tick."""

    t_ns: int
    horizontal_m: float
    vertical_m: float

    @property
    def slant_m(self) -> float:
        """Distance in three dimensions, in m."""
        return math.hypot(self.horizontal_m, self.vertical_m)


@dataclass(slots=True)
class PairTruth:
    """Conflict phases of one pair with their times, and its closest approaches."""

    first_ns: dict[ConflictPhase, int] = field(default_factory=dict)
    closest: Approach | None = None
    opened_ns: int | None = None
    """Time since which the conflict window of the pair is open, None while it is not."""
    closest_in_window: Approach | None = None
    """Closest approach while the conflict window was open."""
    least_horizontal_m: float | None = None
    """Least horizontal distance while the vertical minimum was infringed, in m."""
    least_vertical_m: float | None = None
    """Least vertical distance while the horizontal minimum was infringed, in m."""


def profile_of(aircraft: Aircraft) -> VerticalProfile:
    """Return the vertical profile that an aircraft is really flying."""
    state, target = aircraft.state, aircraft.target_altitude_m
    if aircraft.on_ground or abs(target - state.altitude_m) < LEVEL_WITHIN_M:
        return VerticalProfile(state.altitude_m, 0.0)
    rate = -state.velocity_down_m_s
    if (target - state.altitude_m) * rate <= 0.0:
        rate = aircraft.target_vertical_rate_m_s
    return VerticalProfile(state.altitude_m, rate, target)


class ConflictMonitor:
    """Watches separation, near mid-air collisions, collisions, and alerts of TCAS II.

    Bodies move straight on between two ticks, so that a fast pass is not missed. A collision
    is a contact of two outlines, and a near mid-air collision less than `NARROW_M` between the
    outlines of an aircraft in flight and of anything else. Separation minima apply to aircraft in
    flight, outside the zone of an airport's tower.

    Parameters
    ----------
    zone
        Centre of the tower's zone, if there is one.
    transponders
        Callsigns with a transponder. TCAS is aboard of these aircraft only, and sees no others.
    always
        Pairs whose closest approach is recorded at any distance; once a second when far apart.
    became_true
        Called with a new phase, its pair, and the horizontal and vertical distance.
    """

    def __init__(
        self,
        aircraft: Mapping[str, Aircraft],
        others: Mapping[str, Mover],
        minima: Minima,
        ground_m: float,
        zone: Kinematics | None,
        tick_s: float,
        transponders: frozenset[str],
        always: frozenset[Pair],
        became_true: Callable[[ConflictPhase, Pair, float, float], None],
    ) -> None:
        self.pairs: dict[Pair, PairTruth] = {}
        self._aircraft = aircraft
        self._bodies: dict[str, Mover] = {**aircraft, **others}
        self._zone = zone
        self._minima = minima
        self._ground_m = ground_m
        self._tick_s = tick_s
        self._transponders = transponders
        self._always = always
        self._became_true = became_true
        self._motions: dict[Pair, tuple[Kinematics, Kinematics, Relative]] = {}
        self._near: list[Pair] = []
        self._selected_ns = -SECOND_NS

    def tick(self, now_ns: int) -> None:
        """Watch the pairs that can come near within the next second."""
        if now_ns >= self._selected_ns + SECOND_NS:
            self._selected_ns = now_ns - now_ns % SECOND_NS
            self._select_pairs(now_ns)
        for pair in self._near:
            self._watch(now_ns, pair, self._tick_s)

    def motion(self, pair: Pair) -> Relative:
        """Return the motion of the second of a pair relative to the first."""
        first, second = self._bodies[pair[0]].state, self._bodies[pair[1]].state
        known = self._motions.get(pair)
        if known is None or known[0] is not first or known[1] is not second:
            known = self._motions[pair] = (first, second, relative(first, second))
        return known[2]

    def profiles(self, pair: Pair) -> tuple[VerticalProfile, VerticalProfile]:
        """Return the vertical profiles of a pair."""
        return self._profile(pair[0]), self._profile(pair[1])

    def vertical_m(self, pair: Pair) -> float:
        """Return the vertical distance of a pair, in m."""
        first, second = self._bodies[pair[0]].state, self._bodies[pair[1]].state
        return abs(first.altitude_m - second.altitude_m)

    def _profile(self, callsign: str) -> VerticalProfile:
        aircraft = self._aircraft.get(callsign)
        if aircraft is not None:
            return profile_of(aircraft)
        return VerticalProfile(self._bodies[callsign].state.altitude_m, 0.0)

    def _in_flight(self, callsign: str) -> bool:
        """Return whether this is an aircraft off the ground."""
        return callsign in self._aircraft and not self._aircraft[callsign].on_ground

    def time_to_loss_s(self, pair: Pair) -> float | None:
        """Return the time in s until the pair loses separation, if both fly on as they do."""
        return time_to_loss_s(self.motion(pair), *self.profiles(pair), self._minima)

    def flying(self, pair: Pair) -> bool:
        """Return whether neither of a pair has ended."""
        return all(self._bodies[callsign].ended is None for callsign in pair)

    def collided(self, pair: Pair) -> bool:
        """Return whether a pair, in any order, has collided."""
        truth = self.pairs.get(pair) or self.pairs.get((pair[1], pair[0]))
        return truth is not None and "collision" in truth.first_ns

    def open_window(self, pair: Pair, now_ns: int) -> None:
        """Record the closest approach of a pair in its conflict window from now on."""
        self.pairs.setdefault(pair, PairTruth()).opened_ns = now_ns

    def close_window(self, pair: Pair) -> None:
        """Record no more of the conflict window of a pair."""
        self.pairs[pair].opened_ns = None

    def is_seen_by_tcas(self, pair: Pair) -> bool:
        """Return whether both of a pair carry a transponder."""
        return self._transponders.issuperset(pair)

    def _select_pairs(self, now_ns: int) -> None:
        """Select the pairs to watch for a second, and check the TCAS thresholds of all pairs."""
        reach_m = self._minima.horizontal_m + 2_000.0
        height_m = self._minima.vertical_m + 300.0
        far_m, far_up_m = max(reach_m, TCAS_RANGE_M), max(height_m, TCAS_HEIGHT_M)
        moving = [
            _Moving(name, body, body.state, self._in_flight(name))
            for name, body in self._bodies.items()
            if body.ended is None
        ]
        self._near = []
        for one, two in self._roughly_near(moving, far_m, far_up_m):
            (name, own, first, flies), (other, its, second, too) = one, two
            pair = (name, other)
            height = abs(first.altitude_m - second.altitude_m)
            motion = relative(first, second)
            distance = motion.distance_m
            if flies and too:
                near = distance < reach_m and height < height_m
                if (
                    distance < TCAS_RANGE_M
                    and height < TCAS_HEIGHT_M
                    and self.is_seen_by_tcas(pair)
                ):
                    self._check_tcas(now_ns, pair, motion)
            else:
                in_a_second_m = distance - motion.speed_m_s
                near = in_a_second_m < radius_m(own) + radius_m(its) + NMAC.horizontal_m
            if near:
                self._near.append(pair)
            elif pair in self._always:
                self._watch(now_ns, pair, min(1.0, now_ns / SECOND_NS))

    def _roughly_near(
        self, moving: Sequence[_Moving], far_m: float, far_up_m: float
    ) -> Iterator[tuple[_Moving, _Moving]]:
        """Yield the pairs that are always watched, or not too far apart in one of three directions.

        The distance to the east of `relative` is at least that at the latitude nearer a pole. Most
        pairs of many are far apart, and arrays find them out at once.
        """
        altitudes_m = np.array([each.state.altitude_m for each in moving])
        latitudes_rad = np.array([each.state.latitude_rad for each in moving])
        is_far = np.abs(np.subtract.outer(altitudes_m, altitudes_m)) > far_up_m
        north_rad = np.abs(np.subtract.outer(latitudes_rad, latitudes_rad))
        is_far |= north_rad * LEAST_CURVATURE_RADIUS_M > far_m
        one, two = np.nonzero(~is_far)
        longitudes_rad = np.array([each.state.longitude_rad for each in moving])
        turn_rad = np.abs(longitudes_rad[one] - longitudes_rad[two])
        across = np.cos(latitudes_rad)
        east_rad = np.minimum(turn_rad, math.tau - turn_rad) * np.minimum(across[one], across[two])
        is_far[one, two] = east_rad * LEAST_CURVATURE_RADIUS_M > far_m
        places = {each.name: place for place, each in enumerate(moving)}
        for name, other in self._always:
            if name in places and other in places:
                is_far[places[name], places[other]] = False
        for place, later in np.argwhere(np.triu(~is_far, 1)).tolist():
            yield moving[place], moving[later]

    def _check_tcas(self, now_ns: int, pair: Pair, motion: Relative) -> None:
        states = [self._bodies[name].state for name in pair]
        gap = states[1].altitude_m - states[0].altitude_m
        gap_rate = states[0].velocity_down_m_s - states[1].velocity_down_m_s
        heights = [state.altitude_m - self._ground_m for state in states]
        for own, sign in ((0, 1.0), (1, -1.0)):
            alert = tcas.alert(
                motion,
                sign * gap,
                sign * gap_rate,
                tcas.Own(states[own].altitude_m, heights[own], heights[1 - own]),
            )
            if alert is not None:
                self._record("tcas_ta", now_ns, pair, motion.distance_m, abs(gap))
                self._record(alert, now_ns, pair, motion.distance_m, abs(gap))

    def _watch(self, now_ns: int, pair: Pair, elapsed_s: float) -> None:
        """Update the closest approach of a pair over the last ``elapsed_s``, and its phases."""
        first, second = (self._bodies[name] for name in pair)
        if first.ended is not None or second.ended is not None:
            return
        truth = self.pairs.setdefault(pair, PairTruth())
        motion = self.motion(pair)
        back_s = min(max(motion.time_to_closest_approach_s(), -elapsed_s), 0.0)
        near = self._approach(now_ns, pair, motion, back_s)
        truth.closest = _nearer(truth.closest, near)
        if truth.opened_ns is not None:
            since_s = (truth.opened_ns - now_ns) / SECOND_NS
            inside = near
            if since_s > back_s:  # It was nearest before the window opened.
                inside = self._approach(now_ns, pair, motion, since_s)
            truth.closest_in_window = _nearer(truth.closest_in_window, inside)
        self._classify(now_ns, pair, truth, near, back_s)

    def _approach(self, now_ns: int, pair: Pair, motion: Relative, back_s: float) -> Approach:
        """Return the distances of a pair ``back_s`` (0 or less) from now."""
        own, other = (self._bodies[name].state for name in pair)
        gap_rate = own.velocity_down_m_s - other.velocity_down_m_s
        return Approach(
            now_ns + seconds_to_ns(back_s),
            motion.at(back_s).distance_m,
            abs(other.altitude_m - own.altitude_m + gap_rate * back_s),
        )

    def _classify(
        self, now_ns: int, pair: Pair, truth: PairTruth, near: Approach, back_s: float
    ) -> None:
        """Record the phases of a pair at its closest approach, ``back_s`` (0 or less) from now."""
        _, horizontal, vertical = near
        first, second = (self._bodies[name] for name in pair)
        flying = [self._in_flight(name) for name in pair]
        both_fly = all(flying)
        too_near = horizontal < self._minima.horizontal_m
        too_level = vertical < self._minima.vertical_m
        reach_m = radius_m(first) + radius_m(second) + (NARROW_M if any(flying) else 0.0)
        between = gap(first, second, back_s) if horizontal <= reach_m else None
        if both_fly:
            if too_level:
                truth.least_horizontal_m = _lesser(truth.least_horizontal_m, horizontal)
            if too_near:
                truth.least_vertical_m = _lesser(truth.least_vertical_m, vertical)
            if too_near and too_level and not (self._in_zone(first) and self._in_zone(second)):
                self._record("loss_of_separation", now_ns, pair, horizontal, vertical)
        is_narrow = any(flying) and between is not None and between.slant_m < NARROW_M
        is_near = both_fly and horizontal < NMAC.horizontal_m and vertical < NMAC.vertical_m
        if is_narrow or is_near:
            self._record("nmac", now_ns, pair, horizontal, vertical)
        if between is not None and between.touches:
            self._record("collision", now_ns, pair, *between)

    def _in_zone(self, body: Mover) -> bool:
        """Return whether a body is in the zone in which the tower separates by sight."""
        if self._zone is None or body.state.altitude_m - self._ground_m > ZONE_HEIGHT_M:
            return False
        return horizontal_distance_m(self._zone, body.state) < ZONE_RADIUS_M

    def _record(
        self, phase: ConflictPhase, now_ns: int, pair: Pair, horizontal: float, vertical: float
    ) -> None:
        """Record a phase the first time that it becomes true."""
        truth = self.pairs.setdefault(pair, PairTruth())
        if phase not in truth.first_ns:
            truth.first_ns[phase] = now_ns
            self._became_true(phase, pair, horizontal, vertical)


def _nearer(known: Approach | None, other: Approach) -> Approach:
    return other if known is None or other.slant_m < known.slant_m else known


def _lesser(known: float | None, value: float) -> float:
    return value if known is None else min(known, value)
