"""Pictures with coloured blobs, and a detector that finds them."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from scipy import ndimage

from airhilt.assistant.vision.detector import Found, Picture
from airhilt.messages import Box, CameraFrame, CameraInfo, CameraView, VisibleClass
from airhilt.sim import Input

COLOURS: dict[VisibleClass, tuple[int, int, int]] = {
    "airplane": (255, 0, 0),
    "truck": (0, 255, 0),
    "bird": (0, 0, 255),
}
PERIOD_NS = 62_500_000
"""Period of a camera at 16 Hz."""

Blob = tuple[VisibleClass, tuple[int, int, int, int]]
"""A class, and left, top, right and bottom."""


def camera_view(columns: int = 640, rows: int = 360, **changes: Any) -> CameraView:
    """Return a view to the north, level."""
    numbers = {
        "latitude_deg": 47.0,
        "longitude_deg": 8.0,
        "height_m": 20.0,
        "heading_deg": 0.0,
        "pitch_deg": 0.0,
        "roll_deg": 0.0,
        "horizontal_fov_deg": 60.0,
        "width_px": columns,
        "height_px": rows,
    }
    return CameraView.model_validate(numbers | changes)


def background(columns: int = 640, rows: int = 360, seed: int = 0) -> Picture:
    """Return a grey picture with a texture."""
    rng = np.random.default_rng(seed)
    grey = rng.integers(90, 130, size=(rows, columns, 1), dtype=np.uint8)
    return np.repeat(grey, 3, axis=2)


def with_blobs(picture: Picture, blobs: Iterable[Blob]) -> Picture:
    """Return a picture with rectangles in the colours of their classes."""
    painted = picture.copy()
    for label, (left, top, right, bottom) in blobs:
        painted[max(top, 0) : max(bottom, 0), max(left, 0) : max(right, 0)] = COLOURS[label]
    return painted


class BlobDetector:
    """Finds blobs; how sure it is depends on what is up to `REACH_PX` around them."""

    name = "blobs"
    threshold = 0.0
    REACH_PX = 24

    def __init__(self) -> None:
        self.asked: list[tuple[int, int]] = []

    @property
    def pixels(self) -> int:
        """In all that it has looked at."""
        return sum(rows * columns for rows, columns in self.asked)

    def detect(self, picture: Picture) -> Sequence[Found]:
        self.asked.append(picture.shape[:2])
        found = []
        for label, colour in COLOURS.items():
            labels, _ = ndimage.label((picture == np.array(colour, np.uint8)).all(axis=2))
            for rows, columns in ndimage.find_objects(labels):
                around = picture[
                    max(rows.start - self.REACH_PX, 0) : rows.stop + self.REACH_PX,
                    max(columns.start - self.REACH_PX, 0) : columns.stop + self.REACH_PX,
                ]
                box = (columns.start, rows.start, columns.stop, rows.stop)
                found.append(
                    Found(
                        label, 0.5 + float(around.mean()) / 600.0, (box[0], box[1], box[2], box[3])
                    )
                )
        return sorted(found, key=lambda one: (-one.confidence, one.box))


class Told:
    """A detector that finds what it is told to, picture by picture, the last again and again."""

    name = "told"
    threshold = 0.0

    def __init__(self, *pictures: Sequence[Found]) -> None:
        self._pictures = list(pictures)

    def detect(self, picture: Picture) -> Sequence[Found]:
        return self._pictures.pop(0) if len(self._pictures) > 1 else self._pictures[0]


def a(
    label: VisibleClass, column: float, row: float, side: float, confidence: float = 0.9
) -> Found:
    """Return a square finding about a place."""
    half = side / 2.0
    box: Box = (column - half, row - half, column + half, row + half)
    return Found(label, confidence, box)


def info(camera: str = "tower", **changes: Any) -> Input:
    """Return what never changes about a camera, as a worker gets it."""
    numbers = {
        "camera": camera,
        "rate_hz": 16.0,
        "width_px": 640,
        "height_px": 360,
        "horizontal_fov_deg": 60.0,
    }
    payload = CameraInfo.model_validate(numbers | changes).model_dump_json().encode()
    return Input(f"camera/{camera}/info", 0, payload)


def frame(picture: Picture, seq: int = 0, camera: str = "tower", **changes: Any) -> Input:
    """Return a picture as a worker gets it."""
    rows, columns = picture.shape[:2]
    pixels = picture.tobytes()
    header = CameraFrame(
        camera=camera,
        seq=seq,
        t_frame_ns=seq * PERIOD_NS,
        view=camera_view(columns, rows),
        sha256=hashlib.sha256(pixels).hexdigest(),
    )
    attachment = header.model_dump(mode="json") | changes
    return Input(f"camera/{camera}/frame", seq * PERIOD_NS, pixels, attachment)
