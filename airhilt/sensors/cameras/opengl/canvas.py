"""Frame buffers to draw in."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from airhilt.sensors.cameras.renderers import Samples

CANVAS_STEP_PX = 64
"""Step in which frame buffers grow."""
TOUCHED, UNTOUCHED = ((True,) * 4,) * 2, ((False,) * 4,) * 2
"""Masks that let colours and distances be written, or not."""


class Canvas:
    """Draws into the upper left corner of a frame buffer that only grows.

    There is never more than one: a buffer for each size would in time take all memory.
    """

    def __init__(self, context: Any) -> None:
        self._context = context
        self._room = 0, 0
        self._owned: list[Any] = []
        self.frame: Any = None
        self.size = 0, 0

    def clear(self, size: tuple[int, int], *, is_filled: bool = False) -> None:
        """Begin a drawing of some size; colours are not cleared if all of it will be filled."""
        width, height = (
            max(CANVAS_STEP_PX * math.ceil(side / CANVAS_STEP_PX), room)
            for side, room in zip(size, self._room, strict=True)
        )
        if (width, height) != self._room:
            self._replace((width, height))
        self.size = size
        self.frame.use()
        self.frame.viewport = 0, 0, *size
        self.frame.color_mask = UNTOUCHED if is_filled else TOUCHED
        self.frame.clear(viewport=(0, 0, *size))
        self.frame.color_mask = TOUCHED

    def _replace(self, room: tuple[int, int]) -> None:
        for owned in self._owned:
            owned.release()
        context = self._context
        colour, distance = context.texture(room, 4), context.texture(room, 1, dtype="f4")
        depth = context.depth_renderbuffer(room)
        self.frame = context.framebuffer([colour, distance], depth)
        self._owned = [self.frame, colour, distance, depth]
        self._room = room

    def read(self) -> Samples:
        """Return colours, and what has been drawn for distances."""
        width, height = self.size
        colour = self.frame.read(self.size, components=3, alignment=1)
        distance = self.frame.read(self.size, components=1, attachment=1, dtype="f4")
        return Samples(
            np.frombuffer(colour, dtype=np.uint8).reshape(height, width, 3),
            np.frombuffer(distance, dtype=np.float32).reshape(height, width),
        )
