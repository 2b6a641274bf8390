"""The ways to say a callsign.

Full callsigns are those of ICAO Annex 10 volume II, 5.2.1.7.2.1; abbreviated ones those of
5.2.1.7.2.2 (the first sign or the maker, and the last two signs) and of FAA Order JO 7110.65,
2-4-9 (the prefix and the last three). A flight number has no abbreviated form.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from airhilt.phraseology.aircraft_names import NATIONALITY_MARKS
from airhilt.phraseology.alphabet import LETTERS
from airhilt.phraseology.telephony import AIRLINES, names
from airhilt.phraseology.words import tokens

VEHICLES = {"PLOW": ("snowplow",), "FIRE": ("firetruck",), "OPS": ("operations",)}
"""Spoken names of vehicles, by the letters of their callsigns."""
MAKER = "*"
"""Name of a `Form` that stands for any maker or model."""

FULL = 1.0
"""Score of a callsign that is said in full."""
ABBREVIATED = 0.9
"""Score of a callsign that is abbreviated."""

FILLED = 3
"""Digits of a flight number that zeros fill: "Emirates zero zero three" is UAE3."""

_AIRLINE = re.compile(r"([A-Z]{3})([0-9][0-9A-Z]{0,3})")
_AMERICAN = re.compile(r"N([1-9][0-9]{0,4}[A-Z]{0,2})")
_HYPHENATED = re.compile(r"([A-Z0-9]{1,4})-([A-Z0-9]{2,5})")
_MARKS = "|".join(sorted(NATIONALITY_MARKS, key=len, reverse=True))
_REGISTRATION = re.compile(rf"[A-Z]{{5}}|(?:{_MARKS})(?:[A-Z]{{3,5}}|[0-9]{{2,5}}[A-Z]{{0,2}})")
_NAMED = re.compile(r"([A-Z]{3,})([0-9]+[A-Z]{0,2})|([A-Z]+)([0-9]+)")


class Form(NamedTuple):
    """One spoken form of a callsign."""

    name: str
    """Words of the name, joined; `MAKER` for any maker."""
    signs: str
    """Digits and letters after the name."""
    worth: float = FULL


def is_registration(callsign: str) -> bool:
    """Return whether a callsign is the registration of an aircraft."""
    airline = _AIRLINE.fullmatch(callsign)
    if airline and airline[1] in AIRLINES:
        return False
    return bool(
        _AMERICAN.fullmatch(callsign)
        or _HYPHENATED.fullmatch(callsign)
        or _REGISTRATION.fullmatch(callsign)
    )


def forms(callsign: str) -> tuple[Form, ...]:
    """Return the spoken forms of a callsign, the full ones first."""
    airline = _AIRLINE.fullmatch(callsign)
    if airline and airline[1] in AIRLINES:
        said = (airline[1].lower(), *(joined(name) for name in names(airline[1])))
        plain = tuple(Form(name, airline[2]) for name in dict.fromkeys(said))
        filled = _with_zeros(airline[2])
        return plain + tuple(
            Form(each.name, more, ABBREVIATED) for each in plain for more in filled
        )
    if is_registration(callsign):
        signs = callsign.replace("-", "")
        spelled = _of_registration(signs[0].lower(), signs[1:], signs)
        return (*spelled, Form(joined(callsign), ""))
    named = _NAMED.fullmatch(callsign)
    if named:
        letters, signs = named[1] or named[3], named[2] or named[4]
        said = (letters.lower(), *VEHICLES.get(letters, ()))
        return tuple(Form(name, signs) for name in said)
    return (Form("".join(tokens(callsign)), ""),)


def _of_registration(first: str, rest: str, signs: str) -> Iterator[Form]:
    spelled = [LETTERS[ord(first) - ord("a")]] if first.isalpha() else []
    prefixes = [first, *spelled, MAKER]
    for prefix in prefixes:
        yield Form(prefix, rest)
        if prefix == MAKER and first != "n":
            yield Form(prefix, signs)
    for size in (3, 2):
        if len(rest) > size:
            yield from (Form(prefix, rest[-size:], ABBREVIATED) for prefix in prefixes)


def _with_zeros(number: str) -> tuple[str, ...]:
    """Return a flight number with the zeros that fill it to three digits: "zero zero six"."""
    if not number.isdigit():
        return ()
    return tuple(number.zfill(size) for size in range(len(number) + 1, FILLED + 1))


def joined(name: str) -> str:
    """Return the words of a name without blanks."""
    return "".join(tokens(name))
