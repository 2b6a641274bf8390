"""Conditions on the true state, as scenarios state them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from airhilt.flight import Aircraft
from airhilt.metrics.monitor import ConflictMonitor, Pair
from airhilt.scenario.models import (
    AllOf,
    AnyOf,
    BoundForAltitude,
    ClosestApproachPassed,
    Condition,
    LineEnded,
    PredictedLossOfSeparation,
    SeparationBelow,
    TimeReached,
)
from airhilt.units import FOOT, NAUTICAL_MILE, seconds_to_ns

Test = Callable[[int], bool]
"""Tells whether a condition is true at a time in nanoseconds."""


class ConditionCompiler:
    """Turns conditions into tests on the true state of one run."""

    def __init__(
        self,
        aircraft: Mapping[str, Aircraft],
        monitor: ConflictMonitor,
        ended_lines: set[str],
    ) -> None:
        self._aircraft = aircraft
        self._monitor = monitor
        self._ended_lines = ended_lines

    def compile(self, condition: Condition) -> Test:
        """Return the test for a condition. Tests of ended aircraft are false."""
        match condition:
            case TimeReached(at_s=at_s):
                due_ns = seconds_to_ns(at_s)
                return lambda now_ns: now_ns >= due_ns
            case LineEnded(line=line):
                return lambda _: line in self._ended_lines
            case BoundForAltitude():
                return self._bound_for(condition)
            case PredictedLossOfSeparation(actors=pair, within_s=within_s):
                return self._of_flying(pair, lambda: self._loss_within(pair, within_s))
            case SeparationBelow():
                return self._separation(condition)
            case ClosestApproachPassed(actors=pair, for_s=for_s):
                return self._passed(pair, for_s)
            case AllOf(conditions=inner):
                tests = [self.compile(one) for one in inner]
                return lambda now_ns: all(_each(tests, now_ns))
            case AnyOf(conditions=inner):
                tests = [self.compile(one) for one in inner]
                return lambda now_ns: any(_each(tests, now_ns))

    def _of_flying(self, pair: Pair, test: Callable[[], bool]) -> Test:
        return lambda _: self._monitor.flying(pair) and test()

    def _loss_within(self, pair: Pair, within_s: float) -> bool:
        loss = self._monitor.time_to_loss_s(pair)
        return loss is not None and loss <= within_s

    def _bound_for(self, condition: BoundForAltitude) -> Test:
        aircraft = self._aircraft[condition.actor]
        altitude_m, within_m = condition.altitude_ft * FOOT, condition.within_ft * FOOT
        return lambda _: (
            aircraft.ended is None and abs(aircraft.target_altitude_m - altitude_m) <= within_m
        )

    def _separation(self, condition: SeparationBelow) -> Test:
        pair = condition.actors
        horizontal_m = condition.horizontal_nm * NAUTICAL_MILE
        vertical_m = condition.vertical_ft * FOOT

        def below() -> bool:
            motion, first, second = self._monitor.motion(pair)
            gap = abs(first.altitude_m - second.altitude_m)
            return gap < vertical_m and motion.distance_m < horizontal_m

        return self._of_flying(pair, below)

    def _passed(self, pair: Pair, for_s: float) -> Test:
        diverging_since_ns: int | None = None

        def passed(now_ns: int) -> bool:
            nonlocal diverging_since_ns
            motion, _, _ = self._monitor.motion(pair)
            if motion.time_to_closest_approach_s() >= 0.0:
                diverging_since_ns = None
                return False
            if diverging_since_ns is None:
                diverging_since_ns = now_ns
            return now_ns - diverging_since_ns >= seconds_to_ns(for_s)

        return passed


def _each(tests: Sequence[Test], now_ns: int) -> list[bool]:
    """Ask every test, also those that cannot change the answer: some keep time."""
    return [test(now_ns) for test in tests]
