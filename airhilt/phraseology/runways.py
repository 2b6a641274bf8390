"""Forms of actions on runways (FAA Order JO 7110.65, 3-8 to 3-10; ICAO Doc 4444, 12.3.4)."""

from __future__ import annotations

import re
from dataclasses import replace

from airhilt.phraseology.call import Action, Instruction
from airhilt.phraseology.forms import (
    BARE_RUNWAY,
    BARE_VALUE,
    NO_RUNWAY,
    POSITION,
    UNIT,
    Listed,
    Read,
    Segment,
    alone,
    is_next_runway,
    nothing,
    on_runway,
)
from airhilt.phraseology.slots import (
    LETTER,
    NAMED_RUNWAY,
    NUMBERED_LINK,
    RUNWAY,
    SIDED_RUNWAY,
    TAXIWAY,
    designator,
    runway_confidence,
    taxiway,
)

ANIMALS = (
    "deer", "coyote", "fox", "dog", "animal", "wildlife", "geese", "goose", "gull", "gulls",
    "bird", "birds", "flock", "coyotes", "foxes", "dogs", "animals", "goats", "goat", "sheep",
    "cow", "cows", "cattle", "horse", "horses", "kangaroo", "kangaroos", "moose", "elk", "hare",
    "hares", "rabbit", "rabbits", "turtle", "turtles", "alligator", "vulture", "vultures",
    "hawk", "seagulls", "pigs", "boar",
)  # fmt: skip
PLACES = (
    "park", "valley", "creek", "lake", "river", "island", "hill", "hills", "city", "point",
    "mountain", "run", "springs", "bay", "harbor", "harbour", "woods", "pass", "field",
)  # fmt: skip
"""Words after an animal in the name of a place: Deer Park."""
_POINT = re.compile(
    rf" (?:at |of )?(?:the )?(?:taxiway |intersection |(?:holding )?(?:point|decimal) )?({TAXIWAY})"
)
_LINK = re.compile(rf" (?:of |at )?({NUMBERED_LINK})")
_SIGN = rf"(?:{LETTER}|[a-z](?!\S))"
_DOUBLE_POINT = re.compile(
    rf" (?:of )?(?:taxiway )?({_SIGN}) ({_SIGN}(?: [0-9]{{1,2}}(?!\S))?)(?= ?(?:$|\||#))"
)
"""Taxiway of two letters, with or without a number, behind which the call ends."""
_OF_LANDING = re.compile(r"(?<!\S)(?:land|landing|final|around)(?!\S)")
"""Words of an approach, which "continue" belongs to."""
_ONLY = re.compile(
    r"(?:\| )?(?:(?:[a-z]+ )?(?:tower|ground) )?"
    r"(?:(?:you|may|can|okay|ok|roger|thanks|thank|please|just|now|and|then|the|#+) )*"
    r"(?:continue|proceed)(?: (?:now|please|as cleared))*"
)
"""A call that says nothing but to continue."""
_OF = re.compile(
    rf" (?:(?:end|threshold|side|middle|edge|numbers) of|on|crossing|off|near|beside) {RUNWAY}"
)
"""A runway without the word, where animals are."""
_ANY_RUNWAY = re.compile(rf"(?<!\S)(?:runway |(?={SIDED_RUNWAY})){RUNWAY}")
_THE_RUNWAY = re.compile(
    r"(?<!\S)the (?:runway(?! [0-9])|threshold|touchdown zone|numbers|centre ?line|approach end"
    r"|departure end|far end|near end)(?!\S)"
)
"""Words for a runway that the same call may name elsewhere."""
_BY_WIND = re.compile(r" (?:wind|#)")
"""Words behind a runway that is also that of the clearance behind them."""
_ELSEWHERE = re.compile(
    rf" (?:\S+ )*?(?:on|at|near|by|along|beside|crossing|off|in|over|from)(?: the)?"
    rf" (?P<place>taxiway {TAXIWAY}|{LETTER}(?: [0-9]{{1,2}}(?!\S))?(?!.*runway)"
    r"|(?:(?:north|south|east|west|main|cargo|general aviation|run up|parking|perimeter"
    r"|service|airport) ){0,2}(?:apron|ramp|stand|gate|hangars?|terminal|fence|road"
    r"|perimeter|parking|pad|taxiway)(?: [0-9]{1,3})?)(?!\S)"
)
"""A place on the ground that is no runway."""
_HEARSAY = re.compile(r"(?<!\S)(?:reported|reports|earlier|previous)(?!\S)")
"""Words of what somebody else saw before."""
_READY = re.compile(r"(?<!\S)ready(?!\S)")


def go_around(segment: Segment, action: Action) -> Read | None:
    """Read an action whose runway is named right after it, if at all."""
    beside = (
        None if is_next_runway(segment) else re.match(rf" (?:on )?runway {RUNWAY}", segment.after)
    )
    runway = designator(*beside.groups()) if beside else None
    end = segment.found.end() + (beside.end() if beside else 0)
    confidence = runway_confidence(beside[1]) if beside else 1.0
    return Read(Instruction(action, runway, confidence=confidence), segment.start, end)


def continue_approach(segment: Segment, action: Action) -> Read | None:
    """Read "continue approach", whose runway is named before or after it, if at all."""
    is_only = len(NAMED_RUNWAY.findall(segment.after)) == 1
    if is_only and is_next_runway(segment) and segment.text.startswith("clear", segment.limit):
        return alone(segment, action)  # The runway is that of the clearance.
    read = on_runway(segment, action)
    if read is None:
        return None
    told = read.instruction
    is_lost = told.runway is None and "runway" in segment.before.split()
    confidence = told.confidence if told.runway else NO_RUNWAY if is_lost else 1.0
    return Read(Instruction(action, told.runway, confidence=confidence), read.start, read.end)


def continues(segment: Segment, action: Action) -> Read | None:
    """Read "continue": the approach beside a runway or a landing, else the way on the ground."""
    read = continue_approach(segment, action)
    if read is None or read.instruction.runway:
        return read
    if _OF_LANDING.search(segment.text) is None and not segment.after.startswith(" #"):
        is_alone = _ONLY.fullmatch(segment.text)
        sure = NO_RUNWAY if "#" in segment.text else BARE_VALUE
        told = Instruction("taxi", confidence=sure)
        return Read(told, segment.start, segment.found.end()) if is_alone else None
    told = replace(read.instruction, confidence=NO_RUNWAY)
    return read._replace(instruction=told)


def hold_short(segment: Segment, action: Action) -> Read | None:
    """Read the runway or the taxiway to hold short of."""
    if segment.found[0].startswith("holding") and _READY.search(segment.text, segment.start):
        return None  # A pilot says where the aircraft is.
    link = _LINK.match(segment.after)
    if link:
        held = Instruction(action, hold_short=link[1])
        return Read(held, segment.start, segment.found.end() + link.end())
    point = _DOUBLE_POINT.match(segment.after) or _POINT.match(segment.after)
    if point is None:
        return on_runway(segment, action)
    held = Instruction(action, hold_short="".join(taxiway(each) for each in point.groups()))
    return Read(held, segment.start, segment.found.end() + point.end())


def bare_hold_short(segment: Segment, action: Action) -> Read | None:
    """Read "short of" without "hold", as it is read back."""
    read = hold_short(segment, action)
    if read is None or _READY.search(segment.text, segment.start):
        return None
    told = read.instruction
    return read._replace(instruction=replace(told, confidence=min(told.confidence, BARE_VALUE)))


def wildlife(segment: Segment, action: Action) -> Read | None:
    """Read a report of wildlife, which counts even without a place."""
    end = segment.found.end()
    here = segment.text[segment.start : segment.limit]
    is_next = is_next_runway(segment)
    named = None if is_next else NAMED_RUNWAY.search(segment.after) or _OF.search(segment.after)
    if named is None and "runway" not in here.split():
        elsewhere = _ELSEWHERE.search(here)
        if elsewhere:
            place = Instruction(action, position=elsewhere["place"].strip(), confidence=NO_RUNWAY)
            return Read(place, segment.start, max(end, segment.start + elsewhere.end()))
    if named is None and _THE_RUNWAY.search(here):
        told = {designator(*each.groups()) for each in _ANY_RUNWAY.finditer(segment.text)}
        if len(told) == 1:
            seen = Instruction(action, told.pop(), confidence=NO_RUNWAY)
            return Read(seen, segment.start, end)
    runway = designator(*named.groups()) if named else None
    is_shared = named is not None and _BY_WIND.match(segment.after, named.end()) is not None
    end += named.end() if named and not is_shared else 0
    at = POSITION.match(segment.text, end, segment.limit)
    confidence = runway_confidence(named[1]) if named else 1.0
    if named and named.re is _OF:
        confidence = min(confidence, BARE_RUNWAY)
    if _HEARSAY.search(segment.before_all) or segment.after.startswith(" activity"):
        confidence = min(confidence, NO_RUNWAY)
    position = taxiway(at[1]) if at else None
    read = Instruction(action, runway, position, confidence=confidence)
    return Read(read, segment.start, at.end() if at else end)


_CLEAR = r"clear(?:ed)?"
_NAMED = r"runway [0-9]{1,2}(?: (?:left|right|centre|l|r|c))?"
_INSIDE = rf"(?:{_NAMED} )?"
_ANIMAL = "|".join(ANIMALS)
_PLACE = "|".join(PLACES)
_WHERE = (
    r"(?: (?:is |are )?(?:on|at|near|by|off|crossing)(?: the)?"
    r"(?: [a-z]+ (?:end|side|edge) of)?(?: the)?(?= runway|$| \|))?"
)
"""Words between an animal and its runway."""

FORMS: Listed = (
    ("clear cleared", "touch_and_go", rf"{_CLEAR} (?:for )?(?:a |the )?touch and go", on_runway),
    ("clear cleared", "stop_and_go", rf"{_CLEAR} (?:for )?(?:a |the )?stop and go", on_runway),
    ("clear cleared", "cleared_option", rf"{_CLEAR} (?:for )?(?:the )?option", on_runway),
    ("clear cleared", "low_approach", rf"{_CLEAR} (?:for )?(?:a |the )?low approach", on_runway),
    ("clear cleared", "cleared_for_takeoff",
     rf"{_CLEAR} (?:(?:for|to) )?{_INSIDE}(?:for )?(?:an |the )?(?:immediate )?takeoff",
     on_runway),
    ("takeoff", "cleared_for_takeoff",
     r"takeoff (?:immediately|now)(?= or (?:vacate|exit|hold)(?!\S))", on_runway),
    ("clear cleared", "cleared_for_takeoff", rf"{_CLEAR} to go(?! (?:around|direct|to))",
     on_runway),
    ("clear cleared", "cleared_to_land", rf"{_CLEAR} {_INSIDE}(?:(?:to )?land|for landing)",
     on_runway),
    ("clear cleared", "cross", rf"{_CLEAR} across(?= runway| [0-9])", on_runway),
    ("line lining", "line_up",
     rf"(?<!the )(?<! a )(?:line|lining) up(?: and wait(?:ing)?)?(?! (?:{UNIT})(?!\S))", on_runway),
    ("position", "line_up", r"position and hold", on_runway),
    ("taxi", "line_up", r"taxi into position and hold", on_runway),
    ("hold holding", "hold_short", r"hold(?:ing)? short(?: of)?", hold_short),
    ("short", "hold_short",
     r"(?<!hold )(?<!we )(?<!i )(?<!you )(?<!are )(?<!is )(?<!am )(?<!just )(?<!landed )(?<!stop )"
     r"short of", bare_hold_short),
    (" ".join(str(count) for count in range(1, 10)), "cleared_to_land",
     r"(?<!runway )[1-9] (?:more )?(?:aircraft )?(?:to|for)"
     r" (?:vacate|exit|depart|departure|land|go|roll|cross)", nothing),
    ("hold holding", "hold_short",
     rf"hold(?:ing)? at(?! {LETTER} {LETTER} {LETTER})"
     rf"(?= (?:taxiway |intersection |holding (?:point|decimal) )?{LETTER})",
     hold_short),
    ("continue remain", "hold_position", r"(?:continue|remain) holding(?! short)", alone),
    ("holding", "hold_position", r"holding(?= \||$)", alone),
    ("hold holding", "hold_position", r"(?<!will )hold(?:ing)? (?:your |my |present |in )?position",
     alone),
    ("cross crossing", "cross", r"cross(?:ing)?(?= runway| [0-9])", on_runway),
    ("abort", "cancel_takeoff", r"abort(?: abort)+(?! takeoff)", alone),
    ("cancel cancelling abort aborting reject rejecting abandon abandoning", "cancel_takeoff",
     r"(?:cancel|abort|reject|abandon)(?:ling|ing)? (?:(?:your|the|my|that) )?takeoff"
     r"(?: clearance)?", alone),
    ("takeoff", "cancel_takeoff", r"takeoff(?: clearance)? (?:is |has been )?cancelled", alone),
    ("cancel cancelling", "cancel_landing",
     r"cancel(?:ling)? (?:your |the |my )?landing(?: clearance)?", alone),
    ("landing", "cancel_landing", r"landing clearance (?:is |has been )?cancelled", alone),
    ("go going", "go_around", r"go(?:ing)? around", go_around),
    ("around", "go_around", r"around we go", alone),
    ("continue continuing", "continue_approach", r"continu(?:e|ing) (?:the |your )?approach",
     continue_approach),
    ("continue proceed", "continue_approach",
     r"(?:continue(?: for)?|proceed(?=(?: now| please| as cleared)?(?: \||$)))(?: now)?"
     r"(?= runway|(?: please| as cleared)(?: \||$)"
     r"|$| \|| traffic| expect| wind| [0-9]{1,2} (?:left|right|centre))",
     continues),
    ("continue", "continue_approach", r"continue(?= number [0-9])", continue_approach),
    ("backtrack backtracking", "backtrack", r"backtrack(?:ing)?", on_runway),
    ("back", "backtrack", r"back taxi(?:ing)?", on_runway),
    (" ".join(ANIMALS), "wildlife_gone",
     rf"(?:{_ANIMAL})(?!\S)(?: \S+)*? (?:(?:has|have) left|gone|(?:is|are) clear)", wildlife),
    (" ".join(ANIMALS), "wildlife",
     rf"(?<!via the )(?<!via )(?<!direct )(?<!direct to )(?:{_ANIMAL})(?!\S)"
     rf"(?! (?:strike|hazard|control|scaring|{_PLACE})(?!\S))"
     rf"(?: (?:\S+ )*(?:{_ANIMAL}))?{_WHERE}",
     wildlife),
)  # fmt: skip
"""Forms of actions on runways, and of animals on them."""
