"""Forms of speeds (FAA Order JO 7110.65, 5-7-2 to 5-7-4; ICAO Doc 4444, 12.4.1.6)."""

from __future__ import annotations

import re

from airhilt.phraseology.call import Action, Instruction
from airhilt.phraseology.forms import Form, Listed, Read, Segment, alone
from airhilt.phraseology.slots import NO_SENSE, SHORTENED, speed_confidence
from airhilt.phraseology.vertical import bound_after


def speed(segment: Segment, action: Action) -> Read | None:
    """Read a speed in knots; one in feet makes no sense."""
    parts = segment.found.groupdict()
    speed_kt = float(parts["number"])
    bound, end, sure = bound_after(segment.text[: segment.limit], segment.found.end())
    if parts.get("most") or _MOST.search(segment.text[: segment.found.start("number")]):
        bound = "or_less"
    elif _LEAST.search(segment.text[: segment.found.start("number")]):
        bound = "or_more"
    distance = _TO_DISTANCE.match(segment.text, end)
    end = distance.end() if distance else end
    confidence = NO_SENSE if parts.get("feet") else min(sure, speed_confidence(speed_kt))
    read = Instruction(action, speed_kt=speed_kt, bound=bound, confidence=confidence)
    return Read(read, segment.start, end)


def bare_speed(segment: Segment, action: Action) -> Read | None:
    """Read a speed without a verb."""
    read = speed(segment, action)
    if read is None:
        return None
    told = read.instruction
    sure = min(told.confidence, SHORTENED)
    told = Instruction(action, speed_kt=told.speed_kt, bound=told.bound, confidence=sure)
    return read._replace(instruction=told)


def named_speed(segment: Segment, action: Action) -> Read | None:
    """Read a speed that has a name instead of a number."""
    named = segment.found["named"]
    confidence = 1.0 if " " in named else SHORTENED
    read = Instruction(action, named=named, confidence=confidence)
    return Read(read, segment.start, segment.found.end())


def resume(segment: Segment, action: Action) -> Read | None:
    """Read the end of speed control."""
    named = segment.found["named"]
    is_whole = named in ("normal", "published")
    read = Instruction(
        action, named=named if is_whole else "normal", confidence=1.0 if is_whole else SHORTENED
    )
    return Read(read, segment.start, segment.found.end())


def mach(segment: Segment, action: Action) -> Read | None:
    """Read a Mach number."""
    digits = segment.found["digits"]
    bound, end, sure = bound_after(segment.text[: segment.limit], segment.found.end())
    value = float(f"0.{digits}")
    confidence = sure if 0.5 <= value <= 0.95 else NO_SENSE
    return Read(Instruction(action, mach=value, bound=bound, confidence=confidence),
                segment.start, end)  # fmt: skip


_LEAST = re.compile(r"(?<!\S)(?:at least|not? (?:less|slower) than) $")
_MOST = re.compile(r"(?<!\S)(?:at most|not? (?:more|faster|greater) than) $")
"""Words before a speed that leave one side of it free."""
_TO_DISTANCE = re.compile(
    r" to (?:the )?(?:(?:outer )?marker|[0-9]{1,2}(?: (?:miles?|d m e|dme))?(?: final)?)(?!\S)"
)
"""The distance from the threshold to which a speed is kept."""
_NUMBER = (
    r"(?P<number>[1-9][0-9]{2}|[6-9][0-9])(?!\S)(?! (?:thousand|degrees|miles?|decimal))"
    r"(?: knots)?(?P<feet> feet)?"
)
_VERB = r"(?:(?:reduc|increas|slow)(?:e|ing)?|(?:maintain|keep)(?:ing)?)"
_NAMED = (
    r"(?P<named>(?:(?:minimum|maximum|slowest|best|final) )?"
    r"(?:minimum|maximum|slowest|best|final|approach|clean|forward|practical|possible))"
)

FORMS: Listed = (
    ("reduce reducing increase increasing slow slowing maintain maintaining", "mach",
     rf"{_VERB}(?: speed)?(?: to)? mach (?:number )?(?:decimal )?(?P<digits>[0-9]{{2,3}})", mach),
    ("mach", "mach", r"mach (?:number )?(?:decimal )?(?P<digits>[0-9]{2,3})", mach),
    ("reduce reducing increase increasing slow slowing maintain maintaining", "speed",
     rf"{_VERB}(?: your)?(?: speed)?(?: to)?(?: your)? {_NAMED}(?: speed)?", named_speed),
    ("minimum maximum slowest best", "speed",
     r"(?P<named>minimum (?:clean|approach(?= speed))|maximum forward|best forward"
     r"|slowest (?:practical|possible))(?: speed)?", named_speed),
    ("keep keeping", "speed",
     r"keep(?:ing)? (?:speed )?(?P<number>[1-3][0-9]0)(?: knots| speed|(?= or | until| to| \||$))",
     speed),
    ("maintain maintaining", "speed",
     r"maintain(?:ing)? (?:speed )?(?P<number>[1-9][0-9]{2}|[6-9][0-9])"
     r"(?: knots| speed|(?= or (?:greater|less|better)))", speed),
    ("maintain maintaining", "speed", rf"maintain(?:ing)? speed(?: at| of)? {_NUMBER}", speed),
    ("maintain maintaining", "speed", r"maintain(?:ing)? (?P<number>[1-3][0-9]0)(?= until| \||$)",
     bare_speed),
    ("reduce reducing increase increasing slow slowing", "speed",
     rf"(?:reduc|increas|slow)(?:e|ing)?(?: your| it)?(?: speed)?(?: down)?(?: to)? {_NUMBER}",
     speed),
    ("at no not maintain", "speed",
     r"(?:maintain )?(?:at (?:least|most)|not? (?:less|slower|more|faster|greater) than)"
     r" (?P<number>[1-3][0-9]0)(?! (?:feet|thousand|degrees|miles|decimal))(?: knots)?", speed),
    ("do", "speed", rf"do not (?P<most>exceed)(?: speed)? {_NUMBER}", speed),
    ("speed", "speed", rf"speed(?: to)? {_NUMBER}", speed),
    ("resume", "resume_speed",
     r"resume (?P<named>normal|published|your)?(?: )?speed(?: restrictions)?", resume),
    ("no delete cancel", "no_speed_restrictions",
     r"(?:no|delete|cancel)(?: a t c| atc)? speed (?:restrictions?|control|limits?)", alone),
    ("speed", "no_speed_restrictions",
     r"speed (?:is )?(?:at )?(?:your|pilot|pilots|own) discretion", alone),
    ("high free", "no_speed_restrictions", r"high speed approved|free speed", alone),
)  # fmt: skip
"""Forms of speeds."""
KNOTS_FORM = Form(
    "speed",
    re.compile(rf"(?<!at )(?<!of )(?<!wind ){_NUMBER.replace('(?: knots)?', ' knots')}(?!\S)"),
    bare_speed,
)
"""Form of a speed without a verb."""
ON_SPEED_FORM = Form(
    "speed", re.compile(r"(?P<number>[1-3][0-9]0)(?= on the speed(?!\S))"), bare_speed
)
"""Form of a speed that is read back as "one seventy on the speed"."""
LIMITED_FORM = Form(
    "speed",
    re.compile(
        r"(?<!heading )(?<!level )(?P<number>[1-3][0-9]0)(?= or (?:better|greater|less|more)(?!\S)"
        r"| (?:to|until) (?:the )?(?:(?:outer )?marker|[0-9]{1,2} (?:miles?|d m e|dme)|short final"
        r"|(?:[2-9]|1[0-5])(?= \||$| (?:and|then|contact|tower)(?!\S)))(?!\S))"
    ),
    bare_speed,
)
"""Form of a speed that only its bound or its limit shows to be one."""
