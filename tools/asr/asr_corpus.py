"""Made-up calls on aeronautical frequencies: texts for training and testing speech.

`Talk` draws calls with all that varies in them: who, where, which numbers, in which phraseology.
The forms are in ``asr_forms.txt``. Texts are lower-case words without punctuation, as a
transcript has them.
"""

from __future__ import annotations

import csv
import random
import re
from pathlib import Path

HERE = Path(__file__).parent
TELEPHONY = HERE.parents[1] / "airhilt" / "phraseology" / "telephony.csv"
FORMS = HERE / "asr_forms.txt"

DIGITS = "zero one two three four five six seven eight nine".split()
TEENS = "ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen nineteen".split()
TENS = "twenty thirty forty fifty sixty seventy eighty ninety".split()
LETTERS = (
    "alfa bravo charlie delta echo foxtrot golf hotel india juliett kilo lima mike november "
    "oscar papa quebec romeo sierra tango uniform victor whiskey xray yankee zulu"
).split()
MAKERS = (
    "cessna|piper|cirrus|beech|bonanza|cherokee|skyhawk|diamond|mooney|citation|learjet|"
    "gulfstream|king air|november|helicopter"
).split("|")
COMMON = "AAL DAL UAL SWA JBU BAW DLH AFR KLM RPA SKW ASA FDX UPS ACA EJA SWR RYR".split()
PLACES = (
    "washington|potomac|kennedy|newark|boston|chicago|atlanta|denver|seattle|miami|dallas|"
    "houston|oakland|san francisco|norcal|socal|los angeles|phoenix|memphis|minneapolis|"
    "cleveland|indianapolis|jacksonville|new york|amsterdam|schiphol|london|heathrow|gatwick|"
    "manchester|scottish|paris|frankfurt|munich|langen|zurich|geneva|vienna|madrid|barcelona|"
    "lisbon|rome|milano|copenhagen|stockholm|oslo|helsinki|warsaw|prague|budapest|athens|"
    "istanbul|dubai|tokyo|haneda|narita|osaka|singapore|sydney|melbourne|shannon|dublin|"
    "brussels|rhein|maastricht|reykjavik|toronto|montreal|vancouver|gander|moncton"
).split("|")
UNITS = "tower ground approach departure center centre control radar director delivery".split()
VEHICLES = (
    "ops|ops|follow me|fire truck|snow plow|sweeper|tug|car|security|maintenance|inspector|"
    "rescue|truck|checker|leader|bird control"
).split("|")
TYPES = (
    "boeing|airbus|cessna|piper|citation|learjet|gulfstream|embraer|bombardier|dash eight|"
    "regional jet|heavy boeing|seven thirty seven|triple seven|seven four seven|"
    "seven fifty seven|three twenty|three thirty|skyhawk|helicopter|twin cessna"
).split("|")
ANIMALS = "deer|coyote|fox|dog|geese|birds|gulls|flock of birds|flock of geese|animal".split("|")
POINTS = "north south east west northeast northwest southeast southwest".split()

_CHOICE = re.compile(r"\(([^()]*)\)")
_VARIABLE = re.compile(r"\{(\w+)\}")


def airlines() -> dict[str, str]:
    """Return the spoken names of airlines by their ICAO designator."""
    with TELEPHONY.open(encoding="utf-8", newline="") as stream:
        return {row["designator"]: row["telephony"] for row in csv.DictReader(stream)}


def forms() -> dict[str, list[str]]:
    """Return the forms of calls by their kind."""
    found: dict[str, list[str]] = {}
    kind = ""
    for line in FORMS.read_text(encoding="utf-8").splitlines():
        if line.startswith("["):
            kind = line.strip("[]")
        elif line and not line.startswith("#"):
            found.setdefault(kind, []).append(line)
    return found


class Talk:
    """Draws calls.

    Attributes
    ----------
    callsign_of_call
        Callsign of the last `call`, as on a flight strip; None if it names nobody.
    """

    def __init__(self, rng: random.Random) -> None:
        self.callsign_of_call: str | None = None
        self._rng = rng
        self._airlines = airlines()
        self._designators = sorted(self._airlines)
        self._forms = forms()
        self._last: str | None = None

    # --- numbers ---------------------------------------------------------------------------

    def digit(self, digit: int | str) -> str:
        """Return one digit, as some say it."""
        word = DIGITS[int(digit)]
        if word == "nine" and self._rng.random() < 0.6:
            return "niner"
        if word == "three" and self._rng.random() < 0.08:
            return "tree"
        if word == "five" and self._rng.random() < 0.08:
            return "fife"
        return word

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

    # --- what varies in a form -------------------------------------------------------------

    def callsign(self) -> str:
        """Return how somebody is called."""
        rng, kind = self._rng, self._rng.random()
        if kind < 0.74:
            return self._flight()
        if kind < 0.90:
            return self._registration()
        self._last = None
        return f"{rng.choice(VEHICLES)} {self.digits(rng.randint(1, 30))}"

    def _flight(self) -> str:
        rng = self._rng
        designator = rng.choice(COMMON if rng.random() < 0.22 else self._designators)
        number = rng.choice((rng.randint(1, 99), rng.randint(100, 999), rng.randint(1000, 9999)))
        spoken = self.digits(number) if rng.random() < 0.55 else self.group(number)
        self._last = f"{designator}{number}"
        if rng.random() < 0.06:
            letter = rng.choice(LETTERS)
            spoken = f"{self.digits(number % 1000)} {letter}"
            self._last = f"{designator}{number % 1000}{letter[0].upper()}"
        heavy = rng.choice((" heavy", " super")) if rng.random() < 0.06 else ""
        return f"{self._airlines[designator]} {spoken}{heavy}"

    def _registration(self) -> str:
        rng = self._rng
        maker = rng.choice(MAKERS)
        if rng.random() < 0.25:
            self._last = None
            return " ".join((maker, *rng.choices(LETTERS, k=rng.choice((2, 3, 4)))))
        number, letters = rng.randint(1, 999), rng.choices(LETTERS, k=rng.choice((1, 2, 2)))
        self._last = f"N{number}{''.join(letter[0].upper() for letter in letters)}"
        return " ".join((maker, self.digits(number), *letters))

    def station(self) -> str:
        """Return a controller's position."""
        unit = self._rng.choice(UNITS)
        return unit if self._rng.random() < 0.25 else f"{self._rng.choice(PLACES)} {unit}"

    def unit(self) -> str:
        """Return a position without its place."""
        return self._rng.choice(UNITS)

    def runway(self) -> str:
        """Return a runway, with its word most of the time."""
        number = self._rng.randint(1, 36)
        spoken = self.digits(f"{number:02d}" if self._rng.random() < 0.7 else number)
        side = self._rng.choice((" left", " right", " center")) if self._rng.random() < 0.35 else ""
        prefix = "runway " if self._rng.random() < 0.93 else ""
        return f"{prefix}{spoken}{side}"

    def letter(self) -> str:
        """Return a letter's word."""
        return self._rng.choice(LETTERS)

    def taxiway(self) -> str:
        """Return a taxiway."""
        name = self._rng.choice(LETTERS)
        return f"{name} {self.digit(self._rng.randint(1, 9))}" if self._rng.random() < 0.3 else name

    def level(self) -> str:
        """Return a level or an altitude."""
        rng = self._rng
        if rng.random() < 0.5:
            return f"flight level {self.digits(rng.randint(6, 45) * 10 + rng.choice((0, 0, 0, 5)))}"
        thousands = rng.randint(1, 17)
        spoken = self.digits(thousands) if rng.random() < 0.7 else self.group(thousands)
        hundreds = f" {self.digit(rng.randint(1, 9))} hundred" if rng.random() < 0.3 else ""
        feet = " feet" if rng.random() < 0.2 else ""
        return f"{spoken} thousand{hundreds}{feet}"

    def heading(self) -> str:
        """Return a heading."""
        return self.digits(f"{self._rng.randint(1, 72) * 5:03d}")

    def frequency(self) -> str:
        """Return a frequency."""
        rng = self._rng
        tail = rng.choice((0, 25, 5, 50, 75, 1, 3, 9, 15, 35, 65, 8, 7))
        point = rng.choice(("point", "decimal"))
        return f"{self.digits(rng.randint(118, 136))} {point} {self.digits(tail)}"

    def squawk(self) -> str:
        """Return a transponder code."""
        return self.digits("".join(str(self._rng.randint(0, 7)) for _ in range(4)))

    def speed(self) -> str:
        """Return a speed in knots."""
        return self.digits(self._rng.randint(12, 32) * 10)

    def tens(self) -> str:
        """Return an angle in degrees."""
        return self.digits(self._rng.randint(1, 9) * 10)

    def miles(self) -> str:
        """Return a short distance."""
        return self.digits(self._rng.randint(1, 9))

    def clock(self) -> str:
        """Return a direction on the clock."""
        return self.group(self._rng.randint(1, 12))

    def wind(self) -> str:
        """Return the wind."""
        rng = self._rng
        if rng.random() < 0.1:
            return "wind calm"
        gust = f" gust {self.digits(rng.randint(12, 35))}" if rng.random() < 0.2 else ""
        form = rng.choice(("wind {} at {}", "wind {} degrees {} knots", "winds {} at {}"))
        return form.format(self.heading(), self.digits(rng.randint(3, 30))) + gust

    def altimeter(self) -> str:
        """Return an altimeter setting."""
        rng = self._rng
        if rng.random() < 0.5:
            return f"altimeter {self.digits(rng.randint(2900, 3080))}"
        return f"q n h {self.digits(rng.randint(975, 1040))}"

    def type(self) -> str:
        """Return a type of aircraft."""
        return self._rng.choice(TYPES)

    def animal(self) -> str:
        """Return an animal."""
        return self._rng.choice(ANIMALS)

    def point(self) -> str:
        """Return a point of the compass."""
        return self._rng.choice(POINTS)

    # --- whole calls -----------------------------------------------------------------------

    def instruction(self) -> str:
        """Return one instruction, as it is given or read back."""
        return self._say("instruction")

    def traffic(self) -> str:
        """Return traffic information."""
        return self._say("traffic")

    def _say(self, kind: str) -> str:
        """Return a form of a kind with its choices made and its variables drawn."""
        form = self._rng.choice(self._forms[kind])
        while "(" in form:
            form = _CHOICE.sub(lambda choice: self._rng.choice(choice[1].split("|")), form)
        said = _VARIABLE.sub(lambda name: str(getattr(self, name[1])()), form)
        return " ".join(said.split())

    def salad(self, words: list[str]) -> str:
        """Return words that make no sense together."""
        return " ".join(self._rng.choices(words, k=self._rng.randint(2, 9)))

    def call(self) -> str:
        """Return a call of any kind."""
        rng, kind = self._rng, self._rng.random()
        who, callsign = self.callsign(), self._last
        count = rng.choices((1, 2, 3), (0.55, 0.35, 0.1))[0]
        what = " ".join(self.instruction() for _ in range(count))
        if kind < 0.36:
            station = self.station() if rng.random() < 0.3 else ""
            extra = self.traffic() if rng.random() < 0.25 else ""
            parts = [who, station, what, extra]
        elif kind < 0.60:
            parts = [rng.choice(("", "", "roger", "okay", "uh")), what, who]
        elif kind < 0.68:
            parts = [who, self.traffic()]
        elif kind < 0.80:
            first = rng.choice((f"{self.station()} {who}", who, f"tower {who}", "tower"))
            parts = [first, self._say("report")]
        elif kind < 0.86:
            parts = [self._say("report"), who]
        elif kind < 0.90:
            turn = rng.choice(("correction", "negative", "i say again", "break", "disregard"))
            parts = [who, self.instruction(), turn, self.instruction()]
        elif kind < 0.94:
            parts = [self._say("advisory")]
        elif kind < 0.97:
            parts = [what]
        else:
            parts = [self.station(), who]
        text = " ".join(" ".join(parts).split())
        self.callsign_of_call = callsign if who in text else None
        return text
