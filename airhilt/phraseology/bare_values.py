"""Values that are read back without any other word: "two seven zero, flight level one hundred"."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import NamedTuple

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
_SPEEDS_KT = range(120, 351, 10)
"""Speeds that are read back without a unit."""
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
    has_level = "altitude" in beside or _LEVEL.search(text) is not None
    bare, is_later = Bare(), False
    while at < len(text):
        is_set = (at > 0 and has_level) or last == "cross_fix"
        for pattern, read in _VALUES:
            found = pattern.match(text, at)
            around = _Around(found is not None and _is_then(text, found.end()), has_level, is_set,
                             "heading" in beside)  # fmt: skip
            value = read(found, around) if found else None
            if found and value is not None:
                break
        else:
            return Bare()
        if isinstance(value, float):
            bare.pressure_hpa = value
        else:
            bare.instructions.append(replace(value, condition="then") if is_later else value)
        at, is_later = found.end(), _is_then(text, found.end())
        joint = _JOINT.match(text, at)
        at = joint.end() if joint else at
    return bare


def _is_then(text: str, end: int) -> bool:
    """Return whether "then" leads to the next value."""
    joint = _JOINT.match(text, end)
    return joint is not None and "then" in joint[0]


class _Around(NamedTuple):
    """Meaning of a number, as the words around it show."""

    is_first: bool
    """True if "then" stands behind it."""
    has_level: bool
    is_set: bool
    """True if an altimeter setting may stand here."""
    has_heading: bool


_Reader = Callable[[re.Match[str], _Around], Instruction | float | None]


def _level(text: str, action: Action) -> Instruction | None:
    level = _LEVEL.search(text)
    feet = level and level_ft(level)
    if level is None or feet is None:
        return None
    return Instruction(action, altitude_ft=feet, confidence=min(SHORTENED, level_confidence(level)))


def _crossing(found: re.Match[str], _: _Around) -> Instruction | None:
    """Return a restriction at a fix, whose name is no word of the grammar."""
    if not is_unknown(found["fix"]):
        return None
    level = _level(found["level"], "cross_fix") if found["level"] else None
    feet = level.altitude_ft if level else float(found["over"] or 0) * 1000.0
    speed = found["at"] or found["speed"]
    return Instruction(
        "cross_fix", position=found["fix"], altitude_ft=feet,
        speed_kt=float(speed) if speed else None, confidence=SHORTENED,
    )  # fmt: skip


def _turn_by(found: re.Match[str], _: _Around) -> Instruction:
    turn: Turn = "left" if found[2] == "left" else "right"
    return Instruction("turn_by", turn=turn, turn_deg=float(found[1]), confidence=NO_SENSE)


def _turn_to(found: re.Match[str], _: _Around) -> Instruction | None:
    turn: Turn = "left" if found[1] == "left" else "right"
    heading_deg = float(found[2])
    has_sense = 0.0 < heading_deg <= 360.0
    told = Instruction("heading", turn=turn, heading_deg=heading_deg, confidence=SHORTENED)
    return told if has_sense else None


def _setting(found: re.Match[str], around: _Around) -> float | None:
    """Return an altimeter setting, which only a level or its digits show to be one."""
    digits = found[1]
    is_one = around.is_set or (len(digits) == 4 and set(digits) & {"8", "9"})
    return hpa_of(digits) if is_one else None


def _frequency(found: re.Match[str], _: _Around) -> Instruction | None:
    """Return a frequency; four digits of which none is above 7 may also be a code."""
    mhz, point, fraction = found.groups()
    is_cut = len(mhz) == 2
    if is_cut and not point and not re.fullmatch(r"[0-9][0257]|[1-46-9]", fraction):
        return None
    khz = frequency_khz(f"1{mhz}" if is_cut else mhz, fraction)
    digits = mhz + fraction
    is_code = not point and len(digits) == 4 and set(digits) <= set("01234567")
    sure = NO_SENSE if is_code else SHORTENED
    return Instruction("contact", frequency_khz=khz, confidence=sure) if khz else None


def _ground(found: re.Match[str], _: _Around) -> Instruction | None:
    khz = frequency_khz(GROUND_MHZ, found[1])
    return Instruction("contact", frequency_khz=khz, confidence=SHORTENED) if khz else None


def _number(found: re.Match[str], around: _Around) -> Instruction | None:
    """Return what three digits say, as far as the rest of the call tells.

    Before "then" and a level they are the speed that comes first (FAA Order JO 7110.65, 5-7-2),
    beside a heading a speed, and beside a level a heading. More than 360 is a flight level.
    """
    value = int(found[1])
    if value % 5 or not value:
        return None
    if value > 360:
        return Instruction("altitude", altitude_ft=value * 100.0, confidence=NO_SENSE)
    is_first = around.is_first and around.has_level
    if value in _SPEEDS_KT and (is_first or around.has_heading):
        return Instruction("speed", speed_kt=float(value), confidence=NO_SENSE)
    told = Instruction("heading", heading_deg=float(value), confidence=NO_SENSE)
    return told if around.has_level else None


_VALUES: tuple[tuple[re.Pattern[str], _Reader], ...] = tuple(
    (re.compile(rf"{pattern}(?: |$)"), read)
    for pattern, read in (
        (r"(?P<fix>[a-z]+) at (?:(?P<over>[4-9]|[12][0-9]) (?:and )?(?P<at>[12][0-9]0)"
         rf"|(?P<level>{_LEVEL.pattern})(?: and (?P<speed>[12][0-9]0))?)", _crossing),
        (_LEVEL.pattern, lambda found, _: _level(found[0], "altitude")),
        (r"(left|right) ([0-9]{3})", _turn_to),
        (r"(10|15|20|25|30|40|45) (left|right)", _turn_by),
        (r"(2[89][0-9]{2}|3[01][0-9]{2}|9[5-9][0-9]|10[0-4][0-9])", _setting),
        (r"(1?(?:1[89]|2[0-9]|3[0-6]))( decimal )?([0-9]{1,3})(?: for [a-z]+)?", _frequency),
        (r"decimal ([0-9]{1,2})", _ground),
        (r"([0-7]{4})",
         lambda found, _: Instruction("squawk", squawk=found[1], confidence=SHORTENED)),
        (r"([0-9]{3})", _number),
    )
)  # fmt: skip
"""Values by their words: the first that can be read is taken."""
