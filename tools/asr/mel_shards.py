"""Turns shards of speech into mel powers, which `train_asr` trains on.

    python tools/asr/mel_shards.py build/asr/train

`NAME.mel.npz` is written beside each `NAME.npy` of `asr_speech` that has none yet. So it is given
again when there are new shards.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from airhilt.assistant.asr.features import BINS, FLOOR, mel_power
from airhilt.assistant.asr.pieces import Pieces
from airhilt.scenario.radio_profiles import PROFILES
from airhilt.sensors.radio.channel import VhfChannel
from synthesisers import FAMILY

REAL_SHARE = 0.25
"""Share of the utterances that `prepare` also sends through the real channel, with noise."""


@dataclass(frozen=True)
class MelCalls:
    """Calls as logarithms of mel powers, one after another.

    Attributes
    ----------
    logarithms
        Shape (frames of all calls, `BINS`).
    lengths
        Frames of each call.
    units
        Pieces that are said in each call.
    is_received
        Calls that went through the whole channel, with noise, are True.
    """

    logarithms: NDArray[np.float16]
    lengths: NDArray[np.int64]
    units: list[tuple[int, ...]]
    is_received: NDArray[np.bool_]


def prepare(source: Path) -> None:
    """Turn shards of speech, or one, into shards of mel powers, those that are not yet."""
    paths = [source] if source.is_file() else sorted(source.glob("*.jsonl"), reverse=True)
    if not paths:
        sys.exit(f"{source}: no shard (.jsonl with .npy); see tools/asr/asr_speech.py")
    for path in paths:
        target = path.with_name(f"{path.stem}.mel.npz")
        if target.exists() or not path.with_suffix(".npy").exists():
            continue
        begun = time.time()
        unfinished = path.with_name(f"{path.stem}.tmp.npz")
        np.savez(unfinished, **_mel_powers(path))
        unfinished.rename(target)
        print(f"{target.name} {time.time() - begun:.0f} s", flush=True)


def _mel_powers(path: Path) -> dict[str, Any]:
    """Return the arrays of a shard."""
    profiles = [
        PROFILES[name] for name in ("vhf", "vhf", "vhf_833", "fading", "noisy_cockpit", "line")
    ]
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
    return {
        "clean": np.concatenate(clean), "lengths": np.array(lengths),
        "real": np.concatenate(real or [np.empty((0, BINS), np.float16)]),
        "real_of": np.array(real_of, np.int64).reshape(-1, 2),
    }  # fmt: skip


def _trimmed(speech: NDArray[np.float32], rng: np.random.Generator) -> NDArray[np.float32]:
    """Return speech with silence of random length at both ends instead of the engine's own."""
    loud = np.flatnonzero(np.abs(speech) > 0.01 * np.abs(speech).max())
    speech = speech[loud[0] : loud[-1] + 1] if len(loud) else speech
    before, after = rng.integers(0, 6_000, 2)
    return np.pad(speech, (before, after))


def load(folder: Path, pieces: Pieces, without: str) -> MelCalls:
    """Return the calls of the prepared shards of a folder.

    Parameters
    ----------
    without
        Lineage that is left out, with all other voices of its speakers; empty for none.
    """
    left_out = speakers_of(without)
    parts: list[NDArray[np.float16]] = []
    lengths: list[int] = []
    units: list[tuple[int, ...]] = []
    is_received: list[bool] = []
    for path in sorted(folder.glob("*.mel.npz")):
        lines = [json.loads(line) for line in _lines(path)]
        texts = [pieces.units(line["text"].split()) for line in lines]
        is_kept = np.array([
            text is not None and line["lineage"] != without and line["speaker"] not in left_out
            for text, line in zip(texts, lines, strict=True)
        ])  # fmt: skip
        with np.load(path) as shard:
            for name, index, sizes, received in (
                ("clean", np.arange(len(lines)), shard["lengths"], False),
                ("real", *shard["real_of"].T, True),
            ):
                chosen = is_kept[index]
                parts.append(shard[name][np.repeat(chosen, sizes)])
                lengths += sizes[chosen].tolist()
                units += [tuple(texts[each] or ()) for each in index[chosen]]
                is_received += [received] * int(chosen.sum())
    logarithms = np.concatenate(parts or [np.empty((0, BINS), np.float16)])
    return MelCalls(logarithms, np.array(lengths, np.int64), units, np.array(is_received, np.bool_))


def _lines(path: Path) -> list[str]:
    return path.with_name(path.name.replace(".mel.npz", ".jsonl")).read_text().splitlines()


def speakers_of(lineage: str) -> set[str]:
    """Return the persons whose voices a lineage has."""
    voices = (voice for name in FAMILY.names() for voice in FAMILY.load(name).voices)
    return {voice.speaker for voice in voices if voice.lineage == lineage}


def noise_bank() -> NDArray[np.float32]:
    """Return mel powers of a receiver's noise, of power one, shape (kinds, frames, `BINS`)."""
    rng = np.random.default_rng(1)
    bank = []
    silence = np.zeros(16_000 * 20, np.float32)
    for name in ("vhf", "vhf_833", "vhf"):
        parts = VhfChannel(PROFILES[name]).parts(silence, 0.0, rng)
        bank.append(mel_power(parts.noise) / float(np.mean(parts.noise**2)))
    return np.stack(bank)


def main() -> None:
    """Prepare a folder or a shard."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("source", type=Path, help="folder of shards, or one shard (.jsonl)")
    prepare(parser.parse_args().source)


if __name__ == "__main__":
    main()
