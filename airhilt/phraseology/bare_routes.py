"""Taxi routes without "taxi": "bravo golf, short of two seven", "three zero left via bravo"."""

from __future__ import annotations

import re

from airhilt.phraseology.alphabet import LETTERS
from airhilt.phraseology.call import Action, Instruction
from airhilt.phraseology.ground import STAND, place_name, route_of
from airhilt.phraseology.slots import (
    NUMBERED_LINK,
    RUNWAY,
    SHORTENED,
    designator,
    runway_confidence,
    taxiway,
)

ON_GROUND: frozenset[Action] = frozenset(
    {"hold_short", "cross", "give_way", "follow", "taxi", "backtrack"}
)
"""Actions beside which a letter alone is a route."""
_LETTER = rf"(?:{'|'.join(LETTERS)})(?!\S)"
_PIECE = rf"(?:{_LETTER}(?: [0-9]{{1,2}}(?!\S))?|{NUMBERED_LINK})"
_LISTED = rf"{_PIECE}(?: (?:(?:and|then|on|onto|left|right|taxiway) )*{_PIECE})*"
_TO_RUNWAY = rf"(?:to|for)(?: the)?(?: holding (?:point|decimal))?(?: runway)? {RUNWAY}"
_ROUTES = (
    re.compile(
        rf"(?:runway (?=[0-9])|(?=[0-9]+ (?:left|right|centre|via))){RUNWAY}(?: via| on)?"
        rf" (?P<via>{_LISTED})"
    ),
    re.compile(
        rf"(?P<named>holding (?:point|decimal) )?(?P<point>{_LETTER}(?: [0-9]{{1,2}}(?!\S))?)"
        rf"(?: (?:for runway |for |runway |(?=[0-9]+ (?:left|right|centre))){RUNWAY})?"
    ),
    re.compile(
        r"(?:(?:taxi|route|is|via|on|along|taxiway|left|right|then|continue|we|will|take|now) )*"
        rf"(?P<via>{_LISTED})"
        rf"(?: {_TO_RUNWAY}|(?: and)?(?: to)?(?: the)? (?P<stand>{STAND})"
        r"| to (?:the )?(?P<place>(?:north|south|east|west|cargo|main)(?: [a-z]+){1,2}|fbo|f b o))?"
    ),
)
_CROSSED_AT = re.compile(rf"{_PIECE} (?=(?:left|right)(?: on| onto)? {_LETTER})")
"""Where a runway is crossed, before the turn behind it."""


def bare_route(
    words: list[str], beside: set[Action], last: Action | None, *, is_joined: bool
) -> Instruction | None:
    """Return the route that is all that some words say, None if they say anything else.

    Letters alone are a route only beside another action on the ground, or if the call says nothing
    else: they may also be a callsign, or that of an information broadcast.

    Parameters
    ----------
    words
        Words that belong to no action, without courtesies.
    beside
        Actions of the call.
    last
        Action right before the words.
    is_joined
        True if "and" or "then" leads to the words.
    """
    text = " ".join(words)
    if last in ("follow", "give_way") and " then " in text:
        text, is_joined = text.split(" then ", 1)[1], True
    if last == "cross":
        text = _CROSSED_AT.sub("", text, count=1)
    if words[0] in ("on", "at") and last in ("hold_short", "cross", "line_up"):
        return None
    is_others = last in ("follow", "give_way") and not is_joined
    for pattern in _ROUTES:
        found = pattern.fullmatch(text)
        if found is None:
            continue
        is_ground = not (ON_GROUND.isdisjoint(beside) or is_others)
        route = _instruction(found, is_ground=is_ground, is_alone=not beside)
        if route is not None:
            return route
    return None


def _instruction(found: re.Match[str], *, is_ground: bool, is_alone: bool) -> Instruction | None:
    parts = found.groupdict()
    number, side = _runway_of(found)
    runway = designator(number, side) if number else None
    sure = min(SHORTENED, runway_confidence(number)) if number else SHORTENED
    if point := parts.get("point"):
        if not (parts["named"] or (runway and (" for " in found[0] or is_ground))):
            return None
        return Instruction("taxi", runway, taxiway(point), confidence=sure)
    via = route_of(parts["via"])
    stand = parts.get("stand") or parts.get("place")
    if not (runway or stand or is_ground or (is_alone and len(via) > 1)):
        return None
    return Instruction("taxi", runway, stand and place_name(stand), via=via, confidence=sure)


def _runway_of(found: re.Match[str]) -> tuple[str | None, str | None]:
    """Return the number and the side of the runway, which are the groups without a name."""
    named = set(found.re.groupindex.values())
    number, side = (found[at] for at in range(1, found.re.groups + 1) if at not in named)
    return number, side
