"""The second network of a detector: it refines what the first one proposes.

The first network looks at a whole picture and proposes almost every place where something is, and
many where nothing is. The refiner looks at these places alone, in a near view that suits the size
and in a wide one, as a cascade does (P. Viola and M. Jones, CVPR 2001). It gives the class of a
body, if there is one, and its box.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
import numpy.typing as npt
from pydantic import BaseModel, ConfigDict, Field

from airhilt.assistant.vision.detector import Found, Picture
from airhilt.errors import VisionError, first_line
from airhilt.host.onnx import open_network, require_end
from airhilt.imaging.boxes import centre, sides, size_px
from airhilt.messages import Box, Confidence, VisibleClass

EXPECTED = (
    "a network of tools/detector/train_refiner.py: 'views', uint8 [n, 2, 40, 40, 3], and 'about', "
    "float [n, 3], to 'chances', float [n, 1 + classes], and 'moves', float [n, 4]"
)
USUAL_PIXELS = 640 * 360
VIEW_PX = 40
"""Rows and columns of a view, in pixels."""
NEAR, LEAST_NEAR_PX = 1.7, 20.0
"""Width of a near view: in longest sides of the box, and at least in pixels."""
WIDE, LEAST_WIDE_PX = 5.0, 96.0
REFERENCE_PX = 32.0
LEAST_CHANCE = 1e-3
PARTS = np.uint16(128)
"""Unit of the weights between two pixels."""

Views = npt.NDArray[np.uint8]
Floats = npt.NDArray[np.float32]


class RefinerCard(BaseModel):
    """The part of ``card.json`` about the refiner."""

    model_config = ConfigDict(extra="ignore", frozen=True, allow_inf_nan=False)
    file: Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]+\.onnx$")]
    """Name of the network's file in the folder of the card."""
    least_score: Confidence
    """Least score of the first network with which a place is looked at."""
    most: Annotated[int, Field(ge=1, le=100)]
    """Largest number of places in a picture of `USUAL_PIXELS`; in proportion in larger ones."""


class Refiner:
    """Looks at places in a picture.

    Parameters
    ----------
    folder
        Folder of the card.
    classes
        Classes in the order of the network's probabilities.

    Raises
    ------
    VisionError
        The file is missing, or is not what it must be.
    """

    def __init__(
        self,
        card: RefinerCard,
        folder: Path,
        classes: Sequence[VisibleClass],
        threads: int = 1,
    ) -> None:
        path = folder / card.file
        self._card, self._classes = card, classes
        self._subject = f"refiner {path}, which the card beside it names"
        self._network = open_network(path, self._subject, EXPECTED, VisionError, threads)
        both = (*self._network.get_inputs(), *self._network.get_outputs())
        expected = {
            "views": ("tensor(uint8)", [2, VIEW_PX, VIEW_PX, 3]),
            "about": ("tensor(float)", [3]),
            "chances": ("tensor(float)", [1 + len(classes)]),
            "moves": ("tensor(float)", [4]),
        }
        if {each.name: (each.type, each.shape[1:]) for each in both} != expected:
            told = ", ".join(f"{each.name!r} {each.type} {each.shape}" for each in both)
            raise VisionError(
                f"{self._subject} has {told}; expected {EXPECTED}, and {len(classes)} classes"
            )
        views = np.zeros((1, 2, VIEW_PX, VIEW_PX, 3), np.uint8)
        inputs = {"views": views, "about": np.zeros((1, 3), np.float32)}
        require_end(self._network, inputs, self._subject, VisionError)

    def places(self, found: Sequence[Found], pixels: int) -> list[Found]:
        """Return the findings that are looked at in a picture of so many pixels."""
        most = math.ceil(self._card.most * max(pixels / USUAL_PIXELS, 1.0))
        return [each for each in found if each.confidence >= self._card.least_score][:most]

    def judge(self, picture: Picture, places: Sequence[Found]) -> list[Found]:
        """Return the likeliest class at each place, and its probability, in the order of places.

        Boxes may reach beyond the picture.
        """
        if not places:
            return []
        boxes, scores = [each.box for each in places], [each.confidence for each in places]
        inputs = {"views": views_of(picture, boxes), "about": about(boxes, scores)}
        try:
            chances, moves = self._network.run(["chances", "moves"], inputs)
        except Exception as error:  # onnxruntime raises classes of its own that share no base
            raise VisionError(f"{self._subject} has failed: {first_line(error)}") from None
        of_class = chances[:, 1:]
        return [
            Found(self._classes[label], float(each[label]), refined(box, move))
            for each, label, box, move in zip(
                of_class, of_class.argmax(axis=1).tolist(), boxes, moves, strict=True
            )
        ]


def about(boxes: Sequence[Box], scores: Sequence[float]) -> Floats:
    """Return score and shape of places, shape (n, 3).

    They are the logit of the first score, the binary logarithm of the longest side over
    `REFERENCE_PX`, and that of the width over the height.
    """
    rows = []
    for box, score in zip(boxes, scores, strict=True):
        chance = min(max(score, LEAST_CHANCE), 1.0 - LEAST_CHANCE)
        width, height = sides(box)
        rows.append(
            (
                math.log(chance / (1.0 - chance)),
                math.log2(max(width, height) / REFERENCE_PX),
                math.log2(width / height),
            )
        )
    return np.array(rows, dtype=np.float32).reshape(-1, 3)


def refined(box: Box, moves: npt.NDArray[np.floating]) -> Box:
    """Return a box as the refiner moves it.

    The middle goes right and down by parts of the longest side, and width and height are
    multiplied by what the other two are the logarithms of.
    """
    (column, row), longest = centre(box), max(size_px(box), 1.0)
    right, down, wider, higher = (float(move) for move in moves)
    column += longest * min(max(right, -1.0), 1.0)
    row += longest * min(max(down, -1.0), 1.0)
    width, height = (
        side * math.exp(min(max(change, -1.5), 1.5)) / 2.0
        for side, change in zip(sides(box), (wider, higher), strict=True)
    )
    return column - width, row - height, column + width, row + height


def views_of(picture: Picture, boxes: Sequence[Box]) -> Views:
    """Return a near and a wide view of each place, shape (n, 2, `VIEW_PX`, `VIEW_PX`, 3).

    Beyond the picture, its edges are repeated.
    """
    middles = np.array([centre(box) for box in boxes], dtype=np.float64).reshape(-1, 1, 2)
    longest = np.array([size_px(box) for box in boxes], dtype=np.float64)[:, None]
    side = np.maximum(longest * (NEAR, WIDE), (LEAST_NEAR_PX, LEAST_WIDE_PX))
    (columns, across), (rows, down) = (
        _taps(middles[..., axis] - side / 2.0, side, picture.shape[1 - axis]) for axis in (0, 1)
    )
    pixels = np.ascontiguousarray(picture).reshape(-1, 3)
    cut = pixels.take(rows[..., :, None] * picture.shape[1] + columns[..., None, :], axis=0)
    # In whole parts of `PARTS`, which 16 bits hold.
    down, across = down[..., None, None], across[:, :, None, :, None]
    tall = (cut[:, :, ::2] * (PARTS - down) + cut[:, :, 1::2] * down) // PARTS
    seen = tall[:, :, :, ::2] * (PARTS - across) + tall[:, :, :, 1::2] * across
    return np.asarray((seen + PARTS // 2) // PARTS, dtype=np.uint8)


def _taps(
    start: npt.NDArray[np.float64], side: npt.NDArray[np.float64], size: int
) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.uint16]]:
    """Return two places along an axis for each pixel of views, and the weight of the second.

    The weight is by the distance; where a pixel of the view covers several, two stand for all.
    """
    step = (side / VIEW_PX)[..., None]
    middle = start[..., None] + (np.arange(VIEW_PX) + 0.5) * step
    first = np.floor(np.where(step > 1.0, middle - step / 4.0, middle - 0.5))
    second = np.where(step > 1.0, np.floor(middle + step / 4.0), first + 1.0)
    part = np.where(step > 1.0, 0.5, middle - 0.5 - first)
    places = np.stack((first, second), axis=-1).reshape(*start.shape, 2 * VIEW_PX)
    return places.clip(0, size - 1).astype(np.intp), np.rint(PARTS * part).astype(np.uint16)
