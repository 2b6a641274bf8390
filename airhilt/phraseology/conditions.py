"""Conditions, and what clauses of one call mean for each other."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

from airhilt.phraseology.call import (
    CLEARANCES,
    OTHERWISE,
    REPORTS,
    STOPS,
    Action,
    Instruction,
)
from airhilt.phraseology.clauses import Found, Span
from airhilt.phraseology.forms import BARE_RUNWAY, DEPARTED, LONG_NAME, NO_VALUE


@dataclass(slots=True)
class Clause:
    """An action with its slots and its own condition, and where its words stand."""

    told: Instruction
    more: tuple[Instruction, ...]
    """Other instructions of the same words."""
    found: Found
    """The words of the action alone."""
    start: int
    end: int
    is_expected: bool

    def wait(self, condition: str) -> None:
        """Make the clause wait for an event, which is what a report without one tells."""
        told = self.told
        if told.action in REPORTS:
            return  # What is seen waits for nothing.
        event = condition.partition(" ")[2]
        if told.action == "report" and told.position is None and not _CONTINGENT.match(condition):
            self.told = replace(told, position=event, confidence=LONG_NAME)
            return
        received = _RECEIVED.fullmatch(condition) if told.action == "direct" else None
        if received and told.position is None:
            told = replace(told, position=received[1])
        self.told = replace(told, condition=condition)


_TRAILING = re.compile(r"(?: (?:and|then|next|good (?:day|night|evening|morning)|goodbye|bye))+$")
"""Words behind a condition that are no part of it."""
_THEN_BEHIND = re.compile(r"\S (?:and )?then$")
"""The end of a condition that belongs to what stands before it: another action follows it."""
CONDITIONED: frozenset[Action] = CLEARANCES | {"hold_position"}
"""Actions that may be followed by a condition with "behind"."""
SEQUENCED: frozenset[Action] = frozenset(
    {"altitude", "speed", "mach", "heading", "direct", "turn_by", "descend_via", "climb_via"}
)
"""Actions that wait for the one before them after "then" (FAA Order JO 7110.65, 5-7-2)."""
YIELDED: frozenset[Action] = frozenset({"give_way", "follow"})
"""Actions that a taxi route waits for after "then"."""
_MOVED = frozenset({"taxi", "vacate", "cross", "hold_short", "backtrack", "push_back"})
"""Actions on the ground that another unit waits for after "then"."""
IN_FLIGHT: frozenset[Action] = frozenset({"heading", "direct", "turn_by", "join"})
"""Actions that wait for the take-off that is cleared in the same call."""
WITHDRAWN: dict[Action, Action] = {
    "cancel_takeoff": "cleared_for_takeoff",
    "cancel_landing": "cleared_to_land",
    "cancel_approach": "cleared_approach",
}
"""Clearances by the actions that cancel them."""
_SHARING: dict[Action, frozenset[Action]] = {
    "backtrack": frozenset({"line_up"}),
    "line_up": frozenset({"backtrack"}),
    **dict.fromkeys(
        ("cleared_to_land", "touch_and_go", "cleared_option"), frozenset({"circle", "side_step"})
    ),
}
"""Actions on a runway that one beside them names: "circle to runway 33, cleared to land"."""
_CONTINGENT = re.compile(
    r"(?:(?:if|unless|should|missed|climb|in (?:the )?(?:event|case)) \S"
    r"|(?:on|for) the (?:go around|missed approach))"
)
"""First words of a condition on all that follows it."""
_FREE = re.compile(
    r"(?:at )?(?:pilot|your|own) (?:discretion|convenience)$|when ready$"
    r"|(?:crossing|passing) the \S*(?: )?marker$|on the go$"
)
"""Conditions that belong to the action right before them if there is one."""
_WHEN_ABLE = re.compile(r"(?:when|whenever|if) able$")
"""Conditions that belong to the action right behind them, or else to the one right before."""
_AS_FILED = re.compile(
    r"(?<!\S)(?:as filed|cleared to .* airport"
    r"|cleared to (?!land|cross|enter|the ils).* departure)(?!\S)"
)
"""Words of a clearance before departure (FAA Order JO 7110.65, 4-3-2)."""
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
_TRAFFIC = re.compile(r"(?:behind|after|once|when) (?:the|that|a|an|landing|departing) ")
"""Conditions on other traffic: they belong to a clearance on to a runway (ICAO Doc 4444,
12.2.7)."""
_TAKEN_OFF = r"(?:airborne|(?:after|on) departure|off the ground|in the air)"
_AIRBORNE = re.compile(rf"(?<!\S){_TAKEN_OFF}(?!\S)")
_ONLY_AIRBORNE = re.compile(rf"(?:(?:when|once) )?{_TAKEN_OFF}")
_IN_A_WHILE = re.compile(r"(?: in)?(?: [0-9]+ minutes?)? *")
AIRBORNE = "when airborne"
_RECEIVED = re.compile(r"when receiving (?:the )?(.*?)(?: vor| v o r)?")
"""A condition that names the navaid to go to (FAA Order JO 7110.65, 4-4-1)."""
_RIVALS: dict[Action, Callable[[Instruction], float | None]] = {
    "heading": lambda told: told.heading_deg,
    "altitude": lambda told: None if told.bound else told.altitude_ft,
    "speed": lambda told: None if told.bound else told.speed_kt,
}
"""Actions of which one call gives one value for a time, with that value."""
_ENTERING = frozenset({"cleared_for_takeoff", "line_up", "cross"})
"""Clearances to go on to a runway."""
_EXCLUSIVE = frozenset({"cleared_to_land", "cleared_for_takeoff", "line_up"})
"""Clearances of which one aircraft gets one at a time, except line-up and take-off."""


def attach(conditions: list[Span], clauses: list[Clause], text: str) -> None:
    """Give each condition to its own clause, and drop clauses that lack what only it could name."""
    for span in conditions:
        words = text[span.start : span.end].strip()
        before = next((each for each in reversed(clauses) if each.start < span.start), None)
        if words.startswith("until") or (before and _TURNING.match(words)):
            if before and " " in words:
                before.told = replace(before.told, until=words)
            continue
        words = _TRAILING.sub("", words.rstrip(" |"))
        after = [each for each in clauses if each.start >= span.end]
        for clause in _owners(words, before, after, text, span):
            clause.wait(words)
    clauses[:] = [
        each
        for each in clauses
        if each.told.action not in ("direct", "report") or each.told.position is not None
    ]


def _owners(
    words: str, before: Clause | None, after: list[Clause], text: str, span: Span
) -> list[Clause]:
    """Return the clauses of a condition: the next one that it begins, or the one that it ends."""
    kind, _, event = words.partition(" ")
    between = text[before.end : span.start] if before else ""
    is_behind = before is not None and not between.strip()
    last = [before] if before else []
    said = text[span.start : span.end].strip(" |")
    if before and is_behind and _THEN_BEHIND.search(said) and before.told.condition is None:
        return last
    if before and is_behind and _is_onto_runway(before, after) and _TRAFFIC.match(words):
        return last
    if _CONTINGENT.match(words) and not _WHEN_ABLE.match(words):
        return after or ([] if _CONSEQUENCE.search(words) else last)
    if before and before.is_expected and _IN_A_WHILE.fullmatch(between):
        return last
    is_report = bool(after) and after[0].told == Instruction("report")
    if is_report or (before and before.told.action in STOPS):
        return after[:1]
    if _FREE.match(words):
        is_departure = kind == "on" and before and before.told.action in CLEARANCES
        own = last if not after or (is_behind and not is_departure) else after[:1]
        is_others = kind == "at" and not is_behind and own and own[0].told.action in CLEARANCES
        return [] if is_others else own
    if _WHEN_ABLE.match(words):
        is_next = after and text[span.end : after[0].start].strip() in ("", "proceed", "then")
        is_exit = before and before.told.action == "vacate"
        return last if not after or (is_behind and (is_exit or not is_next)) else after[:1]
    if _AHEAD_OF_YOU.fullmatch(words) or (not after and _CONSEQUENCE.search(words)):
        return []
    if after and _AIRBORNE.search(words):  # Nobody is airborne before the take-off.
        later = [each for each in after if each.told.action not in CLEARANCES]
        own = last if before and before.told.action not in CLEARANCES else after[:1]
        return later[:1] or (own if _ONLY_AIRBORNE.fullmatch(words) else [])
    if kind == "behind":
        is_again = not event and (before is None or before.told.condition)
        after = [] if is_again else [e for e in after if e.told.action in CONDITIONED][:1]
        return [] if is_again else after or last
    if not event and kind != "airborne":
        return []
    return after[:1] or last


def _is_onto_runway(before: Clause, after: list[Clause]) -> bool:
    """Return whether the clearance before a condition leads on to a runway, and no later one."""
    return (
        before.told.action in _ENTERING
        and before.told.condition is None
        and not any(each.told.action in _ENTERING for each in after)
    )


def merge_levels(clauses: list[Clause], text: str) -> None:
    """Merge two instructions such as "climb now, maintain flight level 330".

    The name of a procedure between them shows that the level is not for now.
    """
    for index in range(len(clauses) - 1, 0, -1):
        ahead, behind = clauses[index - 1 : index + 1]
        first, second = ahead.told, behind.told
        if (
            first.action == second.action == "altitude"
            and first.altitude_ft is None
            and second.altitude_ft is not None
            and second.sense in ("maintain", first.sense)
            and not (ahead.is_expected or behind.is_expected)
        ):
            is_apart = _PROCEDURE.search(text[ahead.end : behind.start]) is not None
            ahead.told = replace(
                first,
                altitude_ft=second.altitude_ft,
                bound=second.bound,
                condition=first.condition or second.condition,
                until=first.until or second.until,
                immediate=first.immediate or second.immediate,
                confidence=min(second.confidence, NO_VALUE) if is_apart else second.confidence,
            )
            ahead.end = behind.end
            del clauses[index]


def withdraw(clauses: list[Clause]) -> None:
    """Drop the clearances that the same call cancels."""
    for cancel, cleared in WITHDRAWN.items():
        last = max((each.start for each in clauses if each.told.action == cancel), default=0)
        clauses[:] = [each for each in clauses if each.told.action != cleared or each.start >= last]


def put_in_order(clauses: list[Clause], texts: list[str], text: str) -> None:
    """Give conditions to actions that wait for others of the same call, without saying so."""
    is_filed = _AS_FILED.search(text) is not None
    is_takeoff = any(
        each.told.action == "cleared_for_takeoff" and not each.is_expected for each in clauses
    )
    for index, each in enumerate(clauses):
        told, before = each.told, clauses[index - 1] if index else None
        if told.action == "heading" and told.position and _is_route(clauses[:index]):
            each.told = Instruction("taxi", via=(told.position,), confidence=told.confidence)
            continue
        if told.runway is None and told.action in _SHARING:
            _share_runway(each, clauses, text)
        if told.condition is not None:
            continue
        if before and _is_alternative(told, before, text[before.end : each.start]):
            each.told = replace(told, condition=OTHERWISE)
        elif told.action in IN_FLIGHT and is_takeoff:
            each.wait(AIRBORNE)
        elif is_filed and told.action in _AFTER_DEPARTURE and not each.is_expected:
            each.wait(DEPARTED)
        elif before and (before.told.action, told.action) == ("own_navigation", "direct"):
            each.told = replace(told, condition=before.told.condition)
        elif _waits(told, before, texts, each.found.first):
            each.wait("then")


def _is_alternative(told: Instruction, before: Clause, between: str) -> bool:
    """Return whether an action is for who cannot do what was cleared right before it."""
    is_other = told.action in STOPS or told.action == "vacate"
    return is_other and before.told.action in CLEARANCES and between.strip() == "or"


def _is_route(before: list[Clause]) -> bool:
    """Return whether a turn onto a taxiway is the route behind the crossing of a runway."""
    return any(each.told.action == "cross" for each in before)


def _share_runway(own: Clause, clauses: list[Clause], text: str) -> None:
    """Give an action the runway that is named once, right beside it."""
    for ahead, behind in pairwise(clauses):
        if own not in (ahead, behind):
            continue
        told = (behind if ahead is own else ahead).told
        is_beside = text[ahead.end : behind.start].strip() in ("", "and")
        if is_beside and told.runway and told.action in _SHARING[own.told.action]:
            sure = min(told.confidence, BARE_RUNWAY)
            own.told = replace(own.told, runway=told.runway, confidence=sure)
            return


def _is_then(texts: list[str], first: int) -> bool:
    """Return whether "then" stands before an action: "then back to one eighty on the speed"."""
    at = first - 1
    while texts[at] in ("back", "to", "down", "it"):
        at -= 1
    return texts[at] == "then"


def _waits(told: Instruction, before: Clause | None, texts: list[str], first: int) -> bool:
    """Return whether an action waits for the one before it.

    A taxi route waits for whom to give way to, even without "then". After "then" they may not
    have been understood.
    """
    last = before.told.action if before else None
    if told.action == "taxi" and last == "give_way":
        return True
    if told.action == "taxi":
        is_next = last is None or last in YIELDED
    elif told.action in ("contact", "monitor"):
        is_next = before is not None and (before.told.until is not None or last in _MOVED)
    else:
        is_next = told.action in SEQUENCED
    return is_next and _is_then(texts, first)


def doubtful(instructions: list[Instruction]) -> list[Instruction]:
    """Return instructions with low confidence in those that exclude each other.

    Nobody lines up, or takes off, and is cleared to land in one call, is cleared for what the same
    call stops, or is told two headings, levels or speeds for one time: a word is lost, or the
    speaker began again without saying so.
    """
    now = [each for each in instructions if each.condition is None]
    actions = {each.action for each in now}
    values: dict[Action, set[float]] = {}
    for each in now:
        value = _RIVALS[each.action](each) if each.action in _RIVALS else None
        if value is not None and each.until is None:
            values.setdefault(each.action, set()).add(value)
    kept_off = {each.runway for each in now if each.action == "hold_short" and each.runway}
    exclusive = [each for each in now if each.action in _EXCLUSIVE]
    is_both = "cleared_to_land" in actions and (
        len({each.action for each in exclusive}) > 1
        or len({each.runway for each in exclusive if each.runway}) > 1
    )

    def is_doubtful(told: Instruction) -> bool:
        is_entering = told.action in _ENTERING
        return told.condition is None and (
            (told.until is None and len(values.get(told.action, ())) > 1)
            or (is_both and told.action in _EXCLUSIVE)
            or (told.action == "cleared_to_land" and "go_around" in actions)
            or (is_entering and ("hold_position" in actions or told.runway in kept_off))
        )

    return [
        replace(each, confidence=min(each.confidence, NO_VALUE)) if is_doubtful(each) else each
        for each in instructions
    ]
