"""Learns the language model of the embedded recogniser from the texts of `asr_corpus`.

    python tools/asr/learn_language.py airhilt/assistant/asr/model --calls 250000

The folder holds ``pieces.txt``; ``language.npz`` is written beside it. N-grams with interpolated
Kneser-Ney smoothing and one discount an order (Chen and Goodman, 1999, section 3), in backing-off
form. N-grams of three and more pieces that occur less than `LEAST` times are left out.
"""

from __future__ import annotations

import argparse
import json
import math
import random
from collections import Counter, defaultdict
from pathlib import Path
from typing import Any

import numpy as np

from airhilt.assistant.asr.language import END, key
from airhilt.assistant.asr.pieces import Pieces
from asr_corpus import Talk

ORDER = 4
LEAST = 3
Gram = tuple[int, ...]


def texts(pieces: Pieces, calls: int, seed: int) -> list[Gram]:
    """Return calls as units, each with `END` before and after it."""
    talk = Talk(random.Random(f"language {seed}"))
    found = []
    for _ in range(calls):
        units = pieces.units(talk.call().split())
        if units is not None:
            found.append((END, *units, END))
    return found


def counts_of(calls: list[Gram]) -> list[Counter[Gram]]:
    """Return how often each n-gram occurs; below the highest order, after how many others.

    An n-gram at the beginning of a call has nothing before it and keeps its number.
    """
    highest: list[Counter[Gram]] = [Counter() for _ in range(ORDER)]
    for units in calls:
        for n in range(1, ORDER + 1):
            highest[n - 1].update(units[at : at + n] for at in range(len(units) - n + 1))
    counts = [Counter[Gram]() for _ in range(ORDER)]
    counts[-1] = highest[-1]
    for n in range(1, ORDER):
        counts[n - 1] = Counter(gram[1:] for gram in highest[n])
        for gram, count in highest[n - 1].items():
            if gram[0] == END and n > 1:
                counts[n - 1][gram] = count
    del counts[0][(END,)]
    counts[0][(END,)] = len({gram[-2] for gram in highest[1] if gram[-1] == END})
    return counts


def kept_of(counts: list[Counter[Gram]]) -> list[dict[Gram, int]]:
    """Return the n-grams that are frequent, or stand before the last unit of a longer one."""
    found: list[dict[Gram, int]] = []
    contexts: set[Gram] = set()
    for n in range(ORDER, 0, -1):
        kept = {
            gram: count
            for gram, count in counts[n - 1].items()
            if n < 3 or count >= LEAST or gram in contexts
        }
        contexts = {gram[:-1] for gram in kept}
        found.append(kept)
    return found[::-1]


def tables(counts: list[Counter[Gram]], units: int) -> list[dict[Gram, tuple[float, float]]]:
    """Return score and backoff of each n-gram, as natural logarithms."""
    found: list[dict[Gram, tuple[float, float]]] = []
    for n, (grams, kept) in enumerate(zip(counts, kept_of(counts), strict=True), start=1):
        once = sum(count == 1 for count in grams.values())
        twice = sum(count == 2 for count in grams.values())
        discount = once / (once + 2 * twice) if once else 0.5
        totals: Counter[Gram] = Counter()
        for gram, count in grams.items():
            totals[gram[:-1]] += count
        left: defaultdict[Gram, float] = defaultdict(lambda: 1.0)
        for gram, count in kept.items():
            left[gram[:-1]] -= (count - discount) / totals[gram[:-1]]
        if n == 1:
            even = left[()] / units
            found.append(
                {
                    (unit,): (
                        math.log(max(kept.get((unit,), 0) - discount, 0) / totals[()] + even),
                        0.0,
                    )
                    for unit in range(units)
                }
            )
            continue
        lower = found[-1]
        here = {}
        for gram, count in kept.items():
            seen = (count - discount) / totals[gram[:-1]]
            share = seen + left[gram[:-1]] * math.exp(_score(found, gram[1:]))
            here[gram] = (math.log(share), 0.0)
        for context, rest in left.items():
            if context in lower:
                lower[context] = (lower[context][0], math.log(max(rest, 1e-6)))
        found.append(here)
    return found


def _score(found: list[dict[Gram, tuple[float, float]]], gram: Gram) -> float:
    """Return the log-likelihood of the last unit of an n-gram, with backing off."""
    backed_off = 0.0
    while gram not in found[len(gram) - 1]:
        context = gram[:-1]
        backed_off += found[len(context) - 1].get(context, (0.0, 0.0))[1]
        gram = gram[1:]
    return backed_off + found[len(gram) - 1][gram][0]


def write(path: Path, found: list[dict[Gram, tuple[float, float]]]) -> None:
    """Write the archive that `Language` reads."""
    arrays: dict[str, Any] = {}
    for n, grams in enumerate(found, start=1):
        ordered = sorted((key(gram), *both) for gram, both in grams.items())
        arrays[f"keys{n}"] = np.array([each[0] for each in ordered], np.uint64)
        arrays[f"scores{n}"] = np.array([each[1] for each in ordered], np.float16)
        arrays[f"backoffs{n}"] = np.array([each[2] for each in ordered], np.float16)
    np.savez_compressed(path, **arrays)


def main() -> None:
    """Write the language model of a model's folder, and note it in its card."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", type=Path)
    parser.add_argument("--calls", type=int, default=250_000)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    pieces = Pieces((given.model / "pieces.txt").read_text(encoding="utf-8").split())
    found = tables(counts_of(texts(pieces, given.calls, given.seed)), len(pieces) + 1)
    write(given.model / "language.npz", found)
    card = given.model / "card.json"
    if card.exists():
        about = {"calls": given.calls, "seed": given.seed, "ngrams": [len(each) for each in found]}
        card.write_text(
            json.dumps(json.loads(card.read_text()) | {"language": about}, indent=2) + "\n"
        )
    print(f"n-grams: {', '.join(str(len(each)) for each in found)}")


if __name__ == "__main__":
    main()
