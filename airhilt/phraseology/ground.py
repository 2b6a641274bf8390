"""Forms of movement on the ground (FAA Order JO 7110.65, 3-7; ICAO Doc 4444, 12.3.4.4 to 9)."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import cast

from airhilt.phraseology.call import Action, Instruction, Turn
from airhilt.phraseology.forms import (
    BARE_RUNWAY,
    BARE_VALUE,
    NO_VALUE,
    Listed,
    Read,
    Segment,
    alone,
    is_immediate,
    nothing,
    on_runway,
    runway_before,
)
from airhilt.phraseology.slots import (
    FIX_ENDS,
    LETTER,
    NAMED_RUNWAY,
    NUMBERED_LINK,
    RUNWAY,
    SHORTENED,
    TAXIWAY,
    designator,
    runway_confidence,
    taxiway,
)

_PIECE = rf"(?:{TAXIWAY}|{NUMBERED_LINK})"
"""Pattern of a taxiway, or of a link between two that has a number."""
_LISTED = rf"(?:(?!q n h)(?:(?:and|then|taxiway) )*{_PIECE}(?: |$))+"
_VIA = re.compile(rf"(?<!\S)via ({_LISTED})")
_HERE = re.compile(rf" (?:(?:on|via|along) )?((?=(?:taxiway )?{LETTER}){_LISTED})")
"""A route right here, whose "via" may be missing."""
_HOLDING_POINT = r"(?:the )?holding (?:point|decimal)"
_GOES_ON = re.compile(
    rf" ?(?:$|\||#|{FIX_ENDS}(?!\S)|(?:give|pass|without|use|give|back|full)(?!\S))"
)
_EACH_TAXIWAY = re.compile(rf"(?<!\S){_PIECE}")
_PLACE = re.compile(
    r" (?:to )?(?:the )?("
    r"(?:(?!(?:runway|to|via|and|then|cleared|wind|line|hold)(?!\S))[a-z]+ ?){1,4}(?:[0-9]+)?)"
)
_TAXI_RUNWAY = re.compile(
    rf"(?: to)?(?: the)?(?: holding(?: point| decimal)?(?: {TAXIWAY})?)?(?: for)? runway {RUNWAY}"
)
_RUNWAY_BEHIND = re.compile(
    rf" to (?:{_HOLDING_POINT} {TAXIWAY} runway |{_HOLDING_POINT} (?:runway )?|(?:runway )?)"
    rf"{RUNWAY}"
)
"""A runway behind its route."""
_POINT = re.compile(
    rf"(?: (?:to|at) (?:taxiway |{_HOLDING_POINT} )?| {_HOLDING_POINT} )({TAXIWAY})"
)
_TAXI_TO = re.compile(
    r"(?!.* (?:runway|not)(?!\S)) to (?:the )?((?:[a-z]+ ?){1,4}(?:[0-9]+)?)(?=$| )"
)


def proceed(segment: Segment, action: Action) -> Read | None:
    """Read leave to go on to a runway, or a taxi route."""
    if NAMED_RUNWAY.search(segment.after):
        return on_runway(segment, action)
    if not re.match(r" (?:to|via)(?!\S)", segment.after):
        return None
    read = taxi(segment, "taxi")
    if read is None or read.instruction.via:
        return read
    told = read.instruction  # It may be the flight to a fix.
    return read._replace(instruction=replace(told, confidence=min(told.confidence, SHORTENED)))


def taxi(segment: Segment, action: Action) -> Read | None:
    """Read a taxi clearance: its runway or place, and its route."""
    after = segment.after
    runway = _TAXI_RUNWAY.match(after)
    via = _VIA.search(after) or _HERE.match(after)
    if runway is None and via is not None:
        runway = _RUNWAY_BEHIND.match(after, via.end() - via[0].endswith(" "))
    ahead = None if runway or via is None else runway_before(segment)
    point = _POINT.match(after) or (via and _POINT.match(after, via.end() - via[0].endswith(" ")))
    to = re.split(r" (?:via|and|at|on)(?!\S)", after)[0]
    place = None if runway or point else _TAXI_TO.match(to)
    position = taxiway(point[1]) if point else place[1].strip() if place else None
    taken = max((each.end() for each in (runway, via, point) if each), default=0)
    number, side = runway.group(1, 2) if runway else ahead.group(2, 3) if ahead else (None, None)
    is_read = bool(number or position or (via and not to.strip()))
    confidence = runway_confidence(number) if number else 1.0 if is_read else NO_VALUE
    if runway is not None and "runway" not in runway[0]:
        confidence = min(confidence, BARE_RUNWAY)
    is_lost = number is None and "runway" in segment.before.split()
    is_request = number is not None and via is None and not after.startswith(" to")
    if is_lost or is_request or (taken and _GOES_ON.match(after, taken) is None):
        confidence = NO_VALUE  # A word may be missing, or be the rest of the route.
    read = Instruction(
        action,
        designator(number, side) if number else None,
        position,
        via=_route(via[1]) if via else (),
        confidence=confidence,
    )
    start = segment.begin + ahead.start() if ahead else segment.start
    return Read(read, start, segment.found.end() + taken)


def on_taxiways(segment: Segment, action: Action) -> Read | None:
    """Read the taxiways to join, or to go on along."""
    via = _HERE.match(segment.after)
    if via is None:
        return None
    is_cut = _GOES_ON.match(segment.after, via.end()) is None
    end = segment.found.end() + via.end()
    read = Instruction(action, via=_route(via[1]), confidence=NO_VALUE if is_cut else 1.0)
    return Read(read, segment.start, end)


def turns(segment: Segment, action: Action) -> Read | None:
    """Read a route of turns: "left on C then right on B"."""
    read = Instruction(action, via=_route(segment.found["turns"]), confidence=BARE_VALUE)
    return Read(read, segment.start, segment.found.end())


def route(segment: Segment, action: Action) -> Read | None:
    """Read a taxi route that is read back without its verb: "runway 27 via A"."""
    found = segment.found
    via = _VIA.search(found[0])
    if via is None:
        return None
    confidence = min(BARE_VALUE, runway_confidence(found[1]))
    read = Instruction(
        action, designator(found[1], found[2]), via=_route(via[1]), confidence=confidence
    )
    return Read(read, segment.start, found.end())


def _route(text: str) -> tuple[str, ...]:
    return tuple(
        each if each.startswith(("link", "exit", "spur")) else taxiway(each)
        for each in _EACH_TAXIWAY.findall(text)
    )


def vacate(segment: Segment, action: Action) -> Read | None:
    """Read where to leave a runway."""
    found = re.match(
        rf"(?: runway {RUNWAY})?(?: next| first)?(?: to the)?(?: (left|right)(?!\S))?"
        rf"(?: (?:at |via |on |onto )?(?:taxiway )?({TAXIWAY}))?(?: (left|right) turn(?!\S))?",
        segment.after,
    )
    number, side, turn, exit_, turn_behind = found.groups() if found else (None,) * 5
    turn = segment.found.groupdict().get("turn") or turn or turn_behind
    read = Instruction(
        action,
        designator(number, side) if number else None,
        taxiway(exit_) if exit_ else None,
        turn=cast(Turn | None, turn),
        immediate=is_immediate(segment, segment.found.end()),
        confidence=runway_confidence(number) if number else 1.0,
    )
    return Read(read, segment.start, segment.found.end() + (found.end() if found else 0))


def about_other(segment: Segment, action: Action) -> Read | None:
    """Read an action about another aircraft."""
    place = _PLACE.match(segment.after)
    words = place[1].strip() if place else None
    end = segment.found.end() + (place.end() if place else 0)
    read = Instruction(action, position=words, confidence=1.0 if words else NO_VALUE)
    return Read(read, segment.start, end)


FORMS: Listed = (
    ("enter entering join joining make", "proceed",
     r"(?:(?:enter|join)(?:ing)?|make)(?: the| a)?(?: (?:left|right)(?: hand)?)?"
     r" (?:downwind|base|crosswind|final|pattern|traffic|360|orbit|turns?|short|straight)",
     nothing),
    ("proceed proceeding enter entering", "proceed", r"(?:proceed|enter)(?:ing)?", proceed),
    ("join joining", "taxi", rf"join(?:ing)?(?= (?:taxiway )?{LETTER})", on_taxiways),
    ("continue continuing", "taxi",
     r"continu(?:e|ing)(?: taxi)?(?: straight(?: ahead)?)?"
     rf"(?=(?: (?:on|via|along))? (?:taxiway )?{LETTER})",
     on_taxiways),
    ("turn left right", "taxi",
     rf"(?:turn )?(?P<turns>(?:left|right) (?:on|onto) {_PIECE}"
     rf"(?: (?:and|then|and then))?(?: turn)? (?:left|right) (?:on|onto) {_PIECE})", turns),
    ("vacate vacating exit exiting", "vacate",
     r"(?:vacat(?:e|ing)|exit(?:ing)?(?! [0-9]))(?: the runway)?", vacate),
    ("take", "vacate",
     r"take(?: the)?(?: (?:first|next))?(?: available)?(?: high speed)?(?= (?:left|right|exit))",
     vacate),
    ("first next", "vacate",
     r"(?:first|next)(?: available)?(?: high speed)?(?= (?:left|right|exit|turn off))", vacate),
    ("turn turning", "vacate",
     r"turn(?:ing)? (?P<turn>left|right)(?: at)?(?: the)? next (?:taxiway|intersection|exit)",
     vacate),
    ("left right", "vacate", r"(?P<turn>left|right)(?= when able)", vacate),
    ("expedite", "vacate", r"expedite (?:vacating|exiting)(?: the runway)?", vacate),
    ("expedite", "taxi", r"expedite taxi", nothing),
    ("turn turning", "vacate", r"turn(?:ing)? off(?: the runway)?", vacate),
    ("leave", "vacate", r"leave the runway", vacate),
    ("taxi taxiing drive driving", "taxi",
     r"(?:(?<!continue )taxi(?:ing)?|driv(?:e|ing))"
     rf"(?= (?:(?:taxiway )?{LETTER}|to|via|at|on|back|across|runway|holding|gate|stand|straight"
     r"|left|right|into|without|and|with|hold|[0-9]+|\|)(?!\S)|$)",
     taxi),
    ("continue", "taxi", r"continue taxi(?= to)", taxi),
    ("runway", "taxi",
     rf"(?<!to )(?<!taxi )(?<!decimal )runway {RUNWAY}"
     rf" via(?: (?!q n h)(?:and |taxiway )?{TAXIWAY})+", route),
    ("stop", "stop",
     r"(?<!cleared )(?<!full )stop"
     r"(?! (?:on|at|squawk|over|and|turn|climb|descent|your|heading)(?!\S))(?: immediately)?",
     alone),
    ("stopping", "stop", r"stopping(?= \||$| immediately| on)", alone),
    ("pushback push", "push_back",
     r"push(?:back)?(?: (?:is )?approved|(?= and start(?:up)? (?:is )?approved))", alone),
    ("startup start", "start_up", r"start(?:up)? (?:is )?approved", alone),
    ("startup start", "start_up", r"start(?:up)?(?= and push(?:back)? (?:is )?approved)", alone),
    ("follow", "follow", r"follow(?! me)", about_other),
    ("give giving", "give_way", r"giv(?:e|ing) way(?: to)?", about_other),
    ("pass passing", "give_way", r"pass(?:ing)? behind", about_other),
)  # fmt: skip
"""Forms of movement on the ground."""
