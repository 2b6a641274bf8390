"""Numbers in words: digit by digit, in group form, with hundreds and thousands.

ICAO Annex 10 volume II, 5.2.1.4; FAA Order JO 7110.65, 2-4-16 and 2-4-17.
"""

from __future__ import annotations

from typing import Literal

Style = Literal["faa", "icao"]

DIGITS = {
    "zero": "0", "one": "1", "two": "2", "three": "3", "tree": "3", "four": "4", "fower": "4",
    "five": "5", "fife": "5", "six": "6", "seven": "7", "eight": "8", "nine": "9", "niner": "9",
}  # fmt: skip
"""Spoken digits (ICAO Annex 10 volume II, 5.2.1.4.3)."""
TEENS = {
    "ten": "10", "eleven": "11", "twelve": "12", "thirteen": "13", "fourteen": "14",
    "fifteen": "15", "sixteen": "16", "seventeen": "17", "eighteen": "18", "nineteen": "19",
}  # fmt: skip
TENS = {
    "twenty": "20", "thirty": "30", "forty": "40", "fourty": "40", "fifty": "50", "sixty": "60",
    "seventy": "70", "eighty": "80", "ninety": "90",
}  # fmt: skip
SOUNDS = {
    "to": "2", "too": "2", "for": "4", "fore": "4", "won": "1", "ate": "8", "oh": "0", "o": "0",
}  # fmt: skip
"""Words that sound like digits."""

_FAA = ["zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "niner"]
_ICAO = ["zero", "one", "two", "tree", "fower", "fife", "six", "seven", "eight", "niner"]
_TEENS = list(TEENS)
_TENS = ["twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety"]


def speak_digits(digits: str, style: Style) -> str:
    """Return digits one by one.

    The words of ICAO are written as they are to be pronounced (Annex 10 volume II, 5.2.1.4.3); of
    those, controllers of the United States keep "niner".
    """
    words = _ICAO if style == "icao" else _FAA
    return " ".join(words[int(digit)] for digit in digits)


def speak_group(number: int, style: Style) -> str:
    """Return a number of up to four digits in pairs: twelve thirty four (7110.65, 2-4-16)."""
    if number < 10:
        return speak_digits(str(number), style)
    if number < 20:
        return _TEENS[number - 10]
    if number < 100:
        unit = f" {speak_digits(str(number % 10), style)}" if number % 10 else ""
        return _TENS[number // 10 - 2] + unit
    head, tail = divmod(number, 100)
    if tail == 0:
        return f"{speak_group(head, style)} hundred"
    spoken = f"zero {speak_digits(str(tail), style)}" if tail < 10 else speak_group(tail, style)
    return f"{speak_group(head, style)} {spoken}"


def speak_thousands(feet: int, style: Style) -> str:
    """Return an altitude in thousands and hundreds (Annex 10 volume II, 5.2.1.4.1.2)."""
    thousands, hundreds = divmod(feet, 1000)
    parts = []
    if thousands:
        parts.append(f"{speak_digits(str(thousands), style)} thousand")
    if hundreds:
        parts.append(f"{speak_digits(str(hundreds // 100), style)} hundred")
    return " ".join(parts) or speak_digits("0", style)
