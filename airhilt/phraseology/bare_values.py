"""Values that are read back without any other word: "two seven zero, flight level one hundred"."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace

from airhilt.phraseology.call import Action, Instruction, Turn
from airhilt.phraseology.hits import NAME
from airhilt.phraseology.slots import (
    GROUND_MHZ,
    NO_SENSE,
    SHORTENED,
    frequency_khz,
    hpa_of,
    level_confidence,
    level_ft,
    speed_confidence,
)
from airhilt.phraseology.slots import LEVEL as _LEVEL
from airhilt.phraseology.vocabulary import COURTESIES, is_unknown

_IDLE = COURTESIES | {
    NAME, "copy", "and", "right", "bye", "see", "ya", "so", "long", "cheers", "we", "will", "then",
    "ciao", "servus", "salut", "tschuss", "adios", "later", "have", "a", "nice", "one", "flight",
    "much", "for", "now", "yes", "great", "super", "goodbye", "care", "take", "weekend",
}  # fmt: skip
"""Words that may stand beside the values."""
_FAREWELL = re.compile(r"(?<!\S)(?:have a )?(?:good|great|nice) 1$")
"""The end of "have a good one"."""
_LEAST_SPEED_KT, _GREATEST_SPEED_KT = 120, 350
_FRACTION = r"[0-9][0257]"
_VALUE = re.compile(
    r"(?:(?P<fix>[a-z]+) at (?:(?P<over>[4-9]|[12][0-9]) (?:and )?(?P<at_kt>[12][0-9]0)"
    rf"|(?P<over_level>{_LEVEL.pattern})(?: and (?P<at_speed>[12][0-9]0))?)"
    rf"|(?P<level>{_LEVEL.pattern})|(?P<speed>[1-3][0-9]{{2}}) knots"
    r"|(?P<turn>left|right) (?P<turned>[0-9]{3})|(?P<heading>[0-9]{3}) on the heading"
    r"|(?P<degrees>10|15|20|25|30|40|45) (?P<side>left|right)"
    r"|(?P<setting>2[89][0-9]{2}|3[01][0-9]{2}|9[5-9][0-9]|10[0-4][0-9])(?= |$)"
    r"|(?P<cut>1[89]|2[0-7]|3[2-6]) decimal (?P<part>[0-9]{1,3})"
    r"|(?P<mhz>1[1-3][0-9])(?P<fraction>[0-9]{1,3})(?: for [a-z]+)?"
    r"|(?P<short>(?:1[89]|2[0-9]|3[0-6])[1-46-9])"
    rf"|(?P<group>(?:1[89]|2[0-9]|3[0-6]){_FRACTION})(?= |$)"
    r"|decimal (?P<ground>[0-9]{1,2})|(?P<code>[0-7]{4})|(?P<number>[0-9]{3}))(?: |$)"
)
_FURTHER = re.compile(r"expect further(?: clearance)?(?: at| time)*(?: [0-9]{2,4})?$")
"""The time to which an aircraft holds."""
_JOINT = re.compile(r"(?:and|then)(?: and| then)* ")


@dataclass(slots=True)
class Bare:
    """Meaning of values that stand alone."""

    instructions: list[Instruction] = field(default_factory=list)
    pressure_hpa: float | None = None


def without_courtesies(words: list[str]) -> list[str]:
    """Return words without those that may stand before and behind a readback."""
    kept = words[:]
    if words[-1:] == ["1"]:
        kept = _FAREWELL.sub("", " ".join(words)).split()
    while kept and kept[0] in _IDLE and kept[0] != "right":
        del kept[0]
    while kept and (kept[-1] in _IDLE or kept[-1] == "to") and kept[-1] not in ("right", "one"):
        del kept[-1]
    return kept


def bare_values(words: list[str], beside: set[Action], last: Action | None = None) -> Bare:
    """Return the values of a readback that has nothing else; nothing if any word is left over.

    Parameters
    ----------
    words
        Words that belong to no action, without courtesies.
    beside
        Actions of the call, which tell what a number without a unit is.
    last
        Action right before the words.
    """
    text, at = _FURTHER.sub("", " ".join(words)).strip(), 0
    bare, is_then = Bare(), False
    found_values: list[tuple[re.Match[str], bool]] = []
    while at < len(text):
        joint = _JOINT.match(text, at)
        if joint and found_values:
            is_then, at = "then" in joint[0], joint.end()
        found = _VALUE.match(text, at)
        if found is None:
            return Bare()
        found_values.append((found, is_then))
        at, is_then = found.end(), False
    has_level = "altitude" in beside or any(found["level"] for found, _ in found_values)
    for index, (found, is_later) in enumerate(found_values):
        setting = _setting_of(
            found, is_behind_level=(index > 0 and has_level) or last == "cross_fix"
        )
        if setting is not None:
            bare.pressure_hpa = setting
            continue
        is_first = any(later for _, later in found_values[index + 1 : index + 2])
        value = _instruction(found, beside, has_level=has_level, is_first=is_first)
        if value is None:
            return Bare()
        bare.instructions.append(replace(value, condition="then") if is_later else value)
    return bare


def _setting_of(found: re.Match[str], *, is_behind_level: bool) -> float | None:
    """Return an altimeter setting, which only a level or its digits show to be one."""
    number = found["setting"]
    if number is None or not (is_behind_level or (len(number) == 4 and set(number) & {"8", "9"})):
        return None
    return hpa_of(number)


def _instruction(
    found: re.Match[str], beside: set[Action], *, has_level: bool, is_first: bool
) -> Instruction | None:
    """Return the instruction that a value reads back; it may be a report or another's value."""
    if found["fix"]:
        return _crossing(found)
    if found["level"]:
        return _level(found["level"], "altitude")
    if found["speed"]:
        return _speed(found["speed"], SHORTENED)
    if found["degrees"]:
        side: Turn = "left" if found["side"] == "left" else "right"
        return Instruction(
            "turn_by", turn=side, turn_deg=float(found["degrees"]), confidence=NO_SENSE
        )
    if number := found["turned"] or found["heading"]:
        turn: Turn | None = (
            "left" if found["turn"] == "left" else "right" if found["turn"] else None
        )
        return _heading(number, turn, SHORTENED)
    text = found[0].strip()
    if found["number"] or (found["setting"] and len(text) == 3):
        return _number(text, beside, has_level=has_level, is_first=is_first)
    if frequency := _frequency(found, text):
        return frequency
    is_code = len(text) == 4 and set(text) <= set("01234567")
    return Instruction("squawk", squawk=text, confidence=SHORTENED) if is_code else None


def _level(text: str, action: Action) -> Instruction | None:
    level = _LEVEL.search(text)
    feet = level and level_ft(level)
    if level is None or feet is None:
        return None
    return Instruction(action, altitude_ft=feet, confidence=min(SHORTENED, level_confidence(level)))


def _crossing(found: re.Match[str]) -> Instruction | None:
    """Return a restriction at a fix, whose name is no word of the grammar."""
    if not is_unknown(found["fix"]):
        return None
    speed = found["at_kt"] or found["at_speed"]
    level = _level(found["over_level"], "cross_fix") if found["over_level"] else None
    feet = float(found["over"]) * 1000.0 if found["over"] else None
    feet = level.altitude_ft if level else feet
    return Instruction(
        "cross_fix", position=found["fix"], altitude_ft=feet,
        speed_kt=float(speed) if speed else None, confidence=SHORTENED,
    )  # fmt: skip


def _speed(number: str, sure: float) -> Instruction:
    speed_kt = float(number)
    return Instruction("speed", speed_kt=speed_kt, confidence=min(sure, speed_confidence(speed_kt)))


def _heading(number: str, turn: Turn | None, sure: float) -> Instruction | None:
    if not 0 < int(number) <= 360:
        return None
    return Instruction("heading", turn=turn, heading_deg=float(number), confidence=sure)


def _number(
    number: str, beside: set[Action], *, has_level: bool, is_first: bool
) -> Instruction | None:
    """Return what three digits say, as far as the rest of the call tells.

    Before "then" and a level they are the speed that comes first (FAA Order JO 7110.65, 5-7-2),
    beside a heading a speed, and beside a level a heading. More than 360 is a flight level.
    """
    value = int(number)
    if value % 5 or not value:
        return None
    if value > 360:
        return Instruction("altitude", altitude_ft=value * 100.0, confidence=NO_SENSE)
    is_speed = _LEAST_SPEED_KT <= value <= _GREATEST_SPEED_KT and value % 10 == 0
    if is_speed and ((is_first and has_level) or "heading" in beside):
        return _speed(number, NO_SENSE)
    return _heading(number, None, NO_SENSE) if has_level else None


def _frequency(found: re.Match[str], text: str) -> Instruction | None:
    """Return a frequency; four digits of which none is above 7 may also be a code."""
    if found["ground"]:
        mhz, fraction = GROUND_MHZ, found["ground"]
    elif found["cut"]:
        mhz, fraction = f"1{found['cut']}", found["part"]
    elif found["mhz"]:
        mhz, fraction = found["mhz"], found["fraction"]
    else:
        digits = found["short"] or found["group"] or (found["setting"] and text)
        if not digits or not re.fullmatch(
            rf"(?:1[89]|2[0-9]|3[0-6])(?:{_FRACTION}|[1-46-9])", digits
        ):
            return None
        mhz, fraction = f"1{digits[:2]}", digits[2:]
    khz = frequency_khz(mhz, fraction)
    is_code = not found["ground"] and set(text) <= set("01234567") and len(text) == 4
    sure = NO_SENSE if is_code else SHORTENED
    return Instruction("contact", frequency_khz=khz, confidence=sure) if khz else None
