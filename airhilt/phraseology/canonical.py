"""The form of transcripts, for the output of general recognisers.

Transcripts are lower-case words without punctuation. A runway is the word "runway", then its digits
one by one as words, then its side. Recognisers write "run way 01L", "Runway 1-L" or "RWY one left",
and the same recogniser writes one or the other.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from airhilt.phraseology.numbers import TEENS

WordConfidence = tuple[str, float]

DIGITS = ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")
TENS = {"twenty": "two", "thirty": "three"}
"""No runway has a number above 36."""
SPOKEN_DIGITS = {"oh": "zero", "o": "zero", **{word: word for word in DIGITS}} | {
    word: word for word in ("niner", "tree", "fower", "fife")
}
SIDES = {
    "l": "left", "left": "left",
    "r": "right", "right": "right", "write": "right", "rite": "right",
    "c": "center", "center": "center", "centre": "center",
}  # fmt: skip
MOST_DIGITS = 2
_DESIGNATOR = re.compile(r"([0-9]{1,2})(left|right|center|centre|[lrc])?")
_PUNCTUATION = " \t\n.,;:!?\"'()[]…"


def canonical(words: Iterable[WordConfidence]) -> tuple[WordConfidence, ...]:
    """Return words in the form of transcripts, each with the confidence of its source."""
    return tuple(_runways(list(_joined(_plain(words)))))


def _plain(words: Iterable[WordConfidence]) -> Iterator[WordConfidence]:
    """Yield words in lower case, without punctuation except decimal points."""
    for text, confidence in words:
        text = text.lower().replace("x-ray", "xray")
        text = re.sub(r"(?<=[0-9]),(?=[0-9]{3})", "", text)
        for part in re.split(r"[\s\-–/]+", text):
            if part := part.strip(_PUNCTUATION):
                yield part, confidence


def _joined(words: Iterable[WordConfidence]) -> Iterator[WordConfidence]:
    """Yield words with "runway" as one word, however it was written."""
    waiting: WordConfidence | None = None
    for text, confidence in words:
        if waiting is not None:
            if text in ("way", "ways"):
                yield "runway", min(waiting[1], confidence)
                waiting = None
                continue
            yield waiting
            waiting = None
        if text == "run":
            waiting = text, confidence
        elif text in ("rwy", "runways"):
            yield "runway", confidence
        elif match := re.fullmatch(r"runway([0-9].*)", text):
            yield "runway", confidence
            yield match.group(1), confidence
        else:
            yield text, confidence
    if waiting is not None:
        yield waiting


def _runways(words: list[WordConfidence]) -> Iterator[WordConfidence]:
    """Yield words with the designator after each "runway" spelled."""
    index = 0
    while index < len(words):
        yield words[index]
        index += 1
        if words[index - 1][0] != "runway":
            continue
        digits = 0
        while index < len(words) and digits < MOST_DIGITS:
            text, confidence = words[index]
            spelled = _spelled(text, digits)
            if not spelled:
                break
            for word in spelled:
                yield word, confidence
            digits += sum(word not in SIDES.values() for word in spelled)
            index += 1
            if spelled[-1] in SIDES.values():
                digits = MOST_DIGITS + 1
            elif text in TENS and (index == len(words) or words[index][0] not in SPOKEN_DIGITS):
                yield "zero", confidence
                digits += 1
        if 0 < digits <= MOST_DIGITS and index < len(words) and words[index][0] in SIDES:
            yield SIDES[words[index][0]], words[index][1]
            index += 1


def _spelled(text: str, digits: int) -> list[str]:
    """Return the words of a part of a designator, or none if the text is not one.

    Parameters
    ----------
    digits
        Number of digits of the designator before it.
    """
    if text in SPOKEN_DIGITS:
        return [SPOKEN_DIGITS[text]]
    if digits == 0 and text in TEENS:
        return [DIGITS[int(digit)] for digit in TEENS[text]]
    if digits == 0 and text in TENS:
        return [TENS[text]]
    match = _DESIGNATOR.fullmatch(text)
    if match is None or len(match.group(1)) + digits > MOST_DIGITS:
        return []
    side = SIDES[match.group(2)] if match.group(2) else ""
    return [*(DIGITS[int(digit)] for digit in match.group(1)), *([side] if side else [])]
