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
import json
import math
import multiprocessing
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import torch
from torch import Tensor, nn
from torch.nn import functional

from airhilt.assistant.vision.detectors.embedded import CARD
from detector_data import CLASSES, read_folder
from detector_network import LIGHT, STRIDE, Network, write_onnx
from detector_scratch import contents, decoded, mark_of
from detector_start import begin_with, measure
from detector_tiles import ASKED, Tiles

RATE, WARM_UP, DECAY = 2e-3, 200, 1e-3
GONE_ON_RATE = 1e-3
"""Rate at which a network learns that has learnt before."""
BEFORE_ALL, MEASURED = 10_000_000, 12
"""Number of the first batch that an exported network is measured with, and how many there are."""
EMA = 0.999
ROUND = 2000
"""Batches after which the network is asked what it makes of some of the pictures."""
AHEAD = 3
"""Batches that are made before they are needed."""
LONGEST_S = 600.0
"""Longest time to wait for a batch, in s."""
CHECKPOINT_S = 120.0
WORTH = (2.0, 0.5, 0.5)
"""Weights of the losses of scores, places and overlaps."""
NOT_CALIBRATED = 1.0
"""The threshold in a card, until tools/detector/calibrate_detector.py chooses one."""


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


def followed(mean: Tensor, now: Tensor, count: Tensor | int) -> Tensor:
    """Return a running mean that follows fast at first."""
    return mean + (now - mean) * max(1.0 - EMA, 10.0 / (10.0 + float(count)))


def seen_as(pictures: Tensor) -> Tensor:
    """Return pictures, shape (n, rows, columns, 3), as the network takes them."""
    return pictures.permute(0, 3, 1, 2).float().contiguous(memory_format=torch.channels_last)


def begun(tiles: Tiles, start: Path) -> Network:
    """Return a network that does what an exported one did, and can learn."""
    network = Network()
    others = begin_with(network, start)
    norm = network.stem_norm[0]
    assert isinstance(norm, nn.BatchNorm2d)
    with torch.no_grad():
        network.stem.weight.copy_(others["first"] * LIGHT)
        norm.bias.copy_(others["stem_local.bias"])
    measured = (tiles.batch(BEFORE_ALL + number)[0] for number in range(MEASURED))
    measure(network, ((seen_as(torch.from_numpy(pictures)),) for pictures in measured))
    return network


def rate_at(step: int, steps: int, highest: float) -> float:
    """Return the learning rate: a warm-up, then a cosine."""
    rate = highest * min((step + 1) / WARM_UP, 0.5 + 0.5 * math.cos(math.pi * step / steps))
    return max(rate, 1e-5)


def optimiser_of(network: Network) -> torch.optim.Optimizer:
    """Return the optimiser; only weights of several dimensions decay."""
    scaled = [p for p in network.parameters() if p.ndim > 1]
    others = [p for p in network.parameters() if p.ndim <= 1]
    return torch.optim.AdamW(
        [{"params": scaled, "weight_decay": DECAY}, {"params": others, "weight_decay": 0.0}], RATE
    )


def resume(
    checkpoint: Path, network: nn.Module, mean: nn.Module, optimiser: torch.optim.Optimizer
) -> dict[str, Any]:
    """Go on from a checkpoint, and return what it has besides networks and optimiser."""
    kept: dict[str, Any] = torch.load(checkpoint, weights_only=True)
    network.load_state_dict(kept.pop("network"))
    mean.load_state_dict(kept.pop("mean"))
    optimiser.load_state_dict(kept.pop("optimiser"))
    print(f"goes on at step {kept['done']}", flush=True)
    return kept


def save(
    checkpoint: Path,
    network: nn.Module,
    mean: nn.Module,
    optimiser: torch.optim.Optimizer,
    state: dict[str, Any],
) -> None:
    """Write a checkpoint of networks, optimiser and the state of the training."""
    partial = checkpoint.with_suffix(".partial")
    networks = {"network": network.state_dict(), "mean": mean.state_dict()}
    torch.save({**networks, "optimiser": optimiser.state_dict(), **state}, partial)
    partial.replace(checkpoint)


def train(
    tiles: Tiles, steps: int, checkpoint: Path, seed: int, start: Path | None = None
) -> Network:
    """Return the mean network of the last part of the training."""
    torch.manual_seed(seed)
    network = Network() if start is None else begun(tiles, start)
    network.to(memory_format=torch.channels_last)
    mean = torch.optim.swa_utils.AveragedModel(network, avg_fn=followed, use_buffers=True)
    optimiser = optimiser_of(network)
    done, spent_s = 0, 0.0
    if checkpoint.is_file():
        kept = resume(checkpoint, network, mean, optimiser)
        done, spent_s = kept["done"], kept["spent_s"]
        tiles.mistakes = [(int(index), x, y) for index, x, y in kept["mistakes"].tolist()]
    highest = RATE if start is None else GONE_ON_RATE
    begun_s = saved = time.monotonic()
    means = np.zeros(3)
    network.train()
    for step, (pictures, *maps) in rounds(tiles, mean, done, steps):
        for group in optimiser.param_groups:
            group["lr"] = rate_at(step, steps, highest)
        scores, boxes = network(seen_as(pictures))
        losses = loss_of(scores, boxes, *maps)
        optimiser.zero_grad(set_to_none=True)
        sum(worth * loss for worth, loss in zip(WORTH, losses, strict=True)).backward()
        nn.utils.clip_grad_norm_(network.parameters(), 5.0)
        optimiser.step()
        mean.update_parameters(network)
        means += [float(loss.detach()) for loss in losses]
        if (step + 1) % 50 == 0:
            told = "  ".join(f"{loss:.3f}" for loss in means / 50)
            spent = spent_s + time.monotonic() - begun_s
            print(f"step {step + 1} of {steps}  {spent:.0f} s  {told}", flush=True)
            means[:] = 0.0
        if time.monotonic() - saved > CHECKPOINT_S or step + 1 == steps:
            saved = time.monotonic()
            state = {
                "mistakes": torch.tensor(tiles.mistakes, dtype=torch.float64).reshape(-1, 3),
                "done": step + 1,
                "spent_s": spent_s + saved - begun_s,
            }
            save(checkpoint, network, mean, optimiser, state)
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
    parser.add_argument("--start", type=Path, metavar="FILE", help="exported network to go on from")
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
