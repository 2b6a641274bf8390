"""Things below the horizon that a camera in flight shows: on the ground, or in the air.

What stands on the ground moves in the pictures as its place does while the camera flies by. What is
on a collision course stays in one direction.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from airhilt.assistant.decision.approach import Approach
from airhilt.assistant.decision.line_of_sight import Ray
from airhilt.assistant.decision.visual_tracks import Observation, VisualTrack
from airhilt.geodesy.wgs84 import offset_m
from airhilt.messages import CameraView
from airhilt.units import DEGREE, SECOND_NS

FLOCK_M = 20.0
AIRLINER_M = 80.0
"""Largest sizes of a flock and of an aircraft, in m.

What is no larger where its line of sight meets the ground may stand there."""
TOLD_APART_SIGMAS = 2.0
"""Least ratio of the motion of a place on the ground to the error of the motion that was seen.

Below it the two cannot be told apart from standing still in the picture."""
ALIKE_SIGMAS = 3.0
RELIEF = 0.25
"""Largest error of the expected motion, as a share of it: the ground is not flat, and fields and
woods reach nearer and farther than their middle. An assumption."""


def may_stand(track: VisualTrack) -> bool:
    """Return whether something may stand on the ground, by the size that it would have there."""
    distance_m = _ground_distance_m(track.last)
    if distance_m is None:
        return False
    largest_m = FLOCK_M if track.label == "bird" else AIRLINER_M
    return max(track.last.size_rad) * distance_m <= largest_m


def moves_with_ground(track: VisualTrack, approach: Approach) -> bool:
    """Return whether its direction turns as that to a place on the ground, whatever its size.

    A field or a wood is larger than any aircraft. It is told from what stays in one direction only
    where the errors allow it.
    """
    expected = _turning_of_ground(track.observations)
    if expected is None:
        return False
    amount, seen = math.hypot(*expected), approach.turning_rad_s
    apart = math.dist(expected, seen)
    return (
        amount > TOLD_APART_SIGMAS * approach.turning_error
        and apart <= ALIKE_SIGMAS * approach.turning_error + RELIEF * amount
        and apart < math.hypot(*seen)
    )


def _ground_distance_m(observation: Observation) -> float | None:
    """Return the distance at which the lower side of a box meets flat ground; None if nowhere."""
    height_m = observation.geometry.view.height_m
    depression_rad = -observation.geometry.foot(observation.box).elevation_rad
    if depression_rad <= 0.0 or height_m <= 0.0:
        return None
    return height_m / math.sin(depression_rad)


def _turning_of_ground(observations: Sequence[Observation]) -> tuple[float, float] | None:
    """Return the rates at which the direction to a place on the ground turns, in rad/s.

    They are to the right and up. The place is where the line of sight meets flat ground; None if it
    does not.
    """
    last = observations[-1]
    ray, height_m = last.ray, last.geometry.view.height_m
    seconds = (last.t_ns - observations[0].t_ns) / SECOND_NS
    if ray.up >= 0.0 or height_m <= 0.0 or seconds <= 0.0:
        return None
    distance_m = height_m / -ray.up
    moved = _moved_m(observations[0].geometry.view, last.geometry.view)
    right, up = _across(ray)
    rate = -1.0 / (distance_m * seconds)
    return (
        rate * sum(a * b for a, b in zip(moved, right, strict=True)),
        rate * sum(a * b for a, b in zip(moved, up, strict=True)),
    )


def _moved_m(before: CameraView, now: CameraView) -> tuple[float, float, float]:
    """Return the movement of a camera to the east, to the north and up, in m."""
    north_m, east_m = offset_m(
        (before.latitude_deg * DEGREE, before.longitude_deg * DEGREE),
        (now.latitude_deg * DEGREE, now.longitude_deg * DEGREE),
    )
    return east_m, north_m, now.height_m - before.height_m


def _across(ray: Ray) -> tuple[Ray, Ray]:
    """Return the directions to the right of a line of sight and above it."""
    azimuth, elevation = ray.azimuth_rad, ray.elevation_rad
    right = Ray(math.cos(azimuth), -math.sin(azimuth), 0.0)
    up = Ray(
        -math.sin(elevation) * math.sin(azimuth),
        -math.sin(elevation) * math.cos(azimuth),
        math.cos(elevation),
    )
    return right, up
