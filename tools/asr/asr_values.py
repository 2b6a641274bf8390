"""Values as they are spoken: runways, levels, headings, frequencies, weather, in some style.

FAA: Order JO 7110.65, 2-4-17. ICAO: Annex 10 volume II, 5.2.1.4. Beside these stands what people
say instead: "twenty four left", "eight and a half thousand", "point oh two".
"""

from __future__ import annotations

import random

DIGITS = "zero one two three four five six seven eight nine".split()
PRONOUNCED = "zero one two tree fower fife six seven eight niner".split()
"""Digits as ICAO wants them pronounced (Annex 10 volume II, 5.2.1.4.3)."""
TEENS = "ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen nineteen".split()
TENS = "twenty thirty forty fifty sixty seventy eighty ninety".split()
LETTERS = (
    "alfa bravo charlie delta echo foxtrot golf hotel india juliett kilo lima mike november "
    "oscar papa quebec romeo sierra tango uniform victor whiskey xray yankee zulu"
).split()
STYLES = ("faa", "icao", "plain")
"""Styles: of the FAA, of ICAO, and what people say who care for neither."""


class Values:
    """Draws values. All of one call are in one style."""

    def __init__(self, rng: random.Random) -> None:
        self._rng = rng
        self.style = "faa"
        self._is_strict = False

    def begin(self) -> None:
        """Draw the style of a new call."""
        self.style = self._rng.choices(STYLES, (0.45, 0.3, 0.25))[0]
        self._is_strict = self._rng.random() < 0.5

    def one_of(self, *ways: str) -> str:
        """Return one of some ways to say it."""
        return self._rng.choice(ways)

    def chance(self, share: float) -> bool:
        """Return True in a share of the draws."""
        return self._rng.random() < share

    # --- numbers ---------------------------------------------------------------------------

    def digit(self, digit: int | str) -> str:
        """Return one digit."""
        number = int(digit)
        if self.style == "icao" and self._is_strict:
            return PRONOUNCED[number]
        if number == 9 and self.chance(0.75 if self.style == "faa" else 0.4):
            return "niner"
        if self.style == "plain" and number == 0 and self.chance(0.2):
            return "oh"
        if number in (3, 5) and self.chance(0.05):
            return PRONOUNCED[number]
        return DIGITS[number]

    def digits(self, number: int | str) -> str:
        """Return a number digit by digit."""
        return " ".join(self.digit(digit) for digit in str(number))

    def group(self, number: int) -> str:
        """Return a number up to 9999 in group form: twelve thirty four."""
        if number < 10:
            return self.digit(number)
        if number < 20:
            return TEENS[number - 10]
        if number < 100:
            ones = f" {self.digit(number % 10)}" if number % 10 else ""
            return TENS[number // 10 - 2] + ones
        head, rest = divmod(number, 100)
        if rest == 0:
            return f"{self.group(head)} hundred"
        tail = f"zero {self.digit(rest)}" if rest < 10 else self.group(rest)
        return f"{self.group(head)} {tail}"

    def number(self, number: int) -> str:
        """Return a number digit by digit, or in group form by those who are plain."""
        grouped = 0.5 if self.style == "plain" else 0.05
        return self.group(number) if self.chance(grouped) else self.digits(number)

    # --- places on an aerodrome ------------------------------------------------------------

    def runway(self) -> str:
        """Return a runway, with its word most of the time."""
        return f"runway {self.bare_runway()}" if self.chance(0.93) else self.bare_runway()

    def bare_runway(self) -> str:
        """Return a runway without its word."""
        number = self._rng.randint(1, 36)
        leading = 0.2 if self.style == "faa" else 0.9
        if self.style == "plain" and number > 9 and self.chance(0.5):
            spoken = self.group(number)
        else:
            spoken = self.digits(f"{number:02d}" if self.chance(leading) else number)
        return f"{spoken} {self.side()}" if self.chance(0.4) else spoken

    def side(self) -> str:
        """Return the side of a runway among others."""
        centre = "centre" if self.style == "icao" else "center"
        return self.one_of("left", "left", "right", "right", centre)

    def letter(self) -> str:
        """Return a letter's word."""
        word = self._rng.choice(LETTERS)
        return {"alfa": "alpha", "juliett": "juliet"}.get(word, word) if self.chance(0.03) else word

    def taxiway(self) -> str:
        """Return a taxiway."""
        kind = self._rng.random()
        if kind < 0.62:
            return self.letter()
        if kind < 0.92:
            number = self._rng.randint(1, 19)
            return f"{self.letter()} {self.number(number)}"
        return f"{self.letter()} {self.letter()}"

    def route(self) -> str:
        """Return some taxiways, one after another."""
        count = self._rng.choices((1, 2, 3, 4, 5), (0.3, 0.3, 0.2, 0.12, 0.08))[0]
        return " ".join(self.taxiway() for _ in range(count))

    def stand(self) -> str:
        """Return a place to park."""
        number = self.number(self._rng.randint(1, 99))
        word = self.one_of("stand", "gate", "spot", "parking", "position", "ramp")
        return f"{word} {self.letter()} {number}" if self.chance(0.4) else f"{word} {number}"

    # --- levels, headings, speeds ------------------------------------------------------------

    def level(self) -> str:
        """Return a level or an altitude."""
        return self.flight_level() if self.chance(0.45) else self.altitude()

    def flight_level(self) -> str:
        """Return a flight level."""
        level = self._rng.randint(6, 45) * 10 + self._rng.choice((0, 0, 0, 5))
        if level % 100 == 0 and self.style != "faa" and self.chance(0.6):
            return f"flight level {self.digit(level // 100)} hundred"
        spoken = self.digits(level)
        if self.style == "plain" and self.chance(0.25):
            return self.one_of(f"level {spoken}", f"fl {spoken}", f"level {self.group(level)}")
        return f"flight level {spoken}"

    def altitude(self) -> str:
        """Return an altitude in feet."""
        thousands, hundreds = self._rng.randint(1, 17), self._rng.randint(1, 9)
        grouped = {"faa": 0.1, "icao": 0.0, "plain": 0.7}[self.style]
        spoken = self.group(thousands) if self.chance(grouped) else self.digits(thousands)
        strict = self.style == "icao" and self._is_strict and self.chance(0.4)
        word = "tousand" if strict else "thousand"
        feet = " feet" if self.chance(0.4 if self.style == "icao" else 0.08) else ""
        if self.chance(0.35):
            half = self.style == "plain" and self.chance(0.4)
            return (
                self._half(spoken)
                if half
                else f"{spoken} {word} {self.digit(hundreds)} hundred{feet}"
            )
        return f"{spoken} {word}{feet}"

    def _half(self, thousands: str) -> str:
        """Return thousands and five hundred feet, as it is said in short."""
        return self.one_of(
            f"{thousands} point five",
            f"{thousands} and a half thousand",
            f"{thousands} five hundred",
        )

    def rate(self) -> str:
        """Return a vertical rate in feet per minute."""
        thousands, hundreds = self._rng.randint(0, 4), self._rng.choice((0, 5, 5, 8))
        if thousands == 0:
            return f"{self.digit(hundreds or 5)} hundred"
        rest = f" {self.digit(hundreds)} hundred" if hundreds else ""
        return f"{self.digit(thousands)} thousand{rest}"

    def heading(self) -> str:
        """Return a heading."""
        degrees = self._rng.randint(1, 72) * 5
        if self.style == "plain" and degrees >= 100 and self.chance(0.3):
            return self.group(degrees)
        return self.digits(f"{degrees:03d}")

    def speed(self) -> str:
        """Return a speed in knots."""
        knots = self._rng.randint(12, 34) * 10 + self._rng.choice((0, 0, 0, 5))
        grouped = 0.3 if self.style == "plain" else 0.0
        return self.group(knots) if self.chance(grouped) else self.digits(knots)

    def mach(self) -> str:
        """Return a Mach number."""
        return f"mach {self.point()} {self.digits(self._rng.randint(70, 87))}"

    def tens(self) -> str:
        """Return an angle in degrees."""
        return self.number(self._rng.choice((5, *range(10, 100, 5))))

    def miles(self) -> str:
        """Return a distance."""
        return self.number(self._rng.choice((*range(1, 16), *range(1, 10), 20, 25, 30, 40, 60)))

    def minutes(self) -> str:
        """Return a number of minutes."""
        return self.number(self._rng.choice((1, 2, 3, 4, 5, 8, 10, 15, 20, 30, 45)))

    def count(self) -> str:
        """Return a place in a sequence."""
        return self.digit(self._rng.randint(1, 7))

    def clock(self) -> str:
        """Return a direction on the clock."""
        return self.group(self._rng.randint(1, 12))

    def time(self) -> str:
        """Return minutes past the hour, or hours and minutes."""
        minutes = f"{self._rng.randint(0, 59):02d}"
        return self.digits(
            f"{self._rng.randint(0, 23):02d}{minutes}" if self.chance(0.5) else minutes
        )

    # --- frequencies, codes, weather -----------------------------------------------------------

    def point(self) -> str:
        """Return the word for a decimal point."""
        if self.style == "plain":
            return self.one_of("point", "decimal", "point", "dot")
        return "decimal" if self.style == "icao" else "point"

    def frequency(self) -> str:
        """Return a frequency."""
        rng = self._rng
        mhz, tail = rng.randint(118, 136), rng.randint(0, 199) * 5
        channel = rng.random() < 0.35
        fraction = (
            f"{tail:03d}" if channel else f"{rng.randint(0, 39) * 25:03d}"[:2].rstrip("0") or "0"
        )
        whole = self.digits(mhz)
        if self.style == "plain":
            whole = self.one_of(whole, f"one {self.group(mhz - 100)}", self.group(mhz - 100))
            if len(fraction) == 2 and fraction[0] != "0" and self.chance(0.3):
                fraction_said = self.group(int(fraction))
                return f"{whole} {self.point()} {fraction_said}"
        between = "" if self.style == "plain" and self.chance(0.25) else f"{self.point()} "
        return f"{whole} {between}{self.digits(fraction)}"

    def squawk(self) -> str:
        """Return a transponder code."""
        if self.chance(0.06):
            return self.digits(self._rng.choice(("7000", "1200", "7700", "7600", "2000", "1000")))
        return self.digits("".join(str(self._rng.randint(0, 7)) for _ in range(4)))

    def wind(self) -> str:
        """Return the wind."""
        rng = self._rng
        knots, gust = self.number(rng.randint(1, 38)), self.number(rng.randint(12, 50))
        direction = self.heading()
        if self.chance(0.1):
            return self.one_of(
                "wind calm", "winds calm", "wind is calm", f"wind variable at {knots}"
            )
        if self.style == "icao":
            word = self.one_of("gusting", "maximum", "gusting up to")
            said = f"{self.one_of('wind', 'surface wind')} {direction} degrees {knots} knots"
            return f"{said} {word} {gust}" if self.chance(0.2) else said
        said = f"{self.one_of('wind', 'wind', 'winds')} {direction} at {knots}"
        return (
            f"{said} {self.one_of('gust', 'gusts', 'gusting')} {gust}" if self.chance(0.2) else said
        )

    def altimeter(self) -> str:
        """Return an altimeter setting."""
        rng = self._rng
        if self.style == "faa" or self.chance(0.3):
            return f"altimeter {self.digits(rng.randint(2900, 3080))}"
        unit = self.one_of("", "", "", " hectopascals", " hectopascal", " millibars")
        hectopascals = self.digits(rng.randint(975, 1040))
        return f"{self.one_of('q n h', 'q n h', 'pressure')} {hectopascals}{unit}"

    def temperature(self) -> str:
        """Return a temperature in degrees Celsius."""
        sign = self.one_of("", "", "", "minus ")
        return f"{sign}{self.number(self._rng.randint(0, 38))}"

    def spelled(self, name: str) -> str:
        """Return a name letter by letter, in the alphabet of the radio most of the time."""
        if self.chance(0.75):
            return " ".join(LETTERS[ord(letter) - ord("a")] for letter in name if letter != " ")
        return " ".join(name.replace(" ", ""))
