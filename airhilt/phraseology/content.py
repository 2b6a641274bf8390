"""The meaning of words without corrections: what they instruct, expect and say of traffic."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, fields, replace
from typing import NamedTuple

from airhilt.phraseology.bare_routes import bare_route
from airhilt.phraseology.bare_values import bare_values, without_courtesies
from airhilt.phraseology.call import (
    CLEARANCES,
    OTHERWISE,
    REPORTS,
    STOPS,
    Action,
    Asks,
    Instruction,
    Question,
)
from airhilt.phraseology.clauses import Line, Span
from airhilt.phraseology.conditions import (
    SEQUENCED,
    YIELDED,
    Clause,
    attach,
    merge_levels,
    put_in_order,
    withdraw,
)
from airhilt.phraseology.denials import ASKS, end_of_denial, is_expected, is_meant
from airhilt.phraseology.forms import Segment
from airhilt.phraseology.hits import NAME
from airhilt.phraseology.neighbours import is_unexplained_before, is_unexplained_behind
from airhilt.phraseology.questions import asks, is_asked_afterwards
from airhilt.phraseology.slots import FIX, LEVEL, LEVEL_WORDS, PRESSURE, SHORTENED
from airhilt.phraseology.vocabulary import has_unknown, has_unknown_side, is_unknown
from airhilt.phraseology.words import Words

SLOTS = tuple(each.name for each in fields(Instruction) if each.compare and each.name != "action")
"""Details of an action."""
_VIA = re.compile(r"(?<!\S)(?:climb|descend) via(?: [^\s|]+){0,4} ?$")
_OF_PROCEDURE = re.compile(
    r"(?: (?!ahead|caution|contact|expect|monitor|on|report)[^\s|]+){0,5}"
    r" (?:arrival|departure|transition)(?!\S)"
)
"""Words before and behind the name of a procedure, which has no word of a report or an order."""
_VALUED = frozenset({"altitude", "heading", "speed", *CLEARANCES} - {"taxi", "cleared_approach"})
"""Actions whose value stands near their words, without unknown words between."""
_VERBS = (
    "make", "do(?! (?:you|not|i|we|they)(?!\\S))", "fly", "leave", "return", "get", "move",
    "wait(?= [a-z])",
    "slow", "taxi", "drive", "speed(?= up)", "hurry", "keep", "widen", "offset", "shorten",
    "square", "break", "pull", "push", "start", "rock", "lower", "back(?= up)",
    "continue", "proceed", "turn",
    "climb", "descend", "hold", "cross", "stop", "clear(?= (?:the )?runway)", "land",
    "go(?! ahead)", "follow", "join", "maintain", "reduce", "increase", "abort", "wave",
    "circle", "orbit", "exit", "vacate", "line", "cancel", "come", "park", "use(?! caution)",
    "(?:stay|remain)(?! (?:this|with|on (?:this|my)))", "side", "change(?! to runway)", "switch",
    "give",
    "take(?! care)", "intercept", "recycle", "reset", "adjust", "divert", "extend", "resume",
)  # fmt: skip
"""First words of orders."""
_ORDERS = re.compile(
    r"[ |]*(?:(?:and|then|also|now|please|just|so|okay|ok|roger|you|can|may|thanks|thank) )*"
    rf"(?:{'|'.join(_VERBS)})(?!\S)"
)
"""Beginning of an order, behind courtesies."""
_AT = re.compile(r"(?:at|passing|leaving|reaching|crossing|over|abeam) ")
"""Beginning of words behind an action that say where or when it is done."""
_AT_PLACE = re.compile(rf"{_AT.pattern}(?:{LEVEL_WORDS}|{FIX})")
_PASSING = re.compile(r" ?(?:climbing|descending)(?!\S)")
"""Words behind a level that is only passed."""


@dataclass(slots=True)
class Content:
    """The meaning of some words."""

    instructions: list[Instruction] = field(default_factory=list)
    doing: set[Action] = field(default_factory=set)
    """Actions that are being done now, as in "climbing"."""
    expected: list[Instruction] = field(default_factory=list)
    asked: list[Question] = field(default_factory=list)
    traffic: list[str] = field(default_factory=list)
    disregards: bool = False
    """True if it withdraws what was told before."""
    is_unread: bool = False
    """True if an order stands in it that nobody can make out."""
    pressure_hpa: float | None = None
    """Altimeter setting that was read back without its word."""


def content_of(words: Words) -> Content:
    """Return the meaning of words without corrections."""
    line = Line(words)
    text = line.text
    content = Content()
    for span in line.spans:
        if span.is_traffic:
            content.traffic.append(text[span.start : span.end].strip())
            text = _blank(text, span)
    conditions = [span for span in line.spans if not span.is_traffic]
    plain = text
    for span in conditions:
        plain = _blank(plain, span)
    clauses, content.asked = _clauses(line, plain)
    attach(conditions, clauses, text)
    merge_levels(clauses, plain)
    withdraw(clauses)
    put_in_order(clauses, line.texts, text)
    gaps = _gaps(clauses, line, plain)
    gaps, is_lost = _wait_for_places(clauses, gaps, plain)
    content.is_unread = is_lost or any(
        _ORDERS.match(plain, gap.start, gap.end) and (len(gap.words) > 2 or gap.end == len(plain))
        for gap in gaps
    )
    if gaps:
        _take_bare(content, gaps, clauses, line, text)
    for clause in clauses:
        is_beside = bool(gaps) and _is_beside_unexplained(clause, plain, clauses)
        heard = _confidences(clause, line)
        for told in (clause.told, *clause.more):
            is_doubtful = is_beside or _is_doubtful(told, plain, clause)
            sure = min(told.confidence, SHORTENED) if is_doubtful else told.confidence
            told = _heard(told, sure, *heard)
            if clause.is_expected:
                content.expected.append(told)
            else:
                _add(content, told, is_doing=line.texts[clause.found.first].endswith("ing"))
    return content


def _confidences(clause: Clause, line: Line) -> tuple[float, float]:
    """Return the least confidences of the recogniser in an action and in its details."""
    found = clause.found
    begin, end = line.index(clause.start), line.index(clause.end - 1) + 1
    after_action = line.index(found.match.end() - 1) + 1
    details = min(line.heard(begin, found.first), line.heard(after_action, end))
    return line.heard(found.first, after_action), details


def _is_doubtful(told: Instruction, text: str, clause: Clause) -> bool:
    """Return whether words may be missing that change what an instruction means.

    They are the side of a runway, the "are" of a question, and a condition of which one unknown
    word is left: "super able climb" may have been "when able climb". An animal without a place may
    be of the name of one: "deer park".
    """
    if told.action == "wildlife" and told.runway is None and told.position is None:
        behind = text[clause.end :].split(maxsplit=1)
        if behind and is_unknown(behind[0]):
            return True
        if _VIA.search(text, 0, clause.start) and _OF_PROCEDURE.match(text, clause.end):
            return True
    if told.runway is not None and has_unknown_side(text, clause.start, clause.end):
        return True
    if told.action in _VALUED and has_unknown(text[clause.found.match.end() : clause.end].split()):
        return True
    before = text[: min(clause.start, clause.found.match.start())].rsplit(maxsplit=2)[-2:]
    if not before or told.action in REPORTS:
        return False
    if told.action in CLEARANCES and before[-1] in ("we", "i"):
        return True
    return (
        (before[-1] == "or" and told.condition != OTHERWISE)
        or is_unknown(before[-1])
        or (before[-1] == "and" and is_unknown(before[0]))
    )


def _is_beside_unexplained(clause: Clause, text: str, clauses: list[Clause]) -> bool:
    """Return whether words right beside an instruction belong to no other and are unexplained."""
    action = clause.told.action
    limit = min((other.start for other in clauses if other.start >= clause.end), default=len(text))
    if limit > clause.end + 1 and is_unexplained_behind(text[clause.end : limit].split(), action):
        return True
    begin = max((other.end for other in clauses if other.end <= clause.start), default=0)
    return begin + 1 < clause.start and is_unexplained_before(
        text[begin : clause.start].split(), action
    )


def _heard(told: Instruction, sure: float, action: float, details: float) -> Instruction:
    """Return an instruction with a confidence, and those of the recogniser in its words."""
    return replace(
        told,
        confidence=sure * min(action, details),
        action_heard=action,
        details_heard=details,
    )


class _Gap(NamedTuple):
    """Words that belong to no action."""

    start: int
    end: int
    first: str
    """The first of them."""
    words: list[str]
    """The words without courtesies."""
    heard: float
    """Least confidence of the recogniser in them."""


def _gaps(clauses: list[Clause], line: Line, text: str) -> list[_Gap]:
    """Return the words between the actions, without courtesies."""
    taken = [(each.start, each.end) for each in clauses]
    taken += [(span.start, span.end) for span in line.spans]
    gaps: list[_Gap] = []
    at = 0
    for start, end in (*sorted(taken), (len(text), len(text))):
        gap = text[at:start].strip(" |")
        if gap:
            heard = line.heard(line.index(at - 1) + 1, line.index(start - 1) + 1)
            said = without_courtesies(PRESSURE.sub("", gap).split())
            gaps.append(_Gap(at, start, gap.split()[0], said, heard))
        at = max(at, end)
    return gaps


def _wait_for_places(clauses: list[Clause], gaps: list[_Gap], text: str) -> tuple[list[_Gap], bool]:
    """Let clauses wait for the level or fix named behind them: "turn left at three thousand".

    Return the other gaps, and whether a place stands there that is neither.
    """
    left: list[_Gap] = []
    is_lost = False
    for gap in gaps:
        words = text[gap.start : gap.end].strip(" |")
        own = next(
            (
                each
                for each in clauses
                if each.end <= gap.start + 1 and not text[each.end : gap.start].strip(" ")
            ),
            None,
        )
        if (
            own is None
            or own.is_expected
            or own.told.action not in SEQUENCED | {"join"}
            or not _AT.match(words)
        ):
            left.append(gap)
        elif _AT_PLACE.fullmatch(words) and own.told.condition is None:
            own.wait(words)
        else:
            is_lost = True
    return left, is_lost


def _take_bare(
    content: Content, gaps: list[_Gap], clauses: list[Clause], line: Line, text: str
) -> None:
    """Add the routes and values that stand alone.

    Values alone are read back: a call that begins with its callsign has none.
    """
    is_called = line.texts[:1] == [NAME]
    beside = {each.told.action for each in clauses if not each.is_expected}
    has_route = any(each.told.via for each in clauses) or NAME not in text
    for gap in gaps:
        if not gap.words:
            continue
        before = max((each for each in clauses if each.end <= gap.start + 1),
                     key=lambda each: each.end, default=None)  # fmt: skip
        is_behind = before is not None and not text[before.end : gap.start].strip()
        last = before.told.action if before is not None and is_behind else None
        route = (
            None
            if has_route or (is_called and not beside)
            else bare_route(gap.words, beside, last, is_joined=gap.first in ("and", "then"))
        )
        values: list[Instruction] = []
        if route is not None:
            condition = _condition_before(gap.start, line.spans, text)
            if condition is None and last in YIELDED:
                condition = "then"
            values = [replace(route, condition=condition)]
        elif not _PASSING.match(text, gap.end):
            is_level = last == "heading" and LEVEL.fullmatch(" ".join(gap.words)) is not None
            if is_called and not is_level:
                continue
            bare = bare_values(gap.words, beside, last)
            content.pressure_hpa = content.pressure_hpa or bare.pressure_hpa
            values = bare.instructions
            if is_level and before is not None:  # It waits for what the heading waits for.
                values = [replace(each, condition=before.told.condition) for each in values]
        for each in values:
            _add(content, _heard(each, each.confidence, gap.heard, gap.heard))


def _condition_before(start: int, spans: list[Span], text: str) -> str | None:
    """Return the words of a condition right before some others."""
    for span in spans:
        words = text[span.start : span.end].strip()
        if not span.is_traffic and not text[span.end : start].strip() and span.end <= start:
            return None if words.startswith("until") else words
    return None


def _clauses(line: Line, plain: str) -> tuple[list[Clause], list[Question]]:
    """Return the clauses whose action is meant, and the questions about the others.

    The words that lead to an action are those of its clause alone, without its condition.
    """
    clauses: list[Clause] = []
    asked: list[Question] = []
    texts, found = line.texts, line.found
    taken, floor, is_said = 0, 0, True
    about: Asks | None = None
    aside = {
        index
        for span in line.spans
        if not span.is_traffic
        for index in range(line.index(span.start), line.index(span.end - 1) + 1)
    }
    is_question = not ASKS.isdisjoint(texts[1:2] if texts[:1] == [NAME] else texts[:1])
    for index, each in enumerate(found):
        limit = found[index + 1].match.start() if index + 1 < len(found) else len(plain)
        action = each.form.action
        read = each.form.build(Segment(each.match, plain, taken, limit), action)
        if read is None:
            continue
        taken = read.end
        after = line.index(max(each.match.end(), read.end) - 1) + 1
        lead = [texts[at] for at in range(floor, each.first) if at not in aside]
        about = read.asks or (asks(lead, about) if lead or action not in STOPS else None)
        is_said = about is None and is_meant(
            lead, texts[each.first : after], texts[after:], action,
            before_is_meant=is_said, is_question=is_question,
        )  # fmt: skip
        if about == "able" and action == "say":
            is_said = True
        if about is not None and not is_said:
            asked += (Question(about, told) for told in (read.instruction, *read.more))
        is_later = read.is_expected or (not is_said and action not in REPORTS and is_expected(lead))
        if is_said or is_later:
            told, start, end, more, *_ = read
            clauses.append(Clause(told, more, each, start, end, is_later))
        floor = after + (0 if is_said else end_of_denial(texts[after:]))
    if clauses and is_asked_afterwards(plain):
        last = clauses.pop()
        asked += (Question("able", told) for told in (last.told, *last.more))
    return clauses, asked


def _add(content: Content, instruction: Instruction, *, is_doing: bool = False) -> None:
    """Add an instruction, or replace one that has fewer of its details."""
    for index, before in enumerate(content.instructions):
        if _says_all(before, instruction):
            return
        if _says_all(instruction, before):
            content.instructions[index] = instruction
            return
    content.instructions.append(instruction)
    if is_doing:
        content.doing.add(instruction.action)


def _says_all(full: Instruction, part: Instruction) -> bool:
    """Return whether an instruction has all details of another."""
    return full.action == part.action and all(
        getattr(part, slot) in (None, (), False, getattr(full, slot)) for slot in SLOTS
    )


def _blank(text: str, span: Span) -> str:
    """Return a text with the words of a span blanked, so that the others keep their places."""
    words = text[span.start : span.end].rstrip()
    return text[: span.start] + "#" * len(words) + text[span.start + len(words) :]
