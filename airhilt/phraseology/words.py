"""Words of a transcript, without fillers, with misheard words mended and numbers in digits.

The same call may come as ``Runway 01L``, ``runway zero one left`` or ``run way o one left``; its
words are ``runway 01 left`` here, or ``runway 01 l``.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from airhilt.phraseology.alphabet import LETTER_OF, LETTER_VARIANTS
from airhilt.phraseology.mending import mend_by_sound
from airhilt.phraseology.numbers import DIGITS, SOUNDS, TEENS, TENS

MENDED = 0.9
"""Factor on the confidence in a word that replaces one that sounds like it."""

FILLERS = frozenset({"uh", "um", "er", "ah", "eh", "erm", "hm", "hmm", "mm", "uhm", "please"})

THOUSANDS = re.compile(r",(?:(?<=\b[0-9],)|(?<=\b[0-9]{2},))(?=[0-9]{3}\b)")
"""A thousands separator, as in 5,000."""
DECIMALS = re.compile(r"(?<![0-9])([0-9]+)\.([0-9]+)")
DESIGNATORS = re.compile(r"\b(?!fl)([a-z])([a-z])([0-9]{1,2})\b")
"""A taxiway of two letters, as in NP1."""
PLAIN = re.compile(r"[a-z ,.;]*")
"""A text without numbers, which its blanks and signs take apart."""
PIECES = re.compile(r"[a-z]+(?:'[a-z]+)?|[0-9]+|[,.;]")
BREAKS = frozenset(",.;")

SPELLINGS: dict[str, tuple[str, ...]] = {
    **{variant: (letter,) for variant, letter in LETTER_VARIANTS.items()},
    "center": ("centre",), "point": ("decimal",), "dot": ("decimal",), "lineup": ("line", "up"),
    "liningup": ("lining", "up"), "goaround": ("go", "around"), "holdshort": ("hold", "short"),
    "holdposition": ("hold", "position"), "flightlevel": ("flight", "level"),
    "fl": ("flight", "level"), "don't": ("do", "not"), "dont": ("do", "not"),
    "can't": ("can", "not"), "cannot": ("can", "not"),
    "cant": ("can", "not"), "won't": ("will", "not"), "didnt": ("did", "not"),
    "isnt": ("is", "not"), "arent": ("are", "not"), "canceled": ("cancelled",),
    "centerline": ("centreline",),
    "plough": ("plow",), "snowplow": ("snow", "plow"), "snowplough": ("snow", "plow"),
    "touchandgo": ("touch", "and", "go"), "kts": ("knots",),
    "tousand": ("thousand",), "dayseemal": ("decimal",),
    "ft": ("feet",), "fpm": ("feet", "per", "minute"),
    "rwy": ("runway",), "hdg": ("heading",), "till": ("until",), "til": ("until",),
}  # fmt: skip
"""Other spellings of words, with the same confidence."""
SOUNDALIKES: dict[str, tuple[str, ...]] = {
    "write": ("right",), "rite": ("right",), "wright": ("right",), "runaway": ("runway",),
    "runways": ("runway",), "decent": ("descent",), "decend": ("descend",), "clime": ("climb",),
    "clim": ("climb",), "cleard": ("cleared",), "clered": ("cleared",), "haeding": ("heading",),
    "hedding": ("heading",), "squak": ("squawk",), "squack": ("squawk",), "mantain": ("maintain",),
    "maintane": ("maintain",), "disreguard": ("disregard",), "nein": ("niner",),
    "niners": ("niner",), "wun": ("one",), "ait": ("eight",), "mayday's": ("mayday",),
}  # fmt: skip
"""Words that recognisers write for others that sound like them."""
PAIRS: dict[str, dict[str, tuple[str, ...]]] = {
    "take": {"off": ("takeoff",)},
    "run": {"way": ("runway",)},
    "x": {"ray": ("xray",)},
    "o": {"clock": ("oclock",)},
    "go": {"round": ("go", "around")},
    "whole": {"short": ("hold", "short"), "position": ("hold", "position")},
    "hole": {"short": ("hold", "short"), "position": ("hold", "position")},
    "old": {"short": ("hold", "short"), "position": ("hold", "position")},
    "hold": {"shore": ("hold", "short"), "sort": ("hold", "short"), "shot": ("hold", "short")},
    "clear": {"too": ("clear", "to"), "two": ("clear", "to")},
    "cleared": {
        "two": ("cleared", "to"), "too": ("cleared", "to"), "four": ("cleared", "for"),
        "fore": ("cleared", "for"),
    },
    "flight": {"levels": ("flight", "level")},
    "fly": {"level": ("flight", "level")},
    "and": {"weight": ("and", "wait")},
    "lie": {"nup": ("line", "up")},
    "re": {"cleared": ("recleared",)},
    "read": {"back": ("readback",)},
    "push": {"back": ("pushback",)},
    "start": {"up": ("startup",)},
    "back": {"track": ("backtrack",)},
    "fox": {"trot": ("foxtrot",)},
}  # fmt: skip
"""The same for two words; the key is the first."""
_SPELLED_APART = frozenset(
    {"take", "run", "x", "o", "go", "re", "read", "push", "start", "back", "fox"}
)
"""First words of pairs that are only spelled differently, not misheard."""

UNITS = frozenset(
    {"thousand", "hundred", "mile", "miles", "knots", "feet", "degrees", "oclock", "minutes",
     "nautical"}
)  # fmt: skip
"""Words before which a number ends."""
WIDTHS = {"runway": 2, "heading": 3, "level": 3, "decimal": 3}
"""Number of digits that follow a word."""
_DISTANCES = frozenset({"d", "dme"})
"""First words of a unit of distance behind a number, besides `UNITS`."""
_SPEEDS = range(140, 260)
"""Speeds in knots that are kept to a distance from the threshold; no frequency begins so."""
_SIDES = frozenset({"left", "right", "centre"})
_AFTER_RUNWAY = frozenset({"left", "right", "l", "r", "centre", "cleared", "clear", "line"})


_MENDED = PAIRS.keys() | SPELLINGS.keys() | SOUNDALIKES.keys() | {"fox"}
"""Words that may stand for others."""
_SPOKEN = DIGITS | TEENS
_NUMERIC = (
    DIGITS.keys() | TEENS.keys() | TENS.keys() | SOUNDS.keys() | {"hundred", "double", "triple"}
)
"""Words that may be a number or a part of one."""
_SPELLED = LETTER_OF.keys() | LETTER_VARIANTS.keys()


@dataclass(slots=True)
class Words:
    """The words of a call, with a confidence in [0, 1] for each."""

    texts: list[str] = field(default_factory=list)
    confidences: list[float] = field(default_factory=list)

    def add(self, text: str, confidence: float) -> None:
        """Append a word."""
        self.texts.append(text)
        self.confidences.append(confidence)

    def add_all(self, texts: Sequence[str], confidence: float) -> None:
        """Append words of one confidence."""
        self.texts.extend(texts)
        self.confidences.extend([confidence] * len(texts))

    def take(self, others: Words, start: int, end: int) -> None:
        """Append a range of other words."""
        self.texts.extend(others.texts[start:end])
        self.confidences.extend(others.confidences[start:end])


def tokens(text: str) -> list[str]:
    """Return the lower-case words of a call, with spoken numbers in digits.

    ``flight level three five zero`` gives ``flight level 350``. A comma ends a number.
    """
    return words_of(text).texts


def words_of(text: str, confidences: Sequence[float] | None = None) -> Words:
    """Return the words of a call, each with the least confidence of the words that it replaces.

    Raises
    ------
    ValueError
        The number of confidences is not that of the words.
    """
    words = _join(_mend(_split(text, confidences)))
    mend_by_sound(words.texts, words.confidences)
    return words


def _split(text: str, confidences: Sequence[float] | None) -> Words:
    text = text.lower().replace("’", "'")
    if confidences is None:
        pieces = _pieces(text)
        return Words(pieces, [1.0] * len(pieces))
    chunks = text.split()
    if len(confidences) != len(chunks):
        raise ValueError(
            f"{len(confidences)} word confidences for {len(chunks)} words; expected one for each "
            "word of the text, which are those between its blanks"
        )
    words = Words()
    for chunk, confidence in zip(chunks, confidences, strict=True):
        words.add_all(_pieces(chunk), confidence)
    return words


def _pieces(text: str) -> list[str]:
    """Return words, numbers and signs."""
    if PLAIN.fullmatch(text):
        return text.replace(",", " , ").replace(".", " . ").replace(";", " ; ").split()
    text = DESIGNATORS.sub(r"\1 \2 \3", DECIMALS.sub(r"\1 decimal \2", THOUSANDS.sub("", text)))
    return PIECES.findall(text)


def _mend(words: Words) -> Words:
    """Leave out fillers, unify spellings, and mend words that were misheard."""
    if not FILLERS.isdisjoint(words.texts):
        words = _without_fillers(words)
    texts = words.texts
    mended = Words()
    done = 0
    for at, word in enumerate(texts):
        if (word not in _MENDED and "'" not in word) or at < done:
            continue
        following = texts[at + 1] if at + 1 < len(texts) else ""
        pairs = PAIRS.get(word)
        size, sure = 1, 1.0
        meant: Sequence[str]
        if pairs and following in pairs:
            meant, size, sure = pairs[following], 2, 1.0 if word in _SPELLED_APART else MENDED
        elif word == "fox" and _is_spelling(texts[done:at][-1:] or mended.texts[-1:], following):
            meant = ("foxtrot",)
        elif word in SPELLINGS:
            meant = SPELLINGS[word]
        elif word in SOUNDALIKES:
            meant, sure = SOUNDALIKES[word], MENDED
        elif word.endswith("n't"):
            meant = (word[:-3], "not") if word != "n't" else ("not",)
        elif "'" in word:
            meant = (word.split("'")[0] if word != "o'clock" else "oclock",)
        else:
            continue
        mended.take(words, done, at)
        mended.add_all(meant, min(words.confidences[at : at + size]) * sure)
        done = at + size
    if done == 0:
        return words
    mended.take(words, done, len(texts))
    return mended


def _is_spelling(before: list[str], following: str) -> bool:
    """Return whether the words around one are letters, or lead to the letter of a taxiway."""
    return (
        following in _SPELLED or not _SPELLED.isdisjoint(before) or before in (["via"], ["taxiway"])
    )


def _without_fillers(words: Words) -> Words:
    """Return words without hesitations, of which "and uh" is one."""
    texts = words.texts
    kept = Words()
    for at, word in enumerate(texts):
        is_hesitation = word in FILLERS or (
            word == "and"
            and not FILLERS.isdisjoint(texts[at + 1 : at + 2])
            and not (_ends_number(texts[:at]) and _digits_from(texts, at + 2)[0] > 1)
        )
        if not is_hesitation:
            kept.add(word, words.confidences[at])
    return kept


def _ends_number(texts: list[str]) -> bool:
    """Return whether words end with a whole number: three digits, or a distance after "to"."""
    count = 0
    for word in reversed(texts):
        if word in DIGITS:
            count += 1
        elif word in TEENS or word in TENS:
            count += 1 if count == 1 and word in TENS else 2
        else:
            return count == 3 or (count == 1 and word in ("to", "until", "till"))
    return count == 3


def _join(said: Words) -> Words:
    """Write numbers in digits, and join those that follow each other."""
    texts, confidences = said.texts, said.confidences
    words = Words()
    joined, sure = words.texts, words.confidences
    joining = False
    at, size = 0, len(texts)
    while at < size:
        word, confidence = texts[at], confidences[at]
        at += 1
        if word not in _NUMERIC and not word[0].isdigit():
            joining = False
            if word not in BREAKS:
                joined.append(word)
                sure.append(confidence)
            continue
        digits = _SPOKEN.get(word)
        if digits is not None:
            pass
        elif word in TENS:
            digits = TENS[word]
            unit = DIGITS.get(texts[at], "0") if at < size else "0"
            if unit != "0":
                digits = digits[0] + unit
                confidence = min(confidence, confidences[at])
                at += 1
        elif word in SOUNDS:
            if _is_digit_here(words, joining, texts, at):
                digits, confidence = SOUNDS[word], confidence * MENDED
        elif word[0].isdigit():
            digits = word
            joining = joining and len(word) < 3 and not _is_long_literal(texts, at - 2)
        elif word == "hundred" and joining:
            joined[-1] += "00"
            sure[-1] = min(sure[-1], confidence)
            at = _add_below_hundred(words, said, at)
            joining = False
            continue
        elif word in ("double", "triple") and at < size and texts[at] in DIGITS:
            digits = DIGITS[texts[at]] * (2 if word == "double" else 3)
            confidence = min(confidence, confidences[at])
            at += 1
        if digits is not None and joining:
            joined[-1] += digits
            sure[-1] = min(sure[-1], confidence)
        else:
            joined.append(digits or word)
            sure.append(confidence)
        joining = digits is not None
    return words


def _add_below_hundred(words: Words, said: Words, at: int) -> int:
    """Add the tens after "hundred" to the number, and return the index after it."""
    texts = said.texts
    if at == len(texts):
        return at
    word, confidence = texts[at], said.confidences[at]
    digits = TEENS.get(word)
    after = at + 1
    if digits is None and word in TENS:
        unit = DIGITS.get(texts[after], "0") if after < len(texts) else "0"
        digits = TENS[word][0] + unit
        after += unit != "0"
    if digits is None:
        return at
    words.texts[-1] = words.texts[-1][:-2] + digits
    words.confidences[-1] = min(words.confidences[-1], confidence)
    return after


def _is_long_literal(texts: list[str], at: int) -> bool:
    """Return whether a complete number was written here."""
    return at >= 0 and texts[at][0].isdigit() and len(texts[at]) >= 3


def _is_digit_here(words: Words, joining: bool, texts: list[str], at: int) -> bool:
    """Return whether a word before ``at`` that sounds like a digit is one.

    It is a digit between two digits, and after "runway" and the like if it completes the usual
    number of digits there. It is none before a number with a unit, as in "180 to 4 miles".
    """
    sound = texts[at - 1]
    following = texts[at] if at < len(texts) else ""
    if following == "thousand" and sound in ("to", "too", "for", "fore"):
        return joining or sound != "to"
    digits, after = _digits_from(texts, at)
    introduced = words.texts[-1] if words.texts else ""
    if sound in ("oh", "o", "won", "ate"):
        return joining or bool(digits) or introduced in WIDTHS
    if joining:
        if _is_preposition(words, sound, digits, after):
            return False
        if digits == 0:
            return (
                sound in ("for", "fore")
                and words.texts[-2:-1] == ["runway"]
                and len(introduced) == 1
                and following in _AFTER_RUNWAY
            )
        return len(introduced) < 4 and after not in UNITS and after not in _DISTANCES
    width = WIDTHS.get(introduced)
    is_short = width is not None and 0 < digits < width and (width == 3 or digits == 1)
    return is_short and after not in UNITS


def _is_preposition(words: Words, sound: str, digits: int, after: str) -> bool:
    """Return whether "to" or "for" between two numbers is no digit.

    It leads from a speed to the distance where it ends ("one seventy to five"), or from a holding
    point to its runway ("mike three for zero eight right").
    """
    introduced, before = words.texts[-1], words.texts[-2] if len(words.texts) > 1 else ""
    is_speed = len(introduced) == 3 and introduced[2] == "0" and int(introduced) in _SPEEDS
    if is_speed and sound in ("to", "too") and digits == 1:
        return True
    is_point = before in _SPELLED and len(introduced) <= 2 and digits == 2
    is_for = sound in ("for", "fore") and before != "november" and after not in _SPELLED
    return is_point and (after in _SIDES or is_for)


def _digits_from(texts: list[str], at: int) -> tuple[int, str]:
    """Return the number of digits that follow, and the word after them."""
    count = 0
    while at < len(texts):
        word = texts[at]
        if word in DIGITS:
            count += 1
        elif word in TEENS or word in TENS:
            count += 2
        elif word[0].isdigit():
            count += len(word)
        elif not (word in SOUNDS and count):
            return count, word
        at += 1
    return count, ""
