"""Words that a recogniser wrote for words of the phraseology that sound like them.

A word is replaced only if it is no word of the phraseology itself, sounds like one, and stands
where that one fits: "hitting" before a course, "conduct" before a unit and a frequency. What was
replaced has a confidence below `airhilt.phraseology.call.TAU_ASR`, so that no clearance that was
mended is acted upon.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import NamedTuple

from airhilt.phraseology.sounds import PHONEMES, likeness
from airhilt.phraseology.telephony import TELEPHONY

FITTED = 0.75
"""Factor on the confidence in a word that was replaced because it fits."""
LEAST_ALIKE = 0.6
"""Least likeness by sound with the word that fits."""

_STATION = "(?:tower|ground|approach|departure|centre|radar|control|delivery|arrival|director)"
_FREQUENCY = r"(?:(?:on )?1[1-3][0-9](?: decimal|[0-9]|(?!\S))|$)"
_LEVEL = r"(?:(?:to )?(?:flight )?level [0-9]{2,3}|(?:to )?[0-9]{1,2} thousand|and maintain)"
_RUNWAY = r"(?:0?[1-9]|[12][0-9]|3[0-6])(?!\S)"
_COURSE = r"[0-3][0-9]{2}(?!\S)(?! (?:knots|decimal|thousand|feet))"


class Fit(NamedTuple):
    """Where a word of the phraseology stands."""

    word: str
    before: str = ""
    """Pattern of the words before it."""
    after: str = ""
    """Pattern of the words after it."""


FITS = (
    Fit("heading", after=_COURSE),
    Fit("runway", after=rf"{_RUNWAY}(?: (?:left|right|centre))?(?: (?:cleared|line|hold)|$)"),
    Fit("runway", before="(?:short of|cross|to land|for takeoff)", after=_RUNWAY),
    Fit("contact", after=rf"(?:\S+ ){{0,2}}{_STATION} {_FREQUENCY}"),
    Fit("climb", after=_LEVEL),
    Fit("descend", after=_LEVEL),
    Fit("maintain", before="(?:climb|descend) and", after=""),
    Fit("maintain", after=r"(?:flight level [0-9]|[0-9]{1,2} thousand|[1-3][0-9]{2} knots)"),
    Fit("left", before="turn", after=rf"(?:heading|{_COURSE}|direct)"),
    Fit("right", before="turn", after=rf"(?:heading|{_COURSE}|direct)"),
    Fit("left", before=f"runway {_RUNWAY}", after="(?:cleared|line|hold|$)"),
    Fit("right", before=f"runway {_RUNWAY}", after="(?:cleared|line|hold|$)"),
    Fit("turn", after=rf"(?:left|right) (?:heading|{_COURSE}|direct)"),
    Fit("hold", after="(?:short of|position)"),
    Fit("short", before="hold", after="of"),
    Fit("squawk", after=r"[0-7]{4}(?!\S)"),
    Fit("level", before="flight", after=r"[0-9]{2,3}(?!\S)"),
    Fit("thousand", before="(?:climb|descend|maintain)(?: to)? [0-9]{1,2}"),
    Fit("knots", before="(?:speed|reduce|maintain|increase)(?: speed)?(?: to)? [1-3][0-9]{2}"),
    Fit("approach", before="cleared (?:for )?(?:the )?(?:ils|visual|rnav|localizer)"),
    Fit("tower", before=r"contact(?: \S+)?", after=r"(?:on )?1[1-3][0-9]"),
    Fit("ground", before=r"contact(?: \S+)?", after=r"(?:on )?1[1-3][0-9]"),
    Fit("land", before=rf"runway {_RUNWAY}(?: (?:left|right|centre))? cleared to"),
    Fit("takeoff", before="cleared for", after=rf"runway {_RUNWAY}"),
    Fit("cleared", after=rf"(?:to land|for takeoff)(?: runway {_RUNWAY}|$)"),
)
"""Places of words. A place names all other words of the phrase, so that no ordinary word becomes
an instruction."""
_TARGETS = tuple(dict.fromkeys(fit.word for fit in FITS))
_FITS = {
    target: tuple(
        (
            re.compile(rf"(?:^|.* ){fit.before}$" if fit.before else ""),
            re.compile(fit.after),
        )
        for fit in FITS
        if fit.word == target
    )
    for target in _TARGETS
}
_INFLECTED = re.compile("(?:ed|d|s|ing)$")
_BEFORE_FIX = frozenset({"cross", "crossing", "direct", "over", "by", "depart", "leave"})
"""Words before the name of a fix, which may sound like anything."""
_NAMES = frozenset(word for name in TELEPHONY.values() for word in name.split())
_OWN = frozenset({*_TARGETS, "correct"}) | (PHONEMES.keys() - _NAMES)
"""Words of the phraseology, which are never replaced."""


@lru_cache(maxsize=8192)
def candidates(word: str) -> tuple[str, ...]:
    """Return the words of the phraseology that a word may stand for, the most alike first.

    Inflected forms stand for themselves: "climbed" is no "climb".
    """
    if not word.isalpha() or len(word) < 3 or _OWN.intersection((word, _INFLECTED.sub("", word))):
        return ()
    scores = {target: likeness(word, target) for target in _TARGETS}
    return tuple(
        target
        for target in sorted(scores, key=lambda each: (-scores[each], each))
        if scores[target] >= LEAST_ALIKE
    )


def mend_by_sound(texts: list[str], confidences: list[float]) -> None:
    """Replace the words that fit as others that sound like them, in place."""
    others = [(at, word) for at, word in enumerate(texts) if word not in _OWN and word.isalpha()]
    for at, word in others:
        if at == 0 or texts[at - 1] in _BEFORE_FIX:
            continue
        before, after = " ".join(texts[max(at - 6, 0) : at]), " ".join(texts[at + 1 : at + 7])
        fitting = {target for target in _TARGETS if _fits(target, before, after)}
        if fitting and not _is_operators(word, texts[at + 1 : at + 2]):
            meant = next((each for each in candidates(word) if each in fitting), None)
            if meant is not None:
                texts[at] = meant
                confidences[at] *= FITTED


def _is_operators(word: str, following: list[str]) -> bool:
    """Return whether a word may end the name of an operator in a callsign."""
    return word in _NAMES and bool(following) and following[0][0].isdigit()


def _fits(target: str, before: str, after: str) -> bool:
    return any(right.match(after) and left.match(before) for left, right in _FITS[target])
