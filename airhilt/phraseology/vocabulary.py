"""The words of the grammar, and runways that a word unknown to it follows."""

from __future__ import annotations

import re

from airhilt.phraseology import denials
from airhilt.phraseology.actions import FORMS, NUMBER_FORMS
from airhilt.phraseology.alphabet import LETTERS
from airhilt.phraseology.clauses import CONDITIONS, EVENTS
from airhilt.phraseology.numbers import DIGITS, TEENS, TENS
from airhilt.phraseology.slots import FIX_ENDS, RUNWAY
from airhilt.phraseology.words import UNITS

COURTESIES = frozenset(
    {"thanks", "thank", "you", "sir", "madam", "please", "bye", "good", "day", "morning",
     "afternoon", "evening", "night", "i", "my", "affirm", "wilco", "roger", "hello",
     "hi", "sorry", "okay", "ok", "alright", "welcome", "well", "all"}
)  # fmt: skip
"""Words beside the phraseology that may follow anything."""
_PATTERNS = [
    *(form.words.pattern for forms in FORMS.values() for form in forms),
    *(form.words.pattern for forms in NUMBER_FORMS.values() for form in forms),
    *(event.pattern for event in EVENTS.values()),
    FIX_ENDS,
]
WORDS = frozenset(
    {*re.findall(r"[a-z]+", " ".join(_PATTERNS)), *LETTERS, *DIGITS, *TEENS, *TENS, *UNITS,
     *CONDITIONS, *COURTESIES, *denials.DENIALS, *denials.OPEN, *denials.SOMEBODY,
     *denials.OTHERS, *denials.BETWEEN, *denials.SPOKEN_OF, *denials.AFTERWARDS, "departing",
     "winds", "surface", "waiting", "alert", "again", "incorrect",
     "avoiding", "action", "may"}
) - {"able"}  # fmt: skip
"""Words that the grammar knows. "Able" is none without its "when": that may be what is lost."""
_RUNWAY = re.compile(rf"(?<!\S)(?:runway )?{RUNWAY}")
_SMALL = COURTESIES | {"and", "the", "a", "that", "this", "it"}
"""Words that may be put in between a runway and its side."""
_SIDES = frozenset({"left", "right", "centre"})
_OF_TURN = frozenset({"turn", "turns", "turnout"})
"""Words behind a side that is that of a turn."""
_FARTHEST = 4
"""Number of words behind a runway among which its side is looked for."""


def is_unknown(word: str) -> bool:
    """Return whether a word is none of the grammar, the callsign or a number."""
    return word.isalpha() and word not in WORDS


def has_unknown(words: list[str]) -> bool:
    """Return whether one of some words is unknown."""
    return bool([word for word in words if word not in WORDS and word.isalpha()])


def has_unknown_side(text: str, start: int, end: int) -> bool:
    """Return whether a runway among some words has no side, and a word after it is unknown.

    The unknown word may be the side, misheard: "runway 15 rime" may have been "runway 15 right".
    """
    while start < end and (found := _RUNWAY.search(text, start)) and found.start() < end:
        if found[2] is None and _side_follows(text[found.end() :].split(maxsplit=_FARTHEST + 1)):
            return True
        start = found.end()
    return False


def _side_follows(words: list[str]) -> bool:
    """Return whether a side, or an unknown word that may be one, follows a runway."""
    for at, word in enumerate(words[:_FARTHEST], 1):
        if word in _SIDES or is_unknown(word):
            return _OF_TURN.isdisjoint(words[at : at + 1])
        if word not in _SMALL:
            return False
    return False
