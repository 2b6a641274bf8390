"""Runway status lights: which red lights are lit, and who has them before the eyes.

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

import math
from collections.abc import Iterator
from typing import Annotated, Literal, NamedTuple

from pydantic import Field

from airhilt.assistant.decision.aerodrome import Aerodrome, Direction, Strip, Vector, way_through
from airhilt.assistant.decision.mobiles import (
    ALIGNED_RAD,
    FINAL_WIDENING,
    FINAL_WIDTH_M,
    HEIGHT_ALLOWANCE_M,
    OVERRUN_M,
    STEEPEST,
    Kind,
)
from airhilt.assistant.decision.surface_traffic import MOVING_M_S, SurfaceTraffic, Target
from airhilt.configuration import Configuration, Seconds
from airhilt.units import FOOT, KNOT, NAUTICAL_MILE, wrap_angle

BESIDE_M = 10.0
"""Distance beside the pavement, in m, that still counts as on it: an assumption."""
Amount = Annotated[float, Field(ge=0.0)]
"""Distance in m, or speed in m/s."""
ACCURATE_NACP = 11
"""Accuracy category for which the area of a runway is hardly made smaller."""


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
    """Lights that are lit before somebody's eyes.

    Attributes
    ----------
    viewer
        The target that has them ahead.
    because
        The target for which they are lit.
    runway
        Direction of the runway that must not be entered or used.
    is_disregarded
        True if the viewer moves on against them.
    can_stop
        False if the viewer is too near the pavement to stop short of it.
    """

    lights: Lights
    viewer: Target
    because: Target
    strip: Strip
    runway: str
    is_disregarded: bool
    can_stop: bool = True


class _OnRunway(NamedTuple):
    """A target on a runway, or on final for it, and where."""

    target: Target
    strip: Strip
    direction: Direction
    along_m: float
    kind: Kind

    def time_to_s(self, along_m: float) -> float:
        """Return the time until it is somewhere ahead at its present speed, in s."""
        return (along_m - self.along_m) / max(self.target.speed_m_s, 1.0)


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
                along_m, across_m = direction.along_m(point), abs(direction.across_m(point))
                if target.is_aloft:
                    if self._is_on_final(target, direction, along_m, across_m):
                        yield _OnRunway(target, strip, direction, along_m, "arrival")
                elif _is_on_pavement(direction, along_m, across_m) and self._points_along(
                    target, direction, along_m
                ):
                    kind: Kind = "rollout" if target.has_landed else "departure"
                    yield _OnRunway(target, strip, direction, along_m, kind)

    def _points_along(self, target: Target, direction: Direction, along_m: float) -> bool:
        """Return whether a target on the pavement points down the runway.

        One that has not moved yet points down the runway at whose beginning it stands.
        """
        if target.heading_rad is None:
            return along_m <= self._config.hold_lights_end_m
        return abs(wrap_angle(target.heading_rad - direction.course_rad)) <= ALIGNED_RAD

    def _is_on_final(
        self, target: Target, direction: Direction, along_m: float, across_m: float
    ) -> bool:
        """Return whether a target in the air is so near before landing that it lights REL."""
        if target.heading_rad is None or target.altitude_m is None:
            return False
        if target.climbs or target.has_taken_off:
            return False
        config = self._config
        is_slow = target.speed_m_s < config.slow_arrival_m_s
        within_m = config.slow_arrival_m if is_slow else config.arrival_m
        height_m = target.altitude_m - direction.elevation_m
        return (
            abs(wrap_angle(target.heading_rad - direction.course_rad)) <= ALIGNED_RAD
            and -within_m <= along_m <= direction.length_m
            and across_m <= FINAL_WIDTH_M + FINAL_WIDENING * max(-along_m, 0.0)
            and height_m <= HEIGHT_ALLOWANCE_M + STEEPEST * max(-along_m, 0.0)
        )

    def _latch(self, users: list[_OnRunway]) -> None:
        """Update which departures are at speed: from one speed on, until they fall below another.

        A rejected take-off is known by that it has been faster.
        """
        config, present = self._config, set()
        for user in users:
            if user.kind != "departure":
                continue
            number, speed = user.target.number, user.target.speed_m_s
            fastest = self._fastest_m_s.get(number, 0.0)
            is_rejected = speed < config.taxi_m_s < fastest
            if speed >= config.departure_m_s and not is_rejected:
                self._fastest_m_s[number] = max(fastest, speed)
                present.add(number)
        self._fastest_m_s = {
            number: fastest for number, fastest in self._fastest_m_s.items() if number in present
        }

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
        point, heading_rad = viewer.point_at(t_ns), viewer.heading_rad
        for strip in self._aerodrome.strips:
            to_pavement_m = strip.room_m(point, heading_rad)
            area = way_through(strip.core(ACCURATE_NACP), point, heading_rad)
            if to_pavement_m <= 0.0 or area is None or area.entry_m > self._config.seen_from_m:
                continue
            entry = Vector(
                point.east + to_pavement_m * math.sin(heading_rad),
                point.north + to_pavement_m * math.cos(heading_rad),
            )
            for user in fast:
                if user.strip is strip and user.target is not viewer and self._lights(user, entry):
                    needed_m = self._stopping_m(viewer)
                    yield RedLights(
                        "entrance",
                        viewer,
                        user.target,
                        strip,
                        user.direction.ident,
                        viewer.speed_m_s >= MOVING_M_S and area.entry_m <= needed_m,
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

    def _stopping_m(self, viewer: Target) -> float:
        """Return the distance in which somebody reacts and stops, in m."""
        speed = viewer.speed_m_s
        return speed * self._config.reaction_s + speed**2 / (2.0 * self._config.braking_m_s2)

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
            along_m = user.direction.along_m(point)
            if along_m > user.along_m and self._obstructs(other, point, user):
                yield RedLights(
                    "take-off hold",
                    user.target,
                    other,
                    user.strip,
                    user.direction.ident,
                    user.target.is_rolling,
                )

    def _obstructs(self, other: Target, point: Vector, user: _OnRunway) -> bool:
        """Return whether a target is on a runway, and stays for a while, or is about to enter."""
        direction, strip = user.direction, user.strip
        along_m, across_m = direction.along_m(point), abs(direction.across_m(point))
        if _is_on_pavement(direction, along_m, across_m):
            if other.heading_rad is None or other.speed_m_s < MOVING_M_S:
                return True
            way = strip.pavement_way(point, other.heading_rad)
            return way is not None and way.exit_m / other.speed_m_s > self._config.off_ahead_s
        if other.heading_rad is None or other.speed_m_s < MOVING_M_S:
            return False
        area = way_through(strip.core(ACCURATE_NACP), point, other.heading_rad)
        braking_m = other.speed_m_s**2 / (2.0 * self._config.braking_m_s2)
        return (
            area is not None
            and area.entry_m <= braking_m
            and strip.room_m(point, other.heading_rad) > 0.0
        )

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
            apart_s = abs(user.time_to_s(own_m) - other.time_to_s(other_m))
            if user.kind == "rollout" and not (
                self._is_fast(user) and apart_s <= self._config.meeting_s
            ):
                continue
            disregards = user.kind == "rollout" or user.target.is_rolling
            yield RedLights(
                "intersection",
                user.target,
                other.target,
                user.strip,
                user.direction.ident,
                disregards,
            )


def _is_on_pavement(direction: Direction, along_m: float, across_m: float) -> bool:
    return (
        across_m <= direction.half_width_m + BESIDE_M
        and -OVERRUN_M <= along_m <= direction.length_m + OVERRUN_M
    )
