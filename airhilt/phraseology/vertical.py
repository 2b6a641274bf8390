"""Forms of levels (FAA Order JO 7110.65, 4-5-7; ICAO Doc 4444, 12.3.1.2)."""

from __future__ import annotations

import re

from airhilt.phraseology.call import Action, Bound, Instruction, Sense
from airhilt.phraseology.forms import (
    BARE_VALUE,
    NO_VALUE,
    Listed,
    Read,
    Segment,
    fix_of,
    is_immediate,
    nothing,
)
from airhilt.phraseology.slots import (
    BARE_FEET,
    FIX,
    HIGHEST_LEVEL,
    LEVEL,
    LEVEL_HERE,
    LEVEL_WORDS,
    NO_SENSE,
    SHORTENED,
    SIDED_RUNWAY,
    feet_confidence,
    level_confidence,
    level_ft,
    speed_confidence,
)

_SENSES: dict[str, Sense] = {
    "climb": "climb", "up": "climb", "desce": "descend", "down": "descend", "maint": "maintain"
}  # fmt: skip
_SPOKEN_BOUNDS: dict[str, Bound] = {
    "above": "or_more", "greater": "or_more", "more": "or_more", "better": "or_more",
    "faster": "or_more", "below": "or_less", "less": "or_less", "slower": "or_less",
}  # fmt: skip
_BOUND_AFTER = re.compile(r"( or)? (above|below|greater|less|more|better|faster|slower)(?!\S)")
MOST_THOUSANDS = 45
"""Most thousands of feet that are said without the word."""
TENS_FROM = 20
"""Number from which on tens may be thousands of feet or a flight level."""
_BARE_LEVEL = re.compile(
    r"(?: (?:to|at|and|maintain|now))* ([1-9][0-9]{0,2})(?!\S)"
    r"(?! (?:left|right|knots|degrees|miles?|decimal|thousand|hundred|feet|or|minutes?|oclock|per))"
)
"""A level without its unit."""
_KNOTS = re.compile(r" knots(?!\S)")


def bound_of(word: str | None) -> Bound | None:
    """Return the side that words such as "or greater" leave free."""
    return _SPOKEN_BOUNDS.get(word or "")


def bound_after(text: str, end: int) -> tuple[Bound | None, int, float]:
    """Return the bound that is said right here, its end, and the confidence in it.

    It is low if "or" is missing: then another word may be missing too.
    """
    found = _BOUND_AFTER.match(text, end)
    if found is None:
        return None, end, 1.0
    return bound_of(found[2]), found.end(), 1.0 if found[1] else NO_VALUE


def level_in(text: str, *, is_here: bool = False) -> tuple[float | None, float, int]:
    """Return a level in a text, the confidence in it, and its end.

    Parameters
    ----------
    is_here
        True if the level is to be right at the beginning.
    """
    level = LEVEL_HERE.match(text) if is_here else LEVEL.search(text)
    bare = BARE_FEET.match(text)
    if level:
        feet = level_ft(level)
        return feet, level_confidence(level) if feet is not None else NO_VALUE, level.end()
    if bare:
        feet = float(bare[1])
        is_speed = _KNOTS.match(text, bare.end())
        return feet, NO_SENSE if is_speed else feet_confidence(feet), bare.end()
    return None, NO_VALUE, 0


def bare_level(text: str) -> tuple[float | None, float, int]:
    """Return a level without its unit: "up to fourteen", "down to eight zero".

    Three digits are a flight level; fewer are thousands of feet up to 45, and above a level.
    """
    found = _BARE_LEVEL.match(text)
    if found is None:
        return None, NO_VALUE, 0
    number = int(found[1])
    if number <= MOST_THOUSANDS:
        feet, has_sense = number * 1000.0, number < TENS_FROM or number % 10 != 0
    else:
        feet, has_sense = number * 100.0, number <= HIGHEST_LEVEL and number % 5 == 0
    return feet, SHORTENED if has_sense else NO_SENSE, found.end()


def altitude(segment: Segment, action: Action) -> Read | None:
    """Read a level, with its sense and its bound."""
    words = segment.found[0].split()
    head = next((word[:5] for word in words if word[:5] in _SENSES), "maint")
    sense: Sense | None = _SENSES[head]
    if words[0] in ("stop", "stopping", "level"):
        sense = "maintain"
    elif words[0].startswith("expedit") and head == "maint":
        sense = None
    bound = bound_of(segment.found.groupdict().get("bound"))
    feet, confidence, taken = level_in(segment.after, is_here=bound is not None)
    if feet is None and (sense != "maintain" or words[0] != "maintain"):
        feet, confidence, taken = bare_level(segment.after)
    if feet is None and sense in ("maintain", None):
        return None
    end = segment.found.end() + taken
    if bound is None and taken:
        bound, end, sure = bound_after(segment.text[: segment.limit], end)
        confidence = min(confidence, sure)
    read = Instruction(
        action,
        sense=sense,
        altitude_ft=feet,
        bound=bound,
        immediate=is_immediate(segment, end),
        confidence=confidence,
    )
    return Read(read, segment.start, end)


def cross_fix(segment: Segment, action: Action) -> Read | None:
    """Read a restriction at a fix: its level, its speed, or both."""
    found = segment.found
    fix, confidence = fix_of(segment)
    bound = bound_of(found["bound"])
    feet, sure, taken = level_in(segment.after, is_here=True)
    end = found.end() + taken
    if feet is not None and bound is None:
        bound, end, or_sure = bound_after(segment.text[: segment.limit], end)
        confidence = min(confidence, or_sure)
    speed = _CROSSING_SPEED.match(segment.text, end, segment.limit)
    if feet is None and speed is None:
        speed = _CROSSING_SPEED_HERE.match(segment.text, end, segment.limit)
    if feet is None and speed is None:
        return None
    if speed is None and _MORE_NUMBERS.match(segment.text, end, segment.limit):
        confidence = NO_VALUE
    confidence = min(confidence, sure) if feet is not None else confidence
    speed_kt = float(speed[1]) if speed else None
    if speed_kt is not None:
        confidence = min(confidence, speed_confidence(speed_kt))
    read = Instruction(
        action, position=fix, altitude_ft=feet, bound=bound, speed_kt=speed_kt,
        confidence=confidence,
    )  # fmt: skip
    kept = Instruction(
        "altitude", sense="maintain", altitude_ft=feet, condition=f"at {fix}", confidence=confidence
    )
    end = speed.end() if speed else end
    return Read(read, segment.start, end, (kept,) if found["kept"] and feet is not None else ())


_MORE_NUMBERS = re.compile(r" (?:and )?at [0-9]")
_CROSSING_SPEED = re.compile(
    r" (?:(?:and )?at |and |(?=[0-9]{3} knots))([1-3][0-9]{2})"
    r"(?! (?:feet|thousand))(?: knots)?(?!\S)"
)
_CROSSING_SPEED_HERE = re.compile(r" ([1-3][0-9]{2})(?! (?:feet|thousand))(?: knots)?(?!\S)")


def level_by_fix(segment: Segment, action: Action) -> Read | None:
    """Read a level that is to be reached by a fix (ICAO Doc 4444, 12.3.1.2)."""
    found = segment.found
    fix, confidence = fix_of(segment)
    said = found.groupdict().get("level") or segment.text[: segment.start]
    level = next(reversed(list(LEVEL.finditer(said))), None)
    feet = level and level_ft(level)
    if level is None or feet is None:
        return None
    sure = min(confidence, level_confidence(level))
    read = Instruction(action, position=fix, altitude_ft=feet, confidence=sure)
    sense = _SENSES.get(found[0][:5])
    if sense is None:
        return Read(read, segment.start, found.end())
    level_read = Instruction("altitude", sense=sense, altitude_ft=feet, confidence=sure)
    return Read(level_read, segment.start, found.end(), (read,))


def via_procedure(segment: Segment, action: Action) -> Read | None:
    """Read a climb or a descent along the restrictions of a procedure."""
    name = segment.found["name"]
    feet, sure, taken = level_in(segment.after, is_here=True)
    more: tuple[Instruction, ...] = ()
    sense: Sense = "climb" if action == "climb_via" else "descend"
    if re.match(r" to(?!\S)", segment.after) and feet is not None:
        more = (Instruction("altitude", sense=sense, altitude_ft=feet, confidence=sure),)
    else:
        taken = 0
    read = Instruction(action, position=name, confidence=1.0 if name or more else BARE_VALUE)
    return Read(read, segment.start, segment.found.end() + taken, more)


def rate(segment: Segment, action: Action) -> Read | None:
    """Read a vertical rate."""
    found = segment.found
    thousands, hundreds, plain = found["thousands"], found["hundreds"], found["plain"]
    fpm = float(plain) if plain else float(thousands) * 1000.0 + float(hundreds or 0)
    bound, end, or_sure = bound_after(segment.text[: segment.limit], found.end())
    sure = or_sure if fpm % 100.0 == 0.0 and 0.0 < fpm <= 8000.0 else NO_SENSE
    return Read(Instruction(action, rate_fpm=fpm, bound=bound, confidence=sure), segment.start, end)


_OR = r"(?: at or (?P<bound>above|below))?"
_RATE = r"(?:(?P<thousands>[0-9]) thousand(?: (?P<hundreds>[1-9]00))?|(?P<plain>[1-9][0-9]{2,3}))"
_PROCEDURE = r"(?: (?:the )?(?!to |sid|star|the |glide)(?P<name>[a-z]+(?: [a-z]+)?(?: [0-9])?))??"

CROSSINGS: Listed = (
    ("cross crossing", "cross_fix",
     rf"cross(?:ing)? (?!{SIDED_RUNWAY})"
     rf"(?P<fix>(?:[0-9]{{1,3}} miles? (?:[a-z]+ )?(?:of|from|before) )?{FIX})"
     r"(?: at(?: or (?P<bound>above|below)| (?P<kept>and maintain))?|(?= flight level))",
     cross_fix),
    ("climb climbing descend descending", "cross_fix",
     r"(?:climb|descend)(?:ing)? to (?:be level|reach|be at)(?: at)?"
     rf" (?P<level>{LEVEL_WORDS}) by (?P<fix>{FIX})", level_by_fix),
    ("level", "cross_fix", rf"level by (?P<fix>{FIX})", level_by_fix),
)  # fmt: skip
"""Forms of crossing restrictions, which come before those of crossing a runway."""
FORMS: Listed = (
    ("stop stopping", "altitude",
     r"stop(?:ping)? (?:(?:your|the|my) )?(?:climb|descent|descend)(?: at| and maintain)?",
     altitude),
    ("stopping", "altitude", r"stopping(?: at)?(?= (?:flight|level|[0-9]))", altitude),
    ("climb climbing", "climb_via",
     rf"climb(?:ing)? via(?: the)?{_PROCEDURE}(?: (?:sid|departure)|(?= except| squawk| \||$))",
     via_procedure),
    ("descend descending", "descend_via",
     rf"descend(?:ing)? via(?: the)?{_PROCEDURE}(?: (?:star|arrival)|(?= except| \||$))",
     via_procedure),
    ("climb climbing descend descending maintain", "altitude",
     r"(?:climb|descend|maintain)(?:ing)?(?: to)?(?: (?:and )?maintain(?:ing)?)?(?: a)? block",
     nothing),
    ("climb climbing climbed descend descending descended descent", "altitude",
     r"(?:climb(?:ing|ed)?|descend(?:ing|ed)?|descent(?= and maintain| to))(?! rate)(?! via)"
     r"(?: to)?(?: and maintain(?:ing)?| maintain)?"
     rf"{_OR}",
     altitude),
    ("amend", "altitude", r"amend (?:your )?altitude(?: to)?(?= [0-9]| flight)", altitude),
    ("expedite expediting", "altitude", r"expedit(?:e|ing) to(?= flight| level| [0-9])", altitude),
    ("up down", "altitude", r"(?:up|down) to(?= [0-9]| flight| level)", altitude),
    ("expedite expediting", "altitude",
     r"expedit(?:e|ing) (?:your |the )?(?:climb|descent|descend)(?: through| to| and maintain)?"
     rf"{_OR}",
     altitude),
    ("except", "altitude", r"except maintain", altitude),
    ("maintain maintaining remain", "altitude",
     r"(?:maintain(?:ing)?|remain)(?: v f r| vfr)? at or (?P<bound>above|below)", altitude),
    ("maintain maintaining", "altitude", r"maintain(?:ing)?(?: at| altitude)?", altitude),
    ("level", "altitude", r"level off(?: at)?", altitude),
    ("at", "vertical_rate", rf"at {_RATE}(?: feet)? (?:per minute|a minute|min)", rate),
    ("rate", "vertical_rate",
     rf"rate(?: of (?:climb|descent))?(?: at)? {_RATE}(?: feet)?(?: (?:per minute|a minute|min))?",
     rate),
)  # fmt: skip
"""Forms of levels."""
