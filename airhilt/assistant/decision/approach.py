"""Time to contact of something in the air, from its growth in the pictures of one camera.

An object on a collision course stays in the same direction and grows. The reciprocal of its size
falls in proportion to the distance: evenly, to 0 at the encounter, while both fly straight on.
Neither its size nor its distance need be known (D. N. Lee, A theory of visual control of braking
based on information about time-to-collision, Perception 5 (1976) 437-459).

What stays in its place, a cloud or what is on the ground, moves in the pictures while the camera
flies by.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from airhilt.assistant.decision.line_of_sight import Ray
from airhilt.assistant.decision.visual_tracks import Observation, VisualTrack
from airhilt.geodesy.wgs84 import offset_m
from airhilt.units import DEGREE, SECOND_NS

LEAST_SPAN_NS = round(0.75 * SECOND_NS)
LEAST_OBSERVATIONS = 5
"""Least number of observations of a series; fewer tell nothing."""
SIDE_ERROR_PX = 0.4
"""Least standard deviation of a side of a box, in pixels."""
LASTING_ERROR_PX = 2.0
"""Standard deviation of the diagonal of a box for seconds on end, in pixels.

How much shows of what is thinner than a pixel depends on where it lies on the raster, which changes
slowly where the direction stays. Of boxes under 12 px the embedded detector drew 0.6 to 1.6 of the
true size for 5 s and more.
"""
CORRELATION_S = 0.2
"""Least time within which the errors of pictures are alike, in s."""
MOST_CORRELATION = 0.95
"""Largest autocorrelation of the errors of successive pictures that is believed."""
SHOWN_S, SHOWN_QUANTILE, SHOWN_PART = 1.0, 0.8, 0.75
"""Sizes count that reach this part of this quantile of all sizes within this time in s.

Wings thinner than a pixel show in some pictures and not in others, as they pass from one row of
pixels to the next."""
OUTLIER_SIGMAS = 3.0
MAD_PER_SIGMA = 0.6745
"""Median absolute deviation of a normal distribution, in standard deviations."""
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

Floats = npt.NDArray[np.float64]


class Approach(NamedTuple):
    """Motion of something towards a camera, as of the last picture."""

    closing: float
    """Reciprocal of the time to contact, in 1/s; negative if it recedes."""
    closing_error: float
    """Standard deviation of ``closing``, by what differs from picture to picture."""
    lasting_error: float
    """Standard deviation of ``closing`` by errors of the size that last, in 1/s."""
    turning_rad_s: tuple[float, float]
    """Rates at which its direction turns to the right and up, whatever way the camera turns."""
    turning_error: float
    size_rad: float
    """Larger side of its box."""

    @property
    def time_s(self) -> float:
        """Time until contact, in s; infinite if it does not come nearer."""
        return 1.0 / self.closing if self.closing > 0.0 else math.inf

    @property
    def longest_s(self) -> float:
        """Longest time until contact, by two standard deviations, in s; infinite if unknown."""
        slowest = self.closing - 2.0 * math.hypot(self.closing_error, self.lasting_error)
        return 1.0 / slowest if slowest > 0.0 else math.inf

    @property
    def is_growing(self) -> bool:
        """True if it comes nearer by more than two standard deviations, pictures being unlike.

        Errors that last do not count here, but in `longest_s`: to wait until they cannot explain
        the growth would be too late, and to go back too early is worse than to keep clear in vain.
        """
        return self.closing > 2.0 * self.closing_error

    def least_miss(self) -> float:
        """Return the least distance at which it passes, by the errors, in units of its size."""
        turning = math.hypot(*self.turning_rad_s) - 2.0 * self.turning_error
        return max(turning, 0.0) * self.time_s / self.size_rad

    def passes_above(self) -> float:
        """Return the height above the camera at which it passes, in units of its size."""
        return self.turning_rad_s[1] * self.time_s / self.size_rad


def approach_of(observations: Sequence[Observation]) -> Approach | None:
    """Return the motion of something towards the camera; None while it cannot be told.

    Observations that touch the edge of the picture are left out: they do not show its whole size.
    """
    whole = [observation for observation in observations if observation.is_whole]
    if len(whole) < LEAST_OBSERVATIONS or whole[-1].t_ns - whole[0].t_ns < LEAST_SPAN_NS:
        return None
    last = whole[-1]
    times = np.array([(observation.t_ns - last.t_ns) / SECOND_NS for observation in whole])
    sizes = np.array([observation.size_rad for observation in whole])
    # The diagonal changes least while the camera rolls.
    diagonals = np.hypot(sizes[:, 0], sizes[:, 1])
    side_rad = SIDE_ERROR_PX / last.geometry.focal_px
    shown = _is_shown(times, diagonals)
    size_error = math.sqrt(2.0) * side_rad / diagonals[shown] ** 2
    growth = _line(times[shown], 1.0 / diagonals[shown], size_error)
    offsets = np.array([last.ray.offset_to(observation.ray) for observation in whole])
    aim_error = np.full_like(times, side_rad / math.sqrt(2.0))
    turns = [_line(times, axis, aim_error) for axis in offsets.T]
    now, span_s = max(growth.now, 1e-9), (last.t_ns - whole[0].t_ns) / SECOND_NS
    first = max(growth.now - growth.slope * span_s, 1e-9)
    lasting_rad = LASTING_ERROR_PX / last.geometry.focal_px
    return Approach(
        closing=-growth.slope / now,
        closing_error=growth.slope_error / now,
        # As if the sizes of the first and of the last picture erred by it independently.
        lasting_error=lasting_rad * math.hypot(first * first, now * now) / (now * span_s),
        turning_rad_s=(turns[0].slope, turns[1].slope),
        turning_error=math.hypot(*(turn.slope_error for turn in turns)),
        size_rad=float(np.median(sizes[-LEAST_OBSERVATIONS:].max(axis=1))),
    )


def _is_shown(times: Floats, diagonals: Floats) -> npt.NDArray[np.bool_]:
    """Return the pictures that show all of something; all pictures if those are too few."""
    near = np.abs(times[:, None] - times) <= SHOWN_S
    falling = -np.sort(np.where(near, -diagonals, np.inf), axis=1)
    place = ((1.0 - SHOWN_QUANTILE) * (near.sum(axis=1) - 1)).astype(int)
    larger = np.take_along_axis(falling, place[:, None], axis=1)[:, 0]
    shown = diagonals >= SHOWN_PART * larger
    return np.asarray(shown if shown.sum() >= LEAST_OBSERVATIONS else np.ones_like(shown))


class _Line(NamedTuple):
    now: float
    """Value at time 0."""
    slope: float
    slope_error: float


def _line(times: Floats, values: Floats, errors: Floats) -> _Line:
    """Fit a straight line to values of known least errors, the second time without outliers.

    The error of the slope comes from the scatter, with the pictures of one correlation time counted
    as one, and with as many as one as their errors show to be alike.
    """
    kept = np.ones_like(times, dtype=bool)
    now = slope = scatter = 0.0
    for _ in range(2):
        weights = 1.0 / errors[kept]
        design = np.column_stack((np.ones(kept.sum()), times[kept])) * weights[:, None]
        (now, slope), *_ = np.linalg.lstsq(design, values[kept] * weights, rcond=None)
        misfit = (values - now - slope * times) / errors
        scatter = float(np.median(np.abs(misfit[kept]))) / MAD_PER_SIGMA
        kept = np.abs(misfit) <= OUTLIER_SIGMAS * max(scatter, 1.0)
    t, w = times[kept], 1.0 / errors[kept] ** 2
    middle = np.average(t, weights=w)
    spread = float(np.sum(w * (t - middle) ** 2))
    span_s = float(t.max() - t.min())
    alike = max(len(t) * CORRELATION_S / max(span_s, CORRELATION_S), 1.0)
    variance = max(max(scatter, 1.0) ** 2 * alike, scatter**2 * _variance_ratio(misfit[kept]))
    slope_error = math.sqrt(variance / spread) if spread > 0.0 else math.inf
    return _Line(float(now), float(slope), slope_error)


def _variance_ratio(misfit: Floats) -> float:
    """Return the factor by which errors that last raise the variance of a slope, 1 if none do.

    It is (1 + r) / (1 - r) for errors whose autocorrelation at one step is r and falls
    exponentially (Bayley and Hammersley, The "effective" number of independent observations in an
    autocorrelated time series, J. R. Stat. Soc. Suppl. 8 (1946) 184-197).
    """
    squares = float(np.sum(misfit * misfit))
    if squares <= 0.0:
        return 1.0
    r = min(max(float(np.sum(misfit[1:] * misfit[:-1])) / squares, 0.0), MOST_CORRELATION)
    return (1.0 + r) / (1.0 - r)


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
    before, now = first.geometry.view, last.geometry.view
    north_m, east_m = offset_m(
        (before.latitude_deg * DEGREE, before.longitude_deg * DEGREE),
        (now.latitude_deg * DEGREE, now.longitude_deg * DEGREE),
    )
    moved = east_m, north_m, now.height_m - before.height_m
    azimuth, elevation = last.ray.azimuth_rad, last.ray.elevation_rad
    right = Ray(math.cos(azimuth), -math.sin(azimuth), 0.0)
    up = Ray(
        -math.sin(elevation) * math.sin(azimuth),
        -math.sin(elevation) * math.cos(azimuth),
        math.cos(elevation),
    )
    to_right, upward, along = (
        sum(a * b for a, b in zip(moved, axis, strict=True)) / seconds
        for axis in (right, up, last.ray)
    )
    return to_right, upward, along
