"""Things that a camera in flight shows and that are no aircraft: clouds, and what is on the ground.

What stays in its place moves in the pictures while the camera flies by. What is on a collision
course stays in one direction.
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
"""Largest sizes of a flock and of an aircraft, in m."""
TOLD_SIGMAS = 2.0
"""Standard deviations from which a motion counts as one."""
ALIKE_SIGMAS = 3.0
"""Standard deviations within which two motions count as the same."""
SLACK = 0.25
"""Largest error of the motion of a cloud, as a share of it: its middle is not one place on it. An
assumption."""


def may_stand(track: VisualTrack) -> bool:
    """Return whether something may stand on the ground, by the size that it would have there."""
    last = track.last
    height_m = last.geometry.view.height_m
    depression_rad = -last.geometry.foot(last.box).elevation_rad
    if depression_rad <= 0.0 or height_m <= 0.0:
        return False
    return max(last.size_rad) * height_m / math.sin(depression_rad) <= _largest_m(track)


def _largest_m(track: VisualTrack) -> float:
    return FLOCK_M if track.label == "bird" else AIRLINER_M


def stays_in_place(track: VisualTrack, approach: Approach) -> bool:
    """Return whether something moves and grows as what is larger than an aircraft and stays.

    The direction to what stays in its place turns away from the camera's course, the slower the
    farther it is. So the turning tells its distance, and the size in the picture its own.
    """
    observations, last = track.observations, track.last
    speeds = _across_and_along_m_s(observations)
    across_m_s = math.hypot(*speeds[:2])
    error = approach.turning_error
    if across_m_s <= 0.0:
        return False
    away = (-speeds[0] / across_m_s, -speeds[1] / across_m_s)
    turning = approach.turning_rad_s
    outward = turning[0] * away[0] + turning[1] * away[1]
    sideward = turning[0] * away[1] - turning[1] * away[0]
    if outward <= TOLD_SIGMAS * error or abs(sideward) > ALIKE_SIGMAS * error + SLACK * outward:
        return False
    fastest = speeds[2] / across_m_s * outward
    if approach.closing > ALIKE_SIGMAS * approach.closing_error + (1.0 + SLACK) * fastest:
        return False
    nearest_m = across_m_s / (outward + TOLD_SIGMAS * error)
    return max(last.size_rad) * nearest_m > _largest_m(track)


def _across_and_along_m_s(observations: Sequence[Observation]) -> tuple[float, float, float]:
    """Return the speeds of a camera to the right of a line of sight, above it and along it."""
    first, last = observations[0], observations[-1]
    seconds = (last.t_ns - first.t_ns) / SECOND_NS
    if seconds <= 0.0:
        return 0.0, 0.0, 0.0
    moved = _moved_m(first.geometry.view, last.geometry.view)
    right, up = _across(last.ray)
    to_right, upward, along = (
        sum(a * b for a, b in zip(moved, axis, strict=True)) / seconds
        for axis in (right, up, last.ray)
    )
    return to_right, upward, along


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
