"""Masks of pictures as lengths of runs, as `airhilt.messages.CameraInfo` has them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Mask = npt.NDArray[np.bool_]
"""Mask of the pixels of a picture, shape (rows, columns)."""


def runs_of(mask: Mask) -> tuple[int, ...]:
    """Return the lengths of runs, row by row: free, covered, free and so on; none if all is free.

    The first is 0 where the first pixel is covered.
    """
    if not mask.any():
        return ()
    flat = mask.reshape(-1)
    changes = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    bounds = np.concatenate(([0], [0] if flat[0] else [], changes, [flat.size]))
    return tuple(int(length) for length in np.diff(bounds))


def mask_of(runs: Sequence[int], rows: int, columns: int) -> Mask:
    """Return the mask of some lengths of runs.

    Raises
    ------
    ValueError
        They do not add up to the pixels of the picture.
    """
    if not runs:
        return np.zeros((rows, columns), dtype=bool)
    if min(runs) < 0 or sum(runs) != rows * columns:
        raise ValueError(
            f"runs of {sum(runs)} pixels; expected the {columns} by {rows} of the picture, and "
            "none below 0"
        )
    covered = np.arange(len(runs)) % 2 == 1
    return np.repeat(covered, runs).reshape(rows, columns)


def grown(mask: Mask, margin_px: int) -> Mask:
    """Return a mask and all pixels within a margin of it, along rows and columns."""
    grown = np.pad(mask, margin_px)
    for axis in (0, 1):
        steps = range(-margin_px, margin_px + 1)
        grown = np.logical_or.reduce([np.roll(grown, step, axis) for step in steps])
    return grown[margin_px:-margin_px, margin_px:-margin_px]
