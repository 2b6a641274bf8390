"""Finds the callsigns of a roster in the posteriors of a call.

The roster says who may be on the frequency, and a callsign that is half heard is probably one of
those. For each way to say a callsign the likeliest alignment is found (Viterbi over the CTC states
of its pieces, which may begin and end anywhere in the call). Its loss against the likeliest path of
all over the same time gives the odds that it was said rather than nobody of the roster called.
Callsigns at the same place share the probability (Bayes' rule).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from airhilt.assistant.asr.pieces import Pieces
from airhilt.phraseology import LETTERS, TELEPHONY
from airhilt.phraseology.numbers import speak_digits, speak_group
from airhilt.phraseology.spoken_forms import MAKER, forms, is_registration
from airhilt.phraseology.telephony import names

SAME = (
    ("zero", "oh"), ("nine", "niner"), ("three", "tree"), ("five", "fife"), ("four", "fower")
)  # fmt: skip
"""Words that stand for the same digit."""
TAKEN = 0.5
"""Least confidence with which a callsign counts as said."""
NAME_WEIGHT = 0.4
"""Weight of what is lost in a name, against what is lost in digits and letters.

Names are many and are heard badly, signs are few. The calls of two tests were likelier by 0.4 and
0.15 than by 1, and about alike by both."""
LEAST_BARE = 3
"""Least signs of a registration that are looked for without its first sign: fewer are in any
call, as a value."""
LEAST_POSTERIOR = 1e-8
_AIRLINE = re.compile(r"([A-Z]{3})([0-9]{1,4})([A-Z]{0,2})")


class SpokenForm(NamedTuple):
    """One way to say a callsign."""

    name: tuple[str, ...]
    """Words of the airline's name; empty for a registration."""
    signs: tuple[str, ...]
    """Words of digits and letters."""


@dataclass(frozen=True)
class Odds:
    """Log-odds that somebody of the roster was called so, and not nobody of it.

    They are linear in the words of the form and in the log-likelihood that it loses.
    """

    offset: float
    name: float
    """Log-odds that a word of the name adds."""
    sign: float
    """Log-odds that the word of a digit or a letter adds."""
    loss: float
    """Log-odds that a unit of loss takes away."""

    def __call__(self, aligned: Aligned) -> float:
        """Return the log-odds of an alignment."""
        form = aligned.form
        said = self.name * len(form.name) + self.sign * len(form.signs)
        return self.offset + said - self.loss * aligned.loss


class Aligned(NamedTuple):
    """A form of a callsign where it fits best."""

    callsign: str
    form: SpokenForm
    begin: int
    """First step of its alignment."""
    end: int
    """Step after the last one of its alignment."""
    loss: float
    """Log-likelihood lost against the likeliest path there, in the name by `NAME_WEIGHT`."""


@dataclass(frozen=True, slots=True)
class Spotted:
    """A callsign where it was probably said."""

    callsign: str
    words: tuple[str, ...]
    begin: int
    """First step of its alignment."""
    end: int
    """Step after the last one of its alignment."""
    confidence: float
    """Probability that it was said, and neither another of the roster nor none."""


def is_same(one: Sequence[str], other: Sequence[str]) -> bool:
    """Return whether words are the same, or stand for the same digits."""
    first_of = {word: variants[0] for variants in SAME for word in variants}
    return [first_of.get(word, word) for word in one] == [first_of.get(w, w) for w in other]


def spoken_forms(callsign: str) -> Iterator[SpokenForm]:
    """Yield the ways to say a flight number or a registration, in full or abbreviated.

    A registration may follow the name of a maker, which is not part of the form: "Cessna four kilo
    lima" is looked for as "four kilo lima".
    """
    airline = _AIRLINE.fullmatch(callsign)
    if airline and airline[1] in TELEPHONY:
        letters = _spell(airline[3])
        digits = airline[2]
        numbers = [_spell(digits)]
        if len(digits) > 1 and digits[0] != "0":
            numbers.append(tuple(speak_group(int(digits), "faa").split()))
        for name in names(airline[1]):
            for number in numbers:
                yield SpokenForm(tuple(name.split()), (*number, *letters))
    elif is_registration(callsign):
        for name, signs, _ in forms(callsign):
            if name == MAKER and len(signs) >= LEAST_BARE:
                yield SpokenForm((), _spell(signs))
            elif name != MAKER and len(name) == 1:
                yield SpokenForm((), _spell(name.upper() + signs))


def _spell(signs: str) -> tuple[str, ...]:
    return tuple(
        speak_digits(sign, "faa") if sign.isdigit() else LETTERS[ord(sign) - ord("A")]
        for sign in signs
    )


class Spotter:
    """Looks for the callsigns of one roster, but for those with a word that has no pieces."""

    def __init__(self, pieces: Pieces, callsigns: Sequence[str], odds: Odds) -> None:
        known = [
            {word: unit for word in variants if (unit := pieces.unit(word)) is not None}
            for variants in SAME
        ]
        self._odds = odds
        self._same = [list(units.values()) for units in known if units]
        standing_for = {
            word: next(iter(units), word)
            for variants, units in zip(SAME, known, strict=True)
            for word in variants
        }
        self._forms: list[tuple[str, SpokenForm]] = []
        written: list[tuple[int, ...]] = []
        names: list[int] = []
        for callsign in dict.fromkeys(callsigns):
            for name, said in dict.fromkeys(spoken_forms(callsign)):
                signs = tuple(standing_for.get(word, word) for word in said)
                of_name, of_signs = pieces.units(name), pieces.units(signs)
                if of_name is not None and of_signs:
                    self._forms.append((callsign, SpokenForm(name, signs)))
                    written.append((*of_name, *of_signs))
                    names.append(len(of_name))
        longest = max(map(len, written), default=0)
        self._last = np.array([len(units) - 1 for units in written], np.intp)
        self._units = np.zeros((len(written), longest), np.intp)
        for row, units in enumerate(written):
            self._units[row, : len(units)] = units
        is_name = np.arange(longest) < np.array(names, np.intp)[:, None]
        self._weights = np.where(is_name, NAME_WEIGHT, 1.0).astype(np.float32)

    def spot(self, posteriors: NDArray[np.float32]) -> Spotted | None:
        """Return the callsign that was probably said, by posteriors of shape (steps, units)."""
        likeliest: dict[str, Aligned] = {}
        for each in sorted(self.aligned(posteriors), key=self._odds, reverse=True):
            likeliest.setdefault(each.callsign, each)
        if not likeliest:
            return None
        best, *others = likeliest.values()
        rivals = [each for each in others if each.begin < best.end and best.begin < each.end]
        odds = np.array([self._odds(best), *map(self._odds, rivals), 0.0])
        confidence = float(np.exp(odds[0] - np.logaddexp.reduce(odds)))
        if confidence < TAKEN:
            return None
        words = best.form.name + best.form.signs
        return Spotted(best.callsign, words, best.begin, best.end, confidence)

    def aligned(self, posteriors: NDArray[np.float32]) -> list[Aligned]:
        """Return the likeliest alignment of each form of each callsign.

        A form has a state for each of its pieces and one for the gap after it.
        """
        if not self._forms or not len(posteriors):
            return []
        count, size = self._units.shape
        repeats = np.zeros((count, size), bool)
        repeats[:, 1:] = self._units[:, 1:] == self._units[:, :-1]
        rows = np.arange(count)
        best = np.full(count, -np.inf, np.float32)
        best_begin, best_end = np.zeros((2, count), np.intp)
        word, gap = np.full((2, count, size), -np.inf, np.float32)
        word_begin, gap_begin = np.zeros((2, count, size), np.intp)
        for step, here in enumerate(self._losses(posteriors)):
            came, came_begin = np.zeros((count, size), np.float32), np.full((count, size), step)
            direct = np.where(repeats[:, 1:], -np.inf, word[:, :-1])
            is_direct = direct > gap[:, :-1]
            came[:, 1:] = np.where(is_direct, direct, gap[:, :-1])
            came_begin[:, 1:] = np.where(is_direct, word_begin[:, :-1], gap_begin[:, :-1])
            gap_begin = np.where(gap >= word, gap_begin, word_begin)
            gap = np.maximum(gap, word) + here[0] * self._weights
            word_begin = np.where(word >= came, word_begin, came_begin)
            word = np.maximum(word, came) + here[self._units] * self._weights
            ended = word[rows, self._last]
            is_better = ended > best
            best = np.where(is_better, ended, best)
            best_begin = np.where(is_better, word_begin[rows, self._last], best_begin)
            best_end = np.where(is_better, step + 1, best_end)
        return [
            Aligned(callsign, form, int(best_begin[row]), int(best_end[row]), -float(best[row]))
            for row, (callsign, form) in enumerate(self._forms)
        ]

    def _losses(self, posteriors: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return log-likelihoods against that of the likeliest unit of each step."""
        log = np.maximum(posteriors, LEAST_POSTERIOR)
        np.log(log, out=log)
        log -= log.max(axis=1, keepdims=True)
        for variants in self._same:
            log[:, variants] = log[:, variants].max(axis=1, keepdims=True)
        return log
