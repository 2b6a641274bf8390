"""Words by which an action is denied, asked for, or expected, instead of ordered.

They stand in the clause of the action: in the words that lead to it, or right behind it.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise

from airhilt.phraseology.call import CLEARANCES, REPORTS, STOPS, Action
from airhilt.phraseology.hits import NAME

DENIALS = frozenset(
    {"no", "not", "never", "without", "unable", "neither", "nor", "cancelled", "refuse", "do",
     "cancel", "cancelling", "ignore", "nobody"}
)  # fmt: skip
"""Words before an action that deny it."""
OPEN = frozenset(
    {"if", "unless", "when", "until", "once", "before", "whether", "expect", "expecting",
     "expected", "await", "awaiting", "wait", "request", "requesting", "requested",
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
    {"did", "does", "why", "what", "who", "how", "could", "would", "should", "can", "may", "might",
     "plan"}
)  # fmt: skip
"""Words that make a question of the clearance that they lead to."""
ASKS = frozenset({"is", "are", "am", "was", "were"})
"""First words of a question."""
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
NEVER_PASSED = DENIALS | OPEN | {"delay"}
"""Words that are never passed over."""
AFTERWARDS = frozenset({"cancelled", "denied", "revoked", "withdrawn", "not", "negative", "was"})
"""Words after a clearance that deny it: "cleared to land, cancelled"."""
CANCELLED = frozenset({"that", "it", "this", "the", "clearance", "last"})
"""Words after "cancel" that deny the clearance before it: "line up and wait, cancel that"."""
_DENIED = frozenset({*AFTERWARDS, "given", "issued", "yet", "clearance", "is"})
"""Words behind a clearance that was denied, which lead to nothing."""
_ASKING = frozenset(
    (first, second)
    for first, seconds in {
        "are": "you we they", "am": "i", "is": "he that", "were": "you we", "was": "i that",
        "have": "we i", "can": "you we i", "could": "you", "may": "we i", "do": "you",
        "did": "you", "will": "you", "would": "you", "ready": "to for", "able": "to",
        "standby": "for", "by": "for", "you": "want", "want": "us", "we": "may might",
        "i": "may might", "should": "we i", "shall": "we", "how": "about", "what": "about",
    }.items()
    for second in seconds.split()
)  # fmt: skip
"""Word pairs before an action that is asked about or asked for: "are you", "ready for"."""
_WITHDRAWN = (
    "clearance", "takeoff", "landing", "crossing", "taxi", "up", "pushback", "push", "approach",
    "is", "been", "hold", "descent", "climb", "route", "it", "that",
)  # fmt: skip
_BEFORE_IT = frozenset(
    {*((word, "cancelled") for word in _WITHDRAWN),
     *((word, "request") for word in ("that", "your", "the"))}
)  # fmt: skip
"""Word pairs right before an action that deny what is before them: "crossing cancelled, hold
short", "unable that request, maintain flight level 240"."""
_TALKED_OF = re.compile(
    r"(?<!\S)(?:(?:may|might|could|would|can)(?: still| also)? have to"
    r"|(?:reason|thank you|thanks|sorry|apologies|stand ?by|standing by) for)$|^for$"
)
"""Words right before an action that only talk of it: what may have to be done, thanks, reasons."""
_ARTICLES = frozenset({"the", "a", "an", "that", "your", "another", "during"})
"""Words right before a noun: "the go around"."""
_NOUNS: frozenset[Action] = frozenset({*CLEARANCES, *STOPS, "missed_approach"}).difference(
    ("cancel_takeoff", "hold_short")
)
"""Actions whose words may be a noun."""
_WISHED = frozenset({("need", "you"), ("want", "you"), ("like", "you")})
"""Word pairs that order what is behind them: "I need you to turn left"."""
_WHO_WILL = frozenset({"we", "i", "you", "and", "then", "roger", "wilco", "okay", "affirm", NAME})
"""Words before "will" that make an action the speaker's own, or that of whom is called."""
_NOT_DENIED = frozenset({"above", "below", "before", "contact"})
"""Words behind "not" and "negative" that belong to them, so that what is before is not denied."""


def is_meant(
    lead: Sequence[str],
    said: Sequence[str],
    behind: Sequence[str],
    action: Action,
    *,
    before_is_meant: bool,
    is_question: bool,
) -> bool:
    """Return whether an action is ordered or read back, not denied, asked about or expected.

    Parameters
    ----------
    lead, said, behind
        Words of its clause before the action, its own words, and those behind it.
    before_is_meant
        True if the action before it is meant: "do not cross or line up" denies both.
    is_question
        True if the call begins as a question does.
    """
    if action in CLEARANCES and (is_question or not _is_own(lead, said, behind)):
        return False
    if not lead or list(lead) == [NAME]:
        return True
    if not _ASKING.isdisjoint(pairwise((*lead, said[0]))):
        return False
    if said[0].endswith("ing") and _is_somebody_elses(lead):
        return False
    if lead[-1] == "will" and len(lead) > 1 and action != "report" and lead[-2] not in _WHO_WILL:
        return False
    is_noun = lead[-1] in _ARTICLES and action in _NOUNS
    if action not in REPORTS and (is_noun or _TALKED_OF.search(" ".join(lead))):
        return False
    at = _governing(lead, is_clearance=action in CLEARANCES)
    if at is None:
        return True
    word = lead[at]
    if word in ("and", "or") and at == 0 and not before_is_meant:
        return False
    if at == len(lead) - 1 > 0 and (lead[at - 1], word) in _BEFORE_IT:
        return True
    if at and tuple(lead[at : at + 2]) == ("no", NAME):
        return True  # The speaker corrects the callsign: "Delta, no, United 914".
    if word in DENIALS:
        return action in STOPS and lead[-1] in ("unable", "clearance")
    if action not in CLEARANCES and (
        tuple(lead[at : at + 2]) in _WISHED or tuple(lead[at - 2 : at + 1]) == (NAME, "you", "need")
    ):
        return True
    return word not in OPEN or action in REPORTS


def _governing(lead: Sequence[str], *, is_clearance: bool) -> int | None:
    """Return the index of the word that an action depends on, None if there is none.

    One unknown word before a clearance is passed over, because recognisers insert words.
    """
    skips = is_clearance
    for at in reversed(range(len(lead))):
        word = lead[at]
        if word in BETWEEN or word[0].isdigit():
            continue
        if word == "on" and at and lead[at - 1] in EXPECTS:
            continue
        if not skips or word in NEVER_PASSED or at == 0:
            return at
        skips = word == "or"
    return None


def _is_somebody_elses(lead: Sequence[str]) -> bool:
    """Return whether somebody else does what is said: "the American is holding short"."""
    ahead = lead[-2] if len(lead) > 1 else ""
    return (lead[-1] in ("is", "are") and ahead not in ("", "you", "we", NAME, "i")) or (
        lead[-1] in SOMEBODY and SPOKEN_OF.isdisjoint(lead)
    )


def is_expected(lead: Sequence[str]) -> bool:
    """Return whether the words before an action say that it is to be expected."""
    words = list(lead)
    while words and (words[-1] in BETWEEN or words[-1] in ("on", "that")):
        words.pop()
    if not words or (words[-2:-1] and words[-2] in DENIALS):
        return False
    return words[-1] in EXPECTS or words[-2:] == ["be", "ready"]


def _is_own(lead: Sequence[str], said: Sequence[str], behind: Sequence[str]) -> bool:
    """Return whether a clearance belongs to the one who is called or reads it back."""
    if behind[:1] == ["clearance"]:
        behind = behind[1:]
    first, second = (*behind[:2], "", "")[:2]
    is_cleared = said[0] in ("cleared", "clear")
    if tuple(lead[-2:]) in (("cleared", "to"), ("clear", "to")):
        lead, is_cleared = lead[:-2], True
    last = lead[-1] if lead else ""
    return not (
        last in ("negative", "to", "ready")
        or (last in SOMEBODY and SPOKEN_OF.isdisjoint(lead))
        or (tuple(lead[-2:-1]) == ("ready",) and last.isdigit())
        or (is_cleared and last in OTHERS and tuple(lead[-2:]) not in OWN)
        or (first == "cancel" and (not second or second in CANCELLED))
        or (first in AFTERWARDS and second not in _NOT_DENIED)
        or (first == "is" and second in AFTERWARDS | {"for"})
        or not ASKED.isdisjoint(lead)
    )


def end_of_denial(behind: Sequence[str]) -> int:
    """Return the number of words that deny what is before them: "clearance not given"."""
    if _DENIED.difference({"clearance", "is"}).isdisjoint(behind[:3]):
        return 0
    return next((at for at, word in enumerate(behind) if word not in _DENIED), len(behind))
