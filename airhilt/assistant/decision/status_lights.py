"""Runway status lights: which red lights are lit, and who has them ahead.

Sources
-------
AIM
    FAA Aeronautical Information Manual, 2-1-6 (faraim.org): entrance lights (REL), take-off hold
    lights (THL) and runway intersection lights (RIL).
LL
    MIT Lincoln Laboratory (rwsl.ll.mit.edu): 3/4 NM for arrivals below 110 kt. Its protocol says
    what is done on red: stop, and what is not safe is left to the crew's own judgement.
LGA
    NTSB preliminary report on LaGuardia, 22 March 2026: REL went out 3 s before the crossing.

What is called an assumption has no published source. The chart of the briefing has no taxiways:
every way on to a runway is taken to have entrance lights, and every runway to have the other two.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal, NamedTuple

from pydantic import Field

from airhilt.assistant.decision.aerodrome import Aerodrome, Direction, Strip, Vector, way_through
from airhilt.assistant.decision.findings import RunwayUse
from airhilt.assistant.decision.mobiles import (
    FINAL_WIDENING,
    FINAL_WIDTH_M,
    HEIGHT_ALLOWANCE_M,
    OVERRUN_M,
    STEEPEST,
)
from airhilt.assistant.decision.surface_traffic import SurfaceTraffic, Target
from airhilt.assistant.decision.velocity_checks import MOVING_M_S
from airhilt.configuration import Configuration, Seconds
from airhilt.units import FOOT, KNOT, NAUTICAL_MILE

BESIDE_M = 10.0
"""Distance beside the pavement, in m, that still counts as on it: an assumption."""
Amount = Annotated[float, Field(ge=0.0)]
"""Distance in m, or speed in m/s."""


class StatusLightConfig(Configuration):
    """Numbers of the light logic."""

    departure_m_s: Amount = Field(
        30.0 * KNOT, description="speed from which a departure lights the REL ahead, in m/s (AIM)"
    )
    arrival_m: Amount = Field(
        NAUTICAL_MILE,
        description="distance to the threshold from which an arrival lights all REL, in m (AIM)",
    )
    slow_arrival_m: Amount = Field(
        0.75 * NAUTICAL_MILE,
        description="the same for an arrival slower than slow_arrival_m_s, in m (LL)",
    )
    slow_arrival_m_s: Amount = Field(
        110.0 * KNOT, description="speed below which an arrival is slow, in m/s (LL)"
    )
    rollout_m_s: Amount = Field(
        80.0 * KNOT,
        description="speed below which a landing lights only the REL that it reaches within "
        "path_s, in m/s (AIM)",
    )
    path_s: Seconds = Field(30.0, description="time ahead of a slow landing, in s (AIM)")
    taxi_m_s: Amount = Field(
        34.0 * KNOT,
        description="speed below which a landing or a rejected take-off lights nothing, in m/s "
        "(AIM)",
    )
    off_ahead_s: Seconds = Field(
        3.0,
        description="time before the crossing at which lights go out, in s (AIM: 3 to 4 s; LGA)",
    )
    hold_lights_end_m: Amount = Field(
        (375.0 + 1500.0) * FOOT,
        description="distance of the end of the THL from the threshold, in m (AIM)",
    )
    meeting_s: Seconds = Field(
        5.0,
        description="RIL for a landing: difference of the times to the intersection, in s (AIM)",
    )
    seen_from_m: Amount = Field(
        100.0,
        description="distance to the hold line from which the REL are seen, in m: an assumption",
    )
    reaction_s: Seconds = Field(
        5.0,
        description="time in which a crew or a driver reacts, in s (standard pilot model of ICAO "
        "Annex 10, volume IV)",
    )
    braking_m_s2: float = Field(
        2.0, gt=0.0, description="ordinary braking before a hold line, in m/s2: an assumption"
    )


Lights = Literal["entrance", "take-off hold", "intersection"]


class RedLights(NamedTuple):
    """Red lights that a target has ahead."""

    lights: Lights
    viewer: Target
    because: Target
    """The target for which they are lit."""
    strip: Strip
    runway: str
    """Direction of the runway that must not be entered or used."""
    is_disregarded: bool
    """True if the viewer moves on against them."""
    can_stop: bool = True
    """False if the viewer is too near the pavement to stop short of it."""


class _OnRunway(NamedTuple):
    """A target on a runway, or on final for it, and where."""

    target: Target
    strip: Strip
    direction: Direction
    along_m: float
    kind: RunwayUse

    def time_to_s(self, along_m: float) -> float:
        """Return the time until it is somewhere ahead at its present speed, in s."""
        return (along_m - self.along_m) / max(self.target.speed_m_s, 1.0)

    def red(self, lights: Lights, because: Target, *, is_disregarded: bool) -> RedLights:
        """Return red lights that it has ahead."""
        ident = self.direction.ident
        return RedLights(lights, self.target, because, self.strip, ident, is_disregarded)


class StatusLights:
    """The lights of all runways of an airport."""

    def __init__(self, aerodrome: Aerodrome, config: StatusLightConfig) -> None:
        self._aerodrome = aerodrome
        self._config = config
        self._fastest_m_s: dict[int, float] = {}
        """Greatest speed of each departure that has lit the REL, by track."""

    def lit(self, traffic: SurfaceTraffic, t_ns: int) -> Iterator[RedLights]:
        """Yield the lights that somebody sees lit at a time."""
        users = [user for target in traffic for user in self._uses(target, t_ns)]
        self._latch(users)
        fast = [user for user in users if self._is_fast(user)]
        for viewer in traffic:
            if not viewer.is_aloft:
                yield from self._entrance_lights(viewer, fast, t_ns)
        for user in users:
            if user.kind == "departure":
                yield from self._hold_lights(user, traffic, t_ns)
            if user.kind != "arrival":
                yield from self._intersection_lights(user, fast)

    # --- the traffic for which lights are lit -----------------------------------------------

    def _uses(self, target: Target, t_ns: int) -> Iterator[_OnRunway]:
        """Yield how a target uses runways: lands on, takes off from, or rolls out on them."""
        point = target.point_at(t_ns)
        for strip in self._aerodrome.strips:
            for direction in strip.directions:
                kind = self._use(target, point, direction)
                if kind is not None:
                    yield _OnRunway(target, strip, direction, direction.along_m(point), kind)

    def _use(self, target: Target, point: Vector, direction: Direction) -> RunwayUse | None:
        """Return how a target uses a runway; None if it does not.

        One on the pavement that has not moved yet points down the runway at whose beginning it
        stands. One in the air uses it if it is so near before landing that it lights REL.
        """
        along_m, across_m = direction.along_m(point), abs(direction.across_m(point))
        heading_rad, config = target.heading_rad, self._config
        if heading_rad is not None and not direction.points_along(heading_rad):
            return None
        if target.altitude_m is None:
            is_at_begin = along_m <= config.hold_lights_end_m
            if not _is_on_pavement(direction, along_m, across_m):
                return None
            if heading_rad is None and not is_at_begin:
                return None
            return "rollout" if target.has_landed else "departure"
        if heading_rad is None or target.climbs or target.has_taken_off:
            return None
        is_slow = target.speed_m_s < config.slow_arrival_m_s
        within_m = config.slow_arrival_m if is_slow else config.arrival_m
        left_m, height_m = max(-along_m, 0.0), target.altitude_m - direction.elevation_m
        is_on_final = (
            -within_m <= along_m <= direction.length_m
            and across_m <= FINAL_WIDTH_M + FINAL_WIDENING * left_m
            and height_m <= HEIGHT_ALLOWANCE_M + STEEPEST * left_m
        )
        return "arrival" if is_on_final else None

    def _latch(self, users: list[_OnRunway]) -> None:
        """Update which departures are at speed: from one speed on, until they fall below another.

        A rejected take-off is known by that it has been faster.
        """
        config, before, self._fastest_m_s = self._config, self._fastest_m_s, {}
        for user in users:
            number, speed = user.target.number, user.target.speed_m_s
            fastest = before.get(number, 0.0)
            is_rejected = speed < config.taxi_m_s < fastest
            if user.kind == "departure" and speed >= config.departure_m_s and not is_rejected:
                self._fastest_m_s[number] = max(fastest, speed)

    def _is_fast(self, user: _OnRunway) -> bool:
        if user.kind == "departure":
            return user.target.number in self._fastest_m_s
        return user.kind == "arrival" or user.target.speed_m_s >= self._config.taxi_m_s

    # --- entrance lights --------------------------------------------------------------------

    def _entrance_lights(
        self, viewer: Target, fast: list[_OnRunway], t_ns: int
    ) -> Iterator[RedLights]:
        """Yield the REL ahead of a target beside a runway."""
        if viewer.heading_rad is None or not fast:
            return
        config, speed = self._config, viewer.speed_m_s
        point, heading_rad = viewer.point_at(t_ns), viewer.heading_rad
        needed_m = speed * config.reaction_s + self._braking_m(viewer)
        for strip in self._aerodrome.strips:
            to_pavement_m = strip.room_m(point, heading_rad)
            area = way_through(strip.core(), point, heading_rad)
            if to_pavement_m <= 0.0 or area is None or area.entry_m > config.seen_from_m:
                continue
            entry = point.moved(to_pavement_m, heading_rad)
            is_disregarded = speed >= MOVING_M_S and area.entry_m <= needed_m
            for user in fast:
                if user.strip is strip and user.target is not viewer and self._lights(user, entry):
                    yield RedLights(
                        "entrance",
                        viewer,
                        user.target,
                        strip,
                        user.direction.ident,
                        is_disregarded,
                        can_stop=to_pavement_m > needed_m,
                    )

    def _lights(self, user: _OnRunway, entry: Vector) -> bool:
        """Return whether a user of a runway lights the REL at an entrance."""
        config = self._config
        left_s = user.time_to_s(user.direction.along_m(entry))
        if left_s < config.off_ahead_s:
            return False
        is_slow = user.kind == "rollout" and user.target.speed_m_s < config.rollout_m_s
        return not is_slow or left_s <= config.path_s

    def _braking_m(self, target: Target) -> float:
        return target.speed_m_s**2 / (2.0 * self._config.braking_m_s2)

    # --- take-off hold lights ---------------------------------------------------------------

    def _hold_lights(
        self, user: _OnRunway, traffic: SurfaceTraffic, t_ns: int
    ) -> Iterator[RedLights]:
        """Yield the THL ahead of a target in position, or at the beginning of its roll."""
        if user.along_m > self._config.hold_lights_end_m:
            return
        for other in traffic:
            if other is user.target or other.is_aloft:
                continue
            point = other.point_at(t_ns)
            is_ahead = user.direction.along_m(point) > user.along_m
            if is_ahead and self._obstructs(other, point, user):
                yield user.red("take-off hold", other, is_disregarded=user.target.is_rolling)

    def _obstructs(self, other: Target, point: Vector, user: _OnRunway) -> bool:
        """Return whether a target is on a runway, and stays for a while, or is about to enter."""
        direction, strip = user.direction, user.strip
        along_m, across_m = direction.along_m(point), abs(direction.across_m(point))
        is_on = _is_on_pavement(direction, along_m, across_m)
        if other.heading_rad is None or other.speed_m_s < MOVING_M_S:
            return is_on
        way = strip.pavement_way(point, other.heading_rad)
        if is_on:
            return way is not None and way.exit_m / other.speed_m_s > self._config.off_ahead_s
        area = way_through(strip.core(), point, other.heading_rad)
        is_ahead = way is not None and way.entry_m > 0.0
        return is_ahead and area is not None and area.entry_m <= self._braking_m(other)

    # --- intersection lights ----------------------------------------------------------------

    def _intersection_lights(self, user: _OnRunway, fast: list[_OnRunway]) -> Iterator[RedLights]:
        """Yield the RIL ahead of a target that takes off or rolls out towards an intersection."""
        for other in fast:
            crossing = self._aerodrome.crossing(user.strip, other.strip)
            if other.target is user.target or crossing is None:
                continue
            own_m = user.direction.along_m(crossing)
            other_m = other.direction.along_m(crossing)
            if own_m <= user.along_m or other_m <= other.along_m:
                continue
            rolls_out = user.kind == "rollout"
            apart_s = abs(user.time_to_s(own_m) - other.time_to_s(other_m))
            if rolls_out and (not self._is_fast(user) or apart_s > self._config.meeting_s):
                continue
            is_disregarded = rolls_out or user.target.is_rolling
            yield user.red("intersection", other.target, is_disregarded=is_disregarded)


def _is_on_pavement(direction: Direction, along_m: float, across_m: float) -> bool:
    return (
        across_m <= direction.half_width_m + BESIDE_M
        and -OVERRUN_M <= along_m <= direction.length_m + OVERRUN_M
    )
