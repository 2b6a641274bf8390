"""Forms of movement on the ground (FAA Order JO 7110.65, 3-7; ICAO Doc 4444, 12.3.4.4 to 9)."""

from __future__ import annotations

import re
from typing import cast

from airhilt.phraseology.alphabet import LETTER_OF, LETTERS
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
    FIX,
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

LETTERS_OF = "|".join(LETTERS)
_PIECE = rf"(?:{TAXIWAY}|{NUMBERED_LINK})"
"""Pattern of a taxiway, or of a link between two that has a number."""
_LISTED = rf"(?:(?!q n h)(?:(?:and|then|taxiway) )*{_PIECE}(?: |$))+"
_VIA = re.compile(rf"(?<!\S)via ({_LISTED})")
_HERE = re.compile(rf" (?:(?:on|via|along|down) )?((?=(?:taxiway )?{LETTER}){_LISTED})")
"""A route right here, whose "via" may be missing."""
_HOLDING_POINT = r"(?:the )?holding (?:point|decimal)"
_GOES_ON = re.compile(
    rf" ?(?:$|\||#|{FIX_ENDS}(?!\S)|(?:give|pass|without|use|give|back|full)(?!\S))"
)
_EACH_TAXIWAY = re.compile(rf"(?<!\S){_PIECE}")
_NOT_PLACE = "runway|to|via|and|then|cleared|wind|line|hold|from|at|coming|off"
_PLACE = re.compile(
    rf" (?:to )?(?:the )?((?!(?:{_NOT_PLACE})(?!\S))[a-z]+"
    rf"(?: (?!(?:{_NOT_PLACE}|{LETTERS_OF})(?!\S))[a-z]+){{0,3}}(?: [0-9]+(?! miles?))?"
    r"|[0-9]{2,4})(?!\S)"
)
"""Another aircraft; a letter behind its name belongs to a route."""
_FOLLOWED_TO = re.compile(rf"(?: [a-z]+){{0,4}} to (?:runway )?{RUNWAY}")
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
_INTERSECTION = re.compile(rf" at (?:taxiway |intersection )?({TAXIWAY})")
"""Where on a runway a departure begins (FAA Order JO 7110.65, 3-7-2)."""
STAND = (
    r"(?:(?:stand|gate|spot|bay|hangar|pad|parking(?: stand)?|ramp|apron|terminal)(?!\S)"
    rf"(?: (?:(?:{LETTER}|[a-z]) )?[0-9]{{1,3}}(?!\S)"
    rf"(?: (?:{LETTER}|[a-z])(?= \||$| via| hold))?)?)"
)
"""Pattern of a place on the apron, with its number."""
_STAND = re.compile(rf"(?: (?:to|into|onto|in|on)(?: the| your)?)? ({STAND})(?!\S)")
_NAME_OF_PLACE = rf"(?:(?!(?:{LETTERS_OF}|{FIX_ENDS})(?!\S))[a-z]+)"
_PLACE_BEHIND = re.compile(
    rf"(?: and)? to (?:the )?({_NAME_OF_PLACE}(?: {_NAME_OF_PLACE}){{0,3}})(?= |$)"
)
"""A place behind its route."""
_TAXI_TO = re.compile(
    r"(?!.* (?:runway|not)(?!\S)) (?:to|into|onto) (?:the |your )?"
    r"((?:[a-z]+ ?){1,4}(?:[0-9]+)?)(?=$| )"
)

_TO_FIX = re.compile(rf" to ((?!(?:the|via)(?!\S)|{TAXIWAY}){FIX})")
_ON_GROUND = (
    rf"(?:{STAND}|holding|taxiway|station|fire|cargo|maintenance|area|line|fbo|fuel|run up)"
    r"(?!\S)"
)
_PLACE_ON_GROUND = re.compile(rf"(?<!\S){_ON_GROUND}")


def proceed(segment: Segment, action: Action) -> Read | None:
    """Read leave to go on to a runway, or a taxi route."""
    if re.match(r" (?:the )?(?:left|right)(?!\S)", segment.after):
        return None  # A leg of the traffic circuit, whose name is lost.
    runway = NAMED_RUNWAY.search(segment.after)
    if runway and "and" in segment.after[: runway.start()].split():
        return None  # Another action, whose word is lost.
    if runway and not segment.after.startswith(" to "):
        return on_runway(segment, action)
    if not re.match(r" (?:to|via)(?!\S)", segment.after):
        return None
    fix = _TO_FIX.match(segment.after)
    if fix is None or _PLACE_ON_GROUND.search(fix[1]):
        return taxi(segment, "taxi")
    to = Instruction("direct", position=fix[1].strip())
    return Read(to, segment.start, segment.found.end() + fix.end())


def taxi(segment: Segment, action: Action) -> Read | None:
    """Read a taxi clearance: its runway or place, and its route."""
    after = segment.after
    runway = _TAXI_RUNWAY.match(after)
    via = _VIA.search(after) or _HERE.match(after)
    if runway is None and via is not None:
        runway = _RUNWAY_BEHIND.match(after, via.end() - via[0].endswith(" "))
    ahead = None if runway or via is None else runway_before(segment)
    point = _POINT.match(after) or (via and _POINT.match(after, via.end() - via[0].endswith(" ")))
    if point is None and runway is not None:
        point = _INTERSECTION.match(after, runway.end())
    to = re.split(r" (?:via|and|at|on)(?!\S)", after)[0]
    place = None if runway or point else _STAND.match(after)
    if place and via is None:
        via = _HERE.match(after, place.end())
    if place is None and via and not (runway or point):
        place = _place_behind(after, via)
    stand = place if place and place.re is not _TAXI_TO else None
    place = place or (None if runway or point else _TAXI_TO.match(to))
    at_runway = point or (ahead and _INTERSECTION.search(ahead[0]))
    position = taxiway(at_runway[1]) if at_runway else place_name(place[1]) if place else None
    taken = max((each.end() for each in (runway, via, point, stand) if each), default=0)
    number, side = runway.group(1, 2) if runway else ahead.group(1, 2) if ahead else (None, None)
    is_read = bool(number or position or (via and (via.start() == 0 or not to.strip())))
    confidence = runway_confidence(number) if number else 1.0 if is_read else NO_VALUE
    if runway is not None and "runway" not in runway[0]:
        confidence = min(confidence, BARE_RUNWAY)
    is_lost = number is None and "runway" in segment.before.split()
    is_request = number is not None and not (via or point or after.startswith(" to"))
    if is_lost or is_request or (taken and _GOES_ON.match(after, taken) is None):
        confidence = NO_VALUE  # A word may be missing, or be the rest of the route.
    read = Instruction(
        action,
        designator(number, side) if number else None,
        position,
        via=route_of(via[1]) if via else (),
        confidence=confidence,
    )
    start = segment.begin + ahead.start() if ahead else segment.start
    return Read(read, start, segment.found.end() + taken)


def _place_behind(text: str, via: re.Match[str]) -> re.Match[str] | None:
    """Return the place behind a route."""
    end = via.end() - via[0].endswith(" ")
    return _STAND.match(text, end) or _PLACE_BEHIND.match(text, end)


def _letter(word: str) -> str | None:
    """Return the letter that a word spells, or is."""
    return word.upper() if len(word) == 1 and word.isalpha() else LETTER_OF.get(word)


def place_name(words: str) -> str:
    """Return the name of a place on the apron, with its designator: stand B46."""
    *name, last = words.split()
    if name and last.isdigit() and (letter := _letter(name[-1])):
        return " ".join((*name[:-1], letter + last))
    if name and name[-1].isdigit() and (letter := _letter(last)):
        return " ".join((*name[:-1], name[-1] + letter))
    return words.strip()


def on_taxiways(segment: Segment, action: Action) -> Read | None:
    """Read the taxiways to join, or to go on along."""
    via = _HERE.match(segment.after)
    if via is None:
        return None
    place = _place_behind(segment.after, via)
    is_cut = place is None and _GOES_ON.match(segment.after, via.end()) is None
    end = segment.found.end() + (place or via).end()
    read = Instruction(
        action,
        position=place_name(place[1]) if place else None,
        via=route_of(via[1]),
        confidence=NO_VALUE if is_cut else 1.0,
    )
    return Read(read, segment.start, end)


def turns(segment: Segment, action: Action) -> Read | None:
    """Read a route of turns: "left on C then right on B"."""
    read = Instruction(action, via=route_of(segment.found["turns"]), confidence=BARE_VALUE)
    return Read(read, segment.start, segment.found.end())


def route(segment: Segment, action: Action) -> Read | None:
    """Read a taxi route that is read back without its verb: "runway 27 via A"."""
    found = segment.found
    via = _VIA.search(found[0])
    if via is None:
        return None
    confidence = min(BARE_VALUE, runway_confidence(found[1]))
    read = Instruction(
        action, designator(found[1], found[2]), via=route_of(via[1]), confidence=confidence
    )
    return Read(read, segment.start, found.end())


def route_of(text: str) -> tuple[str, ...]:
    """Return the taxiways and numbered links among some words."""
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
        turn=cast("Turn | None", turn),
        immediate=is_immediate(segment, segment.found.end() + (found.end() if found else 0)),
        confidence=runway_confidence(number) if number else 1.0,
    )
    return Read(read, segment.start, segment.found.end() + (found.end() if found else 0))


def followed(segment: Segment, action: Action) -> Read | None:
    """Read whom a pilot follows on a route: "via B following the company embraer"."""
    is_route = _ROUTE_BEFORE.search(segment.text[: segment.start])
    return about_other(segment, action) if is_route else None


_ROUTE_BEFORE = re.compile(rf"(?<!\S)via {_LISTED}$")


def start_at(segment: Segment, action: Action) -> Read | None:
    """Read a start-up that waits for a time (ICAO Doc 4444, 12.3.4.1)."""
    read = Instruction(action, condition=f"at time{segment.found['time']}", confidence=SHORTENED)
    return Read(read, segment.start, segment.found.end())


def about_other(segment: Segment, action: Action) -> Read | None:
    """Read an action about another aircraft."""
    place = _PLACE.match(segment.after)
    words = place[1].strip() if place else None
    end = segment.found.end() + (place.end() if place else 0)
    read = Instruction(action, position=words, confidence=1.0 if words else NO_VALUE)
    to = _FOLLOWED_TO.match(segment.text, end, segment.limit) if action == "follow" else None
    if to is None:
        return Read(read, segment.start, end)
    route = Instruction("taxi", designator(*to.groups()), confidence=SHORTENED)
    return Read(read, segment.start, to.end(), (route,))


FORMS: Listed = (
    ("enter entering join joining make", "proceed",
     r"(?:(?:enter|join)(?:ing)?|make)(?: the| a)?(?: (?:left|right)(?: hand)?)?"
     r" (?:downwind|base|crosswind|final|pattern|traffic|360|orbit|turns|turn (?:on|out|to|into)"
     r"|short|straight)",
     nothing),
    ("proceed proceeding enter entering", "proceed", r"(?:proceed|enter)(?:ing)?", proceed),
    ("join joining", "taxi", rf"join(?:ing)?(?= (?:taxiway )?{LETTER})", on_taxiways),
    ("continue continuing", "taxi",
     r"continu(?:e|ing)(?: taxi)?(?: straight(?: ahead)?)?"
     rf"(?=(?: (?:on|via|along|down))? (?:taxiway )?{LETTER})",
     on_taxiways),
    ("turn left right", "taxi",
     r"(?:turn )?(?<!(?<!\S)[0-9] )(?<!(?<!\S)[0-9][0-9] )"
     rf"(?P<turns>(?:left|right)(?: (?:on|onto)|(?= {LETTER})) {_PIECE}"
     rf"(?:(?: (?:and|then|and then))?(?: turn)? (?:left|right)(?: on| onto)? {_PIECE})+)", turns),
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
    ("turn turning left right", "vacate",
     r"(?:turn(?:ing)? )?(?P<turn>left|right)(?: turn)?(?: (?:off )?(?:at|on|onto))?(?: the)?"
     r"(?: (?:first|next))? high speed(?: (?:exit|taxiway|turn ?off))?", vacate),
    ("left right", "vacate", r"(?P<turn>left|right)(?= when able)", vacate),
    ("off", "vacate",
     rf"(?<!turn )(?<!turning )(?<!level )(?<!take )(?<!\S)off(?= (?:at|on) {LETTER})", vacate),
    ("expedite", "vacate", r"expedite (?:vacat|exit)(?:e|ing)?(?: the runway)?", vacate),
    ("expedite", "expedite", r"expedite (?:your |the )?(?:taxi|crossing|backtrack|turn)", alone),
    ("turn turning", "vacate", r"turn(?:ing)? off(?: the runway)?", vacate),
    ("leave", "vacate", r"leave(?: the runway|(?= runway [0-9]))", vacate),
    ("get", "vacate", r"get off(?: the runway|(?= runway [0-9]))", vacate),
    ("taxi taxiing drive driving", "taxi",
     r"(?:(?<!continue )taxi(?:ing)?|driv(?:e|ing))"
     r"(?: (?:back|out|over|forward|up|ahead|straight)(?= (?:to(?! and)|into|onto|via|on)(?!\S)))*"
     rf"(?= (?:(?:taxiway )?{LETTER}|to|via|at|on|back|across|runway|holding|gate|stand|straight"
     r"|left|right|into|without|and|with|hold|[0-9]+|\|)(?!\S)|$)",
     taxi),
    ("continue", "taxi",
     r"continue(?: taxi(?:ing)?(?= to)"
     rf"|(?= to (?:the )?(?:holding (?:point|decimal)|{STAND})))", taxi),
    ("continue continuing resume resuming", "taxi",
     r"(?:continu|resum)(?:e|ing)(?: your| the)? taxi(?:ing)?", alone),
    ("return returning go going come head taxi drive", "taxi",
     r"(?:return(?:ing)?|(?:go|going|come|head|taxi|drive) back)"
     rf"(?= to (?:the |your )?(?:{_ON_GROUND}))", taxi),
    ("runway", "taxi",
     rf"(?<!to )(?<!taxi )(?<!decimal )runway {RUNWAY}"
     rf" via(?: (?!q n h)(?:and |taxiway )?{TAXIWAY})+", route),
    ("stop", "stop", r"stop(?: your| the)? taxi(?:ing)?(?! to| via)", alone),
    ("hold", "hold_position", r"hold (?:your|the) taxi", alone),
    ("stop", "stop",
     r"(?<!cleared )(?<!full )stop"
     r"(?! (?:on|at|squawk|over|and|turn(?! left| right)|climb|descent|your|heading|bar|bars|lights"
     r"|line)(?!\S))"
     r"(?: immediately)?",
     alone),
    ("stopping", "stop", r"stopping(?= \||$| immediately| on)", alone),
    ("pushback push", "push_back",
     r"push(?:back)?(?: (?:is )?(?:approved|at (?:your |own |pilot )+discretion)"
     r"|(?= and start(?:up)? (?:is )?approved))", alone),
    ("startup start", "start_up",
     r"start(?:up)? at(?: time)?(?P<time> [0-9]{2}(?:[0-9]{2})?)(?! (?:minutes?|miles?|decimal))",
     start_at),
    ("startup start", "start_up",
     r"start(?:up)? (?:is )?(?:approved|at (?:your |own |pilot )+discretion)", alone),
    ("push pushback", "push_back",
     r"push(?:back)?(?= and start(?:up)? at (?:your |own |pilot )+discretion)", alone),
    ("startup start", "start_up", r"start(?:up)?(?= and push(?:back)? (?:is )?approved)", alone),
    ("following", "follow", r"following(?= (?:the|that|company)(?!\S))", followed),
    ("follow", "follow", r"follow(?! (?:me|is|was|are|will)(?!\S))", about_other),
    ("give giving", "give_way", r"giv(?:e|ing) way(?: to)?", about_other),
    ("pass passing", "give_way", r"pass(?:ing)? behind", about_other),
)  # fmt: skip
"""Forms of movement on the ground."""
