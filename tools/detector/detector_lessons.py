"""Training data of the refiner: places with bodies and without, drawn and varied."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from airhilt.assistant.vision.refiner import about, views_of
from airhilt.imaging.boxes import centre, sides, size_px
from airhilt.messages import Box
from detector_places import Places

BATCH, OF_BODIES = 256, 0.35
"""Places in a batch, and the part of them that are bodies."""
SHIFT, STRETCH = 0.08, 0.12
"""Largest shift of a box in training, in longest sides, and largest change of its log size."""
LOGIT_NOISE, LOGIT_HIDDEN = 0.4, 0.2

Bytes = npt.NDArray[np.uint8]
Floats = npt.NDArray[np.float32]


class Lessons:
    """Draws places to learn from."""

    def __init__(self, folders: Sequence[Places], seed: int) -> None:
        self._folders, self._seed = folders, seed
        self._folder = np.repeat(np.arange(len(folders)), [len(each) for each in folders])
        self._place = np.concatenate([np.arange(len(each)) for each in folders])
        self._labels = np.concatenate([each.labels for each in folders])
        boxes = np.concatenate([each.boxes for each in folders])
        longest = np.maximum(boxes[:, 2] - boxes[:, 0], boxes[:, 3] - boxes[:, 1])
        octave = np.log2(longest.clip(6.0, 200.0) / 6.0).astype(int)
        kinds = np.column_stack((self._labels, octave))
        groups, group, count = np.unique(kinds, axis=0, return_inverse=True, return_counts=True)
        # Of airplanes there is more to learn than of others.
        wanted = np.where(groups[:, 0] == 1, 5.0, 1.0) * np.minimum(count / 30.0, 1.0)
        often = (wanted / count)[group.reshape(-1)] * (self._labels > 0)
        self._often = np.cumsum(often) / often.sum()
        self._nothing = np.flatnonzero(self._labels == 0)
        self.fooled = np.concatenate([each.scores for each in folders])[self._nothing]

    def __len__(self) -> int:
        return len(self._labels)

    @property
    def bodies(self) -> int:
        """Number of the places that show a body."""
        return int((self._labels > 0).sum())

    def batch(self, number: int) -> list[npt.NDArray[Any]]:
        """Return which of what is nothing is in it, views, what is known, labels and moves."""
        draws = np.random.default_rng((self._seed, number))
        bodies = round(BATCH * OF_BODIES)
        chosen = np.searchsorted(self._often, draws.random(bodies)).clip(0, len(self._often) - 1)
        hard = np.cumsum(self.fooled + 0.03)
        nothing = np.searchsorted(hard / hard[-1], draws.random(BATCH - bodies))
        nothing = nothing.clip(0, len(self._nothing) - 1)
        numbers = np.concatenate((np.full(bodies, -1), nothing))
        made = [
            self._lesson(int(index), draws)
            for index in np.concatenate((chosen, self._nothing[nothing]))
        ]
        return [numbers, *(np.stack(part) for part in zip(*made, strict=True))]

    def _lesson(
        self, index: int, draws: np.random.Generator
    ) -> tuple[Bytes, Floats, np.int64, Floats]:
        folder, place = self._folders[self._folder[index]], self._place[index]
        label = folder.labels[place]
        box = _moved_about(tuple(folder.boxes[place].tolist()), draws)
        wanted = moves_to(box, tuple(folder.truth[place].tolist()))
        views = views_of(folder.pictures[folder.picture[place]], [box])[0]
        known = about([box], [float(folder.scores[place])])[0]
        known[0] += draws.normal(0.0, LOGIT_NOISE)
        if draws.random() < LOGIT_HIDDEN:
            known[0] = 0.0
        if draws.random() < 0.5:
            views = views[:, :, ::-1]
            wanted = -wanted[0], *wanted[1:]
        return varied(views, draws), known, label, np.array(wanted, dtype=np.float32)


def moves_to(box: Box, other: Box) -> tuple[float, float, float, float]:
    """Return the moves by which `airhilt.assistant.vision.refiner.refined` makes another box."""
    (column, row), (column_, row_) = centre(box), centre(other)
    longest = max(size_px(box), 1.0)
    (width, height), (width_, height_) = sides(box), sides(other)
    return (
        (column_ - column) / longest,
        (row_ - row) / longest,
        math.log(width_ / width),
        math.log(height_ / height),
    )


def _moved_about(box: Box, draws: np.random.Generator) -> Box:
    (column, row), longest = centre(box), size_px(box)
    column, row = (float(at + draws.normal(0.0, SHIFT * longest + 0.3)) for at in (column, row))
    both = draws.normal(0.0, STRETCH)
    width, height = (
        side * math.exp(both + draws.normal(0.0, STRETCH / 2.0)) / 2.0 for side in sides(box)
    )
    return column - width, row - height, column + width, row + height


def varied(views: Bytes, draws: np.random.Generator) -> Bytes:
    """Return views as another camera would have taken them."""
    if draws.random() < 0.7:
        gains = draws.uniform(0.94, 1.06, size=3) * draws.uniform(0.7, 1.1)
        gamma, lift = math.exp(draws.normal(0.0, 0.2)), draws.uniform(-8.0, 8.0)
        levels = np.arange(256)[:, None] / 255.0
        table = np.clip(255.0 * levels**gamma * gains + lift, 0.0, 255.0).astype(np.uint8)
        views = np.stack([table[views[..., colour], colour] for colour in range(3)], axis=-1)
    if draws.random() < 0.25:
        noise = draws.standard_normal(views.shape, dtype=np.float32)
        views = np.clip(views + noise * draws.uniform(0.5, 4.0), 0.0, 255.0).astype(np.uint8)
    return np.ascontiguousarray(views)
