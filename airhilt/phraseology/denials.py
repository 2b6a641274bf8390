"""Words by which an action is denied, asked for, or expected, instead of ordered."""

from __future__ import annotations

from itertools import pairwise

from airhilt.phraseology.call import CLEARANCES, REPORTS, Action
from airhilt.phraseology.hits import NAME
from airhilt.phraseology.runways import ANIMALS

DENIALS = frozenset(
    {"no", "not", "never", "without", "unable", "neither", "nor", "cancelled", "refuse", "do",
     "cancel", "cancelling", "ignore", "nobody"}
)  # fmt: skip
"""Words before an action that deny it."""
OPEN = frozenset(
    {"if", "unless", "when", "until", "once", "before", "whether", "expect", "expecting",
     "expected", "await", "awaiting", "waiting", "wait", "request", "requesting", "requested",
     "confirm", "confirming", "verify", "except", "like", "want", "possible", "possibly",
     "maybe", "about", "prepare", "prepared", "anticipate", "disregard", "prior",
     "need", "intend", "plan", "planning", "chance", "assigned", "expects", "supposed", "told",
     "might", "possibility", "thought", "waited"}
)  # fmt: skip
"""Words before an action that is asked for, asked about, or only expected."""
EXPECTS = frozenset(
    {"expect", "expecting", "plan", "planning", "anticipate", "anticipating", "prepare", "prepared"}
)
"""Words before an action that is to be expected."""
ASKED = frozenset(
    {"did", "does", "why", "what", "who", "how", "could", "would", "should", "can", "may",
     "might", "plan"}
)  # fmt: skip
"""Words anywhere before a clearance that make it a question, if no other action stands between."""
ASKS = frozenset({"is", "are", "am", "was", "were"})
"""First words of a question."""
_ASKS_YOU = frozenset({"can", "could", "do", "did", "will", "would", "are"})
"""Words before "you" that ask for what the other can or wants to do."""
OTHERS = frozenset({"is", "was", "were", "are", "be", "has", "have", "been"})
"""Words before the clearance of another: "traffic is cleared to land"."""
SOMEBODY = frozenset(
    {"aircraft", "airplane", "aeroplane", "jet", "helicopter", "vehicle", "vehicles", "truck",
     "car", "tug", "somebody", "someone", "company", "boeing", "airbus", "cessna", "piper",
     "citation", "learjet", "gulfstream", "embraer", "bombardier", "heavy", "he", "she", "they",
     "passes", "passed"}
)  # fmt: skip
"""Words right before the clearance of another: "vehicle crossing runway 01"."""
SPOKEN_OF = frozenset({"follow", "following", "behind", "after", "traffic", "number", "from"})
"""Words before one of `SOMEBODY` that mean that the clearance is not that aircraft's."""
OWN = frozenset({("you", "are"), ("we", "are"), ("are", "now"), ("you", "now")})
"""Word pairs before a clearance that give it or read it back all the same."""
BETWEEN = frozenset(
    {"yet", "to", "be", "been", "being", "have", "had", "has", "the", "a", "an", "for",
     "clearance", "get", "now", "still", "runway", "left", "right", "centre", "your", "any", "you",
     "we", "i", "am", "are", "l", "r", "c", "of", "immediate", "immediately", "was", "were",
     "is", "it", "cleared", "clear", "longer", "currently", "actually", "really"}
)  # fmt: skip
"""Words that may stand between a denial and its action."""
STOPS = DENIALS | OPEN | {"delay"}
"""Words that are never passed over."""
AFTERWARDS = frozenset({"cancelled", "denied", "revoked", "withdrawn", "not", "negative", "was"})
"""Words after a clearance that deny it: "cleared to land, cancelled"."""
CANCELLED = frozenset({"that", "it", "this", "the", "clearance", "last"})
"""Words after "cancel" that deny the clearance before it: "line up and wait, cancel that"."""
_PHRASES = {
    "are": ("you", "we", "they"), "am": ("i",), "is": ("he", "that"), "were": ("you", "we"),
    "was": ("i", "that"), "have": ("we", "i"), "can": ("we", "i"), "may": ("we", "i"),
    "ready": ("to", "for"), "able": ("to",), "standby": ("for",), "by": ("for",),
}  # fmt: skip
"""Words before an action that is not ordered, by the word before them: "are you"."""
_QUESTIONS = frozenset(
    {("was", "that"), ("is", "that"), ("did", "you"), ("do", "you"), ("you", "want"),
     ("want", "us"), ("we", "may"), ("we", "might"), ("i", "may"), ("i", "might"),
     ("should", "we"), ("shall", "we"), ("should", "i"), ("how", "about"),
     ("what", "about")}
)  # fmt: skip
"""Word pairs before an action that make it a question."""
_CANCELLED_BEFORE = (
    "clearance", "takeoff", "landing", "crossing", "taxi", "up", "pushback", "push", "approach",
    "is", "been", "hold", "descent", "climb", "route", "it", "that",
)  # fmt: skip
"""Words before "cancelled" that are what is cancelled."""
_BEFORE_IT = frozenset(
    {*((word, "cancelled") for word in _CANCELLED_BEFORE),
     *((word, "request") for word in ("that", "your", "the"))}
)  # fmt: skip
"""Word pairs right before an action that deny what is before them: "crossing cancelled, hold
short", "unable that request, maintain flight level 240"."""
_WHO_WILL = frozenset({"we", "i", "you", "and", "then", "roger", "wilco", "okay", "affirm", NAME})
"""Words before "will" that make an action the speaker's own, or that of whom is called."""
_CLEARED = ("cleared", "clear")
_NOT_DENIED = frozenset({"above", "below", "before", "contact"})
"""Words behind "not" and "negative" that belong to them, so that what is before is not denied."""


def is_meant(
    words: list[str], first: int, after: int, action: Action, floor: int, before_is_meant: bool
) -> bool:
    """Return whether an action is ordered or read back, not denied, asked about or expected.

    Parameters
    ----------
    first, after
        Begin and end of the words of the action.
    floor
        End of the words of the action before it.
    before_is_meant
        True if the action before it is meant: "do not cross or line up" denies both.

    Notes
    -----
    One unknown word before a clearance is passed over, because recognisers insert words.
    """
    if action in CLEARANCES and not _is_own(words, first, after, floor):
        return False
    if words[floor:first] in ([], [NAME]):
        return True
    if "you" in words[floor:first] and words[max(words.index("you", floor) - 1, 0)] in _ASKS_YOU:
        return False
    if not _QUESTIONS.isdisjoint(pairwise(words[floor:first])):
        return False
    if words[first].endswith("ing") and _is_somebody_elses(words, first, floor):
        return False
    is_said_of = words[first - 1] == "will" and first - 2 >= floor and action != "report"
    if is_said_of and words[first - 2] not in _WHO_WILL:
        return False
    at = first - 1
    skips = action in CLEARANCES
    while at >= floor:
        if words[at + 1] in _PHRASES.get(words[at], ()):
            return False
        if words[at] not in BETWEEN and not words[at][0].isdigit():
            is_on = words[at] == "on" and at > floor and words[at - 1] in EXPECTS
            if not is_on and (not skips or words[at] in STOPS or at == floor):
                break
            skips = words[at] == "or"
        at -= 1
    if at < floor:
        return True
    if words[at] in ("and", "or") and at == floor and not before_is_meant:
        return False
    if at == first - 1 > floor and (words[at - 1], words[at]) in _BEFORE_IT:
        return True
    if words[at : at + 2] == ["no", NAME] and at > floor:
        return True  # The speaker corrects the callsign: "Delta, no, United 914".
    if words[at] in DENIALS or words[at + 1] in _PHRASES.get(words[at], ()):
        return False
    if action not in CLEARANCES and words[at] == "need" and words[at + 1 : at + 2] == ["you"]:
        return True  # "I need you to turn left".
    is_thanked = words[at] == "waiting" and words[at - 1] == "for"
    return words[at] not in OPEN or is_thanked or action in REPORTS


def _is_somebody_elses(words: list[str], first: int, floor: int) -> bool:
    """Return whether somebody else does what is said: "the American is holding short"."""
    last, ahead = words[first - 1], words[max(first - 2, 0)]
    if first - 1 < floor or first < 2:
        return False
    return (last in ("is", "are") and ahead not in ("you", "we", NAME, "i")) or (
        last in SOMEBODY and SPOKEN_OF.isdisjoint(words[floor:first])
    )


def is_expected(words: list[str], first: int, floor: int) -> bool:
    """Return whether the words before an action say that it is to be expected."""
    at = first - 1
    while at >= floor and (words[at] in BETWEEN or words[at] in ("on", "that")):
        at -= 1
    if at < floor or DENIALS.intersection(words[max(at - 1, floor) : at]):
        return False
    is_ready = words[at] == "ready" and words[at - 1] == "be" and at > floor
    return words[at] in EXPECTS or is_ready


def _is_own(words: list[str], first: int, after: int, floor: int) -> bool:
    """Return whether a clearance belongs to the one who is called or reads it back."""
    after += words[after : after + 1] == ["clearance"]
    ends = words[after : after + 2]
    if first - 2 >= floor and words[first - 1] == "to" and words[first - 2] in _CLEARED:
        first -= 2
    before = tuple(words[max(first - 2, 0) : first])
    last = before[-1] if before else ""
    is_cleared = words[first] in _CLEARED
    is_cancelled = ends[:1] == ["cancel"] and (ends[1:] == [] or ends[1] in CANCELLED)
    opening = words[1:2] if words[0] == NAME else words[:1]
    return not (
        last == "negative"
        or (words[first].endswith("ing") and last in ANIMALS)
        or (last in SOMEBODY and first > floor and SPOKEN_OF.isdisjoint(words[floor:first]))
        or last == "to"
        or last == "ready"
        or (before[:1] == ("ready",) and last.isdigit())
        or (is_cleared and last in OTHERS and before not in OWN)
        or is_cancelled
        or (not AFTERWARDS.isdisjoint(ends[:1]) and _NOT_DENIED.isdisjoint(ends[1:]))
        or (ends[:1] == ["is"] and not (AFTERWARDS | {"for"}).isdisjoint(ends[1:]))
        or not ASKED.isdisjoint(words[floor:first])
        or not ASKS.isdisjoint(opening)
    )
