"""The words of instructions."""

from __future__ import annotations

import re
from collections.abc import Callable

from airhilt.phraseology.call import Action, Instruction
from airhilt.phraseology.numbers import Style, speak_digits, speak_thousands
from airhilt.phraseology.spoken_values import (
    join,
    speak_altitude,
    speak_frequency,
    speak_heading,
    speak_mach,
    speak_runway,
    speak_speed,
    speak_taxiway,
    spell,
)

_APPROACHES = {
    "ils": "i l s", "rnav": "r nav", "rnp": "r n p", "vor": "v o r", "gps": "g p s",
    "ndb": "n d b", "lda": "l d a", "sdf": "s d f", "gls": "g l s", "par": "p a r",
    "sra": "s r a",
}  # fmt: skip


def phrase_of(instruction: Instruction, style: Style, *, readback: bool) -> str:
    """Return the words of one instruction, with its condition and its limit."""
    words = _FORMS[instruction.action](instruction, style, readback)
    if instruction.until is not None:
        words = f"{words} {_with_digits(instruction.until, style)}"
    if instruction.condition is None:
        return words
    return f"{_with_digits(instruction.condition, style)}, {words}"


def _with_digits(words: str, style: Style) -> str:
    return re.sub(r"[0-9]+", lambda found: speak_digits(found[0], style), words)


Speak = Callable[[Instruction, Style, bool], str]


def _on_runway(words: str, immediate: str = "") -> Speak:
    """Return a form with the runway before its words, or after them in a readback."""

    def speak(instruction: Instruction, style: Style, readback: bool) -> str:
        runway = join(_runway(instruction, style), _at(instruction, style))
        text = (immediate if instruction.immediate and immediate else words).strip()
        if readback or not instruction.runway:
            return join(text, runway)
        return join(f"{runway},", text)

    return speak


def _then_runway(words: str) -> Speak:
    """Return a form with the runway after its words."""

    def speak(instruction: Instruction, style: Style, readback: bool) -> str:
        del readback
        delay = "without delay" if instruction.immediate else ""
        return join(words, _runway(instruction, style), _at(instruction, style), delay)

    return speak


def _alone(words: str, icao: str | None = None, readback: str | None = None) -> Speak:
    """Return a form that needs no details."""

    def speak(instruction: Instruction, style: Style, is_readback: bool) -> str:
        text = icao if icao and style == "icao" else words
        return join(readback if readback and is_readback else text, _runway(instruction, style))

    return speak


def _hold_short(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    point = _runway(instruction, style) or (
        speak_taxiway(instruction.hold_short, style) if instruction.hold_short else ""
    )
    return join("hold short", f"of {point}" if point else "", _at(instruction, style))


def _taxi(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    to = _runway(instruction, style) or (
        _place(instruction.position, style) if instruction.position else ""
    )
    via = ", ".join(speak_taxiway(each, style) for each in instruction.via)
    return join("taxi", f"to {to}" if to else "", f"via {via}" if via else "")


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
    return join(verb, _runway(instruction, style), side, _at(instruction, style))


def _altitude(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    level = (
        speak_altitude(instruction.altitude_ft, style)
        if instruction.altitude_ft is not None
        else ""
    )
    if instruction.bound:
        level = f"{_at_or(instruction)} {level}"
    if instruction.sense in (None, "maintain"):
        return join("maintain", level, "immediately" if instruction.immediate else "")
    verb = "climb" if instruction.sense == "climb" else "descend"
    if instruction.immediate:
        verb = "expedite climb" if instruction.sense == "climb" else "expedite descent"
    return join(verb, ("and maintain" if style == "faa" else "to") if level else "", level)


def _heading(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    if instruction.heading_deg is None:
        if instruction.turn:
            now = "immediately" if instruction.immediate else ""
            return join(f"turn {instruction.turn}", now, _at(instruction, style))
        verb = "maintain" if instruction.position == "present heading" else "fly"
        return join(verb, instruction.position or "runway heading")
    heading = f"heading {speak_heading(instruction.heading_deg, style)}"
    now = "immediately" if instruction.immediate else ""
    return (
        join(f"turn {instruction.turn}", now, heading)
        if instruction.turn
        else join("fly", heading, now)
    )


def _at_or(instruction: Instruction) -> str:
    side = {"or_more": "at or above", "or_less": "at or below", None: "at"}
    return side[instruction.bound]


def _or_greater(instruction: Instruction) -> str:
    side = {"or_more": "or greater", "or_less": "or less", None: ""}
    return side[instruction.bound]


def _speed(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    if instruction.speed_kt is None:
        return join("reduce to", instruction.named or "minimum", "speed")
    return join("maintain", speak_speed(instruction.speed_kt, style), _or_greater(instruction))


def _mach(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    return join("maintain", speak_mach(instruction.mach or 0.0, style), _or_greater(instruction))


def _resume_speed(instruction: Instruction, style: Style, readback: bool) -> str:
    del style, readback
    return join("resume", instruction.named or "normal", "speed")


def _turn_by(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    degrees = speak_digits(f"{round(instruction.turn_deg or 0.0)}", style)
    return join("turn", degrees, "degrees", instruction.turn or "")


def _cross_fix(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    level_ft, speed_kt = instruction.altitude_ft, instruction.speed_kt
    level = join(_at_or(instruction), speak_altitude(level_ft, style)) if level_ft else ""
    speed = join("at", speak_speed(speed_kt, style)) if speed_kt else ""
    return join("cross", _place(instruction.position or "", style), level, speed)


def _via_procedure(verb: str, procedure: str) -> Speak:
    def speak(instruction: Instruction, style: Style, readback: bool) -> str:
        del readback
        name = instruction.position
        return f"{verb} via the {_place(name, style)} {procedure}" if name else f"{verb} via"

    return speak


def _rate(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    rate = speak_thousands(round(instruction.rate_fpm or 0.0), style)
    return join("at", rate, "feet per minute", _or_greater(instruction))


def _hold_at(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    turns = f"{instruction.turn} turns" if instruction.turn else ""
    return join("hold at", _place(instruction.position or "", style), turns)


def _circle(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    return join("circle to", _runway(instruction, style))


def _side_step(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    return join("side step", f"to {_runway(instruction, style)}" if instruction.runway else "")


def _orbit(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    if style == "icao":
        return join("orbit", instruction.turn or "")
    return join("make", "" if instruction.turn else "a", instruction.turn or "", "three sixty")


def _extend(instruction: Instruction, style: Style, readback: bool) -> str:
    del style, readback
    return join("extend", instruction.position or "downwind")


def _join_leg(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    verb = "enter" if style == "faa" else "join"
    leg = instruction.position or "downwind"
    if leg == "straight in":
        verb = "make" if style == "faa" else "join"
    return join(verb, instruction.turn or "", leg, _runway(instruction, style))


def _direct(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    turn = f"turn {instruction.turn}" if instruction.turn else ""
    return join(turn, "proceed direct", _place(instruction.position or "", style))


def _squawk(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    return join("squawk", speak_digits(instruction.squawk or "", style))


def _station(verb: str) -> Speak:
    def speak(instruction: Instruction, style: Style, readback: bool) -> str:
        del readback
        khz = instruction.frequency_khz
        frequency = speak_frequency(khz, style) if khz is not None else ""
        return join(verb, instruction.position or "", frequency)

    return speak


def _approach(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    kind = _APPROACHES.get(instruction.approach or "", instruction.approach or "")
    kind = join(kind, spell(instruction.variant or "", style))
    runway = _runway(instruction, style)
    if style == "faa":
        return join("cleared", kind, runway, "approach")
    return join("cleared", kind, "approach", runway)


def _about(verb: str) -> Speak:
    def speak(instruction: Instruction, style: Style, readback: bool) -> str:
        del readback
        return join(verb, _place(instruction.position, style) if instruction.position else "")

    return speak


def _wildlife(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    where = f"on {_runway(instruction, style)}" if instruction.runway else "reported"
    return join("wildlife", where, _at(instruction, style))


def _wildlife_gone(instruction: Instruction, style: Style, readback: bool) -> str:
    del readback
    runway = _runway(instruction, style) or "the runway"
    return join("wildlife has left", runway, _at(instruction, style))


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
    "direct": _direct,
    "stop_and_go": _on_runway("cleared stop and go"),
    "circle": _circle,
    "cancel_approach": _alone("cancel approach clearance"),
    "missed_approach": _alone("execute missed approach"),
    "cross_fix": _cross_fix,
    "climb_via": _via_procedure("climb", "departure"),
    "descend_via": _via_procedure("descend", "arrival"),
    "vertical_rate": _rate,
    "turn_by": _turn_by,
    "hold_at": _hold_at,
    "mach": _mach,
    "resume_speed": _resume_speed,
    "no_speed_restrictions": _alone("no speed restrictions"),
    "ident": _alone("squawk ident"),
    "visual_separation": _alone("maintain visual separation"),
    "own_navigation": _alone("resume own navigation"),
    "squawk": _squawk,
    "contact": _station("contact"),
    "monitor": _station("monitor"),
    "stand_by": _alone("stand by"),
    "report": _about("report"),
    "orbit": _orbit,
    "extend": _extend,
    "short_approach": _alone("make short approach"),
    "join": _join_leg,
    "side_step": _side_step,
    "return_to_field": _alone("return to the field"),
    "expedite": _alone("expedite"),
    "say": _about("say"),
    "wildlife": _wildlife,
    "wildlife_gone": _wildlife_gone,
}


def _runway(instruction: Instruction, style: Style) -> str:
    return speak_runway(instruction.runway, style) if instruction.runway else ""


def _at(instruction: Instruction, style: Style) -> str:
    return f"at {_place(instruction.position, style)}" if instruction.position else ""


def _place(place: str, style: Style) -> str:
    """Return a taxiway spelled, or a place in words unchanged."""
    if re.fullmatch(r"[A-Z][0-9]{0,2}", place):
        return spell(place, style)
    return _with_digits(place, style)
