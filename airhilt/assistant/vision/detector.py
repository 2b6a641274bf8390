"""What a detector is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from airhilt.errors import VisionError
from airhilt.imaging.boxes import overlap
from airhilt.messages import Box, VisibleClass

Picture = npt.NDArray[np.uint8]
"""8-bit sRGB, shape (rows, columns, 3)."""
GRID_PX = 16
"""Strides of networks divide it: what begins at multiples of it is seen as it is in the whole."""
SAME_OVERLAP = 0.5
"""Boxes that overlap more (intersection over union) are on one body, whatever it is taken for."""


class Found(NamedTuple):
    """Something that a detector has found in a picture."""

    label: VisibleClass
    confidence: float
    box: Box


class PictureMissed(VisionError):
    """A detector has failed to look at one picture, and may succeed with the next."""


class Detector(Protocol):
    """Finds aircraft, vehicles and animals in pictures of any size."""

    @property
    def name(self) -> str:
        """As in ``Detections.engine``."""
        ...

    @property
    def threshold(self) -> float:
        """Confidence from which a finding counts by itself; others only continue tracks."""
        ...

    def detect(self, picture: Picture) -> Sequence[Found]:
        """Return what is in a picture, the surest first.

        Raises
        ------
        PictureMissed
            It has not seen this picture.
        airhilt.errors.VisionError
            It has failed for good.
        """
        ...


def once(found: Sequence[Found]) -> list[Found]:
    """Return each thing once: of boxes on the same, of whatever class, that which comes first."""
    kept: list[Found] = []
    for each in found:
        if not any(overlap(each.box, other.box) > SAME_OVERLAP for other in kept):
            kept.append(each)
    return kept
