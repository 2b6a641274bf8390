"""Forms of actions: their words, and how their details are read.

The forms are those of ICAO Doc 4444, chapter 12, and FAA Order JO 7110.65, chapter 2, section 4,
and chapter 3, sections 7 to 10, and what people say instead.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple, cast

from airhilt.phraseology.call import Action, Instruction, Sense, Turn
from airhilt.phraseology.slots import (
    BARE_FEET,
    FREQUENCY,
    GROUND_MHZ,
    JOINED_FREQUENCY,
    LEVEL,
    NAMED_RUNWAY,
    RUNWAY,
    SHORT_FREQUENCY,
    SHORTENED,
    TAXIWAY,
    designator,
    feet_confidence,
    frequency_khz,
    level_confidence,
    level_ft,
    runway_confidence,
    taxiway,
)

BARE_RUNWAY = 0.85
"""Confidence in a runway that is said without the word."""
NO_RUNWAY = 0.75
"""Confidence in an action on a runway that is not named."""
NO_VALUE = 0.6
"""Confidence in an action whose level, heading or frequency is missing."""
BARE_VALUE = 0.85
"""Confidence in a value that is said without its word."""

ANIMALS = (
    "deer", "coyote", "fox", "dog", "animal", "wildlife", "geese", "goose", "gull", "gulls",
    "bird", "birds", "flock",
)  # fmt: skip
UNITS = (
    "tower", "ground", "approach", "departure", "centre", "control", "radar", "director",
    "delivery", "apron", "ramp", "information", "radio",
)  # fmt: skip
"""Last words of callsigns of stations (ICAO Annex 10 volume II, 5.2.1.7.1.2)."""


class Segment(NamedTuple):
    """The words of an action, and those around it that may hold its runway and its values."""

    found: re.Match[str]
    text: str
    """Text of the whole call."""
    begin: int
    """Begin of the words before the action that belong to no other action."""
    limit: int
    """Begin of the next action."""

    @property
    def start(self) -> int:
        """Begin of the action's own words."""
        return self.found.start()

    @property
    def after(self) -> str:
        """The words after the action, up to the next."""
        return self.text[self.found.end() : self.limit]


class Read(NamedTuple):
    """An instruction, with the begin and the end of its words."""

    instruction: Instruction
    start: int
    end: int


Builder = Callable[[Segment, Action], Read | None]


class Form(NamedTuple):
    """One form of an action: a pattern of its words, and the function that reads its details."""

    action: Action
    words: re.Pattern[str]
    build: Builder


_BEFORE = re.compile(rf"(?<!\S)runway {RUNWAY}(?: (?:at|from) (?P<place>{TAXIWAY}))?$")
_BARE_AFTER = re.compile(rf" (?:on )?{RUNWAY}")
_OTHER_RUNWAY = re.compile(
    r"^ runway(?!\S)|(?<!\S)(?:hold|short|of|final|base|downwind|clear|crossing)(?!\S)"
)
"""Words before a runway that is not that of the action, or after one that cannot be read."""
_POSITION = re.compile(rf" (?:at|from) (?:taxiway |intersection )?({TAXIWAY})")
_POINT = re.compile(rf" (?:at |of )?(?:taxiway |intersection |point )?({TAXIWAY})")
_VIA = re.compile(rf"(?<!\S)via ((?:(?:and |taxiway )?{TAXIWAY}(?: |$))+)")
_EACH_TAXIWAY = re.compile(TAXIWAY)
_PLACE = re.compile(r" (?:to )?(?:the )?((?:[a-z]+ ?){1,4}(?:[0-9]+)?)")
_TAXI_TO = re.compile(
    r"(?!.* (?:runway|not)(?!\S)) to (?:the )?((?:[a-z]+ ?){1,4}(?:[0-9]+)?)(?=$| )"
)
_IMMEDIATE = re.compile(r"(?<!\S)(?:immediate(?:ly)?|expedit(?:e|ing)|now)(?!\S)")
_WITHOUT_DELAY = re.compile(r" (?:immediately|without delay|expedite|now)(?!\S)")


def _is_immediate(segment: Segment, end: int) -> bool:
    """Return whether the words of an action, or those right after them, demand it at once."""
    after = _WITHOUT_DELAY.match(segment.text, end, segment.limit)
    return bool(after or _IMMEDIATE.search(segment.text[segment.start : end]))


def _on_runway(segment: Segment, action: Action) -> Read | None:
    """Read an action on a runway, which is named right before it or after it.

    The action is not read if two different runways are named.
    """
    inside = NAMED_RUNWAY.search(segment.found[0])
    before = _BEFORE.search(segment.text[segment.begin : segment.start].rstrip())
    after = _runway_after(segment)
    told = [designator(*each.groups()[:2]) for each in (inside, before, after) if each]
    start, end = segment.start, segment.found.end()
    if before:
        start = segment.begin + before.start()
    if after:
        end += after.end()
    if len(set(told)) > 1:
        return None
    place = before and before["place"]
    place_after = _POSITION.match(segment.text, end, segment.limit)
    if place_after:
        place, end = place_after[1], place_after.end()
    confidences = [runway_confidence(each[1]) for each in (inside, before, after) if each]
    if after is not None and after.re is _BARE_AFTER and len(told) == 1:
        confidences.append(BARE_RUNWAY)
    read = Instruction(
        action,
        told[0] if told else None,
        taxiway(place) if place else None,
        immediate=_is_immediate(segment, end),
        confidence=min(confidences, default=NO_RUNWAY),
    )
    return Read(read, start, end)


def _runway_after(segment: Segment) -> re.Match[str] | None:
    """Return the runway that is named after an action and does not belong to the next one."""
    bare = _BARE_AFTER.match(segment.after)
    if bare:
        return bare
    named = NAMED_RUNWAY.search(segment.after)
    if named and _OTHER_RUNWAY.search(segment.after[: named.start()]):
        return None
    has_one = NAMED_RUNWAY.search(segment.found[0]) or _BEFORE.search(
        segment.text[segment.begin : segment.start].rstrip()
    )
    if named and has_one:
        is_next = segment.limit < len(segment.text) and _BEFORE.search(segment.after.rstrip())
        is_beside = segment.after[: named.start()].strip() in ("", "on")
        return named if is_beside and not is_next else None
    return named


def _alone(segment: Segment, action: Action) -> Read | None:
    """Read an action without details."""
    return Read(Instruction(action), segment.start, segment.found.end())


def _go_around(segment: Segment, action: Action) -> Read | None:
    is_next = segment.limit < len(segment.text) and _BEFORE.search(segment.after.rstrip())
    beside = None if is_next else re.match(rf" (?:on )?runway {RUNWAY}", segment.after)
    runway = designator(*beside.groups()) if beside else None
    end = segment.found.end() + (beside.end() if beside else 0)
    confidence = runway_confidence(beside[1]) if beside else 1.0
    return Read(Instruction(action, runway, confidence=confidence), segment.start, end)


def _hold_short(segment: Segment, action: Action) -> Read | None:
    point = _POINT.match(segment.after)
    if point is None:
        return _on_runway(segment, action)
    held = Instruction(action, hold_short=taxiway(point[1]))
    return Read(held, segment.start, segment.found.end() + point.end())


def _proceed(segment: Segment, action: Action) -> Read | None:
    if NAMED_RUNWAY.search(segment.after):
        return _on_runway(segment, action)
    return _taxi(segment, "taxi") if re.match(r" (?:to|via)(?!\S)", segment.after) else None


def _taxi(segment: Segment, action: Action) -> Read | None:
    after = segment.after
    runway = re.match(rf"(?: to)?(?: the)?(?: holding point)? runway {RUNWAY}", after)
    via = _VIA.search(after)
    point = re.match(rf" (?:to|at) (?:taxiway |holding point )?({TAXIWAY})", after)
    to = re.split(r" (?:via|and|at|on)(?!\S)", after)[0]
    place = None if runway or point else _TAXI_TO.match(to)
    position = taxiway(point[1]) if point else place[1].strip() if place else None
    taken = max((each.end() for each in (runway, via, point) if each), default=0)
    is_read = bool(runway or position or (via and not to.strip()))
    confidence = runway_confidence(runway[1]) if runway else 1.0 if is_read else NO_VALUE
    read = Instruction(
        action,
        designator(*runway.groups()) if runway else None,
        position,
        via=tuple(taxiway(each) for each in _EACH_TAXIWAY.findall(via[1])) if via else (),
        confidence=confidence,
    )
    return Read(read, segment.start, segment.found.end() + taken)


def _vacate(segment: Segment, action: Action) -> Read | None:
    found = re.match(
        rf"(?: runway {RUNWAY})?(?: next)?(?: to the)?(?: (left|right)(?!\S))?"
        rf"(?: (?:at |via |on )?(?:taxiway )?({TAXIWAY}))?",
        segment.after,
    )
    number, side, turn, exit_ = found.groups() if found else (None,) * 4
    read = Instruction(
        action,
        designator(number, side) if number else None,
        taxiway(exit_) if exit_ else None,
        turn=cast(Turn | None, turn),
        immediate=_is_immediate(segment, segment.found.end()),
        confidence=runway_confidence(number) if number else 1.0,
    )
    return Read(read, segment.start, segment.found.end() + (found.end() if found else 0))


def _about_other(segment: Segment, action: Action) -> Read | None:
    place = _PLACE.match(segment.after)
    words = place[1].strip() if place else None
    end = segment.found.end() + (place.end() if place else 0)
    read = Instruction(action, position=words, confidence=1.0 if words else NO_VALUE)
    return Read(read, segment.start, end)


def _altitude(segment: Segment, action: Action) -> Read | None:
    words = segment.found[0].split()
    head = next((word[:5] for word in words if word[:5] in _SENSES), "maint")
    sense = "maintain" if words[0] in ("stop", "level") else _SENSES[head]
    level = LEVEL.search(segment.after)
    bare = BARE_FEET.match(segment.after)
    feet = level_ft(level) if level else float(bare[1]) if bare else None
    if feet is None and sense == "maintain":
        return None
    value = level or bare
    end = segment.found.end() + (value.end() if value else 0)
    confidence = NO_VALUE
    if feet is not None:
        confidence = level_confidence(level) if level else feet_confidence(feet)
    read = Instruction(
        action,
        sense=sense,
        altitude_ft=feet,
        immediate=_is_immediate(segment, end),
        confidence=confidence,
    )
    return Read(read, segment.start, end)


_SENSES: dict[str, Sense] = {"climb": "climb", "desce": "descend", "maint": "maintain"}


def _heading(segment: Segment, action: Action) -> Read | None:
    parts = segment.found.groupdict()
    number = parts.get("number")
    heading = float(number) if number and 0 < int(number) <= 360 else None
    if number and heading is None:
        return None
    turn = cast(Turn | None, parts.get("turn"))
    kept = parts.get("kept")
    at = _POSITION.match(segment.after) if turn and heading is None else None
    read = Instruction(
        action,
        position=f"{kept} heading" if kept else taxiway(at[1]) if at else None,
        turn=turn,
        heading_deg=heading,
        immediate=_is_immediate(segment, segment.found.end()),
        confidence=1.0 if heading is not None or kept or at else NO_VALUE,
    )
    return Read(read, segment.start, segment.found.end() + (at.end() if at else 0))


def _speed(segment: Segment, action: Action) -> Read | None:
    number = segment.found.groupdict().get("number")
    confidence = SHORTENED if number and len(number) == 2 else 1.0
    read = Instruction(action, speed_kt=float(number) if number else None, confidence=confidence)
    return Read(read, segment.start, segment.found.end())


def _squawk(segment: Segment, action: Action) -> Read | None:
    read = Instruction(action, squawk=segment.found["code"])
    return Read(read, segment.start, segment.found.end())


_STATION = re.compile(rf" ((?:[a-z]+ ){{0,3}}?(?:{'|'.join(UNITS)}))(?!\S)")


def _contact(segment: Segment, action: Action) -> Read | None:
    after = segment.after
    station = _STATION.match(after)
    full, joined = FREQUENCY.search(after), JOINED_FREQUENCY.search(after)
    short = SHORT_FREQUENCY.search(after) if station and "ground" in station[1] else None
    khz, confidence, found = None, NO_VALUE, None
    if full:
        khz, confidence, found = frequency_khz(full[1], full[2]), 1.0, full
    elif short:
        khz, confidence, found = frequency_khz(GROUND_MHZ, short[1]), BARE_VALUE, short
    elif joined and station:
        khz, confidence, found = frequency_khz(joined[1], joined[2]), BARE_VALUE, joined
    if station is None and khz is None:
        return None
    read = Instruction(
        action,
        position=station[1] if station else None,
        frequency_khz=khz,
        confidence=confidence if khz else NO_VALUE,
    )
    end = max((each.end() for each in (station, found) if each), default=0)
    return Read(read, segment.start, segment.found.end() + end)


def _frequency(segment: Segment, action: Action) -> Read | None:
    """Read a frequency that is given or read back, alone or after its station."""
    khz = frequency_khz(segment.found[1], segment.found[2])
    if khz is None:
        return None
    ahead = segment.text[segment.begin : segment.start].rstrip()
    station = re.search(rf"(?<!\S)(?:[a-z]+ )?(?:{'|'.join(UNITS)})(?: on)?$", ahead)
    name = station[0].removesuffix(" on") if station else None
    read = Instruction(action, position=name, frequency_khz=khz, confidence=BARE_VALUE)
    return Read(read, segment.begin + station.start() if station else segment.start,
                segment.found.end())  # fmt: skip


def _approach(segment: Segment, action: Action) -> Read | None:
    read = _on_runway(segment, action)
    if read is None:
        return None
    kind = segment.found["kind"]
    told = Instruction(
        action,
        read.instruction.runway,
        approach=kind.replace(" ", "") if kind else None,
        confidence=read.instruction.confidence,
    )
    return Read(told, read.start, read.end)


def _place(segment: Segment, action: Action) -> Read | None:
    """Read an action with its place or state in words."""
    said = re.match(r"((?: (?!via |and |then |turn )[a-z0-9]+){1,5})", segment.after)
    if not said:
        return None
    read = Instruction(action, position=said[1].strip())
    return Read(read, segment.start, segment.found.end() + said.end())


def _wildlife(segment: Segment, action: Action) -> Read | None:
    """Read a report of wildlife, which counts even without a place."""
    read = _on_runway(segment, action)
    if read is None:
        return Read(Instruction(action, confidence=NO_RUNWAY), segment.start, segment.found.end())
    told = read.instruction
    confidence = 1.0 if told.runway is None else told.confidence
    return Read(Instruction(action, told.runway, told.position, confidence=confidence), *read[1:])


_CLEAR = r"clear(?:ed)?"
_NAMED = r"runway [0-9]{1,2}(?: (?:left|right|centre|l|r|c))?"
_INSIDE = rf"(?:{_NAMED} )?"
_ANIMAL = "|".join(ANIMALS)
_SPEED = r"(?P<number>[1-9][0-9]{2}|[6-9][0-9])(?!\S)(?! (?:feet|thousand|degrees|miles?))"
_HEADING = r"(?P<number>[0-9]{3})(?!\S)(?! (?:knots|thousand|feet|miles?))"
_APPROACH = "i l s|ils|visual|r nav|rnav|r n p|rnp|localizer|localiser|v o r|vor|gps|g p s|circling"

_FORMS: tuple[tuple[str, Action, str, Builder], ...] = (
    ("clear cleared", "touch_and_go", rf"{_CLEAR} (?:for )?(?:a |the )?touch and go", _on_runway),
    ("clear cleared", "cleared_option", rf"{_CLEAR} (?:for )?(?:the )?option", _on_runway),
    ("clear cleared", "low_approach", rf"{_CLEAR} (?:for )?(?:a |the )?low approach", _on_runway),
    ("clear cleared", "cleared_for_takeoff",
     rf"{_CLEAR} (?:for )?{_INSIDE}(?:for )?(?:an |the )?(?:immediate )?takeoff", _on_runway),
    ("clear cleared", "cleared_to_land", rf"{_CLEAR} {_INSIDE}(?:(?:to )?land|for landing)",
     _on_runway),
    ("clear cleared", "cleared_approach",
     rf"{_CLEAR} (?:for )?(?:the )?(?:straight in )?(?P<kind>{_APPROACH})(?: {_NAMED})?"
     r"(?: approach)?",
     _approach),
    ("clear cleared", "direct", rf"{_CLEAR} (?:to proceed )?direct(?: to)?", _place),
    ("line lining", "line_up", r"(?:line|lining) up(?: and wait(?:ing)?)?", _on_runway),
    ("position", "line_up", r"position and hold", _on_runway),
    ("hold holding", "hold_short", r"hold(?:ing)? short(?: of)?", _hold_short),
    ("continue remain", "hold_position", r"(?:continue|remain) holding", _alone),
    ("holding", "hold_position", r"holding(?= \||$)", _alone),
    ("hold holding", "hold_position", r"hold(?:ing)? (?:your |my |present )?position", _alone),
    ("cross crossing", "cross", r"cross(?:ing)?(?= runway| [0-9])", _on_runway),
    ("proceed proceeding", "direct", r"proceed(?:ing)? direct(?: to)?", _place),
    ("proceed proceeding enter entering", "proceed", r"(?:proceed|enter)(?:ing)?", _proceed),
    ("cancel cancelling abort aborting reject rejecting abandon abandoning", "cancel_takeoff",
     r"(?:cancel|abort|reject|abandon)(?:ling|ing)? (?:your |the |my )?takeoff(?: clearance)?",
     _alone),
    ("takeoff", "cancel_takeoff", r"takeoff clearance (?:is |has been )?cancelled", _alone),
    ("cancel cancelling", "cancel_landing",
     r"cancel(?:ling)? (?:your |the |my )?landing(?: clearance)?", _alone),
    ("landing", "cancel_landing", r"landing clearance (?:is |has been )?cancelled", _alone),
    ("go going", "go_around", r"go(?:ing)? around", _go_around),
    ("continue continuing", "continue_approach", r"continu(?:e|ing) (?:the |your )?approach",
     _go_around),
    ("vacate vacating exit exiting", "vacate", r"(?:vacat(?:e|ing)|exit(?:ing)?)(?: the runway)?",
     _vacate),
    ("expedite", "vacate", r"expedite (?:vacating|exiting)(?: the runway)?", _vacate),
    ("turn turning", "vacate", r"turn(?:ing)? off(?: the runway)?", _vacate),
    ("leave", "vacate", r"leave the runway", _vacate),
    ("backtrack backtracking", "backtrack", r"backtrack(?:ing)?", _on_runway),
    ("taxi", "line_up", r"taxi into position and hold", _on_runway),
    ("taxi taxiing drive driving", "taxi", r"(?:taxi(?:ing)?|driv(?:e|ing))", _taxi),
    ("stop", "altitude", r"stop (?:your )?(?:climb|descent|descend)(?: at| and maintain)?",
     _altitude),
    ("stop", "stop", r"stop(?! (?:on|at|squawk|over|and))(?: immediately)?", _alone),
    ("pushback", "push_back", r"pushback (?:is )?approved", _alone),
    ("startup", "start_up", r"startup (?:is )?approved", _alone),
    ("follow", "follow", r"follow(?! me)", _about_other),
    ("give giving", "give_way", r"giv(?:e|ing) way(?: to)?", _about_other),
    ("climb climbing descend descending", "altitude",
     r"(?:climb|descend)(?:ing)?(?! rate)(?: to)?(?: and maintain(?:ing)?)?", _altitude),
    ("expedite expediting", "altitude",
     r"expedit(?:e|ing) (?:your |the )?(?:climb|descent|descend)(?: through| to| and maintain)?",
     _altitude),
    ("maintain maintaining", "heading", r"maintain(?:ing)? (?P<kept>runway|present) heading",
     _heading),
    ("maintain maintaining", "speed",
     rf"maintain(?:ing)? (?:speed )?{_SPEED} (?:knots|speed|or greater|or less)", _speed),
    ("maintain maintaining", "altitude", r"maintain(?:ing)?(?: at| altitude)?", _altitude),
    ("level", "altitude", r"level off(?: at)?", _altitude),
    ("turn turning", "heading",
     rf"turn(?:ing)? (?P<turn>left|right)(?! base| downwind| final)(?: now| immediately)?"
     rf"(?: to)?(?: heading)?(?: {_HEADING})?", _heading),
    ("left right", "heading", rf"(?P<turn>left|right)(?: to)? heading {_HEADING}", _heading),
    ("fly flying", "heading", rf"fly(?:ing)? heading {_HEADING}", _heading),
    ("fly flying continue", "heading",
     r"(?:fly(?:ing)?|continue) (?P<kept>runway|present) heading", _heading),
    ("heading", "heading", rf"heading {_HEADING}", _heading),
    ("reduce reducing increase increasing slow slowing", "speed",
     rf"(?:reduc|increas|slow)(?:e|ing)?(?: your)?(?: speed)?(?: down)?(?: to)? {_SPEED}"
     r"(?: knots)?", _speed),
    ("speed", "speed", rf"speed(?: to)? {_SPEED}(?: knots)?", _speed),
    ("resume", "speed", r"resume (?:normal|your) speed", _speed),
    ("resume", "own_navigation", r"resume (?:your )?own navigation", _alone),
    ("direct", "direct", r"direct(?: to)?", _place),
    ("squawk squawking", "squawk", r"squawk(?:ing)? (?P<code>[0-7]{4})", _squawk),
    ("contact contacting call", "contact", r"(?:contact(?:ing)?|call)", _contact),
    ("over switch switching change changing", "contact",
     r"(?:over|switch(?:ing)?|chang(?:e|ing))(?: over)?(?: to)?", _contact),
    ("monitor monitoring", "monitor", r"monitor(?:ing)?", _contact),
    ("stand standby", "stand_by", r"stand ?by(?! for)", _alone),
    ("report", "report", r"(?<!wildlife )(?<!pilot )(?<!bird )(?<!weather )report", _place),
    (" ".join(ANIMALS), "wildlife_gone",
     rf"(?:{_ANIMAL})(?!\S)(?: \S+)*? (?:(?:has|have) left|gone|(?:is|are) clear)", _wildlife),
    (" ".join(ANIMALS), "wildlife",
     rf"(?:{_ANIMAL})(?!\S)(?! strike)(?: (?:\S+ )*(?:{_ANIMAL}))?", _wildlife),
)  # fmt: skip


def _by_first_word() -> dict[str, tuple[Form, ...]]:
    forms: dict[str, list[Form]] = {}
    for words, action, pattern, build in _FORMS:
        form = Form(action, re.compile(rf"{pattern}(?!\S)"), build)
        for word in words.split():
            forms.setdefault(word, []).append(form)
    return {word: tuple(listed) for word, listed in forms.items()}


FORMS = _by_first_word()
"""Forms of actions, by their first words."""
FREQUENCY_FORM = Form("contact", FREQUENCY, _frequency)
"""Form of a frequency without an action."""
