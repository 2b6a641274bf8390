"""Callsigns: which of those on the frequency a call names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import NamedTuple

from airhilt.phraseology.aircraft_names import MAKERS
from airhilt.phraseology.alphabet import LETTER_OF
from airhilt.phraseology.callsign_repair import Known, repaired, similarity
from airhilt.phraseology.hits import STATIONS, Hit, is_spoken_of, read
from airhilt.phraseology.spoken_forms import FULL, MAKER, forms, is_registration

LEADING = frozenset({"okay", "ok", "and", "break", "alright"})
"""Words that may stand before the callsign at the beginning of a call."""
OPENING = LEADING | {
    "hello", "good", "morning", "afternoon", "evening", "day", "pan", "mayday", "roger", "wilco",
    "affirm", "affirmative", "negative", "sir", "maam",
}  # fmt: skip
"""Words that may stand between the name of a unit and a callsign."""
LONGEST_STATION = 4
"""Most words of the name of a unit."""
ONLY_NAME = 0.3
"""Score of a right name with another number; the similarity of the numbers at most doubles it."""
MARGIN = 0.1
"""Difference of scores below which two candidates are ambiguous."""

_LONGEST_NAME = 4


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


class Naming(NamedTuple):
    """The callsigns in a call."""

    match: CallsignMatch
    hit: Hit | None = None
    addressed_first: bool = False
    again: tuple[Hit, ...] = ()
    """Other places with the same callsign."""
    others: tuple[Hit, ...] = ()
    """Places that name another callsign, or may do so."""


@dataclass(frozen=True)
class Roster:
    """The callsigns on a frequency, by their spoken forms."""

    by_name: dict[str, list[tuple[str, str, float]]] = field(default_factory=dict)
    """Signs after the name, callsign and score, by name."""
    known: list[Known] = field(default_factory=list)
    beginnings: set[str] = field(default_factory=set)
    """First letters, of any number, of the names."""

    def naming(self, words: list[str], *, is_written: bool = False) -> Naming:
        """Return the callsigns that a call names.

        If there are several, the match is the one that begins the call, or else the one that ends
        it, or else the first.

        Parameters
        ----------
        is_written
            True if nothing can have been misheard: a garbled callsign is none.
        """
        hits, near = self._find(words)
        lead = 0
        while lead < len(words) and words[lead] in LEADING:
            lead += 1
        openings = (lead, *_after_opening(words))
        mine = [hit for hit in hits if not is_spoken_of(words, hit.start, hit.end)]
        for hit in mine:
            if hit.start <= lead or hit.start in openings or hit.end == len(words):
                break
        else:
            more, unlikely = ([], []) if is_written else repaired(words, self.known, openings)
            mine += more
            near += unlikely
        if not mine:
            return Naming(_best(None, near)) if near else Naming(NOBODY)
        return self._naming(words, mine, [*hits, *mine], near, openings)

    def _naming(
        self,
        words: list[str],
        mine: list[Hit],
        hits: list[Hit],
        near: list[Hit],
        openings: tuple[int, ...],
    ) -> Naming:
        """Return the callsigns of a call from those that may be of its speaker or addressee."""
        longest = _longest(mine, openings, len(words)) if len(mine) > 1 else mine
        chosen = longest[0]
        rivals = [hit for hit in near if hit.start < chosen.end and chosen.start < hit.end]
        match = _best(chosen, [*longest, *rivals])
        if _is_one_of_two(words, chosen, hits):
            match = replace(match, ambiguous=True)
        again: list[Hit] = []
        others: list[Hit] = []
        for hit in hits:
            if hit.start >= chosen.end or hit.end <= chosen.start:
                (again if hit.callsign == chosen.callsign else others).append(hit)
        for hit in near:
            if hit.callsign != chosen.callsign and not _may_be_taxiway(words, hit.start):
                others.append(hit)
        return Naming(match, chosen, chosen.start <= openings[0], tuple(again), tuple(others))

    def _find(self, words: list[str]) -> tuple[list[Hit], list[Hit]]:
        """Return the places of names with their own numbers, and of names with others."""
        hits: list[Hit] = []
        near: list[Hit] = []
        size = len(words)
        for start, first in enumerate(words):
            if first not in self.beginnings:
                continue
            name = ""
            for at, word in enumerate(words[start : start + _LONGEST_NAME], start):
                if at > start and word[0].isdigit():
                    break
                name += word
                if name not in self.beginnings:
                    break
                named: Sequence[tuple[str, str, float]] = self.by_name.get(name, ())
                if name in MAKERS:
                    named = (*named, *self.by_name.get(MAKER, ()))
                for signs, callsign, worth in named:
                    hit = read(words, start, at + 1, signs, callsign, worth)
                    if hit:
                        hits.append(hit)
                    elif worth == FULL and at + 1 < size and words[at + 1][0].isdigit():
                        score = ONLY_NAME * (1.0 + similarity(words[at + 1], signs))
                        near.append(Hit(start, at + 2, min(score, 0.59), callsign))
        return hits, near


def _longest(mine: list[Hit], openings: tuple[int, ...], size: int) -> list[Hit]:
    """Return the longest hits at the place that counts, the best first.

    It is the beginning of the call, or else its end, or else the first place.
    """
    lead = openings[0]
    chosen = min(
        mine,
        key=lambda hit: (
            hit.start > lead and hit.start not in openings, hit.end < size, hit.start,
            -hit.end, -hit.score, hit.callsign,
        ),
    )  # fmt: skip
    same_place = [hit for hit in mine if hit.start < chosen.end and chosen.start < hit.end]
    longest = [
        hit
        for hit in same_place
        if not any(
            o.start <= hit.start and o.end > hit.end and o.score >= hit.score for o in same_place
        )
    ]
    return sorted(longest, key=lambda hit: (-hit.score, hit.start))


def _after_opening(words: list[str]) -> tuple[int, ...]:
    """Return the indices after the name of a unit, a greeting or a distress signal at the begin."""
    found = [at for at, word in enumerate(words[:LONGEST_STATION], 1) if word in STATIONS]
    at = found[-1] if found else 0
    while at < len(words) and words[at] in OPENING:
        at += 1
        found.append(at)
    return tuple(found)


def _is_one_of_two(words: list[str], chosen: Hit, hits: list[Hit]) -> bool:
    """Return whether "or" and another number or callsign follow: "for 177 or 1177"."""
    if words[chosen.end : chosen.end + 1] != ["or"]:
        return False
    after = words[chosen.end + 1 : chosen.end + 3]
    is_number = bool(after) and after[0][0].isdigit() and len(after[0]) > 1
    return is_number or any(hit.start == chosen.end + 1 for hit in hits)


def _may_be_taxiway(words: list[str], at: int) -> bool:
    """Return whether a letter and a number may be a taxiway."""
    return words[at] in LETTER_OF and at + 1 < len(words) and len(words[at + 1]) <= 2


def _best(chosen: Hit | None, hits: list[Hit]) -> CallsignMatch:
    scores: dict[str, float] = {}
    for hit in hits:
        scores[hit.callsign] = max(scores.get(hit.callsign, 0.0), hit.score)
    candidates = tuple([Candidate(*each) for each in scores.items()])
    if len(candidates) > 1:
        candidates = tuple(sorted(candidates, key=lambda each: (-each.score, each.callsign)))
    best = candidates[0].score
    ambiguous = len(candidates) > 1 and candidates[1].score >= best - MARGIN
    return CallsignMatch(chosen and candidates[0].callsign, best, ambiguous, candidates)


@lru_cache(maxsize=64)
def roster_of(callsigns: tuple[str, ...]) -> Roster:
    """Return the roster of a frequency; it is computed once for each set of callsigns."""
    roster = Roster()
    for callsign in dict.fromkeys(callsigns):
        said = forms(callsign)
        for name, signs, worth in said:
            roster.by_name.setdefault(name, []).append((signs, callsign, worth))
        if said[0].signs:
            is_aircraft = is_registration(callsign)
            names = () if is_aircraft else tuple(each.name for each in said)
            first = callsign[0] if is_aircraft else ""
            roster.known.append(Known(callsign, names, said[0].signs, first))
    named = {*roster.by_name, *(MAKERS if MAKER in roster.by_name else ())}
    roster.beginnings.update(name[:end] for name in named for end in range(1, len(name) + 1))
    return roster
