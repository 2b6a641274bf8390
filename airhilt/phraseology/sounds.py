"""Likeness of the sounds of two words.

Words of the phraseology have their phonemes in ``phonemes.csv``, which ``tools/phoneme_table.py``
makes from the CMU Pronouncing Dictionary. Other words get theirs by spelling rules. The distance is
an edit distance in which sounds of one class are half as far apart as others, as in Editex (Zobel
and Dart, "Phonetic string matching", SIGIR 1996).
"""

from __future__ import annotations

import csv
import re
from collections.abc import Callable
from functools import lru_cache
from importlib.resources import files

from airhilt.phraseology.alphabet import LETTER_OF
from airhilt.phraseology.numbers import DIGITS

CODES = {
    "AA": "a", "AE": "A", "AH": "V", "AO": "O", "AW": "W", "AY": "Y", "EH": "E", "ER": "R",
    "EY": "e", "IH": "I", "IY": "i", "OW": "o", "OY": "7", "UH": "U", "UW": "u", "B": "b",
    "CH": "C", "D": "d", "DH": "D", "F": "f", "G": "g", "HH": "h", "JH": "J", "K": "k", "L": "l",
    "M": "m", "N": "n", "NG": "N", "P": "p", "R": "r", "S": "s", "SH": "S", "T": "t", "TH": "T",
    "V": "v", "W": "w", "Y": "y", "Z": "z", "ZH": "Z",
}  # fmt: skip
"""One sign for each phoneme of the CMU Pronouncing Dictionary."""
VOWELS = frozenset("aAVOWYEReiIo7Uu")
CLASSES = ("pb", "td", "kg", "fv", "szT", "SZCJ", "TD", "mnN", "lr", "rR")
"""Consonants that are easily taken for each other: those of one place, and the nasals."""
NEAR = 0.5
"""Distance of two sounds of one class, of two vowels, and of a vowel or H from nothing; other
distances are 1."""
SIGN_ALIKE = 0.7
"""Least likeness of a word with the word of a digit or a letter that it is taken for."""

_NEAR = {(one, other) for group in (*CLASSES, "".join(VOWELS)) for one in group for other in group}
_SPELLINGS = (
    (r"\bkn|\bgn", "n"), (r"\bwr", "r"), (r"\bx", "z"), (r"tch|ch", "C"), (r"sh", "S"),
    (r"tion\b|sion\b", "SVn"), (r"ture\b", "CR"), (r"ph", "f"), (r"igh", "Y"), (r"gh", ""),
    (r"th", "T"), (r"ck|cc", "k"), (r"qu", "kw"), (r"q", "k"), (r"x", "ks"), (r"wh", "w"),
    (r"dge|dj", "J"), (r"ng\b", "N"), (r"c(?=[eiy])", "s"), (r"c", "k"), (r"g(?=[eiy])", "J"),
    (r"j", "J"), (r"ee|ea|ie(?!r)", "i"), (r"oo|ew|ue\b|ui", "u"), (r"oa|ow\b", "o"),
    (r"ou|ow", "W"), (r"ai|ay|ei|ey\b", "e"), (r"oi|oy", "7"), (r"au|aw", "O"),
    (r"(?<=[a-zA-Z])(?:er|or|ar|ir|ur|re)\b", "R"),
    (r"a(?=[bdfgklmnprstvz]e\b)", "e"), (r"i(?=[bdfgklmnprstvz]e\b)", "Y"),
    (r"o(?=[bdfgklmnprstvz]e\b)", "o"), (r"u(?=[bdfgklmnprstvz]e\b)", "u"),
    (r"(?<=[^aeiou\b])e\b|es\b(?<=[^s]es)", ""), (r"(?<=[a-zA-Z])y\b", "i"), (r"y(?![aeiou])", "I"),
    (r"o\b", "o"), (r"a\b", "V"), (r"a", "A"), (r"e", "E"), (r"i", "I"), (r"o", "a"), (r"u", "V"),
    (r"([a-zA-Z])\1", r"\1"),
)  # fmt: skip
_RULES = tuple((re.compile(pattern), sound) for pattern, sound in _SPELLINGS)


def _load() -> dict[str, str]:
    table = files(__package__).joinpath("phonemes.csv").read_text(encoding="utf-8")
    return {
        row["word"]: "".join(CODES[each] for each in row["phonemes"].split())
        for row in csv.DictReader(table.splitlines())
    }


PHONEMES = _load()
"""Sounds of the words of the phraseology."""


@lru_cache(maxsize=4096)
def sounds_of(word: str) -> str:
    """Return the sounds of a word, one sign for each."""
    known = PHONEMES.get(word)
    return known if known is not None else spelled_sounds(word)


def spelled_sounds(word: str) -> str:
    """Return the sounds of a word by its spelling."""
    text = re.sub(r"[^a-z]", "", word)
    # Sounds are capital or small letters too: each rule must see letters only once.
    made: list[str] = []
    at = 0
    while at < len(text):
        for pattern, sound in _RULES:
            found = pattern.match(text, at)
            if found and found.end() > at:
                made.append(found.expand(sound) if "\\" in sound else sound)
                at = found.end()
                break
        else:
            made.append(text[at])
            at += 1
    return "".join(sign for i, sign in enumerate(made) if i == 0 or made[i - 1] != sign)


@lru_cache(maxsize=4096)
def likeness(first: str, second: str) -> float:
    """Return how alike two words sound, from 0 to 1 (equal)."""
    return alike(sounds_of(first), sounds_of(second))


def alike(first: str, second: str) -> float:
    """Return how alike two rows of sounds are, from 0 to 1 (equal)."""
    return edit_likeness(first, second, _lost, _distance)


def edit_likeness(
    first: str,
    second: str,
    lost: Callable[[str], float] = lambda _: 1.0,
    distance: Callable[[str, str], float] = lambda sign, other: float(sign != other),
) -> float:
    """Return the likeness of two texts by their edit distance, from 0 to 1 (equal).

    Parameters
    ----------
    lost
        Distance of a sign from nothing.
    distance
        Distance of two signs.
    """
    if first == second:
        return 1.0
    row = [0.0]
    for sign in second:
        row.append(row[-1] + lost(sign))
    for sign in first:
        diagonal, row[0] = row[0], row[0] + lost(sign)
        for j, other in enumerate(second, start=1):
            diagonal, row[j] = (
                row[j],
                min(
                    row[j] + lost(sign),
                    row[j - 1] + lost(other),
                    diagonal + distance(sign, other),
                ),
            )
    return max(0.0, 1.0 - row[-1] / max(len(first), len(second)))


def _lost(sign: str) -> float:
    return NEAR if sign in VOWELS or sign == "h" else 1.0


def _distance(first: str, second: str) -> float:
    if first == second:
        return 0.0
    return NEAR if (first, second) in _NEAR else 1.0


@lru_cache(maxsize=4096)
def sign_of(word: str) -> str | None:
    """Return the digit or letter whose word sounds most like a word, None if none does."""
    said = sounds_of(word)
    best = max(_SIGNS, key=lambda each: (alike(said, each[0]), each[1]))
    return best[1] if alike(said, best[0]) >= SIGN_ALIKE else None


_SIGNS = tuple((sounds_of(word), sign) for word, sign in {**LETTER_OF, **DIGITS}.items())
