"""Callsigns as they are spoken, with what a flight strip would have of them."""

from __future__ import annotations

import random

from airhilt.phraseology.telephony import TELEPHONY, names
from asr_values import LETTERS, Values

MAKERS = (
    "aerostar|agusta|archer|arrow|aztec|baron|beech|beechcraft|beechjet|bell|bombardier|bonanza|"
    "caravan|cardinal|centurion|cessna|cessna|cessna|challenger|cherokee|chieftain|cirrus|cirrus|"
    "citabria|citation|citation|comanche|commander|conquest|cub|dakota|diamond|diamond star|"
    "duchess|eclipse|embraer|experimental|extra|falcon|glider|global express|grumman|gulfstream|"
    "hawker|helicopter|helicopter|husky|jet ranger|jetstream|king air|king air|lance|lear|learjet|"
    "legacy|light sport|long ranger|malibu|maule|meridian|mooney|mustang|navajo|november|november|"
    "november|phenom|pilatus|piper|piper|premier|robin|robinson|saratoga|seminole|seneca|sikorsky|"
    "skyhawk|skyhawk|skylane|skymaster|skywagon|sling|stationair|super cub|tecnam|tiger|tobago|"
    "tomahawk|trinidad|twin cessna|twin otter|twin star|vision jet|warrior|westwind|medevac|"
    "lifeguard"
).split("|")
"""Makers and models (FAA Order JO 7360.1) before the signs of a registration."""
COMMON = "AAL DAL UAL SWA JBU BAW DLH AFR KLM RPA SKW ASA FDX UPS ACA EJA SWR RYR".split()
"""Airlines that fly so much that they are drawn more often."""
MILITARY = (
    "reach|evac|navy|army|air force one|coast guard|guard|rescue|cobra|viper|eagle|hawk|bear|"
    "raider|python|ascot|rafair|german air force|nato|magic|spar|sam|boxer|cajun|duke|venom"
).split("|")
VEHICLES = (
    "ops|ops|follow me|fire truck|snow plow|sweeper|tug|car|security|maintenance|inspector|"
    "rescue|truck|checker|leader|bird control|operations|airport one|city|electric|plow|red|"
    "friction tester|fuel|wildlife|vehicle|lawn mower|ramp"
).split("|")
MARKS = (
    "G-#### D-#### F-#### I-#### HB-### OE-### PH-### OO-### LX-### SE-### OY-### LN-### OH-### "
    "EI-### EC-### CS-### SP-### OK-### OM-### HA-### S5-### 9A-### YU-### LZ-### YR-### SX-### "
    "TC-### 4X-### A6-### VT-### VH-### ZK-### ZS-### PP-### PR-### LV-### CC-### XA-### C-F### "
    "C-G### B-#### 9V-### HS-### 9M-### JA-####"
).split()
"""Shapes of registrations (ICAO Annex 7): each # is a letter."""


class Callsigns:
    """Draws callsigns.

    Attributes
    ----------
    strip
        The last callsign as on a flight strip; None for vehicles and the military.
    """

    def __init__(self, rng: random.Random, values: Values) -> None:
        self.strip: str | None = None
        self._rng = rng
        self._values = values
        self._designators = sorted(TELEPHONY)

    def draw(self) -> str:
        """Return how somebody is called."""
        rng, kind = self._rng, self._rng.random()
        if kind < 0.74:
            return self._flight()
        if kind < 0.90:
            return self._registration()
        self.strip = None
        if kind < 0.92:
            return f"{rng.choice(MILITARY)} {self._values.number(rng.randint(1, 999))}"
        return f"{rng.choice(VEHICLES)} {self._values.number(rng.randint(1, 30))}"

    def _flight(self) -> str:
        rng, values = self._rng, self._values
        designator = rng.choice(COMMON if rng.random() < 0.22 else self._designators)
        number = rng.choice((rng.randint(1, 99), rng.randint(100, 999), rng.randint(1000, 9999)))
        grouped = {"faa": 0.6, "icao": 0.1, "plain": 0.5}[values.style]
        spoken = values.group(number) if rng.random() < grouped else values.digits(number)
        self.strip = f"{designator}{number}"
        kind = rng.random()
        if kind < 0.08:
            count = 1 if kind < 0.05 else 2
            letters = rng.choices(LETTERS, k=count)
            number %= 1000 if count == 1 else 100
            spoken = " ".join((values.digits(number), *letters))
            self.strip = f"{designator}{number}{_initials(letters)}"
        elif len(str(number)) == 3 and rng.random() < 0.06:
            spoken = self._repeated(str(number)) or spoken
        weight = rng.choice((" heavy", " heavy", " super")) if rng.random() < 0.07 else ""
        return f"{rng.choice(names(designator))} {spoken}{weight}"

    def _repeated(self, number: str) -> str:
        """Return digits with "triple" or "double" if they repeat."""
        first, second, third = (self._values.digit(digit) for digit in number)
        if number[0] == number[1] == number[2]:
            return f"triple {first}"
        if number[1] == number[2]:
            return f"{first} double {third}"
        return f"double {first} {third}" if number[0] == number[1] else f"{first} {second} {third}"

    def _registration(self) -> str:
        """Return a registration in full, or abbreviated (Annex 10 volume II, 5.2.1.7.2.2)."""
        rng, values = self._rng, self._values
        maker = rng.choice(MAKERS)
        if rng.random() < 0.3:
            return self._of_other_states(maker)
        number, letters = rng.randint(1, 9999), rng.choices(LETTERS, k=rng.choice((0, 1, 2, 2)))
        number = number if not letters else number % 1000 or 7
        self.strip = f"N{number}{_initials(letters)}"
        signs = [*(values.digit(digit) for digit in str(number)), *letters]
        if len(signs) > 3 and rng.random() < 0.35:
            signs = signs[-3:]
        elif maker == "november" and not letters and rng.random() < 0.3:
            signs = [values.group(number)]
        prefix = f"november {maker}" if maker != "november" and rng.random() < 0.03 else maker
        return " ".join((prefix, *signs))

    def _of_other_states(self, maker: str) -> str:
        rng = self._rng
        shape = rng.choice(MARKS)
        self.strip = "".join(rng.choice(LETTERS)[0].upper() if c == "#" else c for c in shape)
        signs = self.strip.replace("-", "")
        spoken = [
            self._values.digit(sign) if sign.isdigit() else LETTERS[ord(sign) - ord("A")]
            for sign in signs
        ]
        kind = rng.random()
        if kind < 0.25:
            return " ".join((spoken[0], *spoken[-2:]))
        if kind < 0.35 and maker != "november":
            return " ".join((maker, *spoken[-2:]))
        return " ".join(spoken)


def _initials(letters: list[str]) -> str:
    return "".join(letter[0].upper() for letter in letters)
