"""Whether something in the air that grows in the picture comes towards the camera, and when.

An object that is not going to pass by stays in the same direction and grows. The reciprocal of
its size falls in proportion to the distance: evenly, to 0 at the encounter, while both fly
straight on. Neither its size nor its distance need be known (D. N. Lee, A theory of visual control
of braking based on information about time-to-collision, Perception 5 (1976) 437-459).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from airhilt.assistant.decision.visual_tracks import Observation
from airhilt.units import SECOND_NS

LEAST_SPAN_NS = round(0.75 * SECOND_NS)
LEAST_GLIMPSES = 5
"""A shorter or sparser series tells nothing."""
SIDE_ERROR_PX = 0.4
"""A detector errs at least so much in a side of a box (standard deviation)."""
CORRELATION_S = 0.2
"""Pictures nearer in time than this err alike."""
SHOWN_S, SHOWN_QUANTILE, SHOWN_PART = 1.0, 0.8, 0.75
"""Wings thinner than a pixel show in some pictures and not in others, as they pass from one row of
pixels to the next. Sizes count that are not much below the larger ones within so long."""
OUTLIER_SIGMAS = 3.0
MAD_PER_SIGMA = 0.6745
"""Median absolute deviation of a normal distribution."""

Floats = npt.NDArray[np.float64]


class Approach(NamedTuple):
    """How something nears a camera; as of the last picture.

    Attributes
    ----------
    closing
        The reciprocal of the time to contact (1/s); negative if it recedes.
    closing_error, turning_error
        Standard deviations.
    turning_rad_s
        How fast its direction turns, whatever way the camera turns: to the right, and up.
    size_rad
        The larger side of its box.
    """

    closing: float
    closing_error: float
    turning_rad_s: tuple[float, float]
    turning_error: float
    size_rad: float

    @property
    def time_s(self) -> float:
        """Until contact; infinite if it does not come nearer."""
        return 1.0 / self.closing if self.closing > 0.0 else math.inf

    @property
    def is_growing(self) -> bool:
        """Whether it surely comes nearer."""
        return self.closing > 2.0 * self.closing_error

    def least_miss(self) -> float:
        """Return how far it passes at least, by the errors, in units of its own size."""
        turning = math.hypot(*self.turning_rad_s) - 2.0 * self.turning_error
        return max(turning, 0.0) * self.time_s / self.size_rad

    def passes_above(self) -> float:
        """Return how far above it passes, in units of its own size; negative below."""
        return self.turning_rad_s[1] * self.time_s / self.size_rad


def approach_of(observations: Sequence[Observation]) -> Approach | None:
    """Return how something nears the camera; None while it cannot be told.

    Glimpses in which it may go on beyond the picture's edge tell nothing of its size.
    """
    whole = [observation for observation in observations if observation.is_whole]
    if len(whole) < LEAST_GLIMPSES or whole[-1].t_ns - whole[0].t_ns < LEAST_SPAN_NS:
        return None
    last = whole[-1]
    times = np.array([(observation.t_ns - last.t_ns) / SECOND_NS for observation in whole])
    sizes = np.array([observation.size_rad for observation in whole])
    # The diagonal changes least while the camera rolls.
    diagonals = np.hypot(sizes[:, 0], sizes[:, 1])
    side_rad = SIDE_ERROR_PX / last.eye.focal_px
    shown = _is_shown(times, diagonals)
    size_error = math.sqrt(2.0) * side_rad / diagonals[shown] ** 2
    growth = _line(times[shown], 1.0 / diagonals[shown], size_error)
    offsets = np.array([last.ray.offset_to(observation.ray) for observation in whole])
    aim_error = np.full_like(times, side_rad / math.sqrt(2.0))
    turns = [_line(times, axis, aim_error) for axis in offsets.T]
    now = max(growth.now, 1e-9)
    return Approach(
        closing=-growth.slope / now,
        closing_error=growth.slope_error / now,
        turning_rad_s=(turns[0].slope, turns[1].slope),
        turning_error=math.hypot(*(turn.slope_error for turn in turns)),
        size_rad=float(np.median(sizes[-LEAST_GLIMPSES:].max(axis=1))),
    )


def _is_shown(times: Floats, diagonals: Floats) -> npt.NDArray[np.bool_]:
    """Return in which pictures all of something shows; all, if that is in too few."""
    near = np.abs(times[:, None] - times) <= SHOWN_S
    falling = -np.sort(np.where(near, -diagonals, np.inf), axis=1)
    place = ((1.0 - SHOWN_QUANTILE) * (near.sum(axis=1) - 1)).astype(int)
    larger = np.take_along_axis(falling, place[:, None], axis=1)[:, 0]
    shown = diagonals >= SHOWN_PART * larger
    return np.asarray(shown if shown.sum() >= LEAST_GLIMPSES else np.ones_like(shown))


class _Line(NamedTuple):
    now: float
    """Its value at time 0."""
    slope: float
    slope_error: float


def _line(times: Floats, values: Floats, errors: Floats) -> _Line:
    """Fit a straight line to values of known least errors, twice: the second time less outliers.

    The error of the slope is by the scatter that is found, and as if pictures within the time of
    correlation were one.
    """
    kept = np.ones_like(times, dtype=bool)
    now = slope = scatter = 0.0
    for _ in range(2):
        weights = 1.0 / errors[kept]
        design = np.column_stack((np.ones(kept.sum()), times[kept])) * weights[:, None]
        (now, slope), *_ = np.linalg.lstsq(design, values[kept] * weights, rcond=None)
        misfit = np.abs(values - now - slope * times) / errors
        scatter = max(float(np.median(misfit[kept])) / MAD_PER_SIGMA, 1.0)
        kept = misfit <= OUTLIER_SIGMAS * scatter
    t, w = times[kept], 1.0 / errors[kept] ** 2
    middle = np.average(t, weights=w)
    spread = float(np.sum(w * (t - middle) ** 2))
    span_s = float(t.max() - t.min())
    alike = max(len(t) * CORRELATION_S / max(span_s, CORRELATION_S), 1.0)
    slope_error = scatter * math.sqrt(alike / spread) if spread > 0.0 else math.inf
    return _Line(float(now), float(slope), slope_error)
