"""Questions: what somebody is to say, can do, or is to confirm.

ICAO Annex 10 volume II, 5.2.1.8, has the radio check.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from airhilt.phraseology.approaches import NAMED_APPROACH, named_approach
from airhilt.phraseology.call import Action, Asks, Instruction
from airhilt.phraseology.forms import BARE_RUNWAY, LONG_NAME, Listed, Read, Segment
from airhilt.phraseology.slots import (
    FIX_ENDS,
    LETTER,
    LEVEL_WORDS,
    RUNWAY,
    designator,
    runway_confidence,
    taxiway,
)
from airhilt.phraseology.vertical import level_in

_ABLE = re.compile(
    r"(?<!\S)(?:(?:can|could|will|would) you(?: be able)?|are you able"
    r"|(?:advise|say|know|tell)(?: me| us)?(?: able| (?:if|whether)(?: you)?(?: (?:are|can|could))?"
    r"(?: able)?))(?: to)?(?: (?:accept|take|make|do|fly|give|me|us|the|an?|your|please|still"
    r"|now|just|land and))*$"
)
"""Words that lead to what somebody is asked to be able to do."""
_AFTERWARDS = re.compile(
    r"(?<!\S)(?:(?:are you )?able|can you (?:do|accept|take|make) (?:that|it))(?: \|)?$"
)
"""Words at the end of a call that make a question of what is before them."""
_DOES = re.compile(
    r"(?<!\S)(?:(?:confirm|verify)(?: that)?(?: you are| you)?|are you)(?: still| now)?$"
)
"""Words that lead to what somebody is asked to be doing."""
QUESTION = re.compile(
    r"\| (?:(?:[a-z]+ ){1,3}?(?:tower|ground|approach|departure|centre) )?"
    r"(?:(?:do|did|can|could|are|will|would|have|were) you|is that|what|where|which|how|who|why"
    r"|confirm|verify|say|advise (?:if|able|whether))(?!\S)"
)
"""Beginning of a call that asks somebody something."""
RADIO_CHECK = re.compile(r"(?<!\S)(?:radio check|how do you (?:read|hear|copy|receive))(?!\S)")
"""Words of a test of a radio (Annex 10 volume II, 5.2.1.8)."""
ADVISED = frozenset({"advise", "say", "know", "me", "us", "tell", "confirm"})
"""Words before an "if" that begins a question, not a condition."""


def asks(lead: Sequence[str], before: Asks | None) -> Asks | None:
    """Return what is asked about the action that words lead to; None if they ask nothing.

    Parameters
    ----------
    before
        What is asked about the action before it. A question what somebody can do goes on, because
        nothing that is only asked about may be done.
    """
    words = " ".join(lead)
    if _ABLE.search(words) or (before == "able" and not lead):
        return "able"
    if _DOES.search(words):
        return "doing"
    return before if words in ("and", "or", "and then", "then") else None


def is_asked_afterwards(text: str) -> bool:
    """Return whether a call ends with the question whether its last action can be done."""
    return _AFTERWARDS.search(text) is not None


def said(segment: Segment, action: Action) -> Read | None:
    """Read what is to be said at once, one thing or several."""
    first, *more = (
        Instruction(action, position=each[0]) for each in _THING.finditer(segment.found["things"])
    )
    return Read(first, segment.start, segment.found.end(), tuple(more))


def said_otherwise(segment: Segment, action: Action) -> Read | None:
    """Read something else that is to be said at once, in words."""
    read = Instruction(action, position=segment.found["thing"], confidence=LONG_NAME)
    return Read(read, segment.start, segment.found.end())


def ready(segment: Segment, action: Action) -> Read | None:
    """Read a question whether somebody is ready."""
    return _asked(segment, Instruction(action, position="ready"))


def confirmed_level(segment: Segment, action: Action) -> Read | None:
    """Read a question whether somebody is at a level, which its level answers."""
    return _asked(segment, Instruction(action, position="altitude"))


def seen(segment: Segment, action: Action) -> Read | None:
    """Read a question whether somebody sees something."""
    return _asked(segment, Instruction(action, position=f"{segment.found['thing']} in sight"))


def _asked(segment: Segment, about: Instruction) -> Read:
    return Read(about, segment.start, segment.found.end(), asks="doing")


def accepted_runway(segment: Segment, action: Action) -> Read | None:
    """Read a runway that somebody is asked to take instead."""
    number, side = segment.found.group(1, 2)
    sure = runway_confidence(number) if "runway" in segment.found[0] else BARE_RUNWAY
    read = Instruction(action, designator(number, side), confidence=sure)
    return Read(read, segment.start, segment.found.end())


def accepted_approach(segment: Segment, action: Action) -> Read | None:
    """Read an approach that somebody is asked to take."""
    del action
    read, end = named_approach(segment.found["approach"]), segment.found.end()
    beside = _TO_RUNWAY.match(segment.after)
    if read is None:
        return None
    if read.runway is None and beside:
        runway, sure = designator(*beside.groups()), runway_confidence(beside[1])
        read, end = replace(read, runway=runway, confidence=sure), end + beside.end()
    return Read(read, segment.start, end)


def accepted_level(segment: Segment, action: Action) -> Read | None:
    """Read a level that somebody is asked to take."""
    feet, confidence, end = level_in(segment.after, is_here=True)
    read = Instruction(action, altitude_ft=feet, confidence=confidence)
    return None if feet is None else Read(read, segment.start, segment.found.end() + end)


def accepted_exit(segment: Segment, action: Action) -> Read | None:
    """Read an exit of a runway that somebody is asked to take."""
    read = Instruction(action, position=taxiway(segment.found["place"]))
    return Read(read, segment.start, segment.found.end())


def accepted_takeoff(segment: Segment, action: Action) -> Read | None:
    """Read a take-off that somebody is asked to accept."""
    found = segment.found
    runway = designator(found["number"], found["side"]) if found["number"] else None
    read = Instruction(action, runway, immediate="immediate" in found[0])
    return Read(read, segment.start, segment.found.end())


_WHOSE = r"(?:(?:your|the|present|current|indicated|number of|total) )*"
_NAMES = (
    r"(?:(?:assigned )?(?:altitude|level|airspeed|speed|heading|track)"
    r"|position|location|intentions"
    r"|(?:aircraft )?type|mach(?: number)?|registration|destination"
    r"|(?:remaining )?fuel(?: remaining| on board| state| endurance)?|endurance"
    r"|(?:souls|persons|people|passengers|pob|p o b)(?: on board)?)(?!\S)"
)
_VALUED = r"(?! (?:[0-9]|to |or |at |of [0-9]))"
"""Pattern behind a name that no value follows, as one does in an instruction."""
_UNITS = r"(?: (?:leaving|aircraft|of aircraft)| in (?:pounds|minutes|hours|time|kilograms|kilos))?"
_THING = re.compile(_NAMES)
_THINGS = (
    rf"(?P<things>{_NAMES}{_VALUED}{_UNITS}"
    rf"(?: (?:(?:and|also|plus) )*{_WHOSE}{_NAMES}{_VALUED}{_UNITS})*)"
)
_ASKED = (
    r"(?:(?<=can you )|(?<=could you )|(?<=will you )|(?<=would you )|(?<=able )|(?<=able to ))"
)
_TAKE = r"(?:accept|take|make|do|use|fly|land(?: on)?|switch to|change to)"
_TAKEN = rf"{_ASKED}{_TAKE} (?:the |an? )?"
"""Pattern of what somebody is asked to accept."""
_NOT_TOLD = "again|all|that|it|when|if|able|callsign|call|your|frequency"
"""Words behind "say" that ask for words that were said, or for something else."""
_ACCEPTING = "accept take make do use fly land switch change"
_SEEN = (
    r"(?: (?:the|that|your|a))? (?P<thing>field|airport|aerodrome|runway|traffic)"
    r"(?: [0-9]{1,2})?(?: (?:left|right|centre))?"
)
_TO_RUNWAY = re.compile(rf" (?:(?:to|for) )?runway {RUNWAY}")
_RUNWAY = RUNWAY.replace("(0?", "(?P<number>0?", 1).replace("(left|", "(?P<side>left|", 1)

FORMS: Listed = (
    ("say", "say", rf"say {_WHOSE}{_THINGS}", said),
    ("confirm verify what", "say",
     rf"(?<=\| )(?:confirm|verify|what(?: is| are)?(?= your)) {_WHOSE}{_THINGS}", said),
    ("what", "say", rf"(?<=\| )what {_THINGS}(?= (?:are|do) you(?!\S))", said),
    ("confirm verify", "say",
     rf"(?<=\| )(?:confirm|verify)(?: you are)?(?: (?:level|at|maintaining|passing|leaving))*"
     rf" {LEVEL_WORDS}", confirmed_level),
    ("do have", "say", rf"(?:do you|have you)(?: (?:have|see|got))*{_SEEN}(?: in sight)?", seen),
    ("confirm verify say", "say",
     rf"(?:confirm|verify|say)(?: you)?(?: have| see)?{_SEEN} in sight", seen),
    ("are", "say",
     r"are you (?:still )?ready(?: (?:for|to) (?:(?:an|immediate|the) )*[a-z]+)?", ready),
    (_ACCEPTING, "cleared_approach",
     rf"{_TAKEN}(?P<approach>{NAMED_APPROACH.pattern})", accepted_approach),
    (_ACCEPTING, "cleared_to_land", rf"{_TAKEN}(?:runway )?{RUNWAY}", accepted_runway),
    (_ACCEPTING, "vacate",
     rf"{_TAKEN}(?:taxiway |exit )?(?P<place>{LETTER}(?: [0-9]{{1,2}}(?!\S))?)", accepted_exit),
    (_ACCEPTING, "altitude", rf"{_ASKED}{_TAKE}(?= {LEVEL_WORDS})", accepted_level),
    (f"{_ACCEPTING} immediate takeoff depart", "cleared_for_takeoff",
     rf"{_ASKED}(?:{_TAKE} (?:an )?)?(?:immediate )?(?:takeoff|depart(?:ure)?)"
     rf"(?: (?:from|on))?(?: runway {_RUNWAY})?", accepted_takeoff),
    ("say", "say",
     rf"(?<=\| )say (?:your |the )?(?P<thing>(?!(?:{_NOT_TOLD}|{FIX_ENDS})(?!\S))"
     rf"[a-z]+(?: (?!{FIX_ENDS}(?!\S))[a-z]+){{0,2}})", said_otherwise),
)  # fmt: skip
"""Forms of questions."""
