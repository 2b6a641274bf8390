"""The clauses of a call: its words, cut once at actions, conditions and words about others."""

from __future__ import annotations

import re
from bisect import bisect_right
from itertools import accumulate
from typing import NamedTuple

from airhilt.phraseology.actions import FORMS, NUMBER_FORMS
from airhilt.phraseology.alphabet import LETTER_OF
from airhilt.phraseology.call import CLEARANCES
from airhilt.phraseology.denials import BETWEEN
from airhilt.phraseology.forms import Form
from airhilt.phraseology.ground import route, taxi, vacate
from airhilt.phraseology.hits import NAME
from airhilt.phraseology.lateral import taxiway_turn
from airhilt.phraseology.patterns import LatePattern
from airhilt.phraseology.questions import ADVISED
from airhilt.phraseology.slots import FIX, LEVEL_WORDS, RUNWAY, SIDED_RUNWAY, TAXIWAY
from airhilt.phraseology.speeds import KNOTS_FORM
from airhilt.phraseology.surveillance import FREQUENCY_FORM
from airhilt.phraseology.vertical import cross_fix
from airhilt.phraseology.words import Words

CONDITIONS = frozenset(
    {"behind", "after", "when", "until", "before", "once", "if", "unless", "upon", "whenever",
     "provided"}
)  # fmt: skip
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
_INCOMPLETE = frozenset(
    {"be", "been", "is", "are", "was", "were", "to", "your", "cleared", "of", "a", "an", "the"}
)
"""Words of an event that go on with a clearance."""
_SUPPOSING = re.compile(
    r"(?:if|unless|when|whenever|once|case|should)(?: that)? (?:you|we|i|he|she|it|they)"
    r"(?: (?:do|also|still|then|(?:have|need|want|decide|intend|elect|had|wish) to|must))?$"
)
"""Words of a condition that go on with what somebody does."""
_CASE = re.compile(r"in (?:the )?(?:event|case)(?: of| that| you)(?!\S)|should you(?!\S)")
"""First words of another condition on all that follows it."""
IDLE = frozenset({"and", "the"})
"""Words without which an action means the same, however surely they were heard."""
LONGEST_STATION = 6
"""Most words from "contact" to the frequency."""
RUNWAY_NEXT = re.compile(rf" runway {RUNWAY}")
_AHEAD = re.compile(
    rf"(?:runway {RUNWAY}|(?<!landing )(?<!departing )(?<!for )(?<!to )(?<!of )(?<!on )(?<!off )"
    rf"(?<!crossing )(?<!the )(?<!\S){SIDED_RUNWAY})(?: at \S+)? $"
)
_TRAFFIC_NOT = frozenset({"pattern", "alert", "circuit"})
_BEFORE_CIRCUIT = frozenset({"left", "right", "closed", "make", "follow", "following", "way"})
_ARTICLES = frozenset({"the", "that", "to"})
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
    "on": r"on (?:the (?:go around|missed approach)(?= (?!\|)\S)|the go(?! around)|departure)",
    "for": r"for the (?:go around|missed approach)(?= (?!\|)\S)",
    "reaching": rf"reaching (?:{_GROUND_PLACE}(?={_CALL_THERE})"
    rf"|(?:{LEVEL_WORDS}|{FIX})(?={_VERB}))",
    "depart": rf"depart {FIX}(?= heading)",
    "leave": rf"leave {FIX}(?= heading)",
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
EVENTS = {word: LatePattern(rf"{pattern}(?!\S)") for word, pattern in _EVENTS.items()}
"""Patterns of conditions that end with their own words, by their first words."""
SEEN = re.compile(r"traffic (?:is )?(?:not )?in sight(?!\S)")
"""A pilot's words about traffic, which end with their own words."""
_BEHIND_AGAIN = re.compile(rf"(?: (?:runway )?{RUNWAY})? (?:behind|after) \|$")
"""The end of a readback of a condition."""
_LEVEL_ONLY = re.compile(rf" {LEVEL_WORDS}(?: and)? ")
_TO_TURN = re.compile(rf" (?:runway {RUNWAY} )?(?:(?:next|first) )?(?:to the )?")
MILES_BEFORE = re.compile(rf"[0-9]+ (?:nautical )?miles? before {FIX}(?={_VERB})")
_BEGINNINGS = FORMS.keys() | EVENTS.keys() | CONDITIONS | {"traffic", "should"}
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


class _Open(NamedTuple):
    """Words about traffic, or a condition, that may still go on."""

    start: int
    first: int
    is_traffic: bool


class Line:
    """The words of a call and their text, cut at its actions, its conditions and its traffic."""

    def __init__(self, words: Words) -> None:
        self.words = words
        self.texts = words.texts
        self.text = " ".join(words.texts)
        self.starts = [0, *accumulate([len(word) + 1 for word in words.texts])]
        self.found: list[Found] = []
        self.spans: list[Span] = []
        self._open: _Open | None = None
        self._cut()

    def index(self, position: int) -> int:
        """Return the index of the word at a position of the text."""
        return bisect_right(self.starts, position) - 1

    def heard(self, first: int, last: int) -> float:
        """Return the least confidence of the recogniser in a range of words that count."""
        said = zip(self.texts[first:last], self.words.confidences[first:last], strict=True)
        return min([1.0 if word in IDLE else sure for word, sure in said], default=1.0)

    def _cut(self) -> None:
        free = 0
        for index, word in enumerate(self.texts):
            is_number = word[0].isdigit() and not _BEHIND_NUMBERS.isdisjoint(
                self.texts[index + 1 : index + 2]
            )
            begins = word in _BEGINNINGS or is_number or self._open is not None
            if begins and self.starts[index] >= free:
                free = self._take_aside(index, word) or self._take_action(index, word) or free
        self._close(len(self.text))

    def _take_aside(self, index: int, word: str) -> int:
        """Begin a condition, or words about traffic, and return their end if it is known."""
        if word == "if" and not ADVISED.isdisjoint(self.texts[max(index - 1, 0) : index]):
            return 0
        start, is_open = self.starts[index], self._open
        is_free = is_open is None or is_open.is_traffic
        event = self._event_at(start, index, word) if is_free else None
        if event is not None:
            self._close(start)
            self.spans.append(Span(start, event.end(), is_traffic=False))
            return event.end()
        if word == "traffic" and is_open is None and _is_traffic(self.texts, index):
            seen = SEEN.match(self.text, start)
            if seen or self.texts[max(index - 2, 0) : index] == ["looking", "for"]:
                end = seen.end() if seen else start + len(word)
                self.spans.append(Span(start, end, is_traffic=True))
                return end
            self._open = _Open(start, index, is_traffic=True)
            return start + 1
        is_number = word in _PLACED and "number" in self.texts[max(index - 4, 0) : index]
        is_condition = (word in CONDITIONS and not is_number) or _CASE.match(self.text, start)
        if is_condition and is_free:
            self._close(start)
            self._open = _Open(start, index, is_traffic=False)
            return start + 1
        return 0

    def _take_action(self, index: int, word: str) -> int:
        """Take the action that begins with a word, and return its end; 0 if there is none."""
        start = self.starts[index]
        if self._open is not None and self._ends_here(self._open, index, word):
            self._close(start)
        each = _action_at(self.texts, self.text, start, index)
        if each is None or (self.found and _belongs_to(self.found[-1], each)):
            return 0
        if self._open is not None:
            if self._is_others(self._open, each):
                return each.match.end()
            if self._is_in_condition(self._open, each):
                return 0
            self._close(self._end_before(self._open, each))
        self.found.append(each)
        return each.match.end()

    def _is_others(self, aside: _Open, each: Found) -> bool:
        """Return whether the traffic, or whom a condition names, does what is said.

        A pilot lines up, or crosses, behind another if "behind" and the callsign end the call.
        """
        longest = LONGEST_TRAFFIC if aside.is_traffic else LONGEST_CONDITION
        is_readback = (
            not aside.is_traffic
            and self.texts[0] != NAME
            and _BEHIND_AGAIN.match(self.text, each.match.end()) is not None
        )
        return (
            self.texts[each.first].endswith("ing")
            and each.form.action != "visual_separation"
            and each.first - aside.first <= longest
            and not is_readback
        )

    def _is_in_condition(self, aside: _Open, each: Found) -> bool:
        """Return whether an action is a part of the event that something else waits for.

        A clearance is in "once you are cleared to land".
        """
        inner = self.texts[aside.first + 1 : each.first]
        said = self.text[aside.start : each.match.start()].rstrip()
        is_open = not inner or inner[-1] in _INCOMPLETE or _SUPPOSING.search(said) is not None
        is_cleared = each.form.action in CLEARANCES and BETWEEN.issuperset(inner)
        return not aside.is_traffic and (is_open or is_cleared)

    def _end_before(self, aside: _Open, each: Found) -> int:
        """Return the end of words about traffic, or a condition, before an action.

        The runway right before the action is its own.
        """
        start = each.match.start()
        if not aside.is_traffic or RUNWAY_NEXT.match(self.text, each.match.end()):
            return start
        ahead = _AHEAD.search(self.text[aside.start : start])
        return aside.start + ahead.start() if ahead else start

    def _event_at(self, start: int, index: int, word: str) -> re.Match[str] | None:
        """Return the condition that begins with a word and ends with its own words."""
        if word.isdigit():
            return MILES_BEFORE.match(self.text, start)
        pattern = EVENTS.get(word)
        event = pattern.match(self.text, start) if pattern else None
        if event is None or word != "at" or self.texts[:index] in ([], [NAME]):
            return event
        is_level = AT_LEVEL.match(event[0]) and self.texts[index - 1] not in (NAME, "then")
        is_taxiway = LETTER_AT.match(event[0]) and self.texts[index - 1] != NAME
        return None if is_level or is_taxiway else event

    def _close(self, end: int) -> None:
        if self._open is not None:
            self.spans.append(Span(self._open.start, end, self._open.is_traffic))
            self._open = None

    def _ends_here(self, aside: _Open, index: int, word: str) -> bool:
        """Return whether what is open cannot go on with a word."""
        if aside.is_traffic or word == NAME:
            return word == NAME
        if word == "runway" and self.texts[index - 1] in ("crossing", "the", "of", "if", "unless"):
            return False
        has_happened = self.texts[index - 1] in _HAPPENED and (
            word in LETTER_OF or word[0].isdigit()
        )
        return word == "runway" or has_happened or index - aside.first >= LONGEST_CONDITION


AT_LEVEL = re.compile(rf"at {LEVEL_WORDS}(?!\S)")
"""Pattern of a level, which is a condition only at the beginning of a call."""
LETTER_AT = re.compile(rf"at {TAXIWAY}(?!\S)")
"""Pattern of a taxiway, which may also be a fix."""


def _is_traffic(texts: list[str], index: int) -> bool:
    """Return whether the word "traffic" begins words about aircraft.

    It begins none in a traffic circuit, or as whom to follow or give way to.
    """
    before = [each for each in texts[max(index - 3, 0) : index] if each not in _ARTICLES]
    return _BEFORE_CIRCUIT.isdisjoint(before[-1:]) and _TRAFFIC_NOT.isdisjoint(
        texts[index + 1 : index + 2]
    )


def _action_at(texts: list[str], text: str, start: int, index: int) -> Found | None:
    forms = FORMS.get(texts[index], ())
    if texts[index][0].isdigit():
        forms += NUMBER_FORMS.get("".join(texts[index + 1 : index + 2]), ())
    for form in forms:
        match = form.words.match(text, start)
        if match:
            return Found(form, match, index)
    return None


def _belongs_to(last: Found, each: Found) -> bool:
    """Return whether the words of an action are a detail of the one before.

    They are what an animal does, the frequency of a station to contact, the route of a taxi
    clearance, the side of a turn off the runway, and the speed of a crossing restriction.
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
