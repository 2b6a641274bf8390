"""The circumstances of one call: who is on the frequency, and the numbers said there."""

from __future__ import annotations

import random
from collections import Counter
from dataclasses import dataclass
from typing import TypeVar

from . import names
from .callsigns import Aircraft, roster, spoken
from .spoken_numbers import Speller

Choice = TypeVar("Choice")


@dataclass
class Scene:
    """One call's surroundings, from which phrases draw their values.

    Attributes
    ----------
    rng
        The source of random numbers.
    say
        The speller of numbers.
    aircraft
        The aircraft on the frequency.
    own
        The aircraft that is addressed or speaks.
    city
        The name of the facility, such as "boston".
    airport_runway
        The runway in use.
    turns
        The option that comes next in each list that is dealt in turn; all calls share it.
    """

    rng: random.Random
    say: Speller
    aircraft: tuple[Aircraft, ...]
    own: Aircraft
    city: str
    airport_runway: str
    turns: Counter[str]

    @classmethod
    def drawn(cls, rng: random.Random, turns: Counter[str]) -> Scene:
        """Return a scene drawn from a source of random numbers."""
        say = Speller(rng, "faa" if rng.random() < 0.6 else "icao")
        aircraft = roster(rng)
        own = rng.choice(aircraft)
        city, runway = rng.choice(names.CITIES), rng.choice(names.RUNWAYS)
        return cls(rng, say, aircraft, own, city, runway, turns)

    @property
    def is_faa(self) -> bool:
        """Tell whether the call follows the FAA's phraseology."""
        return self.say.style == "faa"

    def pick(self, *options: Choice) -> Choice:
        """Return one of the options."""
        return self.rng.choice(options)

    def deal(self, name: str, *options: Choice) -> Choice:
        """Return the option whose turn it is in the list of that name."""
        self.turns[name] += 1
        return options[self.turns[name] % len(options)]

    def chance(self, share: float) -> bool:
        """Return True in that share of cases."""
        return self.rng.random() < share

    def source(self, faa: str, icao: str) -> str:
        """Return the section of the authority whose phraseology is spoken."""
        return f"FAA JO 7110.65 {faa}" if self.is_faa else f"ICAO Doc 4444 {icao}"

    def callsign(self) -> str:
        """Return the own call sign as it is said."""
        return spoken(self.own, self.aircraft, self.say)

    def other_callsign(self) -> str:
        """Return the call sign of somebody else on the frequency, as it is said."""
        other = self.rng.choice([a for a in self.aircraft if a is not self.own])
        return spoken(other, self.aircraft, self.say)

    def fix(self) -> str:
        """Return the name of a fix."""
        return self.rng.choice(names.FIXES)

    def airport(self) -> str:
        """Return the name of an airport."""
        return self.rng.choice(names.AIRPORTS)

    def procedure(self) -> str:
        """Return the name of a departure or arrival."""
        return self.rng.choice(names.PROCEDURES)

    def heading_deg(self) -> int:
        """Return a heading in tens or fives of degrees, from 5 to 360."""
        return self.rng.randint(1, 36) * 10 if self.chance(0.8) else self.rng.randint(1, 72) * 5

    def speed_kt(self) -> int:
        """Return an indicated speed."""
        return self.rng.randint(16, 31) * 10

    def low_ft(self) -> int:
        """Return an altitude of an approach or departure."""
        return self.rng.randint(3, 12) * 500 if self.chance(0.5) else self.rng.randint(2, 17) * 1000

    def altitude_ft(self) -> int:
        """Return any altitude; cruising levels among them."""
        return self.low_ft() if self.chance(0.5) else self.rng.randint(18, 41) * 1000

    def khz(self) -> int:
        """Return a frequency of the aeronautical band, in steps of 25 kHz."""
        return self.rng.randint(4720, 5479) * 25

    def another_runway(self) -> str:
        """Return a runway that is not in use."""
        return self.rng.choice([r for r in names.RUNWAYS if r != self.airport_runway])

    def runway(self) -> tuple[str, str]:
        """Return the words "runway ..." and the designator of the runway in use."""
        return f"runway {self.say.runway(self.airport_runway)}", self.airport_runway

    def route(self) -> tuple[str, str]:
        """Return the words and the designators of 1 to 3 taxiways."""
        chosen = self.rng.sample(names.TAXIWAYS, self.rng.choice((1, 2, 2, 3)))
        return " ".join(self.taxiway(each) for each in chosen), " ".join(chosen)

    def taxiway(self, designator: str) -> str:
        """Return the words of a taxiway: "K5" is "kilo five"."""
        letter, number = designator[0], designator[1:]
        return (
            f"{self.say.letter(letter)} {self.say.maybe_group(number)}"
            if number
            else (self.say.letter(letter))
        )
