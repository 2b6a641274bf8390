"""Trains the embedded recogniser on speech that `asr_speech` has made, and writes its ONNX file.

A TDNN-CTC network (temporal convolutions with residuals) whose units are the word pieces of
`learn_pieces`, so that it can write words that no training text has. Its inside has a step of
60 ms, which is cheap, and its output one of 30 ms, in which single letters fit. Noise and levels
vary anew each time an utterance is seen: they are mixed as mel powers, which costs next to nothing.
A share of the calls really went through `airhilt.sensors.radio.channel`.

    python tools/asr/learn_pieces.py build/asr/pieces.txt
    python tools/asr/train_asr.py prepare build/asr/train     (as often as there are new shards)
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
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import onnx
import torch
from torch import Tensor, nn
from torch.utils.data import DataLoader, Dataset

from airhilt.assistant.asr.features import BINS, FLOOR, mel_power, normalised
from airhilt.assistant.asr.pieces import Pieces
from airhilt.scenario.radio_profiles import PROFILES
from airhilt.sensors.radio.channel import VhfChannel
from synthesisers import FAMILY

STRIDE = 6
"""Frames of features to a step inside the network: 60 ms."""
OUTPUTS = 2
"""Steps of the output to one inside."""
WIDTH, NARROW, SQUEEZED = 256, 128, 32
DILATIONS = (1, 1, 2, 1, 2, 4, 1, 2)
AROUND = 16
"""Steps inside, on both sides of one, whose mean weighs its channels: a second."""
HALFWAY, HALFWAY_WEIGHT = 4, 0.3
"""Block after which the pieces are asked for too, and the weight of that loss (intermediate CTC:
Lee and Watanabe, ICASSP 2021)."""
NEIGHBOURS = 0.02
"""Share of the utterances, those of about one length, that a batch is drawn from."""
EASY_FRAMES = 450
"""Frames of the longest call that is easy."""
SILENT_SHARE = 0.3
"""Share of the batches with a call in which nobody speaks."""
EASY_SHARE, CLEAR_SHARE = 0.06, 0.3
"""Shares of the steps at the beginning in which only short, clear calls are drawn, and in which no
call has much noise, unless a training begins with weights."""
LARGE = 10_000
"""Weights from which on a matrix is kept in half precision."""
REAL_SHARE = 0.25
"""Share of the utterances that `prepare` also sends through the real channel, with noise."""


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
        self.drop = nn.Dropout1d(0.05)

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


# --- data ----------------------------------------------------------------------------------


def prepare(folder: Path) -> None:
    """Turn shards of speech into shards of mel powers, those that are not yet."""
    profiles = [
        PROFILES[name] for name in ("vhf", "vhf", "vhf_833", "fading", "noisy_cockpit", "line")
    ]
    for path in sorted(folder.glob("*.jsonl"), reverse=True):
        target = folder / f"{path.stem}.mel.npz"
        if target.exists() or not path.with_suffix(".npy").exists():
            continue
        begun = time.time()
        rng = np.random.default_rng(zlib.crc32(path.stem.encode()))
        samples = np.load(path.with_suffix(".npy"), mmap_mode="r")
        clean, real, lengths, real_of, at = [], [], [], [], 0
        for index, line in enumerate(path.read_text().splitlines()):
            size = json.loads(line)["samples"]
            speech = _trimmed(np.asarray(samples[at : at + size], np.float32) / 32767.0, rng)
            at += size
            background = str(rng.choice(["cockpit", "cockpit", "tower", "none"]))
            channel = VhfChannel(profiles[rng.integers(len(profiles))])
            signal = channel.parts(speech, None, rng, (), background).signal  # type: ignore[arg-type]
            power = mel_power(signal)
            clean.append(np.log(power + FLOOR).astype(np.float16))
            lengths.append(len(power))
            if rng.random() < REAL_SHARE:
                heard = channel.transmit(speech, float(rng.uniform(-3, 30)), rng, (), background)  # type: ignore[arg-type]
                power = mel_power(heard)
                real.append(np.log(power + FLOOR).astype(np.float16))
                real_of.append((index, len(power)))
        np.savez(
            folder / f"{path.stem}.tmp.npz",
            clean=np.concatenate(clean), lengths=np.array(lengths),
            real=np.concatenate(real), real_of=np.array(real_of),
        )  # fmt: skip
        (folder / f"{path.stem}.tmp.npz").rename(target)
        print(f"{target.name} {time.time() - begun:.0f} s", flush=True)


def _trimmed(speech: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return speech with silence of random length at both ends instead of the engine's own."""
    loud = np.flatnonzero(np.abs(speech) > 0.01 * np.abs(speech).max())
    speech = speech[loud[0] : loud[-1] + 1] if len(loud) else speech
    before, after = rng.integers(0, 6_000, 2)
    return np.pad(speech, (before, after))


@dataclass
class Utterance:
    """One call as mel powers, clean or as it was received."""

    mel: np.ndarray
    units: Sequence[int]
    real: bool


def load(folder: Path, pieces: Pieces, without: str) -> list[Utterance]:
    """Return the utterances of the prepared shards of a folder.

    Parameters
    ----------
    without
        Lineage that is left out, with all other voices of its speakers; empty for none.
    """
    left_out = speakers_of(without)
    found = []
    for path in sorted(folder.glob("*.mel.npz")):
        lines = [json.loads(line) for line in _lines(path)]
        texts = [pieces.units(line["text"].split()) for line in lines]
        is_kept = [
            text is not None and line["lineage"] != without and line["speaker"] not in left_out
            for text, line in zip(texts, lines, strict=True)
        ]
        with np.load(path) as shard:
            at, clean = 0, shard["clean"]
            for index, size in enumerate(shard["lengths"]):
                if is_kept[index]:
                    mel = clean[at : at + size].copy()
                    found.append(Utterance(mel, texts[index] or (), False))
                at += size
            at, real = 0, shard["real"]
            for index, size in shard["real_of"]:
                if is_kept[index]:
                    found.append(Utterance(real[at : at + size].copy(), texts[index] or (), True))
                at += size
    return found


def speakers_of(lineage: str) -> set[str]:
    """Return the persons whose voices a lineage has."""
    voices = (voice for name in FAMILY.names() for voice in FAMILY.load(name).voices)
    return {voice.speaker for voice in voices if voice.lineage == lineage}


def noise_bank() -> np.ndarray:
    """Return mel powers of a receiver's noise, of power one within the band, per profile."""
    rng = np.random.default_rng(1)
    bank = []
    silence = np.zeros(16_000 * 20, np.float32)
    for name in ("vhf", "vhf_833", "vhf"):
        parts = VhfChannel(PROFILES[name]).parts(silence, 0.0, rng)
        bank.append(mel_power(parts.noise) / float(np.mean(parts.noise**2)))
    return np.stack(bank)


class Mixer:
    """Makes what the network sees out of clean mel powers: speed, timbre, noise, gain control."""

    def __init__(self, bank: np.ndarray, rng: np.random.Generator) -> None:
        self._bank = bank
        self._rng = rng

    def mix(self, utterance: Utterance, easy: bool, clear: bool) -> np.ndarray:
        """Return the features of a call as they may be.

        Parameters
        ----------
        easy
            Whether it is neither warped nor masked, nor has much noise.
        clear
            Whether it has not much noise.
        """
        rng = self._rng
        log = utterance.mel.astype(np.float32)
        if utterance.real:
            return self._masked(normalised(np.exp(log)), easy)
        if not easy:
            log = self._warped(log)
        power = np.exp(log)
        kind = rng.random()
        if easy or clear:
            snr_db = rng.uniform(12, 35)
        elif kind < 0.55:
            snr_db = rng.uniform(-4, 14)
        else:
            snr_db = rng.uniform(14, 40) if kind < 0.9 else np.inf
        noise = self._bank[rng.integers(len(self._bank))]
        start = rng.integers(0, len(noise) - 1)
        noise = np.take(noise, np.arange(start, start + len(power)), axis=0, mode="wrap")
        power = power + noise * (0.01 / 10.0 ** (snr_db / 10.0))
        if not easy and rng.random() < 0.7:
            level = power.sum(axis=1)
            kernel = np.exp(-np.arange(50) / 16.0)
            level = np.convolve(level, kernel / kernel.sum())[: len(level)]
            power = power * (level / level.mean() + 1e-3)[:, None] ** -rng.uniform(0.2, 0.7)
        return self._masked(normalised(power), easy)

    def _warped(self, log: np.ndarray) -> np.ndarray:
        rng = self._rng
        if rng.random() < 0.7:
            size = max(8, round(len(log) / rng.uniform(0.85, 1.2)))
            at = np.linspace(0, len(log) - 1, size)
            low = at.astype(int)
            high = np.minimum(low + 1, len(log) - 1)
            part = (at - low)[:, None].astype(np.float32)
            log = log[low] * (1 - part) + log[high] * part
        if rng.random() < 0.7:
            at = np.clip(
                np.arange(BINS) * rng.uniform(0.9, 1.12) + rng.uniform(-1.5, 1.5), 0, BINS - 1.001
            )
            low = at.astype(int)
            part = (at - low)[None, :].astype(np.float32)
            log = log[:, low] * (1 - part) + log[:, low + 1] * part
        return log

    def _masked(self, log: np.ndarray, easy: bool) -> np.ndarray:
        rng = self._rng
        if not easy:
            for _ in range(rng.integers(0, 3)):
                begin, size = rng.integers(0, BINS), rng.integers(1, 8)
                log[:, begin : begin + size] = 0.0
            for _ in range(rng.integers(0, 3)):
                begin, size = rng.integers(0, len(log)), rng.integers(1, 10)
                log[begin : begin + size] = 0.0
        return log

    def noise_alone(self) -> np.ndarray:
        """Return the features of an open channel on which nobody speaks."""
        rng = self._rng
        noise = self._bank[rng.integers(len(self._bank))]
        start, size = rng.integers(0, 1_000), rng.integers(30, 500)
        log: np.ndarray = np.log(noise[start : start + size] * 10.0 ** rng.uniform(-6, -1) + FLOOR)
        log -= log.mean(axis=0)
        return log


class Batch(NamedTuple):
    """Calls of about one length, and what is said in them."""

    features: Tensor
    """Shape (calls, frames, bins); calls that are shorter end with zeros."""
    units: Tensor
    """Units of all calls, one after another."""
    steps: Tensor
    """Steps of the output of each call."""
    sizes: Tensor
    """Number of units of each call."""


class Batches(Dataset[Batch]):
    """The batches of a training: each follows from the seed and its step alone.

    Any process may therefore make it, and a training that goes on sees what it would have seen.

    Parameters
    ----------
    easy, clear
        Steps before which only short, clear calls are drawn, and no call has much noise.
    """

    def __init__(
        self, utterances: Sequence[Utterance], frames: int, seed: int, easy: float, clear: float
    ) -> None:
        self._all = sorted(utterances, key=lambda each: len(each.mel))
        short = [each for each in self._all if len(each.mel) < EASY_FRAMES and not each.real]
        self._easy = short or self._all
        self._ends = [
            np.cumsum([len(each.mel) for each in some]) for some in (self._all, self._easy)
        ]
        self._frames, self._seed = frames, seed
        self._easy_steps, self._clear_steps = easy, clear
        self._bank = noise_bank()

    def __getitem__(self, step: int) -> Batch:
        """Return the batch of a step.

        A call is drawn by the chance of its length, and with it others of about that length: as
        many as fill the batch. So each call is drawn as often as any other.
        """
        rng = np.random.default_rng([self._seed, step])
        easy = step < self._easy_steps
        drawn_from, ends = (self._easy if easy else self._all), self._ends[easy]
        middle = int(np.searchsorted(ends, rng.integers(ends[-1]), side="right"))
        count = max(1, self._frames // len(drawn_from[middle].mel))
        around = max(count, round(NEIGHBOURS * len(drawn_from)))
        begin = min(max(0, middle - around // 2), max(0, len(drawn_from) - around))
        near = drawn_from[begin : begin + around]
        drawn = [near[index] for index in rng.permutation(len(near))[:count]]
        mixer = Mixer(self._bank, rng)
        inputs = [mixer.mix(each, easy, step < self._clear_steps) for each in drawn]
        targets = [each.units for each in drawn]
        if not easy and rng.random() < SILENT_SHARE:
            inputs.append(mixer.noise_alone())
            targets.append(())
        return _as_batch(inputs, targets)


def _as_batch(inputs: Sequence[np.ndarray], targets: Sequence[Sequence[int]]) -> Batch:
    longest = -(-max(len(mixed) for mixed in inputs) // 48) * 48
    features = torch.zeros(len(inputs), longest, BINS)
    for row, mixed in enumerate(inputs):
        features[row, : len(mixed)] = torch.from_numpy(mixed)
    return Batch(
        features,
        torch.tensor([unit for target in targets for unit in target]),
        torch.tensor([OUTPUTS * -(-len(mixed) // STRIDE) for mixed in inputs]),
        torch.tensor([len(target) for target in targets]),
    )


# --- training ------------------------------------------------------------------------------


@dataclass(frozen=True)
class Training:
    """Settings of a training.

    Attributes
    ----------
    build
        Folder with ``pieces.txt`` and the prepared shards in ``train``.
    into
        Folder of the checkpoint; a training goes on from the one that is there.
    batch_frames
        Frames of a batch, about.
    without
        Lineage that is left out; empty for none.
    begin_with
        Folder of `keep` whose weights a new training begins with; None: random ones.
    bfloat16
        Whether convolutions are computed in bfloat16, which accelerators and processors with
        AVX512-BF16 do faster.
    device
        Device of torch: ``cpu`` or ``cuda``. On an accelerator, the same seed gives weights that
        differ a little from run to run, because it sums in another order each time.
    workers
        Processes that mix batches; 0: the training does it itself.
    adamw
        Whether AdamW trains all weights, instead of Muon the matrices inside. Muon computes in
        bfloat16, with which a step takes 12 s on a processor that does not know it.
    """

    build: Path
    into: Path
    steps: int
    rate: float = 1.5e-3
    seed: int = 0
    batch_frames: int = 12_000
    without: str = ""
    begin_with: Path | None = None
    bfloat16: bool = False
    device: str = "cpu"
    workers: int = 0
    adamw: bool = False


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
    first = _resume(network, optimisers, given.into / "checkpoint.pt")
    parameters = sum(p.numel() for p in network.parameters())
    utterances = load(given.build / "train", pieces, given.without)
    print(f"{parameters / 1e6:.2f} M parameters, {len(pieces)} pieces, {len(utterances)} calls")
    new = given.steps if given.begin_with is None else 0
    batches = Batches(
        utterances, given.batch_frames, given.seed, EASY_SHARE * new, CLEAR_SHARE * new
    )
    loader = DataLoader(
        batches, batch_size=None, sampler=range(first, given.steps), num_workers=given.workers
    )
    begun = saved = time.time()
    mean = torch.tensor(8.0, device=given.device)
    network.train()
    for step, batch in enumerate(loader, start=first):
        for optimiser in optimisers:
            for group in optimiser.param_groups:
                group["lr"] = _rate(given.rate, step, given.steps)
        loss = _loss(network, batch, given)
        network.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        for optimiser in optimisers:
            optimiser.step()
        mean += 0.02 * (loss.detach() - mean)
        done = step + 1
        if done % 100 == 0:
            each = (time.time() - begun) / (done - first)
            print(f"step {done}  {each:.3f} s each  loss {mean.item():.3f}", flush=True)
        if time.time() - saved > 240.0:
            saved = time.time()
            _save(network, optimisers, done, given, len(utterances))
    _save(network, optimisers, max(first, given.steps), given, len(utterances))


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


def _rate(most: float, step: int, steps: int) -> float:
    """Return the learning rate: a warm-up, then constant, then a cosine."""
    decay = max(0.0, (step / steps - 0.35) / 0.65)
    return most * min(1.0, (step + 1) / 300) * (0.5 * (1 + math.cos(math.pi * decay)) + 0.003)


def _loss(network: Recogniser, batch: Batch, given: Training) -> Tensor:
    features, units, steps, sizes = (each.to(given.device, non_blocking=True) for each in batch)
    with torch.autocast(given.device, dtype=torch.bfloat16, enabled=given.bfloat16):
        both = network.both(features)
    halfway, end = (
        nn.functional.ctc_loss(
            logits.float().log_softmax(2).transpose(0, 1), units, steps, sizes, zero_infinity=True
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


def _resume(network: nn.Module, optimisers: list[torch.optim.Optimizer], path: Path) -> int:
    """Go on from a checkpoint; return the steps that are done, 0 if there is none."""
    if not path.exists():
        return 0
    state = torch.load(path, weights_only=True, map_location="cpu")
    network.load_state_dict(state["network"])
    for optimiser, its_state in zip(optimisers, state["optimisers"], strict=True):
        optimiser.load_state_dict(its_state)
    print(f"goes on from step {state['step']}")
    return int(state["step"])


def _save(
    network: nn.Module,
    optimisers: list[torch.optim.Optimizer],
    step: int,
    given: Training,
    calls: int,
) -> None:
    state = {
        "network": network.state_dict(),
        "optimisers": [optimiser.state_dict() for optimiser in optimisers],
        "step": step,
    }
    path = given.into / "checkpoint.tmp"
    torch.save(state, path)
    path.rename(given.into / "checkpoint.pt")
    card = {
        "made_by": "tools/asr/learn_pieces.py, asr_speech.py, vary_speech.py, train_asr.py",
        "parameters": sum(p.numel() for p in network.parameters()),
        "calls": calls,
        "steps": step,
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
        "lost_words": {"slope": 1.0, "offset": -1.0},
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


def _lines(path: Path) -> list[str]:
    return path.with_name(path.name.replace(".mel.npz", ".jsonl")).read_text().splitlines()


def add_options(parser: argparse.ArgumentParser, steps: int) -> None:
    """Add the options of a training that are those of `Training`."""
    parser.add_argument("--steps", type=int, default=steps)
    parser.add_argument("--rate", type=float, default=1.5e-3, help="highest learning rate")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--batch-frames", type=int, default=12_000, help="frames of a batch")
    parser.add_argument("--bfloat16", action="store_true", help="faster on CUDA and AVX512-BF16")
    parser.add_argument("--adamw", action="store_true", help="without Muon, which needs bfloat16")
    parser.add_argument("--device", default="cpu", help="device of torch, such as cuda")
    parser.add_argument("--workers", type=int, default=0, help="processes that mix batches")


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("prepare", help="turn speech into features")
    one.add_argument("folder", type=Path)
    two = commands.add_parser("train", help="train, from the checkpoint if there is one")
    two.add_argument("build", type=Path)
    two.add_argument("--into", type=Path, required=True, help="folder of the checkpoint")
    two.add_argument("--begin-with", type=Path, help="folder with weights to begin with")
    two.add_argument("--without", default="", help="lineage that is left out")
    add_options(two, steps=36_000)
    three = commands.add_parser("export", help="write the ONNX file")
    three.add_argument("folder", type=Path, help="folder of the checkpoint")
    three.add_argument("target", type=Path)
    four = commands.add_parser("keep", help="write the weights for other trainings to begin with")
    four.add_argument("folder", type=Path, help="folder of the checkpoint")
    four.add_argument("target", type=Path)
    given = vars(parser.parse_args())
    match given.pop("command"):
        case "prepare":
            prepare(**given)
        case "train":
            train(Training(**given))
        case "export":
            export(**given)
        case "keep":
            keep(**given)


if __name__ == "__main__":
    main()
