"""Callsigns: which of those on the frequency a call names.

Full callsigns are those of ICAO Annex 10 volume II, 5.2.1.7.2.1; abbreviated ones those of
5.2.1.7.2.2 (the first sign or the maker, and the last two signs) and of FAA Order JO 7110.65,
2-4-9 (the prefix and the last three). A flight number has no abbreviated form.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from typing import NamedTuple

from airhilt.phraseology.alphabet import LETTER_OF, LETTERS
from airhilt.phraseology.numbers import SOUNDS
from airhilt.phraseology.telephony import AIRLINES, names
from airhilt.phraseology.words import UNITS, tokens

MAKERS = (
    "november", "cessna", "piper", "beech", "cirrus", "bonanza", "baron", "cherokee", "skyhawk",
    "skylane", "diamond", "mooney", "citation", "learjet", "gulfstream", "kingair", "helicopter",
)  # fmt: skip
"""First words of the callsign of an aircraft of the United States (FAA AIM 4-2-4)."""
VEHICLES = {"PLOW": ("snowplow",), "FIRE": ("firetruck",), "OPS": ("operations",)}
"""Spoken names of vehicles, by the letters of their callsigns."""
WAKE = frozenset({"heavy", "super"})
"""Words after the callsign of a large aircraft (ICAO Doc 4444, 4.9.2; FAA Order JO 7110.65,
2-4-15)."""
LEADING = frozenset({"okay", "ok", "and", "break", "alright"})
"""Words that may stand before the callsign at the beginning of a call."""

FULL = 1.0
"""Score of a callsign that is said in full."""
ABBREVIATED = 0.9
"""Score of a callsign that is abbreviated."""
MISSPELT = 0.95
"""Factor for a misspelt name with the right number; the other factor is their similarity."""
CONTINUED = 0.7
"""Factor for a callsign that is followed by a letter, which may belong to another callsign."""
ONLY_NUMBER = 0.5
"""Score of a right number whose name is missing or another's."""
ONLY_NAME = 0.3
"""Score of a right name with another number; the similarity of the numbers at most doubles it."""
ACCEPTED = 0.6
"""Least score at which a call is taken to name an actor."""
ALIKE = 0.7
"""Least similarity of a name with one on the frequency."""
MARGIN = 0.1
"""Difference of scores below which two candidates are ambiguous."""

_LONGEST_NAME = 4
_AIRLINE = re.compile(r"([A-Z]{3})([0-9][0-9A-Z]{0,3})")
_AMERICAN = re.compile(r"N([1-9][0-9]{0,4}[A-Z]{0,2})")
_REGISTRATION = re.compile(r"([A-Z0-9]{1,2})-([A-Z0-9]{2,5})|([A-Z])([A-Z]{4})")
_NAMED = re.compile(r"([A-Z]+)([0-9]+)")


class Form(NamedTuple):
    """One spoken form of a callsign."""

    name: str
    """Words of the name, joined."""
    signs: str
    """Digits and letters after the name."""
    worth: float = FULL


@dataclass(frozen=True, slots=True)
class Candidate:
    """A callsign on the frequency that may have been said, with a score in [0, 1]."""

    callsign: str
    score: float


@dataclass(frozen=True, slots=True)
class CallsignMatch:
    """The callsign on the frequency that a call says.

    ``callsign`` is that of the best candidate if its score is high enough, even if it is ambiguous.
    """

    callsign: str | None
    score: float
    ambiguous: bool
    candidates: tuple[Candidate, ...]
    """Candidates, the best first."""


NOBODY = CallsignMatch(None, 0.0, False, ())


class Hit(NamedTuple):
    """Words of a call that may be a callsign."""

    start: int
    end: int
    score: float
    callsign: str
    left_over: str = ""
    """Digits of the last word that do not belong to the callsign."""
    is_mended: bool = False


@dataclass(frozen=True, slots=True)
class Naming:
    """The callsigns in a call."""

    match: CallsignMatch
    hit: Hit | None = None
    addressed_first: bool = False
    again: tuple[Hit, ...] = ()
    """Other places with the same callsign."""
    others: tuple[Hit, ...] = ()
    """Places that name another callsign, or may do so."""


def forms(callsign: str) -> tuple[Form, ...]:
    """Return the spoken forms of a callsign, the full ones first."""
    airline = _AIRLINE.fullmatch(callsign)
    if airline and airline[1] in AIRLINES:
        said = (airline[1].lower(), *(_joined(name) for name in names(airline[1])))
        return tuple(Form(name, airline[2]) for name in dict.fromkeys(said))
    american = _AMERICAN.fullmatch(callsign)
    if american:
        return tuple(_of_registration("n", american[1], "N" + american[1]))
    registration = _REGISTRATION.fullmatch(callsign)
    if registration:
        signs = callsign.replace("-", "")
        spelled = _of_registration(signs[0].lower(), signs[1:], signs)
        return (*spelled, Form(_joined(callsign), ""))
    named = _NAMED.fullmatch(callsign)
    if named:
        said = (named[1].lower(), *VEHICLES.get(named[1], ()))
        return tuple(Form(name, named[2]) for name in said)
    return (Form("".join(tokens(callsign)), ""),)


def _of_registration(first: str, rest: str, signs: str) -> Iterator[Form]:
    spelled = [LETTERS[ord(first) - ord("a")]] if first.isalpha() else []
    prefixes = [first, *spelled, *(maker for maker in MAKERS if maker != "november")]
    for prefix in prefixes:
        yield Form(prefix, rest)
        if prefix not in (first, *spelled) and first != "n":
            yield Form(prefix, signs)
    for size in (3, 2):
        if len(rest) > size:
            yield from (Form(prefix, rest[-size:], ABBREVIATED) for prefix in prefixes)


def _joined(name: str) -> str:
    return "".join(tokens(name))


_KNOWN_NAMES = frozenset(_joined(name) for designator in AIRLINES for name in names(designator))


@dataclass(frozen=True)
class Roster:
    """The callsigns on a frequency, by their spoken forms."""

    by_name: dict[str, list[tuple[str, str, float]]] = field(default_factory=dict)
    """Signs after the name, callsign and score, by name."""
    by_number: dict[str, list[tuple[str, str, str, float]]] = field(default_factory=dict)
    """Name, all signs, callsign and score, by the digits right after the name."""

    def naming(self, words: list[str]) -> Naming:
        """Return the callsigns that a call names.

        If there are several, the match is the one that begins the call, or else the one that ends
        it, or else the first.
        """
        hits, near = self._find(words)
        lead = 0
        while lead < len(words) and words[lead] in LEADING:
            lead += 1
        if not any(hit.start <= lead or hit.end == len(words) for hit in hits):
            more, unnamed = self._find_misspelt(words)
            hits += more
            near += unnamed
        if not hits:
            return Naming(_best(None, near)) if near else Naming(NOBODY)
        chosen = min(
            hits,
            key=lambda hit: (
                hit.start > lead, hit.end < len(words), hit.start, -hit.end, -hit.score,
                hit.callsign,
            ),
        )  # fmt: skip
        same_place = [hit for hit in hits if hit.start < chosen.end and chosen.start < hit.end]
        longest = [
            hit
            for hit in same_place
            if not any(o.start <= hit.start and o.end > hit.end for o in same_place)
        ]
        chosen = max(longest, key=lambda hit: (hit.score, -hit.start))
        rivals = [hit for hit in near if hit.start < chosen.end and chosen.start < hit.end]
        match = _best(chosen, [*longest, *rivals])
        apart = [hit for hit in hits if hit.start >= chosen.end or hit.end <= chosen.start]
        again = tuple(hit for hit in apart if hit.callsign == chosen.callsign)
        unread = [hit for hit in near if not _may_be_taxiway(words, hit.start)]
        others = tuple(hit for hit in (*apart, *unread) if hit.callsign != chosen.callsign)
        return Naming(match, chosen, chosen.start <= lead, again, others)

    def _find(self, words: list[str]) -> tuple[list[Hit], list[Hit]]:
        """Return the places of names with their own numbers, and of names with others."""
        hits: list[Hit] = []
        near: list[Hit] = []
        size = len(words)
        for start in range(size):
            name = ""
            for at in range(start, min(start + _LONGEST_NAME, size)):
                word = words[at]
                if word[0].isdigit() and at > start:
                    break
                name += word
                for signs, callsign, worth in self.by_name.get(name, ()):
                    hit = _read(words, start, at + 1, signs, callsign, worth)
                    if hit:
                        hits.append(hit)
                    elif worth == FULL and at + 1 < size and words[at + 1][0].isdigit():
                        score = ONLY_NAME * (1.0 + similarity(words[at + 1], signs))
                        near.append(Hit(start, at + 2, min(score, 0.59), callsign))
        return hits, near

    def _find_misspelt(self, words: list[str]) -> tuple[list[Hit], list[Hit]]:
        """Return the places of numbers after a name similar to their own, and of those without."""
        hits: list[Hit] = []
        unnamed: list[Hit] = []
        for at, word in enumerate(words):
            if not word[0].isdigit():
                continue
            said = _names_before(words, at)
            for name, signs, callsign, worth in self.by_number.get(word, ()):
                read = _read(words, at, at, signs, callsign, worth)
                if read is None or any(text == name for _, text in said):
                    continue
                start, alike = max(
                    ((start, similarity(text, name)) for start, text in said),
                    key=lambda each: (each[1], each[0]),
                    default=(at, 0.0),
                )
                if alike >= ALIKE and not any(text in _KNOWN_NAMES for _, text in said):
                    score = MISSPELT * alike * read.score
                    hits.append(read._replace(start=start, score=score, is_mended=True))
                elif worth == FULL:
                    unnamed.append(read._replace(score=ONLY_NUMBER))
        return [hit for hit in hits if hit.score >= ACCEPTED], unnamed


def _may_be_taxiway(words: list[str], at: int) -> bool:
    """Return whether a letter and a number may be a taxiway."""
    return words[at] in LETTER_OF and len(words[at + 1]) <= 2


def _names_before(words: list[str], at: int) -> list[tuple[int, str]]:
    """Return possible names before a number: the last one to three words, joined."""
    said: list[tuple[int, str]] = []
    name = ""
    for start in range(at - 1, max(at - _LONGEST_NAME, -1), -1):
        if words[start][0].isdigit():
            break
        name = words[start] + name
        said.append((start, name))
    return said


def _read(
    words: list[str], start: int, at: int, signs: str, callsign: str, worth: float
) -> Hit | None:
    """Return the hit if the words from ``at`` on are these signs."""
    read, size, left_over = 0, len(signs), ""
    is_mended = False
    while read < size:
        if at == len(words):
            return None
        word = words[at]
        rest = signs[read:]
        if word[0].isdigit():
            if rest.startswith(word):
                read += len(word)
            elif rest.isdigit() and word.startswith(rest) and words[at + 1 : at + 2] in _UNIT:
                read, left_over = size, word[len(rest) :]
                worth *= ABBREVIATED
            else:
                return None
        elif LETTER_OF.get(word) == rest[0]:
            read += 1
        elif len(word) <= 3 and rest.startswith(word.upper()):
            read += len(word)
        elif SOUNDS.get(word) == rest[0]:
            read += 1
            is_mended = True
        else:
            return None
        at += 1
    if at < len(words) and words[at] in LETTER_OF and size:
        if signs[-1].isalpha():
            return None
        worth *= CONTINUED
    if at < len(words) and words[at] in WAKE:
        at += 1
    return Hit(start, at, worth, callsign, left_over, is_mended)


_UNIT = tuple([unit] for unit in UNITS)


def _best(chosen: Hit | None, hits: list[Hit]) -> CallsignMatch:
    scores: dict[str, float] = {}
    for hit in hits:
        scores[hit.callsign] = max(scores.get(hit.callsign, 0.0), hit.score)
    candidates = tuple(
        Candidate(callsign, score)
        for callsign, score in sorted(scores.items(), key=lambda each: (-each[1], each[0]))
    )
    best = candidates[0].score
    ambiguous = len(candidates) > 1 and candidates[1].score >= best - MARGIN
    return CallsignMatch(chosen and candidates[0].callsign, best, ambiguous, candidates)


@lru_cache(maxsize=64)
def roster_of(callsigns: tuple[str, ...]) -> Roster:
    """Return the roster of a frequency; it is computed once for each set of callsigns."""
    roster = Roster()
    for callsign in dict.fromkeys(callsigns):
        for name, signs, worth in forms(callsign):
            roster.by_name.setdefault(name, []).append((signs, callsign, worth))
            number = re.match(r"[0-9]+", signs)
            if number and len(name) >= 3:
                entry = (name, signs, callsign, worth)
                roster.by_number.setdefault(number[0], []).append(entry)
    return roster


@lru_cache(maxsize=4096)
def similarity(first: str, second: str) -> float:
    """Return the similarity of two texts by their edit distance, from 0 to 1 (equal)."""
    if first == second:
        return 1.0
    longest = max(len(first), len(second))
    row = list(range(len(second) + 1))
    for i, sign in enumerate(first, start=1):
        diagonal, row[0] = row[0], i
        for j, other in enumerate(second, start=1):
            diagonal, row[j] = (
                row[j],
                min(row[j] + 1, row[j - 1] + 1, diagonal + (sign != other)),
            )
    return 1.0 - row[-1] / longest
