"""Tiles of pictures that a detector learns from, and what it should say of them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import torch
from PIL import Image
from torch.nn import functional

from airhilt.assistant.vision.detector import GRID_PX
from detector_data import CLASSES, Body, Shot
from detector_disturbances import Disturber
from detector_network import STRIDE, Network
from detector_scratch import Pictures

TILES = ((96, 36), (160, 13), (96, 36), (288, 5))
"""Side in pixels and number of the tiles of a batch, in turn: most bodies are small."""
LARGEST_SHARE = 0.7
"""Largest share of a tile's side that the body in its middle may take."""
AROUND_A_MISTAKE, AROUND_A_BODY = 0.3, 0.55
"""Parts of the tiles; the rest is cut anywhere."""
ASKED = 400
"""Pictures in a round."""
REMEMBERED = 3000
"""Mistakes, at most: the newest."""
FALSE_FROM, MISSED_UNDER = 0.15, 0.4
"""Scores that make a mistake of what is nothing, and of what is a body."""
SCALES = (0.55, 1.7)
AS_DRAWN = 0.2
"""Part of the tiles that nothing disturbs."""
LEARNT_PX = 8.0
"""Smaller bodies are left out of training: they teach to take lamps and specks for something."""
Picture = npt.NDArray[np.uint8]
Floats = npt.NDArray[np.float32]
Mistake = tuple[int, float, float]
"""A picture's number, and a place in it in pixels."""


class Tiles:
    """Draws tiles of pictures, and the maps that the network should make of them.

    Parameters
    ----------
    pictures
        Pictures of the shots, decoded.
    """

    def __init__(self, shots: list[Shot], pictures: Pictures, seed: int) -> None:
        self._shots, self._pictures, self._seed = shots, pictures, seed
        self._disturber = Disturber(seed)
        self.mistakes: list[Mistake] = []
        self._found = [
            (index, body)
            for index, shot in enumerate(shots)
            for body in shot.bodies
            if _learnt(body)
        ]
        self._weights = {side: _weights(self._found, side) for side, _ in TILES}
        self._own = {
            index: mask
            for index, mask in ((index, shot.own_aircraft()) for index, shot in enumerate(shots))
            if mask.any()
        }

    def ask(self, network: Network, number: int) -> tuple[int, int]:
        """Remember what a network gets wrong in some pictures, and return how much that is.

        What it finds where nothing is comes first, what it misses second.
        """
        draws = np.random.default_rng((self._seed, number, 1))
        indices = draws.choice(len(self._shots), min(ASKED, len(self._shots)), replace=False)
        made: list[Mistake] = []
        false = 0
        network.eval()
        for index in (int(each) for each in indices):
            found, missed = self._mistakes(network, index)
            false += len(found)
            made += [*found, *missed]
        network.train()
        self.mistakes = [*self.mistakes, *made][-REMEMBERED:]
        return false, len(made) - false

    def _mistakes(self, network: Network, index: int) -> tuple[list[Mistake], list[Mistake]]:
        rows, columns = (side - side % GRID_PX for side in self._pictures.shape[1:3])
        picture = torch.from_numpy(self._pictures[index, :rows, :columns].copy())
        with torch.no_grad():
            scores = network(picture.permute(2, 0, 1)[None].float())[0][0].sigmoid()
        best = scores.amax(dim=0)
        free = np.ones(best.shape, dtype=np.float32)
        missed = []
        for body in self._shots[index].bodies:
            left, top, right, bottom = (edge / STRIDE for edge in body.box)
            near = np.s_[max(int(top) - 1, 0) : int(bottom) + 2,
                         max(int(left) - 1, 0) : int(right) + 2]  # fmt: skip
            free[near] = 0.0
            own = scores[body.label][near]
            if _learnt(body) and own.numel() and float(own.max()) < MISSED_UNDER:
                missed.append((index, *_centre(body)))
        if index in self._own:
            free *= ~self._own[index][STRIDE // 2 : rows : STRIDE, STRIDE // 2 : columns : STRIDE]
        best = best * torch.from_numpy(free)
        peaks = (best > FALSE_FROM) & (best == functional.max_pool2d(best[None], 5, 1, 2)[0])
        found = [
            (index, STRIDE * (column + 0.5), STRIDE * (row + 0.5))
            for row, column in peaks.nonzero().tolist()
        ]
        return found, missed

    def batch(self, number: int) -> list[npt.NDArray[Any]]:
        """Return a batch: pictures, scores, weights of scores, boxes, and weights of boxes."""
        draws = np.random.default_rng((self._seed, number))
        side, count = TILES[number % len(TILES)]
        made = [self._tile(side, draws) for _ in range(count)]
        return [np.stack(part) for part in zip(*made, strict=True)]

    def _tile(
        self, tile_px: int, draws: np.random.Generator
    ) -> tuple[Picture, Floats, Floats, Floats, Floats]:
        scale = 1.0
        if draws.random() < 0.5:
            scale = math.exp(draws.uniform(*np.log(SCALES)))
        rows, columns = self._pictures.shape[1:3]
        side = min(round(tile_px / scale), rows, columns)
        choice = draws.random()
        if choice < AROUND_A_MISTAKE and self.mistakes:
            index, x, y = self.mistakes[int(draws.integers(len(self.mistakes)))]
            x -= side * draws.uniform(0.15, 0.85)
            y -= side * draws.uniform(0.15, 0.85)
        elif choice < AROUND_A_MISTAKE + AROUND_A_BODY:
            chosen = int(np.searchsorted(self._weights[tile_px], draws.random()))
            index, body = self._found[chosen]
            x, y = _centre(body)
            x -= side * draws.uniform(0.15, 0.85)
            y -= side * draws.uniform(0.15, 0.85)
        else:
            index = int(draws.integers(len(self._shots)))
            x, y = draws.uniform(0.0, columns - side), draws.uniform(0.0, rows - side)
        x, y = int(np.clip(x, 0, columns - side)), int(np.clip(y, 0, rows - side))
        within = np.s_[y : y + side, x : x + side]
        tile, masks = self._pictures[index][within], self._shots[index].masks()[within]
        if side != tile_px:
            sharp = draws.random() < 0.3
            kind = Image.Resampling.BICUBIC if sharp else Image.Resampling.BILINEAR
            tile = _scaled(tile, tile_px, kind)
            masks = _scaled(masks.astype(np.uint8) * 255, tile_px, Image.Resampling.BILINEAR) > 127
        flip = draws.random() < 0.5
        if flip:
            tile, masks = tile[:, ::-1], masks[:, ::-1]
        bodies = self._shots[index].bodies
        if draws.random() >= AS_DRAWN:
            taken = self._disturber(tile, masks, draws)
            tile, bodies = taken.picture, taken.bodies(bodies)
        scores, counts, boxes, box_weights = _maps(bodies, x, y, tile_px / side, flip, tile_px)
        if index in self._own:
            middles = ((np.arange(tile_px // STRIDE) + 0.5) * STRIDE * side / tile_px).astype(int)
            own = self._own[index][np.ix_(y + middles, x + middles)]
            counts[0][(own[:, ::-1] if flip else own) & (scores.max(axis=0) < 0.3)] = 0.0
        return np.ascontiguousarray(tile), scores, counts, boxes, box_weights


def _scaled(picture: Picture, side: int, kind: Image.Resampling) -> Picture:
    return np.asarray(Image.fromarray(picture).resize((side, side), kind))


def _weights(found: list[tuple[int, Body]], side: int) -> npt.NDArray[np.float64]:
    """Return how likely each body is to be chosen for a tile, summed up."""
    kinds = np.array([(body.label, _octave(body)) for _, body in found])
    groups, group, count = np.unique(kinds, axis=0, return_inverse=True, return_counts=True)
    # Of airplanes there is more to learn than of others, and little of the smallest.
    wanted = np.where(groups[:, 0] == 0, 5.0, 1.0) * np.where(groups[:, 1] < 1, 0.5, 1.0)
    weight = (np.minimum(wanted, count / 20.0) / count)[group.reshape(-1)]
    sizes = np.array([body.size_px for _, body in found])
    weight = np.where(sizes < LARGEST_SHARE * side, weight, 0.0)
    summed: npt.NDArray[np.float64] = np.cumsum(weight) / weight.sum()
    return np.minimum(summed, 1.0)


def _learnt(body: Body) -> bool:
    return body.counts and body.size_px >= LEARNT_PX


def _centre(body: Body) -> tuple[float, float]:
    left, top, right, bottom = body.box
    return (left + right) / 2.0, (top + bottom) / 2.0


def _octave(body: Body) -> int:
    return int(2.0 * math.log2(body.size_px / LEARNT_PX))


def _inside(
    body: Body, x: int, y: int, zoom: float, flip: bool, tile_px: int
) -> tuple[tuple[float, float, float, float], float]:
    """Return the box of a body as far as it is inside a tile, and the part of it that is."""
    left, top, right, bottom = (
        (edge - start) * zoom for edge, start in zip(body.box, (x, y, x, y), strict=True)
    )
    if flip:
        left, right = tile_px - right, tile_px - left
    area = max((right - left) * (bottom - top), 1e-6)
    left, right = max(left, 0.0), min(right, tile_px)
    top, bottom = max(top, 0.0), min(bottom, tile_px)
    inside = max(right - left, 0.0) * max(bottom - top, 0.0)
    return (left, top, right, bottom), inside / area


def _maps(
    bodies: tuple[Body, ...], x: int, y: int, zoom: float, flip: bool, tile_px: int
) -> tuple[Floats, Floats, Floats, Floats]:
    """Return what the network should say of a tile, and how much each cell counts."""
    cells = tile_px // STRIDE
    scores = np.zeros((len(CLASSES), cells, cells), dtype=np.float32)
    counts = np.ones((1, cells, cells), dtype=np.float32)
    boxes = np.zeros((4, cells, cells), dtype=np.float32)
    shares = np.zeros((1, cells, cells), dtype=np.float32)
    bells = np.zeros((cells, cells), dtype=np.float32)
    centres = np.arange(cells, dtype=np.float32) + 0.5
    ignored = []
    # The nearest last, since it stands before the others.
    for body in sorted(bodies, key=lambda body: -body.range_m):
        (left, top, right, bottom), part = _inside(body, x, y, zoom, flip, tile_px)
        if part <= 0.0:
            continue
        width, height = right - left, bottom - top
        if not _learnt(body) or part < 0.3 or max(width, height) < 4.0:
            ignored.append((left, top, right, bottom))
            continue
        middle_x, middle_y = (left + right) / 2.0 / STRIDE, (top + bottom) / 2.0 / STRIDE
        column, row = min(int(middle_x), cells - 1), min(int(middle_y), cells - 1)
        sigma_x, sigma_y = (max(0.11 * side / STRIDE, 0.55) for side in (width, height))
        bell = np.exp(
            -0.5 * ((centres - column - 0.5) / sigma_x)[None, :] ** 2
            - 0.5 * ((centres - row - 0.5) / sigma_y)[:, None] ** 2
        )
        scores[body.label] = np.maximum(scores[body.label], bell)
        mine = (bell > 0.3) & (bell >= 0.99 * bells)
        bells[mine] = bell[mine]
        shares[0][mine] = bell[mine] / bell[mine].sum()
        boxes[0][mine] = np.broadcast_to(middle_x - centres[None, :], bell.shape)[mine]
        boxes[1][mine] = np.broadcast_to(middle_y - centres[:, None], bell.shape)[mine]
        boxes[2][mine], boxes[3][mine] = math.log(max(width, 1.0)), math.log(max(height, 1.0))
    taken = scores.max(axis=0) > 0.3
    for left, top, right, bottom in ignored:
        rows = slice(max(int(top / STRIDE) - 1, 0), int(bottom / STRIDE) + 2)
        columns = slice(max(int(left / STRIDE) - 1, 0), int(right / STRIDE) + 2)
        counts[0, rows, columns] *= taken[rows, columns]
    return scores, counts, boxes, shares
