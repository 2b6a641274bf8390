"""Call signs: a roster of aircraft, and the ways to say one of them.

FAA JO 7110.65 2-4-20 and AIM 4-2-4 have airline numbers in group form and the last three characters
of a registration. ICAO Annex 10 volume II 5.2.1.7.2 has the first character and the last two.
"""

from __future__ import annotations

import random
from dataclasses import dataclass

from .names import AIRLINES, TYPES_OF_GENERAL_AVIATION
from .spoken_numbers import Speller, group

LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ"
FOREIGN = ("GA", "GB", "DE", "FG", "HB", "CF", "CG", "PH", "EI", "VH", "ZK", "OE")
"""Begins of registrations in other states, without the dash."""


@dataclass(frozen=True)
class Aircraft:
    """An aircraft on the frequency.

    Attributes
    ----------
    ident
        The call sign in ICAO form, as in a flight plan.
    telephony
        The airline's spoken name; None for a registration.
    number
        The characters after the airline's designator, or the registration.
    suffix
        The wake category that is said, "heavy" or "super", or nothing.
    model
        The type that is said before a registration, or nothing.
    """

    ident: str
    telephony: str | None
    number: str
    suffix: str = ""
    model: str = ""


def roster(rng: random.Random) -> tuple[Aircraft, ...]:
    """Return 3 to 8 aircraft; in a third of cases two of them sound alike."""
    size = rng.randint(3, 8)
    found = {a.ident: a for a in (_aircraft(rng) for _ in range(size))}
    if rng.random() < 0.35:
        twin = _sounding_alike(rng, rng.choice(list(found.values())))
        found.setdefault(twin.ident, twin)
    while len(found) > 8 or len(found) < 3:
        if len(found) > 8:
            found.pop(next(iter(found)))
        else:
            other = _aircraft(rng)
            found.setdefault(other.ident, other)
    aircraft = list(found.values())
    rng.shuffle(aircraft)
    return tuple(aircraft)


def _aircraft(rng: random.Random) -> Aircraft:
    if rng.random() < 0.72:
        return _airliner(rng, rng.choice(list(AIRLINES)), _flight(rng))
    if rng.random() < 0.75:
        return _registered(rng, "N" + _tail(rng))
    begin = rng.choice(FOREIGN)
    return _registered(rng, begin + "".join(rng.choices(LETTERS, k=5 - len(begin))))


def _airliner(rng: random.Random, designator: str, number: str) -> Aircraft:
    share = rng.random()
    suffix = "heavy" if share < 0.12 else "super" if share < 0.14 else ""
    return Aircraft(designator + number, AIRLINES[designator], number, suffix)


def _registered(rng: random.Random, ident: str) -> Aircraft:
    model = rng.choice(TYPES_OF_GENERAL_AVIATION) if rng.random() < 0.5 else ""
    return Aircraft(ident, None, ident, "", model)


def _flight(rng: random.Random) -> str:
    share = rng.random()
    if share < 0.12:
        return f"{rng.randint(1, 99)}{''.join(rng.choices(LETTERS, k=rng.randint(1, 2)))}"
    length = rng.choice((1, 2, 3, 3, 3, 4, 4, 4))
    number = rng.randint(10 ** (length - 1), 10**length - 1)
    return f"{number + 1 if number % 1000 == 0 else number}"


def _tail(rng: random.Random) -> str:
    letters = rng.choice((0, 1, 2, 2))
    length = rng.randint(2, 5 - letters) if letters else rng.randint(3, 5)
    digits = f"{rng.randint(10 ** (length - 1), 10**length - 1)}"
    return digits + "".join(rng.choices(LETTERS, k=letters))


def _sounding_alike(rng: random.Random, one: Aircraft) -> Aircraft:
    if one.telephony is None:
        front, last = one.ident[:-1], one.ident[-1]
        others = "0123456789" if last.isdigit() else "BDEGPTV" if last in "BDEGPTV" else LETTERS
        return _registered(rng, front + rng.choice([c for c in others if c != last]))
    designator = one.ident[:3]
    choice = rng.random()
    if choice < 0.4 and one.number.isdigit() and len(one.number) > 1:
        swapped = one.number[:-2] + one.number[-1] + one.number[-2]
        if swapped != one.number and swapped[0] != "0" and int(swapped) % 1000:
            return _airliner(rng, designator, swapped)
    if choice < 0.7:
        return _airliner(rng, rng.choice([d for d in AIRLINES if d != designator]), one.number)
    return _airliner(rng, designator, f"{rng.randint(1, 9)}{one.number}"[:4])


def spoken(aircraft: Aircraft, others: tuple[Aircraft, ...], speller: Speller) -> str:
    """Return a call sign as it is said; shortened only where nobody else is called so."""
    if aircraft.telephony is not None:
        number = _flight_number(aircraft.number, speller)
        return f"{aircraft.telephony} {number} {aircraft.suffix}".strip()
    short = _short(aircraft, speller)
    same = [o for o in others if o is not aircraft and o.ident[-3:] == aircraft.ident[-3:]]
    if short and not same and speller.rng.random() < 0.45:
        return f"{aircraft.model} {short}".strip()
    body = aircraft.ident
    if aircraft.model and body[0] == "N":
        body = body[1:]  # The type replaces the "N": AIM 4-2-4.
    return f"{aircraft.model} {speller.letters(body)}".strip()


def _short(aircraft: Aircraft, speller: Speller) -> str:
    ident = aircraft.ident
    if ident[0] == "N":
        if aircraft.model or speller.style == "faa":
            is_bare = aircraft.model or (ident[-1].isalpha() and speller.rng.random() < 0.4)
            begin = "" if is_bare else "november "
            return begin + speller.letters(ident[-3:]) if len(ident) > 4 else ""
        return ""
    return speller.letters(ident[0] + ident[-2:])


def _flight_number(number: str, speller: Speller) -> str:
    if not number.isdigit():
        return speller.letters(number)
    is_grouped = speller.rng.random() < (0.85 if speller.style == "faa" else 0.2)
    return group(number) if is_grouped and len(number) > 1 else speller.digits(number)
