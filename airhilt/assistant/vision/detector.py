"""The protocol of detectors."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from airhilt.errors import VisionError
from airhilt.imaging.boxes import overlap
from airhilt.imaging.masks import Mask
from airhilt.messages import Box, CameraView, VisibleClass

Picture = npt.NDArray[np.uint8]
"""A picture in 8-bit sRGB, shape (rows, columns, 3)."""
GRID_PX = 16
"""Grid of parts of a picture, in pixels: a multiple of the strides of networks, so that a network
sees a part as it sees the whole."""
SAME_OVERLAP = 0.5
"""Intersection over union above which two boxes are on one body, whatever their classes."""


class Found(NamedTuple):
    """One finding of a detector in a picture."""

    label: VisibleClass
    confidence: float
    box: Box


class Shot(NamedTuple):
    """Origin of a picture that a detector is given."""

    camera: str
    """Name of the camera."""
    t_frame_ns: int
    """End of the exposure."""
    left: int = 0
    """Left edge of the picture in that of the camera, in pixels: not 0 for a tile."""
    top: int = 0
    own_aircraft: Mask | None = None
    """Mask of the pixels that the camera's own aircraft may cover; None if there are none."""
    view: CameraView | None = None
    """Pose and lens of the camera; None if they are not known."""


class PictureMissed(VisionError):
    """A detector has failed with one picture, and may succeed with the next."""

    is_passing = True


@runtime_checkable
class Detector(Protocol):
    """Finds aircraft, vehicles and animals in pictures of any size."""

    @property
    def name(self) -> str:
        """Name in ``Detections.engine``."""

    @property
    def threshold(self) -> float:
        """Confidence from which a finding counts by itself; others only continue tracks."""

    def detect(self, picture: Picture) -> Sequence[Found]:
        """Return what is in a picture, by falling confidence.

        Raises
        ------
        airhilt.errors.VisionError
            The detector has failed for good, or with this picture if the error `is_passing`.
        """


@runtime_checkable
class DetectsShots(Protocol):
    """Part that a detector may have besides: it is told where a picture comes from."""

    def detect_shot(self, picture: Picture, shot: Shot) -> Sequence[Found]:
        """Return what is in a picture; it raises what `Detector.detect` does."""


def once(found: Sequence[Found]) -> list[Found]:
    """Return each thing once: of boxes on one body, whatever their classes, the first."""
    kept: list[Found] = []
    for each in found:
        if not any(overlap(each.box, other.box) > SAME_OVERLAP for other in kept):
            kept.append(each)
    return kept
