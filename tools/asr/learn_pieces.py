"""Learns the word pieces of the embedded recogniser from the texts of `asr_corpus`.

    python tools/asr/learn_pieces.py build/asr/pieces.txt --count 700

The digits, numbers and letters as they are spoken are pieces, and so is each letter, with and
without the mark of a word's beginning. The others are merged from letters, the most frequent pair
first (byte-pair encoding: Sennrich, Haddow and Birch, ACL 2016), and those that save few letters
are taken out again.

Needs tokenizers, which the package itself does not.
"""

from __future__ import annotations

import argparse
import random
import string
from collections import Counter
from pathlib import Path

from tokenizers import Tokenizer, models, pre_tokenizers, trainers

from airhilt.assistant.asr.pieces import BEGIN, Pieces
from asr_corpus import Talk
from asr_values import DIGITS, LETTERS, PRONOUNCED, TEENS, TENS

CALLS = 60_000
WHOLE = (*DIGITS, *PRONOUNCED, *TEENS, *TENS, *LETTERS, "hundred", "thousand", "decimal", "point")
"""Words that are pieces in any case: a callsign or a value is made of them."""
CANDIDATES = 3
"""Merged pieces for each one that is asked for."""
SIGNS = string.ascii_lowercase + "'"


def learn(count: int) -> list[str]:
    """Return so many pieces, in alphabetical order."""
    talk = Talk(random.Random("pieces"))
    times = Counter(word for _ in range(CALLS) for word in talk.call().split())
    certain = {BEGIN + word for word in WHOLE} | {*SIGNS} | {BEGIN + sign for sign in SIGNS}
    candidates = merged(times, CANDIDATES * count) | certain
    while len(candidates) > count:
        used = uses(times, candidates)
        surplus = sorted(candidates - certain, key=lambda piece: (saved(piece, used), piece))
        candidates -= {*surplus[: max(1, (len(candidates) - count) // 2)]}
    return sorted(candidates)


def merged(times: Counter[str], count: int) -> set[str]:
    """Return so many pieces that the most frequent pairs make."""
    tokenizer = Tokenizer(models.BPE())
    tokenizer.pre_tokenizer = pre_tokenizers.WhitespaceSplit()
    trainer = trainers.BpeTrainer(
        vocab_size=count, min_frequency=20, show_progress=False, initial_alphabet=[*SIGNS, BEGIN]
    )
    tokenizer.train_from_iterator((BEGIN + word for word in times.elements()), trainer)
    return {piece for piece in tokenizer.get_vocab() if piece != BEGIN}


def uses(times: Counter[str], pieces: set[str]) -> Counter[str]:
    """Return how often each piece is used in the texts."""
    ordered = sorted(pieces)
    inventory = Pieces(ordered)
    used: Counter[str] = Counter()
    for word, count in times.items():
        for unit in inventory.split(word) or ():
            used[ordered[unit - 1]] += count
    return used


def saved(piece: str, used: Counter[str]) -> int:
    """Return how many letters a piece saves, about."""
    return used[piece] * (len(piece.strip(BEGIN)) - 1)


def main() -> None:
    """Write the pieces, one a line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("--count", type=int, default=700)
    given = parser.parse_args()
    given.file.parent.mkdir(parents=True, exist_ok=True)
    pieces = learn(given.count)
    given.file.write_text("\n".join(pieces) + "\n", encoding="utf-8")
    print(f"{len(pieces)} pieces")


if __name__ == "__main__":
    main()
