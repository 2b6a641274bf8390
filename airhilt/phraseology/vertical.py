"""Forms of levels (FAA Order JO 7110.65, 4-5-7; ICAO Doc 4444, 12.3.1.2)."""

from __future__ import annotations

import re
from typing import cast

from airhilt.phraseology.call import Action, Bound, Instruction, Sense
from airhilt.phraseology.forms import (
    BARE_VALUE,
    IMMEDIATE,
    NO_VALUE,
    Listed,
    Read,
    Segment,
    alone,
    fix_of,
    is_immediate,
    nothing,
)
from airhilt.phraseology.slots import (
    BARE_FEET,
    FIX,
    FIX_ENDS,
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
    "faster": "or_more", "least": "or_more", "most": "or_less", "below": "or_less",
    "less": "or_less", "slower": "or_less",
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
_HUNDREDS = re.compile(r" ([5-9]00)(?!\S)(?! (?:feet|thousand|knots|miles?|degrees|decimal))")
_SHORT_UNTIL = re.compile(r" (?:[2-9]|1[0-9]) #")
"""Thousands of feet without the word, to be kept until something."""
_DIGITS = re.compile(r"(?<!\S)[0-9]")
"""A number before a level, which may be its first part."""
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
    if level:
        feet = level_ft(level)
        sure = level_confidence(level) if feet is not None else NO_VALUE
        is_cut = _DIGITS.search(text, 0, level.start()) is not None
        return feet, min(sure, NO_SENSE) if is_cut else sure, level.end()
    bare = BARE_FEET.match(text)
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


def _hundreds(text: str) -> tuple[float | None, float, int]:
    """Return a bound in hundreds of feet without the unit: "not above five hundred".

    Few aircraft ever fly at flight level 500 or above.
    """
    found = _HUNDREDS.match(text)
    return (float(found[1]), SHORTENED, found.end()) if found else (None, NO_VALUE, 0)


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
    after = segment.after
    feet, confidence, taken = level_in(after, is_here=bound is not None)
    is_short = sense == "maintain" and _SHORT_UNTIL.match(after) is not None
    is_verb = sense != "maintain" or words[0] != "maintain"
    if feet is None and bound is not None:
        feet, confidence, taken = _hundreds(after)
    if feet is None and (is_verb or is_short) and _PASSED.match(after) is None:
        feet, confidence, taken = bare_level(after)
    along = _ALONG.match(segment.text, segment.found.end()) if feet is None else None
    if along is not None:
        feet, confidence, _ = level_in(segment.text[along.end() :], is_here=True)
        taken = 0
    if feet is None and sense in ("maintain", None):
        return None
    if feet is None and after.strip() in IMMEDIATE:
        confidence = 1.0  # A traffic alert names no level (FAA Order JO 7110.65, 2-1-6).
    if taken and sense in ("climb", "descend") and after.startswith(" at "):
        confidence = min(confidence, SHORTENED)  # It may be a rate whose unit is lost.
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
    by_fix = _BY_FIX.match(segment.text, end, segment.limit) if feet is not None else None
    if by_fix is None:
        return Read(read, segment.start, end)
    reached = Instruction(
        "cross_fix", position=by_fix["fix"], altitude_ft=feet, confidence=confidence
    )
    return Read(read, segment.start, by_fix.end(), (reached,))


def limited_level(segment: Segment, action: Action) -> Read | None:
    """Read a level that is not to be passed, or one that holds until a fix or over it."""
    found = segment.found
    bound = bound_of(found["bound"])
    if found[0].startswith("not"):
        bound = "or_more" if found["bound"] == "below" else "or_less"
    feet, confidence, taken = level_in(segment.after, is_here=True)
    if feet is None:
        feet, confidence, taken = _hundreds(segment.after)
    if feet is None:
        return None
    end = found.end() + taken
    fix = segment.before.split()
    if len(fix) == 1 and segment.found[0].startswith("at") and _IS_NAME.fullmatch(fix[0]):
        action, sure = "cross_fix", min(confidence, BARE_VALUE)
        crossed = Instruction(
            action, position=fix[0], altitude_ft=feet, bound=bound, confidence=sure
        )
        return Read(crossed, segment.begin, end)
    if found[0].startswith("at"):
        confidence = min(confidence, SHORTENED)  # The fix to cross may be what is lost.
    read = Instruction(action, altitude_ft=feet, bound=bound, confidence=confidence)
    return Read(read, segment.start, end)


def level_over_fix(segment: Segment, action: Action) -> Read | None:
    """Read a bound for a level over a fix that is named behind it."""
    found = segment.found
    fix, confidence = fix_of(segment)
    feet, sure, _ = level_in(f" {found['level']}", is_here=True)
    if feet is None:
        return None
    read = Instruction(
        action, position=fix, altitude_ft=feet, bound=bound_of(found["bound"]),
        confidence=min(confidence, sure),
    )  # fmt: skip
    return Read(read, segment.start, found.end())


def by_discretion(segment: Segment, action: Action) -> Read | None:
    """Read a level that the pilot may go to at any time."""
    feet, confidence, taken = level_in(segment.after, is_here=True)
    if feet is None:
        feet, confidence, taken = bare_level(segment.after)
    if feet is None:
        return None
    sense: Sense | None = "descend" if " down" in segment.found[0] else None
    read = Instruction(
        action, sense=sense, altitude_ft=feet, condition="at pilot discretion",
        confidence=confidence,
    )  # fmt: skip
    return Read(read, segment.start, segment.found.end() + taken)


def cross_fix(segment: Segment, action: Action) -> Read | None:
    """Read a restriction at a fix: its level, its speed, or both."""
    found = segment.found
    fix, confidence = fix_of(segment)
    bound = bound_of(found["bound"])
    feet, sure, taken = level_in(segment.after, is_here=True)
    bare = _BARE_CROSSING.match(segment.after) if feet is None else None
    if bare:
        feet, sure, taken = float(bare[1]) * 1000.0, SHORTENED, bare.end()
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
    end = speed.end() if speed else end
    if not found["kept"] or feet is None:
        return Read(read, segment.start, end)
    kept = Instruction(
        "altitude", sense="maintain", altitude_ft=feet, condition=f"at {fix}", confidence=confidence
    )
    return Read(read, segment.start, end, (kept,))


_ALONG = re.compile(r" (?:(?:on )?(?:runway|present) heading|straight ahead)(?= to(?!\S))")
"""A heading between a climb and its level."""
_PASSED = re.compile(r" through(?!\S)")
"""A level that is only passed: the climb or the descent goes on."""
_BY_FIX = re.compile(rf" by (?!the(?!\S)|time(?!\S))(?P<fix>{FIX})(?!\S)")
_IS_NAME = re.compile(rf"(?!(?:{FIX_ENDS})$)[a-z]{{3,}}")
_BARE_CROSSING = re.compile(r" ([4-9]|[12][0-9])(?= (?:and|at) [12][0-9]0(?!\S)|$| \|)")
"""Thousands of feet over a fix without the word."""
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


def from_level(segment: Segment, action: Action) -> Read | None:
    """Read a level that is left for another one."""
    left, _, _ = level_in(f" {segment.found['left']}", is_here=True)
    feet, confidence, taken = level_in(segment.after, is_here=True)
    if left is None or feet is None:
        return None
    sense: Sense = "climb" if feet > left else "descend"
    read = Instruction(action, sense=sense, altitude_ft=feet, confidence=confidence)
    return Read(read, segment.start, segment.found.end() + taken)


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
    sense = cast("Sense | None", found.groupdict().get("sense"))
    told = Instruction(action, sense=sense, rate_fpm=fpm, bound=bound, confidence=sure)
    return Read(told, segment.start, end)


_OR = r"(?: at or (?P<bound>above|below))?"
_RATE = r"(?:(?P<thousands>[0-9]) thousand(?: (?P<hundreds>[1-9]00))?|(?P<plain>[1-9][0-9]{2,3}))"
_PROCEDURE = r"(?: (?:the )?(?!to |sid|star|the |glide)(?P<name>[a-z]+(?: [a-z]+)?(?: [0-9])?))??"

CROSSINGS: Listed = (
    ("cross crossing", "cross_fix",
     rf"cross(?:ing)? (?!{SIDED_RUNWAY})"
     rf"(?P<fix>(?:[0-9]{{1,3}} miles? (?:[a-z]+ )?(?:of|from|before) )?{FIX})"
     r"(?: at(?: or (?P<bound>above|below)| (?P<kept>(?:and )?maintain))?|(?= flight level))",
     cross_fix),
    ("climb climbing descend descending", "cross_fix",
     r"(?:climb|descend)(?:ing)? to (?:be level|reach|be at)(?: at)?"
     rf" (?P<level>{LEVEL_WORDS}) by (?P<fix>{FIX})", level_by_fix),
    ("at", "cross_fix",
     rf"at or (?P<bound>above|below) (?P<level>{LEVEL_WORDS}) (?:at|over) (?P<fix>{FIX})",
     level_over_fix),
    ("level", "cross_fix", rf"level by (?P<fix>{FIX})", level_by_fix),
)  # fmt: skip
"""Forms of crossing restrictions, which come before those of crossing a runway."""
FORMS: Listed = (
    ("leave", "altitude",
     rf"leave (?P<left>{LEVEL_WORDS}) for(?= {LEVEL_WORDS})", from_level),
    ("stop stopping", "altitude",
     r"stop(?:ping)? (?:(?:your|the|my) )?(?:climb|descent|descend)(?: at| and maintain)?",
     altitude),
    ("stopping", "altitude", r"stopping(?: at)?(?= (?:flight|level|[0-9]))", altitude),
    ("climb climbing", "climb_via",
     rf"climb(?:ing)? via(?: the)?{_PROCEDURE}"
     r"(?: (?:sid|departure)|(?= except| squawk| altimeter| qnh| \||$))",
     via_procedure),
    ("descend descending", "descend_via",
     rf"descend(?:ing)? via(?: the)?{_PROCEDURE}"
     r"(?: (?:star|arrival)|(?= except| altimeter| qnh| \||$))",
     via_procedure),
    ("climb climbing descend descending", "vertical_rate",
     rf"(?P<sense>climb|descend)(?:ing)? (?:at|with) {_RATE}(?: feet)? (?:per minute|a minute|min)",
     rate),
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
    ("up down", "altitude", r"(?:up|down) to(?= [0-9]| flight| level)"
     r"(?! [0-9]{1,3} (?:miles?|nautical|degrees|left|right|d m e|knots|minutes?)(?!\S))",
     altitude),
    ("expedite expediting", "altitude",
     r"expedit(?:e|ing) (?:your |the )?(?:climb|descent|descend)(?: to| and maintain)?"
     rf"{_OR}",
     altitude),
    ("expedite", "expedite", r"(?:^|(?<=\| ))expedite(?= \||$)", alone),
    ("not", "altitude",
     r"not (?:to be )?(?P<bound>above|below)(?= [0-9]| flight| level| altitude [0-9])",
     limited_level),
    ("at", "altitude", r"at or (?P<bound>above|below)(?= [0-9]| flight| level)", limited_level),
    ("pd", "altitude", r"pd(?: down)?(?: to|(?= flight| level))(?= [0-9]| flight| level)",
     by_discretion),
    ("discretion pilot", "altitude",
     r"(?:pilot )?discretion(?: down to| to|(?= flight| level| [0-9]+ thousand))"
     r"(?= [0-9]| flight| level)", by_discretion),
    ("recleared", "altitude", r"recleared(?: to)?(?= flight| level| [0-9])", altitude),
    ("except", "altitude", r"except(?: maintain|(?= flight level [0-9]| [0-9]+ thousand))",
     altitude),
    ("maintain maintaining remain", "altitude",
     r"(?:maintain(?:ing)?|remain)(?: v f r| vfr)? at or (?P<bound>above|below)", altitude),
    ("maintain maintaining", "altitude",
     r"maintain(?:ing)? (?:at )?(?P<bound>least|most)(?= [0-9]| flight| level)", altitude),
    ("maintain maintaining", "altitude", r"maintain(?:ing)?(?: at| altitude)?", altitude),
    ("remain", "altitude",
     r"remain(?: at)?(?= flight level| level|(?: [0-9]+) thousand)", altitude),
    ("level", "altitude", r"level off(?: at)?", altitude),
    ("at with", "vertical_rate",
     rf"(?:at|with) {_RATE}(?: feet)? (?:per minute|a minute|min)", rate),
    ("rate", "vertical_rate",
     rf"rate(?: of (?:climb|descent))?(?: at)? {_RATE}(?: feet)?(?: (?:per minute|a minute|min))?",
     rate),
)  # fmt: skip
"""Forms of levels."""
