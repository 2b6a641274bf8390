"""Finds the callsigns of a roster in the posteriors of a call.

The roster says who may be on the frequency, and a name that is half heard is probably one of
those. For each way to say a callsign the likeliest alignment is found (Viterbi over the CTC states
of its pieces, which may begin and end anywhere in the call). It is compared with the likeliest path
of all over the same time. If little is lost, the callsign counts as said.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from airhilt.assistant.asr.pieces import Pieces
from airhilt.phraseology import LETTERS, TELEPHONY
from airhilt.phraseology.numbers import speak_digits, speak_group
from airhilt.phraseology.telephony import names

SAME = (("nine", "niner"), ("three", "tree"), ("five", "fife"), ("four", "fower"))
"""Words that stand for the same digit."""
MOST_LOSS = 2.5
"""Largest `Spotted.loss` with which a callsign was said. Chosen on calls like those of training
(``tools/asr/calibrate_asr.py``), and on calls by somebody whose callsign is one digit off."""
MARGIN = 0.3
"""Least loss, per word, by which every other callsign must fit worse."""
LEAST_POSTERIOR = 1e-8
_AIRLINE = re.compile(r"([A-Z]{3})([0-9]{1,4})([A-Z]{0,2})")
_AMERICAN = re.compile(r"N([1-9][0-9]{0,4}[A-Z]{0,2})")


@dataclass(frozen=True, slots=True)
class Spotted:
    """A callsign where it was probably said."""

    callsign: str
    words: tuple[str, ...]
    begin: int
    """First step of its alignment."""
    end: int
    """Step after the last one of its alignment."""
    loss: float
    """Log-likelihood lost against the likeliest path there, per word; 0 if it is that path."""


def is_same(one: Sequence[str], other: Sequence[str]) -> bool:
    """Return whether words are the same, or stand for the same digits."""
    first_of = {word: variants[0] for variants in SAME for word in variants}
    return [first_of.get(word, word) for word in one] == [first_of.get(w, w) for w in other]


def spoken_forms(callsign: str) -> Iterator[tuple[str, ...]]:
    """Yield the ways to say a flight number or a registration of the United States in full."""
    airline = _AIRLINE.fullmatch(callsign)
    if airline and airline[1] in TELEPHONY:
        number, letters = airline[2], _spell(airline[3])
        for name in names(airline[1]):
            yield (*name.split(), *_spell(number), *letters)
            if len(number) > 1 and number[0] != "0" and not letters:
                yield (*name.split(), *speak_group(int(number), "icao").split())
    american = _AMERICAN.fullmatch(callsign)
    if american:
        signs = _spell(american[1])
        yield ("november", *signs)
        if len(signs) >= 3:
            yield signs


def _spell(signs: str) -> tuple[str, ...]:
    return tuple(
        speak_digits(sign, "faa") if sign.isdigit() else LETTERS[ord(sign) - ord("A")]
        for sign in signs
    )


class Spotter:
    """Looks for the callsigns of one roster.

    Parameters
    ----------
    pieces
        Pieces of the recogniser.
    """

    def __init__(self, pieces: Pieces, callsigns: Sequence[str]) -> None:
        known = [
            {word: unit for word in variants if (unit := pieces.unit(word)) is not None}
            for variants in SAME
        ]
        self._same = [list(units.values()) for units in known if units]
        standing_for = {
            word: next(iter(units), word)
            for variants, units in zip(SAME, known, strict=True)
            for word in variants
        }
        self._forms: list[tuple[str, tuple[str, ...], tuple[int, ...]]] = []
        for callsign in dict.fromkeys(callsigns):
            for form in dict.fromkeys(spoken_forms(callsign)):
                words = tuple(standing_for.get(word, word) for word in form)
                units = pieces.units(words)
                if units is not None:
                    self._forms.append((callsign, words, units))
        longest = max((len(units) for _, _, units in self._forms), default=0)
        self._units = np.zeros((len(self._forms), longest), np.intp)
        for row, (_, _, units) in enumerate(self._forms):
            self._units[row, : len(units)] = units

    def spot(self, posteriors: NDArray[np.float32]) -> Spotted | None:
        """Return the callsign that fits best, if it fits and no other does about as well there.

        Parameters
        ----------
        posteriors
            Posteriors of each unit at each step, shape (steps, units).
        """
        if not self._forms or not len(posteriors):
            return None
        best, *others = sorted(
            self._aligned(self._losses(posteriors)),
            key=lambda each: (each.loss, -len(each.words), each.callsign),
        )
        rivals = (
            other.loss
            for other in others
            if other.callsign != best.callsign and other.begin < best.end and best.begin < other.end
        )
        if best.loss > MOST_LOSS or min(rivals, default=np.inf) < best.loss + MARGIN:
            return None
        return best

    def _losses(self, posteriors: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return log-likelihoods against that of the likeliest unit of each step."""
        log = np.maximum(posteriors, LEAST_POSTERIOR)
        np.log(log, out=log)
        log -= log.max(axis=1, keepdims=True)
        for variants in self._same:
            log[:, variants] = log[:, variants].max(axis=1, keepdims=True)
        return log

    def _aligned(self, log: NDArray[np.float32]) -> Iterator[Spotted]:
        """Yield the best alignment of each form.

        A form has a state for each of its pieces and one for the gap after it.
        """
        count, size = self._units.shape
        repeats = np.zeros((count, size), bool)
        repeats[:, 1:] = self._units[:, 1:] == self._units[:, :-1]
        last = np.array([len(units) - 1 for _, _, units in self._forms])
        rows = np.arange(count)
        best = np.full(count, -np.inf, np.float32)
        best_begin, best_end = np.zeros((2, count), np.intp)
        word, gap = np.full((2, count, size), -np.inf, np.float32)
        word_begin, gap_begin = np.zeros((2, count, size), np.intp)
        for step, here in enumerate(log):
            came, came_begin = np.zeros((count, size), np.float32), np.full((count, size), step)
            direct = np.where(repeats[:, 1:], -np.inf, word[:, :-1])
            is_direct = direct > gap[:, :-1]
            came[:, 1:] = np.where(is_direct, direct, gap[:, :-1])
            came_begin[:, 1:] = np.where(is_direct, word_begin[:, :-1], gap_begin[:, :-1])
            gap_begin = np.where(gap >= word, gap_begin, word_begin)
            gap = np.maximum(gap, word) + here[0]
            word_begin = np.where(word >= came, word_begin, came_begin)
            word = np.maximum(word, came) + here[self._units]
            ended = word[rows, last]
            is_better = ended > best
            best = np.where(is_better, ended, best)
            best_begin = np.where(is_better, word_begin[rows, last], best_begin)
            best_end = np.where(is_better, step + 1, best_end)
        for row, (callsign, words, _) in enumerate(self._forms):
            loss = -float(best[row]) / len(words)
            yield Spotted(callsign, words, int(best_begin[row]), int(best_end[row]), loss)
