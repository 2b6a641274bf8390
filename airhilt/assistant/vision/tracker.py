"""Tracks of things from picture to picture.

As in SORT (Bewley et al., ICIP 2016), each box has a Kalman filter of constant velocity, and what
is expected is assigned to what is found at least cost. As in ByteTrack (Zhang et al., ECCV 2022),
confident findings are assigned first and begin tracks, and doubtful ones only continue them. Time
is that of the exposures, so pictures may be missing. The rotation of a camera with a known attitude
is taken out before things are compared.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment

from airhilt.assistant.vision.detector import Found
from airhilt.imaging.pinhole import Pinhole
from airhilt.messages import CONFIRMED_HITS, Box, CameraView, Detection, VisibleClass
from airhilt.units import SECOND_NS

Array = npt.NDArray[np.float64]

LIFE_S = 1.0
"""Time without a finding, in s, after which a track ends."""
TENTATIVE_LIFE_S = 0.3
"""Likewise for a track that is not confirmed yet."""
LEAST_MISSES = 2
"""Least number of pictures without a finding before a track ends, where pictures are rare."""
GATE = 13.8
"""Largest squared Mahalanobis distance of a place in the picture: 99.9 % of chi-squared with 2
degrees of freedom."""
MOST_SIZE_RATIO = 2.5
SIZE_DEVIATION = math.log(1.4)
"""Largest difference of the logarithms of the found and the expected size."""
OTHER_LABEL = 4.0
"""Cost of another label: as much as two standard deviations in one direction."""
SOON_S = 1e-3
"""Time step for rotating a velocity together with its position, in s."""
NEVER = 1e6


@dataclass
class _Track:
    """One thing: middle and sides of its box in pixels, each with its rate in pixels per second."""

    id: int
    state: Array
    """Values and rates of column, row, width and height; shape (4, 2)."""
    covariance: Array
    """Covariance of each value and its rate; shape (4, 2, 2)."""
    found_ns: int
    hits: int = 1
    misses: int = 0
    labels: dict[VisibleClass, float] = field(default_factory=dict)

    @classmethod
    def begin(cls, id_: int, found: Found, t_ns: int) -> _Track:
        """Return the track of a new thing, which may move fast."""
        measured = _measured(found)
        side = _side(measured)
        place, size = 60.0 + 3.0 * side, 5.0 + 0.5 * side
        covariance = np.zeros((4, 2, 2))
        covariance[:, 0, 0] = _measurement_variance(side)
        covariance[:, 1, 1] = np.square((place, place, size, size))
        state = np.column_stack((measured, np.zeros(4)))
        return cls(id_, state, covariance, t_ns, labels={found.label: found.confidence})

    @property
    def side(self) -> float:
        return _side(self.state[:, 0])

    @property
    def label(self) -> VisibleClass:
        return max(self.labels, key=self.labels.__getitem__)

    def predict(self, dt_s: float) -> None:
        move = np.array(((1.0, dt_s), (0.0, 1.0)))
        # White noise as acceleration (Bar-Shalom et al., 2001, section 6.2.2), in px^2/s^3.
        noise = np.array(((dt_s**3 / 3.0, dt_s**2 / 2.0), (dt_s**2 / 2.0, dt_s)))
        side = self.side
        place, size = 15.0 + side, 5.0 + 0.5 * side
        density = np.square((place, place, size, size))
        self.state = self.state @ move.T
        self.state[2:, 0] = np.maximum(self.state[2:, 0], 1.0)
        self.covariance = move @ self.covariance @ move.T + density[:, None, None] * noise

    def turn(self, turning: Array, view: CameraView) -> bool:
        """Rotate with the camera, and return whether it is still ahead of the camera.

        Its size stays.
        """
        place, rate = self.state[:2].T
        now = _turned(place, turning, view)
        soon = _turned(place + rate * SOON_S, turning, view)
        if now is None or soon is None:
            return False
        self.state[:2] = np.column_stack((now, (soon - now) / SOON_S))
        return True

    def costs(self, found: Sequence[Found]) -> Array:
        """Return the cost of assigning each finding to it; `NEVER` where it cannot be."""
        measured = np.array([_measured(one) for one in found])
        ratio = np.log(np.sqrt(measured[:, 2] * measured[:, 3]) / self.side)
        variance = self.covariance[:2, 0, 0] + _measurement_variance(self.side)[:2]
        distance = np.sum(np.square(measured[:, :2] - self.state[:2, 0]) / variance, axis=1)
        is_other = np.array([one.label != self.label for one in found])
        # The logarithm keeps a vague expectation from being everybody's best one.
        vagueness = float(np.sum(np.log(variance)))
        costs = distance + vagueness + np.square(ratio / SIZE_DEVIATION) + OTHER_LABEL * is_other
        is_possible = (distance <= GATE) & (np.abs(ratio) <= math.log(MOST_SIZE_RATIO))
        return np.where(is_possible, costs, NEVER)

    def update(self, found: Found, t_ns: int) -> None:
        variance = _measurement_variance(self.side)
        gain = self.covariance[:, :, 0] / (self.covariance[:, 0, 0] + variance)[:, None]
        self.state = self.state + gain * (_measured(found) - self.state[:, 0])[:, None]
        self.covariance = self.covariance - gain[:, :, None] * self.covariance[:, None, 0, :]
        self.labels[found.label] = self.labels.get(found.label, 0.0) + found.confidence
        self.found_ns = t_ns
        self.hits += 1
        self.misses = 0

    def is_over(self, t_ns: int, view: CameraView) -> bool:
        column, row = self.state[:2, 0]
        is_out = not (0.0 <= column <= view.width_px and 0.0 <= row <= view.height_px)
        life_s = LIFE_S if self.hits >= CONFIRMED_HITS else TENTATIVE_LIFE_S
        is_old = self.misses >= LEAST_MISSES and t_ns - self.found_ns > life_s * SECOND_NS
        return is_old or (is_out and self.misses > 0)


class Tracker:
    """Follows what one camera sees.

    Parameters
    ----------
    threshold
        Confidence from which a finding begins a track and counts before the track is confirmed.
    """

    def __init__(self, threshold: float = 0.0) -> None:
        self._threshold = threshold
        self._tracks: list[_Track] = []
        self._count = 0
        self._last: tuple[int, CameraView] | None = None

    def expected(self, t_ns: int, view: CameraView) -> list[Box]:
        """Return the boxes of all tracks as they should be in the next picture."""
        self._expect(t_ns, view)
        boxes = []
        for track in self._tracks:
            column, row, width, height = track.state[:, 0].tolist()
            half = width / 2.0, height / 2.0
            boxes.append((column - half[0], row - half[1], column + half[0], row + half[1]))
        return boxes

    def follow(self, t_ns: int, view: CameraView, found: Sequence[Found]) -> list[Detection]:
        """Return the findings in the next picture with their tracks, by falling confidence.

        Each has the label that its track had most, weighted by confidence. Doubtful findings are
        left out unless they continue a confirmed track.
        """
        self._expect(t_ns, view)
        confident = [one for one in found if one.confidence >= self._threshold]
        doubtful = [one for one in found if one.confidence < self._threshold]
        followed: list[tuple[_Track, Found]] = []
        rest = self._assign(self._tracks, confident, followed)
        left = [track for track in self._tracks if all(track is not other for other, _ in followed)]
        self._assign(left, doubtful, followed)
        for track in self._tracks:
            track.misses += 1
        for track, one in followed:
            track.update(one, t_ns)
        for one in rest:
            self._count += 1
            track = _Track.begin(self._count, one, t_ns)
            self._tracks.append(track)
            followed.append((track, one))
        self._tracks = [track for track in self._tracks if not track.is_over(t_ns, view)]
        told = [
            Detection(
                label=track.label,
                confidence=one.confidence,
                box=one.box,
                track_id=track.id,
                hits=track.hits,
            )
            for track, one in followed
            if one.confidence >= self._threshold or track.hits >= CONFIRMED_HITS
        ]
        return sorted(told, key=lambda each: (-each.confidence, each.track_id or 0))

    def _expect(self, t_ns: int, view: CameraView) -> None:
        if self._last is not None:
            last_ns, last_view = self._last
            dt_s = max(t_ns - last_ns, 0) / SECOND_NS
            for track in self._tracks:
                track.predict(dt_s)
            if last_view != view:
                turning = Pinhole(view).axes.T @ Pinhole(last_view).axes
                self._tracks = [track for track in self._tracks if track.turn(turning, view)]
        self._last = (t_ns, view)

    def _assign(
        self,
        tracks: Sequence[_Track],
        found: Sequence[Found],
        followed: list[tuple[_Track, Found]],
    ) -> list[Found]:
        """Add the pairs of least cost to ``followed``, and return the findings in no pair."""
        if not tracks or not found:
            return list(found)
        costs = np.array([track.costs(found) for track in tracks])
        taken: set[int] = set()
        for row, column in zip(*linear_sum_assignment(costs), strict=True):
            if costs[row, column] < NEVER:
                followed.append((tracks[row], found[column]))
                taken.add(int(column))
        return [one for index, one in enumerate(found) if index not in taken]


def _measured(found: Found) -> Array:
    left, top, right, bottom = found.box
    width, height = max(right - left, 1.0), max(bottom - top, 1.0)
    return np.array(((left + right) / 2.0, (top + bottom) / 2.0, width, height))


def _side(box: Array) -> float:
    return math.sqrt(float(box[2] * box[3]))


def _measurement_variance(side: float) -> Array:
    place, size = 0.7 + 0.05 * side, 1.0 + 0.1 * side
    return np.square((place, place, size, size))


def _turned(place: Array, turning: Array, view: CameraView) -> Array | None:
    """Return the place of something far away after a rotation of the camera; None if behind it."""
    lens = Pinhole(view)
    pixel = lens.pixel(*(turning @ lens.direction(*place)))
    return None if pixel is None else np.array(pixel)
