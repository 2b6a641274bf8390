"""Trains the embedded recogniser on speech that `asr_speech` has made, and writes its ONNX file.

A TDNN-CTC network (temporal convolutions with residuals) whose units are the word pieces of
`learn_pieces`, so that it can write words that no training text has. Its inside has a step of
60 ms, which is cheap, and its output one of 30 ms, in which single letters fit. Speed, timbre,
rooms, noise and levels vary anew each time a call is seen (`mixing`). A share of the calls really
went through `airhilt.sensors.radio.channel` (`mel_shards`).

    python tools/asr/learn_pieces.py build/asr/pieces.txt
    python tools/asr/mel_shards.py build/asr/train
    python tools/asr/train_asr.py train build/asr --into build/asr/full --steps 36000
    python tools/asr/train_asr.py export build/asr/full airhilt/assistant/asr/model

Needs torch, which the package itself does not.
"""

from __future__ import annotations

import argparse
import json
import math
import shutil
import time
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import torch
from torch import Tensor, nn

from airhilt.assistant.asr.features import BINS
from airhilt.assistant.asr.pieces import Pieces
from batches import Batch, Batches
from mel_shards import load, noise_bank
from training import Training, add_options

STRIDE = 6
"""Frames of features to a step inside the network: 60 ms."""
OUTPUTS = 2
"""Steps of the output to one inside."""
WIDTH, NARROW, SQUEEZED = 288, 128, 32
DILATIONS = (1, 1, 2, 1, 2, 4, 1, 2, 1)
DROPPED = 0.1
"""Share of the channels of a block that a training step leaves out."""
AROUND = 16
"""Steps inside, on both sides of one, whose mean weighs its channels: a second."""
HALFWAY, HALFWAY_WEIGHT = 4, 0.3
"""Block after which the pieces are asked for too, and the weight of that loss (intermediate CTC:
Lee and Watanabe, ICASSP 2021)."""
LARGE = 10_000
"""Weights from which on a matrix is kept in half precision."""


class Convolution(nn.Module):
    """A convolution over time whose weights are a matrix, as `torch.optim.Muon` asks for."""

    def __init__(
        self, inputs: int, outputs: int, size: int, *, stride: int = 1, dilation: int = 1
    ) -> None:
        super().__init__()
        begin = nn.Conv1d(inputs, outputs, size)
        self.weight = nn.Parameter(begin.weight.detach().flatten(1))
        self.bias = nn.Parameter(begin.weight.new_zeros(outputs))
        self.size, self.stride, self.dilation = size, stride, dilation

    def forward(self, x: Tensor) -> Tensor:
        """Return (batch, outputs, frames / stride)."""
        weight = self.weight.unflatten(1, (-1, self.size))
        padding = self.dilation * (self.size // 2)
        return nn.functional.conv1d(x, weight, self.bias, self.stride, padding, self.dilation)


class Residual(nn.Module):
    """A convolution with a way round it, whose channels are weighed by what is around a step.

    Squeeze and excitation: Hu et al., CVPR 2018; for speech, with a window: Han et al.,
    Interspeech 2020.
    """

    def __init__(self, width: int, dilation: int) -> None:
        super().__init__()
        self.convolve = Convolution(width, width, 5, dilation=dilation)
        self.norm = nn.BatchNorm1d(width)
        self.squeeze = nn.Linear(width, SQUEEZED)
        self.excite = nn.Linear(SQUEEZED, width)
        self.drop = nn.Dropout1d(DROPPED)

    def forward(self, x: Tensor) -> Tensor:
        """Return the same shape."""
        y = torch.relu(self.norm(self.convolve(x)))
        around = nn.functional.avg_pool1d(
            y, 2 * AROUND + 1, 1, AROUND, count_include_pad=False
        ).transpose(1, 2)
        weights = torch.sigmoid(self.excite(torch.relu(self.squeeze(around))))
        return x + self.drop(y * weights.transpose(1, 2))


class Recogniser(nn.Module):
    """Log-mel features (batch, frames, bins) to logits (batch, frames / 3, pieces + 1)."""

    def __init__(self, pieces: int) -> None:
        super().__init__()
        self.front = nn.Sequential(
            Convolution(BINS, NARROW, 5, stride=2), nn.BatchNorm1d(NARROW), nn.ReLU(),
            Convolution(NARROW, WIDTH, 5, stride=3), nn.BatchNorm1d(WIDTH), nn.ReLU(),
        )  # fmt: skip
        blocks = [Residual(WIDTH, dilation) for dilation in DILATIONS]
        self.lower = nn.Sequential(*blocks[:HALFWAY])
        self.upper = nn.Sequential(*blocks[HALFWAY:])
        self.head = nn.Linear(WIDTH, OUTPUTS * (pieces + 1))

    def forward(self, features: Tensor) -> Tensor:
        """Return the logits."""
        return self.both(features)[1]

    def both(self, features: Tensor) -> tuple[Tensor, Tensor]:
        """Return the logits halfway and at the end."""
        halfway = self.lower(self.front(features.transpose(1, 2)))
        return self._logits(halfway), self._logits(self.upper(halfway))

    def _logits(self, x: Tensor) -> Tensor:
        """Return `OUTPUTS` steps of logits for each step inside."""
        steps = self.head(x.transpose(1, 2))
        return steps.reshape(steps.shape[0], -1, steps.shape[2] // OUTPUTS)


# --- training ------------------------------------------------------------------------------


def train(given: Training) -> None:
    """Train until the steps are done; write a checkpoint every few minutes."""
    torch.set_num_threads(1)
    given.into.mkdir(parents=True, exist_ok=True)
    shutil.copy((given.begin_with or given.build) / "pieces.txt", given.into / "pieces.txt")
    pieces = pieces_of(given.into)
    torch.manual_seed(given.seed)
    network = Recogniser(len(pieces))
    if given.begin_with is not None:
        begin_with(network, given.begin_with)
    network.to(given.device)
    optimisers = optimisers_of(network, given.rate, adamw=given.adamw)
    first, spent_s = _resume(network, optimisers, given.into / "checkpoint.pt")
    parameters = sum(p.numel() for p in network.parameters())
    calls = load(given.build / "train", pieces, given.without)
    if not len(calls.lengths):
        raise SystemExit(
            f"train_asr: {given.build / 'train'} has no prepared calls to train on; make shards "
            f"with asr_speech.py, and then: python tools/asr/mel_shards.py {given.build / 'train'}"
        )
    count = len(calls.lengths)
    print(f"{parameters / 1e6:.2f} M parameters, {len(pieces)} pieces, {count} calls", flush=True)
    batches = Batches(calls, noise_bank(), given.batch_frames, given.seed, given.device)
    is_new = given.begin_with is None
    begun = saved = time.time()
    before_s = spent_s
    mean = torch.tensor(8.0, device=given.device)
    network.train()
    done = first
    for step in range(first, given.steps):
        share = max(step / given.steps, spent_s / (60.0 * given.minutes))
        if share >= 1.0:
            break
        for optimiser in optimisers:
            for group in optimiser.param_groups:
                group["lr"] = _rate(given.rate, step, share)
        loss = _loss(network, batches.batch(step, share if is_new else 1.0), given)
        network.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        for optimiser in optimisers:
            optimiser.step()
        mean += 0.02 * (loss.detach() - mean)
        done, spent_s = step + 1, before_s + time.time() - begun
        if done % 100 == 0:
            each = (time.time() - begun) / (done - first)
            print(f"step {done}  {each:.3f} s each  loss {mean.item():.3f}", flush=True)
        if time.time() - saved > 240.0:
            saved = time.time()
            _save(network, optimisers, done, spent_s, given, count)
    _save(network, optimisers, done, spent_s, given, count)


def optimisers_of(network: Recogniser, rate: float, *, adamw: bool) -> list[torch.optim.Optimizer]:
    """Return the optimisers: Muon (Jordan 2024) of the matrices inside, AdamW of all else."""
    if adamw:
        return [torch.optim.AdamW(network.parameters(), lr=rate, weight_decay=0.01)]
    matrices: list[nn.Parameter] = []
    others: list[nn.Parameter] = []
    for name, weight in network.named_parameters():
        (matrices if weight.ndim == 2 and not name.startswith("head") else others).append(weight)
    return [
        torch.optim.Muon(matrices, lr=rate, weight_decay=0.05, adjust_lr_fn="match_rms_adamw"),
        torch.optim.AdamW(others, lr=rate, weight_decay=0.01),
    ]


def pieces_of(folder: Path) -> Pieces:
    """Return the pieces of a build folder or a model."""
    return Pieces((folder / "pieces.txt").read_text(encoding="utf-8").split())


def _rate(most: float, step: int, share: float) -> float:
    """Return the learning rate: a warm-up, then constant, then a cosine.

    Parameters
    ----------
    share
        Part of the training that is done.
    """
    decay = max(0.0, (share - 0.35) / 0.65)
    return most * min(1.0, (step + 1) / 300) * (0.5 * (1 + math.cos(math.pi * decay)) + 0.003)


def _loss(network: Recogniser, batch: Batch, given: Training) -> Tensor:
    with torch.autocast(given.device, dtype=torch.bfloat16, enabled=given.bfloat16):
        both = network.both(batch.features)
    units = batch.units.to(given.device)
    steps = OUTPUTS * -(-batch.lengths // STRIDE)
    halfway, end = (
        nn.functional.ctc_loss(
            logits.float().log_softmax(2).transpose(0, 1),
            units,
            steps,
            batch.sizes,
            zero_infinity=True,
        )
        for logits in both
    )
    return (1.0 - HALFWAY_WEIGHT) * end + HALFWAY_WEIGHT * halfway


def weights_of(folder: Path) -> dict[str, Tensor]:
    """Return the weights that `keep` has written."""
    with np.load(folder / "weights.npz", allow_pickle=False) as archive:
        return {name: torch.from_numpy(archive[name].astype(np.float32)) for name in archive.files}


def begin_with(network: Recogniser, folder: Path) -> None:
    """Give a network the weights that `keep` has written.

    Raises
    ------
    SystemExit
        They are those of another network.
    """
    weights = weights_of(folder)
    expected = {
        name: weight.shape
        for name, weight in network.state_dict().items()
        if weight.is_floating_point()
    }
    if expected != {name: weight.shape for name, weight in weights.items()}:
        raise SystemExit(
            f"train_asr: {folder} has weights of another network; expected those that "
            f"`train_asr.py keep` writes of this one, with {len(expected)} arrays"
        )
    network.load_state_dict(weights, strict=False)


def keep(folder: Path, target: Path) -> None:
    """Write the weights of a checkpoint in half precision, for other trainings to begin with."""
    state = _network_of(folder)
    arrays: dict[str, Any] = {
        name: weight.numpy().astype(np.float16)
        for name, weight in state.items()
        if weight.is_floating_point()
    }
    target.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(target / "weights.npz", **arrays)
    for name in ("pieces.txt", "training.json"):
        shutil.copy(folder / name, target / name)


def _resume(
    network: nn.Module, optimisers: list[torch.optim.Optimizer], path: Path
) -> tuple[int, float]:
    """Go on from a checkpoint; return the steps that are done and the seconds that they took."""
    if not path.exists():
        return 0, 0.0
    state = torch.load(path, weights_only=True, map_location="cpu")
    network.load_state_dict(state["network"])
    for optimiser, its_state in zip(optimisers, state["optimisers"], strict=True):
        optimiser.load_state_dict(its_state)
    print(f"goes on from step {state['step']}")
    return int(state["step"]), float(state["seconds"])


def _save(
    network: nn.Module,
    optimisers: list[torch.optim.Optimizer],
    step: int,
    seconds: float,
    given: Training,
    calls: int,
) -> None:
    state = {
        "network": network.state_dict(),
        "optimisers": [optimiser.state_dict() for optimiser in optimisers],
        "step": step,
        "seconds": seconds,
    }
    path = given.into / "checkpoint.tmp"
    torch.save(state, path)
    path.rename(given.into / "checkpoint.pt")
    card = {
        "made_by": "tools/asr/make_recogniser.py",
        "parameters": sum(p.numel() for p in network.parameters()),
        "calls": calls,
        "steps": step,
        "seconds": round(seconds),
        "batch_frames": given.batch_frames,
        "rate": given.rate,
        "seed": given.seed,
        "without": given.without,
        "begun_with": given.begin_with.name if given.begin_with else "",
    }
    (given.into / "training.json").write_text(json.dumps(card, indent=2) + "\n")


def _network_of(folder: Path) -> dict[str, Tensor]:
    """Return the network of a checkpoint."""
    state = torch.load(folder / "checkpoint.pt", weights_only=True, map_location="cpu")
    return dict(state["network"])


def export(folder: Path, target: Path) -> None:
    """Write the network as ONNX, with its pieces and a card that is not calibrated yet."""
    pieces = pieces_of(folder)
    network = Recogniser(len(pieces))
    network.load_state_dict(_network_of(folder))
    network.eval()
    target.mkdir(parents=True, exist_ok=True)
    torch.onnx.export(
        network, (torch.zeros(1, 120, BINS),), str(target / "ctc.onnx"), dynamo=False,
        input_names=["features"], output_names=["logits"],
        dynamic_axes={"features": {0: "batch", 1: "frames"}, "logits": {0: "batch", 1: "frames"}},
    )  # fmt: skip
    _halve(target / "ctc.onnx")
    shutil.copy(folder / "pieces.txt", target / "pieces.txt")
    card = json.loads((folder / "training.json").read_text()) | {
        "word_curve": {"posterior_slope": 0.3, "alternatives_slope": 0.4, "offset": -0.5},
        "lost_words": {"heard_slope": 0.5, "inserted_slope": 0.2, "offset": -1.0},
        "callsign_odds": {"offset": 0.8, "name": 1.4, "sign": 1.1, "loss": 0.45},
        "call_calibration": {"slope": 1.0, "offset": 0.0},
        "least_word_confidence": 0.0,
        "best_word_threshold": 0.0,
        "language_weight": 0.4,
        "piece_reward": 2.5,
    }
    (target / "card.json").write_text(json.dumps(card, indent=2) + "\n")


def _halve(path: Path) -> None:
    """Keep the large weights of an ONNX file in half precision, which a node turns back."""
    model = onnx.load(path)
    for place, weight in enumerate(model.graph.initializer):
        values = onnx.numpy_helper.to_array(weight)
        if values.dtype != np.float32 or values.size < LARGE:
            continue
        name, half = weight.name, f"{weight.name}.half"
        halved = onnx.numpy_helper.from_array(values.astype(np.float16), half)
        model.graph.initializer[place].CopyFrom(halved)
        turn = onnx.helper.make_node("Cast", [half], [name], to=onnx.TensorProto.FLOAT)
        model.graph.node.insert(0, turn)
    onnx.save(model, path)


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    training = commands.add_parser("train", help="train, from the checkpoint if there is one")
    training.add_argument("build", type=Path)
    training.add_argument("--into", type=Path, required=True, help="folder of the checkpoint")
    training.add_argument("--begin-with", type=Path, help="folder with weights to begin with")
    training.add_argument("--without", default="", help="lineage that is left out")
    add_options(training, steps=36_000)
    exporting = commands.add_parser("export", help="write the ONNX file")
    exporting.add_argument("folder", type=Path, help="folder of the checkpoint")
    exporting.add_argument("target", type=Path)
    keeping = commands.add_parser(
        "keep", help="write the weights for other trainings to begin with"
    )
    keeping.add_argument("folder", type=Path, help="folder of the checkpoint")
    keeping.add_argument("target", type=Path)
    given = vars(parser.parse_args())
    match given.pop("command"):
        case "train":
            train(Training(**given))
        case "export":
            export(**given)
        case "keep":
            keep(**given)


if __name__ == "__main__":
    main()
