"""When the words of an action do not mean it: denied, asked, expected, or not yet."""

from __future__ import annotations

from airhilt.radio.phraseology.call import CLEARANCES, REPORTS, Action

DENIALS = frozenset(
    {"no", "not", "never", "without", "unable", "neither", "nor", "cancelled", "refuse"}
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
OTHERS = frozenset({"is", "was", "were", "are", "be", "has", "have", "been"})
"""Before a clearance that somebody else has: "traffic is cleared to land"."""
OWN = frozenset({("you", "are"), ("we", "are"), ("are", "now"), ("you", "now")})
"""But these tell, or read back, a clearance."""
BETWEEN = frozenset(
    {"yet", "to", "be", "been", "being", "have", "had", "has", "the", "a", "an", "for",
     "clearance", "get", "now", "still", "runway", "left", "right", "centre", "your", "any", "you",
     "we", "i", "am", "are", "l", "r", "c", "of", "do", "immediate", "immediately", "was", "were",
     "is", "it"}
)  # fmt: skip
"""Words that may stand between."""
AFTERWARDS = frozenset({"cancelled", "denied", "revoked", "withdrawn", "not", "negative"})
"""After a clearance that is none: "cleared to land, cancelled"."""
_PHRASES = frozenset(
    {("are", "you"), ("are", "we"), ("are", "they"), ("am", "i"), ("is", "he"), ("were", "you"),
     ("were", "we"), ("was", "i"), ("can", "we"), ("can", "i"), ("may", "we"), ("may", "i"),
     ("could", "we"), ("do", "we"), ("do", "i"), ("should", "we"), ("should", "i"),
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
    """
    if action in CLEARANCES:
        is_cleared = words[first] in ("cleared", "clear")
        before = tuple(words[max(first - 2, 0) : first])
        if before[-1:] == ("negative",) or AFTERWARDS.intersection(words[after : after + 1]):
            return False
        if is_cleared and before and before[-1] in OTHERS and before not in OWN:
            return False
    at = first - 1
    while at >= floor and (words[at] in BETWEEN or words[at][0].isdigit()):
        if tuple(words[at : at + 2]) in _PHRASES:
            return False
        at -= 1
    if at < floor:
        return True
    if words[at] in ("and", "or") and at == floor and not before_is_meant:
        return False
    if words[at] in DENIALS or tuple(words[at : at + 2]) in _PHRASES:
        return False
    return words[at] not in OPEN or action in REPORTS
