"""Checks that a reworded message still says what the rule's message says.

Both texts are read by the project's own phraseology, and what is read is compared. A word that is
neither in the rule's message nor in `ADDED` is refused, so that no wording can deny, soften or
extend a message in a way that the phraseology does not know.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from airhilt.messages import CONTROLLER, Severity
from airhilt.phraseology import parse_call, tokens
from airhilt.phraseology.aloud import ADDRESS
from airhilt.phraseology.callsigns import Naming, roster_of
from airhilt.phraseology.instruction_end import action_end
from airhilt.phraseology.slots import NAMED_RUNWAY, designator

LONGEST = 200
"""Length of the longest reworded message, in characters."""
SHAPE = re.compile(rf"[A-Za-z0-9 ,.;:'/-]{{1,{LONGEST}}}")
"""Characters of a message."""
ADDED = frozenset(
    {"a", "an", "the", "is", "are", "you", "your", "in", "at", "on", "and", "with", "it", "its",
     "immediately", "now", "traffic", "second", "seconds", "feet", "foot", "per", "minute", "min",
     "degrees", "will", "lose", "loss", "separation", "conflict", "due"}
)  # fmt: skip
"""Words that a wording may add: they order nothing and deny nothing."""
DENYING = frozenset(
    {"no", "not", "nothing", "never", "without", "cancel", "cancelled", "unidentified", "negative",
     "disregard", "until", "unless", "if"}
)  # fmt: skip
"""Words of a message that a wording may not leave out either."""
ADDED_BEFORE_ACTION = 2
"""Words that a wording may add before the action, such as "immediately": an assumption."""
ROLES = frozenset({"for", "by", "of", "from", "to", "behind", "after", "with"})
"""Words before a callsign that say what it has to do with the rest."""
UNITS = {"s": "second", "seconds": "second", "second": "second", "feet": "feet", "foot": "feet",
         "degrees": "degrees", "nm": "nm"}  # fmt: skip
"""Units after a number, by their spellings."""
_CLAUSES = re.compile(r"[;,:]|\.(?![0-9])")
_CALLSIGN = re.compile(r"\b(?=[A-Z0-9]*[0-9])[A-Z][A-Z0-9]{2,6}\b")
_NUMBER = re.compile(r"[0-9]+")


class Mention(NamedTuple):
    """A callsign in a message, behind the word before it if that is one of `ROLES`."""

    role: str
    callsign: str


Quantities = tuple[tuple[str, str], ...]
"""Numbers, each with its unit, in an order of their own."""


class Told(NamedTuple):
    """An action in a message, with what stands in the same clause."""

    callsigns: tuple[str, ...]
    """Callsigns of the clause, or the recipient: who is told to do it."""
    action: str
    sense: str | None
    altitude_ft: float | None
    turn: str | None
    heading_deg: float | None
    condition: str | None
    quantities: Quantities
    """Numbers of the clause, such as a level and a rate. A time does not get in there: "go around,
    12 s to go" is not "go around in 12 s"."""


@dataclass(frozen=True)
class Reading:
    """Meaning of a message, as far as it must not change."""

    addressed: str | None
    """Callsign with which it begins; None if it begins with none."""
    mentions: tuple[Mention, ...]
    runways: tuple[str, ...]
    """Designators, in their order."""
    actions: tuple[Told, ...]
    """Actions, in an order of their own."""
    quantities: Quantities
    words: Counter[str]
    """All other words."""


CHANGES = {
    "mentions": "callsigns",
    "runways": "runways",
    "actions": "actions",
    "quantities": "numbers",
}
"""Parts of a `Reading` that must not change, in words."""


def reading(text: str, recipient: str, callsigns: Collection[str]) -> Reading:
    """Return what a message to a recipient says, with the callsigns that it may name."""
    known = tuple(sorted(callsigns))
    words = tokens(text)
    naming = roster_of(known).naming(words, is_written=True)
    mentions, rest = _without_callsigns(words, naming)
    runways, rest = _without_runways(rest)
    return Reading(
        addressed=naming.match.callsign if naming.addressed_first else None,
        mentions=mentions,
        runways=runways,
        actions=_actions(text, recipient, known),
        quantities=_quantities(rest),
        words=Counter(word for word in rest if not _NUMBER.fullmatch(word)),
    )


def change(rule: str, reworded: str, recipient: str, severity: Severity) -> str:
    """Return what a reworded message changes of the rule's message; empty if nothing.

    Parameters
    ----------
    recipient
        Callsign or `airhilt.messages.CONTROLLER`.
    severity
        Severity of the alert: its word may be in the message, that of another not.
    """
    if not SHAPE.fullmatch(reworded):
        return f"it has other characters than those of a message, or more than {LONGEST}"
    names = {each: f"ICAO{n}" for n, each in enumerate(sorted(set(ADDRESS.findall(rule))), 1)}
    rule, reworded, recipient = (_named(text, names) for text in (rule, reworded, recipient))
    callsigns = set(_CALLSIGN.findall(rule)) | ({recipient} - {CONTROLLER})
    was = reading(rule, recipient, callsigns)
    now = reading(reworded, recipient, callsigns)
    if now.addressed != was.addressed:
        begin, expected = now.addressed or "no callsign", was.addressed or "none"
        return f"it begins with {begin}; expected {expected}"
    for part, what in CHANGES.items():
        before, after = getattr(was, part), getattr(now, part)
        if after != before:
            return f"it changes the {what}: {_listed(after)}; expected {_listed(before)}"
    known = tuple(sorted(callsigns))
    before, after = _words_to_action(rule, known), _words_to_action(reworded, known)
    if after > before + ADDED_BEFORE_ACTION:
        return f"it names the action with word {after}; expected it with word {before}"
    return _changed_words(was, now, severity)


def _words_to_action(text: str, callsigns: tuple[str, ...]) -> int:
    """Return after how many words the first action of a text has been said, but for callsigns."""
    words = tokens(text[: action_end(text, callsigns)])
    _, rest = _without_callsigns(words, roster_of(callsigns).naming(words, is_written=True))
    return len(rest)


def _changed_words(was: Reading, now: Reading, severity: Severity) -> str:
    """Return which words are not allowed, or are missing."""
    others = sorted({each.value.lower() for each in Severity} - {severity.value.lower()})
    wrong = [word for word in others if now.words[word] > was.words[word]]
    if wrong:
        return f"it changes the severity: {', '.join(wrong)}; expected {severity.value.lower()}"
    allowed = ADDED | set(was.words) | {severity.value.lower()}
    strange = sorted(set(now.words) - allowed)
    if strange:
        return (
            f"it has words of its own: {', '.join(strange[:5])}; expected those of the rule's "
            "message, and some that order and deny nothing"
        )
    denying = [word for word in sorted(DENYING) if now.words[word] != was.words[word]]
    if denying:
        return f"it has another number of {', '.join(map(repr, denying))} than the rule's message"
    return ""


def _without_callsigns(words: list[str], naming: Naming) -> tuple[tuple[Mention, ...], list[str]]:
    found = [naming.hit, *naming.again, *naming.others]
    mentions: list[Mention] = []
    rest: list[str] = []
    at = 0
    for hit in sorted(hit for hit in found if hit is not None):
        if hit.start < at:
            continue
        rest += words[at : hit.start]
        before = words[hit.start - 1] if hit.start > at else ""
        mentions.append(Mention(before if before in ROLES else "", hit.callsign))
        at = hit.end
    return tuple(mentions), rest + words[at:]


def _without_runways(words: list[str]) -> tuple[tuple[str, ...], list[str]]:
    text = " ".join(words)
    found = tuple(designator(each[1], each[2]) for each in NAMED_RUNWAY.finditer(text))
    return found, NAMED_RUNWAY.sub(" ", text).split()


def _quantities(words: list[str]) -> Quantities:
    return tuple(
        sorted(
            (word, UNITS.get(after, ""))
            for word, after in zip(words, [*words[1:], ""], strict=True)
            if _NUMBER.fullmatch(word)
        )
    )


def _actions(text: str, recipient: str, callsigns: tuple[str, ...]) -> tuple[Told, ...]:
    """Return who is told to do what: whom a clause names, or else the recipient."""
    told: list[Told] = []
    for clause in _CLAUSES.split(text):
        words = tokens(clause)
        if not words:
            continue
        mentions, rest = _without_callsigns(
            words, roster_of(callsigns).naming(words, is_written=True)
        )
        _, rest = _without_runways(rest)
        told += (
            Told(
                tuple(each.callsign for each in mentions) or (recipient,),
                each.action,
                each.sense,
                each.altitude_ft,
                each.turn,
                each.heading_deg,
                each.condition or each.until,
                _quantities(rest),
            )
            for each in parse_call(clause, callsigns).instructions
        )
    return tuple(sorted(told, key=repr))


def _named(text: str, names: Mapping[str, str]) -> str:
    return ADDRESS.sub(lambda found: names.get(found[0], found[0]), text)


def _listed(parts: Iterable[object]) -> str:
    return ", ".join(_shown(each) for each in parts) or "none"


def _shown(part: object) -> str:
    if isinstance(part, tuple):
        return " ".join(_shown(each) for each in part if each)
    return str(part)
