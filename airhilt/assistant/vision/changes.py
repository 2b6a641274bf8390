"""Changes between two pictures, and the windows about them that a detector looks at."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from airhilt.assistant.vision.detector import GRID_PX, Picture
from airhilt.assistant.vision.tiling import Tile
from airhilt.imaging.boxes import area, shared_area, within
from airhilt.messages import Box

LEAST_CHANGE = 2
"""Least change of a pixel, in levels of 255."""
LEAST_BEYOND_MOTION = 8
"""Likewise beyond what the motion of a camera explains: less than the 5 % of full scale below which
a body does not count (docs/detector.md)."""
LEAST_PIXELS = 3
"""Least number of such pixels in a block: edges that are finer than a pixel come and go."""
MARGIN_PX = 48
"""Margin between a change and the edges of its window, in pixels, unless the picture ends there."""
MARGIN_BLOCKS = MARGIN_PX // GRID_PX - 1
"""Margin in blocks about the blocks next to a change."""

Blocks = npt.NDArray[np.bool_]
"""Marks of squares of `GRID_PX`, shape (down, across)."""
NEXT_TO = np.ones((3, 3), dtype=bool)


def changed_blocks(before: Picture, after: Picture) -> Blocks:
    """Return the blocks in which any pixel has changed by `LEAST_CHANGE` or more."""
    rows, columns, colours = before.shape
    blocks = np.zeros((-(-rows // GRID_PX), -(-columns // GRID_PX)), dtype=bool)
    starts = np.arange(0, columns * colours, GRID_PX * colours)
    for index, strip in enumerate(blocks):
        part = slice(index * GRID_PX, (index + 1) * GRID_PX)
        one, other = before[part], after[part]
        if not np.array_equal(one, other):
            change = np.maximum(one, other) - np.minimum(one, other)
            most = change.reshape(len(change), -1).max(axis=0)
            strip[:] = np.maximum.reduceat(most, starts) >= LEAST_CHANGE
    return blocks


def blocks_beyond_motion(before: Picture, after: Picture, motion_px: tuple[int, int]) -> Blocks:
    """Return the blocks with pixels whose colours were not within a pixel of their places before.

    What comes into the picture at its edges does not count.

    Parameters
    ----------
    motion_px
        Way right and down from places in the picture after to the same places before.
    """
    rows, columns, _ = after.shape
    right, down = motion_px
    blocks = np.zeros((-(-rows // GRID_PX), -(-columns // GRID_PX)), dtype=bool)
    if abs(right) >= columns or abs(down) >= rows:
        return ~blocks
    old = before[max(down, 0) : rows + min(down, 0), max(right, 0) : columns + min(right, 0)]
    place = (
        slice(max(-down, 0), rows - max(down, 0)),
        slice(max(-right, 0), columns - max(right, 0)),
    )
    new = after[place]
    differ = np.flatnonzero((old != new).reshape(len(new), -1).any(axis=1))
    if not len(differ):
        return blocks
    part = slice(max(int(differ[0]) - 1, 0), int(differ[-1]) + 2)
    old, new = old[part], new[part]
    low, high = _about_each(np.minimum, old), _about_each(np.maximum, old)
    change = np.maximum(np.maximum(low, new) - new, np.maximum(high, new) - high)
    beyond = np.zeros((rows, columns), dtype=bool)
    beyond[place][part] = (change >= LEAST_BEYOND_MOTION).any(axis=2)
    starts = np.arange(0, columns, GRID_PX)
    for index, strip in enumerate(blocks):
        count = beyond[index * GRID_PX : (index + 1) * GRID_PX].sum(axis=0)
        strip[:] = np.add.reduceat(count, starts) >= LEAST_PIXELS
    return blocks


def _about_each(pick: np.ufunc, picture: Picture) -> Picture:
    """Return the extreme of each pixel and its eight neighbours."""
    column = picture.copy()
    pick(column[1:], picture[:-1], out=column[1:])
    pick(column[:-1], picture[1:], out=column[:-1])
    square = column.copy()
    pick(square[:, 1:], column[:, :-1], out=square[:, 1:])
    pick(square[:, :-1], column[:, 1:], out=square[:, :-1])
    return square


def blocks_of(boxes: Sequence[Box], rows: int, columns: int) -> Blocks:
    """Return the blocks that boxes touch; they lie within the picture."""
    blocks = np.zeros((-(-rows // GRID_PX), -(-columns // GRID_PX)), dtype=bool)
    for box in boxes:
        left, top, right, bottom = (round(side) // GRID_PX for side in _about([box]))
        blocks[top:bottom, left:right] = True
    return blocks


def windows_about(blocks: Blocks, boxes: Sequence[Box], rows: int, columns: int) -> list[Tile]:
    """Return windows about all changes, on the grid, none of which touches another.

    Each of the boxes, which are those of earlier findings, lies wholly in a window or in none. At
    the edges of the picture windows are no smaller than elsewhere.
    """
    parts = ndimage.find_objects(ndimage.label(ndimage.binary_dilation(blocks, NEXT_TO))[0])
    waiting: list[Box] = []
    for down, across in parts:
        left, right = _inside(across, blocks.shape[1])
        top, bottom = _inside(down, blocks.shape[0])
        waiting.append((left, top, right, bottom))
    windows: list[Box] = []
    while waiting:
        window = waiting.pop()
        met = [other for other in windows if shared_area(_about([window], 1.0), other)]
        cut = [box for box in boxes if 0.0 < shared_area(window, box) < area(box)]
        if met or cut:
            windows = [other for other in windows if other not in met]
            waiting.append(_about([window, *met, *cut]))
        else:
            windows.append(window)
    return [
        Tile(top, left, bottom - top, right - left)
        for window in windows
        for left, top, right, bottom in [map(round, within(window, columns, rows))]
    ]


def _inside(changed: slice, blocks: int) -> tuple[float, float]:
    first, end = changed.start - MARGIN_BLOCKS, changed.stop + MARGIN_BLOCKS
    back, on = max(end - blocks, 0), max(-first, 0)
    return max(first - back, 0) * GRID_PX, min(end + on, blocks) * GRID_PX


def _about(boxes: Sequence[Box], margin_px: float = 0.0) -> Box:
    """Return the smallest box on the grid around boxes and a margin."""
    left, top = (min(box[side] for box in boxes) - margin_px for side in (0, 1))
    right, bottom = (max(box[side] for box in boxes) + margin_px for side in (2, 3))
    return (
        math.floor(left / GRID_PX) * GRID_PX,
        math.floor(top / GRID_PX) * GRID_PX,
        math.ceil(right / GRID_PX) * GRID_PX,
        math.ceil(bottom / GRID_PX) * GRID_PX,
    )
