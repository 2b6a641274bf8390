"""The meaning of a call, from its words.

`parse_call` finds the callsign (`callsigns`), and puts corrected values in place (`corrections`).
The rest is cut into clauses (`clauses`). Each has the slots of its action (`actions`), is dropped
if its own words deny it (`denials`), and gets its own condition (`conditions`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from airhilt.phraseology.aircraft_names import MAKERS
from airhilt.phraseology.alphabet import LETTER_OF
from airhilt.phraseology.call import REPORTS, Call, Instruction, Kind
from airhilt.phraseology.callsigns import Naming, roster_of
from airhilt.phraseology.clauses import CONDITIONS
from airhilt.phraseology.conditions import doubtful
from airhilt.phraseology.content import Content
from airhilt.phraseology.corrections import content_with_corrections, without_slips
from airhilt.phraseology.forms import UNIT
from airhilt.phraseology.hits import NAME, Hit
from airhilt.phraseology.questions import QUESTION, RADIO_CHECK
from airhilt.phraseology.run_together import split_numbers
from airhilt.phraseology.slots import FIX_ENDS, LEVEL, NO_SENSE, SHORTENED, pressure_of, wind_of
from airhilt.phraseology.spoken_forms import is_registration
from airhilt.phraseology.words import MENDED, Words, words_of

DISTRESS = "mayday"
EMERGENCY_DESCENT = "emergency descent"
URGENCY = "pan"
LONGEST_TRAFFIC = 9
"""Most words from "traffic" to the type of an aircraft, which may sound like a callsign."""
NO_CALLSIGN = 0.5
"""Confidence in a call that names no callsign on the frequency, or two ambiguous ones."""
_ASKS_BACK = re.compile(
    r"(?<!\S)(?:confirm(?: for us)?|is that (?:correct|right|for us)|was that (?:for )?us"
    r"|did (?:i|we) (?:hear|get|copy) that|or (?:us|me|somebody else|someone else))(?: \|)?$"
)
"""The end of a readback of which the speaker is not sure."""
_ASKED_BACK = frozenset({"confirm", "correct", "right", "us", "that", "me", "else"})
"""Last words of `_ASKS_BACK`."""
_WINDY = frozenset({"wind", "land", "takeoff", "option", "touch"})
"""Words beside which a wind is given."""
_SETTING = frozenset({"altimeter", "qnh", "q"})
"""Words before an altimeter setting."""
_ACKNOWLEDGED = frozenset({"roger", "wilco", "affirm", "affirmative", "copy", "copied"})
_REQUESTS = frozenset({"request", "requesting", "requests"})
_SAY_AGAIN = re.compile(
    r"(?<!\S)(?:(?<!i )say (?:that |it |all )?again|words twice|say your last|repeat (?:that|your)"
    r"|(?:did not|didn) (?:copy|get|understand|catch)|unreadable|say (?:callsign|call sign))(?!\S)"
)
_CONFIRM = re.compile(
    r"(?<!\S)(?:confirm|verify|read (?:it|that) back|readback(?! (?:is )?correct))(?!\S)"
)
"""Requests to say what was said: ICAO Annex 10 volume II, 5.2.1.5.8, and "verify" of the FAA's
Pilot/Controller Glossary."""
_STATION = rf"(?:(?!{FIX_ENDS}(?!\S)|the )[a-z]+ ){{0,2}}?(?:{UNIT})(?: good [a-z]+| hello| hi)?"
_HAIL = re.compile(rf"{_STATION}(?: this is)? \||\|(?: this is)? {_STATION}")
"""A call that has only the names of who is called and who calls (Annex 10, 5.2.1.7.3.2.1)."""
_READY = re.compile(
    r"(?<!\S)(?:(?<!report )ready(?: (?:for|to)(?!\S)|$| (?=\|))|(?:fully ready|would like)(?!\S))"
)
_PLACES = re.compile(
    r"(?<!\S)(?:[0-9]{1,2} (?:nautical )?miles? (?:final|out|(?:to the )?(?:north|south|east|west)"
    r"(?:east|west)?|from [a-z]+)|short final|long final|(?:left |right )?(?:downwind|base)"
    r"|(?:on )?final|crosswind|runway vacated|clear of (?:the )?runway|field in sight"
    r"|runway in sight|established)(?!\S)"
)
_PLACED = frozenset(
    {"mile", "miles", "final", "downwind", "base", "crosswind", "vacated", "clear", "sight",
     "established"}
)  # fmt: skip
"""Words of which `_PLACES` has one at least."""


NAMED_AFTER = CONDITIONS | {
    "traffic", "follow", "to", "for", "by", "with", "from", "of", "the", "is", "and", "company",
    "ahead", "via", "taxi", "exit", "vacate", "taxiway", "intersection", "at", "on", "number",
    "than", "or", "departed", "landed", "decimal",
}  # fmt: skip
"""Words before a callsign that is not the one called."""
AHEAD = frozenset({"follow", "following", "behind", "landing", "departing", "passing"})
"""Words before the type of another aircraft, which stands before its callsign."""


def parse_call(
    text: str,
    callsigns: Iterable[str],
    word_confidences: Sequence[float] | None = None,
    *,
    ceilings_ft: Mapping[str, float] | None = None,
) -> Call:
    """Return the meaning of a call.

    Parameters
    ----------
    text
        Words of the call, with numbers in words or digits.
    callsigns
        Callsigns on the frequency.
    word_confidences
        Confidence of the recogniser in each word of the text, in [0, 1].
    ceilings_ft
        Highest level of aircraft, in ft, by callsign. A level above it is doubtful.
    """
    words = words_of(text, word_confidences)
    naming = roster_of(tuple(callsigns)).naming(words.texts)
    named = _confidence_of_name(words, naming)
    rest = _without_name(words, naming)
    said = split_numbers(without_slips(rest))
    content = content_with_corrections(said)
    ceiling_ft = (ceilings_ft or {}).get(naming.match.callsign or "")
    content.instructions = _with_sense(doubtful(content.instructions), ceiling_ft)
    if content.instructions and _asks_back(said.texts):
        content.instructions = [
            replace(each, confidence=min(each.confidence, NO_SENSE))
            for each in content.instructions
        ]
    call = _call(naming, said, content, named)
    return (
        call
        if said is rest or call.corrected
        else replace(call, corrected="correction" in rest.texts)
    )


def _asks_back(words: list[str]) -> bool:
    """Return whether a call ends with a question whether it is right."""
    last = words[-2:-1] if words[-1] == NAME else words[-1:]
    return not _ASKED_BACK.isdisjoint(last) and bool(_ASKS_BACK.search(" ".join(words)))


def _with_sense(instructions: list[Instruction], ceiling_ft: float | None) -> list[Instruction]:
    """Return instructions with low confidence in levels that the aircraft cannot reach."""
    if ceiling_ft is None:
        return instructions
    return [
        replace(each, confidence=min(each.confidence, NO_SENSE))
        if each.altitude_ft is not None and each.altitude_ft > ceiling_ft
        else each
        for each in instructions
    ]


_OF_ORDERS = frozenset(
    {"cleared", "not", "takeoff", "land", "runway", "climb", "descend", "turn", "taxi", "tow",
     "hold", "cross", "line", "approach"}
)  # fmt: skip
"""Words of clearances, orders and prohibitions."""


def _is_obscure(kind: Kind, rest: Words) -> bool:
    """Return whether words clear or forbid something that is not known: whoever hears them asks."""
    return kind == "unknown" and not _OF_ORDERS.isdisjoint(rest.texts)


def _call(naming: Naming, rest: Words, content: Content, named: float) -> Call:
    words = rest.texts
    present = set(words)
    text = " ".join(words)
    first = words[1:2] if words[:1] == [NAME] else words[:1]
    corrects = first in (["negative"], ["correction"])
    kind = _kind(naming, words, present, text, content, corrects)
    is_unread = (content.is_unread or _is_obscure(kind, rest)) and not content.asked
    match = naming.match
    if named < match.score:
        match = replace(match, score=named)
    certain = match.callsign is not None and not match.ambiguous
    parts = [each.confidence for each in content.instructions]
    parts.append(match.score if certain else NO_CALLSIGN)
    if kind == "unknown":
        parts.append(0.0)
    elif not content.instructions:
        parts.append(min(rest.confidences, default=0.0))
    pressure_hpa = None if _SETTING.isdisjoint(present) else pressure_of(text)
    if pressure_hpa is None and content.pressure_hpa is not None:
        pressure_hpa = content.pressure_hpa
        parts.append(SHORTENED)
    is_told = naming.addressed_first and kind == "instruction"
    place = None if is_told or _PLACED.isdisjoint(present) else _PLACES.search(text)
    return Call(
        match=match,
        addressed_first=naming.addressed_first,
        kind=kind,
        instructions=tuple(content.instructions),
        expected=tuple(content.expected),
        asked=tuple(content.asked),
        unread=naming.addressed_first and is_unread,
        distress=DISTRESS in present,
        urgency=URGENCY in present,
        emergency_descent=EMERGENCY_DESCENT in text,
        corrected=corrects or "correction" in present,
        disregards=content.disregards,
        negative="negative" in first or "unable" in present,
        acknowledged=not _ACKNOWLEDGED.isdisjoint(present),
        asks_again=kind == "say_again"
        or (not content.instructions and bool(_CONFIRM.search(text))),
        position=place[0] if place else None,
        traffic=tuple(content.traffic),
        wind=None if _WINDY.isdisjoint(present) else wind_of(text),
        pressure_hpa=pressure_hpa,
        confidence=min(parts),
        text=text,
    )


def _kind(
    naming: Naming,
    words: list[str],
    present: set[str],
    text: str,
    content: Content,
    corrects: bool,
) -> Kind:
    actions = [each.action for each in content.instructions if each.action not in REPORTS]
    doing = [action in content.doing for action in actions]
    if "disregard" in present:
        return "disregard"
    if doing and corrects:
        return "correction"
    if not doing and _SAY_AGAIN.search(text):
        return "say_again"
    is_ready = "ready" in text or "would like" in text
    is_requested = not _REQUESTS.isdisjoint(present)
    if is_requested or (is_ready and not naming.addressed_first and _READY.search(text)):
        return "request"
    if doing:
        if naming.addressed_first:
            return "report" if all(doing) else "instruction"
        if naming.hit is None:
            return "readback" if all(doing) else "instruction"
        ends = words[-1] == NAME
        return "readback" if ends or not all(doing) else "report"
    if RADIO_CHECK.search(text):
        return "radio_check"
    if naming.addressed_first and (content.asked or QUESTION.match(text)):
        return "question"
    reports = (
        present & {DISTRESS, URGENCY, "unable", "negative"}
        or content.instructions
        or content.expected
        or content.traffic
        or not _ACKNOWLEDGED.isdisjoint(present)
        or _PLACES.search(text)
        or LEVEL.search(text)
        or ("wind" in present and wind_of(text))
        or pressure_of(text)
    )
    if reports:
        return "report"
    return "hail" if _HAIL.fullmatch(text) else "unknown"


def _confidence_of_name(words: Words, naming: Naming) -> float:
    """Return the confidence in the words of the callsign, lower if they had to be mended."""
    hit = naming.hit
    if hit is None:
        return 1.0
    confidence = min(words.confidences[hit.start : hit.end], default=1.0)
    return hit.score * confidence * (MENDED if hit.is_mended and hit.score == 1.0 else 1.0)


def _without_name(words: Words, naming: Naming) -> Words:
    """Return the words with `NAME` for the callsign of the call, and without other callsigns."""
    if naming.hit is None:
        return words
    rest = Words()
    at = 0
    other: Hit | None = None
    for hit in sorted((naming.hit, *naming.again, *naming.others)):
        if hit.start < at:
            continue
        if hit.callsign != naming.hit.callsign:
            if other is None and at > 0 and not _is_spoken_of(words.texts[at : hit.start]):
                other = hit
            continue
        rest.take(words, at, other.start if other else hit.start - _makers_before(words.texts, hit))
        other = None
        if hit.before:
            rest.add(hit.before, words.confidences[hit.start])
        rest.add(NAME, min(words.confidences[hit.start : hit.end]))
        if hit.left_over:
            rest.add(hit.left_over, words.confidences[hit.end - 1])
        at = hit.end
    rest.take(words, at, other.start if other else len(words.texts))
    return rest


def _makers_before(words: list[str], hit: Hit) -> int:
    """Return the number of words before a registration that are the maker's name: "king air"."""
    for size in (2, 1):
        if hit.start >= size and "".join(words[hit.start - size : hit.start]) in MAKERS:
            return size if is_registration(hit.callsign) else 0
    return 0


def _is_spoken_of(before: list[str]) -> bool:
    """Return whether the words before a callsign show that it is not the one called."""
    last = before[-1] if before else NAME
    is_traffic = "traffic" in before[-LONGEST_TRAFFIC:]
    is_type = last.isalpha() and not AHEAD.isdisjoint(before[-2:])
    return is_traffic or is_type or last in NAMED_AFTER or last in LETTER_OF or last.endswith("ing")
