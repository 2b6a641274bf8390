"""Train the refiner of the detector that ships with AIRHILT, and write it as ONNX.

    python tools/detector/train_refiner.py data/train1 data/train2 \
        --network detector/detector.onnx --scratch places

``tools/detector/train_detector.py`` makes the network that sees a whole picture. Here it is asked
what it makes of pictures; whether a body of `airhilt dataset export` is at each place that it
names is known, and that is what the second network learns to tell, with the body's class and box
(see `airhilt.assistant.vision.refiner`). Of what is nothing it is shown most often what it has
taken for something. Places on bodies that can hardly be seen teach nothing.

Every second picture is disturbed, as the first network's were (see `detector_disturbances`).

It is written beside the first network, as ``refiner.onnx``, and into the card there. Pictures
are kept decoded beside the answers of the first network in ``SCRATCH/<folder>-<mark>.u8`` and
``SCRATCH/<folder>-<mark>.npz``, where the mark changes with what they are made of. A checkpoint
is written every few minutes; the same command goes on from it, also with more folders.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn import functional

from airhilt.assistant.vision.detectors.embedded import CARD
from airhilt.assistant.vision.refiner import VIEW_PX
from detector_data import CLASSES
from detector_lessons import Lessons
from detector_network import convolution
from detector_places import places_of
from detector_start import begin_with, measure
from train_detector import (
    BEFORE_ALL,
    GONE_ON_RATE,
    MEASURED,
    NOT_CALIBRATED,
    batches,
    followed,
    rate_at,
    resume,
    save,
)

FILE = "refiner.onnx"
USED_FROM, USED = 0.15, 8
"""Least first score of a place that is looked at again, and most such places in a picture."""
WIDTHS = (16, 48, 64)
NEAR_BLOCKS, WIDE_BLOCKS = (1, 2), (0, 1)
"""At half and a quarter of the resolution."""
LAST = 128
RATE, DECAY = 2e-3, 1e-2
BOX_WORTH = 1.0
ROUND = 250
"""Batches after which hard places are chosen anew."""
CHECKPOINT_S = 120.0


# --- the network --------------------------------------------------------------------------


class Block(nn.Module):
    """Two convolutions past which the input goes too."""

    def __init__(self, width: int) -> None:
        super().__init__()
        self.body = nn.Sequential(convolution(width, width), convolution(width, width))

    def forward(self, features: Tensor) -> Tensor:
        """Return as many features."""
        return features + self.body(features)


def tower(blocks: tuple[int, int]) -> nn.Sequential:
    """Return what makes features of a view."""
    fine, coarse, last = WIDTHS
    return nn.Sequential(
        convolution(4, fine, step=2, size=5),
        *(Block(fine) for _ in range(blocks[0])),
        convolution(fine, coarse, 2),
        *(Block(coarse) for _ in range(blocks[1])),
        convolution(coarse, last, 2),
        nn.Flatten(),
    )


class Network(nn.Module):
    """From views, and what is known besides, to logits and moves of boxes.

    The first logit is that of nothing. To the colours of a view goes how much each pixel differs
    from the mean, in parts of how much all do.
    """

    def __init__(self) -> None:
        super().__init__()
        self.near, self.wide = tower(NEAR_BLOCKS), tower(WIDE_BLOCKS)
        self.joined = nn.Sequential(
            nn.Linear(2 * (VIEW_PX // 8) ** 2 * WIDTHS[-1] + 3, LAST),
            nn.ReLU(inplace=True),
            nn.Dropout(0.1),
        )
        self.last = nn.Linear(LAST, 1 + len(CLASSES) + 4)
        nn.init.normal_(self.last.weight, std=0.01)
        nn.init.zeros_(self.last.bias)

    def forward(self, views: Tensor, known: Tensor) -> tuple[Tensor, Tensor]:
        """Return logits, shape (n, 1 + classes), and moves, shape (n, 4)."""
        pixels = views.permute(0, 1, 4, 2, 3).float() * (1.0 / 255.0)
        grey = pixels.mean(dim=2, keepdim=True)
        away = grey - grey.mean(dim=(3, 4), keepdim=True)
        spread = (away * away).mean(dim=(3, 4), keepdim=True).sqrt() + 0.02
        seen = torch.cat((pixels - 0.5, away / spread), dim=2)
        features = (self.near(seen[:, 0]), self.wide(seen[:, 1]), known)
        out = self.last(self.joined(torch.cat(features, dim=1)))
        return out[:, : 1 + len(CLASSES)], out[:, 1 + len(CLASSES) :]


class Exported(nn.Module):
    """The exported network: probabilities in place of logits."""

    def __init__(self, network: Network) -> None:
        super().__init__()
        self.network = network

    def forward(self, views: Tensor, known: Tensor) -> tuple[Tensor, Tensor]:
        """Return chances and moves."""
        logits, moves = self.network(views, known)
        return logits.softmax(dim=1), moves


def write_onnx(network: Network, path: Path) -> None:
    """Write a network for any number of places."""
    example = torch.zeros((2, 2, VIEW_PX, VIEW_PX, 3), dtype=torch.uint8), torch.zeros((2, 3))
    torch.onnx.export(
        Exported(network).eval(),
        example,
        str(path),
        input_names=["views", "about"],
        output_names=["chances", "moves"],
        dynamic_axes={name: {0: "n"} for name in ("views", "about", "chances", "moves")},
        opset_version=17,
        dynamo=False,
    )


# --- training -----------------------------------------------------------------------------


def begun(lessons: Lessons, start: Path) -> Network:
    """Return a network that does what an exported one did, and can learn."""
    network = Network()
    begin_with(network, start)
    batches = (lessons.batch(BEFORE_ALL + number) for number in range(MEASURED))
    measure(network, (tuple(map(torch.from_numpy, batch[1:3])) for batch in batches))
    return network


def learn(
    network: Network,
    optimiser: torch.optim.Optimizer,
    lessons: Lessons,
    batch: tuple[Tensor, ...],
) -> tuple[float, float, float]:
    """Learn from a batch; return the losses of kinds and of places, and the share that is right.

    The lessons are told which places with nothing were taken for something.
    """
    numbers, views, known, labels, wanted = batch
    logits, moves = network(views, known)
    kinds = functional.cross_entropy(logits, labels)
    bodies = labels > 0
    places = functional.smooth_l1_loss(moves[bodies], wanted[bodies], beta=0.1)
    optimiser.zero_grad(set_to_none=True)
    (kinds + BOX_WORTH * places).backward()
    nn.utils.clip_grad_norm_(network.parameters(), 5.0)
    optimiser.step()
    with torch.no_grad():
        something = 1.0 - logits.softmax(dim=1)[:, 0]
        nothing = numbers >= 0
        taken = numbers[nothing].numpy()
        lessons.fooled[taken] = 0.5 * (lessons.fooled[taken] + something[nothing].numpy())
        right = (logits.argmax(dim=1) == labels).float().mean()
    return float(kinds.detach()), float(places.detach()), float(right)


def train(
    lessons: Lessons, steps: int, checkpoint: Path, seed: int, start: Path | None = None
) -> tuple[Network, list[dict[str, int]]]:
    """Return the mean network of the last part of the training, and how the training went.

    The account of the training has a row for each time that it was gone on with: from which step,
    up to which it was planned, and on how many places and bodies.
    """
    torch.manual_seed(seed)
    network = Network() if start is None else begun(lessons, start)
    network.to(memory_format=torch.channels_last)
    highest = RATE if start is None else GONE_ON_RATE
    mean = torch.optim.swa_utils.AveragedModel(network, avg_fn=followed, use_buffers=True)
    optimiser = torch.optim.AdamW(network.parameters(), RATE, weight_decay=DECAY)
    done, spent_s = 0, 0.0
    stages: list[dict[str, int]] = []
    if checkpoint.is_file():
        kept = resume(checkpoint, network, mean, optimiser)
        done, spent_s, stages = kept["done"], kept["spent_s"], kept["stages"]
        if len(kept["fooled"]) == len(lessons.fooled):
            lessons.fooled = kept["fooled"].numpy()
    if done < steps:
        counts = {"places": len(lessons), "bodies": lessons.bodies}
        stages = [*stages, {"from_step": done, "planned_steps": steps, **counts}]
    begun_s = saved = time.monotonic()
    told = np.zeros(3)
    network.train()
    while done < steps:
        end = min(done + ROUND - done % ROUND, steps)
        for batch in batches(lessons.batch, done, end):
            for group in optimiser.param_groups:
                group["lr"] = rate_at(done, steps, highest)
            told += learn(network, optimiser, lessons, batch)
            mean.update_parameters(network)
            done += 1
            if done % 50 == 0:
                now = "  ".join(f"{value:.4f}" for value in told / 50)
                spent = spent_s + time.monotonic() - begun_s
                print(f"step {done} of {steps}  {spent:.0f} s  {now}", flush=True)
                told[:] = 0.0
        if time.monotonic() - saved > CHECKPOINT_S or done == steps:
            saved = time.monotonic()
            state = {
                "fooled": torch.from_numpy(lessons.fooled),
                "done": done,
                "stages": stages,
                "spent_s": spent_s + saved - begun_s,
            }
            save(checkpoint, network, mean, optimiser, state)
    averaged = mean.module
    assert isinstance(averaged, Network)
    return averaged, stages


def main() -> None:
    """Train, export and write into the card."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=Path, metavar="DATA")
    parser.add_argument("--network", required=True, type=Path, metavar="FILE")
    parser.add_argument("--scratch", required=True, type=Path, metavar="DIR")
    parser.add_argument("--steps", type=int, default=12_000, help="batches to train on")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--start", type=Path, metavar="FILE", help="exported network to go on from")
    parser.add_argument("--threads", type=int, default=1)
    given = parser.parse_args()
    torch.set_num_threads(given.threads)
    given.scratch.mkdir(parents=True, exist_ok=True)
    folders = [
        places_of(folder, given.network, given.scratch, given.seed) for folder in given.folders
    ]
    lessons = Lessons(folders, given.seed)
    print(f"{len(lessons)} places, {lessons.bodies} of them bodies", flush=True)
    checkpoint = given.scratch / "refiner.pt"
    network, stages = train(lessons, given.steps, checkpoint, given.seed, given.start)
    write_onnx(network, given.network.with_name(FILE))
    path = given.network.with_name(CARD)
    card = json.loads(path.read_text(encoding="utf-8"))
    for stale in ("calibration", "false_a_minute", "counted_minutes"):
        card.pop(stale, None)
    card["threshold"] = NOT_CALIBRATED
    card["refiner"] = {
        "file": FILE,
        "least_score": USED_FROM,
        "most": USED,
        "parameters": sum(p.numel() for p in network.parameters()),
        "training": {
            "pictures": sum(len(each.pictures) for each in folders),
            "begun_with": given.start.name if given.start else None,
            "stages": stages,
            "seed": given.seed,
        },
    }
    path.write_text(json.dumps(card, indent=2) + "\n", encoding="utf-8")
    print(json.dumps(card["refiner"], indent=2))
    print(f"{path} has no calibration now: tools/detector/calibrate_detector.py makes one")


if __name__ == "__main__":
    main()
