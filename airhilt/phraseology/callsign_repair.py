"""Callsigns that a call says with a garbled or missing name, or with one sign wrong.

Only the beginning and the end of a call are searched, where a callsign stands. A name that is
misspelt may count as said. What else is found here never reaches the confidence to act upon: its
number or its registration fits only one on the frequency, and no other name contradicts it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

from airhilt.phraseology.aircraft_names import MAKERS
from airhilt.phraseology.alphabet import LETTER_OF
from airhilt.phraseology.hits import SPOKEN_OF, STATIONS, WAKE, Hit, is_spoken_of
from airhilt.phraseology.numbers import SOUNDS
from airhilt.phraseology.sounds import edit_likeness, likeness, sign_of
from airhilt.phraseology.spoken_forms import ABBREVIATED, joined
from airhilt.phraseology.telephony import AIRLINES, names

MISSPELT = 0.95
"""Factor for a misspelt name with the right number; the other factor is their similarity."""
ALIKE = 0.7
"""Least similarity of a name with one on the frequency."""
NUMBER_FITS = 0.75
"""Score of a right number or abbreviation whose name is garbled, unknown or missing."""
SHORT_NUMBER_FITS = 0.63
"""Score of a right number after a name unlike its own, of one digit after an unknown name, and of
one with digits after it."""
ALMOST = 0.62
"""Score of a right name with one sign of at least three wrong, missing or added."""
ONLY_NUMBER = 0.5
"""Score of a right number with another's name, or of an uncertain one without a name."""
LONGEST_NAME = 3
"""Most words of a name."""
INTRODUCING = frozenset(
    {"level", "heading", "runway", "decimal", "altimeter", "qnh", "squawk", "squawking", "wind",
     "speed", "maintain", "maintaining", "climb", "climbing", "descend", "descending", "to", "at",
     "above", "below", "information", "thousand", "hundred", "through", "passing", "leaving",
     "reaching", "left", "right", "mach", "degrees", "number", "via", "and", "or", "of", "short",
     "on", "for", "taxiway", "holding", "point", "reduce", "increase", "final", "hold", "cross",
     "is", "than", "until", "by", "between", "q", "h", "report", "expect", "contact", "gate",
     "stand", "fly", "increasing", "reducing", "turn", "terminal", "gusting", "gusts", "with",
     *SPOKEN_OF}
)  # fmt: skip
"""Words before a number that is a value or somebody else's, and no callsign."""
BEFORE_TAXIWAY = frozenset(
    {"via", "at", "taxiway", "of", "cross", "hold", "short", "point", "information", "gate",
     "stand", "join", "then", "with", *SPOKEN_OF}
)  # fmt: skip
"""Words before digits and letters that are no callsign."""
ENDING = frozenset(
    {"traffic", "approved", "takeoff", "land", "go", "option", "wait", "clear", "approach", "ident",
     "downwind", "base", "crosswind", "navigation", "standby", "separation", "sight", "established"}
)  # fmt: skip
"""Last words of what a call says, which belong to no name behind them."""
VALUED = frozenset(
    {"thousand", "hundred", "feet", "knots", "degrees", "miles", "mile", "oclock", "minutes",
     "minute", "decimal", "nautical", "seconds", "percent"}
)  # fmt: skip
"""Words after a number that is a value."""


class Known(NamedTuple):
    """A callsign on the frequency."""

    callsign: str
    names: tuple[str, ...]
    """Names before its signs, joined; none of a registration."""
    signs: str
    """Digits and letters after the name, or after the first sign of a registration."""
    first: str = ""
    """First sign of a registration."""


class Run(NamedTuple):
    """Digits and letters that follow each other in a call."""

    start: int
    ends: tuple[int, ...]
    """Index after the last word of each of `signs`."""
    signs: tuple[str, ...]
    """Signs up to each of `ends`."""
    is_mended: bool
    """True if a word was taken for the digit or the letter that it sounds like."""
    begins: bool = False
    """True if the run is at the beginning of the call."""


def repaired(
    words: list[str], known: Sequence[Known], openings: Sequence[int]
) -> tuple[list[Hit], list[Hit]]:
    """Return likely callsigns at the beginning and the end of a call, and unlikely ones.

    Parameters
    ----------
    openings
        Indices where a callsign at the beginning may stand.
    """
    likely: list[Hit] = []
    unlikely: list[Hit] = []
    for run, first in _runs(words, openings):
        for each in known:
            hit = _fit(words, run, first, each)
            if hit is not None:
                (unlikely if hit.score <= ONLY_NUMBER else likely).append(hit)
    return likely, unlikely


def _runs(words: list[str], openings: Sequence[int]) -> Iterator[tuple[Run, int]]:
    """Yield the runs where a callsign may be, with the first index of its name."""
    size = len(words)
    last = size - 1 if words[-1:] and words[-1] in WAKE else size
    at = 0
    while at < size:
        run = _run(words, at)
        if run is None:
            at += 1
            continue
        after = run.ends[-1]
        is_name = words[at] in LETTER_OF and after > at + 1 and words[at + 1][0].isdigit()
        opening = max((each for each in openings if each <= run.start), default=0)
        begins = run.start - opening <= LONGEST_NAME
        if (begins or after == last) and not _is_value(words, run, opening):
            yield run._replace(begins=begins), max(opening, run.start - LONGEST_NAME)
        at = at + 1 if is_name else after


def _run(words: list[str], start: int) -> Run | None:
    """Return the digits and letters from a word on."""
    text, ends, signs = "", [], []
    is_mended = False
    at = start
    while at < len(words):
        word = words[at]
        sign = word if word[0].isdigit() else LETTER_OF.get(word)
        if sign is None and text:
            sign = SOUNDS.get(word) or (sign_of(word) if _is_between(words, at) else None)
            is_mended = is_mended or sign is not None
        if sign is None:
            break
        text += sign
        at += 1
        ends.append(at)
        signs.append(text)
    if len(text) < 1:
        return None
    return Run(start, tuple(ends), tuple(signs), is_mended)


def _is_between(words: list[str], at: int) -> bool:
    """Return whether a word stands before a digit or a letter, or at the end of the call."""
    word = words[at]
    if word in INTRODUCING or word in VALUED or len(word) < 3:
        return False
    after = words[at + 1] if at + 1 < len(words) else None
    return after is None or after[0].isdigit() or after in LETTER_OF


def _is_value(words: list[str], run: Run, opening: int) -> bool:
    """Return whether the words around a run show that it is a value."""
    after = run.ends[-1]
    is_quantity = after < len(words) and words[after] in VALUED and words[after - 1].isdigit()
    if is_quantity and (run.start == opening or words[run.start - 1] in INTRODUCING):
        return True
    if run.start == opening:
        return False
    signs = run.signs[-1]
    has_letters = len(signs) >= 3 and not signs.isdigit() and not signs.isalpha()
    before = words[run.start - 1]
    if before in LETTER_OF and run.start > opening + 1:
        return words[run.start - 2] in BEFORE_TAXIWAY
    return before in (BEFORE_TAXIWAY if has_letters else INTRODUCING)


def _fit(words: list[str], run: Run, first: int, known: Known) -> Hit | None:
    """Return the hit if the signs of a run, or their first or last ones, fit a callsign."""
    start, name = _name(words, first, run, known)
    if is_spoken_of(words, start, run.ends[-1]):
        return None
    if name is not None and name.is_others:
        whole = known.signs in run.signs
        return Hit(start, run.ends[-1], ONLY_NUMBER, known.callsign) if whole else None
    best: Hit | None = None
    for end, signs in zip(run.ends, run.signs, strict=True):
        if not run.begins and signs != run.signs[-1]:
            continue
        score, left_over = _score(signs, known, name, end == run.ends[-1])
        if run.is_mended or signs != run.signs[-1]:
            score = min(score, NUMBER_FITS)
        if score > (best.score if best else 0.0):
            is_last = end < len(words) and words[end] in WAKE
            end += is_last
            best = Hit(start, end, score, known.callsign, left_over, "", run.is_mended)
    return best or _after_value(words, run, known)


def _after_value(words: list[str], run: Run, known: Known) -> Hit | None:
    """Return the hit if a run ends the call with the last signs of a registration."""
    size = len(words)
    end = run.ends[-1]
    signs, full = run.signs[-1], known.signs
    if not known.first or end < size - (words[-1] in WAKE) or run.is_mended or full.isdigit():
        return None
    for short in (full, full[-3:]):
        at = len(signs) - len(short)
        if at <= 0 or len(short) < 3 or not short[0].isdigit() or not signs.endswith(short):
            continue
        ends = [len(each) for each in run.signs]
        word = next(index for index, each in enumerate(ends) if each > at)
        before = signs[ends[word - 1] if word else 0 : at]
        hit = Hit(run.start + word, size, NUMBER_FITS, known.callsign)
        return hit._replace(before=before) if before.isdigit() or not before else None
    return None


class _Name(NamedTuple):
    """Words before the signs."""

    likeness: float
    """Likeness with a name of the callsign by its spelling, 0 to 1."""
    by_sound: float
    """Likeness by its sound."""
    is_others: bool = False
    """True if it is another's name."""


def _name(words: list[str], first: int, run: Run, known: Known) -> tuple[int, _Name | None]:
    """Return the begin of the name before a run and its likeness; None if there is no name."""
    best: tuple[int, _Name] | None = None
    for start in range(run.start - 1, first - 1, -1):
        said = words[start : run.start]
        opener = said[0]
        if opener in INTRODUCING or opener in STATIONS or opener in ENDING or opener[0].isdigit():
            break
        text = "".join(said)
        if known.first:
            name = _Name(float(text in MAKERS), 0.0, text in OF_AIRLINES and text not in MAKERS)
        else:
            spelled = max((similarity(text, each) for each in known.names), default=0.0)
            by_sound = max((likeness(text, each) for each in known.names), default=0.0)
            is_others = (text in OF_AIRLINES or text in MAKERS) and text not in known.names
            name = _Name(spelled, by_sound, is_others)
        if best is None or name.likeness + name.by_sound >= best[1].likeness + best[1].by_sound:
            best = start, name._replace(is_others=name.is_others or bool(best and best[1][2]))
        elif name.is_others:
            best = best[0], best[1]._replace(is_others=True)
    if best is None:
        return run.start, None
    if best[1].likeness >= ALIKE:
        best = best[0], best[1]._replace(is_others=False)
    return best


def _score(signs: str, known: Known, name: _Name | None, is_whole: bool) -> tuple[float, str]:
    """Return the score of signs after a name, and the digits that do not belong to them."""
    if known.first:
        is_first = signs[0] == known.first
        rest = signs[1:] if is_first else signs
        is_named = is_first or (name is not None and name.likeness == 1.0)
        return _score_registration(rest, known.signs, is_named, is_whole), ""
    full = known.signs
    is_named = name is not None and name.likeness >= ALIKE
    sounds_right = name is not None and name.by_sound >= ALIKE
    if signs == full:
        if name is not None and is_named:
            return MISSPELT * name.likeness, ""
        if sounds_right:
            return NUMBER_FITS, ""
        if name is None:
            return (NUMBER_FITS if len(full) > 1 else ONLY_NUMBER), ""
        is_unlike = len(known.names) > 1 or len(full) == 1
        return (SHORT_NUMBER_FITS if is_unlike else NUMBER_FITS), ""
    if full.isdigit() and signs.startswith(full) and signs.isdigit():
        fits = is_named or sounds_right or len(full) >= 3
        return (SHORT_NUMBER_FITS if fits else 0.0), signs[len(full) :]
    if is_whole and len(full) >= 3 and _edits(signs, full) == 1:
        return (ALMOST if is_named or sounds_right else ONLY_NUMBER), ""
    return 0.0, ""


def _score_registration(signs: str, full: str, is_named: bool, is_whole: bool) -> float:
    """Return the score of signs after the first sign of a registration, a maker or nothing."""
    if signs == full:
        is_long = len(full) >= 4 and full[0].isdigit() and not full.isdigit()
        return ABBREVIATED if is_long or is_named else NUMBER_FITS
    if len(signs) == 3 and full.endswith(signs):
        return NUMBER_FITS
    if is_whole and len(full) >= 3 and _edits(signs, full) == 1:
        return ALMOST if is_named or len(full) >= 5 else ONLY_NUMBER
    return 0.0


OF_AIRLINES = frozenset(joined(name) for designator in AIRLINES for name in names(designator))
"""Names of airlines, joined."""


def _edits(first: str, second: str) -> int:
    """Return the number of signs to change, add or drop."""
    return round((1.0 - similarity(first, second)) * max(len(first), len(second)))


@lru_cache(maxsize=4096)
def similarity(first: str, second: str) -> float:
    """Return the similarity of two texts by their edit distance, from 0 to 1 (equal)."""
    return edit_likeness(first, second)
