"""Speaker of a call, a pilot or a controller, by its words and their order.

A controller begins with the callsign of whom is called; a pilot begins with the name of the unit,
and ends a readback with the own callsign (ICAO Annex 10 volume II, 5.2.1.7.3.2.3 and 5.2.1.9.2.2;
FAA AIM 4-2-3). Each sign adds to the logarithm of the odds. The weights are assumptions, not
fitted to recordings.
"""

from __future__ import annotations

import math
import re
from typing import Literal, NamedTuple

from airhilt.phraseology.hits import NAME, STATIONS

Speaker = Literal["controller", "pilot"]

_UNIT = "|".join(sorted(STATIONS - {"final", "information", "clearance"}))
_NAME = re.escape(NAME)
_ORDER = (
    (rf"^{_NAME} (?:\S+ ){{0,2}}(?:{_UNIT})(?!\S)", -1.5),
    (rf"^{_NAME} (?!$)", -1.5),
    (rf"^(?!.*{_NAME})", 0.7),
    (rf"[^{_NAME}] {_NAME}$", 2.5),
    (rf"^(?!{_NAME})(?:\S+ ){{1,3}}(?:{_UNIT})(?: \S+){{0,3}} {_NAME}", 2.5),
    (rf"^(?:{_NAME} )?(?:fully )?(?!during|nothing)[a-z]{{2,}}(?:ing|ished) ", 2.5),
    (rf"^(?:{_NAME} )?(?:roger|wilco|copy|okay|all right|affirmative|affirm|looking)(?!\S)", 2.0),
)
"""Signs by the order of callsigns, units and verbs: positive for a pilot."""
_PHRASES = (
    ("request|requesting|wilco|we|we're|we'll|we've|our|us|mayday|pan|declaring", 2.0),
    ("with you|looking|minimum fuel|missed approach|on the missed|clear of conflict", 1.5),
    ("unable|ready|checking in|inbound|airborne|say again|over to|icing|t cas", 1.5),
    ("in sight|climbing|descending|turning|leaving|passing|going around|holding|vacated", 1.0),
    ("report|expect|caution|oclock|advise|say|verify|confirm|you|your|disregard", -1.5),
    ("radar contact|readback correct|low altitude alert|terminated|approved|go around", -2.0),
    ("surface wind|wind [0-9]{3}|altimeter|qnh|number [0-9]|released", -0.7),
    (r"(?:report|say) (?:\S+ ){0,4}in sight", -1.5),
)
"""Words of pilots, positive, and of controllers."""
_SIGNS = tuple(
    (re.compile(pattern), weight)
    for pattern, weight in (
        *_ORDER,
        *((rf"(?<!\S)(?:{words})(?!\S)", weight) for words, weight in _PHRASES),
    )
)


class Spoken(NamedTuple):
    """Speaker of a call, with the likelihood of that."""

    speaker: Speaker
    confidence: float
    """Probability by the weights, 0.5 to 1."""


def speaker_of(text: str) -> Spoken:
    """Return who speaks by the words of a call, with `NAME` for its callsign."""
    odds = sum(weight for pattern, weight in _SIGNS if pattern.search(text))
    speaker: Speaker = "pilot" if odds > 0.0 else "controller"
    return Spoken(speaker, 1.0 / (1.0 + math.exp(-abs(odds))))
