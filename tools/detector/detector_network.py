"""The network that sees a whole picture, and how it is written as ONNX."""

from __future__ import annotations

import copy
import math
from pathlib import Path

import torch
from torch import Tensor, nn
from torch.nn import functional

from detector_data import CLASSES

STEM_STRIDE, STRIDE = 4, 8
"""Strides of the first convolution and of the maps, in pixels."""
FOUND = 50
"""Bodies that are looked for in a picture, at most."""
WIDTHS, BLOCKS = (16, 48, 64, 64), (1, 1, 3)
LIGHT = 64.0
"""Levels are taken in such parts."""
FAINT_LEVELS = 12.0
"""Differences from the surroundings above it count less and less."""
ROUGH = 1.5
"""Weight of the deviation around, beside those levels."""
PRIOR = 0.005
"""Score of everything before training."""


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
        fine, middle, coarse, last = widths
        self.stem = nn.Conv2d(3, fine, 6, STEM_STRIDE, 1, bias=False)
        self.stem_local = nn.Conv2d(1, fine, 6, STEM_STRIDE, 1, bias=False)
        self.stem_norm = nn.Sequential(nn.BatchNorm2d(fine), nn.ReLU(inplace=True))
        self.fine = nn.Sequential(*(Block(fine, 16) for _ in range(blocks[0])))
        self.middle = nn.Sequential(
            convolution(fine, middle, 2),
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
        light = functional.conv2d(pictures, self.stem.weight / LIGHT, None, STEM_STRIDE, 1)
        fine = self.fine(self.stem_norm(light + self.stem_local(_local(pictures))))
        middle = self.middle(fine)
        middle = middle + _enlarged(self.to_middle(self.coarse(middle)), 2)
        maps = self.maps(self.head(middle))
        return maps[:, : len(CLASSES)], maps[:, len(CLASSES) :]


def _local(pictures: Tensor) -> Tensor:
    """Return by how much each pixel differs from what is around it, from -1 to 1.

    It is in parts of some levels and of how much all differs around, so that texture does not
    drown what stands out of it.
    """
    red, green, blue = pictures.split(1, dim=1)
    grey = (red + green + blue) * (1.0 / (3.0 * FAINT_LEVELS))
    away = grey - _enlarged(_around(grey, 3), 8)
    deviation = (_around(away * away, 5) + 1e-6).sqrt()
    return (away / (1.0 + ROUGH * _enlarged(deviation, 8))).tanh()


def _around(features: Tensor, cells: int) -> Tensor:
    """Return means over so many cells of 8 by 8 pixels, one for each cell."""
    pooled = functional.avg_pool2d(features, 8)
    return functional.avg_pool2d(pooled, cells, 1, cells // 2, False, False)


def _enlarged(features: Tensor, factor: int) -> Tensor:
    return functional.interpolate(features, scale_factor=float(factor), mode="nearest")


class Detector(nn.Module):
    """The exported network: a picture in, boxes out."""

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
