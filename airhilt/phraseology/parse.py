"""The meaning of a call, from its words.

`parse_call` finds the callsign (`callsigns`), then the actions (`actions`). It leaves out words
about others (traffic), separates conditions, and drops actions that are not meant (`denials`).
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, fields, replace
from itertools import accumulate
from typing import NamedTuple

from airhilt.phraseology.actions import FORMS, FREQUENCY_FORM, Form, Read, Segment
from airhilt.phraseology.alphabet import LETTER_OF
from airhilt.phraseology.call import CLEARANCES, REPORTS, Action, Call, Instruction, Kind
from airhilt.phraseology.callsigns import Naming, roster_of
from airhilt.phraseology.denials import NAME, is_meant
from airhilt.phraseology.hits import Hit
from airhilt.phraseology.slots import (
    LEVEL,
    NAMED_RUNWAY,
    RUNWAY,
    designator,
    level_confidence,
    level_ft,
    pressure_of,
    wind_of,
)
from airhilt.phraseology.words import MENDED, Words, words_of

DISTRESS = "mayday"
EMERGENCY_DESCENT = "emergency descent"
URGENCY = "pan"
NO_CALLSIGN = 0.5
"""Confidence in a call that names no callsign on the frequency, or two ambiguous ones."""
CONDITIONS = frozenset({"behind", "after", "when", "until", "before", "once", "if", "unless"})
"""First words of a condition (ICAO Doc 4444, 12.2.7)."""
SLOTS = tuple(each.name for each in fields(Instruction) if each.compare and each.name != "action")
"""Details of an action."""
LONGEST_CONDITION = 9
"""Most words in a condition."""
LONGEST_STATION = 6
"""Most words from "contact" to the frequency."""
CONDITIONED: frozenset[Action] = CLEARANCES | {"hold_position"}
"""Actions that may be followed by a condition with "behind"."""

_TRAFFIC_NOT = frozenset({"pattern", "alert", "circuit"})
_BEFORE_CIRCUIT = frozenset({"left", "right", "closed", "make"})
_ACKNOWLEDGED = frozenset({"roger", "wilco", "affirm", "affirmative", "copy", "copied"})
_REQUESTS = frozenset({"request", "requesting", "requests"})
_SAY_AGAIN = re.compile(
    r"(?<!i )say (?:that |it |all )?again|words twice|say your last|repeat (?:that|your)"
    r"|(?:did not|didn) (?:copy|get|understand|catch)|unreadable|say (?:callsign|call sign)"
)
_READY = re.compile(r"(?<!report )ready(?: (?:for|to)(?!\S)|$| (?=\|))|fully ready|would like")
_DISREGARDED = re.compile(
    r"disregard(?: (?:my|the|your|that|this|last|previous|transmission|call|clearance|takeoff"
    r"|landing|instruction|instructions|all|it))*(?!\S)"
)
_PLACES = re.compile(
    r"(?<!\S)(?:[0-9]{1,2} (?:nautical )?miles? (?:final|out|(?:to the )?(?:north|south|east|west)"
    r"(?:east|west)?|from [a-z]+)|short final|long final|(?:left |right )?(?:downwind|base)"
    r"|(?:on )?final|crosswind|runway vacated|clear of (?:the )?runway|field in sight"
    r"|runway in sight|established)(?!\S)"
)


NAMED_AFTER = CONDITIONS | {
    "traffic", "follow", "to", "for", "by", "with", "from", "of", "the", "is", "and", "company",
    "ahead", "via", "taxi", "exit", "vacate", "taxiway", "intersection", "at", "on", "number",
    "than", "or", "departed", "landed",
}  # fmt: skip
"""Words before a callsign that is not the one called."""


RUNWAY_NEXT = re.compile(rf" runway {RUNWAY}")


class Found(NamedTuple):
    """The words of an action."""

    form: Form
    match: re.Match[str]
    first: int
    """Index of its first word."""


class Span(NamedTuple):
    """Words about traffic, or a condition: no instruction."""

    start: int
    end: int
    is_traffic: bool


@dataclass(slots=True)
class Content:
    """The meaning of some words."""

    instructions: list[Instruction] = field(default_factory=list)
    doing: list[bool] = field(default_factory=list)
    """True if each is being done now, as in "climbing"."""
    traffic: list[str] = field(default_factory=list)


def parse_call(
    text: str,
    callsigns: Iterable[str],
    word_confidences: Sequence[float] | None = None,
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
    """
    words = words_of(text, word_confidences)
    naming = roster_of(tuple(callsigns)).naming(words.texts)
    named = _confidence_of_name(words, naming)
    rest = _without_name(words, naming)
    content = _Reader(rest).read()
    return _call(naming, rest, content, named)


def _call(naming: Naming, rest: Words, content: Content, named: float) -> Call:
    words = rest.texts
    present = set(words)
    text = " ".join(words)
    first = words[1:2] if words[:1] == [NAME] else words[:1]
    corrects = bool({"negative", "correction"}.intersection(first))
    kind = _kind(naming, words, text, content, corrects)
    match = replace(naming.match, score=min(naming.match.score, named))
    certain = match.callsign is not None and not match.ambiguous
    parts = [each.confidence for each in content.instructions]
    parts.append(match.score if certain else NO_CALLSIGN)
    if kind == "unknown":
        parts.append(0.0)
    elif not content.instructions:
        parts.append(min(rest.confidences, default=0.0))
    place = None if naming.addressed_first and kind == "instruction" else _PLACES.search(text)
    return Call(
        match=match,
        addressed_first=naming.addressed_first,
        kind=kind,
        instructions=tuple(content.instructions),
        distress=DISTRESS in present,
        urgency=URGENCY in present,
        emergency_descent=EMERGENCY_DESCENT in text,
        corrected=corrects or "correction" in present,
        negative="negative" in first or "unable" in present,
        acknowledged=not _ACKNOWLEDGED.isdisjoint(present),
        position=place[0] if place else None,
        traffic=tuple(content.traffic),
        wind=wind_of(text) if "wind" in present else None,
        pressure_hpa=pressure_of(text) if present & {"altimeter", "qnh", "q"} else None,
        confidence=min(parts),
    )


def _kind(naming: Naming, words: list[str], text: str, content: Content, corrects: bool) -> Kind:
    present = set(words)
    doing = [
        doing
        for each, doing in zip(content.instructions, content.doing, strict=True)
        if each.action not in REPORTS
    ]
    if "disregard" in present:
        return "disregard"
    if doing and corrects:
        return "correction"
    if not doing and _SAY_AGAIN.search(text):
        return "say_again"
    if present & _REQUESTS or (not naming.addressed_first and _READY.search(text)):
        return "request"
    if doing:
        if naming.addressed_first:
            return "report" if all(doing) else "instruction"
        if naming.hit is None:
            return "readback" if all(doing) else "instruction"
        ends = words[-1] == NAME
        return "readback" if ends or not all(doing) else "report"
    reports = (
        present & {DISTRESS, URGENCY, "unable", "negative"}
        or content.instructions
        or content.traffic
        or not _ACKNOWLEDGED.isdisjoint(present)
        or _PLACES.search(text)
        or LEVEL.search(text)
        or ("wind" in present and wind_of(text))
        or pressure_of(text)
    )
    return "report" if reports else "unknown"


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
            if other is None and at > 0 and not _is_spoken_of(words.texts[hit.start - 1]):
                other = hit
            continue
        rest.take(words, at, other.start if other else hit.start)
        other = None
        if hit.before:
            rest.add(hit.before, words.confidences[hit.start])
        rest.add(NAME, min(words.confidences[hit.start : hit.end]))
        if hit.left_over:
            rest.add(hit.left_over, words.confidences[hit.end - 1])
        at = hit.end
    rest.take(words, at, other.start if other else len(words.texts))
    return rest


def _is_spoken_of(before: str) -> bool:
    """Return whether the word before a callsign shows that it is not the one called."""
    return before in NAMED_AFTER or before in LETTER_OF or before.endswith("ing")


class _Reader:
    """Finds the meaning of words, including those that correct or withdraw others."""

    def __init__(self, words: Words) -> None:
        self._words = words

    def read(self) -> Content:
        """Return the meaning after all corrections."""
        texts = self._words.texts
        if "correction" not in texts and "disregard" not in texts:
            return _content_of(self._words)
        content = Content()
        begin, marker = 0, ""
        for at, word in [*enumerate(texts), (len(texts), "")]:
            if at < len(texts) and word not in ("correction", "disregard"):
                continue
            self._take(content, begin, at, marker)
            begin, marker = at, word
        return content

    def _take(self, content: Content, begin: int, end: int, marker: str) -> None:
        """Add the meaning of the words from a marker on."""
        part = Words(self._words.texts[begin:end], self._words.confidences[begin:end])
        if marker == "disregard":
            content.instructions.clear()
            content.doing.clear()
            content.traffic.clear()
            size = len(_DISREGARDED.match(" ".join(part.texts))[0].split())  # type: ignore[index]
            if size > 1:
                part = Words(part.texts[size:], part.confidences[size:])
        new = _content_of(part)
        content.traffic += new.traffic
        if marker == "correction" and content.instructions:
            if _corrects_itself(content.instructions[-1], new):
                _replace(content, new)
                return
            corrected = _corrected(content.instructions[-1], " ".join(part.texts[1:]))
            if corrected is not None:
                content.instructions[-1] = corrected
            elif new.instructions:
                _replace(content, new)
                return
            else:
                content.instructions.pop()
                content.doing.pop()
        content.instructions += new.instructions
        content.doing += new.doing


def _corrects_itself(last: Instruction, new: Content) -> bool:
    """Return whether "correction" is followed by an instruction, not by a value of the last one."""
    return any(
        each.action == last.action or (each.runway and last.runway) for each in new.instructions
    )


def _replace(content: Content, new: Content) -> None:
    """Replace instructions by those that correct them."""
    actions = {each.action for each in new.instructions}
    kept = [i for i, each in enumerate(content.instructions) if each.action not in actions]
    if len(kept) == len(content.instructions):
        kept.pop()
    content.instructions[:] = [*(content.instructions[i] for i in kept), *new.instructions]
    content.doing[:] = [*(content.doing[i] for i in kept), *new.doing]


def _corrected(last: Instruction, text: str) -> Instruction | None:
    """Return an instruction with its corrected value; None if there is no such value."""
    confidence = min(last.confidence, MENDED)
    if last.runway:
        found = NAMED_RUNWAY.match(text) or re.match(RUNWAY, text)
        return found and replace(last, runway=designator(*found.groups()), confidence=confidence)
    number = re.match(r"([0-9]{3})(?!\S)", text)
    if last.altitude_ft:
        level = LEVEL.match(text)
        if level:
            confidence = min(confidence, level_confidence(level))
            return replace(last, altitude_ft=level_ft(level), confidence=confidence)
        if number and last.altitude_ft % 500 == 0 and 10 <= int(number[1]) <= 660:
            return replace(last, altitude_ft=float(number[1]) * 100.0, confidence=confidence)
        return None
    if last.heading_deg and number and 0 < int(number[1]) <= 360:
        return replace(last, heading_deg=float(number[1]), confidence=confidence)
    if last.speed_kt and number:
        return replace(last, speed_kt=float(number[1]), confidence=confidence)
    if last.frequency_khz and FREQUENCY_FORM.words.match(text):
        content = _content_of(words_of(text)).instructions
        if content:
            return replace(last, frequency_khz=content[0].frequency_khz, confidence=confidence)
    return None


def _content_of(words: Words) -> Content:
    """Return the meaning of words without corrections."""
    texts = words.texts
    text = " ".join(texts)
    starts = [0, *accumulate(len(word) + 1 for word in texts)]
    found, spans = _scan(texts, text, starts)
    content = Content()
    for span in spans:
        if span.is_traffic:
            content.traffic.append(text[span.start : span.end].strip())
            text = _blank(text, span)
    conditions = [span for span in spans if not span.is_traffic]
    plain = text
    for span in conditions:
        plain = _blank(plain, span)
    reads: list[tuple[Read, Found]] = []
    taken, floor, is_said = 0, 0, True
    for index, each in enumerate(found):
        limit = found[index + 1].match.start() if index + 1 < len(found) else len(plain)
        read = each.form.build(Segment(each.match, plain, taken, limit), each.form.action)
        if read is None:
            continue
        taken = read.end
        after = bisect_right(starts, max(each.match.end(), read.end) - 1)
        is_said = is_meant(texts, each.first, after, each.form.action, floor, is_said)
        floor = after
        if is_said:
            reads.append((read, each))
    _attach(conditions, reads, text)
    _merge_levels(reads)
    _withdraw(reads)
    for read, each in reads:
        after_action = bisect_right(starts, each.match.end() - 1)
        action = words.confidences[each.first : after_action]
        before = words.confidences[bisect_right(starts, read.start) - 1 : each.first]
        behind = words.confidences[after_action : bisect_right(starts, read.end - 1)]
        heard = min(action, default=1.0), min([*before, *behind], default=1.0)
        instruction = replace(
            read.instruction,
            confidence=read.instruction.confidence * min(heard),
            action_heard=heard[0],
            details_heard=heard[1],
        )
        _add(content, instruction, is_doing=texts[each.first].endswith("ing"))
    return content


def _add(content: Content, instruction: Instruction, *, is_doing: bool) -> None:
    """Add an instruction, or replace one that has fewer of its details."""
    for index, before in enumerate(content.instructions):
        if _says_all(before, instruction):
            return
        if _says_all(instruction, before):
            content.instructions[index] = instruction
            return
    content.instructions.append(instruction)
    content.doing.append(is_doing)


def _says_all(full: Instruction, part: Instruction) -> bool:
    """Return whether an instruction has all details of another."""
    return full.action == part.action and all(
        getattr(part, slot) in (None, (), False, getattr(full, slot)) for slot in SLOTS
    )


def _blank(text: str, span: Span) -> str:
    """Return a text with the words of a span blanked, so that the others keep their places."""
    words = text[span.start : span.end].rstrip()
    return text[: span.start] + "#" * len(words) + text[span.start + len(words) :]


def _scan(texts: list[str], text: str, starts: list[int]) -> tuple[list[Found], list[Span]]:
    """Return the actions, and the spans of traffic and conditions, in their order."""
    found: list[Found] = []
    spans: list[Span] = []
    open_at: int | None = None
    """Begin of the traffic or the condition that may still go on."""
    is_traffic = False
    free = 0
    for index, word in enumerate(texts):
        start = starts[index]
        if start < free:
            continue
        if word == "traffic" and open_at is None and _is_traffic(texts, index):
            open_at, is_traffic, begun = start, True, index
            continue
        if word in CONDITIONS and not (open_at is not None and not is_traffic):
            if open_at is not None:
                spans.append(Span(open_at, start, is_traffic))
            open_at, is_traffic, begun = start, False, index
            continue
        if open_at is not None and not is_traffic:
            ends = word in (NAME, "runway") or index - begun >= LONGEST_CONDITION
            if ends and not (word == "runway" and texts[index - 1] in ("crossing", "the", "of")):
                spans.append(Span(open_at, start, False))
                open_at = None
        if open_at is not None and is_traffic and word == NAME:
            spans.append(Span(open_at, start, True))
            open_at = None
        each = _action_at(text, start, index, word)
        if each is None or (found and _belongs_to(found[-1], each)):
            continue
        if open_at is not None:
            if word.endswith("ing") and index - begun <= LONGEST_CONDITION:
                free = each.match.end()
                continue
            if texts[index - 1] in CONDITIONS:
                continue
            end = start
            if is_traffic:
                ahead = re.search(rf"runway {RUNWAY}(?: at \S+)? $", text[open_at:start])
                is_said = RUNWAY_NEXT.match(text, each.match.end())
                end = open_at + ahead.start() if ahead and not is_said else start
            spans.append(Span(open_at, end, is_traffic))
            open_at = None
        found.append(each)
        free = each.match.end()
    if open_at is not None:
        spans.append(Span(open_at, len(text), is_traffic))
    return found, spans


def _is_traffic(texts: list[str], index: int) -> bool:
    """Return whether the word "traffic" here means aircraft, not a traffic circuit."""
    return texts[index - 1 : index] not in ([each] for each in _BEFORE_CIRCUIT) and not (
        _TRAFFIC_NOT.intersection(texts[index + 1 : index + 2])
    )


def _action_at(text: str, start: int, index: int, word: str) -> Found | None:
    for form in FORMS.get(word, ()):
        match = form.words.match(text, start)
        if match:
            return Found(form, match, index)
    if word[0] == "1":
        match = FREQUENCY_FORM.words.match(text, start)
        if match:
            return Found(FREQUENCY_FORM, match, index)
    return None


def _belongs_to(last: Found, each: Found) -> bool:
    """Return whether a frequency is that of the station to contact."""
    return (
        each.form is FREQUENCY_FORM
        and last.form.action in ("contact", "monitor")
        and each.first - last.first <= LONGEST_STATION
    )


def _attach(conditions: list[Span], reads: list[tuple[Read, Found]], text: str) -> None:
    """Attach each condition to its action.

    Its action is the next one, or the one before if the condition begins with "until", or with
    "behind" at the end of the call.
    """
    for span in conditions:
        words = text[span.start : span.end].strip()
        before = [i for i, (read, _) in enumerate(reads) if read.start < span.start]
        after = [i for i, (read, _) in enumerate(reads) if read.start >= span.end]
        kind = words.split()[0] if words else ""
        if kind == "behind":
            if len(after) > 1:
                after = [i for i in after if reads[i][0].instruction.action in CONDITIONED] or after
            is_again = before and reads[before[-1]][0].instruction.condition
        if len(words.split()) < 2 and (kind != "behind" or not before or is_again):
            continue
        behind = kind == "behind" and before and (
            not after or reads[after[0]][0].instruction.action not in CONDITIONED
        )  # fmt: skip
        if before and (kind == "until" or behind or not after):
            index = before[-1]
        elif after and kind != "until":
            index = after[0]
        else:
            continue
        read, each = reads[index]
        conditional = replace(read.instruction, condition=words)
        reads[index] = read._replace(instruction=conditional), each


def _merge_levels(reads: list[tuple[Read, Found]]) -> None:
    """Merge two instructions such as "climb now, maintain flight level 330"."""
    for index in range(len(reads) - 1, 0, -1):
        first, second = reads[index - 1][0].instruction, reads[index][0].instruction
        if (
            first.action == second.action == "altitude"
            and first.altitude_ft is None
            and second.altitude_ft is not None
            and (second.sense == "maintain" or second.sense == first.sense)
        ):
            merged = replace(
                first,
                altitude_ft=second.altitude_ft,
                condition=first.condition or second.condition,
                immediate=first.immediate or second.immediate,
                confidence=second.confidence,
            )
            read = reads[index - 1][0]._replace(instruction=merged, end=reads[index][0].end)
            reads[index - 1 : index + 1] = [(read, reads[index - 1][1])]


def _withdraw(reads: list[tuple[Read, Found]]) -> None:
    """Drop the clearances that the same call cancels."""
    for cancel, cleared in (
        ("cancel_takeoff", "cleared_for_takeoff"),
        ("cancel_landing", "cleared_to_land"),
    ):
        cancelled = [read.start for read, _ in reads if read.instruction.action == cancel]
        if cancelled:
            reads[:] = [
                (read, each)
                for read, each in reads
                if read.instruction.action != cleared or read.start > cancelled[-1]
            ]
