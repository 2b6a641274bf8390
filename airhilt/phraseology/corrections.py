"""Corrections within a call: "correction" and "disregard" (ICAO Annex 10 volume II, 5.2.1.5.8)."""

from __future__ import annotations

import re
from dataclasses import replace

from airhilt.phraseology.call import CLEARANCES, Instruction
from airhilt.phraseology.content import Content, content_of
from airhilt.phraseology.slots import (
    LETTER,
    NO_SENSE,
    RUNWAY,
    SHORTENED,
    SIDED_RUNWAY,
    TAXIWAY,
)
from airhilt.phraseology.words import MENDED, Words

_DISREGARDED = re.compile(
    r"disregard(?: (?:my|the|your|that|this|last|previous|transmission|call|clearance|takeoff"
    r"|landing|instruction|instructions|all|it"
    r"|(?:taxi|approach|crossing|heading|speed|push)(?= clearance(?!\S)| instruction)))*"
    r"(?:(?<= the) (?:go around|approach|climb|descent|turn|speed|squawk|hold|taxi|push"
    r"|frequency(?: change)?|heading|line up|crossing)(?: clearance)?)?(?!\S)"
)
_LEVEL = r"(?:(?:flight )?level [0-9]{1,3}|[0-9]{1,2} thousand(?: [1-9]00)?(?: feet)?)"
_NUMBER = r"(?:[0-9]{3,5}|(?<!decimal )[0-9]{1,2})(?: knots| feet| degrees)?"
_SLIP = re.compile(
    rf"(?:({_LEVEL})|(?<!\S)({_NUMBER})) correction (?=({_LEVEL})|({_NUMBER})(?!\S))"
)
_VERBS = (
    "turn", "taxi", "hold", "cross", "climb", "descend", "maintain", "contact", "monitor", "fly",
    "via", "follow", "continue", "reduce", "increase", "proceed", "direct", "line", "exit", "go",
    "stop", "squawk", "expect",
)  # fmt: skip
"""First words of instructions."""
_RUNWAY_SLIP = re.compile(
    rf"(?<!\S)(?:(?:runway )?{SIDED_RUNWAY} correction (?=(?:runway )?{SIDED_RUNWAY})"
    rf"|runway {RUNWAY}(?: at {TAXIWAY})? correction (?=runway {RUNWAY}(?: \||$)))"
)
_ROUTE_SLIP = re.compile(
    rf"(?<!\S)(?P<said>{LETTER}(?: [0-9]{{1,2}}(?!\S))?(?: {LETTER}(?: [0-9]{{1,2}}(?!\S))?)*)"
    rf" correction (?P<via>via )?(?P<meant>(?={LETTER}){TAXIWAY}(?: (?={LETTER}){TAXIWAY})*)"
)
"""A route, and the one that corrects it."""
_MEANT = re.compile(
    r"(?<!\S)(?:(?:no|oh|actually|negative) )*(?:(?:i )?sorry|make that|scratch that|i mean|i meant"
    r"|(?<=no )(?:it|that|make it)(?: is)?)(?: (?:it|that|make that|that is|it is))*"
    r"(?= (?:(?:runway|heading|flight|level|left|right|turn)(?!\S)|[0-9]))"
    r"|(?<=[0-9] )no(?= [0-9])|(?<=thousand )no(?= [0-9])"
)
_INSTEAD = re.compile(
    r"(?<!\S)(?:no|oh|negative|actually|er|sorry) (?:sorry )?"
    r"(?:(?:i )?(?:make|scratch) that|i meant?)"
    rf"(?= (?:{'|'.join(_VERBS)})(?!\S))"
)
"""Words that mean "correction", between an instruction and another one."""
_TURN_SLIP = re.compile(
    rf"(?<!\S)(?:left|right) (?:on|onto|at) {TAXIWAY} correction"
    rf"(?= (?:left|right) (?:on|onto|at) {TAXIWAY})"
)
"""Words that mean "correction", between a value and another one."""
_TURNS_BEFORE = re.compile(rf"(?:left|right) (?:on|onto|at) {TAXIWAY}")
_MEANING = frozenset({"sorry", "mean", "meant", "make", "scratch", "no"})


def without_slips(words: Words) -> Words:
    """Return words in which a value replaces the one that it corrects.

    ``climb flight level 350 correction 360`` is ``climb flight level 360``.
    """
    words = _with_correction(words)
    while "correction" in words.texts:
        text = " ".join(words.texts)
        runway = _RUNWAY_SLIP.search(text) or _TURN_SLIP.search(text)
        if runway:
            words = _without(words, text, *runway.span())
            continue
        route = _ROUTE_SLIP.search(text)
        if route and (route["via"] or route["said"].split()[0] == route["meant"].split()[0]):
            size = len(route["meant"].split())
            words = _without(words, text, route.start(), route.start("meant"), size)
            continue
        found = _SLIP.search(text)
        if found is None:
            return words
        level, _, to_level, to_number = found.groups()
        start, end = found.span()
        if level and to_number and not to_level:
            if "level" not in level or len(to_number) != 3:
                return words
            start += level.index("level") + len("level ")
        elif bool(level) != bool(to_level):
            return words
        words = _without(words, text, start, end, len((to_level or to_number).split()))
    return words


def _without(words: Words, text: str, start: int, end: int, size: int = 0) -> Words:
    """Return words without a part of their text; of the next ``size`` words nobody is as sure."""
    first, last = len(text[:start].split()), len(text[:end].split())
    mended = Words(words.texts[:first], words.confidences[:first])
    for index in range(last, len(words.texts)):
        sure = MENDED if index < last + size else 1.0
        mended.add(words.texts[index], words.confidences[index] * sure)
    return mended


def _with_correction(words: Words) -> Words:
    """Return words with "correction" for what else corrects a value: "make that", "I mean"."""
    if _MEANING.isdisjoint(words.texts):
        return words
    text = " ".join(words.texts)
    found = _MEANT.search(text)
    is_value = found is not None and (
        any(sign.isdigit() for sign in text[: found.start()]) or _TURNS_BEFORE.search(text)
    )
    if not is_value:
        found = _INSTEAD.search(text)
    if found is None:
        return words
    first, last = len(text[: found.start()].split()), len(text[: found.end()].split())
    mended = Words(words.texts[:first], words.confidences[:first])
    mended.add("correction", min(words.confidences[first:last]))
    mended.take(words, last, len(words.texts))
    return mended


def content_with_corrections(words: Words) -> Content:
    """Return the meaning of words, including those that correct or withdraw others."""
    texts = words.texts
    if "correction" not in texts and "disregard" not in texts:
        return content_of(words)
    content = Content()
    begin, marker = 0, ""
    for at, word in [*enumerate(texts), (len(texts), "")]:
        if at < len(texts) and word not in ("correction", "disregard"):
            continue
        part = Words(texts[begin:at], words.confidences[begin:at])
        _take(content, part, marker)
        begin, marker = at, word
    return content


def _take(content: Content, part: Words, marker: str) -> None:
    """Add the meaning of the words from a marker on."""
    withdrawn, is_anew = list(content.instructions), False
    if marker == "disregard":
        content.instructions.clear()
        content.traffic.clear()
        size = len(_DISREGARDED.match(" ".join(part.texts))[0].split())  # type: ignore[index]
        is_anew = size == 1
        part = Words(part.texts[size:], part.confidences[size:])
        content.disregards |= not withdrawn and part.texts[:2] != ["the", "traffic"]
    elif marker == "correction":
        part = Words(part.texts[1:], part.confidences[1:])
    new = content_of(part)
    if is_anew:
        new.instructions = [
            _given_anew(each, withdrawn) for each in new.instructions if each not in withdrawn
        ]
    content.traffic += new.traffic
    content.doing |= new.doing
    content.is_unread |= new.is_unread
    content.pressure_hpa = new.pressure_hpa or content.pressure_hpa
    if marker == "correction" and content.instructions:
        if new.instructions:
            _replace(content, new)
            return
        content.instructions.pop()
    content.instructions += new.instructions


def _given_anew(told: Instruction, withdrawn: list[Instruction]) -> Instruction:
    """Return what is said behind a bare "disregard": a clearance may be what is withdrawn."""
    if told.action not in CLEARANCES:
        return told
    is_again = any(told.action == each.action for each in withdrawn)
    return replace(told, confidence=min(told.confidence, NO_SENSE if is_again else SHORTENED))


def _replace(content: Content, new: Content) -> None:
    """Replace instructions by those that correct them."""
    actions = {each.action for each in new.instructions}
    said = {each.action: each for each in content.instructions}
    new.instructions = [_completed(each, said.get(each.action)) for each in new.instructions]
    kept = [each for each in content.instructions if each.action not in actions]
    if len(kept) == len(content.instructions):
        kept.pop()
    content.instructions[:] = [*kept, *new.instructions]


def _completed(new: Instruction, last: Instruction | None) -> Instruction:
    """Return a corrected instruction with the station or the side that it does not say again."""
    if last is None:
        return new
    if new.action in ("contact", "monitor") and new.position is None:
        return replace(new, position=last.position)
    if new.action == "heading" and new.turn is None:
        return replace(new, turn=last.turn)
    return new
