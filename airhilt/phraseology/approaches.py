"""Forms of approach clearances (FAA Order JO 7110.65, 4-8; ICAO Doc 4444, 12.3.3.2, 12.4.2)."""

from __future__ import annotations

import re

from airhilt.phraseology.alphabet import LETTER_OF, LETTERS
from airhilt.phraseology.call import Action, Instruction
from airhilt.phraseology.forms import (
    BARE_VALUE,
    Listed,
    Read,
    Segment,
    alone,
    on_runway,
    runway_before,
)
from airhilt.phraseology.slots import NAMED_RUNWAY, RUNWAY, SHORTENED, designator, runway_confidence

KINDS: dict[str, str] = {
    "i l s": "ils", "ils": "ils", "visual": "visual", "r nav": "rnav", "rnav": "rnav",
    "r n p": "rnp", "rnp": "rnp", "localizer": "localizer", "localiser": "localizer",
    "v o r": "vor", "vor": "vor", "gps": "gps", "g p s": "gps", "circling": "circling",
    "ndb": "ndb", "n d b": "ndb", "l d a": "lda", "s d f": "sdf", "g l s": "gls", "tacan": "tacan",
    "p a r": "par", "s r a": "sra", "contact": "contact",
}  # fmt: skip
"""Kinds of approaches by their words (FAA Order JO 7110.65, 4-8-1)."""


def approach(segment: Segment, action: Action) -> Read | None:
    """Read an approach clearance: the kind, the variant and the runway."""
    read = on_runway(segment, action)
    if read is None:
        return None
    told = read.instruction
    named = _named(segment.found, told.runway, told.confidence)
    return Read(named, read.start, read.end)


def circle(segment: Segment, action: Action) -> Read | None:
    """Read the runway to circle to."""
    runway = re.match(
        rf"(?: (?:north|south|east|west)(?:bound)?)?(?: of the (?:field|airport))?"
        rf" (?:(?:to|for) )?(?:land )?(?:runway )?{RUNWAY}",
        segment.after,
    )
    named = runway or runway_before(segment)
    if named is None:
        return None
    number, side = named.group(1, 2)
    read = Instruction(action, designator(number, side), confidence=runway_confidence(number))
    start = segment.start if runway else segment.begin + named.start()
    return Read(read, start, segment.found.end() + (runway.end() if runway else 0))


def named_approach(text: str) -> Instruction | None:
    """Return the approach that a text names."""
    found = NAMED_APPROACH.match(text)
    if found is None:
        return None
    runway = NAMED_RUNWAY.search(found[0])
    confidence = runway_confidence(runway[1]) if runway else BARE_VALUE
    return _named(found, designator(*runway.groups()) if runway else None, confidence)


def _named(found: re.Match[str], runway: str | None, confidence: float) -> Instruction:
    """Return the approach in the words that were found."""
    parts = found.groupdict()
    kind, variant = KINDS.get(parts.get("kind") or ""), parts.get("variant")
    if parts.get("back"):
        kind = "localizer back course"
    letter = LETTER_OF.get(variant, variant.upper()) if variant else None
    if kind is None or variant == "a":
        confidence = min(confidence, SHORTENED)
    return Instruction(
        "cleared_approach", runway, approach=kind, variant=letter, confidence=confidence
    )


_KIND = "|".join(KINDS).replace("contact", "contact(?= approach)")
_VARIANT = rf"(?: (?P<variant>{'|'.join(LETTERS)}|[a-z])(?= runway| approach| [0-9]| \||$))?"
_RUNWAY = r"runway [0-9]{1,2}(?: (?:left|right|centre|l|r|c))?"
_APPROACH = rf"(?P<kind>{_KIND})(?P<back> back course)?(?: d m e)?{_VARIANT}(?: {_RUNWAY})?"
NAMED_APPROACH = re.compile(rf"{_APPROACH}(?!\S)(?: approach)?(?: {_RUNWAY})?(?!\S)")

FORMS: Listed = (
    ("clear cleared", "cleared_approach",
     r"clear(?:ed)? (?:for |to (?=the ))?(?:the |a )?(?:straight in )?"
     rf"{_APPROACH}(?: approach)?", approach),
    ("clear cleared", "cleared_approach",
     r"clear(?:ed)? (?:for )?(?:the |an )?(?:straight in )?approach", approach),
    ("circle", "circle", r"circle(?: to land(?! (?:runway )?[0-9]))?", circle),
    ("cancel cancelling", "cancel_approach",
     r"cancel(?:ling)? (?:your |the )?approach(?: clearance)?",
     alone),
    ("approach", "cancel_approach", r"approach clearance (?:is )?cancelled", alone),
    ("missed", "missed_approach", r"(?<!of )(?<!of a )missed approach", alone),
    ("execute executing", "missed_approach", r"execut(?:e|ing) (?:the )?missed(?: approach)?",
     alone),
    ("on", "missed_approach", r"on the missed", alone),
    ("go going", "missed_approach", r"go(?:ing)? missed", alone),
)  # fmt: skip
"""Forms of approaches."""
