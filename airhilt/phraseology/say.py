"""The words of a call for its meaning, in the phraseology of the FAA or of ICAO.

`parse_call` finds the same meaning in these words. FAA: Order JO 7110.65. ICAO: Annex 10
volume II, 5.2.1, and Doc 4444, chapter 12.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from airhilt.phraseology.alphabet import LETTERS
from airhilt.phraseology.call import Action, Instruction, Wind
from airhilt.phraseology.numbers import Style, speak_digits, speak_group, speak_thousands
from airhilt.phraseology.slots import HPA_PER_INHG, TRANSITION_FT
from airhilt.phraseology.telephony import TELEPHONY

_SIDES = {"L": "left", "R": "right", "C": "center"}
_VEHICLES = {"PLOW": "snow plow", "FIRE": "fire truck"}
_APPROACHES = {"ils": "i l s", "rnav": "r nav", "rnp": "r n p", "vor": "v o r", "gps": "g p s"}


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
        return _join(TELEPHONY[airline[1]].title(), spoken, _spell(airline[3], style))
    named = re.fullmatch(r"([A-Z]{2,})([0-9]+)", callsign)
    if named:
        name = _VEHICLES.get(named[1], named[1].lower())
        return _join(name.capitalize(), speak_digits(named[2], style))
    spelled = _spell(callsign, style)
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
    spelled = _spell(signs[0] + signs[-kept:], style)
    return spelled[:1].upper() + spelled[1:]


# --- values ---------------------------------------------------------------------------------


def speak_runway(runway: str, style: Style) -> str:
    """Return a runway; the FAA leaves out its zero, as the signs do (2-4-17 k)."""
    number, side = runway[:2], _SIDES.get(runway[2:], "")
    digits = number.lstrip("0") if style == "faa" else number
    return _join("runway", speak_digits(digits, style), side)


def speak_taxiway(taxiway: str, style: Style) -> str:
    """Return a taxiway or an intersection, such as B5."""
    return _spell(taxiway, style)


def speak_altitude(feet: float, style: Style, transition_ft: float = TRANSITION_FT) -> str:
    """Return an altitude, or a flight level from the transition altitude on."""
    if feet >= transition_ft:
        level = f"{round(feet / 100.0):03d}"
        return f"flight level {speak_digits(level, style)}"
    spoken = speak_thousands(round(feet / 100.0) * 100, style)
    return spoken if feet >= 1000.0 else f"{spoken} feet"


def speak_heading(heading_deg: float, style: Style) -> str:
    """Return the three digits of a heading; north is 360."""
    return speak_digits(f"{round(heading_deg) % 360 or 360:03d}", style)


def speak_speed(speed_kt: float, style: Style) -> str:
    """Return a speed."""
    return f"{speak_digits(str(round(speed_kt)), style)} knots"


def speak_frequency(frequency_khz: int, style: Style) -> str:
    """Return a frequency.

    ICAO says six digits, or four if the last two are zero (Annex 10 volume II, 5.2.1.7.3.4.3); the
    FAA at most two after the point (7110.65, 2-4-17 i), so only channels of 25 kHz.
    """
    mhz, khz = divmod(frequency_khz, 1000)
    fraction = f"{khz:03d}"
    if style == "icao":
        fraction = fraction[0] if fraction.endswith("00") else fraction
        return f"{speak_digits(str(mhz), style)} decimal {speak_digits(fraction, style)}"
    if khz % 25 == 0:
        fraction = fraction[:2].rstrip("0") or "0"
    return f"{speak_digits(str(mhz), style)} point {speak_digits(fraction, style)}"


def speak_wind(wind: Wind, style: Style) -> str:
    """Return a wind."""
    if wind.direction_deg is None and not wind.speed_kt:
        return "wind calm"
    speed = speak_digits(str(round(wind.speed_kt)), style)
    direction = (
        "variable" if wind.direction_deg is None else speak_heading(wind.direction_deg, style)
    )
    gust = speak_digits(str(round(wind.gust_kt)), style) if wind.gust_kt else ""
    if style == "faa":
        return _join(f"wind {direction} at {speed}", f"gusts {gust}" if gust else "")
    degrees = "" if wind.direction_deg is None else " degrees"
    return _join(f"wind {direction}{degrees} {speed} knots", f"gusting {gust}" if gust else "")


def speak_pressure(hpa: float, style: Style) -> str:
    """Return an altimeter setting: inches of mercury for the FAA, hectopascals for ICAO."""
    if style == "faa":
        return f"altimeter {speak_digits(f'{round(hpa / HPA_PER_INHG * 100.0):04d}', style)}"
    return f"Q N H {speak_digits(str(round(hpa)), style)}"


# --- calls ----------------------------------------------------------------------------------


def speak_instruction(
    callsign: str, instructions: Instruction | Sequence[Instruction], style: Style
) -> str:
    """Return a call with instructions for an actor."""
    several = (instructions,) if isinstance(instructions, Instruction) else instructions
    parts = [_phrase_of(each, style, readback=False) for each in several]
    return _sentence(speak_callsign(callsign, style), *parts)


def speak_readback(
    callsign: str, instructions: Instruction | Sequence[Instruction], style: Style
) -> str:
    """Return the readback of instructions, or "roger" if there are none."""
    several = (instructions,) if isinstance(instructions, Instruction) else instructions
    parts = [_phrase_of(each, style, readback=True) for each in several] or ["roger"]
    return _sentence(*parts, speak_callsign(callsign, style))


def speak_say_again(callsign: str, style: Style = "faa") -> str:
    """Return the request to repeat a call."""
    return _sentence("say again", speak_callsign(callsign, style))


def _phrase_of(instruction: Instruction, style: Style, *, readback: bool) -> str:
    words = _FORMS[instruction.action](instruction, style, readback)
    if instruction.condition is None:
        return words
    condition = re.sub(
        r"[0-9]+", lambda found: speak_digits(found[0], style), instruction.condition
    )
    if condition.startswith("until"):
        return f"{words} {condition}"
    return f"{condition}, {words}"


Speak = Callable[[Instruction, Style, bool], str]


def _on_runway(words: str, immediate: str = "") -> Speak:
    """Return a form with the runway before its words, or after them in a readback."""

    def speak(instruction: Instruction, style: Style, readback: bool) -> str:
        runway = _join(_runway(instruction, style), _at(instruction, style))
        text = (immediate if instruction.immediate and immediate else words).strip()
        if readback or not instruction.runway:
            return _join(text, runway)
        return _join(f"{runway},", text)

    return speak


def _then_runway(words: str) -> Speak:
    """Return a form with the runway after its words."""

    def speak(instruction: Instruction, style: Style, readback: bool) -> str:
        del readback
        delay = "without delay" if instruction.immediate else ""
        return _join(words, _runway(instruction, style), _at(instruction, style), delay)

    return speak


def _alone(words: str, icao: str | None = None, readback: str | None = None) -> Speak:
    """Return a form that needs no details."""

    def speak(instruction: Instruction, style: Style, is_readback: bool) -> str:
        text = icao if icao and style == "icao" else words
        return _join(readback if readback and is_readback else text, _runway(instruction, style))

    return speak


def _hold_short(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    point = _runway(instruction, style) or (
        speak_taxiway(instruction.hold_short, style) if instruction.hold_short else ""
    )
    return _join("hold short", f"of {point}" if point else "", _at(instruction, style))


def _taxi(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    to = _runway(instruction, style) or (
        _place(instruction.position, style) if instruction.position else ""
    )
    via = ", ".join(speak_taxiway(each, style) for each in instruction.via)
    return _join("taxi", f"to {to}" if to else "", f"via {via}" if via else "")


def _vacate(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    if instruction.immediate:
        verb = "expedite exiting" if style == "faa" else "expedite vacating"
    else:
        verb = "exit" if style == "faa" else "vacate"
    side = (
        f"to the {instruction.turn}"
        if instruction.turn and instruction.runway
        else instruction.turn or ""
    )
    return _join(verb, _runway(instruction, style), side, _at(instruction, style))


def _altitude(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    level = (
        speak_altitude(instruction.altitude_ft, style)
        if instruction.altitude_ft is not None
        else ""
    )
    if instruction.sense in (None, "maintain"):
        return _join("maintain", level, "immediately" if instruction.immediate else "")
    verb = "climb" if instruction.sense == "climb" else "descend"
    if instruction.immediate:
        verb = "expedite climb" if instruction.sense == "climb" else "expedite descent"
    return _join(verb, ("and maintain" if style == "faa" else "to") if level else "", level)


def _heading(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    if instruction.heading_deg is None:
        if instruction.turn:
            now = "immediately" if instruction.immediate else ""
            return _join(f"turn {instruction.turn}", now, _at(instruction, style))
        verb = "maintain" if instruction.position == "present heading" else "fly"
        return _join(verb, instruction.position or "runway heading")
    heading = f"heading {speak_heading(instruction.heading_deg, style)}"
    now = "immediately" if instruction.immediate else ""
    return (
        _join(f"turn {instruction.turn}", now, heading)
        if instruction.turn
        else _join("fly", heading, now)
    )


def _speed(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    if instruction.speed_kt is None:
        return "resume normal speed"
    return f"maintain {speak_speed(instruction.speed_kt, style)}"


def _squawk(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    return _join("squawk", speak_digits(instruction.squawk or "", style))


def _station(verb: str) -> Speak:
    def speak(instruction: Instruction, style: Style, readback: bool) -> str:
        del readback
        khz = instruction.frequency_khz
        frequency = speak_frequency(khz, style) if khz is not None else ""
        return _join(verb, instruction.position or "", frequency)

    return speak


def _approach(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    kind = _APPROACHES.get(instruction.approach or "", instruction.approach or "")
    runway = _runway(instruction, style)
    if style == "faa":
        return _join("cleared", kind, runway, "approach")
    return _join("cleared", kind, "approach", runway)


def _about(verb: str) -> Speak:
    def speak(instruction: Instruction, style: Style, readback: bool) -> str:
        del readback
        return _join(verb, _place(instruction.position, style) if instruction.position else "")

    return speak


def _wildlife(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    where = f"on {_runway(instruction, style)}" if instruction.runway else "reported"
    return _join("wildlife", where, _at(instruction, style))


def _wildlife_gone(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    runway = _runway(instruction, style) or "the runway"
    return _join("wildlife has left", runway, _at(instruction, style))


_FORMS: dict[Action, Speak] = {
    "cleared_to_land": _on_runway("cleared to land"),
    "cleared_for_takeoff": _on_runway("cleared for takeoff", "cleared for immediate takeoff"),
    "line_up": _on_runway("line up and wait"),
    "touch_and_go": _on_runway("cleared touch and go"),
    "low_approach": _on_runway("cleared low approach"),
    "cleared_option": _on_runway("cleared for the option"),
    "hold_short": _hold_short,
    "hold_position": _alone("hold position"),
    "cross": _then_runway("cross"),
    "proceed": _then_runway("proceed onto"),
    "backtrack": _then_runway("backtrack"),
    "cancel_takeoff": _alone(
        "cancel takeoff clearance", icao="cancel takeoff, I say again, cancel takeoff"
    ),
    "cancel_landing": _alone("cancel landing clearance"),
    "go_around": _alone("go around", readback="going around"),
    "cleared_approach": _approach,
    "continue_approach": _alone("continue approach"),
    "vacate": _vacate,
    "taxi": _taxi,
    "stop": _alone("stop", icao="stop immediately"),
    "push_back": _alone("push back approved"),
    "start_up": _alone("start up approved"),
    "follow": _about("follow"),
    "give_way": _about("give way to"),
    "altitude": _altitude,
    "heading": _heading,
    "speed": _speed,
    "direct": _about("proceed direct"),
    "own_navigation": _alone("resume own navigation"),
    "squawk": _squawk,
    "contact": _station("contact"),
    "monitor": _station("monitor"),
    "stand_by": _alone("stand by"),
    "report": _about("report"),
    "wildlife": _wildlife,
    "wildlife_gone": _wildlife_gone,
}


# --- words ----------------------------------------------------------------------------------


def _spell(signs: str, style: Style) -> str:
    words = [
        LETTERS[ord(sign) - ord("A")] if sign.isalpha() else speak_digits(sign, style)
        for sign in signs.upper()
        if sign.isalnum()
    ]
    return " ".join(words)


def _runway(instruction: Instruction, style: Style) -> str:
    return speak_runway(instruction.runway, style) if instruction.runway else ""


def _at(instruction: Instruction, style: Style) -> str:
    return f"at {_place(instruction.position, style)}" if instruction.position else ""


def _place(place: str, style: Style) -> str:
    """Return a taxiway spelled, or a place in words unchanged."""
    if re.fullmatch(r"[A-Z][0-9]{0,2}", place):
        return _spell(place, style)
    return re.sub(r"[0-9]+", lambda found: speak_digits(found[0], style), place)


def _join(*parts: str) -> str:
    return " ".join(part for part in parts if part)


def _sentence(*parts: str) -> str:
    text = ", ".join(parts)
    return f"{text[:1].upper()}{text[1:]}."
