"""Words beside an action that nothing explains.

Between two actions stand courtesies, information and reasons. What else stands right beside an
action may be a part of it that was not understood: a lost value behind "via", another reading
behind "or", a verb before a level. The action is then in doubt.
"""

from __future__ import annotations

from airhilt.phraseology.alphabet import LETTER_OF
from airhilt.phraseology.call import Action
from airhilt.phraseology.hits import NAME, STATIONS
from airhilt.phraseology.vocabulary import COURTESIES

SAFE: frozenset[Action] = frozenset(
    {"stop", "go_around", "hold_position", "cancel_takeoff", "cancel_landing", "cancel_approach",
     "stand_by", "ident", "wildlife", "wildlife_gone", "missed_approach", "start_up", "push_back"}
)  # fmt: skip
"""Actions without a value, of which words beside them say nothing else."""
_OPENERS = COURTESIES | {
    "abeam", "acknowledge", "advise", "aircraft", "altimeter", "and", "arrivederci", "as", "au",
    "are", "be", "break", "bringing", "call", "can", "caution", "cheers", "ciao", "company",
    "confirm", "continue", "copy", "could", "delay", "disregard", "enter", "estimate", "except",
    "expect", "expecting", "expedite", "extend", "face", "facing", "frequency", "goodbye", "have",
    "identified",
    "immediately", "in", "information", "intercept", "it", "join", "keep", "later", "looking",
    "make", "making", "negative", "no", "number", "once", "over", "passing", "pattern", "prepare",
    "proceed", "q", "qfe", "qnh", "radar", "radio", "readback", "remain", "report", "rest",
    "say", "see", "servus", "so", "surface", "tail", "temperature", "then", "there", "they",
    "this", "through", "time", "tower", "traffic", "tschuss", "vector", "vectors", "vehicle",
    "verify", "we", "will", "wind", "winds", "windshear", "with", "without", "yes",
}  # fmt: skip
"""First words of what may follow any action: information, a reason, a courtesy, another action."""
_UNITS_OF_TIME = frozenset({"minutes", "minute", "miles", "mile", "oclock", "seconds"})
"""Words behind a number that is no value of an action."""
_TOLD_WHERE: frozenset[Action] = frozenset(
    {"follow", "give_way", "visual_separation", "hold_short"}
)
"""Actions behind which the place of another aircraft may be told."""
_PLACED = frozenset(
    {"on", "from", "to", "at", "off", "ahead", "short", "long", "turning", "downwind", "final",
     "base", "mile", "miles", "oclock", "heavy", "left", "right", "just", "super", "landing",
     "departing"}
)  # fmt: skip
"""First words of the place of another aircraft."""
_ALSO: dict[Action, frozenset[str]] = {
    "altitude": frozenset({"until", "good", "correction", "below", "vmc", "initially"}),
    "heading": frozenset({"to", "until", "closing", "now", "outbound", "inbound"}),
    "turn_by": frozenset({"to", "now"}),
    "speed": frozenset({"to", "until", "now", "about"}),
    "direct": frozenset({"intersection", "vor", "ndb", "when", "own"}),
    "own_navigation": frozenset({"to", "now"}),
    "cleared_approach": frozenset({"approach", "straight", "via", "glide", "circling", "side"}),
    "touch_and_go": frozenset({"left", "right"}),
    "stop_and_go": frozenset({"left", "right"}),
    "low_approach": frozenset({"left", "right"}),
    "cleared_option": frozenset({"left", "right"}),
    "cleared_for_takeoff": frozenset({"left", "right", "straight"}),
    "cleared_to_land": frozenset({"change", "one", "land", "wheels"}),
    "taxi": frozenset({"intersection", "back", "monitor"}),
    "contact": frozenset({"now", "other", "when", "they"}),
    "monitor": frozenset({"now", "other", "they"}),
    "squawk": frozenset({"low", "normal", "mode"}),
    "vacate": frozenset({"when", "onto", "next", "now"}),
    "descend_via": frozenset({"landing"}),
    "climb_via": frozenset({"departure"}),
    "line_up": frozenset({"landing", "via"}),
    "missed_approach": frozenset({"as"}),
    "hold_at": frozenset({"flight", "delay", "as", "at"}),
    "report": frozenset({"heading"}),
}  # fmt: skip
"""First words of what may follow one action."""
_INTRODUCING = frozenset(
    {"or", "at", "of", "by", "cross", "crossing", "turn", "turning", "left", "right", "on", "a",
     "an", "around", "the", "via", "able", "in", "until", "than", "from", "change",
     "closed", "onto", "is", "are", "was", "were"}
)  # fmt: skip
"""Words right before an action that belong to something that was not understood."""
_LINKING = frozenset({"proceed", "proceeding"})
"""Words before an action that belong to it, before which its side or condition stands."""
_EVENTS = frozenset({"event", "case"})
"""Words of a condition that was not understood."""
_LEADS_TO = {
    "right": frozenset({"all", "your", "the"}),
    "left": frozenset({"your", "the"}),
    "able": frozenset({"when", "if"}),
    "turn": frozenset({"your"}),
    "are": frozenset({"you", "we"}),
    "was": frozenset({"what"}),
}
"""Words before one of `_INTRODUCING` with which it is explained."""
_PARTS = frozenset(
    {"or", "thousand", "hundred", "feet", "decimal", "left", "right", "centre", "via"}
)
"""Words behind a courtesy that belong to the value before it."""


def is_unexplained_behind(words: list[str], action: Action) -> bool:
    """Return whether the words right behind an action, up to the next, may be a part of it."""
    if not words or action in SAFE:
        return False
    if words[0] in COURTESIES:
        following = next((word for word in words if word not in COURTESIES), "")
        return following.isdigit() or following in _PARTS
    first, following = words[0], words[1] if len(words) > 1 else ""
    if first == NAME or first in _OPENERS or first[0] == "#" or following[:1] == "#":
        return False
    if first.isdigit():
        return following not in _UNITS_OF_TIME
    if first == "for":
        return following.isdigit() or following in LETTER_OF or not following
    if action in _TOLD_WHERE and (first in _PLACED or first in LETTER_OF):
        return False
    if first == "runway":
        return action not in ("wildlife", "wildlife_gone", "report")
    if first in STATIONS or following in ("altimeter", "qnh", "information"):
        return False
    if first == "at":
        return following.isdigit() or following in ("", "to", "too")
    return first not in _ALSO.get(action, ())


def is_unexplained_before(words: list[str], action: Action) -> bool:
    """Return whether the word right before an action may be a part of something else."""
    if not words:
        return False
    while len(words) > 1 and words[-1] in _LINKING:
        words = words[:-1]
    if words[-1] in _EVENTS or words[-2:] == ["missed", "approach"]:
        return True
    if words[-1] == "and" and action == "altitude":
        return words[-2:-1] == [NAME] or any(
            each not in COURTESIES and each != NAME and each[0] != "#" for each in words[:-1]
        )
    if action in SAFE or words[-1] not in _INTRODUCING:
        return False
    ahead = words[-2] if len(words) > 1 else ""
    is_side = words[-1] in ("left", "right") and ahead.isdigit()
    return not is_side and ahead not in _LEADS_TO.get(words[-1], ())
