"""Names that are spoken on the radio: airlines, places, fixes and procedures.

A recogniser has to spell names that it never met. So a tenth of the places and fixes, chosen by a
hash of the name, is held out of training and makes the names of tests.
"""

from __future__ import annotations

import random
import re
import zlib
from functools import lru_cache
from pathlib import Path

from airhilt.phraseology.telephony import TELEPHONY
from asr_values import DIGITS, LETTERS, PRONOUNCED, TENS

PLACES = Path(__file__).with_name("asr_places.txt")
WORDS = tuple(
    Path(__file__).with_name(name) for name in ("asr_forms.txt", "asr_english.txt", "asr_words.txt")
)
KNOWN_PLACES = (
    "washington|potomac|kennedy|newark|boston|chicago|atlanta|denver|seattle|miami|dallas|"
    "houston|oakland|san francisco|norcal|socal|los angeles|phoenix|memphis|minneapolis|"
    "cleveland|indianapolis|jacksonville|new york|amsterdam|schiphol|london|heathrow|gatwick|"
    "manchester|scottish|paris|frankfurt|munich|langen|zurich|geneva|vienna|madrid|barcelona|"
    "lisbon|rome|milano|copenhagen|stockholm|oslo|helsinki|warsaw|prague|budapest|athens|"
    "istanbul|dubai|tokyo|haneda|narita|osaka|singapore|sydney|melbourne|shannon|dublin|"
    "brussels|rhein|maastricht|reykjavik|toronto|montreal|vancouver|gander|moncton"
).split("|")
"""Places that are never held out, among them those of the scenarios."""
HELD_OUT_SHARE = 10
"""One name in this many is held out."""
_SYLLABLES = {
    "C": "bbccddffggghhjkkkllllmmmmnnnnnpppprrrrrssssstttttvvwyz",
    "V": "aaaaeeeeeiiiioooouuy",
    "B": "bl br ch cl cr dr fl fr gl gr kl kn kr pl pr qu sc sh sk sl sm sn sp st sw th tr tw wh"
    .split(),
    "E": "ck ct ft ld lk ll lm lp lt mp nd ng nk nn nt pp ps rd rk rl rm rn rp rs rt sh sk sp ss"
    " st th tt xx zz".split(),
    "W": "ai ea ee ie oa oo ou ay ey oy".split(),
    "e": "e", "y": "y",
}  # fmt: skip
"""Letters by their part in a name: consonants, vowels, beginnings, endings, long vowels."""
_SHAPES = (
    "CVCVC CVCVC CVCVC CVEV CVEe CVEy BVCV BVCe BVE BVCC VCVCV VEVC CWCV CWE CVCCV CVCCe VCCVC "
    "CVCWC BWC CVWC VEWC CVCVy"
).split()
"""Shapes of names; names of other lengths than five letters are drawn again."""


def is_held_out(name: str) -> bool:
    """Return whether a name is kept for tests."""
    return zlib.crc32(name.encode()) % HELD_OUT_SHARE == 0


@lru_cache(maxsize=1)
def places() -> tuple[str, ...]:
    """Return the places of the list, without those that are never held out."""
    lines = PLACES.read_text(encoding="utf-8").splitlines()
    listed = ",".join(line for line in lines if not line.startswith("#")).split(",")
    return tuple(sorted({name.strip() for name in listed} - set(KNOWN_PLACES)))


@lru_cache(maxsize=1)
def _words() -> frozenset[str]:
    """Return the words of the forms, which are no names of fixes."""
    texts = " ".join(path.read_text(encoding="utf-8") for path in WORDS)
    return frozenset((*re.findall("[a-z]+", texts), *LETTERS, *DIGITS, *PRONOUNCED, *TENS, "alpha"))


@lru_cache(maxsize=1)
def held_out_places() -> frozenset[str]:
    """Return the places that are kept for tests, none of whose words training has elsewhere."""
    training = (*KNOWN_PLACES, *(name for name in places() if not is_held_out(name)))
    known = {word for name in (*training, *TELEPHONY.values()) for word in name.split()} | _words()
    return frozenset(
        name for name in places() if is_held_out(name) and known.isdisjoint(name.split())
    )


class Names:
    """Draws names.

    Parameters
    ----------
    held_out
        True for the names of tests, False for those of training.
    """

    def __init__(self, rng: random.Random, *, held_out: bool = False) -> None:
        self._rng = rng
        self._held_out = held_out
        kept = held_out_places()
        self._places = [name for name in places() if (name in kept) == held_out]

    def place(self) -> str:
        """Return a place: one of those that are always known, or of the list."""
        rng = self._rng
        return rng.choice(KNOWN_PLACES if rng.random() < 0.25 else self._places)

    def fix(self) -> str:
        """Return a name of five letters that can be spoken, as ICAO Annex 11, appendix 2, asks."""
        while True:
            shape = self._rng.choice(_SHAPES)
            name = "".join(self._rng.choice(_SYLLABLES[part]) for part in shape)
            is_new = len(name) == 5 and name not in _words() and _is_speakable(name)
            if is_new and is_held_out(name) == self._held_out:
                return name

    def waypoint(self) -> str:
        """Return a fix, or a navigation aid that has the name of a place."""
        if self._rng.random() < 0.75:
            return self.fix()
        return self.place() + self._rng.choice(("", "", " v o r", " vor", " n d b"))


def _is_speakable(name: str) -> bool:
    return re.search(r"(.)\1\1|[aeiouy]{3}|uu|ii|aa|yy|^(?:ck|ng)|[jv]$", name) is None
