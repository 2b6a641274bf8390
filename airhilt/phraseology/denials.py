"""When the words of an action do not mean it: denied, asked, expected, or not yet."""

from __future__ import annotations

from airhilt.phraseology.call import CLEARANCES, REPORTS, Action

NAME = "|"
"""Stands in the words for the callsign of the call."""
DENIALS = frozenset(
    {"no", "not", "never", "without", "unable", "neither", "nor", "cancelled", "refuse", "do",
     "cancel", "cancelling", "ignore"}
)  # fmt: skip
"""Before any action."""
OPEN = frozenset(
    {"if", "unless", "when", "until", "once", "before", "whether", "expect", "expecting",
     "expected", "await", "awaiting", "waiting", "wait", "request", "requesting", "requested",
     "confirm", "confirming", "verify", "except", "like", "want", "possible", "possibly",
     "maybe", "about", "prepare", "prepared", "anticipate", "disregard", "prior",
     "need", "intend", "planning"}
)  # fmt: skip
"""Before an action that somebody asks for, asks about, or will perhaps be told."""
ASKED = frozenset(
    {"did", "does", "why", "what", "who", "how", "could", "would", "should", "can", "may",
     "might", "plan"}
)  # fmt: skip
"""Anywhere before a clearance, if no other action stands between."""
ASKS = frozenset({"is", "are", "am", "was", "were"})
"""What begins a question."""
OTHERS = frozenset({"is", "was", "were", "are", "be", "has", "have", "been"})
"""Before a clearance that somebody else has: "traffic is cleared to land"."""
SOMEBODY = frozenset(
    {"aircraft", "airplane", "aeroplane", "jet", "helicopter", "vehicle", "vehicles", "truck",
     "car", "tug", "somebody", "someone", "company", "boeing", "airbus", "cessna", "piper",
     "citation", "learjet", "gulfstream", "embraer", "bombardier", "heavy", "he", "she", "they"}
)  # fmt: skip
"""Right before a clearance, whose that is: "vehicle crossing runway 01"."""
SPOKEN_OF = frozenset({"follow", "following", "behind", "after", "traffic", "number"})
"""But it is where these words end, if one of them stands before."""
OWN = frozenset({("you", "are"), ("we", "are"), ("are", "now"), ("you", "now")})
"""But these tell, or read back, a clearance."""
BETWEEN = frozenset(
    {"yet", "to", "be", "been", "being", "have", "had", "has", "the", "a", "an", "for",
     "clearance", "get", "now", "still", "runway", "left", "right", "centre", "your", "any", "you",
     "we", "i", "am", "are", "l", "r", "c", "of", "immediate", "immediately", "was", "were",
     "is", "it", "cleared", "clear", "longer", "currently", "actually", "really"}
)  # fmt: skip
"""Words that may stand between."""
STOPS = DENIALS | OPEN | {"delay"}
"""Words that are not passed over."""
AFTERWARDS = frozenset({"cancelled", "denied", "revoked", "withdrawn", "not", "negative"})
"""After a clearance that is none: "cleared to land, cancelled"."""
CANCELLED = frozenset({"that", "it", "this", "the", "clearance", "last"})
"""Likewise, after "cancel": "line up and wait, cancel that"."""
_PHRASES = frozenset(
    {("are", "you"), ("are", "we"), ("are", "they"), ("am", "i"), ("is", "he"), ("were", "you"),
     ("were", "we"), ("was", "i"), ("have", "we"), ("have", "i"),
     ("can", "we"), ("can", "i"), ("may", "we"), ("may", "i"),
     ("ready", "to"), ("ready", "for"), ("able", "to")}
)  # fmt: skip


def is_meant(
    words: list[str], first: int, after: int, action: Action, floor: int, before_is_meant: bool
) -> bool:
    """Return whether an action is told or read back, and not denied, asked about or expected.

    Parameters
    ----------
    first, after
        Where the words of the action begin, and where they end.
    floor
        Where the words of the action before it end.
    before_is_meant
        Whether that is meant: "do not cross or line up" denies both.

    Notes
    -----
    One word that does not belong there is passed over before a clearance: recognisers put in words.
    """
    if action in CLEARANCES and not _is_own(words, first, after, floor):
        return False
    at = first - 1
    skips = action in CLEARANCES
    while at >= floor:
        if tuple(words[at : at + 2]) in _PHRASES:
            return False
        if words[at] not in BETWEEN and not words[at][0].isdigit():
            if not skips or words[at] in STOPS or at == floor:
                break
            skips = words[at] == "or"
        at -= 1
    if at < floor:
        return True
    if words[at] in ("and", "or") and at == floor and not before_is_meant:
        return False
    if words[at] in DENIALS or tuple(words[at : at + 2]) in _PHRASES:
        return False
    return words[at] not in OPEN or action in REPORTS


def _is_own(words: list[str], first: int, after: int, floor: int) -> bool:
    """Return whether a clearance is told to, or read back by, who has it or is to have it now."""
    ends = words[after : after + 2]
    if words[max(first - 2, floor) : first] in (["cleared", "to"], ["clear", "to"]):
        first -= 2
    before = tuple(words[max(first - 2, 0) : first])
    last = before[-1] if before else ""
    is_cleared = words[first] in ("cleared", "clear")
    is_cancelled = ends[:1] == ["cancel"] and (ends[1:] == [] or ends[1] in CANCELLED)
    opening = words[1:2] if words[0] == NAME else words[:1]
    return not (
        last == "negative"
        or (last in SOMEBODY and first > floor and not SPOKEN_OF.intersection(words[floor:first]))
        or last == "to"
        or (is_cleared and last in OTHERS and before not in OWN)
        or is_cancelled
        or AFTERWARDS.intersection(ends[:1])
        or ASKED.intersection(words[floor:first])
        or ASKS.intersection(opening)
    )
