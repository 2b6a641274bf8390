"""The truth about each pair of aircraft, watched at every physics tick."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from airhilt.flight import Aircraft, AircraftState
from airhilt.messages import ConflictPhase
from airhilt.surveillance import tcas
from airhilt.surveillance.kinematics import (
    LEAST_CURVATURE_RADIUS_M,
    Minima,
    Relative,
    VerticalProfile,
    relative,
    time_to_loss_s,
)
from airhilt.units import FOOT, SECOND_NS, seconds_to_ns

NMAC = Minima(500 * FOOT, 100 * FOOT)
"""Near mid-air collision: closer than 500 ft horizontally and 100 ft vertically
(RTCA DO-365)."""
LEVEL_WITHIN_M = 100 * FOOT
"""An aircraft this near to its target altitude is taken to be level there."""
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
    if abs(target - state.altitude_m) < LEVEL_WITHIN_M:
        return VerticalProfile(state.altitude_m, 0.0)
    rate = -state.velocity_down_m_s
    if (target - state.altitude_m) * rate <= 0.0:
        rate = aircraft.target_vertical_rate_m_s
    return VerticalProfile(state.altitude_m, rate, target)


class ConflictMonitor:
    """Watches separation, near mid-air collisions, collisions, and where TCAS II would speak.

    Between two ticks both aircraft are taken to fly straight, so a fast pass is not stepped over.
    A collision is when cylinders around the two touch: as wide as the greater of length and span,
    as high as the aircraft.

    Parameters
    ----------
    aircraft
        By callsign.
    minima
        Where separation counts as lost.
    always
        Pairs whose closest approach is followed however far apart they are, once a second there.
    became_true
        Called with the phase, the pair, and the horizontal and vertical distance.
    """

    def __init__(
        self,
        aircraft: Mapping[str, Aircraft],
        minima: Minima,
        ground_m: float,
        tick_s: float,
        always: frozenset[Pair],
        became_true: Callable[[ConflictPhase, Pair, float, float], None],
    ) -> None:
        self.pairs: dict[Pair, PairTruth] = {}
        self._aircraft = aircraft
        self._minima = minima
        self._ground_m = ground_m
        self._tick_s = tick_s
        self._always = always
        self._became_true = became_true
        self._motions: dict[Pair, tuple[AircraftState, AircraftState, Motion]] = {}
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
        first, second = self._aircraft[pair[0]], self._aircraft[pair[1]]
        known = self._motions.get(pair)
        if known is None or known[0] is not first.state or known[1] is not second.state:
            motion = relative(first.state, second.state)
            profiles = profile_of(first), profile_of(second)
            known = (first.state, second.state, (motion, *profiles))
            self._motions[pair] = known
        return known[2]

    def time_to_loss_s(self, pair: Pair) -> float | None:
        """Return how long until the pair loses separation, if both fly on as they do."""
        return time_to_loss_s(*self.motion(pair), self._minima)

    def flying(self, pair: Pair) -> bool:
        """Return whether both aircraft still fly."""
        return all(self._aircraft[callsign].ended is None for callsign in pair)

    def _sort_out(self, now_ns: int) -> None:
        """Choose the pairs to watch closely for a second; on the way, ask what TCAS would say."""
        reach_m = self._minima.horizontal_m + 2_000.0
        height_m = self._minima.vertical_m + 300.0
        far_m, far_up_m = max(reach_m, TCAS_RANGE_M), max(height_m, TCAS_HEIGHT_M)
        flying = [
            (name, craft.state) for name, craft in self._aircraft.items() if craft.ended is None
        ]
        self._near = []
        for (name, first), (other, second) in itertools.combinations(flying, 2):
            gap = abs(first.altitude_m - second.altitude_m)
            apart = abs(first.latitude_rad - second.latitude_rad) * LEAST_CURVATURE_RADIUS_M
            pair = (name, other)
            if (gap > far_up_m or apart > far_m) and pair not in self._always:
                continue
            motion = relative(first, second)
            distance = motion.distance_m
            if distance < TCAS_RANGE_M and gap < TCAS_HEIGHT_M:
                self._ask_tcas(now_ns, pair, motion)
            if distance < reach_m and gap < height_m:
                self._near.append(pair)
            elif pair in self._always:
                self._watch(now_ns, pair, min(1.0, now_ns / SECOND_NS))

    def _ask_tcas(self, now_ns: int, pair: Pair, motion: Relative) -> None:
        states = [self._aircraft[name].state for name in pair]
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
        first, second = (self._aircraft[name] for name in pair)
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
        too_near = horizontal < self._minima.horizontal_m
        too_level = vertical < self._minima.vertical_m
        if too_level:
            truth.least_horizontal_m = _lesser(truth.least_horizontal_m, horizontal)
        if too_near:
            truth.least_vertical_m = _lesser(truth.least_vertical_m, vertical)
        if not (too_near and too_level):
            return
        self._first("loss_of_separation", now_ns, pair, horizontal, vertical)
        if horizontal < NMAC.horizontal_m and vertical < NMAC.vertical_m:
            self._first("nmac", now_ns, pair, horizontal, vertical)
            if self._touch(first, second, horizontal, vertical):
                self._first("collision", now_ns, pair, horizontal, vertical)

    @staticmethod
    def _touch(first: Aircraft, second: Aircraft, horizontal: float, vertical: float) -> bool:
        sizes = (first.kind.dimensions, second.kind.dimensions)
        width = sum(max(size.length_m, size.span_m) for size in sizes) / 2.0
        height = sum(size.height_m for size in sizes) / 2.0
        return horizontal < width and vertical < height

    def _first(
        self, phase: ConflictPhase, now_ns: int, pair: Pair, horizontal: float, vertical: float
    ) -> None:
        truth = self.pairs.setdefault(pair, PairTruth())
        if phase not in truth.first_ns:
            truth.first_ns[phase] = now_ns
            self._became_true(phase, pair, horizontal, vertical)


def _lesser(known: float | None, value: float) -> float:
    return value if known is None else min(known, value)
