"""The values in a call: runways, levels, headings, frequencies, taxiways, wind, pressure.

Every pattern is for the joined words of `words`, where numbers are digits: ``runway 01 left``.
"""

from __future__ import annotations

import re

from airhilt.phraseology.alphabet import LETTER_OF, LETTERS
from airhilt.phraseology.call import Wind

HPA_PER_INHG = 33.8639
"""A conventional inch of mercury (ICAO Annex 5, table 3-3, gives 33.8639 hPa)."""
GROUND_MHZ = "121"
"""MHz of ground control, which may be left out of its frequency (FAA AIM 4-3-14 b)."""
HIGHEST_LEVEL = 660
SHORTENED = 0.75
"""Confidence in a number that may be part of a longer one. A runway or level that has lost a digit
is still a runway or level."""
HIGHEST_FT = 60_000
TRANSITION_FT = 18_000.0
"""Transition altitude of the United States, in ft (14 CFR 91.121). Each other state has its own
(ICAO Doc 8168 volume III, section 2, chapter 1)."""
TOO_HIGH = 0.6
"""Confidence in a level in feet from `TRANSITION_FT` on: "to four thousand" sounds like 24,000."""

NUMBER_ENDS = r"(?! (?:thousand|hundred|miles?|knots|feet|degrees|oclock|decimal|nautical|minutes))"
"""Pattern after a number that is not followed by a unit, and so may be a runway."""
SIDE = (
    r"(?: (left|right|centre|l|r|c)(?!\S)"
    r"(?! (?:downwind|base|crosswind|closed|pattern|heading|turn(?! (?:left|right)))))"
)
"""Pattern of the side of a parallel runway; "runway 01 left downwind" is about the circuit."""
RUNWAY = rf"(0?[1-9]|[12][0-9]|3[0-6])(?!\S){NUMBER_ENDS}{SIDE}?"
NAMED_RUNWAY = re.compile(rf"(?<!\S)runway {RUNWAY}")

_LETTER = "|".join(LETTERS)
TAXIWAY = rf"(?:(?:{_LETTER}|[a-z])(?!\S)(?: [0-9]{{1,2}}(?!\S){NUMBER_ENDS})?)"
LEVEL = re.compile(
    r"(?<!passing )(?<!leaving )(?<!through )(?<!above )(?<!below )(?<!at or )"
    r"(?:(?<!\S)(?:flight )?level ([0-9]{2,3})(?!\S)"
    r"|(?<!\S)([0-9]{1,2}) thousand(?: ([1-9])00)?(?!\S)(?: feet)?"
    r"|(?<!\S)([1-9])00 feet(?!\S))"
)
BARE_FEET = re.compile(
    r"(?: (?:to|at|and|now|altitude|an|of|immediately))* ([1-9][0-9]{3,4})(?!\S)"
    r"(?! (?:knots|miles?|degrees))"
)
FREQUENCY = re.compile(r"(?<!\S)(1[1-3][0-9]) decimal ([0-9]{1,3})(?!\S)")
SHORT_FREQUENCY = re.compile(r"(?<!\S)(?:on )?decimal ([0-9]{1,3})(?!\S)")
JOINED_FREQUENCY = re.compile(r"(?<!\S)(1[1-3][0-9])([0-9]{1,3})(?!\S)")
WIND = re.compile(
    r"(?<!\S)wind (?:is )?(?:(calm)|(variable|[0-9]{3})(?: degrees)?(?: at)? ?([0-9]{1,2})(?!\S)"
    r"(?: knots)?(?: gust(?:s|ing)?(?: to)? ([0-9]{1,2})(?!\S))?)"
)
PRESSURE = re.compile(
    r"(?<!\S)(?:altimeter|qnh|q n h) (?:is )?([0-9]{3,4}|[0-9]{2} decimal [0-9]{2})(?!\S)"
)


def designator(number: str, side: str | None) -> str:
    """Return a runway designator: two digits, and the letter of a parallel runway."""
    return f"{int(number):02d}{(side or '')[:1].upper()}"


def runway_confidence(number: str) -> float:
    """Return the confidence in a runway by its number: one digit may be part of two."""
    return 1.0 if len(number) == 2 else SHORTENED


def level_confidence(found: re.Match[str]) -> float:
    """Return the confidence in a `LEVEL`: two digits of a flight level may be part of three."""
    if found[1]:
        return SHORTENED if len(found[1]) == 2 else 1.0
    return feet_confidence(level_ft(found) or 0.0)


def feet_confidence(feet: float) -> float:
    """Return the confidence in a level that was given in feet."""
    return 1.0 if feet < TRANSITION_FT else TOO_HIGH


def taxiway(text: str) -> str:
    """Return the designator of a taxiway from its words, such as B5."""
    letter, *number = text.split()
    return LETTER_OF.get(letter, letter.upper()) + "".join(number)


def level_ft(found: re.Match[str]) -> float | None:
    """Return the altitude of a `LEVEL`."""
    level, thousands, hundreds, below = found.groups()
    if level:
        is_one = 0 < int(level) <= HIGHEST_LEVEL and (len(level) == 3 or int(level) % 5 == 0)
        return float(level) * 100.0 if is_one else None
    feet = float(thousands or 0) * 1000.0 + float(hundreds or below or 0) * 100.0
    return feet if 0.0 < feet <= HIGHEST_FT else None


def frequency_khz(mhz: str, fraction: str) -> int | None:
    """Return a frequency of the aeronautical VHF band.

    After two decimals that end in 2 or 7, a 5 was left out (FAA Order JO 7110.65, 2-4-17 i).
    """
    if len(fraction) == 2 and fraction[1] in "27":
        fraction += "5"
    khz = int(mhz) * 1000 + int(fraction.ljust(3, "0"))
    return khz if 118_000 <= khz < 137_000 and khz % 5 == 0 else None


def wind_of(text: str) -> Wind | None:
    """Return the wind in a call."""
    found = WIND.search(text)
    if not found:
        return None
    calm, direction, speed, gust = found.groups()
    if calm:
        return Wind(None, 0.0)
    heading = None if direction == "variable" else float(direction)
    if heading is not None and heading > 360.0:
        return None
    return Wind(heading, float(speed), float(gust) if gust else None)


def pressure_of(text: str) -> float | None:
    """Return the altimeter setting in a call, given in inches of mercury or hectopascals."""
    found = PRESSURE.search(text)
    if not found:
        return None
    value = int(found[1].replace(" decimal ", ""))
    if 2700 <= value <= 3150:
        return value / 100.0 * HPA_PER_INHG
    return float(value) if 900 <= value <= 1060 else None
