"""The meaning of words without corrections: what they instruct, expect and say of traffic."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field, fields, replace
from itertools import accumulate

from airhilt.phraseology.bare_values import bare_values
from airhilt.phraseology.call import CLEARANCES, REPORTS, Instruction
from airhilt.phraseology.conditions import Reads, attach, merge_levels, put_in_order, withdraw
from airhilt.phraseology.denials import is_meant
from airhilt.phraseology.forms import Read, Segment
from airhilt.phraseology.hits import NAME
from airhilt.phraseology.scan import Found, Scan, Span
from airhilt.phraseology.slots import PRESSURE, SHORTENED
from airhilt.phraseology.vocabulary import has_unknown_side, is_unknown
from airhilt.phraseology.words import Words

SLOTS = tuple(each.name for each in fields(Instruction) if each.compare and each.name != "action")
"""Details of an action."""
CLEAR = (1.0, 1.0)
"""Confidences of a recogniser that has no doubt about the action and its details."""


@dataclass(slots=True)
class Content:
    """The meaning of some words."""

    instructions: list[Instruction] = field(default_factory=list)
    doing: list[bool] = field(default_factory=list)
    """True if each is being done now, as in "climbing"."""
    expected: list[Instruction] = field(default_factory=list)
    traffic: list[str] = field(default_factory=list)


def content_of(words: Words) -> Content:
    """Return the meaning of words without corrections."""
    texts = words.texts
    text = " ".join(texts)
    starts = [0, *accumulate(len(word) + 1 for word in texts)]
    scan = Scan(texts, text, starts)
    content = Content()
    for span in scan.spans:
        if span.is_traffic:
            content.traffic.append(text[span.start : span.end].strip())
            text = _blank(text, span)
    conditions = [span for span in scan.spans if not span.is_traffic]
    plain = text
    for span in conditions:
        plain = _blank(plain, span)
    reads = _reads(scan, texts, plain, starts)
    attach(conditions, reads, text)
    merge_levels(reads)
    withdraw(reads)
    put_in_order(reads, texts, text)
    if texts[:1] != [NAME]:
        for told in _bare(reads, scan, plain, starts, words):
            _add(content, told, is_doing=False)
    for read, each in reads:
        after_action = bisect_right(starts, each.match.end() - 1)
        action = words.confidences[each.first : after_action]
        before = words.confidences[bisect_right(starts, read.start) - 1 : each.first]
        behind = words.confidences[after_action : bisect_right(starts, read.end - 1)]
        heard = min(action, default=1.0), min([*before, *behind], default=1.0)
        for told in (read.instruction, *read.more):
            if _is_doubtful(told, plain, read, each):
                told = replace(told, confidence=min(told.confidence, SHORTENED))
            instruction = told if heard == CLEAR else _heard(told, *heard)
            if read.is_expected:
                content.expected.append(instruction)
            else:
                _add(content, instruction, is_doing=texts[each.first].endswith("ing"))
    return content


def _is_doubtful(told: Instruction, text: str, read: Read, each: Found) -> bool:
    """Return whether words may be missing that change what an instruction means.

    They are the side of a runway, the "are" of a question, and a condition of which one unknown
    word is left: "super able climb" may have been "when able climb".
    """
    if told.runway is not None and has_unknown_side(text, read.start, read.end):
        return True
    before = text[: min(read.start, each.match.start())].rsplit(maxsplit=2)[-2:]
    if not before or told.action in REPORTS:
        return False
    if told.action in CLEARANCES and before[-1] in ("we", "i"):
        return True
    return (
        before[-1] == "or"
        or is_unknown(before[-1])
        or (before[-1] == "and" and is_unknown(before[0]))
    )


def _heard(told: Instruction, action: float, details: float) -> Instruction:
    """Return an instruction with the confidences of the recogniser in its words."""
    return replace(
        told,
        confidence=told.confidence * min(action, details),
        action_heard=action,
        details_heard=details,
    )


def _bare(
    reads: Reads, scan: Scan, text: str, starts: list[int], words: Words
) -> list[Instruction]:
    """Return the values that stand alone between the actions of a readback."""
    taken = [(read.start, read.end) for read, _ in reads]
    taken += [(span.start, span.end) for span in scan.spans]
    told: list[Instruction] = []
    at = 0
    for start, end in [*sorted(taken), (len(text), len(text))]:
        gap = text[at:start].strip(" |")
        if not gap:
            at = max(at, end)
            continue
        between = words.confidences[bisect_right(starts, at - 1) : bisect_right(starts, start - 1)]
        heard = min(between, default=1.0)
        told += (_heard(each, heard, heard) for each in bare_values(PRESSURE.sub("", gap).split()))
        at = max(at, end)
    return told


def _end_of_limit(spans: list[Span], begin: int, each: Found, starts: list[int]) -> int:
    """Return the index after a limit between two actions: "maintain 3000 until LANDER cleared"."""
    for span in spans:
        if begin <= span.start < each.match.start() and not span.is_traffic:
            return bisect_right(starts, span.end - 1)
    return 0


def _end_of_condition(spans: list[Span], each: Found, starts: list[int]) -> int:
    """Return the index of an action right behind its condition, else 0: "once clear contact"."""
    start = each.match.start()
    is_behind = any(span.end == start and not span.is_traffic for span in spans)
    begun = next((span.start for span in spans if span.end == start), start)
    return each.first if is_behind and each.first - bisect_right(starts, begun) > 0 else 0


def _reads(scan: Scan, texts: list[str], plain: str, starts: list[int]) -> Reads:
    """Return the instructions of the actions that are meant."""
    reads: Reads = []
    taken, floor, is_said = 0, 0, True
    found = scan.found
    for index, each in enumerate(found):
        limit = found[index + 1].match.start() if index + 1 < len(found) else len(plain)
        read = each.form.build(Segment(each.match, plain, taken, limit), each.form.action)
        if read is None:
            continue
        taken = read.end
        after = bisect_right(starts, max(each.match.end(), read.end) - 1)
        if each.form.action == "cleared_approach" and reads:
            floor = max(floor, _end_of_limit(scan.spans, reads[-1][0].end, each, starts))
        if scan.spans and each.form.action not in CLEARANCES:
            floor = max(floor, _end_of_condition(scan.spans, each, starts))
        is_said = is_meant(texts, each.first, after, each.form.action, floor, is_said)
        floor = after
        if is_said:
            reads.append((read, each))
    return reads


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
