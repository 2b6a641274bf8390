"""Forms of headings, directs and holds.

FAA Order JO 7110.65, 5-6-2, 4-4-1, 4-6-1; ICAO Doc 4444, 12.4.1.3, 12.3.2.3, 12.3.3.3.
"""

from __future__ import annotations

import re
from typing import cast

from airhilt.phraseology.call import Action, Instruction, Turn
from airhilt.phraseology.forms import (
    BARE_VALUE,
    NO_VALUE,
    UNIT,
    Form,
    Listed,
    Read,
    Segment,
    alone,
    fix_of,
    is_immediate,
    nothing,
)
from airhilt.phraseology.slots import FIX, LETTER, NO_SENSE, SHORTENED, TAXIWAY, taxiway


def heading(segment: Segment, action: Action) -> Read | None:
    """Read a heading, a turn without one, or a heading that is kept."""
    parts = segment.found.groupdict()
    number = parts.get("number")
    has_sense = number is not None and 0 < int(number) <= 360
    turn = cast("Turn | None", parts.get("turn"))
    kept = parts.get("kept")
    at = _TURN_AT.match(segment.after) if turn and number is None else None
    taxiway_at = at[2] if at else None
    is_cut = at is not None and segment.after[at.end() : at.end() + 2].strip().isdigit()
    confidence = 1.0 if has_sense or kept or (at and not is_cut) else NO_VALUE
    if turn is None and _TURN.search(segment.before):
        confidence = NO_VALUE  # The side of the turn was not understood.
    if "bare" in parts or (at and at["bare"] is not None):
        is_north = turn is not None and number == "360"  # It may be a full turn.
        confidence = min(confidence, SHORTENED if is_north else BARE_VALUE)
    read = Instruction(
        action,
        position=f"{kept} heading" if kept else taxiway(taxiway_at) if taxiway_at else None,
        turn=turn,
        heading_deg=float(number) if number and has_sense else None,
        immediate=is_immediate(segment, segment.found.end()),
        confidence=confidence if has_sense or not number else NO_SENSE,
    )
    return Read(read, segment.start, segment.found.end() + (at.end() if at else 0))


def taxiway_turn(segment: Segment, action: Action) -> Read | None:
    """Read a turn at a taxiway without its verb: off a runway, or on the route."""
    found = segment.found
    turn = cast(Turn, found["turn"])
    read = Instruction(action, position=taxiway(found["at"]), turn=turn, confidence=SHORTENED)
    return Read(read, segment.start, found.end())


def turn_by(segment: Segment, action: Action) -> Read | None:
    """Read a turn by a number of degrees."""
    degrees = float(segment.found["degrees"])
    read = Instruction(
        action,
        turn=cast(Turn, segment.found["turn"]),
        turn_deg=degrees,
        confidence=1.0 if 0.0 < degrees <= 180.0 else NO_SENSE,
    )
    return Read(read, segment.start, segment.found.end())


_AFTER_CONDITION = re.compile(r"# (?:then |proceed |cleared )?$")
"""A condition right before an action, which may name its fix."""


def direct(segment: Segment, action: Action) -> Read | None:
    """Read a fix to go to."""
    fix, confidence = fix_of(segment)
    if fix is None and not _AFTER_CONDITION.search(segment.before_all):
        return None
    turn = cast("Turn | None", segment.found.groupdict().get("turn"))
    read = Instruction(action, position=fix, turn=turn, confidence=confidence)
    return Read(read, segment.start, segment.found.end())


def hold_at(segment: Segment, action: Action) -> Read | None:
    """Read a hold at a fix, with the side of its turns."""
    fix, confidence = fix_of(segment)
    turn = cast("Turn | None", segment.found["turn"])
    if turn is None and ON_GROUND.search(segment.before_all):
        held = Instruction("hold_short", hold_short=fix, confidence=confidence)
        return Read(held, segment.start, segment.found.end())
    read = Instruction(action, position=fix, turn=turn, confidence=confidence)
    return Read(read, segment.start, segment.found.end())


ON_GROUND = re.compile(
    rf"(?<!\S)(?:taxi(?:ing)?|link|holding (?:point|decimal)|stand|gate|push(?:back)?|cross runway"
    rf"|via {LETTER}|{LETTER} {LETTER})(?!\S)"
)
"""Words of a taxi clearance, behind which a hold at a name is no holding pattern."""
_HEADING = (
    r"(?P<number>[0-9]{3})(?!\S)(?! (?:knots|thousand|feet|miles?|decimal))"
    r"(?: degrees(?! (?:left|right)))?"
)
_TURN_AT = re.compile(
    rf" (?:(?:at|from|on|onto|on to) (?!a (?!\||$))(?:taxiway |intersection )?"
    rf"|(?P<bare>(?={LETTER}(?: [0-9]+)?(?! {LETTER}))))({TAXIWAY})"
)
_TURN = re.compile(r"(?<!\S)(?:turn|(?<![0-9] )(?:left|right))(?: [a-z]+)?$")
_COMPASS = r"(?:north|south)?(?:east|west|north|south)?"
_TRACK = (
    r"(?: (?:on the )?(?:inbound (?:track|course|heading) )?[0-9]{1,3}(?: degrees)?"
    r" (?:radial|course|bearing|inbound)| (?:on the )?inbound (?:track|course|heading) [0-9]{3}"
    r"(?: degrees)?)"
)
_TURNS = (
    rf"{_TRACK}?(?: as published)?"
    r"(?: [0-9]{1,2} (?:miles?|minutes?)(?: legs?)?)?"
    r"(?: (?P<turn>left|right)(?: hand)? (?:turns?|pattern|circuits?))?"
)
_NO_RUNWAY = r"(?<!runway )(?<!short of )(?<!short )(?<!cross )(?<!crossing )"
"""Nothing before that makes a runway of a number and a side."""
_DIRECT = r"(?:(?:proceed(?:ing)?|clear(?:ed)?(?: to proceed)?|then) )?direct(?: to)?"

FORMS: Listed = (
    ("clear cleared", "direct",
     rf"clear(?:ed)? (?:to proceed )?direct(?: to)?(?: the)?(?: (?P<fix>{FIX}))?", direct),
    ("clear cleared", "hold_at",
     rf"clear(?:ed)? to (?P<fix>{FIX}) hold(?: {_COMPASS})?{_TURNS}", hold_at),
    ("hold holding", "hold_at",
     rf"hold(?:ing)?(?: as published)?(?: {_COMPASS}(?: of)?| at| over)"
     rf" (?P<fix>(?!position|short|for){FIX}){_TURNS}",
     hold_at),
    ("proceed proceeding", "direct",
     rf"proceed(?:ing)? direct(?: to)?(?: the)?(?: (?P<fix>{FIX}))?",
     direct),
    ("maintain maintaining fly flying continue present runway", "heading",
     r"(?:(?:maintain|fly)(?:ing)? |continue )?(?P<kept>runway|present) heading", heading),
    ("turn turning", "turn_by",
     r"turn(?:ing)? (?P<degrees>[0-9]{1,3}) degrees (?:to the )?(?P<turn>left|right)", turn_by),
    ("turn turning", "turn_by", r"turn(?:ing)? (?P<degrees>[1-9][05]) (?P<turn>left|right)",
     turn_by),
    ("10 15 20 30", "turn_by",
     rf"{_NO_RUNWAY}(?P<degrees>[0-9]{{2}}) (?P<turn>left|right)"
     r"(?= for (?:traffic|spacing|sequenc)\S*)", turn_by),
    ("turn turning", "turn_by",
     r"turn(?:ing)? (?P<turn>left|right) (?P<degrees>[0-9]{1,2}) degrees", turn_by),
    (" ".join(str(degrees) for degrees in range(5, 185, 5)), "turn_by",
     r"(?<!up to )(?P<degrees>[0-9]{1,3}) degrees (?P<turn>left|right)"
     r"(?! (?:of|for|deviation)(?!\S))",
     turn_by),
    ("turn turning", "direct",
     rf"turn(?:ing)? (?P<turn>left|right)(?: now| immediately)? {_DIRECT} (?P<fix>{FIX})", direct),
    ("turn turning", "heading",
     rf"turn(?:ing)? (?P<turn>left|right)(?! base| downwind| final| crosswind)"
     rf"(?: now| immediately)?(?: to)?(?: heading)?(?: {_HEADING})?", heading),
    ("make making", "direct",
     rf"mak(?:e|ing)(?: a| your)? (?P<turn>left|right) turn {_DIRECT} (?P<fix>{FIX})", direct),
    ("make making", "heading",
     r"mak(?:e|ing)(?: a| your)? (?P<turn>left|right) turn"
     r"(?! (?:out|on|to|at|into|onto|base|final)(?!\S))"
     rf"(?: to)?(?: heading)?(?: {_HEADING})?", heading),
    ("left right", "heading",
     r"(?<!all )(?P<turn>left|right)(?: turn)?(?: now| immediately)?(?: to)?(?: a)?"
     rf" heading {_HEADING}",
     heading),
    ("left right", "heading",
     r"(?:(?<!(?<!\S)[0-9] )(?<!(?<!\S)[0-9][0-9] )|(?=[a-z]+ turn))(?<!all )"
     r"(?!(?:left|right) 360 for)"
     rf"(?P<turn>left|right)(?: turn)?(?: to)? (?P<bare>){_HEADING}", heading),
    ("left right", "heading",
     r"(?<!(?<!\S)[0-9] )(?<!(?<!\S)[0-9][0-9] )(?P<turn>left|right)(?: turn(?= at))?"
     rf"(?: (?:on|onto|at)(?= {LETTER})"
     rf"|(?= {LETTER}(?: [0-9]{{1,2}})?(?: (?:short|hold|contact|{UNIT}|\|)|$)))"
     rf" (?P<at>{TAXIWAY})", taxiway_turn),
    ("stop", "heading", rf"stop (?:the |your )?turn(?: at| on)?(?: heading)? {_HEADING}", heading),
    ("fly flying", "heading", rf"fly(?:ing)? heading {_HEADING}", heading),
    ("heading", "heading", rf"heading {_HEADING}", heading),
    ("resume own", "own_navigation", r"(?:resume (?:your )?)?own (?:navigation|nav)", alone),
    ("direct", "direct", rf"direct(?: to)?(?: the)?(?: (?P<fix>{FIX}))?", direct),
    ("intercept", "heading", r"intercept", nothing),
)  # fmt: skip
"""Forms of headings, directs and holds."""
ON_HEADING_FORM = Form(
    "heading", re.compile(r"(?P<bare>)(?P<number>[0-9]{3}) on the heading(?!\S)"), heading
)
"""Form of a heading that is read back as "two seven zero on the heading"."""
