"""Speaks the texts of `asr_corpus` with a synthesiser, for training and testing recognisers.

A shard is two files: `NAME.npy`, all samples one after another (int16, 16 kHz), and `NAME.jsonl`,
one line an utterance with its text, callsign, voice, rate and length. NAME begins with the
synthesiser, then has the choice of voices unless it is ``seen``, and ``names`` for held-out names
or the name of the file of calls. Calls of a file keep what they are said to mean.

    python tools/asr/asr_speech.py build/asr espeak --count 30000 --seed 1
    python tools/asr/asr_speech.py build/asr espeak --voices unseen --count 600 --seed 3
    python tools/asr/asr_speech.py build/asr flite --voices all --count 6000 --seed 2
    python tools/asr/asr_speech.py build/asr/exam pico --voices all \
        --calls tools/phraseology_judge/third_exam.jsonl

Several runs with other seeds may work at the same time.
"""

from __future__ import annotations

import argparse
import json
import random
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from itertools import count as count_from
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from airhilt.errors import SpeechError
from asr_corpus import Talk, common_words
from synthesisers import FAMILY, synthesiser
from synthesisers.synthesiser import CHOICES, Synthesiser, Voice, speak

SHARD = 2_000
WORDS_PER_MINUTE = (120.0, 220.0)
"""Range of the rates of calls, each drawn evenly."""
SALAD = 0.08
"""Share of calls without sense."""
CALLS, FEW = 10_000, 3
"""Calls in which words for calls without sense are looked for, and in how many a word must be."""


def speech(
    made_by: Synthesiser,
    voices: Sequence[Voice],
    calls: Iterable[dict[str, Any]],
    rng: random.Random,
) -> Iterator[tuple[dict[str, Any], NDArray[np.int16]]]:
    """Yield what a shard says of each call, and its samples; the voices take turns."""
    talker = made_by.create()
    turn: list[Voice] = []
    for call in calls:
        spoken = _with_pauses(call["text"], rng)
        turn = turn or rng.sample(voices, len(voices))
        voice = turn.pop()
        rate = round(rng.uniform(*WORDS_PER_MINUTE), 1)
        pitch = round(rng.uniform(*made_by.pitches), 3)
        about = call | {
            "engine": made_by.name,
            "voice": voice.name,
            "speaker": voice.speaker,
            "lineage": voice.lineage,
            "words_per_minute": rate,
            "pitch": pitch,
        }
        yield about, speak(talker, voice, spoken, rate, pitch)


def made_up(
    count: int, rng: random.Random, *, held_out_names: bool = False
) -> Iterator[dict[str, Any]]:
    """Yield texts of the corpus, each with its callsign."""
    talk = Talk(rng, held_out=held_out_names)
    for _ in range(count):
        if rng.random() < SALAD:
            words = rng.choice((_words(), common_words()))
            yield {"text": talk.salad(words), "callsign": None}
        else:
            text = talk.call()
            yield {"text": text, "callsign": talk.callsign_of_call}


@cache
def _words() -> tuple[str, ...]:
    """Return the words of the corpus without invented names, of which each is in few calls."""
    talk = Talk(random.Random(0))
    calls = Counter(word for _ in range(CALLS) for word in set(talk.call().split()))
    return tuple(sorted(word for word, times in calls.items() if times >= FEW))


def _with_pauses(text: str, rng: random.Random) -> str:
    share = rng.choice((0.0, 0.06, 0.15))
    words = [f"{word}," if rng.random() < share else word for word in text.split()]
    return f"{' '.join(words).rstrip(',')}."


def stem(name: str, voices: str, texts: str = "") -> str:
    """Return how the names of shards begin."""
    chosen = voices if voices in CHOICES else "chosen"
    return "-".join(filter(None, [name, "" if voices == "seen" else chosen, texts]))


def write(
    folder: Path,
    name: str,
    count: int,
    seed: int,
    voices: str,
    *,
    held_out_names: bool = False,
    calls: Path | None = None,
) -> None:
    """Write the shards of a synthesiser.

    Parameters
    ----------
    calls
        File of calls to speak, one JSON object a line with its ``text`` and ``callsign``; None:
        ``count`` calls of the corpus.

    Raises
    ------
    SpeechError
        There is no such synthesiser or voice, or it fails.
    """
    made_by = synthesiser(name)
    chosen = made_by.choose(voices)
    rng = random.Random(f"{name} {seed}")  # Synthesisers say different things.
    if calls is None:
        texts = "names" if held_out_names else ""
        of_calls = made_up(count, rng, held_out_names=held_out_names)
    else:
        texts = calls.stem
        of_calls = iter([json.loads(line) for line in calls.read_text().splitlines()])
    utterances = speech(made_by, chosen, of_calls, rng)
    begin = stem(name, voices, texts)
    folder.mkdir(parents=True, exist_ok=True)
    for shard in count_from(0):
        spoken = list(islice(utterances, SHARD))
        if not spoken:
            break
        lines = [json.dumps(about | {"samples": len(pcm)}) for about, pcm in spoken]
        path = folder / f"{begin}-{seed}-{shard:03d}"
        np.save(path.with_suffix(".tmp.npy"), np.concatenate([pcm for _, pcm in spoken]))
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
    parser.add_argument(
        "--held-out-names",
        action="store_true",
        help="places and fixes that no training text has, instead of the others",
    )
    parser.add_argument(
        "--calls", type=Path, help="file of calls to speak instead of the corpus (.jsonl)"
    )
    given = parser.parse_args()
    try:
        write(
            given.folder,
            given.synthesiser,
            given.count,
            given.seed,
            given.voices,
            held_out_names=given.held_out_names,
            calls=given.calls,
        )
    except SpeechError as error:
        print(f"asr_speech.py: {error}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
