"""The actions in the words of a call, and the words between them about others and of conditions."""

from __future__ import annotations

import re
from typing import NamedTuple

from airhilt.phraseology.actions import FORMS, NUMBER_FORMS
from airhilt.phraseology.alphabet import LETTER_OF
from airhilt.phraseology.call import CLEARANCES
from airhilt.phraseology.denials import BETWEEN
from airhilt.phraseology.forms import Form
from airhilt.phraseology.ground import route, taxi, vacate
from airhilt.phraseology.hits import NAME
from airhilt.phraseology.lateral import taxiway_turn
from airhilt.phraseology.slots import FIX, LEVEL_WORDS, RUNWAY, SIDED_RUNWAY, TAXIWAY
from airhilt.phraseology.speeds import KNOTS_FORM
from airhilt.phraseology.surveillance import FREQUENCY_FORM
from airhilt.phraseology.vertical import cross_fix

CONDITIONS = frozenset(
    {
        "behind",
        "after",
        "when",
        "until",
        "before",
        "once",
        "if",
        "unless",
        "upon",
        "whenever",
        "provided",
    }
)
"""First words of a condition (ICAO Doc 4444, 12.2.7)."""
LONGEST_CONDITION = 9
"""Most words in a condition."""
LONGEST_TRAFFIC = 16
"""Most words from "traffic" to what the traffic does, such as "climbing"."""
_PLACED = frozenset({"behind", "after"})
"""Words behind the number in a sequence that say whom to follow, and are no condition."""
_HAPPENED = frozenset(
    {"passes", "passed", "lands", "landed", "departs", "departed", "vacates", "vacated", "clears",
     "rolls", "goes"}
)  # fmt: skip
"""Last words of a condition, behind which a route may begin."""
_INCOMPLETE = frozenset({"be", "been", "is", "are", "was", "were", "to", "your", "cleared"})
"""Words of an event that go on with a clearance."""
LONGEST_STATION = 6
"""Most words from "contact" to the frequency."""
RUNWAY_NEXT = re.compile(rf" runway {RUNWAY}")
_AHEAD = re.compile(
    rf"(?:runway {RUNWAY}|(?<!landing )(?<!departing )(?<!for )(?<!to )(?<!of )(?<!on )(?<!off )"
    rf"(?<!crossing )(?<!the )(?<!\S){SIDED_RUNWAY})(?: at \S+)? $"
)
_TRAFFIC_NOT = frozenset({"pattern", "alert", "circuit"})
_BEFORE_CIRCUIT = frozenset({"left", "right", "closed", "make"})
_VERB = (
    r"(?: (?:climb|descend|turn|fly|reduce|increase|slow|contact|monitor|proceed|maintain|speed"
    r"|hold|cleared|expedite|direct|cross|resume|squawk|heading)(?!\S))"
)
_MARKER = r"the (?:outer |middle |inner )?marker"
_GROUND_PLACE = (
    rf"(?:the )?(?:holding (?:point|decimal)(?: {TAXIWAY})?(?: runway {RUNWAY})?|stop bar"
    r"|hold(?:ing)? line"
    r"|end of (?:the )?(?:runway|taxiway)|run up (?:area|pad)|hold short line|holding position"
    r"|(?:gate|stand|spot|bay) [0-9]{1,3}|apron|ramp|edge of the (?:ramp|apron)|holding bay)"
)
"""Pattern of a place on the ground where something else is to be done."""
_CALL_THERE = r"(?: (?:contact|monitor|call|switch|change|report|advise|stand ?by)(?!\S))"
_EVENTS = {
    "approaching": rf"approaching {_GROUND_PLACE}(?={_CALL_THERE})",
    "at": rf"at (?:{_GROUND_PLACE}(?={_CALL_THERE})|(?:pilot|your|own) (?:discretion|convenience)"
    rf"|(?:{LEVEL_WORDS}|{FIX})(?={_VERB}))",
    "passing": rf"passing (?:{_MARKER}|(?:{LEVEL_WORDS}|{FIX})(?={_VERB}))",
    "crossing": rf"crossing (?:{_MARKER}|{FIX}(?={_VERB}))",
    "leaving": rf"leaving (?:{LEVEL_WORDS}|{FIX})(?={_VERB})",
    "on": r"on (?:the go|departure)",
    "reaching": rf"reaching (?:{_GROUND_PLACE}(?={_CALL_THERE})"
    rf"|(?:{LEVEL_WORDS}|{FIX})(?={_VERB}))",
    "depart": rf"depart {FIX}(?= heading)",
    "leave": rf"leave {FIX}(?= heading)",
    "event": rf"event of(?: (?!fly|climb|turn)[a-z]+){{1,3}}?(?={_VERB})",
    "case": rf"case of(?: (?!fly|climb|turn)[a-z]+){{1,3}}?(?={_VERB})",
    "missed": r"missed approach instructions(?: are)?",
    "climb": r"climb out instructions(?: are)?",
    "when": rf"when (?:ready|able|receiving (?:the )?{FIX}(?: vor| v o r)?"
    r"(?=(?: (?:proceed|cleared|then))? direct(?!\S)))",
    "if": r"if able",
    "whenever": r"whenever (?:ready|able)",
    "in": r"in (?:about |another )?(?:[0-9]+|a|a couple|a few)(?: more)?(?: of)?"
    rf" (?:miles?|minutes?|seconds?)(?={_VERB})",
    "pilot": r"pilot discretion(?= (?:and )?maintain)",
    "airborne": r"(?<!report )airborne(?= \||$)",
    "as": rf"as soon as(?: (?!climb|descend|turn)[a-z0-9]+){{1,6}}?(?={_VERB})",
}
EVENTS = {word: re.compile(rf"{pattern}(?!\S)") for word, pattern in _EVENTS.items()}
"""Patterns of conditions that end with their own words, by their first words."""
SEEN = re.compile(r"traffic (?:is )?(?:not )?in sight(?!\S)")
"""A pilot's words about traffic, which end with their own words."""
_BEHIND_AGAIN = re.compile(rf"(?: (?:runway )?{RUNWAY})? (?:behind|after) \|$")
"""The end of a readback of a condition."""
_LEVEL_ONLY = re.compile(rf" {LEVEL_WORDS}(?: and)? ")
_TO_TURN = re.compile(rf" (?:runway {RUNWAY} )?(?:(?:next|first) )?(?:to the )?")
MILES_BEFORE = re.compile(rf"[0-9]+ (?:nautical )?miles? before {FIX}(?={_VERB})")
_BEGINNINGS = FORMS.keys() | EVENTS.keys() | CONDITIONS | {"traffic"}
"""First words of actions, of conditions, and of words about traffic."""
_BEHIND_NUMBERS = NUMBER_FORMS.keys() | {"mile", "miles", "nautical"}
"""Words behind a number that may begin an action or a condition."""


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


class Scan:
    """Finds the actions of a call, and the spans of traffic and conditions, in their order."""

    def __init__(self, texts: list[str], text: str, starts: list[int]) -> None:
        self._texts = texts
        self._text = text
        self._starts = starts
        self.found: list[Found] = []
        self.spans: list[Span] = []
        self._open_at: int | None = None
        """Begin of the traffic or the condition that may still go on."""
        self._begun = 0
        """Index of its first word."""
        self._is_traffic = False
        free = 0
        for index, word in enumerate(texts):
            if starts[index] < free:
                continue
            is_number = word[0].isdigit() and not _BEHIND_NUMBERS.isdisjoint(
                texts[index + 1 : index + 2]
            )
            if word in _BEGINNINGS or is_number or self._open_at is not None:
                free = self._take(index, word) or free
        if self._open_at is not None:
            self.spans.append(Span(self._open_at, len(text), self._is_traffic))

    def _take(self, index: int, word: str) -> int:
        """Take a word, and return the end of what begins with it."""
        start = self._starts[index]
        event = self._event_at(start, index, word) if word in EVENTS or word.isdigit() else None
        if event is not None:
            self._close(start)
            self.spans.append(Span(start, event.end(), is_traffic=False))
            return event.end()
        if word == "traffic" and self._open_at is None and _is_traffic(self._texts, index):
            seen = SEEN.match(self._text, start)
            if seen or self._texts[max(index - 2, 0) : index] == ["looking", "for"]:
                end = seen.end() if seen else start + len(word)
                self.spans.append(Span(start, end, is_traffic=True))
                return end
            self._open(start, index, is_traffic=True)
            return 0
        is_number = word in _PLACED and "number" in self._texts[max(index - 4, 0) : index]
        is_condition = word in CONDITIONS and not is_number
        if is_condition and (self._open_at is None or self._is_traffic):
            self._close(start)
            self._open(start, index, is_traffic=False)
            return 0
        if self._open_at is not None:
            self._close_at(word, start, index)
        each = _action_at(self._texts, self._text, start, index)
        if each is None or (self.found and _belongs_to(self.found[-1], each)):
            return 0
        return self._take_action(each, word)

    def _take_action(self, each: Found, word: str) -> int:
        start, index = each.match.start(), each.first
        if self._open_at is not None:
            longest = LONGEST_TRAFFIC if self._is_traffic else LONGEST_CONDITION
            is_others = word.endswith("ing") and each.form.action != "visual_separation"
            if is_others and index - self._begun <= longest and not self._is_own(each):
                return each.match.end()
            inner = self._texts[self._begun + 1 : index]
            if not self._is_traffic and (not inner or self._is_in_condition(each, inner)):
                return 0
            end = start
            if self._is_traffic:
                ahead = _AHEAD.search(self._text[self._open_at : start])
                is_said = RUNWAY_NEXT.match(self._text, each.match.end())
                end = self._open_at + ahead.start() if ahead and not is_said else start
            self._close(end)
        self.found.append(each)
        return each.match.end()

    def _is_in_condition(self, each: Found, inner: list[str]) -> bool:
        """Return whether a clearance is a part of the event that something else waits for.

        That of "once you are cleared to land" is.
        """
        is_open = inner[-1] in _INCOMPLETE or BETWEEN.issuperset(inner)
        return is_open and each.form.action in CLEARANCES

    def _is_own(self, each: Found) -> bool:
        """Return whether a pilot lines up, or crosses, behind whom the condition names.

        The words that end the call are "behind" and the callsign.
        """
        text = self._text
        return (
            not self._is_traffic
            and self._texts[0] != NAME
            and _BEHIND_AGAIN.match(text, each.match.end()) is not None
        )

    def _event_at(self, start: int, index: int, word: str) -> re.Match[str] | None:
        """Return the condition that begins with a word and ends with its own words."""
        if self._open_at is not None and not self._is_traffic:
            return None
        if word[0].isdigit():
            return MILES_BEFORE.match(self._text, start) if word.isdigit() else None
        pattern = EVENTS.get(word)
        event = pattern.match(self._text, start) if pattern else None
        if event is None or word != "at":
            return event
        if AT_LEVEL.match(event[0]) and self._texts[index - 1 : index] not in (
            [],
            [NAME],
            ["then"],
        ):
            return None
        is_taxiway = LETTER_AT.match(event[0]) and self._texts[index - 1 : index] not in (
            [],
            [NAME],
        )
        return None if is_taxiway else event

    def _open(self, start: int, index: int, *, is_traffic: bool) -> None:
        self._open_at, self._begun, self._is_traffic = start, index, is_traffic

    def _close(self, end: int) -> None:
        if self._open_at is not None:
            self.spans.append(Span(self._open_at, end, self._is_traffic))
            self._open_at = None

    def _close_at(self, word: str, start: int, index: int) -> None:
        """Close what is open if it cannot go on with a word."""
        if self._is_traffic:
            if word == NAME:
                self._close(start)
            return
        has_happened = self._texts[index - 1] in _HAPPENED and (
            word in LETTER_OF or word[0].isdigit()
        )
        ends = word in (NAME, "runway") or has_happened or index - self._begun >= LONGEST_CONDITION
        if ends and not (word == "runway" and self._texts[index - 1] in ("crossing", "the", "of")):
            self._close(start)


AT_LEVEL = re.compile(rf"at {LEVEL_WORDS}(?!\S)")
"""Pattern of a level, which is a condition only at the beginning of a call."""
LETTER_AT = re.compile(rf"at {TAXIWAY}(?!\S)")
"""Pattern of a taxiway, which may also be a fix."""


def _is_traffic(texts: list[str], index: int) -> bool:
    """Return whether the word "traffic" here means aircraft, not a traffic circuit."""
    return texts[index - 1 : index] not in ([each] for each in _BEFORE_CIRCUIT) and not (
        _TRAFFIC_NOT.intersection(texts[index + 1 : index + 2])
    )


def _action_at(texts: list[str], text: str, start: int, index: int) -> Found | None:
    forms = FORMS.get(texts[index], ())
    if texts[index][0].isdigit() and index + 1 < len(texts):
        forms += NUMBER_FORMS.get(texts[index + 1], ())
    for form in forms:
        match = form.words.match(text, start)
        if match:
            return Found(form, match, index)
    return None


def _belongs_to(last: Found, each: Found) -> bool:
    """Return whether the words of an action are a detail of the one before.

    They are what an animal does, the frequency of a station to contact, the route of a taxi clearance, the side of a
    turn off the runway, and the speed of a crossing restriction.
    """
    if last.form.action == "wildlife" and each.match[0].endswith("ing"):
        return last.match.end() + 1 == each.match.start()
    if each.form.build is route:
        return last.form.build is taxi
    if each.form.build is taxiway_turn:
        between = each.match.string[last.match.end() : each.match.start()]
        return last.form.build is vacate and _TO_TURN.fullmatch(between) is not None
    if each.form is KNOTS_FORM:
        between = each.match.string[last.match.end() : each.match.start()]
        return last.form.build is cross_fix and _LEVEL_ONLY.fullmatch(between) is not None
    return (
        each.form is FREQUENCY_FORM
        and last.form.action in ("contact", "monitor")
        and each.first - last.first <= LONGEST_STATION
    )
