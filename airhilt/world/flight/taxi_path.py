"""Path of a taxiing aircraft over the ground: where to steer, and how fast to go."""

from __future__ import annotations

import bisect
import itertools
import math
from collections.abc import Sequence
from typing import NamedTuple

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place
from airhilt.units import wrap_angle
from airhilt.world.flight.autopilot import within
from airhilt.world.flight.state import AircraftState

LATERAL_ACCELERATION_M_S2 = 0.8
"""Greatest lateral acceleration in the turns of a taxiway, in m/s2."""
DECELERATION_M_S2 = 0.8
"""Deceleration towards the path's end and its turns, in m/s2."""
LOOK_AHEAD_S = 1.5
"""Time ahead of the point that is steered to, in s."""
STEPS_M = 5.0
"""Distance between the points at which turns are looked for, in m."""
WINDOW = 6
"""Number of steps ahead among which the nearest is looked for."""


class _Leg(NamedTuple):
    """A step of the path: its beginning, direction, length, and how far along it begins."""

    east: float
    north: float
    sin: float
    cos: float
    length: float
    along: float


class TaxiPath:
    """A polyline of two places or more to follow at a greatest speed.

    ``look_ahead_m`` is the least distance of the point that is steered to.
    """

    def __init__(self, places: Sequence[Place], speed_m_s: float, look_ahead_m: float) -> None:
        self._local_frame = LocalFrame(places[0])
        self._look_ahead = look_ahead_m
        self._greatest_m_s = speed_m_s
        corners = [self._local_frame.to_local(place) for place in places]
        self._points = [corners[0]]
        for a, b in itertools.pairwise(corners):
            pieces = max(math.ceil(math.dist(a, b) / STEPS_M), 1)
            self._points.extend(
                (a[0] + (b[0] - a[0]) * piece / pieces, a[1] + (b[1] - a[1]) * piece / pieces)
                for piece in range(1, pieces + 1)
                if math.dist(a, b) > 0.0
            )
        steps = [math.dist(a, b) for a, b in itertools.pairwise(self._points)]
        self._along = [0.0, *itertools.accumulate(steps)]
        self._legs = [
            _Leg(*a, (b[0] - a[0]) / step, (b[1] - a[1]) / step, step, along)
            for (a, b), step, along in zip(
                itertools.pairwise(self._points), steps, self._along[:-1], strict=True
            )
        ]
        self._speeds = self._greatest_speeds()
        self._index = 0

    @property
    def length_m(self) -> float:
        """Length from the beginning to the end."""
        return self._along[-1]

    def along_m(self, state: AircraftState) -> float:
        """Return how far along the path the aircraft is: before it, less than 0."""
        x, y = self._local_frame.to_local((state.latitude_rad, state.longitude_rad))
        nearest = math.inf
        along = 0.0
        first, last = self._index, min(self._index + WINDOW, len(self._legs))
        for index in range(first, last):
            leg = self._legs[index]
            east, north = x - leg.east, y - leg.north
            ahead = east * leg.sin + north * leg.cos
            beyond = ahead if ahead < 0.0 else max(ahead - leg.length, 0.0)
            aside = east * leg.cos - north * leg.sin
            distance = aside * aside + beyond * beyond
            if distance < nearest:
                nearest, self._index = distance, index
                inside = index not in (0, len(self._legs) - 1)
                along = leg.along + (ahead - beyond if inside else ahead)
        return along

    def yaw_rate(self, state: AircraftState, along_m: float) -> float:
        """Return the yaw rate (rad/s) that leads to a point ahead on the path."""
        speed = state.ground_speed_m_s
        reach = max(self._look_ahead, LOOK_AHEAD_S * speed)
        east, north = self._at(along_m + reach)
        here = self._local_frame.to_local((state.latitude_rad, state.longitude_rad))
        bearing = math.atan2(east - here[0], north - here[1])
        distance = max(math.dist(here, (east, north)), 1.0)
        aside = within(wrap_angle(bearing - state.heading_rad), math.pi / 2.0)
        return 2.0 * max(speed, 1.0) * math.sin(aside) / distance

    def speed_m_s(self, along_m: float) -> float:
        """Return the greatest speed at a distance along the path."""
        to_go = self.length_m - along_m
        if to_go <= 0.0:
            return 0.0
        index = min(max(bisect.bisect_right(self._along, along_m), 0), len(self._speeds) - 1)
        ahead = max(self._along[index] - along_m, 0.0)
        slowing = math.sqrt(self._speeds[index] ** 2 + 2.0 * DECELERATION_M_S2 * ahead)
        return min(slowing, self._greatest_m_s)

    def _at(self, along_m: float) -> tuple[float, float]:
        """Return the point at a distance along the path, straight on beyond its end."""
        index = min(max(bisect.bisect_right(self._along, along_m), 1), len(self._points) - 1)
        a, b = self._points[index - 1 : index + 1]
        part = (along_m - self._along[index - 1]) / (self._along[index] - self._along[index - 1])
        return a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part

    def _greatest_speeds(self) -> list[float]:
        """Return the greatest speed at each point, with room to slow down for what follows."""
        speeds = [self._greatest_m_s] * len(self._points)
        for index in range(1, len(self._points) - 1):
            before, here, after = self._points[index - 1 : index + 2]
            turn = wrap_angle(
                math.atan2(after[0] - here[0], after[1] - here[1])
                - math.atan2(here[0] - before[0], here[1] - before[1])
            )
            if abs(turn) > 1e-3:
                radius = max(math.dist(before, after) / 2.0, 2.0) / abs(turn)
                in_turn = max(math.sqrt(LATERAL_ACCELERATION_M_S2 * radius), 2.0)
                speeds[index] = min(self._greatest_m_s, in_turn)
        speeds[-1] = 0.0
        for index in range(len(speeds) - 2, -1, -1):
            step = self._along[index + 1] - self._along[index]
            reachable = math.sqrt(speeds[index + 1] ** 2 + 2.0 * DECELERATION_M_S2 * step)
            speeds[index] = min(speeds[index], reachable)
        return speeds
