"""Trains the embedded recogniser on speech that `asr_speech` has made, and writes its ONNX file.

A TDNN-CTC network (temporal convolutions with residuals) whose units are the words of
`asr_corpus`, so that it can give no word that aviators do not use. Noise and levels vary anew
each time an utterance is seen: they are mixed as mel powers, which costs next to nothing. The
last part of the training adds calls that really went through `airhilt.sensors.radio.channel`.

    python tools/asr/train_asr.py prepare build/asr/train     (as often as there are new shards)
    python tools/asr/train_asr.py train build/asr --minutes 90
    python tools/asr/train_asr.py export build/asr airhilt/assistant/asr/model

Needs torch, which the package itself does not.
"""

from __future__ import annotations

import argparse
import json
import math
import random
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn

from airhilt.assistant.asr.features import BINS, FLOOR, mel_power
from airhilt.scenario.radio_profiles import PROFILES
from airhilt.sensors.radio.channel import VhfChannel
from asr_corpus import Talk

STRIDE = 6
"""Frames of features to one of the output: 60 ms."""
WIDTH = 224
DILATIONS = (1, 1, 2, 1, 2, 4, 1, 2)
BATCH_FRAMES = 9_000
REAL_SHARE = 0.25
"""Share of the utterances that `prepare` also sends through the real channel, with noise."""


def vocabulary() -> list[str]:
    """Return all words of the corpus, in alphabetical order. Unit 0 is the blank, word i is i+1."""
    talk = Talk(random.Random(0))
    return sorted({word for _ in range(60_000) for word in talk.call().split()})


class Residual(nn.Module):
    """Two convolutions' worth of context with a way round them."""

    def __init__(self, width: int, dilation: int) -> None:
        super().__init__()
        self.convolve = nn.Conv1d(width, width, 5, padding=2 * dilation, dilation=dilation)
        self.norm = nn.BatchNorm1d(width)
        self.drop = nn.Dropout(0.05)

    def forward(self, x: Tensor) -> Tensor:
        """Return the same shape."""
        return x + self.drop(torch.relu(self.norm(self.convolve(x))))


class Recogniser(nn.Module):
    """Log-mel features (batch, frames, bins) to logits (batch, frames / 6, words + 1)."""

    def __init__(self, words: int) -> None:
        super().__init__()
        self.front = nn.Sequential(
            nn.Conv1d(BINS, WIDTH, 5, stride=2, padding=2), nn.BatchNorm1d(WIDTH), nn.ReLU(),
            nn.Conv1d(WIDTH, WIDTH, 5, stride=3, padding=2), nn.BatchNorm1d(WIDTH), nn.ReLU(),
        )  # fmt: skip
        self.body = nn.Sequential(*(Residual(WIDTH, dilation) for dilation in DILATIONS))
        self.head = nn.Conv1d(WIDTH, words + 1, 1)

    def forward(self, features: Tensor) -> Tensor:
        """Return the logits."""
        return self.head(self.body(self.front(features.transpose(1, 2)))).transpose(1, 2)


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
        rng = np.random.default_rng(abs(hash(path.stem)) % 2**32)
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
    units: list[int]
    real: bool


def load(folder: Path, words: dict[str, int], known: set[str]) -> list[Utterance]:
    """Return the utterances of shards that are not known yet."""
    found = []
    for path in sorted(folder.glob("*.mel.npz")):
        if path.name in known:
            continue
        known.add(path.name)
        lines = (folder / path.name.replace(".mel.npz", ".jsonl")).read_text().splitlines()
        texts = [[words[word] + 1 for word in json.loads(line)["text"].split()] for line in lines]
        with np.load(path) as shard:
            at, clean = 0, shard["clean"]
            for units, size in zip(texts, shard["lengths"], strict=True):
                found.append(Utterance(clean[at : at + size], units, False))
                at += size
            at, real = 0, shard["real"]
            for index, size in shard["real_of"]:
                found.append(Utterance(real[at : at + size], texts[index], True))
                at += size
    return found


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

    def __init__(self, seed: int) -> None:
        self._rng = np.random.default_rng(seed)
        self._bank = noise_bank()

    def mix(self, utterance: Utterance, easy: bool) -> np.ndarray:
        """Return the features of a call as they may be, without much noise if it is ``easy``."""
        rng = self._rng
        log = utterance.mel.astype(np.float32)
        if utterance.real:
            return self._masked(log - log.mean(axis=0), easy)
        if not easy:
            log = self._warped(log)
        power = np.exp(log)
        kind = rng.random()
        if easy:
            snr_db = rng.uniform(15, 35)
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
        tilt = rng.uniform(-1.0, 1.0) * np.linspace(-0.5, 0.5, BINS, dtype=np.float32)
        log = np.log(power + FLOOR) + tilt
        return self._masked(log - log.mean(axis=0), easy)

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


# --- training ------------------------------------------------------------------------------


def train(folder: Path, minutes: float, rate: float, threads: int) -> None:
    """Train until the time is up; write a checkpoint every few minutes."""
    torch.set_num_threads(threads)
    torch.manual_seed(0)
    words = vocabulary()
    index = {word: number for number, word in enumerate(words)}
    network = Recogniser(len(words))
    optimiser = torch.optim.AdamW(network.parameters(), lr=rate, weight_decay=0.01)
    checkpoint = folder / "checkpoint.pt"
    easy = not _resume(network, optimiser, checkpoint)
    parameters = sum(p.numel() for p in network.parameters())
    known: set[str] = set()
    utterances = load(folder / "train", index, known)
    print(f"{parameters / 1e6:.2f} M parameters, {len(words)} words, {len(utterances)} utterances")
    mixer, order = Mixer(int(time.time())), random.Random(0)
    begun = saved = looked = time.time()
    seen, step, mean = 0, 0, 8.0
    while (elapsed := time.time() - begun) < minutes * 60.0:
        if time.time() - looked > 60.0:
            looked = time.time()
            utterances += load(folder / "train", index, known)
        now = _rate(rate, elapsed / (minutes * 60.0), step)
        for group in optimiser.param_groups:
            group["lr"] = now
        for batch in _batches(utterances, order, easy):
            inputs = [mixer.mix(each, easy) for each in batch]
            targets = [each.units for each in batch]
            if not easy and order.random() < 0.3:
                inputs.append(mixer.noise_alone())
                targets.append([])
            loss = _loss(network, inputs, targets)
            optimiser.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(network.parameters(), 1.0)
            optimiser.step()
            step += 1
            seen += len(batch)
            mean += 0.02 * (loss.item() - mean)
            if step % 50 == 0:
                spent = (time.time() - begun) / 60
                drawn = f"{seen} of {len(utterances)} drawn{', easy ones' if easy else ''}"
                print(f"{spent:6.1f} min  step {step}  loss {mean:.3f}  {drawn}", flush=True)
            if easy and mean < 1.0:
                easy = False
                print("all utterances from here on", flush=True)
        if time.time() - saved > 240.0:
            saved = time.time()
            _save(network, optimiser, checkpoint)
    _save(network, optimiser, checkpoint)
    _note_minutes(folder / "minutes.json", minutes)


def _note_minutes(journal: Path, minutes: float) -> None:
    earlier = json.loads(journal.read_text()) if journal.exists() else []
    journal.write_text(json.dumps([*earlier, minutes]))


def _rate(most: float, progress: float, step: int) -> float:
    """Return the learning rate: a warm-up, then constant, then a cosine."""
    rate = most * (0.5 * (1 + math.cos(math.pi * max(0.0, (progress - 0.35) / 0.65))) + 0.003)
    return rate * min(1.0, (step + 1) / 200)


def _batches(
    utterances: list[Utterance], order: random.Random, easy: bool
) -> list[list[Utterance]]:
    """Return batches of some of the utterances, each of utterances of about one length."""
    pool = order.sample(utterances, min(600, len(utterances)))
    if easy:
        pool = [u for u in pool if len(u.mel) < 450 and not u.real]
    batches: list[list[Utterance]] = []
    batch: list[Utterance] = []
    for each in sorted(pool, key=lambda u: len(u.mel)):
        batch.append(each)
        if len(batch) * len(each.mel) > BATCH_FRAMES:
            batches.append(batch)
            batch = []
    order.shuffle(batches)
    return batches


def _loss(network: Recogniser, inputs: list[np.ndarray], targets: list[list[int]]) -> Tensor:
    longest = -(-max(len(mixed) for mixed in inputs) // 48) * 48
    features = torch.zeros(len(inputs), longest, BINS)
    for row, mixed in enumerate(inputs):
        features[row, : len(mixed)] = torch.from_numpy(mixed)
    logits = network(features).log_softmax(2).transpose(0, 1)
    sizes = torch.tensor([-(-len(mixed) // STRIDE) for mixed in inputs])
    return nn.functional.ctc_loss(
        logits, torch.tensor([u for t in targets for u in t]), sizes,
        torch.tensor([len(t) for t in targets]), zero_infinity=True,
    )  # fmt: skip


def _resume(network: nn.Module, optimiser: torch.optim.Optimizer, path: Path) -> bool:
    """Go on from a checkpoint; return False if there is none."""
    if not path.exists():
        return False
    state = torch.load(path, weights_only=True)
    network.load_state_dict(state["network"])
    optimiser.load_state_dict(state["optimiser"])
    print("goes on from the checkpoint")
    return True


def _save(network: nn.Module, optimiser: torch.optim.Optimizer, path: Path) -> None:
    state = {"network": network.state_dict(), "optimiser": optimiser.state_dict()}
    torch.save(state, path.with_suffix(".tmp"))
    path.with_suffix(".tmp").rename(path)


def export(folder: Path, target: Path) -> None:
    """Write the network as ONNX with its words beside it."""
    words = vocabulary()
    network = Recogniser(len(words))
    network.load_state_dict(torch.load(folder / "checkpoint.pt", weights_only=True)["network"])
    network.eval()
    target.mkdir(parents=True, exist_ok=True)
    torch.onnx.export(
        network, (torch.zeros(1, 120, BINS),), str(target / "ctc.onnx"), dynamo=False,
        input_names=["features"], output_names=["logits"],
        dynamic_axes={"features": {0: "batch", 1: "frames"}, "logits": {0: "batch", 1: "frames"}},
    )  # fmt: skip
    (target / "words.txt").write_text("\n".join(words) + "\n")
    shards = sorted((folder / "train").glob("*.mel.npz"))
    lines = {path.name: _lines(path) for path in shards}
    card = {
        "made_by": "tools/asr/asr_corpus.py, tools/asr/asr_speech.py, tools/asr/train_asr.py",
        "parameters": sum(p.numel() for p in network.parameters()),
        "utterances": sum(lines.values()),
        "training_minutes": round(sum(json.loads((folder / "minutes.json").read_text())), 1),
        "word_calibration": {"slope": 1.0, "offset": 0.0},
        "call_calibration": {"slope": 1.0, "offset": 0.0},
        "least_word_confidence": 0.0,
        "best_word_threshold": 0.0,
    }
    (target / "card.json").write_text(json.dumps(card, indent=2) + "\n")


def _lines(path: Path) -> int:
    text = path.with_name(path.name.replace(".mel.npz", ".jsonl")).read_text()
    return len(text.splitlines())


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("prepare", help="turn speech into features")
    one.add_argument("folder", type=Path)
    two = commands.add_parser("train", help="train, from the checkpoint if there is one")
    two.add_argument("folder", type=Path)
    two.add_argument("--minutes", type=float, default=90.0)
    two.add_argument("--rate", type=float, default=1.5e-3)
    two.add_argument("--threads", type=int, default=1)
    three = commands.add_parser("export", help="write the ONNX file")
    three.add_argument("folder", type=Path)
    three.add_argument("target", type=Path)
    given = parser.parse_args()
    match given.command:
        case "prepare":
            prepare(given.folder)
        case "train":
            train(given.folder, given.minutes, given.rate, given.threads)
        case "export":
            export(given.folder, given.target)


if __name__ == "__main__":
    main()
