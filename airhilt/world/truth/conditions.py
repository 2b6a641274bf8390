"""Tests on the true state, made from the conditions of a scenario."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from airhilt.commands import CircuitLeg
from airhilt.scenario.models import (
    AllOf,
    AnyOf,
    BoundForAltitude,
    BoundForRunway,
    ClosestApproachPassed,
    Collided,
    Condition,
    DistanceBelow,
    LineBegun,
    LineEnded,
    OffRunways,
    OnLeg,
    OnRunway,
    PredictedLossOfSeparation,
    SeparationBelow,
    ThresholdWithin,
    TimeReached,
)
from airhilt.units import FOOT, NAUTICAL_MILE, seconds_to_ns
from airhilt.world.actors.actor import Actor
from airhilt.world.actors.triggers import Test
from airhilt.world.mover import Mover
from airhilt.world.site import ScenarioSite
from airhilt.world.truth.conflicts import ConflictMonitor, Pair
from airhilt.world.truth.flown_conditions import flown
from airhilt.world.truth.runways import RunwayMonitor


class ConditionCompiler:
    """Makes tests on the true state of one run from conditions."""

    def __init__(
        self,
        actors: Mapping[str, Actor],
        monitor: ConflictMonitor,
        runways: RunwayMonitor | None,
        begun_lines: set[str],
        ended_lines: set[str],
        site: ScenarioSite,
    ) -> None:
        self._actors = actors
        self._site = site
        self._monitor = monitor
        self._runways = runways
        self._begun_lines = begun_lines
        self._ended_lines = ended_lines

    def compile(self, condition: Condition) -> Test:
        """Return the test of a condition. It is false for actors that have ended."""
        match condition:
            case TimeReached(at_s=at_s):
                due_ns = seconds_to_ns(at_s)
                return lambda now_ns: now_ns >= due_ns
            case LineBegun(line=line):
                return lambda _: line in self._begun_lines
            case LineEnded(line=line):
                return lambda _: line in self._ended_lines
            case BoundForAltitude():
                return self._bound_for(condition)
            case PredictedLossOfSeparation(actors=pair, within_s=within_s):
                return self._of_pair(pair, lambda: self._loss_within(pair, within_s))
            case SeparationBelow(actors=pair, horizontal_nm=horizontal_nm, vertical_ft=vertical_ft):
                horizontal_m, vertical_m = horizontal_nm * NAUTICAL_MILE, vertical_ft * FOOT
                return self._of_pair(
                    pair,
                    lambda: (
                        self._monitor.vertical_m(pair) < vertical_m
                        and self._monitor.motion(pair).distance_m < horizontal_m
                    ),
                )
            case ClosestApproachPassed(actors=pair, for_s=for_s):
                return self._passed(pair, for_s)
            case DistanceBelow(actors=pair, distance_m=distance_m):
                return self._of_pair(
                    pair, lambda: self._monitor.motion(pair).distance_m < distance_m
                )
            case Collided(actors=pair):
                return lambda _: self._monitor.collided(pair)
            case BoundForRunway() | OnRunway() | ThresholdWithin():
                return self._of_runway(condition)
            case OffRunways(actor=name, has_been_on=has_been_on):
                return self._of_actor(name, self._off_runways(name, was_on=not has_been_on))
            case OnLeg(actor=name, leg=leg, within_nm=within_nm):
                within_m = math.inf if within_nm is None else within_nm * NAUTICAL_MILE
                return self._of_actor(name, lambda _: self._is_on_leg(name, leg, within_m))
            case AllOf(conditions=inner):
                tests = [self.compile(one) for one in inner]
                return lambda now_ns: all(_each(tests, now_ns))
            case AnyOf(conditions=inner):
                tests = [self.compile(one) for one in inner]
                return lambda now_ns: any(_each(tests, now_ns))
        body, test = self._actors[condition.actor].body, flown(condition, self._site)
        return lambda now_ns: body.ended is None and test(body, now_ns)

    def _of_pair(self, pair: Pair, test: Callable[[], bool]) -> Test:
        return lambda _: self._monitor.flying(pair) and test()

    def _of_actor(self, name: str, test: Callable[[Mover], bool]) -> Test:
        body = self._actors[name].body
        return lambda _: body.ended is None and test(body)

    def _bound_for(self, condition: BoundForAltitude) -> Test:
        altitude_m, within_m = condition.altitude_ft * FOOT, condition.within_ft * FOOT
        return self._of_actor(
            condition.actor,
            lambda body: abs(getattr(body, "target_altitude_m", math.inf) - altitude_m) <= within_m,
        )

    def _of_runway(self, condition: BoundForRunway | OnRunway | ThresholdWithin) -> Test:
        """Return a test that is false where there is no airport."""
        name, ident, runways = condition.actor, condition.runway, self._runways

        def test(_: Mover) -> bool:
            if runways is None:
                return False
            match condition:
                case BoundForRunway():
                    return runways.is_bound_for(name, ident)
                case OnRunway():
                    return runways.is_on(name, ident)
                case ThresholdWithin(within_s=within_s):
                    time_s = runways.time_to_threshold_s(name, ident)
                    return time_s is not None and time_s <= within_s

        return self._of_actor(name, test)

    def _is_on_leg(self, name: str, leg: CircuitLeg, within_m: float) -> bool:
        flown = None if self._runways is None else self._runways.leg(name)
        return flown is not None and flown.leg == leg and flown.before_threshold_m <= within_m

    def _off_runways(self, name: str, *, was_on: bool) -> Callable[[Mover], bool]:
        def is_off(body: Mover) -> bool:
            nonlocal was_on
            is_on = self._runways is not None and self._runways.is_on_any(name)
            was_on = was_on or is_on
            return was_on and body.on_ground and not is_on

        return is_off

    def _loss_within(self, pair: Pair, within_s: float | None) -> bool:
        loss = self._monitor.time_to_loss_s(pair)
        return loss is not None and (within_s is None or loss <= within_s)

    def _passed(self, pair: Pair, for_s: float) -> Test:
        diverging_since_ns: int | None = None

        def passed(now_ns: int) -> bool:
            nonlocal diverging_since_ns
            if self._monitor.motion(pair).time_to_closest_approach_s() >= 0.0:
                diverging_since_ns = None
                return False
            if diverging_since_ns is None:
                diverging_since_ns = now_ns
            return now_ns - diverging_since_ns >= seconds_to_ns(for_s)

        return passed


def _each(tests: Sequence[Test], now_ns: int) -> list[bool]:
    """Return the results of all tests: each must run at every tick, since some keep time."""
    return [test(now_ns) for test in tests]
