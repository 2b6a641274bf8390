"""Train the detector that ships with AIRHILT, and write it as ONNX with its card.

    pip install torch onnx
    airhilt dataset export --out data/train --images 10000 --seed 101 --renderer moderngl ...
    python tools/detector/train_detector.py data/train --out detector

It is a small convolutional network that looks for the middles of bodies (X. Zhou et al., Objects
as Points, arXiv 1904.07850), of one scale at an eighth of the resolution, and needs no
suppression of overlapping boxes. It learns from tiles: most are cut around a body of some class
and size, drawn so that rare classes and small bodies come as often as others, and changed in
scale, colour and sharpness. Bodies that can hardly be seen are neither learnt nor counted as
background. After training, ``tools/detector/train_refiner.py`` makes the second network, and
``tools/detector/calibrate_detector.py`` fits what both say and chooses the threshold.

A checkpoint is written every few minutes; the same command goes on from it. Pictures must all be
of one size; they are kept decoded in ``OUT/pictures-<mark>.u8``, where the mark changes with the
data; files with other marks are not needed any more. The same data, seed and versions give
the same network, but for the rounding of sums in another order on another machine.
"""

from __future__ import annotations

import argparse
import copy
import json
import math
import multiprocessing
import time
from collections.abc import Callable, Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import torch
from PIL import Image, ImageFilter
from torch import Tensor, nn
from torch.nn import functional

from airhilt.assistant.vision.detector import GRID_PX
from airhilt.assistant.vision.detectors.embedded import CARD
from detector_data import CLASSES, Body, Shot, read_folder
from detector_scratch import Pictures, contents, decoded, mark_of

STEM_STRIDE, STRIDE = 4, 8
"""Of the first convolution, and of the maps."""
TILES = ((96, 36), (160, 13), (96, 36), (288, 5))
"""Side in pixels and number of the tiles of a batch, in turn: most bodies are small."""
LARGEST_SHARE = 0.7
"""Of a tile's side, that the body around which it is cut may have."""
FOUND = 50
"""Bodies that are looked for in a picture, at most."""
RATE, WARM_UP, DECAY = 2e-3, 200, 1e-3
EMA = 0.999
AROUND_A_MISTAKE, AROUND_A_BODY = 0.3, 0.55
"""Parts of the tiles; the rest is cut anywhere."""
ROUND = 1000
"""Batches after which the network is asked what it makes of some of the pictures."""
AHEAD = 3
"""Batches that are made before they are needed."""
LONGEST_S = 600.0
"""For which a batch is waited for."""
ASKED = 400
"""Pictures in a round."""
REMEMBERED = 3000
"""Mistakes, at most: the newest."""
FALSE_FROM, MISSED_UNDER = 0.15, 0.4
"""Scores that make a mistake of what is nothing, and of what is a body."""
SCALES = (0.55, 1.7)
CHECKPOINT_S = 120.0
LEARNT_PX = 8.0
"""Smaller bodies are left out of training: they teach to take lamps and specks for something."""
WIDTHS, BLOCKS = (16, 48, 64, 64), (1, 1, 3)
FAINT_LEVELS = 12.0
"""Differences from the surroundings above it count less and less."""
WORTH = (2.0, 0.5, 0.5)
"""Of the losses of scores, places and overlaps."""
PRIOR = 0.005
"""Score of everything before training."""
NOT_CALIBRATED = 1.0
"""The threshold in a card, until tools/detector/calibrate_detector.py chooses one."""

Picture = npt.NDArray[np.uint8]
Floats = npt.NDArray[np.float32]
Mistake = tuple[int, float, float]
"""A picture's number, and a place in it in pixels."""


# --- the network --------------------------------------------------------------------------


def convolution(
    inward: int, outward: int, step: int = 1, size: int = 3, spread: int = 1
) -> nn.Sequential:
    """Return a convolution with normalisation and rectifier."""
    return nn.Sequential(
        nn.Conv2d(inward, outward, size, step, size // 2 * spread, spread, bias=False),
        nn.BatchNorm2d(outward),
        nn.ReLU(inplace=True),
    )


class Block(nn.Module):
    """Two convolutions past which the input goes too."""

    def __init__(self, width: int, narrow: int, spread: int = 1) -> None:
        super().__init__()
        self.body = nn.Sequential(
            convolution(width, narrow), convolution(narrow, width, spread=spread)
        )

    def forward(self, features: Tensor) -> Tensor:
        """Return as many features."""
        return features + self.body(features)


class Network(nn.Module):
    """From pictures, 0 to 255, shape (n, 3, rows, columns), to maps at an eighth of that.

    The maps are the scores of each class before the sigmoid; how far the middle of a body is from
    that of the cell, right and down, in cells; and the logarithms of its width and height in
    pixels. Rows and columns are multiples of 16. Widths are multiples of 16, as the vector units
    of processors are. Beside the colours goes what differs from the surroundings, so that what is
    faint in haze or darkness counts as much as what is bright.
    """

    def __init__(
        self, widths: tuple[int, int, int, int] = WIDTHS, blocks: tuple[int, int, int] = BLOCKS
    ) -> None:
        super().__init__()
        supersampling, middle, coarse, last = widths
        self.stem = nn.Conv2d(3, supersampling, 6, STEM_STRIDE, 1, bias=False)
        self.stem_local = nn.Conv2d(1, supersampling, 6, STEM_STRIDE, 1, bias=False)
        self.stem_norm = nn.Sequential(nn.BatchNorm2d(supersampling), nn.ReLU(inplace=True))
        self.supersampling = nn.Sequential(*(Block(supersampling, 16) for _ in range(blocks[0])))
        self.middle = nn.Sequential(
            convolution(supersampling, middle, 2),
            *(Block(middle, middle // 2) for _ in range(blocks[1])),
        )
        self.coarse = nn.Sequential(
            convolution(middle, coarse, 2),
            *(Block(coarse, coarse // 2, 1 << depth) for depth in range(blocks[2])),
        )
        self.to_middle = convolution(coarse, middle, size=1)
        self.head = convolution(middle, last)
        self.maps = nn.Conv2d(last, len(CLASSES) + 4, 1)
        nn.init.normal_(self.maps.weight, std=0.01)
        with torch.no_grad():
            self.maps.bias.fill_(math.log(PRIOR / (1.0 - PRIOR)))
            self.maps.bias[-4:] = torch.tensor([0.0, 0.0, 3.0, 2.3])

    def forward(self, pictures: Tensor) -> tuple[Tensor, Tensor]:
        """Return the maps of scores and those of places and sizes."""
        light = functional.conv2d(pictures, self.stem.weight / 64.0, None, STEM_STRIDE, 1)
        supersampling = self.supersampling(
            self.stem_norm(light + self.stem_local(_local(pictures)))
        )
        middle = self.middle(supersampling)
        middle = middle + _enlarged(self.to_middle(self.coarse(middle)), 2)
        maps = self.maps(self.head(middle))
        return maps[:, : len(CLASSES)], maps[:, len(CLASSES) :]


def _local(pictures: Tensor) -> Tensor:
    """Return by how much each pixel differs from what is around it, from -1 to 1."""
    red, green, blue = pictures.split(1, dim=1)
    grey = (red + green + blue) * (1.0 / (3.0 * FAINT_LEVELS))
    around = functional.avg_pool2d(functional.avg_pool2d(grey, 8), 3, 1, 1, False, False)
    return (grey - _enlarged(around, 8)).tanh()


def _enlarged(features: Tensor, factor: int) -> Tensor:
    return functional.interpolate(features, scale_factor=float(factor), mode="nearest")


class Detector(nn.Module):
    """What is exported: a picture in, boxes out."""

    def __init__(self, network: Network) -> None:
        super().__init__()
        self.network = network

    def forward(self, picture: Tensor) -> Tensor:
        """Return left, top, right, bottom, score and class of what stands out most."""
        scores, boxes = self.network(picture.permute(0, 3, 1, 2).float())
        best, label = scores.max(dim=1, keepdim=True)
        peak = best == functional.max_pool2d(best, 3, 1, 1)
        ranked = torch.where(peak, best, torch.full_like(best, -20.0)).flatten(1)
        score, place = ranked.topk(FOUND, dim=1)
        columns = scores.shape[3]
        across, down = place % columns, torch.div(place, columns, rounding_mode="floor")
        chosen = boxes.flatten(2).gather(2, place[:, None, :].expand(-1, 4, -1))
        x = (across + 0.5 + chosen[:, 0]) * STRIDE
        y = (down + 0.5 + chosen[:, 1]) * STRIDE
        half_width, half_height = chosen[:, 2:].exp().unbind(1)
        half_width, half_height = 0.5 * half_width, 0.5 * half_height
        kind = label.flatten(1).gather(1, place).float()
        sides = (x - half_width, y - half_height, x + half_width, y + half_height)
        return torch.stack((*sides, score.sigmoid(), kind), dim=2)


def folded(network: Network) -> Network:
    """Return a network whose first two convolutions do what the normalisation after them did."""
    quick: Network = copy.deepcopy(network).eval()
    norm = quick.stem_norm[0]
    assert isinstance(norm, nn.BatchNorm2d)
    with torch.no_grad():
        scale = norm.weight / (norm.running_var + norm.eps).sqrt()
        quick.stem.weight *= scale[:, None, None, None]
        quick.stem_local.weight *= scale[:, None, None, None]
        quick.stem_local.bias = nn.Parameter(norm.bias - norm.running_mean * scale)
    quick.stem_norm[0] = nn.Identity()
    return quick


def write_onnx(network: Network, path: Path) -> None:
    """Write a network that takes uint8 pictures, (1, rows, columns, 3), of 16 pixels' multiples."""
    detector = Detector(folded(network)).eval()
    example = torch.zeros((1, 96, 160, 3), dtype=torch.uint8)
    torch.onnx.export(
        detector,
        (example,),
        str(path),
        input_names=["picture"],
        output_names=["found"],
        dynamic_axes={"picture": {1: "rows", 2: "columns"}},
        opset_version=17,
        dynamo=False,
    )


# --- tiles --------------------------------------------------------------------------------


class Tiles:
    """Draws tiles of pictures, and the maps that the network should make of them.

    Parameters
    ----------
    pictures
        Those of the shots, decoded.
    """

    def __init__(self, shots: list[Shot], pictures: Pictures, seed: int) -> None:
        self._shots, self._pictures, self._seed = shots, pictures, seed
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
        tile = self._pictures[index, y : y + side, x : x + side]
        if side != tile_px:
            sharp = draws.random() < 0.3
            kind = Image.Resampling.BICUBIC if sharp else Image.Resampling.BILINEAR
            tile = np.asarray(Image.fromarray(tile).resize((tile_px, tile_px), kind))
        flip = draws.random() < 0.5
        if flip:
            tile = tile[:, ::-1]
        scores, counts, boxes, box_weights = _maps(
            self._shots[index].bodies, x, y, tile_px / side, flip, tile_px
        )
        if index in self._own:
            middles = ((np.arange(tile_px // STRIDE) + 0.5) * STRIDE * side / tile_px).astype(int)
            own = self._own[index][np.ix_(y + middles, x + middles)]
            counts[0][(own[:, ::-1] if flip else own) & (scores.max(axis=0) < 0.3)] = 0.0
        return varied(tile, draws), scores, counts, boxes, box_weights


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


def varied(tile: Picture, draws: np.random.Generator) -> Picture:
    """Return a tile as another camera would have taken it."""
    if draws.random() < 0.7:
        gains = draws.uniform(0.94, 1.06, size=3) * draws.uniform(0.7, 1.08)
        gamma = math.exp(draws.normal(0.0, 0.2))
        lift = draws.uniform(-8.0, 8.0)
        levels = np.arange(256)[:, None] / 255.0
        table = np.clip(255.0 * levels**gamma * gains + lift, 0.0, 255.0).astype(np.uint8)
        image = Image.fromarray(np.ascontiguousarray(tile))
        tile = np.asarray(image.point(table.T.ravel().tolist()))
    if draws.random() < 0.08:
        grey = tile.mean(axis=2, keepdims=True)
        tile = np.broadcast_to(grey, tile.shape).astype(np.uint8)
    if draws.random() < 0.08:
        blur = ImageFilter.GaussianBlur(float(draws.uniform(0.3, 0.9)))
        tile = np.asarray(Image.fromarray(np.ascontiguousarray(tile)).filter(blur))
    if draws.random() < 0.25:
        noise = draws.standard_normal(tile.shape, dtype=np.float32)
        tile = np.clip(tile + noise * draws.uniform(0.5, 4.0), 0.0, 255.0).astype(np.uint8)
    if draws.random() < 0.25:
        buffer = BytesIO()
        Image.fromarray(np.ascontiguousarray(tile)).save(
            buffer, format="JPEG", quality=int(draws.integers(60, 96))
        )
        tile = np.asarray(Image.open(buffer))
    return np.ascontiguousarray(tile)


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
        left, top, right, bottom = (
            (edge - start) * zoom for edge, start in zip(body.box, (x, y, x, y), strict=True)
        )
        if flip:
            left, right = tile_px - right, tile_px - left
        inside = max(min(right, tile_px) - max(left, 0.0), 0.0) * max(
            min(bottom, tile_px) - max(top, 0.0), 0.0
        )
        if inside <= 0.0:
            continue
        part = inside / max((right - left) * (bottom - top), 1e-6)
        left, right = max(left, 0.0), min(right, tile_px)
        top, bottom = max(top, 0.0), min(bottom, tile_px)
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


# --- training -----------------------------------------------------------------------------


def loss_of(
    scores: Tensor, boxes: Tensor, wanted: Tensor, counts: Tensor, sides: Tensor, shares: Tensor
) -> tuple[Tensor, Tensor, Tensor]:
    """Return the focal loss of the scores, and the losses of places and of overlap.

    The first is that of X. Zhou et al.: only the middle of a body must have a score of 1, and
    what is near it may have one. So scores tell how sure it is that a body is there, and not
    how sure it is in which cell its middle lies.
    """
    middle = (wanted >= 0.999).float()
    chance = scores.sigmoid()
    there = (1.0 - chance) ** 2 * functional.logsigmoid(scores) * middle
    nothing = chance**2 * functional.logsigmoid(-scores) * (1.0 - wanted) ** 4
    focal = -((there + nothing) * counts).sum() / middle.sum().clamp(min=1.0)
    share = shares.sum().clamp(min=1.0)
    away = functional.smooth_l1_loss(boxes, sides, reduction="none", beta=0.2)
    places = (away * shares).sum() / share
    chosen = shares[:, 0] > 0.0
    overlap = _giou(boxes.permute(0, 2, 3, 1)[chosen], sides.permute(0, 2, 3, 1)[chosen])
    overlaps = ((1.0 - overlap) * shares[:, 0][chosen]).sum() / share
    return focal, places, overlaps


def _giou(one: Tensor, other: Tensor) -> Tensor:
    """Return the generalised overlap (H. Rezatofighi et al., CVPR 2019) of boxes of one cell."""

    def edges(box: Tensor) -> tuple[Tensor, ...]:
        half = 0.5 * box[:, 2:].clamp(max=6.5).exp()
        middle = STRIDE * box[:, :2]
        return *(middle - half).unbind(1), *(middle + half).unbind(1)

    left, top, right, bottom = edges(one)
    left_, top_, right_, bottom_ = edges(other)
    width = (torch.minimum(right, right_) - torch.maximum(left, left_)).clamp(min=0.0)
    height = (torch.minimum(bottom, bottom_) - torch.maximum(top, top_)).clamp(min=0.0)
    shared = width * height
    union = (right - left) * (bottom - top) + (right_ - left_) * (bottom_ - top_) - shared
    around = (torch.maximum(right, right_) - torch.minimum(left, left_)) * (
        torch.maximum(bottom, bottom_) - torch.minimum(top, top_)
    )
    return shared / union - (around - union) / around


def batches(
    make_one: Callable[[int], list[npt.NDArray[Any]]], first: int, last: int
) -> Iterator[tuple[Tensor, ...]]:
    """Yield batches by their numbers; another process makes the next ones while one is used."""
    fork = multiprocessing.get_context("fork")
    made = fork.Queue(AHEAD)

    def make() -> None:
        for number in range(first, last):
            made.put(make_one(number))

    maker = fork.Process(target=make, daemon=True)
    maker.start()
    for _ in range(first, last):
        yield tuple(torch.from_numpy(part) for part in made.get(timeout=LONGEST_S))
    maker.join()


def rounds(
    tiles: Tiles, mean: nn.Module, first: int, last: int
) -> Iterator[tuple[int, tuple[Tensor, ...]]]:
    """Yield numbers and batches; the mean network's mistakes are learnt from, round by round."""
    while first < last:
        if first % ROUND == 0:
            network = mean.module
            assert isinstance(network, Network)
            false, missed = tiles.ask(network, first)
            print(f"of {ASKED} pictures: {false} false, {missed} missed", flush=True)
        end = min(first + ROUND - first % ROUND, last)
        yield from enumerate(batches(tiles.batch, first, end), start=first)
        first = end


def begin_with(network: Network, weights: dict[str, Tensor]) -> None:
    """Take what fits of the weights of another training."""
    own = network.state_dict()
    named = {name.removeprefix("module."): weight for name, weight in weights.items()}
    fitting = {
        name: weight
        for name, weight in named.items()
        if name in own and weight.shape == own[name].shape
    }
    network.load_state_dict(own | fitting)
    print(f"begins with {len(fitting)} of {len(own)} weights", flush=True)


def followed(mean: Tensor, now: Tensor, count: Tensor | int) -> Tensor:
    """Return a running mean that follows fast at first."""
    return mean + (now - mean) * max(1.0 - EMA, 10.0 / (10.0 + float(count)))


def train(
    tiles: Tiles, steps: int, checkpoint: Path, seed: int, start: Path | None = None
) -> Network:
    """Return the mean network of the last part of the training."""
    torch.manual_seed(seed)
    network = Network()
    if start is not None and not checkpoint.is_file():
        begin_with(network, torch.load(start, weights_only=True)["mean"])
    network.to(memory_format=torch.channels_last)
    mean = torch.optim.swa_utils.AveragedModel(network, avg_fn=followed, use_buffers=True)
    scaled = [p for p in network.parameters() if p.ndim > 1]
    others = [p for p in network.parameters() if p.ndim <= 1]
    optimiser = torch.optim.AdamW(
        [{"params": scaled, "weight_decay": DECAY}, {"params": others, "weight_decay": 0.0}], RATE
    )
    done, spent_s = 0, 0.0
    if checkpoint.is_file():
        kept = torch.load(checkpoint, weights_only=True)
        network.load_state_dict(kept["network"])
        mean.load_state_dict(kept["mean"])
        optimiser.load_state_dict(kept["optimiser"])
        done, spent_s = kept["done"], kept["spent_s"]
        tiles.mistakes = [(int(index), x, y) for index, x, y in kept["mistakes"].tolist()]
        print(f"goes on at step {done}", flush=True)
    begun = saved = time.monotonic()
    means = np.zeros(3)
    network.train()
    for step, (pictures, *maps) in rounds(tiles, mean, done, steps):
        rate = RATE * min((step + 1) / WARM_UP, 0.5 + 0.5 * math.cos(math.pi * step / steps))
        for group in optimiser.param_groups:
            group["lr"] = max(rate, 1e-5)
        seen = pictures.permute(0, 3, 1, 2).float()
        scores, boxes = network(seen.contiguous(memory_format=torch.channels_last))
        losses = loss_of(scores, boxes, *maps)
        optimiser.zero_grad(set_to_none=True)
        sum(worth * loss for worth, loss in zip(WORTH, losses, strict=True)).backward()
        nn.utils.clip_grad_norm_(network.parameters(), 5.0)
        optimiser.step()
        mean.update_parameters(network)
        means += [float(loss.detach()) for loss in losses]
        if (step + 1) % 50 == 0:
            told = "  ".join(f"{loss:.3f}" for loss in means / 50)
            print(f"step {step + 1} of {steps}  {spent_s + time.monotonic() - begun:.0f} s  {told}",
                  flush=True)  # fmt: skip
            means[:] = 0.0
        if time.monotonic() - saved > CHECKPOINT_S or step + 1 == steps:
            saved = time.monotonic()
            state = {
                "network": network.state_dict(),
                "mean": mean.state_dict(),
                "optimiser": optimiser.state_dict(),
                "mistakes": torch.tensor(tiles.mistakes, dtype=torch.float64).reshape(-1, 3),
                "done": step + 1,
                "spent_s": spent_s + saved - begun,
            }
            partial = checkpoint.with_suffix(".partial")
            torch.save(state, partial)
            partial.replace(checkpoint)
    averaged = mean.module
    assert isinstance(averaged, Network)
    return averaged


def main() -> None:
    """Train, export and write the card."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=Path, metavar="DATA")
    parser.add_argument("--out", required=True, type=Path, metavar="DIR")
    parser.add_argument("--steps", type=int, default=6000, help="batches to train on")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--start", type=Path, help="checkpoint of another training to begin with")
    parser.add_argument("--threads", type=int, default=1)
    given = parser.parse_args()
    torch.set_num_threads(given.threads)
    given.out.mkdir(parents=True, exist_ok=True)
    shots = [shot for folder in given.folders for shot in read_folder(folder)]
    bodies = sum(body.counts for shot in shots for body in shot.bodies)
    print(f"{len(shots)} pictures with {bodies} bodies", flush=True)
    mark = mark_of(contents(folder) for folder in given.folders)
    pictures = decoded(shots, given.out / f"pictures-{mark}.u8")
    tiles = Tiles(shots, pictures, given.seed)
    network = train(tiles, given.steps, given.out / "checkpoint.pt", given.seed, given.start)
    write_onnx(network, given.out / "detector.onnx")
    card = {
        "name": "AIRHILT embedded detector",
        "classes": list(CLASSES),
        "threshold": NOT_CALIBRATED,
        "input": "uint8 [1, rows, columns, 3], sRGB, rows and columns multiples of 16",
        "output": "float [1, 50, 6]: left, top, right, bottom, score, class",
        "parameters": sum(p.numel() for p in network.parameters()),
        "training": {
            "pictures": len(shots),
            "bodies": bodies,
            "steps": given.steps,
            "begun_with": given.start.name if given.start else None,
            "seed": given.seed,
        },
    }
    path = given.out / CARD
    path.write_text(json.dumps(card, indent=2) + "\n", encoding="utf-8")
    print(json.dumps(card, indent=2))
    print(f"{path} has no calibration yet: tools/detector/calibrate_detector.py makes one")


if __name__ == "__main__":
    main()
