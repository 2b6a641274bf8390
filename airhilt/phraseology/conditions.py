"""Conditions, and what instructions of one call mean for each other."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

from airhilt.phraseology.call import CLEARANCES, REPORTS, Action, Instruction
from airhilt.phraseology.forms import BARE_RUNWAY, DEPARTED, LONG_NAME, NO_VALUE, Read
from airhilt.phraseology.scan import Found, Span

Reads = list[tuple[Read, Found]]
CONDITIONED: frozenset[Action] = CLEARANCES | {"hold_position"}
"""Actions that may be followed by a condition with "behind"."""
SEQUENCED: frozenset[Action] = frozenset(
    {"altitude", "speed", "mach", "heading", "direct", "turn_by", "descend_via", "climb_via"}
)
"""Actions that wait for the one before them after "then" (FAA Order JO 7110.65, 5-7-2)."""
_TALKS: frozenset[Action] = frozenset({"contact", "monitor"})
YIELDED: frozenset[Action] = frozenset({"give_way", "follow"})
"""Actions that a taxi route waits for after "then"."""
IN_FLIGHT: frozenset[Action] = frozenset({"heading", "direct", "turn_by"})
"""Actions that wait for the take-off that is cleared in the same call."""
WITHDRAWN: dict[Action, Action] = {
    "cancel_takeoff": "cleared_for_takeoff",
    "cancel_landing": "cleared_to_land",
    "cancel_approach": "cleared_approach",
}
"""Clearances by the actions that cancel them."""
_FOLLOWING = re.compile(
    r"(?:at )?(?:pilot|your|own) (?:discretion|convenience)$|when ready$"
    r"|(?:crossing|passing) the \S*(?: )?marker$|on the go$"
)
"""Conditions that belong to the action right before them if there is one."""
_WHEN_ABLE = re.compile(r"(?:when|whenever|if) able$")
"""Conditions that belong to the action right behind them, or else to the one right before."""
_FILED = frozenset({"airport", "filed", "departure"})
_AS_FILED = re.compile(
    r"(?<!\S)(?:as filed|cleared to .* airport"
    r"|cleared to (?!land|cross|enter|the ils).* departure)(?!\S)"
)
"""Words of a clearance before departure (FAA Order JO 7110.65, 4-3-2)."""
_SHARING: dict[Action, frozenset[Action]] = {
    "backtrack": frozenset({"line_up"}),
    "line_up": frozenset({"backtrack"}),
    **dict.fromkeys(
        ("cleared_to_land", "touch_and_go", "cleared_option"), frozenset({"circle", "side_step"})
    ),
}
"""Actions on a runway that one beside them names: "circle to runway 33, cleared to land"."""
_AFTER_DEPARTURE: frozenset[Action] = (SEQUENCED - {"direct"}) | {"contact"}
"""Actions of a clearance before departure that wait for it."""
_PROCEDURE = re.compile(r"(?<!\S)(?:[0-9]|arrival|departure|via|star|sid)(?!\S)")
"""Words of a procedure between a climb or a descent and its level."""
_TURNING = re.compile(r"before turning(?!\S)")
"""A limit of the climb before it."""
_CONSEQUENCE = re.compile(
    r"(?<!\S)(?:come back|come to me|call me|let me know|return|advise|tell me|give me|back to me"
    r"|try me|say so|remain|stay with)(?!\S)"
)
"""Words of what is to be done under a condition that are no action of this grammar."""
_AHEAD_OF_YOU = re.compile(r"(?:before|after|behind) (?:you|yours?|that)")
"""Conditions on what somebody else does: "one to depart before you"."""
_AIRBORNE = re.compile(
    r"(?<!\S)(?:airborne|(?:after|on) departure|off the ground|in the air)(?!\S)"
)
AIRBORNE = "when airborne"
_RIVALS: dict[Action, Callable[[Instruction], float | None]] = {
    "heading": lambda told: told.heading_deg,
    "altitude": lambda told: None if told.bound else told.altitude_ft,
    "speed": lambda told: None if told.bound else told.speed_kt,
}
"""Actions of which one call gives one value for a time, with that value."""
_ENTERING = frozenset({"cleared_for_takeoff", "line_up", "cross"})
"""Clearances to go on to a runway."""
_STOPPING = frozenset({"hold_position", "go_around", "hold_short"})
"""Actions that stop a clearance."""
_EXCLUSIVE = frozenset({"cleared_to_land", "cleared_for_takeoff", "line_up"})
"""Clearances of which one aircraft gets one at a time, except line-up and take-off."""


_RECEIVED = re.compile(r"when receiving (?:the )?(.*?)(?: vor| v o r)?")
"""A condition that names the navaid to go to (FAA Order JO 7110.65, 4-4-1)."""


def without_goals(reads: Reads) -> None:
    """Drop the directs to a fix, and the reports of an event, that no word names."""
    reads[:] = [
        (read, each)
        for read, each in reads
        if read.instruction.action not in ("direct", "report")
        or read.instruction.position is not None
    ]


def attach(conditions: list[Span], reads: Reads, text: str) -> None:
    """Attach each condition to its action.

    Its action is the next one, or the one before if the condition is a limit ("until"), or stands
    right behind it ("when ready"), or begins with "behind" at the end of the call.
    """
    for span in conditions:
        words = text[span.start : span.end].strip()
        before = [i for i, (read, _) in enumerate(reads) if read.start < span.start]
        after = [i for i, (read, _) in enumerate(reads) if read.start >= span.end]
        kind = words.split()[0] if words else ""
        if kind == "until" or (kind == "before" and before and _TURNING.match(words)):
            if before and " " in words:
                _set(reads, before[-1], until=words)
        elif kind in ("if", "event", "case", "missed", "climb") and len(words.split()) > 2:
            is_told = not after and _CONSEQUENCE.search(words)
            for index in after or ([] if is_told else before[-1:]):
                _set(reads, index, condition=words)
        elif before and _is_of_expected(reads[before[-1]][0], text, span):
            _set(reads, before[-1], condition=words)
        elif _FOLLOWING.match(words):
            is_own = _is_right_behind(reads, before, text, span) and not (
                kind == "on" and after and reads[before[-1]][0].instruction.action in CLEARANCES
            )
            own = before[-1:] if is_own or not after else after[:1]
            is_cleared = bool(own) and reads[own[0]][0].instruction.action in CLEARANCES
            if kind == "at" and not is_own and is_cleared:
                continue  # It belongs to words before it that are no action.
            for index in own:
                _set(reads, index, condition=words)
        elif _WHEN_ABLE.match(words):
            between = text[span.end : reads[after[0]][0].start].strip() if after else ""
            is_next = bool(after) and between in ("", "proceed", "then")
            is_exit = bool(before) and reads[before[-1]][0].instruction.action == "vacate"
            is_own = _is_right_behind(reads, before, text, span) and (is_exit or not is_next)
            for index in before[-1:] if is_own or not after else after[:1]:
                _set(reads, index, condition=words)
        else:
            _attach_to_one(words, kind, before, after, reads)


def _is_right_behind(reads: Reads, before: list[int], text: str, span: Span) -> bool:
    """Return whether a condition stands right behind an action."""
    return bool(before) and not text[reads[before[-1]][0].end : span.start].strip()


def _is_of_expected(read: Read, text: str, span: Span) -> bool:
    """Return whether a condition stands right behind what is expected: "in ten minutes after"."""
    between = text[read.end : span.start]
    return read.is_expected and bool(re.fullmatch(r"(?: in)?(?: [0-9]+ minutes?)? *", between))


def _attach_to_one(
    words: str, kind: str, before: list[int], after: list[int], reads: Reads
) -> None:
    if _AHEAD_OF_YOU.fullmatch(words):
        return
    if not after and _CONSEQUENCE.search(words):
        return  # What is to be done then is in the words of the condition.
    if after and _AIRBORNE.search(words):
        after = [i for i in after if reads[i][0].instruction.action not in CLEARANCES]
        if not after:
            return  # Nobody is airborne before the take-off.
    is_again = False
    if kind == "behind":
        if len(after) > 1:
            after = [i for i in after if reads[i][0].instruction.action in CONDITIONED] or after
        is_again = bool(before and reads[before[-1]][0].instruction.condition)
    if (
        len(words.split()) < 2
        and kind != "airborne"
        and (kind != "behind" or not before or is_again)
    ):
        return
    is_behind = kind == "behind" and (
        not after or reads[after[0]][0].instruction.action not in CONDITIONED
    )
    if before and (is_behind or not after):
        _set(reads, before[-1], condition=words)
    elif after:
        _set(reads, after[0], condition=words)


def _set(
    reads: Reads, index: int, *, condition: str | None = None, until: str | None = None
) -> None:
    read, each = reads[index]
    told = read.instruction
    if told.action in REPORTS:
        return  # What is seen waits for nothing.
    if told.action == "report" and told.position is None and (condition or "if")[:2] != "if":
        told = replace(told, position=(condition or "").partition(" ")[2], confidence=LONG_NAME)
        condition = None
    received = _RECEIVED.fullmatch(condition or "") if told.action == "direct" else None
    if received and told.position is None:
        told = replace(told, position=received[1])
    told = replace(told, condition=condition or told.condition, until=until or told.until)
    reads[index] = read._replace(instruction=told), each


def merge_levels(reads: Reads, text: str) -> None:
    """Merge two instructions such as "climb now, maintain flight level 330".

    The name of a procedure between them shows that the level is not for now.
    """
    for index in range(len(reads) - 1, 0, -1):
        first, second = reads[index - 1][0].instruction, reads[index][0].instruction
        if (
            first.action == second.action == "altitude"
            and first.altitude_ft is None
            and second.altitude_ft is not None
            and (second.sense == "maintain" or second.sense == first.sense)
            and not (reads[index - 1][0].is_expected or reads[index][0].is_expected)
        ):
            between = text[reads[index - 1][0].end : reads[index][0].start]
            is_apart = _PROCEDURE.search(between) is not None
            merged = replace(
                first,
                altitude_ft=second.altitude_ft,
                bound=second.bound,
                condition=first.condition or second.condition,
                until=first.until or second.until,
                immediate=first.immediate or second.immediate,
                confidence=min(second.confidence, NO_VALUE) if is_apart else second.confidence,
            )
            read = reads[index - 1][0]._replace(instruction=merged, end=reads[index][0].end)
            reads[index - 1 : index + 1] = [(read, reads[index - 1][1])]


def withdraw(reads: Reads) -> None:
    """Drop the clearances that the same call cancels."""
    actions = {read.instruction.action for read, _ in reads}
    for cancel, cleared in WITHDRAWN.items():
        if cancel not in actions:
            continue
        cancelled = [read.start for read, _ in reads if read.instruction.action == cancel]
        reads[:] = [
            (read, each)
            for read, each in reads
            if read.instruction.action != cleared or read.start > cancelled[-1]
        ]


def put_in_order(reads: Reads, texts: list[str], text: str) -> None:
    """Give conditions to actions that wait for others of the same call, without saying so."""
    is_filed = not _FILED.isdisjoint(texts) and bool(_AS_FILED.search(text))
    for index, (read, each) in enumerate(reads):
        told = read.instruction
        if told.action == "heading" and _is_turn_of_route(told, texts[each.first], reads[:index]):
            route = Instruction("taxi", via=(told.position or "",), confidence=told.confidence)
            reads[index] = read._replace(instruction=route), each
            continue
        if told.runway is None and told.action in _SHARING:
            _share_runway(reads, index, text)
        if told.condition is not None:
            continue
        if told.action in IN_FLIGHT and _is_takeoff(reads):
            _set(reads, index, condition=AIRBORNE)
        elif is_filed and told.action in _AFTER_DEPARTURE and not read.is_expected:
            _set(reads, index, condition=DEPARTED)
        elif index and _waits_with(reads[index - 1][0], read, text):
            _set(reads, index, condition=reads[index - 1][0].instruction.condition)
        elif _waits(told, reads[index - 1][0] if index else None, texts, each.first):
            _set(reads, index, condition="then")


def _is_takeoff(reads: Reads) -> bool:
    """Return whether a call clears for take-off."""
    return any(
        read.instruction.action == "cleared_for_takeoff" and not read.is_expected
        for read, _ in reads
    )


def _is_turn_of_route(told: Instruction, first: str, before: Reads) -> bool:
    """Return whether a turn onto a taxiway is the route behind the crossing of a runway."""
    is_turn = told.position is not None and told.heading_deg is None
    is_bare = is_turn and first in ("left", "right")
    return is_bare and any(read.instruction.action == "cross" for read, _ in before)


def _share_runway(reads: Reads, index: int, text: str) -> None:
    """Give an action the runway that is named once, right beside it."""
    read, each = reads[index]
    for other, between in (
        (index + 1, slice(read.end, reads[index + 1][0].start if index + 1 < len(reads) else 0)),
        (index - 1, slice(reads[index - 1][0].end if index else 0, read.start)),
    ):
        if not 0 <= other < len(reads) or text[between].strip() not in ("", "and"):
            continue
        told = reads[other][0].instruction
        if told.runway and told.action in _SHARING[read.instruction.action]:
            shared = replace(
                read.instruction, runway=told.runway, confidence=min(told.confidence, BARE_RUNWAY)
            )
            reads[index] = read._replace(instruction=shared), each
            return


def _is_then(texts: list[str], first: int) -> bool:
    """Return whether "then" stands before an action: "then back to one eighty on the speed"."""
    at = first - 1
    while at > 0 and texts[at] in ("back", "to", "down", "it"):
        at -= 1
    return texts[max(at, 0)] == "then"


def _waits(told: Instruction, before: Read | None, texts: list[str], first: int) -> bool:
    """Return whether an action waits for the one before it.

    A taxi route waits for whom to give way to, even without "then". After "then" they may not
    have been understood.
    """
    last = before.instruction.action if before else None
    if told.action == "taxi":
        is_last = last is None or last in YIELDED
        return last == "give_way" or (is_last and _is_then(texts, first))
    is_limited = before is not None and before.instruction.until is not None
    is_moved = last in ("taxi", "vacate", "cross", "hold_short", "backtrack", "push_back")
    is_later = told.action in _TALKS and (is_limited or is_moved)
    return (is_later or told.action in SEQUENCED) and _is_then(texts, first)


def _waits_with(before: Read, read: Read, text: str) -> bool:
    """Return whether a direct belongs to the "resume own navigation" right before it."""
    return (
        before.instruction.action == "own_navigation"
        and read.instruction.action == "direct"
        and before.instruction.condition is not None
        and not text[before.end : read.start].strip()
    )


def _without_rivals(instructions: list[Instruction]) -> list[Instruction]:
    """Return instructions with low confidence in two values for one thing and one time.

    The speaker may have begun again without saying so.
    """
    seen: dict[Action, set[float | None]] = {}
    for each in instructions:
        if each.action in _RIVALS and each.condition is None and each.until is None:
            seen.setdefault(each.action, set()).add(_RIVALS[each.action](each))
    doubted = {action for action, values in seen.items() if len(values - {None}) > 1}
    if not doubted:
        return instructions
    return [
        replace(each, confidence=min(each.confidence, NO_VALUE))
        if each.action in doubted and each.condition is None and each.until is None
        else each
        for each in instructions
    ]


def _without_stopped(instructions: list[Instruction]) -> list[Instruction]:
    """Return instructions with low confidence in a clearance that the same call stops.

    A word between them is lost: "line up runway 23, disregard, hold short runway 23".
    """
    if _STOPPING.isdisjoint([each.action for each in instructions]):
        return instructions
    now = [each for each in instructions if each.condition is None]
    is_held = any(each.action == "hold_position" for each in now)
    is_gone = any(each.action == "go_around" for each in now)
    kept_off = {each.runway for each in now if each.action == "hold_short" and each.runway}

    def is_stopped(told: Instruction) -> bool:
        if told.action == "cleared_to_land":
            return is_gone
        return told.action in _ENTERING and (is_held or told.runway in kept_off)

    if not (is_held or is_gone or kept_off):
        return instructions
    return [
        replace(each, confidence=min(each.confidence, NO_VALUE))
        if each.condition is None and is_stopped(each)
        else each
        for each in instructions
    ]


def doubtful(instructions: list[Instruction]) -> list[Instruction]:
    """Return instructions with low confidence in those that exclude each other.

    Nobody lines up, or takes off, and is cleared to land in one call, and nobody is cleared twice
    for one thing on two runways, or told two headings, levels or speeds for one time.
    """
    if len(instructions) < 2:
        return instructions
    instructions = _without_stopped(_without_rivals(instructions))
    now = [each for each in instructions if each.action in _EXCLUSIVE and each.condition is None]
    actions = {each.action for each in now}
    runways = {each.runway for each in now if each.runway}
    is_doubtful = "cleared_to_land" in actions and (len(actions) > 1 or len(runways) > 1)
    if not is_doubtful:
        return instructions
    return [
        replace(each, confidence=min(each.confidence, NO_VALUE)) if each in now else each
        for each in instructions
    ]
