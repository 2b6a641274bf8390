"""The truth about each pair of actors, watched at every physics tick."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from airhilt.geodesy.relative_motion import (
    Kinematics,
    Minima,
    Relative,
    VerticalProfile,
    relative,
    time_to_loss_s,
)
from airhilt.geodesy.wgs84 import LEAST_CURVATURE_RADIUS_M
from airhilt.messages import ConflictPhase
from airhilt.surveillance import tcas
from airhilt.units import FOOT, NAUTICAL_MILE, SECOND_NS, seconds_to_ns
from airhilt.world.flight import Aircraft
from airhilt.world.mover import Mover
from airhilt.world.truth.gaps import gap, radius_m

NMAC = Minima(500 * FOOT, 100 * FOOT)
"""Near mid-air collision: closer than 500 ft horizontally and 100 ft vertically
(RTCA DO-365)."""
LEVEL_WITHIN_M = 100 * FOOT
"""An aircraft this near to its target altitude is taken to be level there."""
ZONE_RADIUS_M = 5.0 * NAUTICAL_MILE
ZONE_HEIGHT_M = 2_500.0 * FOOT
"""Around an airport with a tower, about a class D airspace (FAA Order JO 7400.2, 17-1-3). The
tower separates by sight in it (FAA Order JO 7110.65, 7-2-1): no distance is too small there, but
near misses, collisions and runway incursions are what they are."""
TOUCHING_WITHIN_M = 150.0
"""Of both circles around two bodies, where they are followed closely; more than two aircraft at
140 kt can close in the second until pairs are sorted out again."""
TCAS_RANGE_M = 40_000.0
TCAS_HEIGHT_M = 3_000.0
"""Beyond these no pair of aircraft is within any TCAS threshold."""


Pair = tuple[str, str]
Motion = tuple[Relative, VerticalProfile, VerticalProfile]
"""How the second of a pair moves against the first, and the vertical profiles of both."""


class Approach(NamedTuple):
    """The closest that a pair came, at the horizontal closest approach within a tick."""

    t_ns: int
    horizontal_m: float
    vertical_m: float

    @property
    def slant_m(self) -> float:
        """Distance in three dimensions."""
        return math.hypot(self.horizontal_m, self.vertical_m)


@dataclass(slots=True)
class PairTruth:
    """What became true of one pair, and when."""

    first_ns: dict[ConflictPhase, int] = field(default_factory=dict)
    closest: Approach | None = None
    least_horizontal_m: float | None = None
    """While the vertical minimum was infringed."""
    least_vertical_m: float | None = None
    """While the horizontal minimum was infringed."""


def profile_of(aircraft: Aircraft) -> VerticalProfile:
    """Return where an aircraft is really going vertically."""
    state, target = aircraft.state, aircraft.target_altitude_m
    if aircraft.on_ground:
        return VerticalProfile(state.altitude_m, 0.0)
    if abs(target - state.altitude_m) < LEVEL_WITHIN_M:
        return VerticalProfile(state.altitude_m, 0.0)
    rate = -state.velocity_down_m_s
    if (target - state.altitude_m) * rate <= 0.0:
        rate = aircraft.target_vertical_rate_m_s
    return VerticalProfile(state.altitude_m, rate, target)


class ConflictMonitor:
    """Watches separation, near mid-air collisions, collisions, and where TCAS II would speak.

    Between two ticks both are taken to move straight, so a fast pass is not stepped over. A
    collision is when the outlines of two bodies touch. Only aircraft in flight have minima to keep,
    and not inside the zone of an airport's tower.

    Parameters
    ----------
    aircraft, others
        What moves, by callsign.
    minima
        Where separation counts as lost.
    zone
        The centre of the tower's zone, if there is one.
    transponders
        Who carries one: without, TCAS neither is aboard nor sees an aircraft.
    always
        Pairs whose closest approach is followed however far apart they are, once a second there.
    became_true
        Called with the phase, the pair, and the horizontal and vertical distance.
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
        self._motions: dict[Pair, tuple[Kinematics, Kinematics, Motion]] = {}
        self._near: list[Pair] = []
        self._sorted_ns = -SECOND_NS

    def tick(self, now_ns: int) -> None:
        """Look at all pairs that can matter before the next second."""
        if now_ns >= self._sorted_ns + SECOND_NS:
            self._sorted_ns = now_ns - now_ns % SECOND_NS
            self._sort_out(now_ns)
        for pair in self._near:
            self._watch(now_ns, pair, self._tick_s)

    def motion(self, pair: Pair) -> Motion:
        """Return how the second of a pair moves against the first, and both profiles."""
        first, second = self._bodies[pair[0]], self._bodies[pair[1]]
        known = self._motions.get(pair)
        if known is None or known[0] is not first.state or known[1] is not second.state:
            motion = relative(first.state, second.state)
            profiles = self._profile(pair[0]), self._profile(pair[1])
            known = (first.state, second.state, (motion, *profiles))
            self._motions[pair] = known
        return known[2]

    def _profile(self, callsign: str) -> VerticalProfile:
        aircraft = self._aircraft.get(callsign)
        if aircraft is not None:
            return profile_of(aircraft)
        return VerticalProfile(self._bodies[callsign].state.altitude_m, 0.0)

    def _in_flight(self, callsign: str) -> bool:
        """Return whether this is an aircraft off the ground."""
        return callsign in self._aircraft and not self._aircraft[callsign].on_ground

    def time_to_loss_s(self, pair: Pair) -> float | None:
        """Return how long until the pair loses separation, if both fly on as they do."""
        return time_to_loss_s(*self.motion(pair), self._minima)

    def flying(self, pair: Pair) -> bool:
        """Return whether both still move."""
        return all(self._bodies[callsign].ended is None for callsign in pair)

    def collided(self, pair: Pair) -> bool:
        """Return whether a pair, in any order, has touched."""
        truth = self.pairs.get(pair) or self.pairs.get((pair[1], pair[0]))
        return truth is not None and "collision" in truth.first_ns

    def is_seen_by_tcas(self, pair: Pair) -> bool:
        """Return whether both of a pair carry a transponder."""
        return self._transponders.issuperset(pair)

    def _sort_out(self, now_ns: int) -> None:
        """Choose the pairs to watch closely for a second; on the way, ask what TCAS would say."""
        reach_m = self._minima.horizontal_m + 2_000.0
        height_m = self._minima.vertical_m + 300.0
        far_m, far_up_m = max(reach_m, TCAS_RANGE_M), max(height_m, TCAS_HEIGHT_M)
        moving = [(name, body) for name, body in self._bodies.items() if body.ended is None]
        self._near = []
        for (name, own), (other, its) in itertools.combinations(moving, 2):
            first, second = own.state, its.state
            height = abs(first.altitude_m - second.altitude_m)
            apart = abs(first.latitude_rad - second.latitude_rad) * LEAST_CURVATURE_RADIUS_M
            pair = (name, other)
            if (height > far_up_m or apart > far_m) and pair not in self._always:
                continue
            motion = relative(first, second)
            distance = motion.distance_m
            if self._in_flight(name) and self._in_flight(other):
                near = distance < reach_m and height < height_m
                if (
                    distance < TCAS_RANGE_M
                    and height < TCAS_HEIGHT_M
                    and self.is_seen_by_tcas(pair)
                ):
                    self._ask_tcas(now_ns, pair, motion)
            else:
                near = distance < radius_m(own) + radius_m(its) + TOUCHING_WITHIN_M
            if near:
                self._near.append(pair)
            elif pair in self._always:
                self._watch(now_ns, pair, min(1.0, now_ns / SECOND_NS))

    def _ask_tcas(self, now_ns: int, pair: Pair, motion: Relative) -> None:
        states = [self._bodies[name].state for name in pair]
        gap = states[1].altitude_m - states[0].altitude_m
        gap_rate = states[0].velocity_down_m_s - states[1].velocity_down_m_s
        heights = [state.altitude_m - self._ground_m for state in states]
        for own, sign in ((0, 1.0), (1, -1.0)):
            said = tcas.alert(
                motion,
                sign * gap,
                sign * gap_rate,
                tcas.Own(states[own].altitude_m, heights[own], heights[1 - own]),
            )
            if said is not None:
                self._first("tcas_ta", now_ns, pair, motion.distance_m, abs(gap))
                self._first(said, now_ns, pair, motion.distance_m, abs(gap))

    def _watch(self, now_ns: int, pair: Pair, elapsed_s: float) -> None:
        """Look at a pair, and at the time since it was looked at last."""
        first, second = (self._bodies[name] for name in pair)
        if first.ended is not None or second.ended is not None:
            return
        truth = self.pairs.get(pair)
        if truth is None:
            truth = self.pairs[pair] = PairTruth()
        own, other = first.state, second.state
        motion = relative(own, other)
        back_s = min(max(motion.time_to_closest_approach_s(), -elapsed_s), 0.0)
        horizontal = motion.at(back_s).distance_m
        gap_rate = own.velocity_down_m_s - other.velocity_down_m_s
        vertical = abs(other.altitude_m - own.altitude_m + gap_rate * back_s)
        least = truth.closest
        if least is None or horizontal**2 + vertical**2 < least[1] ** 2 + least[2] ** 2:
            truth.closest = Approach(now_ns + seconds_to_ns(back_s), horizontal, vertical)
        self._judge(now_ns, pair, truth, Approach(now_ns, horizontal, vertical), back_s)

    def _judge(
        self, now_ns: int, pair: Pair, truth: PairTruth, near: Approach, back_s: float
    ) -> None:
        """Name what is true of a pair that came so near, a fraction of a tick ago."""
        _, horizontal, vertical = near
        first, second = (self._bodies[name] for name in pair)
        if self._in_flight(pair[0]) and self._in_flight(pair[1]):
            too_near = horizontal < self._minima.horizontal_m
            too_level = vertical < self._minima.vertical_m
            if too_level:
                truth.least_horizontal_m = _lesser(truth.least_horizontal_m, horizontal)
            if too_near:
                truth.least_vertical_m = _lesser(truth.least_vertical_m, vertical)
            if too_near and too_level and not (self._in_zone(first) and self._in_zone(second)):
                self._first("loss_of_separation", now_ns, pair, horizontal, vertical)
            if horizontal < NMAC.horizontal_m and vertical < NMAC.vertical_m:
                self._first("nmac", now_ns, pair, horizontal, vertical)
        if horizontal > radius_m(first) + radius_m(second):
            return
        between = gap(first, second, back_s)
        if between.touches:
            self._first("collision", now_ns, pair, *between)

    def _in_zone(self, body: Mover) -> bool:
        """Return whether a body is where a tower separates by sight."""
        if self._zone is None:
            return False
        if body.state.altitude_m - self._ground_m > ZONE_HEIGHT_M:
            return False
        return relative(self._zone, body.state).distance_m < ZONE_RADIUS_M

    def _first(
        self, phase: ConflictPhase, now_ns: int, pair: Pair, horizontal: float, vertical: float
    ) -> None:
        truth = self.pairs.setdefault(pair, PairTruth())
        if phase not in truth.first_ns:
            truth.first_ns[phase] = now_ns
            self._became_true(phase, pair, horizontal, vertical)


def _lesser(known: float | None, value: float) -> float:
    return value if known is None else min(known, value)
