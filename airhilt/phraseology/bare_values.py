"""Values that are read back without any other word: "two seven zero, flight level one hundred"."""

from __future__ import annotations

import re

from airhilt.phraseology.call import Instruction, Turn
from airhilt.phraseology.hits import NAME
from airhilt.phraseology.slots import (
    GROUND_MHZ,
    SHORTENED,
    frequency_khz,
    level_confidence,
    level_ft,
    speed_confidence,
)
from airhilt.phraseology.slots import LEVEL as _LEVEL
from airhilt.phraseology.vocabulary import COURTESIES

_IDLE = COURTESIES | {NAME, "copy", "and", "right", "bye", "see", "ya", "so", "long", "cheers"}
"""Words that may stand beside the values."""
_VALUE = re.compile(
    rf"(?:(?P<level>{_LEVEL.pattern})|(?P<speed>[1-3][0-9]{{2}}) knots"
    r"|(?P<turn>left|right) (?P<turned>[0-9]{3})|(?P<heading>[0-9]{3}) on the heading"
    r"|(?P<mhz>1[1-3][0-9])(?P<fraction>[0-9]{2,3}|(?<=[89])[0-9])|(?P<short>(?:1[89]|2[0-9]|3[0-6])[1-46-9])"
    r"|decimal (?P<ground>[0-9]{1,2})|(?P<code>[0-7]{4}))(?: |$)"
)


def bare_values(words: list[str]) -> list[Instruction]:
    """Return the values of a readback that has nothing else; none if any word is left over."""
    kept = list(words)
    while kept and kept[0] in _IDLE:
        del kept[0]
    while kept and kept[-1] in _IDLE:
        del kept[-1]
    text, at = " ".join(kept), 0
    read: list[Instruction] = []
    while at < len(text):
        found = _VALUE.match(text, at)
        value = _instruction(found) if found else None
        if found is None or value is None:
            return []
        read.append(value)
        at = found.end()
    return read


def _megahertz(found: re.Match[str]) -> tuple[str, str]:
    """Return the megahertz and the decimals of a frequency, without what was left out."""
    if found["ground"]:
        return GROUND_MHZ, found["ground"]
    if found["short"]:
        return f"1{found['short'][:2]}", found["short"][2:]
    return found["mhz"], found["fraction"]


def _instruction(found: re.Match[str]) -> Instruction | None:
    """Return the instruction that a value reads back; it may be a report or another's value."""
    if found["level"]:
        level = _LEVEL.search(found[0])
        feet = level and level_ft(level)
        if level is None or feet is None:
            return None
        sure = min(SHORTENED, level_confidence(level))
        return Instruction("altitude", altitude_ft=feet, confidence=sure)
    if found["speed"]:
        speed_kt = float(found["speed"])
        sure = min(SHORTENED, speed_confidence(speed_kt))
        return Instruction("speed", speed_kt=speed_kt, confidence=sure)
    number = found["turned"] or found["heading"]
    if number:
        turn: Turn | None = (
            "left" if found["turn"] == "left" else "right" if found["turn"] else None
        )
        is_one = 0 < int(number) <= 360
        return (
            Instruction("heading", turn=turn, heading_deg=float(number), confidence=SHORTENED)
            if is_one
            else None
        )
    if found["mhz"] or found["short"] or found["ground"]:
        khz = frequency_khz(*_megahertz(found))
        told = Instruction("contact", frequency_khz=khz, confidence=SHORTENED)
        return told if khz else None
    return Instruction("squawk", squawk=found["code"], confidence=SHORTENED)
