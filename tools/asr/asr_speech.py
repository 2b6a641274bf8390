"""Speaks the texts of `asr_corpus` with a synthesiser, for training and testing recognisers.

A shard is two files: `NAME.npy`, all samples one after another (int16, 16 kHz), and `NAME.jsonl`,
one line an utterance with its text, callsign, voice, rate and length. NAME begins with the
synthesiser, and with the choice of voices unless that is ``seen``.

    python tools/asr/asr_speech.py build/asr espeak --count 30000 --seed 1
    python tools/asr/asr_speech.py build/asr espeak --voices unseen --count 600 --seed 3
    python tools/asr/asr_speech.py build/asr flite --voices all --count 6000 --seed 2

Several runs with other seeds may work at the same time.
"""

from __future__ import annotations

import argparse
import json
import random
import sys
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from airhilt.errors import SpeechError
from asr_corpus import Talk
from synthesisers import FAMILY, synthesiser
from synthesisers.synthesiser import Synthesiser, Voice, speak

SHARD = 2_000
WORDS_PER_MINUTE = (120.0, 220.0)
"""Range of the rates of calls, each drawn evenly."""
SALAD = 0.06
"""Share of calls without sense."""


def speech(
    made_by: Synthesiser, voices: Sequence[Voice], count: int, seed: int
) -> Iterator[tuple[dict[str, Any], NDArray[np.int16]]]:
    """Yield what a shard says of each call, and its samples; the voices take turns."""
    rng = random.Random(seed)
    talk = Talk(rng)
    talker = made_by.create()
    turn: list[Voice] = []
    for _ in range(count):
        is_salad = rng.random() < SALAD
        text = talk.salad(_words()) if is_salad else talk.call()
        spoken = _with_pauses(text, rng)
        turn = turn or rng.sample(voices, len(voices))
        voice = turn.pop()
        rate = round(rng.uniform(*WORDS_PER_MINUTE), 1)
        pitch = round(rng.uniform(*made_by.pitches), 3)
        about = {
            "text": text,
            "callsign": None if is_salad else talk.callsign_of_call,
            "engine": made_by.name,
            "voice": voice.name,
            "speaker": voice.speaker,
            "lineage": voice.lineage,
            "words_per_minute": rate,
            "pitch": pitch,
        }
        yield about, speak(talker, voice, spoken, rate, pitch)


@cache
def _words() -> list[str]:
    """Return nearly all words of the corpus."""
    talk = Talk(random.Random(0))
    return sorted({word for _ in range(40_000) for word in talk.call().split()})


def _with_pauses(text: str, rng: random.Random) -> str:
    share = rng.choice((0.0, 0.06, 0.15))
    words = [f"{word}," if rng.random() < share else word for word in text.split()]
    return f"{' '.join(words).rstrip(',')}."


def stem(name: str, voices: str) -> str:
    """Return how the names of shards begin."""
    if voices == "seen":
        return name
    return f"{name}-{voices if '+' not in voices and ',' not in voices else 'chosen'}"


def write(folder: Path, name: str, count: int, seed: int, voices: str) -> None:
    """Write the shards of a synthesiser.

    Raises
    ------
    SpeechError
        There is no such synthesiser or voice, or it fails.
    """
    made_by = synthesiser(name)
    utterances = speech(made_by, made_by.choose(voices), count, seed)
    folder.mkdir(parents=True, exist_ok=True)
    for shard in range(-(-count // SHARD)):
        lines, samples = [], []
        for _ in range(min(SHARD, count - shard * SHARD)):
            about, pcm = next(utterances)
            lines.append(json.dumps(about | {"samples": len(pcm)}))
            samples.append(pcm)
        path = folder / f"{stem(name, voices)}-{seed}-{shard:03d}"
        np.save(path.with_suffix(".tmp.npy"), np.concatenate(samples))
        path.with_suffix(".jsonl").write_text("\n".join(lines) + "\n")
        path.with_suffix(".tmp.npy").rename(path.with_suffix(".npy"))
        print(f"{path.name}: {len(lines)} utterances", flush=True)


def main() -> None:
    """Write the shards."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("synthesiser", help=f"one of {', '.join(FAMILY.names())}")
    parser.add_argument("--count", type=int, default=2_000, help="number of calls")
    parser.add_argument("--seed", type=int, default=0, help="seed of all that is drawn")
    parser.add_argument(
        "--voices",
        default="seen",
        help="seen: that the model that ships was trained on (default); unseen: that it was not; "
        "all: both; test-only: those whose licence allows no training; or names between commas",
    )
    given = parser.parse_args()
    try:
        write(given.folder, given.synthesiser, given.count, given.seed, given.voices)
    except SpeechError as error:
        print(f"asr_speech.py: {error}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
