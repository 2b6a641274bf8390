"""The folders of `airhilt dataset export`, as training and judging of detectors read them."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

CLASSES = ("airplane", "truck", "bird", "deer", "coyote")
"""In the order of the network's maps."""
SMALLEST_PX = 5.0
"""Least longest side of a box that a detector may be asked to find."""
LEAST_VISIBLE = 0.25
LEAST_TRANSMISSION = 0.05
LEAST_CONTRAST = 0.05 * 255.0
"""One twentieth is what an observer needs: WMO-No. 8, the definition of meteorological optical
range."""
RING_PX = 3

Picture = npt.NDArray[np.uint8]
Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Body:
    """Something in a picture.

    Attributes
    ----------
    label
        Place of its class in `CLASSES`.
    box
        Left, top, right, bottom in pixels.
    contrast
        What half of its pixels differ more than from the colour around, in 8-bit levels. So
        lamps alone do not make a body visible.
    corner, mask
        Row and column of a part of the picture, and where the body is in it.
    """

    label: int
    box: tuple[float, float, float, float]
    range_m: float
    visible_fraction: float
    transmission: float
    contrast: float
    corner: tuple[int, int] = (0, 0)
    mask: Mask = field(default_factory=lambda: np.zeros((0, 0), dtype=bool), compare=False)

    @property
    def size_px(self) -> float:
        """Its longest side."""
        left, top, right, bottom = self.box
        return max(right - left, bottom - top)

    @property
    def counts(self) -> bool:
        """True if a detector may be asked to find the body."""
        return (
            self.size_px >= SMALLEST_PX
            and self.visible_fraction >= LEAST_VISIBLE
            and self.transmission >= LEAST_TRANSMISSION
            and self.contrast >= LEAST_CONTRAST
        )


@dataclass(frozen=True)
class Shot:
    """A picture of a folder, and what is in it."""

    path: Path
    about: dict[str, Any]
    bodies: tuple[Body, ...]

    def own_aircraft(self) -> Mask:
        """Return where the aircraft that carries the camera is, shape (rows, columns)."""
        rows, columns = self.about["height"], self.about["width"]
        return mask_of(self.about.get("own_aircraft", {"size": [rows, columns], "counts": []}))

    def picture(self) -> Picture:
        """Return its pixels, shape (rows, columns, 3)."""
        return read_picture(self.path)

    def masks(self) -> Mask:
        """Return where bodies are, shape (rows, columns)."""
        masks = np.zeros((self.about["height"], self.about["width"]), dtype=bool)
        for body in self.bodies:
            (top, left), (rows, columns) = body.corner, body.mask.shape
            masks[top : top + rows, left : left + columns] |= body.mask
        return masks


def read_picture(path: Path) -> Picture:
    """Return the pixels of a file, shape (rows, columns, 3)."""
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


def read_folder(folder: Path) -> list[Shot]:
    """Return the pictures of a folder; contrasts are measured in them."""
    document = json.loads((folder / "annotations.json").read_text(encoding="utf-8"))
    names = {category["id"]: category["name"] for category in document["categories"]}
    found: dict[int, list[dict[str, Any]]] = {}
    for annotation in document["annotations"]:
        found.setdefault(annotation["image_id"], []).append(annotation)
    shots = []
    for about in document["images"]:
        path = folder / about["file_name"]
        given = found.get(about["id"], [])
        pixels = read_picture(path) if given else None
        bodies = []
        for annotation in given:
            left, top, width, height = annotation["bbox"]
            box = left, top, left + width, top + height
            assert pixels is not None
            mask = mask_of(annotation["segmentation"])
            top_row, left_column = max(int(top), 0), max(int(left), 0)
            within = np.s_[top_row : math.ceil(top + height), left_column : math.ceil(left + width)]
            bodies.append(
                Body(
                    CLASSES.index(names[annotation["category_id"]]),
                    box,
                    annotation["range_m"],
                    annotation["visible_fraction"],
                    annotation["transmission"],
                    contrast(pixels, box, mask),
                    (top_row, left_column),
                    mask[within].copy(),
                )
            )
        shots.append(Shot(path, about, tuple(bodies)))
    return shots


def mask_of(segmentation: dict[str, list[int]]) -> Mask:
    """Return the mask of COCO's uncompressed run lengths, shape (rows, columns)."""
    rows, columns = segmentation["size"]
    counts = segmentation["counts"] or [rows * columns]
    return np.repeat(np.arange(len(counts)) % 2 == 1, counts).reshape(columns, rows).T


def contrast(picture: Picture, box: tuple[float, float, float, float], mask: Mask) -> float:
    """Return what half of a body's pixels differ more than from the median colour around it."""
    rows, columns = picture.shape[:2]
    left, top = max(int(box[0]), 0), max(int(box[1]), 0)
    right, bottom = min(int(np.ceil(box[2])), columns), min(int(np.ceil(box[3])), rows)
    around = np.s_[
        max(top - RING_PX, 0) : bottom + RING_PX, max(left - RING_PX, 0) : right + RING_PX
    ]
    ring = np.ones(picture[around].shape[:2], dtype=bool)
    above, aside = top - max(top - RING_PX, 0), left - max(left - RING_PX, 0)
    ring[above : above + bottom - top, aside : aside + right - left] = False
    inside = picture[top:bottom, left:right][mask[top:bottom, left:right]]
    if not len(inside):
        return 0.0
    if not ring.any():
        return 255.0
    away = np.abs(inside.astype(float) - np.median(picture[around][ring], axis=0)).max(axis=1)
    return float(np.median(away))
