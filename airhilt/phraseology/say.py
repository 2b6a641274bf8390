"""The words of a call for its meaning, in the phraseology of the FAA or of ICAO.

`parse_call` finds the same meaning in these words. FAA: Order JO 7110.65. ICAO: Annex 10
volume II, 5.2.1, and Doc 4444, chapter 12.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from airhilt.phraseology.call import Instruction
from airhilt.phraseology.numbers import Style, speak_digits, speak_group
from airhilt.phraseology.spoken_actions import phrase_of
from airhilt.phraseology.spoken_values import (
    join,
    speak_altitude,
    speak_frequency,
    speak_heading,
    speak_pressure,
    speak_runway,
    speak_speed,
    speak_taxiway,
    speak_wind,
    spell,
)
from airhilt.phraseology.telephony import TELEPHONY

__all__ = [
    "speak_abbreviated", "speak_altitude", "speak_callsign", "speak_frequency", "speak_heading",
    "speak_instruction", "speak_pressure", "speak_ra_report", "speak_readback", "speak_runway",
    "speak_say_again", "speak_speed", "speak_taxiway", "speak_traffic", "speak_traffic_alert",
    "speak_wind",
]  # fmt: skip

_VEHICLES = {"PLOW": "snow plow", "FIRE": "fire truck"}


# --- who ------------------------------------------------------------------------------------


def speak_callsign(callsign: str, style: Style) -> str:
    """Return a callsign in full.

    The FAA says the number of a flight in group form (2-4-15 a), ICAO digit by digit.
    """
    airline = re.fullmatch(r"([A-Z]{3})([0-9]+)([A-Z]*)", callsign)
    if airline and airline[1] in TELEPHONY:
        number = airline[2]
        grouped = style == "faa" and not airline[3] and number[0] != "0" and len(number) <= 4
        spoken = speak_group(int(number), style) if grouped else speak_digits(number, style)
        return join(TELEPHONY[airline[1]].title(), spoken, spell(airline[3], style))
    named = re.fullmatch(r"([A-Z]{2,})([0-9]+)", callsign)
    if named:
        name = _VEHICLES.get(named[1], named[1].lower())
        return join(name.capitalize(), speak_digits(named[2], style))
    spelled = spell(callsign, style)
    return spelled[:1].upper() + spelled[1:]


def speak_abbreviated(callsign: str, style: Style) -> str:
    """Return the abbreviated form of a callsign, which only registrations have.

    The form is the first sign with the last two (Annex 10 volume II, 5.2.1.7.2.2), or three
    (7110.65, 2-4-9).
    """
    kept = 3 if style == "faa" else 2
    signs = callsign.replace("-", "")
    if re.fullmatch(r"N[1-9][0-9]{0,4}[A-Z]{0,2}|[A-Z]{1,2}-[A-Z0-9]{2,5}", callsign) is None:
        return speak_callsign(callsign, style)
    if len(signs) <= kept + 1:
        return speak_callsign(callsign, style)
    spelled = spell(signs[0] + signs[-kept:], style)
    return spelled[:1].upper() + spelled[1:]


# --- calls ----------------------------------------------------------------------------------


def speak_instruction(
    callsign: str,
    instructions: Instruction | Sequence[Instruction],
    style: Style,
    reason: str = "",
) -> str:
    """Return a call with instructions for an actor, and their reason in a few words."""
    several = (instructions,) if isinstance(instructions, Instruction) else instructions
    parts = [phrase_of(each, style, readback=False) for each in several]
    return _sentence(speak_callsign(callsign, style), *parts, *([reason] if reason else []))


def speak_traffic(clock: int, distance_nm: int, style: Style) -> str:
    """Return where traffic is, as a hand of the clock and a distance (7110.65, 2-1-21 a).

    Ten, eleven and twelve are not said digit by digit (Annex 10 volume II, 5.2.1.4.1).
    """
    hand = speak_digits(str(clock), style) if clock < 10 else speak_group(clock, style)
    miles = "mile" if distance_nm == 1 else "miles"
    if distance_nm < 1:
        return f"{hand} o'clock, less than one mile"
    return f"{hand} o'clock, {speak_digits(str(distance_nm), style)} {miles}"


def speak_traffic_alert(
    callsign: str, instructions: Sequence[Instruction], traffic: str, style: Style
) -> str:
    """Return an alert of traffic, with what to do at once; ``traffic`` is of `speak_traffic`.

    With an immediate instruction it says "immediately". FAA: Order JO 7110.65, 2-1-6 b, without
    "advise you": it is an instruction. ICAO: Doc 4444,
    12.4.1.8.
    """
    who = speak_callsign(callsign, style)
    calm = [replace(each, immediate=False) for each in instructions]
    action = " and ".join(phrase_of(each, style, readback=False) for each in calm)
    if any(each.immediate for each in instructions):
        action = f"{action} immediately"
    if style == "faa":
        return _sentence("traffic alert", who, *([f"traffic {traffic}"] if traffic else []), action)
    return _sentence(who, action, f"to avoid traffic at {traffic}" if traffic else "traffic alert")


def speak_ra_report(callsign: str, style: Style, *, is_over: bool) -> str:
    """Return a crew's report of a resolution advisory, or of its end (Doc 4444, 12.3.1.2)."""
    who = speak_callsign(callsign, style)
    return f"{who}, clear of conflict." if is_over else f"{who}, TCAS RA."


def speak_readback(
    callsign: str, instructions: Instruction | Sequence[Instruction | str], style: Style
) -> str:
    """Return the readback of instructions, or "roger" if there are none.

    Words among the instructions are said as they are.
    """
    several = (instructions,) if isinstance(instructions, Instruction) else instructions
    parts = [
        each if isinstance(each, str) else phrase_of(each, style, readback=True) for each in several
    ] or ["roger"]
    return _sentence(*parts, speak_callsign(callsign, style))


def speak_say_again(callsign: str, style: Style = "faa") -> str:
    """Return the request to repeat a call."""
    return _sentence("say again", speak_callsign(callsign, style))


def _sentence(*parts: str) -> str:
    text = ", ".join(parts)
    return f"{text[:1].upper()}{text[1:]}."
