"""Recognition errors: words lost, words heard as others that sound alike, "uh" put in.

Word pairs come from a short table of confusions, and from a key of each word's sound: the words of
the corpus whose keys are close may replace each other. The key is made by rules for English
spelling, in the manner of Metaphone, with classes of vowels kept.
"""

from __future__ import annotations

import random
import re
from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cache

from .model import Call

CONFUSIONS = {
    group[0]: tuple(word.replace("_", " ") for word in group[1:])
    for line in (
        "two to too|to two|four for or|for four|eight ate a|one won|won one|five fife nine|"
        "nine niner five|niner nine minor nina|six sick sixth|three tree free|seven eleven heaven|"
        "zero xero hero|thousand thousands|hundred hundreds under|climb clime climbed|"
        "descend descent ascend the_send|left lift laughed|right write bright|heading headin head|"
        "maintain maintaining main|cleared clear clears|runway run_way|approach a_approach|"
        "takeoff take_off|hold old whole|short sort shore|cross across cost|contact contract|"
        "tower hour power|ground round crowned|direct directly erect|knots nots not|"
        "level leveled devil|flight light fly|speed peed spied|reduce produce|squawk squat walk|"
        "traffic graphic terrific|established establish|until and till|localizer localiser|"
        "point pint points|decimal desimal|turn turned churn|ils i_l_s|visual visually|"
        "land lend landed|line lime|wait weight|behind be_hind|via by a|expect expects inspect|"
        "delta dealt_a|united unite_it|american a_merrican|charlie charley|alfa alpha|echo eco|"
        "lima lemur|quebec kebec|mike my|hotel motel|golf gulf|and an in|the a|at that"
    ).split("|")
    if (group := line.split())
}
"""Words and what recognisers write in their place; "_" stands for a space."""
LOSING, HEARING, ADDING = 0.3, 0.55, 0.15
"""Shares of deletions, substitutions and insertions among the errors."""
RULES = (
    (r"^(kn|gn|pn|wr)", lambda m: m.group()[1]),
    (r"ght", "t"),
    (r"ph", "f"),
    (r"(tch|ch)", "C"),
    (r"(sh|ti(?=on)|ci(?=a))", "S"),
    (r"th", "0"),
    (r"(ck|q|x(?=$))", "k"),
    (r"c(?=[eiy])", "s"),
    (r"c", "k"),
    (r"g(?=[eiy])", "j"),
    (r"mb$", "m"),
    (r"z", "s"),
    (r"wh", "w"),
    (r"(ee|ea|ie|y$|ey)", "i"),
    (r"(oo|ou|ow|au|aw|oa)", "o"),
    (r"(ai|ay|ei)", "e"),
    (r"(.)\1", lambda m: m.group(1)),
    (r"(?<=[^aeiou])e$", ""),
)
"""Spelling rules in their order, from letters to sounds."""


def degraded(calls: Iterable[Call], rate: float, seed: int) -> list[Call]:
    """Return calls with errors; their truth stays what was said, and `said` holds the words.

    Parameters
    ----------
    calls
        The calls as they were said.
    rate
        The share of words with an error, 0 to 1.
    seed
        The seed of the errors.
    """
    if not 0 <= rate <= 1:
        raise ValueError(f"error rate is {rate}; expected 0 to 1")
    given = list(calls)
    known = sorted({word for call in given for word in call.text.split()})
    similar = Similar(known)
    rng = random.Random(seed + 1)
    return [
        replace(call, text=_with_errors(call.text, rate, rng, similar), said=call.text)
        for call in given
    ]


class Similar:
    """Words of a vocabulary that sound like a given one."""

    def __init__(self, vocabulary: Sequence[str]) -> None:
        self._keys = {word: sound(word) for word in vocabulary}
        self._found: dict[str, tuple[str, ...]] = {}

    def to(self, word: str) -> tuple[str, ...]:
        """Return the words that sound alike; none where there is none."""
        if word not in self._found:
            self._found[word] = CONFUSIONS.get(word, ()) + self._near(word)
        return self._found[word]

    def _near(self, word: str) -> tuple[str, ...]:
        key = self._keys.get(word) or sound(word)
        most = 1 if len(key) < 6 else 2
        return tuple(
            other
            for other, theirs in self._keys.items()
            if other != word
            and abs(len(theirs) - len(key)) <= most
            and distance(key, theirs) <= most
            and len(key) > 2
        )


@cache
def sound(word: str) -> str:
    """Return a key of how a word sounds: "knots" and "nots" have one key."""
    key = re.sub(r"[^a-z]", "", word)
    for pattern, sounds in RULES:
        key = re.sub(pattern, sounds, key)
    return key


def distance(one: str, other: str) -> int:
    """Return the number of sounds to add, drop or change from one key to the other."""
    row = list(range(len(other) + 1))
    for i, left in enumerate(one, start=1):
        before, row[0] = row[0], i
        for j, right in enumerate(other, start=1):
            before, row[j] = row[j], min(row[j] + 1, row[j - 1] + 1, before + (left != right))
    return row[-1]


def _with_errors(text: str, rate: float, rng: random.Random, similar: Similar) -> str:
    heard: list[str] = []
    for word in text.split():
        if rng.random() >= rate:
            heard.append(word)
            continue
        kind = rng.choices(("lose", "hear", "add"), (LOSING, HEARING, ADDING))[0]
        if kind == "hear" and (others := similar.to(word)):
            heard.append(rng.choice(others))
        elif kind == "add":
            heard += [rng.choice(("uh", "um")), word]
    return " ".join(heard) or text
