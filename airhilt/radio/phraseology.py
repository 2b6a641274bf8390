"""From the words of a call to what it says: callsign, level, instruction or readback.

A level is read only where the words say one; unknown words mean nothing. The forms are those of
ICAO Doc 4444, chapter 12, and FAA Order JO 7110.65, chapter 2, section 4.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

DIGITS = {
    "zero": "0", "one": "1", "two": "2", "three": "3", "tree": "3", "four": "4", "fower": "4",
    "five": "5", "fife": "5", "six": "6", "seven": "7", "eight": "8", "nine": "9", "niner": "9",
}  # fmt: skip
"""Spoken digits (ICAO Annex 10 volume II, 5.2.1.4.3)."""

TELEPHONY = {
    "AAL": "american", "ACA": "air canada", "AFR": "air france", "ASA": "alaska",
    "BAW": "speedbird", "DAL": "delta", "DLH": "lufthansa", "EJA": "execjet", "FDX": "fedex",
    "JBU": "jetblue", "KLM": "klm", "NKS": "spirit wings", "QFA": "qantas", "RPA": "brickyard",
    "SKW": "skywest", "SWA": "southwest", "SWR": "swiss", "UAL": "united", "UPS": "u p s",
}  # fmt: skip
"""Telephony designators (ICAO Doc 8585)."""

THOUSANDS = re.compile(r"\b(\d{1,2}),(\d{3})\b")
"""A number with a thousands separator, such as 5,000."""

Sense = Literal["climb", "descend", "maintain"]

_SENSES: dict[str, Sense] = {
    "climb": "climb", "climbing": "climb", "descend": "descend", "descending": "descend",
    "maintain": "maintain", "maintaining": "maintain",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Call:
    """What one call says.

    ``addressed_first`` tells an instruction, which begins with the callsign, from a readback,
    which ends with it.
    """

    callsign: str | None
    addressed_first: bool
    sense: Sense | None
    altitude_ft: float | None


def tokens(text: str) -> list[str]:
    """Return the lower-case words of a call with spoken digits as digits, joined to numbers.

    ``flight level three five zero`` gives ``flight level 350``. A comma ends a number.
    """
    out: list[str] = []
    joining = False
    for word in re.findall(r"[a-z]+|\d+|[,.;]", THOUSANDS.sub(r"\1\2", text.lower())):
        if word in ",.;":
            joining = False
            continue
        digit = DIGITS.get(word, word if word.isdigit() else None)
        if digit is None:
            out.append(word)
        elif joining:
            out[-1] += digit
        else:
            out.append(digit)
        joining = digit is not None
    return out


def spoken_forms(callsign: str) -> list[list[str]]:
    """Return the ways in which a callsign may stand in `tokens`."""
    forms = [tokens(callsign)]
    match = re.fullmatch(r"([A-Z]{3})(\d+)", callsign)
    if match and match[1] in TELEPHONY:
        forms.append([*TELEPHONY[match[1]].split(), match[2]])
    return forms


def _find(words: list[str], form: list[str]) -> int | None:
    """Return where a form stands in the words."""
    size = len(form)
    return next((i for i in range(len(words) - size + 1) if words[i : i + size] == form), None)


def altitude_ft(words: list[str]) -> float | None:
    """Return the level or altitude that the words say, if they say one."""
    for index, word in enumerate(words[:-1]):
        following = words[index + 1]
        after = words[index + 2] if index + 2 < len(words) else ""
        if word == "level" and following.isdigit() and len(following) in (2, 3):
            return float(following) * 100.0
        if word == "fl" and following.isdigit():
            return float(following) * 100.0
        if word.isdigit() and following == "thousand":
            value = float(word) * 1000.0
            hundreds = words[index + 3] if index + 3 < len(words) else ""
            if after.isdigit() and len(after) == 1 and hundreds == "hundred":
                value += float(after) * 100.0
            return value
        if word in ("maintain", "to") and following.isdigit() and len(following) in (4, 5):
            return float(following)
    return None


def parse_call(text: str, callsigns: Iterable[str]) -> Call:
    """Return what a call says, its callsign among those that are known on the frequency."""
    words = tokens(text)
    found: tuple[int, str, int] | None = None
    for callsign in callsigns:
        for form in spoken_forms(callsign):
            position = _find(words, form)
            if position is not None and (found is None or position < found[0]):
                found = (position, callsign, len(form))
    sense = next((_SENSES[word] for word in words if word in _SENSES), None)
    if found is None:
        return Call(None, False, sense, altitude_ft(words))
    position, callsign, size = found
    rest = [*words[:position], "|", *words[position + size :]]
    level = altitude_ft(rest) if sense is not None else None
    return Call(callsign, position == 0, sense, level)
