"""Conditions of instructions: what an actor waits for before it does what it was told."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import cast, get_args

from airhilt.commands import (
    AltitudeCommand,
    CircuitLeg,
    Command,
    CrossCommand,
    DirectCommand,
    EnterCommand,
    GoAroundCommand,
    LandCommand,
    LineUpCommand,
    SpeedCommand,
    TakeOffCommand,
    TrackCommand,
    TurnAtCommand,
    VacateCommand,
)
from airhilt.phraseology.alphabet import LETTER_OF
from airhilt.phraseology.slots import FIX, LEVEL_HERE, level_ft
from airhilt.phraseology.vertical import level_in
from airhilt.scenario.models import (
    AirspeedReached,
    AllOf,
    AltitudeReached,
    Condition,
    FixPassed,
    HeightAbove,
    InPhase,
    OffRunways,
    OnLeg,
    TrackReached,
)

DEPARTED_FT = 400.0
"""Height in ft above which an aircraft turns after a takeoff (FAA AIM 5-2-9 e 1)."""
ENTERS = (CrossCommand, EnterCommand)
"""Commands that bring an actor on to a runway, and off it again."""
THEN = "then"
"""Condition of what follows the action before it in the same call."""
READY = re.compile(
    r"(?:(?:when|whenever|once|as soon as)\s+(?:you(?:'re| are)?\s+)?(?:ready|able)|if able)"
    r"|at (?:pilot|your|own) (?:discretion|convenience)"
)
"""Condition that holds as soon as the instruction has been heard."""
_WHEN = r"(?:(?:when|once|after|on|upon|as soon as)\s+)?(?:you\s+are\s+|you're\s+|you\s+|your\s+)?"
_DEPARTED = re.compile(
    _WHEN + r"(?:airborne|departure|departing|the go|take ?off|off the ground|in the air)"
)
_VACATED = re.compile(
    _WHEN + r"(?:(?:have\s+|had\s+)?(?:vacated?|vacating|clear|cleared|off|exited|exiting|left"
    r"|leaving|landed|landing|down|rollout|on the ground)"
    r"(?:\s+of)?(?:\s+(?:the|this))?(?:\s+(?:active|runway))?(?:\s+runway)?"
    r"(?:\s+[0-9]{1,2}(?:\s+(?:left|right|centre))?)?)"
)
_ESTABLISHED = re.compile(_WHEN + r"(?:fully\s+)?established(?:\s+.*)?")
_MILE_FINAL = re.compile(r"(?:on )?(?:a )?([0-9]{1,2}) miles? final")
_LEG = re.compile(
    r"(?:(?:on|turning|entering|midfield|the|short|long|left|right|hand) )*"
    rf"({'|'.join(get_args(CircuitLeg))})(?: leg)?"
)
_PASSING = re.compile(
    rf"(?:{_WHEN}(?:at|pass(?:ing|ed)|through|leaving|reach(?:ing|ed)|over|crossing|level(?: at)?)"
    r"|after)\s+(?P<what>.+)"
)


def is_departed(condition: str) -> bool:
    """Return whether a condition is that of having taken off."""
    return _DEPARTED.fullmatch(condition) is not None


def is_event(until: str | None) -> bool:
    """Return whether a limit ends by another event than being established on the approach."""
    words = (until or "").removeprefix("until ").removeprefix("till ")
    return bool(words) and _ESTABLISHED.fullmatch(words) is None


def condition_of(words: str, callsign: str, before: Iterable[Command]) -> Condition | None:
    """Return the condition in some words for an actor; None if they name none that is known.

    A name that is no level is taken as a fix. Who is to cross a runway ``before`` vacates that one.
    """
    if is_departed(words):
        return HeightAbove(type="height_above", actor=callsign, height_ft=DEPARTED_FT)
    if _VACATED.fullmatch(words):
        crosses = any(isinstance(each, ENTERS) for each in before)
        return OffRunways(type="off_runways", actor=callsign, has_been_on=crosses)
    if _ESTABLISHED.fullmatch(words):
        return InPhase(type="in_phase", actor=callsign, phases=("glide", "flare", "rollout"))
    passing = _PASSING.fullmatch(words)
    if passing is None:
        return None
    what = passing["what"]
    level = LEVEL_HERE.fullmatch(what)
    altitude_ft = level_in(what, is_here=True)[0] if level is None else level_ft(level)
    if altitude_ft is not None:
        return AltitudeReached(type="altitude_reached", actor=callsign, altitude_ft=altitude_ft)
    if re.fullmatch(FIX, what):
        return FixPassed(type="fix_passed", actor=callsign, fix=fix_named(what))
    return None


def reported(words: str, callsign: str) -> Condition | None:
    """Return when an actor reports what a unit wants to hear of; None if it never sees that."""
    final = _MILE_FINAL.fullmatch(words)
    if final is not None:
        miles = float(final[1])
        return OnLeg(type="on_leg", actor=callsign, leg="final", within_nm=miles)
    leg = _LEG.fullmatch(words)
    if leg is not None:
        return OnLeg(type="on_leg", actor=callsign, leg=cast("CircuitLeg", leg[1]))
    if words.startswith("ready"):
        standing = ("standing", "lined_up")
        return InPhase(type="in_phase", actor=callsign, phases=standing)
    if words.startswith("lined up"):
        return InPhase(type="in_phase", actor=callsign, phases=("lined_up",))
    return condition_of(words, callsign, (CrossCommand(action="cross"),))


def fix_named(words: str) -> str:
    """Return the name of a fix, of which the letters may be spelled."""
    spelled = [LETTER_OF.get(word, "") for word in words.split()]
    return "".join(spelled) if len(spelled) > 1 and all(spelled) else words


def done(command: Command, callsign: str) -> Condition | None:
    """Return the condition that an actor has done what it was told before; None: it has no end."""
    match command:
        case AltitudeCommand(altitude_ft=altitude_ft):
            return AltitudeReached(type="altitude_reached", actor=callsign, altitude_ft=altitude_ft)
        case SpeedCommand(cas_kt=cas_kt):
            return AirspeedReached(type="airspeed_reached", actor=callsign, cas_kt=cas_kt)
        case TrackCommand(track_deg=track_deg):
            return TrackReached(type="track_reached", actor=callsign, track_deg=track_deg)
        case DirectCommand(to=fix):
            return FixPassed(type="fix_passed", actor=callsign, fix=fix)
        case TakeOffCommand():
            return HeightAbove(type="height_above", actor=callsign, height_ft=DEPARTED_FT)
        case LineUpCommand():
            return InPhase(type="in_phase", actor=callsign, phases=("lined_up",))
        case GoAroundCommand():
            return HeightAbove(type="height_above", actor=callsign, height_ft=DEPARTED_FT)
        case LandCommand(then=then) if then != "full_stop":
            again = InPhase(type="in_phase", actor=callsign, phases=("climb_out", "go_around"))
            high = HeightAbove(type="height_above", actor=callsign, height_ft=DEPARTED_FT)
            return AllOf(type="all_of", conditions=(again, high))
        case VacateCommand() | TurnAtCommand() | LandCommand():
            return OffRunways(type="off_runways", actor=callsign)
        case CrossCommand():
            return OffRunways(type="off_runways", actor=callsign, has_been_on=True)
    return None
