"""From the words of a call to what it says: callsign, level, runway, instruction or readback.

A level or a runway is read only where the words say one; unknown words mean nothing. The forms
are those of ICAO Doc 4444, chapter 12, and FAA Order JO 7110.65, chapter 2, section 4, and
chapter 3, sections 7 to 10.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, cast

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

MAKERS = "cessna", "piper", "beech", "cirrus", "november"
"""What the call of an aircraft of the United States may begin with (FAA AIM, 4-2-4)."""

LETTERS = (
    "alfa", "bravo", "charlie", "delta", "echo", "foxtrot", "golf", "hotel", "india",
    "juliett", "kilo", "lima", "mike", "november", "oscar", "papa", "quebec", "romeo",
    "sierra", "tango", "uniform", "victor", "whiskey", "xray", "yankee", "zulu",
)  # fmt: skip
"""Spoken letters (ICAO Annex 10 volume II, 5.2.1.3)."""

VEHICLES = {"PLOW": ("snow plow", "snow plough", "plough"), "FIRE": ("fire truck",)}
"""Other ways to say the call of a vehicle than by its letters and number."""

THOUSANDS = re.compile(r"\b(\d{1,2}),(\d{3})\b")
"""A number with a thousands separator, such as 5,000."""

DISTRESS = "mayday"

Sense = Literal["climb", "descend", "maintain"]

_SENSES: dict[str, Sense] = {
    "climb": "climb", "climbing": "climb", "descend": "descend", "descending": "descend",
    "maintain": "maintain", "maintaining": "maintain",
}  # fmt: skip

Action = Literal[
    "cleared_to_land", "cleared_for_takeoff", "line_up", "hold_short", "hold_position", "cross",
    "proceed", "cancel_takeoff", "go_around", "wildlife", "wildlife_gone",
]  # fmt: skip
"""What a call says about a runway: instructions, their readbacks, and reports of wildlife."""

ANIMALS = "deer|coyote|fox|dog|animal|wildlife|geese|goose|gulls?|birds?(?! strike)|flock"

_ACTIONS: dict[Action, str] = {
    "cleared_to_land": r"clear(ed)? (to )?land",
    "cleared_for_takeoff": r"clear(ed)? (for )?(immediate )?take ?off",
    "line_up": r"(line|lining) up( and wait)?",
    "hold_short": r"hold(ing)? short( of)?",
    "hold_position": r"hold(ing)? (your )?position",
    "cross": r"(?<!traffic )cross(ing)?(?= runway| \d)",
    "proceed": r"(proceed(ing)?|enter(ing)?)(?= \D*runway)",
    "cancel_takeoff": r"(cancel|abort|reject)(ling|ing)? (your )?take ?off( clearance)?",
    "go_around": r"go(ing)? around",
    "wildlife_gone": rf"({ANIMALS})\b.*\b((has|have) left|gone|(is|are) clear)\b",
    "wildlife": rf"({ANIMALS})\b(.*\b({ANIMALS})\b)?",
}
_ANY_ACTION = re.compile("|".join(rf"\b(?P<{action}>{form})" for action, form in _ACTIONS.items()))
_RUNWAY = r"(0?[1-9]|[12]\d|3[0-6])(?: (left|l|right|r|cent(?:er|re)|c))?(?!\S)"
_BEFORE = re.compile(rf"runway {_RUNWAY}(?: at [a-z]+(?: \d+)?)?$")
_AFTER = re.compile(rf"^(?: (?:on )?(?:runway )?|(?:(?! traffic).)* runway ){_RUNWAY}")


@dataclass(frozen=True, slots=True)
class Instruction:
    """One action of a call and the runway that it is about, if the words say one."""

    action: Action
    runway: str | None


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
    instructions: tuple[Instruction, ...] = ()
    distress: bool = False
    """It says mayday (ICAO Annex 10 volume II, 5.3.2)."""


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
    registration = re.fullmatch(r"N(\d+)([A-Z]*)", callsign)
    if registration:
        spelled = [LETTERS[ord(letter) - ord("A")] for letter in registration[2]]
        forms += [[maker, registration[1], *spelled] for maker in MAKERS]
    vehicle = re.fullmatch(r"([A-Z]+)(\d+)", callsign)
    if vehicle:
        forms += [[*name.split(), vehicle[2]] for name in VEHICLES.get(vehicle[1], ())]
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


def designator(number: str, side: str | None) -> str:
    """Return a runway designator: two digits, and the letter of a parallel runway."""
    return f"{int(number):02d}{(side or '')[:1].upper()}"


def instructions(words: list[str]) -> tuple[Instruction, ...]:
    """Return what the words say about runways, in their order.

    The runway of an action is said right before it or after it, but not after the word "traffic",
    which is about somebody else.
    """
    text = " ".join(words)
    said: list[Instruction] = []
    matches = list(_ANY_ACTION.finditer(text))
    used = 0
    for index, match in enumerate(matches):
        following = matches[index + 1].start() if index + 1 < len(matches) else len(text)
        before = _BEFORE.search(text[used : match.start()].rstrip())
        after = _AFTER.search(text[match.end() : following])
        runway = before or after
        used = match.end() + (after.end() if runway is after and after else 0)
        action = cast(Action, match.lastgroup)
        said.append(Instruction(action, designator(*runway.groups()) if runway else None))
    return tuple(said)


def parse_call(text: str, callsigns: Iterable[str]) -> Call:
    """Return what a call says, its callsign among those that are known on the frequency.

    Of several, it is the one that begins the call, else the one that ends it, else the first.
    """
    words = tokens(text)
    found: list[tuple[int, int, str]] = []
    for callsign in callsigns:
        for form in spoken_forms(callsign):
            position = _find(words, form)
            if position is not None:
                found.append((position, len(form), callsign))
    sense = next((_SENSES[word] for word in words if word in _SENSES), None)
    distress = DISTRESS in words
    if not found:
        return Call(None, False, sense, altitude_ft(words), instructions(words), distress)
    position, size, callsign = min(
        found, key=lambda each: (each[0] > 0, each[0] + each[1] < len(words), each[0])
    )
    rest = [*words[:position], "|", *words[position + size :]]
    level = altitude_ft(rest) if sense is not None else None
    return Call(callsign, position == 0, sense, level, instructions(rest), distress)
