"""Numbers as controllers and pilots say them.

FAA JO 7110.65 2-4-17 ("Numbers usage") has the separate digits, group form and "point". ICAO
Annex 10 volume II 5.2.1.4 and Doc 9432 2.4 have "decimal", whole hundreds and whole thousands.
Both are mixed on the air, so a `Speller` draws the form of each number.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

Style = Literal["faa", "icao"]
Spell = Callable[[int], str]

PLAIN = "zero one two three four five six seven eight nine".split()
TEENS = ("ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen nineteen").split()
TENS = "- - twenty thirty forty fifty sixty seventy eighty ninety".split()
SPOKEN_AS = {3: "tree", 4: "fower", 5: "fife", 9: "niner"}
"""Pronunciations of Annex 10 that recognisers sometimes write."""
LETTERS = (
    "alfa bravo charlie delta echo foxtrot golf hotel india juliett kilo lima mike november oscar "
    "papa quebec romeo sierra tango uniform victor whiskey x-ray yankee zulu"
).split()
SIDES = {"L": "left", "R": "right", "C": "center"}


def pair(number: int) -> str:
    """Return a number below 100 as in group form: 7 is "seven", 23 is "twenty three"."""
    if number < 10:
        return PLAIN[number]
    if number < 20:
        return TEENS[number - 10]
    return TENS[number // 10] + (f" {PLAIN[number % 10]}" if number % 10 else "")


def group(digits: str) -> str:
    """Return two to four digits in group form: "1234" is "twelve thirty four"."""
    if len(digits) < 2 or digits[0] == "0":
        return " ".join(PLAIN[int(each)] for each in digits)
    if digits.endswith("00") and len(digits) > 2:
        return f"{pair(int(digits[:-2]))} hundred"
    head, tail = digits[:-2], digits[-2:]
    second = f"zero {PLAIN[int(tail[1])]}" if tail[0] == "0" else pair(int(tail))
    return f"{pair(int(head))} {second}" if head else second


def run_together(first: str, second: str) -> bool:
    """Tell whether two texts read as one number: "heading two twenty" and "five three six"."""
    digits = {*PLAIN[1:], *SPOKEN_AS.values()}
    end, (begin, *more) = first.split()[-1], second.split()
    if end == "thousand":
        return begin in digits and more[:1] == ["hundred"]
    return end in TENS and begin in digits


@dataclass
class Speller:
    """Numbers of one call, said in one style.

    Attributes
    ----------
    rng
        The source of random numbers.
    style
        The authority whose forms are said.
    spoken
        The digits that are written as pronounced, such as "niner".
    errors_left
        The number of slips of the tongue still to be corrected in this call.
    """

    rng: random.Random
    style: Style
    spoken: dict[int, str] = field(init=False)
    errors_left: int = 0

    def __post_init__(self) -> None:
        chosen = {9: "niner"} if self.rng.random() < 0.6 else {}
        if self.style == "icao" and self.rng.random() < 0.2:
            chosen = SPOKEN_AS
        self.spoken = chosen

    def digits(self, text: str) -> str:
        """Return each digit by itself."""
        return " ".join(self.spoken.get(int(each), PLAIN[int(each)]) for each in text)

    def letters(self, text: str) -> str:
        """Return letters and digits in the spelling alphabet."""
        return " ".join(self.digits(each) if each.isdigit() else self.letter(each) for each in text)

    def letter(self, letter: str) -> str:
        """Return a word of the spelling alphabet, in one of the usual spellings."""
        if letter in "AJX" and self.rng.random() < 0.5:
            return {"A": "alpha", "J": "juliet", "X": "xray"}[letter]
        return LETTERS[ord(letter) - ord("A")]

    def maybe_group(self, text: str, share: float = 0.35) -> str:
        """Return digits in group form in that share of cases, or else one by one."""
        return group(text) if self.rng.random() < share else self.digits(text)

    def heading(self, heading_deg: int) -> str:
        """Return a heading, in degrees; sometimes a wrong one and its correction first."""
        wrong = heading_deg + 10 if heading_deg <= 350 else 10
        return self._slip(wrong, heading_deg, lambda n: self._three_digits(n))

    def _three_digits(self, number: int) -> str:
        text = f"{number:03}"
        if self.style == "icao" and text.endswith("00") and self.rng.random() < 0.5:
            return f"{self.digits(text[0])} hundred"
        return self.maybe_group(text, 0.25 if self.style == "faa" else 0.05)

    def speed(self, speed_kt: int) -> str:
        """Return a speed, in knots; sometimes a wrong one and its correction first."""
        return self._slip(speed_kt + 10, speed_kt, lambda n: self.maybe_group(f"{n}", 0.3))

    def altitude(self, altitude_ft: int) -> str:
        """Return an altitude, in feet; sometimes a wrong one and its correction first."""
        return self._slip(altitude_ft + 1000, altitude_ft, self._altitude)

    def _altitude(self, altitude_ft: int) -> str:
        thousands, rest = divmod(altitude_ft, 1000)
        if rest and thousands and thousands < 10 and self.rng.random() < 0.15:
            return group(f"{altitude_ft}")  # "forty five hundred", not by the book but usual
        said = f"{self.maybe_group(f'{thousands}', 0.25)} thousand" if thousands else ""
        if rest:
            said += f" {self.digits(f'{rest // 100}')} hundred"
        return said.strip()

    def level(self, level: int) -> str:
        """Return a flight level, in hundreds of feet, without the words "flight level"."""
        return self._slip(level + 10, level, lambda n: self._three_digits(n))

    def vertical(self, altitude_ft: int) -> tuple[str, int, str]:
        """Return the words, the value and the unit of an altitude or flight level.

        Levels begin at 18,000 ft in the FAA's calls and at 8,000 ft in ICAO's.
        """
        if altitude_ft >= (18000 if self.style == "faa" else 8000):
            level = altitude_ft // 100
            return f"flight level {self.level(level)}", level, "FL"
        feet = self.rng.random() < (0.75 if self.style == "icao" else 0.1)
        return self.altitude(altitude_ft) + (" feet" if feet else ""), altitude_ft, "ft"

    def runway(self, runway: str) -> str:
        """Return the designator of a runway: "27L" is "two seven left"."""
        number = runway.rstrip("LRC")
        if self.style == "faa":
            number = number.lstrip("0")
        words = self.maybe_group(number, 0.06)
        return " ".join([words, *(SIDES[each] for each in runway if each in SIDES)])

    def frequency(self, khz: int) -> str:
        """Return a frequency, in kHz, with "point", "decimal" or nothing between."""
        whole, part = f"{khz // 1000}", f"{khz % 1000:03}"
        if self.style == "icao":
            part = part[0] if part.endswith("00") else part
            return f"{self.digits(whole)} decimal {self.digits(part)}"
        part = part.rstrip("0") or "0"
        if self.rng.random() < 0.2 and len(part) == 2 and part[0] != "0":
            return f"{self.maybe_group(whole, 1.0)} {group(part)}"
        point = "point " if self.rng.random() < 0.75 else ""
        return f"{self.digits(whole)} {point}{self.digits(part)}"

    def code(self, squawk: str) -> str:
        """Return a transponder code."""
        if self.style == "icao" and squawk.endswith("000") and squawk[0] != "0":
            return f"{self.digits(squawk[0])} thousand"
        return self.digits(squawk)

    def count(self, number: int) -> str:
        """Return a small number, such as miles or o'clock: "twelve" or "one two"."""
        return self.maybe_group(f"{number}", 0.6)

    def _slip(self, wrong: int, right: int, spell: Spell) -> str:
        if not self.errors_left:
            return spell(right)
        self.errors_left -= 1
        return f"{spell(wrong)} correction {spell(right)}"
