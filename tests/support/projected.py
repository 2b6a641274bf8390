"""Detections of bodies whose true places are known, without drawing a picture."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.imaging.view import Intrinsics, Pose, View
from airhilt.messages import CameraView, Detection, Detections, VisibleClass
from airhilt.sim import Input
from airhilt.units import DEGREE, SECOND_NS

Place = tuple[float, float, float]
"""East, north and up of the ground, in metres."""


@dataclass(frozen=True)
class Body:
    """Something to be seen: a box, its heading, and where the middle of its lower side is."""

    label: VisibleClass
    length_m: float
    span_m: float
    height_m: float
    at: Callable[[float], tuple[Place, float]]
    """Where it is at a time (s), and its heading (rad)."""

    def corners(self, t_s: float) -> np.ndarray:
        place, heading = self.at(t_s)
        pose = Pose.of(place, heading)
        offsets = [
            (across * self.span_m / 2, along * self.length_m / 2, up * self.height_m)
            for across, along, up in itertools.product((-1, 1), (-1, 1), (0, 1))
        ]
        return np.array(pose.position_m) + np.array(offsets) @ pose.rotation.T


def still(label: VisibleClass, place: Place, sizes: tuple[float, float, float]) -> Body:
    return Body(label, *sizes, lambda _: (place, 0.0))


TRUCK = (6.0, 2.5, 2.0)
DEER = (1.9, 0.5, 1.5)
FLOCK = (7.0, 15.0, 2.7)
CESSNA = (8.2, 11.0, 2.7)
AIRLINER = (33.0, 34.0, 12.5)


@dataclass
class Camera:
    """A camera, and a detector that finds what is large enough, not quite where it is.

    ``error_px`` is the standard deviation of each side of a box.
    """

    name: str
    frame: LocalFrame
    look: Callable[[float], tuple[Place, tuple[float, float, float]]]
    """Its place at a time (s), and its heading, pitch and roll (rad)."""
    bodies: list[Body]
    carrier: str | None = None
    fov_deg: float = 45.0
    width_px: int = 640
    height_px: int = 360
    rate_hz: float = 8.0
    error_px: float = 0.7
    confidence: float = 0.9
    smallest_px: float = 8.0
    recall: float = 1.0
    seed: int = 1
    off_after_s: float = float("inf")
    _seq: int = 0
    _hits: dict[int, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._generator = np.random.default_rng((self.seed, *self.name.encode()))

    @property
    def period_ns(self) -> int:
        return round(SECOND_NS / self.rate_hz)

    def view(self, t_s: float) -> CameraView:
        (east, north, up), angles = self.look(t_s)
        latitude, longitude = self.frame.to_place(east, north)
        heading, pitch, roll = (angle / DEGREE for angle in angles)
        return CameraView(
            latitude_deg=latitude / DEGREE, longitude_deg=longitude / DEGREE, height_m=up,
            heading_deg=heading % 360.0 % 360.0, pitch_deg=pitch, roll_deg=roll,
            horizontal_fov_deg=self.fov_deg, width_px=self.width_px, height_px=self.height_px,
            carrier=self.carrier,
        )  # fmt: skip

    def box(self, body: Body, t_s: float) -> Any:
        """Return the true box about a body, cut off at the picture's edges; None if unseen."""
        place, angles = self.look(t_s)
        lens = Intrinsics(self.width_px, self.height_px, self.fov_deg * DEGREE)
        view = View(lens, Pose.of(place, *angles))
        seen = view.in_camera(body.corners(t_s))
        if seen[:, 2].min() < 0.5:
            return None
        pixels = view.pixels(seen)
        low = np.maximum(pixels.min(axis=0), 0.0)
        high = np.minimum(pixels.max(axis=0), (self.width_px, self.height_px))
        if (high <= low).any():
            return None
        return float(low[0]), float(low[1]), float(high[0]), float(high[1])

    def detections(self, t_ns: int) -> Detections:
        found = []
        for number, body in enumerate(self.bodies):
            box = self.box(body, t_ns / SECOND_NS)
            noise = self._generator.normal(0.0, self.error_px, 4)
            missed = self._generator.random() > self.recall
            if box is None or missed or max(box[2] - box[0], box[3] - box[1]) < self.smallest_px:
                continue
            self._hits[number] = self._hits.get(number, 0) + 1
            left, top, right, bottom = (float(side) for side in np.add(box, noise))
            found.append(
                Detection(
                    label=body.label, confidence=self.confidence, track_id=number,
                    hits=self._hits[number],
                    box=(left, top, max(right, left + 0.5), max(bottom, top + 0.5)),
                )
            )  # fmt: skip
        self._seq += 1
        return Detections(
            camera=self.name, seq=self._seq, t_frame_ns=t_ns, view=self.view(t_ns / SECOND_NS),
            detections=tuple(found), engine="test",
        )  # fmt: skip

    def inputs(self, begin_ns: int, end_ns: int) -> list[Input]:
        """Return what it gives from a time on and before another."""
        if begin_ns >= self.off_after_s * SECOND_NS:
            return []
        first = -(-begin_ns // self.period_ns)
        return [
            Input(f"vision/{self.name}", t_ns, self.detections(t_ns).model_dump_json().encode())
            for t_ns in range(first * self.period_ns, end_ns, self.period_ns)
        ]


def standing(place: Place, heading_deg: float, pitch_deg: float = 0.0) -> Callable[..., Any]:
    """Return where a camera looks that never moves."""
    return lambda _: (place, (heading_deg * DEGREE, pitch_deg * DEGREE, 0.0))
