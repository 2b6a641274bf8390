"""Speaks the texts of `asr_corpus` with many voices, for training and testing recognisers.

A shard is two files: `NAME.npy`, all samples one after another (int16, 16 kHz), and `NAME.jsonl`,
one line an utterance with its text, voice and length.

    python tools/asr/asr_speech.py build/asr espeak --count 30000 --seed 1
    python tools/asr/asr_speech.py build/asr flite --count 6000 --seed 2
    python tools/asr/asr_speech.py build/asr espeak-unseen --count 600 --seed 3
    python tools/asr/asr_speech.py build/asr flite-unseen --count 600 --seed 4
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.io import wavfile
from scipy.signal import resample_poly

from airhilt.audio.pcm import SAMPLE_RATE_HZ
from airhilt.voices.engine import VoiceSpec
from airhilt.voices.engines.espeak import ACCENTS, Espeak
from asr_corpus import Talk

SHARD = 2_000
UNSEEN_TIMBRES = ("f3 m2 m4 Mike linda Gene adam ed steph2 victor anika john").split()
"""Timbres of espeak-ng that no training utterance has."""
TIMBRES = (
    "m1 m3 m5 m6 m7 m8 f1 f2 f4 f5 Alex Alicia Andrea Andy Annie Denis Diogo Gene2 Henrique "
    "Hugo Jacky Lee Marco Mario Michael Nguyen Reed announcer antonio aunty belinda benjamin "
    "boris caleb david edward edward2 grandma grandpa gustave ian iven iven2 iven3 klatt klatt2 "
    "klatt3 klatt4 marcelo max michel miguel mike2 norbert pablo paul pedro quincy rob robert "
    "sandro shelby steph steph3 travis zac"
).split()
FLITE = ["slt", "rms", "kal16", "kal"]
FLITE_UNSEEN = ["awb"]


def speech(
    engine: str, count: int, seed: int
) -> Iterator[tuple[dict[str, str | None], NDArray[np.int16]]]:
    """Yield text, callsign and voice, and the samples."""
    rng = random.Random(seed)
    talk = Talk(rng)
    words = sorted({word for _ in range(40_000) for word in talk.call().split()})
    espeak = Espeak()
    timbres = UNSEEN_TIMBRES if engine.endswith("unseen") else TIMBRES
    for _ in range(count):
        is_salad = rng.random() < 0.06
        text = talk.salad(words) if is_salad else talk.call()
        about = {"text": text, "callsign": None if is_salad else talk.callsign_of_call}
        spoken = _with_pauses(text, rng)
        if engine.startswith("espeak"):
            voice = VoiceSpec(
                f"{rng.choice(ACCENTS)}+{rng.choice(timbres)}",
                rate=rng.uniform(0.75, 1.45),
                pitch=rng.uniform(0.5, 1.5),
            )
            samples = espeak.synthesise(spoken, voice)
            pcm = (np.clip(samples, -1.0, 1.0) * 32767).astype(np.int16)
            yield about | {"voice": voice.name}, pcm
        else:
            name = rng.choice(FLITE_UNSEEN if engine.endswith("unseen") else FLITE)
            pcm = _flite(spoken, name, rng.uniform(0.72, 1.25))
            yield about | {"voice": f"flite-{name}"}, pcm


def _with_pauses(text: str, rng: random.Random) -> str:
    share = rng.choice((0.0, 0.06, 0.15))
    words = [f"{word}," if rng.random() < share else word for word in text.split()]
    return f"{' '.join(words).rstrip(',')}."


def _flite(text: str, voice: str, stretch: float) -> NDArray[np.int16]:
    with tempfile.NamedTemporaryFile(suffix=".wav") as spoken:
        subprocess.run(
            ["flite", "-voice", voice, "--setf", f"duration_stretch={stretch:.2f}",
             "-t", text, "-o", spoken.name],
            check=True,
        )  # fmt: skip
        rate, samples = wavfile.read(spoken.name)
    if rate == SAMPLE_RATE_HZ:
        return np.asarray(samples, np.int16)
    return np.asarray(
        np.clip(resample_poly(samples.astype(np.float32), SAMPLE_RATE_HZ, rate), -32767, 32767),
        np.int16,
    )


def main() -> None:
    """Write the shards."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    engines = ["espeak", "flite", "espeak-unseen", "flite-unseen"]
    parser.add_argument("engine", choices=engines)
    parser.add_argument("--count", type=int, default=2_000)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    utterances = speech(given.engine, given.count, given.seed)
    for shard in range(-(-given.count // SHARD)):
        lines, samples = [], []
        for _ in range(min(SHARD, given.count - shard * SHARD)):
            about, pcm = next(utterances)
            lines.append(json.dumps(about | {"samples": len(pcm)}))
            samples.append(pcm)
        name = f"{given.engine}-{given.seed}-{shard:03d}"
        np.save(given.folder / f"{name}.tmp.npy", np.concatenate(samples))
        (given.folder / f"{name}.jsonl").write_text("\n".join(lines) + "\n")
        (given.folder / f"{name}.tmp.npy").rename(given.folder / f"{name}.npy")
        print(f"{name}: {len(lines)} utterances", flush=True)


if __name__ == "__main__":
    main()
