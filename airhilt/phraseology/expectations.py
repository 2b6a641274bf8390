"""Forms of what is to be expected, which is no clearance (FAA Order JO 7110.65, 4-2-5, 4-7-10)."""

from __future__ import annotations

import re
from dataclasses import replace

from airhilt.phraseology.approaches import NAMED_APPROACH, named_approach
from airhilt.phraseology.call import Action, Instruction, Sense
from airhilt.phraseology.forms import BARE_RUNWAY, Listed, Read, Segment, fix_of
from airhilt.phraseology.slots import FIX, RUNWAY, SIDED_RUNWAY, designator
from airhilt.phraseology.vertical import bare_level, level_in


def expected_level(segment: Segment, action: Action) -> Read | None:
    """Read a level to be expected."""
    feet, confidence, taken = level_in(segment.after, is_here=True)
    if feet is None:
        feet, confidence, taken = _level_in_a_while(segment.after)
    if feet is None:
        return None
    head = segment.found["sense"]
    sense: Sense | None = None if head is None else "climb" if head == "climb" else "descend"
    read = Instruction(action, sense=sense, altitude_ft=feet, confidence=confidence)
    return Read(read, segment.start, segment.found.end() + taken, is_expected=True)


def expected_approach(segment: Segment, action: Action) -> Read | None:
    """Read an approach to be expected."""
    del action
    read = named_approach(segment.found["approach"])
    if read is None:
        return None
    end = segment.found.end()
    beside = _BARE_RUNWAY.match(segment.after)
    if beside and read.runway is None:
        runway = designator(*beside.groups())
        read = replace(read, runway=runway, confidence=min(read.confidence, BARE_RUNWAY))
        end += beside.end()
    return Read(read, segment.start, end, is_expected=True)


def expected_at_fix(segment: Segment, action: Action) -> Read | None:
    """Read a direct or a hold to be expected."""
    fix, confidence = fix_of(segment)
    read = Instruction(action, position=fix, confidence=confidence)
    return Read(read, segment.start, segment.found.end(), is_expected=True)


def expected_on_runway(segment: Segment, action: Action) -> Read | None:
    """Read a landing or a departure to be expected."""
    number = segment.found.groupdict().get("number")
    ahead = re.search(
        rf"(?:continue )?runway {RUNWAY}(?: continue)?$", segment.text[: segment.start].rstrip()
    )
    runway = None
    if number:
        runway = designator(number, segment.found["side"])
    elif ahead:
        runway = designator(*ahead.groups())
    else:
        said = {designator(*each.groups()) for each in _RUNWAYS.finditer(segment.before_all)}
        runway = said.pop() if len(said) == 1 else None
    immediate = "immediate" in segment.found[0]
    read = Instruction(action, runway, immediate=immediate)
    return Read(read, segment.start, segment.found.end(), is_expected=True)


def _level_in_a_while(text: str) -> tuple[float | None, float, int]:
    """Return a flight level without its unit, behind which the time or the place is said."""
    return bare_level(text) if _IN_A_WHILE.match(text) else (None, 0.0, 0)


_IN_A_WHILE = re.compile(r"(?: to)? [1-6][0-9]{2} (?:in|by|at|within)(?!\S)")
_RUNWAYS = re.compile(rf"(?<!\S)(?:runway |(?={SIDED_RUNWAY})){RUNWAY}")
_BARE_RUNWAY = re.compile(
    rf"(?: to)? (?={SIDED_RUNWAY}|[0-9]+(?:$| (?:\||we|with|and|got|have|looking)(?!\S))){RUNWAY}"
)
_EXPECT = r"(?:expect(?:ing)?|plan(?:ning)?(?: on)?|anticipate)"
_RUNWAY = RUNWAY.replace("(0?", "(?P<number>0?", 1).replace("(left|", "(?P<side>left|", 1)

FORMS: Listed = (
    ("expect expecting plan planning anticipate", "altitude",
     rf"{_EXPECT}(?: (?P<sense>climb|descent|descend)(?: to)?)?(?= (?:to |flight |level |[0-9]))",
     expected_level),
    ("expect expecting plan planning anticipate", "cleared_approach",
     rf"{_EXPECT}(?: (?:vectors|radar vectors|the|a|an|for|to|straight in))*"
     rf" (?P<approach>{NAMED_APPROACH.pattern})", expected_approach),
    ("expect expecting plan planning anticipate", "direct",
     rf"{_EXPECT} direct(?: to)? (?P<fix>{FIX})",
     expected_at_fix),
    ("expect expecting plan planning anticipate", "hold_at",
     rf"{_EXPECT}(?: to)? hold(?:ing)?(?: at| over) (?P<fix>{FIX})", expected_at_fix),
    ("expect expecting", "cleared_to_land", r"expect(?:ing)?(?: a)?(?: late)? landing clearance",
     expected_on_runway),
    ("expect expecting", "cleared_for_takeoff",
     rf"expect(?:ing)? (?:departure|takeoff)(?: clearance)?(?: runway {_RUNWAY})?",
     expected_on_runway),
    ("be", "cleared_for_takeoff", r"be ready for (?:an )?immediate (?:departure|takeoff)",
     expected_on_runway),
)  # fmt: skip
"""Forms of what is to be expected."""
