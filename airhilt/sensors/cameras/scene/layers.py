"""Bodies before the landscape: one layer each in its own window; what layers hide is counted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from airhilt.imaging.view import Window
from airhilt.sensors.cameras.renderers import Samples
from airhilt.sensors.cameras.scene.projected_box import Box
from airhilt.sensors.cameras.scene.visible_bodies import VisibleBody
from airhilt.shapes.mesh import Floats

Number = TypeVar("Number", bound=np.generic)
TOUCHES_M = 0.25
"""Distance behind a surface, in m, up to which a body still lies on it."""


@dataclass
class Layer:
    """A body in its window.

    Attributes
    ----------
    number
        Number of the actor in `Frame.instance`.
    box, whole
        Boxes about the body: within the picture, and with what lies beyond it; pixels.
    silhouette
        Area of the body in the picture, hidden or not; pixels.
    cover
        Part of each pixel that it fills and the landscape does not hide; shape (rows, columns).
    colour
        Its light in each pixel, times what it fills; shape (rows, columns, 3).
    distance_m
        Distance of the body's nearest sample in each pixel, infinite where there is none.
    """

    actor: str
    number: int
    window: Window
    box: Box
    whole: Box
    range_m: float
    silhouette: float
    cover: Floats
    colour: Floats
    distance_m: Floats

    @classmethod
    def of(
        cls, number: int, body: VisibleBody, drawn: Samples, samples: int, behind_m: Floats
    ) -> Layer:
        """Return the layer of a body that has been drawn before a landscape so far away."""
        distance = by_sample(drawn.distance_m, samples)
        colour = by_sample(drawn.colour, samples)
        is_body = np.isfinite(distance)
        seen = is_body & (distance < behind_m + np.float32(TOUCHES_M))
        hidden = is_body & ~seen
        if hidden.any():
            colour = np.where(hidden[..., None], np.uint8(0), colour)
        count = np.float32(samples**2)
        return cls(
            body.body.actor,
            number,
            body.window,
            body.box,
            body.whole,
            body.range_m,
            float(is_body.sum()) / samples**2,
            np.add.reduce(seen, axis=0, dtype=np.float32) / count,
            np.add.reduce(colour, axis=0, dtype=np.float32) / count,
            np.where(seen, distance, np.float32(np.inf)).min(axis=0),
        )

    def lay(
        self,
        colour: npt.NDArray[np.uint8],
        distance_m: Floats,
        instance: npt.NDArray[np.uint8],
    ) -> None:
        """Draw the layer over a picture."""
        rows, columns = self.window.slices
        part = colour[rows, columns]
        part[...] = np.rint(part * (1.0 - self.cover[..., None]) + self.colour).astype(np.uint8)
        filled = self.cover >= 0.5
        instance[rows, columns][filled] = self.number
        distance_m[rows, columns][filled] = self.distance_m[filled]

    def hide(self, seen: Floats, window: Window) -> None:
        """Reduce the visible part of a farther layer, in its window, by what this layer covers."""
        left, top = max(window.left, self.window.left), max(window.top, self.window.top)
        right = min(window.right, self.window.right)
        bottom = min(window.bottom, self.window.bottom)
        if left >= right or top >= bottom:
            return
        cover = self.cover[
            top - self.window.top : bottom - self.window.top,
            left - self.window.left : right - self.window.left,
        ]
        hidden = seen[top - window.top : bottom - window.top,
                      left - window.left : right - window.left]  # fmt: skip
        hidden *= 1.0 - cover


def by_sample(drawn: npt.NDArray[Number], samples: int) -> npt.NDArray[Number]:
    """Return the samples of a window as that many pictures of it, one behind the other."""
    rows, columns = (side // samples for side in drawn.shape[:2])
    blocks = drawn.reshape(rows, samples, columns, samples, *drawn.shape[2:])
    order = blocks.transpose(1, 3, 0, 2, *range(4, blocks.ndim))
    return order.reshape(samples**2, rows, columns, *drawn.shape[2:])
