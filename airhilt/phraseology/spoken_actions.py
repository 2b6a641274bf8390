"""The words of instructions."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

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
    spell,
)

_APPROACHES = {
    "ils": "i l s", "rnav": "r nav", "rnp": "r n p", "vor": "v o r", "gps": "g p s",
    "ndb": "n d b", "lda": "l d a", "sdf": "s d f", "gls": "g l s", "par": "p a r",
    "sra": "s r a",
}  # fmt: skip
_LANDMARKS = frozenset({"visual", "contact"})
"""Approaches without an instrument, whose runway is said last (7110.65, 7-4-3 and 4-8-1)."""


def phrase_of(instruction: Instruction, style: Style, *, readback: bool) -> str:
    """Return the words of one instruction, with its condition and its limit."""
    words = _FORMS[instruction.action](_Slots(instruction, style, readback))
    if instruction.until is not None:
        words = f"{words} {with_digits(instruction.until, style)}"
    if instruction.condition is None:
        return words
    comma = "" if instruction.condition == "then" else ","
    return f"{with_digits(instruction.condition, style)}{comma} {words}"


def with_digits(words: str, style: Style) -> str:
    """Return words whose numbers are said digit by digit."""
    return re.sub(r"[0-9]+", lambda found: speak_digits(found[0], style), words)


def speak_place(name: str, style: Style) -> str:
    """Return the name of a place, with its designator spelled: gate bravo one two."""
    spelled = re.sub(r"(?<!\S)[0-9]*[A-Z][0-9]*(?!\S)", lambda found: spell(found[0], style), name)
    return with_digits(spelled, style)


@dataclass(frozen=True, slots=True)
class _Slots:
    """The slots of an instruction in words; a slot without a value has none."""

    told: Instruction
    style: Style
    readback: bool

    @property
    def turn(self) -> str:
        return self.told.turn or ""

    @property
    def runway(self) -> str:
        return speak_runway(self.told.runway, self.style) if self.told.runway else ""

    @property
    def place(self) -> str:
        """Its position: a taxiway spelled, or a place in words."""
        return speak_place(self.told.position or "", self.style)

    @property
    def at(self) -> str:
        return f"at {self.place}" if self.told.position else ""

    @property
    def level(self) -> str:
        feet = self.told.altitude_ft
        return speak_altitude(feet, self.style) if feet is not None else ""

    @property
    def speed(self) -> str:
        speed_kt = self.told.speed_kt
        return speak_speed(speed_kt, self.style) if speed_kt is not None else ""

    @property
    def at_or(self) -> str:
        """Its bound before a level."""
        return {"or_more": "at or above", "or_less": "at or below"}.get(self.told.bound or "", "")

    @property
    def or_greater(self) -> str:
        """Its bound behind a value."""
        return {"or_more": "or greater", "or_less": "or less"}.get(self.told.bound or "", "")

    def now(self, words: str = "immediately") -> str:
        return words if self.told.immediate else ""

    def of(self, faa: str, icao: str) -> str:
        return faa if self.style == "faa" else icao


Speak = Callable[[_Slots], str]


def _on_runway(words: str, immediate: str = "") -> Speak:
    """Return a form with the runway before its words, or after them in a readback."""

    def speak(of: _Slots) -> str:
        runway = join(of.runway, of.at)
        text = of.now(immediate) or words
        is_behind = of.readback or not of.told.runway
        return join(text, runway) if is_behind else join(f"{runway},", text)

    return speak


def _then_runway(words: str) -> Speak:
    """Return a form with the runway after its words."""
    return lambda of: join(words, of.runway, of.at, of.now("without delay"))


def _alone(words: str, icao: str | None = None, readback: str | None = None) -> Speak:
    """Return a form that needs no details."""

    def speak(of: _Slots) -> str:
        text = of.of(words, icao or words)
        return join(readback if readback and of.readback else text, of.runway)

    return speak


def _about(verb: str) -> Speak:
    return lambda of: join(verb, of.place)


def _station(verb: str) -> Speak:
    def speak(of: _Slots) -> str:
        khz = of.told.frequency_khz
        frequency = speak_frequency(khz, of.style) if khz is not None else ""
        return join(verb, of.told.position or "", frequency)

    return speak


def _via_procedure(verb: str, procedure: str) -> Speak:
    return lambda of: f"{verb} via the {of.place} {procedure}" if of.place else f"{verb} via"


def _hold_short(of: _Slots) -> str:
    point = of.runway or spell(of.told.hold_short or "", of.style)
    return join("hold short", f"of {point}" if point else "", of.at)


def _taxi(of: _Slots) -> str:
    to = of.runway or of.place
    via = ", ".join(spell(each, of.style) for each in of.told.via)
    if not to and not via:
        return "continue"
    at = of.at if of.runway else ""
    return join("taxi", f"to {to}" if to else "", at, f"via {via}" if via else "")


def _vacate(of: _Slots) -> str:
    verb = of.of("exit", "vacate")
    if of.told.immediate:
        verb = of.of("expedite exiting", "expedite vacating")
    side = f"to the {of.turn}" if of.turn and of.runway else of.turn
    return join(verb, of.runway, side, of.at)


def _altitude(of: _Slots) -> str:
    sense = of.told.sense
    level = join(of.at_or, of.level)
    if sense in (None, "maintain"):
        is_limit = sense is None and of.told.bound is not None
        return join("" if is_limit else "maintain", level, of.now())
    verb = "climb" if sense == "climb" else "descend"
    if of.told.immediate:
        verb = "expedite climb" if sense == "climb" else "expedite descent"
    return join(verb, of.of("and maintain", "to") if level else "", level)


def _heading(of: _Slots) -> str:
    told, turn = of.told, f"turn {of.turn}" if of.turn else ""
    if told.heading_deg is not None:
        heading = f"heading {speak_heading(told.heading_deg, of.style)}"
        return join(turn, of.now(), heading) if turn else join("fly", heading, of.now())
    if turn:
        return join(turn, of.now(), of.at)
    verb = "maintain" if told.position == "present heading" else "fly"
    return join(verb, told.position or "runway heading")


def _speed(of: _Slots) -> str:
    if of.told.speed_kt is None:
        return join("reduce to", of.told.named or "minimum", "speed")
    return join("maintain", of.speed, of.or_greater)


def _cross_fix(of: _Slots) -> str:
    level = join(of.at_or or "at", of.level) if of.level else ""
    return join("cross", of.place, level, f"at {of.speed}" if of.speed else "")


def _rate(of: _Slots) -> str:
    rate = speak_thousands(round(of.told.rate_fpm or 0.0), of.style)
    return join(of.told.sense or "", "at", rate, "feet per minute", of.or_greater)


def _turn_by(of: _Slots) -> str:
    degrees = speak_digits(f"{round(of.told.turn_deg or 0.0)}", of.style)
    return join("turn", degrees, "degrees", of.turn)


def _approach(of: _Slots) -> str:
    name = of.told.approach or ""
    kind = join(_APPROACHES.get(name, name), spell(of.told.variant or "", of.style))
    if name in _LANDMARKS or of.style == "icao":
        return join("cleared", kind, "approach", of.runway)
    return join("cleared", kind, of.runway, "approach")


def _orbit(of: _Slots) -> str:
    return of.of(join("make", of.turn or "a", "three sixty"), join("orbit", of.turn))


def _join_leg(of: _Slots) -> str:
    leg = of.told.position or "downwind"
    verb = of.of("make" if leg == "straight in" else "enter", "join")
    if of.told.immediate:
        verb = "turn"
    return join(verb, of.turn, leg, of.runway)


_FORMS: dict[Action, Speak] = {
    "cleared_to_land": _on_runway("cleared to land"),
    "cleared_for_takeoff": _on_runway("cleared for takeoff", "cleared for immediate takeoff"),
    "line_up": _on_runway("line up and wait"),
    "touch_and_go": _on_runway("cleared touch and go"),
    "stop_and_go": _on_runway("cleared stop and go"),
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
    "cancel_approach": _alone("cancel approach clearance"),
    "go_around": _alone("go around", readback="going around"),
    "missed_approach": _alone("execute missed approach"),
    "cleared_approach": _approach,
    "continue_approach": _alone("continue approach"),
    "circle": lambda of: join("circle to", of.runway),
    "side_step": lambda of: join("side step", f"to {of.runway}" if of.runway else ""),
    "vacate": _vacate,
    "taxi": _taxi,
    "stop": lambda of: of.of(join("stop", of.now()), "stop immediately"),
    "push_back": _alone("push back approved"),
    "start_up": _alone("start up approved"),
    "follow": _about("follow"),
    "give_way": _about("give way to"),
    "altitude": _altitude,
    "vertical_rate": _rate,
    "climb_via": _via_procedure("climb", "departure"),
    "descend_via": _via_procedure("descend", "arrival"),
    "cross_fix": _cross_fix,
    "heading": _heading,
    "turn_by": _turn_by,
    "direct": lambda of: join(f"turn {of.turn}" if of.turn else "", "proceed direct", of.place),
    "hold_at": lambda of: join("hold at", of.place, f"{of.turn} turns" if of.turn else ""),
    "own_navigation": _alone("resume own navigation"),
    "orbit": _orbit,
    "extend": lambda of: join("extend", of.told.position or "downwind"),
    "short_approach": _alone("make short approach"),
    "join": _join_leg,
    "return_to_field": _alone("return to the field"),
    "speed": _speed,
    "mach": lambda of: join("maintain", speak_mach(of.told.mach or 0.0, of.style), of.or_greater),
    "resume_speed": lambda of: join("resume", of.told.named or "normal", "speed"),
    "no_speed_restrictions": _alone("no speed restrictions"),
    "expedite": _alone("expedite"),
    "squawk": lambda of: join("squawk", speak_digits(of.told.squawk or "", of.style)),
    "ident": _alone("squawk ident"),
    "visual_separation": _alone("maintain visual separation"),
    "contact": _station("contact"),
    "monitor": _station("monitor"),
    "stand_by": _alone("stand by"),
    "report": _about("report"),
    "say": _about("say"),
    "wildlife": lambda of: join("wildlife", f"on {of.runway}" if of.runway else "reported", of.at),
    "wildlife_gone": lambda of: join("wildlife has left", of.runway or "the runway", of.at),
}
