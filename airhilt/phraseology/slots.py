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
NO_SENSE = 0.6
"""Confidence in a value that nobody assigns, such as 5,510 ft, 187 knots or a heading of 370."""
SPEEDS_KT = (60.0, 400.0)
"""Least and greatest speed that is assigned."""
LEVEL_STEP_FT = 100.0
"""Step of levels (FAA Order JO 7110.65, 2-4-17 c)."""
SPEED_STEP_KT = 5.0
"""Step of assigned speeds (FAA Order JO 7110.65, 5-7-1)."""
TRANSITION_FT = 18_000.0
"""Transition altitude of the United States, in ft (14 CFR 91.121). Each other state has its own
(ICAO Doc 8168 volume III, section 2, chapter 1)."""
TOO_HIGH = 0.6
"""Confidence in a level in feet from `TRANSITION_FT` on: "to four thousand" sounds like 24,000."""

NUMBER_ENDS = (
    r"(?! (?:thousand|hundred|miles?|knots|feet|degrees|oclock|decimal|nautical|minutes|d m e|ahead"
    r"|aircraft|in front)(?!\S))"
)
"""Pattern after a number that is not followed by a unit, and so may be a runway."""
SIDE = (
    r"(?: (left|right|centre|l|r|c)(?!\S)"
    r"(?! (?:downwind|base|crosswind|closed|pattern|heading|turn(?! (?:left|right))"
    r"|traffic(?: \||$| approved))))"
)
"""Pattern of the side of a parallel runway; "runway 01 left downwind" is about the circuit."""
RUNWAY = rf"(0?[1-9]|[12][0-9]|3[0-6])(?!\S){NUMBER_ENDS}{SIDE}?"
SIDED_RUNWAY = r"(?:0?[1-9]|[12][0-9]|3[0-6]) (?:left|right|centre|l|r|c)(?!\S)"
"""Pattern of a parallel runway, which its side shows to be one."""
NAMED_RUNWAY = re.compile(rf"(?<!\S)runway {RUNWAY}")

LETTER = rf"(?:{'|'.join(LETTERS)})(?!\S)"
"""Pattern of a letter of the spelling alphabet."""
TAXIWAY = rf"(?:(?:{'|'.join(LETTERS)}|[a-z])(?!\S)(?: [0-9]{{1,2}}(?!\S){NUMBER_ENDS})?)"
NUMBERED_LINK = r"(?:link|exit|spur) [0-9]{1,2}(?!\S)"
"""Pattern of a link between taxiways that has a number."""
_NO_RATE = r"(?!(?: [a-z]+)? (?:per minute|min)(?!\S))"
_ANY_LEVEL = (
    r"(?:(?<!\S)(?:flight |(?<!flight ))level ([0-9]{2,3})(?!\S)"
    rf"|(?<!\S)([0-9]{{1,2}}) thousand(?: ([1-9])00)?(?!\S){_NO_RATE}(?: feet)?"
    rf"|(?<!\S)([1-9])00 feet(?!\S){_NO_RATE})"
)
LEVEL = re.compile(
    r"(?<!\S)(?<!passing )(?<!leaving )(?<!through )(?<!above )(?<!below )(?<!at or )" + _ANY_LEVEL
)
LEVEL_HERE = re.compile(
    rf"(?: (?:at|to|now|and|maintain|altitude|an|of|immediately))* ?{_ANY_LEVEL}"
)
"""A level right here, whatever stands before it."""
LEVEL_WORDS = (
    r"(?:(?:flight )?level [0-9]{2,3}|[0-9]{1,2} thousand(?: [1-9]00)?(?: feet)?"
    r"|[1-9][0-9]{3,4}(?: feet)?)"
)
"""Pattern of the words of any level."""
CONTINUES = re.compile(r" [0-9](?![0-9]* (?:knots|on the)(?!\S))|(?: [a-z]+){1,2} hundred(?!\S)")
"""Pattern after a level whose number goes on, so that it may be the rest of another one."""
BARE_FEET = re.compile(
    r"(?: (?:to|at|and|now|altitude|an|of|immediately))* ([1-9][0-9]{3,4})(?!\S)"
    rf"(?! (?:miles?|degrees|thousand|decimal)){_NO_RATE}(?: feet)?"
)
_NOT_NAMES = (
    r"(?:question|cancelled|runway|heading|as|at|and|then|via|on|or|to|for|with|from|of|the|a"
    r"|when|after|until|before|once|if|behind|is|it|who|what|in|any|my|your|this|that|radial|course|flight|level|thousand"
    r"|approach|approved|clearance|present|own)(?!\S)"
)
FIX_ENDS = (
    r"(?:runway|heading|at|and|then|via|on|or|to|for|with|from|when|after|until|before|once|if"
    r"|behind|cross|crossing|climb|climbing|descend|descending|maintain|maintaining|turn|turning"
    r"|fly|direct|proceed|cleared|contact|monitor|squawk|reduce|increase|speed|slow|resume|expect"
    r"|report|hold|holding|radar|altimeter|qnh|q|wind|traffic|caution|rest|as|expedite|good|roger"
    r"|ident|information|arrival|departure|airport|no|say|stand|standby|correction|disregard"
    r"|negative|unable|intercept|join|continue|make|go|line|taxi|cancel|delete|amend|depart|leave"
    r"|in|position|flight|left turns|right turns|outbound|inbound|approach|approved|identified"
    r"|over|looking|affirm|wilco|copy|okay|tower|ground|centre|control|director|delivery|follow"
    r"|number|squawking|below|above|remain|circle|change|published|enter|intersection|waypoint|vor"
    r"|who|what|where|why|how|which|we|you|i|he|she|they|there|is|are|was|right hand|left hand"
    r"|since|weather|orbit|extend|sidestep|side|return|execute"
    r"|pushback|startup|stop|give|backtrack|going|vacate|exit"
    r"|vortac|ndb|v|by|own|delay)"
)
"""Words that end the name of a fix."""
_NO_UNIT = r"(?:thousand|hundred|miles|knots|feet|degrees|oclock|decimal|nautical|minutes|d)(?!\S)"
_UNIT_IN_NAME = (
    r"(?:ground|tower|centre)(?= \||$| (?:when|if|once|rest|and|then|after|at|climb|descend"
    r"|maintain|cross|expect|as)(?!\S))"
)
"""Pattern of a word for a unit behind which no frequency stands: Battle Ground is a navaid."""
FIX = (
    rf"(?:(?:[0-9]{{1,2}} (?!{FIX_ENDS}(?!\S)|{_NO_UNIT}))?"
    rf"(?!{_NOT_NAMES})[a-z]+(?!\S)"
    rf"(?: (?:(?!{FIX_ENDS}(?!\S))[a-z]+(?!\S)|{_UNIT_IN_NAME})){{0,2}})"
)
"""Pattern of the name of a fix or navaid: up to three words."""
DIGITS_GO_ON = re.compile(r" [a-z]+ [0-9]{1,2}(?!\S)")
"""A word and digits after a frequency: one of its digits was not understood."""
FREQUENCY = re.compile(r"(?<!\S)(1[1-3][0-9]) decimal ([0-9]{1,3})(?!\S)")
SHORT_FREQUENCY = re.compile(r"(?<!\S)(?:on )?decimal ([0-9]{1,3})(?!\S)")
WIND = re.compile(
    r"(?<!\S)wind (?:is )?(?:(calm)|(variable|[0-9]{3})(?: degrees)?(?: at)? ?([0-9]{1,2})(?!\S)"
    r"(?: knots)?(?: (?:gust(?:s|ing)?|maximum|max|peak|peaks|up)(?: up)?(?: to)?"
    r" ([0-9]{1,2})(?!\S))?)"
)
BARE_WIND = re.compile(
    r"(?:^|(?<=\| )|(?<=left )|(?<=right )|(?<=centre )|(?<=check )|(?<=land )|(?<=takeoff ))()"
    r"([0-3][0-9]0)(?: degrees at| at| degrees) ([0-9]{1,2})(?!\S)"
    r"(?: knots)?(?: (?:gust(?:s|ing)?|maximum)(?: up)?(?: to)? ([0-9]{1,2})(?!\S))?"
    r"(?= (?:runway|cleared|traffic|\||[0-9]{1,2} (?:left|right|centre|cleared))|$)"
)
"""A wind without the word."""
_AT_RUNWAY = re.compile(r"(?<!\S)(?:land|takeoff|option|touch and go|wind)(?!\S)")
PRESSURE = re.compile(
    r"(?<!\S)(?:altimeter|qnh|q n h) (?:is |now |is now )?"
    r"([0-9]{3,4}|[0-9]{2} decimal [0-9]{2})(?!\S)"
)


def designator(number: str, side: str | None) -> str:
    """Return a runway designator: two digits, and the letter of a parallel runway."""
    return f"{number.zfill(2)}{(side or '')[:1].upper()}"


def runway_confidence(number: str) -> float:
    """Return the confidence in a runway by its number: one digit may be part of two."""
    return 1.0 if len(number) == 2 else SHORTENED


def level_confidence(found: re.Match[str]) -> float:
    """Return the confidence in a `LEVEL`.

    Two digits of a flight level may be part of three, and digits after thousands belong to them.
    """
    if CONTINUES.match(found.string, found.end()):
        return NO_SENSE
    if found[1]:
        return SHORTENED if len(found[1]) == 2 else 1.0
    return feet_confidence(level_ft(found) or 0.0)


def feet_confidence(feet: float) -> float:
    """Return the confidence in a level that was given in feet."""
    if feet % LEVEL_STEP_FT:
        return NO_SENSE
    return 1.0 if feet < TRANSITION_FT else TOO_HIGH


def speed_confidence(speed_kt: float) -> float:
    """Return the confidence in an assigned speed."""
    least, greatest = SPEEDS_KT
    has_sense = least <= speed_kt <= greatest and speed_kt % SPEED_STEP_KT == 0.0
    if not has_sense:
        return NO_SENSE
    return SHORTENED if speed_kt < 100.0 else 1.0


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
    """Return the wind in a call; beside a clearance to land or take off, "wind" may be left out."""
    found = WIND.search(text) if "wind" in text else None
    if not found and (" at " in text or " degrees " in text) and _AT_RUNWAY.search(text):
        found = BARE_WIND.search(text)
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
    return hpa_of(found[1].replace(" decimal ", "")) if found else None


def hpa_of(digits: str) -> float | None:
    """Return an altimeter setting from its digits, in inches of mercury or hectopascals."""
    value = int(digits)
    if 2700 <= value <= 3150:
        return value / 100.0 * HPA_PER_INHG
    return float(value) if 900 <= value <= 1060 else None
