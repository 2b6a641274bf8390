"""Numbers that were said one after the other, and that a transcript without commas joins."""

from __future__ import annotations

from airhilt.phraseology.slots import SHORTENED
from airhilt.phraseology.words import Words

DIGITS = {"level": 3, "heading": 3, "squawk": 4, "altimeter": 4, "qnh": 4, "h": 4}
"""Number of digits after a word; "h" ends a spelled QNH."""
_SIDES = (["left"], ["right"], ["centre"])
_CLEARED = (["cleared"], ["line"])
_TURNS = frozenset({"left", "right", "heading", "to"})
"""Words before a heading, behind which a level in thousands may stand."""
RUNWAY = 2
"""Number of digits of a runway, behind which its side and its clearance stand."""
HEADING = 3
"""Number of digits of a heading."""
_INTRODUCING = DIGITS.keys() | {"thousand", "cleared", "line"}
LEAST_REST = 2
"""Least number of digits of the second number: a single one may be a slip."""


def split_numbers(words: Words) -> Words:
    """Return words in which a number with more digits than its word allows is two numbers.

    ``level 34010 minutes`` is ``level 340 10 minutes``. The confidence in the first is low, because
    nobody knows where it ends.
    """
    texts = words.texts
    if _INTRODUCING.isdisjoint(texts):
        return words
    numbers = [index for index, text in enumerate(texts) if len(text) > RUNWAY and text.isdigit()]
    sizes = {index: _rest_of(texts, index) for index in numbers if index}
    if not any(sizes.values()):
        return words
    split = Words()
    for index, text in enumerate(texts):
        size = sizes.get(index, 0)
        if size:
            split.add(text[:size], words.confidences[index] * SHORTENED)
            text = text[size:]
        is_rest = size and texts[index + 1 : index + 2] in _SIDES
        split.add(text, words.confidences[index] * (SHORTENED if is_rest else 1.0))
    return split


def _rest_of(texts: list[str], index: int) -> int:
    """Return the number of digits of a number before the second one; 0 if there is none."""
    text = texts[index]
    size = DIGITS.get(texts[index - 1], 0)
    if texts[index + 1 : index + 2] == ["thousand"] and texts[index - 1] in _TURNS:
        return HEADING if len(text) in (HEADING + 1, HEADING + 2) else 0
    is_runway = texts[index + 1 : index + 2] in _SIDES and texts[index + 2 : index + 3] in _CLEARED
    if not (size or is_runway):
        return 0
    if size == 4 and text[0] == "9":  # A QNH below 1000 hPa.
        size = 3 if texts[index - 1] in ("qnh", "h") else size
    if not size:
        return len(text) - RUNWAY if texts[index - 1] != "runway" else 0
    return size if len(text) >= size + (1 if is_runway else LEAST_REST) else 0
