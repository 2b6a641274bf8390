"""Trains a radio channel from clean speech and channel speech that are not of the same words.

    pip install torch onnx
    python tools/train_channel.py CLEAN CHANNEL channel.onnx --steps 4000
    airhilt cosim --scenario s01a_nominal --radio-profile channel.onnx

CLEAN and CHANNEL are folders of WAV files, 16 kHz, mono, 16 bits: speech as it was spoken, and
recordings of the radio. Neither needs transcripts. The generator learns to make clean speech sound
like the recordings (Simu-GAN, arXiv 2203.15321, smaller). The noise of the recordings is not
learned: a run adds noise at its own SNR. A tenth of the files is held out. The distance between
the mean spectra of held-out speech is written to ``channel.json`` beside the model, before and
after, with the files, the settings and the time. The same files, seed and versions give the same
model on a CPU.
"""

from __future__ import annotations

import argparse
import copy
import hashlib
import json
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.audio.wav import read_wav
from airhilt.errors import SpeechError, first_line
from airhilt.sensors.radio.channel import LEVEL_RMS, active

PIECE = SAMPLE_RATE_HZ
"""Samples of the pieces of speech that are learned from: 1 s."""
LEAST_SPEECH = 0.3
"""Least share of speech in a piece."""
HELD_OUT_SHARE = 0.1
WORDS_WEIGHT = 1.0
"""Weight of the contrastive loss beside the adversarial one. An assumption."""
FILTER_RATE = 20.0
"""Learning rate of the filter, relative to that of the layers: its parameters are few, and each is
a gain of up to 40 dB. An assumption."""
REPORT = 50
"""Steps from one trial of the generator, and one line on the terminal, to the next."""
TRIED_CALLS = 20
"""Most calls that a generator is tried with while it is trained."""


@dataclass(frozen=True)
class Settings:
    """Settings of the training."""

    steps: int = 4_000
    batch: int = 8
    rate: float = 5e-4
    seed: int = 0
    device: str = "cpu"
    threads: int = 1
    """Threads of torch; the networks are too small for more to help on a busy machine."""


def train_channel(clean: Path, channel: Path, out: Path, settings: Settings) -> dict[str, Any]:
    """Train a channel, write it as ONNX with its card, and return the card.

    Raises
    ------
    SpeechError
        A package or speech is missing, or ``out`` is there already.
    """
    card_path = out.with_suffix(".json")
    for path in (out, card_path):
        if path.exists():
            raise SpeechError(f"{path}: is there; expected the name of a new file")
    if out.suffix != ".onnx":
        raise SpeechError(f"{out}: expected a name that ends in .onnx")
    _require_packages()
    rng = np.random.default_rng(settings.seed)
    spoken, spoken_held_out = _split(_speech(clean), rng)
    recorded, recorded_held_out = _split(_speech(channel), rng)
    begun = time.monotonic()
    generator, best = _train(spoken, recorded, settings, rng)
    minutes = (time.monotonic() - begun) / 60.0
    _export(generator, out)
    card = {
        "made_by": "tools/train_channel.py",
        "clean": _summary(clean, spoken),
        "channel": _summary(channel, recorded),
        "held_out": {"clean": len(spoken_held_out), "channel": len(recorded_held_out)},
        "settings": asdict(settings),
        "versions": {name: version(name) for name in ("airhilt", "torch", "onnx")},
        "minutes": round(minutes, 2),
        "best": best,
        "distance_before_db": _distance_db(spoken_held_out, recorded_held_out),
        "distance_after_db": _distance_db(
            [_through(generator, each) for each in spoken_held_out], recorded_held_out
        ),
        "sha256": hashlib.sha256(out.read_bytes()).hexdigest(),
    }
    card_path.write_text(json.dumps(card, indent=2) + "\n")
    return card


def _require_packages() -> None:
    try:
        import onnx
        import torch
    except ImportError as error:
        raise SpeechError(
            f"training a channel needs torch and onnx ({first_line(error)}); install them with "
            "`pip install torch onnx`"
        ) from None
    del onnx, torch


def _speech(folder: Path) -> list[Audio]:
    """Return the speech of a folder, each file at the level that a radio gives."""
    calls = []
    for path in sorted(folder.glob("*.wav")):
        audio = read_wav(path)
        speaks = active(audio)
        if len(audio) > PIECE and speaks.any():
            calls.append(audio * np.float32(LEVEL_RMS / np.sqrt(np.mean(audio[speaks] ** 2))))
    if len(calls) < 2:
        raise SpeechError(
            f"{folder}: {len(calls)} WAV files with more than 1 s of speech; expected at least 2"
        )
    return calls


def _split(calls: Sequence[Audio], rng: np.random.Generator) -> tuple[list[Audio], list[Audio]]:
    """Return the calls to train on, and those that are held out."""
    order = rng.permutation(len(calls))
    count = max(1, round(HELD_OUT_SHARE * len(calls)))
    return [calls[i] for i in order[count:]], [calls[i] for i in order[:count]]


def _train(
    spoken: Sequence[Audio], recorded: Sequence[Audio], settings: Settings, rng: np.random.Generator
) -> tuple[Any, dict[str, float]]:
    """Return the best generator of the training, its losses, and its distance on that speech.

    Adversarial training does not settle. The generator is kept whose speech was nearest to the
    recordings, of those that are tried every `REPORT` steps, by the speech that it learns from.
    """
    import torch

    from channel_networks import Generator, LogMel, contrastive_loss, discriminator, frame_encoder

    torch.manual_seed(settings.seed)
    torch.set_num_threads(settings.threads)
    device = torch.device(settings.device)
    made_by, judge, codes = Generator(), discriminator(), frame_encoder()
    log_mel = LogMel().to(device)
    for network in (made_by, judge, codes):
        network.to(device)
    learning, judging = _optimisers(made_by, codes, judge, settings.rate)
    history: list[tuple[float, float, float]] = []
    best: dict[str, float] = {}
    best_weights: Any = None
    for step in range(1, settings.steps + 1):
        clean = torch.from_numpy(_pieces(spoken, settings.batch, rng)).to(device)
        real = log_mel(torch.from_numpy(_pieces(recorded, settings.batch, rng)).to(device))
        made = log_mel(made_by(clean))
        # Least squares as adversarial loss (Mao et al., ICCV 2017).
        fooled = ((judge(real) - 1.0) ** 2).mean() + (judge(made.detach()) ** 2).mean()
        judging.zero_grad()
        fooled.backward()
        judging.step()
        adversarial = ((judge(made) - 1.0) ** 2).mean()
        words = contrastive_loss(codes(log_mel(clean)), codes(made))
        learning.zero_grad()
        (adversarial + WORDS_WEIGHT * words).backward()
        learning.step()
        history.append((fooled.item(), adversarial.item(), words.item()))
        if step % REPORT == 0 or step == settings.steps:
            heard = [_through(made_by, each) for each in spoken[:TRIED_CALLS]]
            distance_db = _distance_db(heard, recorded[:TRIED_CALLS])
            now = {"step": step, "distance_db": distance_db, **_mean(history[-REPORT:])}
            print(f"{now} of {settings.steps} steps", flush=True)
            if not best or distance_db < best["distance_db"]:
                best, best_weights = now, copy.deepcopy(made_by.state_dict())
    made_by.load_state_dict(best_weights)
    return made_by.cpu().eval(), best


def _optimisers(made_by: Any, codes: Any, judge: Any, rate: float) -> tuple[Any, Any]:
    """Return the optimisers of the generator with the frame encoder, and of the discriminator."""
    import torch

    learning = torch.optim.Adam(
        [
            {"params": [made_by.filter], "lr": FILTER_RATE * rate},
            {"params": [*made_by.layers.parameters(), *codes.parameters()]},
        ],
        rate,
    )
    return learning, torch.optim.Adam(judge.parameters(), rate, betas=(0.5, 0.9))


def _pieces(calls: Sequence[Audio], count: int, rng: np.random.Generator) -> np.ndarray:
    """Return pieces of calls in which somebody speaks, shape (count, samples)."""
    pieces: list[Audio] = []
    for attempt in range(100 * count):
        call = calls[int(rng.integers(len(calls)))]
        first = int(rng.integers(len(call) - PIECE))
        piece = call[first : first + PIECE]
        if active(piece).mean() >= LEAST_SPEECH or attempt >= 99 * count:
            pieces.append(piece)
        if len(pieces) == count:
            break
    return np.stack(pieces)


def _export(generator: Any, out: Path) -> None:
    import torch

    out.parent.mkdir(parents=True, exist_ok=True)
    torch.onnx.export(
        generator,
        (torch.zeros(1, PIECE),),
        str(out),
        dynamo=False,
        input_names=["speech"],
        output_names=["heard"],
        dynamic_axes={"speech": {1: "samples"}, "heard": {1: "samples"}},
    )


def _through(generator: Any, speech: Audio) -> Audio:
    import torch

    device = generator.filter.device
    with torch.no_grad():
        heard = generator(torch.from_numpy(speech)[None].to(device))[0]
    return np.asarray(heard.cpu().numpy(), np.float32)


def _distance_db(calls: Sequence[Audio], others: Sequence[Audio]) -> float:
    """Return the distance between the mean log-mel spectra of two sets of speech, in dB."""
    import torch

    from channel_networks import RANGE_DB, LogMel

    log_mel = LogMel()
    with torch.no_grad():
        means = [
            np.mean([log_mel(torch.from_numpy(each)[None])[0].mean(1).numpy() for each in some], 0)
            for some in (calls, others)
        ]
    return round(float(RANGE_DB * np.sqrt(np.mean((means[0] - means[1]) ** 2))), 2)


def _summary(folder: Path, calls: Sequence[Audio]) -> dict[str, Any]:
    seconds = sum(len(each) for each in calls) / SAMPLE_RATE_HZ
    return {"folder": folder.name, "calls": len(calls), "minutes": round(seconds / 60.0, 2)}


def _mean(history: Sequence[tuple[float, float, float]]) -> dict[str, float]:
    """Return the mean losses of some steps, by name."""
    names = ("discriminator", "adversarial", "words")
    means = np.mean(history, axis=0)
    return {name: round(float(mean), 4) for name, mean in zip(names, means, strict=True)}


def main() -> None:
    """Read the command line, and train."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("clean", type=Path, help="folder of WAV files of clean speech")
    parser.add_argument("channel", type=Path, help="folder of WAV files of recorded radio")
    parser.add_argument("out", type=Path, help="a new file, FILE.onnx")
    for name, value in asdict(Settings()).items():
        parser.add_argument(f"--{name}", type=type(value), default=value, help=f"default: {value}")
    given = vars(parser.parse_args())
    clean, channel, out = (given.pop(name) for name in ("clean", "channel", "out"))
    try:
        card = train_channel(clean, channel, out, Settings(**given))
    except SpeechError as error:
        parser.error(str(error))
    for name in ("minutes", "distance_before_db", "distance_after_db"):
        print(f"{name}: {card[name]}")


if __name__ == "__main__":
    main()
