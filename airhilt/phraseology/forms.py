"""Forms of actions: their words, and the pieces that read their details.

The forms of each subject are in a module of its own (`runways`, `ground`, `vertical`, `lateral`,
`speeds`, `approaches`, `surveillance`, `expectations`). `actions` lists them all.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple

from airhilt.phraseology.call import Action, Asks, Instruction
from airhilt.phraseology.hits import STATIONS
from airhilt.phraseology.patterns import LatePattern
from airhilt.phraseology.slots import (
    FIX_ENDS,
    NAMED_RUNWAY,
    RUNWAY,
    TAXIWAY,
    designator,
    runway_confidence,
    taxiway,
)

BARE_RUNWAY = 0.85
"""Confidence in a runway that is said without the word."""
NO_RUNWAY = 0.75
"""Confidence in an action on a runway that is not named."""
NO_VALUE = 0.6
"""Confidence in an action whose level, heading or frequency is missing or makes no sense."""
BARE_VALUE = 0.85
"""Confidence in a value that is said without its word."""
LONG_NAME = 0.75
"""Confidence in a name of a fix of three words, which may have a word that is not its own."""

DEPARTED = "after departure"
"""Condition of what a clearance before departure says."""
UNITS = tuple(sorted(STATIONS - {"clearance", "final"}))
"""Last words of callsigns of stations (ICAO Annex 10 volume II, 5.2.1.7.1.2)."""
UNIT = "|".join(UNITS)


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

    @property
    def before(self) -> str:
        """The words before the action that belong to no other action."""
        return self.text[self.begin : self.start].rstrip()

    @property
    def before_all(self) -> str:
        """All words of the call before the action."""
        return self.text[: self.start]


class Read(NamedTuple):
    """An instruction, with the begin and the end of its words."""

    instruction: Instruction
    start: int
    end: int
    more: tuple[Instruction, ...] = ()
    """Other instructions of the same words."""
    is_expected: bool = False
    """True if the words say what is to be expected."""
    asks: Asks | None = None
    """Subject of the question that the words ask; None if they do not ask by themselves."""


Builder = Callable[[Segment, Action], Read | None]


class Form(NamedTuple):
    """One form of an action: a pattern of its words, and the function that reads its details."""

    action: Action
    words: re.Pattern[str] | LatePattern
    build: Builder


Listed = tuple[tuple[str, Action, str, Builder], ...]
"""Forms by their first words: these, the action, the pattern, and the function."""

_ACK = "okay|ok|roger|alright|copy|and|yes|yeah|affirm|affirmative|wilco|full stop|thanks|thank you"
_BEFORE = re.compile(
    rf"(?<!\S)(?:runway )?{RUNWAY}"
    rf"(?: (?:(?:at|from|(?:at )?intersection) (?P<place>{TAXIWAY})|full length))?$"
)
_OPENING = re.compile(
    rf"(?:\| )?(?:(?:{_ACK}) )*(?:runway )?{RUNWAY}(?= (?:winds?|number|traffic|#))"
)
"""A runway at the beginning of a call, between which and its clearance other words stand."""
_AHEAD = re.compile(
    rf"(?<!of )(?<!final )(?<!base )(?<!on )(?<!for )(?<!behind )(?<!crossing )(?<!landing )"
    rf"(?<!departing )runway {RUNWAY}(?= (?:winds? |number [0-9]|#|cleared short))"
)
"""A named runway before its clearance, with other words between them."""
_BEFORE_TURN = re.compile(
    rf"(?<!of )(?<!final )(?<!base )(?<!on )(?<!for )(?<!behind )(?<!crossing )(?<!landing )"
    rf"(?<!departing )runway {RUNWAY} (?:(?:fly|turn)(?: (?:left|right))?"
    r"|(?:left|right)(?: turn)?)(?: to)?(?: heading)? [0-9]{3}(?: degrees)? $"
)
"""A runway whose take-off is cleared behind the turn after it (FAA Order JO 7110.65, 3-9-9)."""
_BEGINS = re.compile(
    rf"(?:.* )?(?:\||correction|wind calm|knots)(?: (?:{_ACK}))* |(?:(?:{_ACK}) )*"
)
"""Words before a runway at the beginning of a call, or of a correction."""
_NOT_ITS = frozenset(
    {"of", "short", "final", "base", "downwind", "crosswind", "landing", "departing", "crossing",
     "on", "for", "behind", "and", "then", "or", "not", "the", "at", "vacate", "exit", "off", "to"}
)  # fmt: skip
"""Words before a parallel runway that is not that of the clearance behind it."""
_BY_OPENING: frozenset[Action] = frozenset(
    {"cleared_to_land", "cleared_for_takeoff", "line_up", "touch_and_go", "stop_and_go",
     "low_approach", "cleared_option"}
)  # fmt: skip
"""Actions for which the runway at the beginning of the call is given."""
_NAMED_BEFORE = re.compile(rf"(?<!\S)runway {RUNWAY}(?: (?:at|from) {TAXIWAY})?$")
_BARE_AFTER = re.compile(rf" (?:on )?{RUNWAY}")
_AND_RUNWAY = re.compile(rf" and (?:runway )?{RUNWAY}(?! (?:cleared|line|hold))")
_OTHER_RUNWAY = re.compile(
    r"^ runway(?!\S)|(?<!\S)(?:hold|short|of|final|base|downwind|clear|crossing)(?!\S)"
)
"""Words before a runway that is not that of the action, or after one that cannot be read."""
_TO_RUNWAY = frozenset({"", "on", "onto", "on to", "into", "across", "to", "for"})
"""Words between an action and its runway."""
POSITION = re.compile(rf" (?:at|from) (?:taxiway |intersection )?({TAXIWAY})")
IMMEDIATE = frozenset({"immediate", "immediately", "expedite", "expediting", "now"})
_WITHOUT_DELAY = re.compile(r" (?:immediately|without delay|expedite|now)(?!\S)")
_NO_NAME = re.compile(rf"(?!waypoint )(?:{FIX_ENDS}|left|right|to|[0-9]+)(?!\S)")
"""The first word of a fix that is a word of the phraseology: the name itself may be lost."""
_NAME_ENDS_HERE = re.compile(rf" (?:\||#+|{FIX_ENDS})(?!\S)|$")


def is_immediate(segment: Segment, end: int) -> bool:
    """Return whether the words of an action, or those right after them, demand it at once."""
    after = _WITHOUT_DELAY.match(segment.text, end, segment.limit)
    return bool(after) or not IMMEDIATE.isdisjoint(segment.text[segment.start : end].split())


def on_runway(segment: Segment, action: Action) -> Read | None:
    """Read an action on a runway, which is named right before it or after it.

    The action is not read if two different runways are named.
    """
    inside = _named_runway(segment.found[0])
    before = runway_before(segment)
    after = _runway_after(segment, is_named=bool(inside or before))
    if action in _BY_OPENING and not (inside or before or after):
        opening = _opening(segment)
        if opening:
            number, side = opening.groups()
            confidence = min(BARE_RUNWAY, runway_confidence(number))
            read = Instruction(
                action, designator(number, side),
                immediate=is_immediate(segment, segment.found.end()), confidence=confidence,
            )  # fmt: skip
            return Read(read, segment.start, segment.found.end())
    named = [each.group(1, 2) for each in (inside, before, after) if each]
    told = [designator(number, side) for number, side in named]
    start, end = segment.found.span()
    if before:
        start = segment.begin + before.start()
    if after:
        end += after.end()
    if len(set(told)) > 1:
        return None
    place = before and before["place"]
    place_after = POSITION.match(segment.text, end, segment.limit)
    if place_after:
        place, end = place_after[1], place_after.end()
    more = _second_crossing(segment, end) if action == "cross" and told else None
    if more:
        end = more.end()
    confidences = [runway_confidence(number) for number, _ in named]
    bare_after = after is not None and after.re is _BARE_AFTER
    bare_before = before is not None and not before[0].startswith("runway")
    if (bare_after or bare_before) and len(told) == 1:
        confidences.append(BARE_RUNWAY)
    read = Instruction(
        action,
        told[0] if told else None,
        taxiway(place) if place else None,
        immediate=is_immediate(segment, end),
        confidence=min(confidences, default=NO_RUNWAY),
    )
    if more is None:
        return Read(read, start, end)
    other = Instruction(
        action, designator(*more.groups()), confidence=min(read.confidence, BARE_RUNWAY)
    )
    return Read(read, start, end, (other,))


def _opening(segment: Segment) -> re.Match[str] | None:
    """Return the runway at the beginning of a call, or one that is named before other words.

    It is none if the call names another one, but to hold short of.
    """
    opening = (
        _OPENING.match(segment.text)
        or _AHEAD.search(segment.before)
        or _BEFORE_TURN.search(segment.before_all)
    )
    if opening is None:
        return None
    is_at_begin = opening.re is _OPENING
    offset = segment.begin if opening.re is _AHEAD else 0
    others = list(NAMED_RUNWAY.finditer(segment.text, offset + opening.end()))
    if not is_at_begin:
        others += NAMED_RUNWAY.finditer(segment.text, 0, offset + opening.start())
    is_only = all(segment.text[: other.start()].endswith("short of ") for other in others)
    return opening if is_only else None


def _second_crossing(segment: Segment, end: int) -> re.Match[str] | None:
    """Return the second of two runways to cross: "cross 27 left and 27 right"."""
    return _AND_RUNWAY.match(segment.text, end, segment.limit)


def runway_before(segment: Segment) -> re.Match[str] | None:
    """Return the runway right before an action; without its word only after the callsign."""
    ahead = segment.before
    found = _BEFORE.search(ahead)
    if found is None or found[0].startswith("runway"):
        return found
    before = segment.text[: segment.begin + found.start()]
    if _BEGINS.fullmatch(before):
        return found
    has_side = found[2] is not None and segment.begin + found.start() > 0
    return found if has_side and before.split()[-1] not in _NOT_ITS else None


def is_next_runway(segment: Segment) -> bool:
    """Return whether the runway after an action is right before the next one."""
    return segment.limit < len(segment.text) and bool(_NAMED_BEFORE.search(segment.after.rstrip()))


def _named_runway(text: str) -> re.Match[str] | None:
    return NAMED_RUNWAY.search(text) if "runway" in text else None


def _runway_after(segment: Segment, *, is_named: bool) -> re.Match[str] | None:
    """Return the runway that is named after an action and does not belong to the next one.

    Parameters
    ----------
    is_named
        True if a runway is named before the action, or among its words.
    """
    after = segment.after
    bare = _BARE_AFTER.match(after)
    if bare:
        return bare
    named = _named_runway(after)
    if named is None or _OTHER_RUNWAY.search(after[: named.start()]):
        return None
    is_beside = after[: named.start()].strip() in _TO_RUNWAY
    is_next = is_next_runway(segment) and not (is_beside and not is_named)
    return None if is_next or (is_named and not is_beside) else named


def alone(segment: Segment, action: Action) -> Read | None:
    """Read an action without details."""
    return Read(Instruction(action), segment.start, segment.found.end())


def nothing(segment: Segment, action: Action) -> Read | None:
    """Read nothing from words that are no instruction, or none that has a name here."""
    del segment, action
    return None


def fix_of(segment: Segment, name: str = "fix") -> tuple[str | None, float]:
    """Return the fix that an action names, and the confidence that it is the whole name."""
    fix = segment.found.groupdict().get(name)
    if fix is None:
        return None, 1.0
    words = fix.strip()
    if _NAME_ENDS_HERE.match(segment.text, segment.found.end(name)) is None:
        return words, NO_VALUE
    if _NO_NAME.match(words):
        return words, LONG_NAME
    return words, LONG_NAME if len(words.split()) > 2 else 1.0
