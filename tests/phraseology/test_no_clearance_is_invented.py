"""Nothing is read as a clearance that was not one: unknown is unknown."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.phraseology import CLEARANCES, LETTERS, TELEPHONY, parse_call, tokens
from airhilt.phraseology.numbers import SOUNDS

KNOWN = ("AAL123", "DAL456", "N172SP", "OPS1", "BAW38")
ACTED_ON = 0.8
"""The least confidence with which listeners do as they heard."""


def clearances(text: str, callsigns: tuple[str, ...] = KNOWN) -> list[Any]:
    return [each for each in parse_call(text, callsigns).instructions if each.action in CLEARANCES]


def acted_on(text: str) -> set[Any]:
    """Return what somebody is cleared for at once, if the call is sure enough to act on it."""
    call = parse_call(text, KNOWN)
    if call.callsign is None or call.confidence < ACTED_ON:
        return set()
    return {
        (call.callsign, each.action, each.runway)
        for each in call.instructions
        if each.action in CLEARANCES and each.condition is None
    }


def test_what_is_denied_asked_expected_or_somebody_elses_is_no_clearance(
    subtests: pytest.Subtests,
) -> None:
    for text in [
        # denied
        "unable to land runway 01",
        "do not cross runway 01",
        "don't line up runway 01",
        "do not, I say again, do not take off runway 01",
        "you are not cleared to cross runway 01",
        "you aren't cleared to land runway 01",
        "not yet cleared for takeoff runway 01",
        "no longer cleared to land runway 01",
        "negative, not cleared to land runway 01",
        "hold short of runway 01, do not cross or line up",
        # withdrawn
        "cancel takeoff clearance",
        "takeoff clearance cancelled",
        "your landing clearance is cancelled, go around",
        "runway 01, cleared for takeoff, cancel takeoff, hold position",
        "cleared to land runway 01, disregard",
        "cleared to land runway 01, disregard, cleared to land runway 01",
        "line up and wait runway 01, cancel that",
        "cleared to land runway 01, negative",
        # to come, perhaps
        "expect takeoff clearance runway 01 in two minutes",
        "expect to cross runway 01",
        "you will be cleared to land runway 01 shortly",
        "stand by for takeoff clearance",
        "prepare to line up runway 01",
        "plan to cross runway 01 at bravo",
        "be ready to cross runway 01",
        "waiting for takeoff runway 01",
        "hold for takeoff clearance",
        # asked
        "are we cleared to land runway 01",
        "confirm cleared to land runway 01",
        "did you say cleared for takeoff runway 01",
        "why did you cross runway 01",
        "can we cross runway 01",
        "request to cross runway 01",
        "would like to cross runway 01",
        "ready for takeoff runway 01",
        # of somebody else
        "traffic is cleared for takeoff runway 33",
        "be advised, vehicle crossing runway 01",
        "the Boeing is cleared to land runway 01",
        # cut off
        "cleared",
        "cleared for",
        "runway 01",
        "to cross runway 01",
        "do cross runway 01",
        "you crossed runway 01 without clearance",
    ]:
        with subtests.test(text):
            for call in (
                f"American 123, {text}",
                f"{text}, American 123",
                f"Tower, American 123, {text}",
            ):
                assert clearances(call) == [], call


def test_clear_and_cleared_are_the_same_clearance_or_none(subtests: pytest.Subtests) -> None:
    """They sound alike, and the recogniser takes them for one word."""
    table = [
        "{} of runway 01",
        "runway 01 is {}",
        "report {} of runway 01",
        "you are {}",
        "{} runway 01",
        "{} to land runway 01",
        "{} for takeoff runway 01",
        "{} to cross runway 01",
        "{} across runway 01",
        "{} for the option runway 01",
        "traffic is {}, cross runway 01",
    ]
    for text in table:
        with subtests.test(text):
            for call in ("American 123, " + text, text + ", American 123"):
                assert clearances(call.format("clear")) == clearances(call.format("cleared"))


def test_but_clearances_among_such_words_are(subtests: pytest.Subtests) -> None:
    for text in [
        "runway 01, line up and wait, traffic landing runway 33",
        "number two, follow the Cessna on short final, cleared to land runway 01",
        "number two following the Cessna, cleared to land runway 01",
        "you are cleared to land runway 01",
        "runway 15 is clear, cross runway 01",
        "wind is 350 at 8, runway 01, cleared to land",
        "expedite, cross runway 01, no delay",
        "without delay, cross runway 01",
        "cleared to cross runway 01",
        "disregard my last, cross runway 01",
    ]:
        with subtests.test(text):
            assert [each.runway for each in clearances(f"American 123, {text}")] == ["01"]


OFTEN_SAID = """
    a at and the of on to for from with runway one two three four five niner zero left right center
    hold short position taxi line up wait clear cleared land takeoff cross crossing go around
    traffic final wind altimeter heading flight level thousand contact tower ground approach
    maintain climb descend expect cancel clearance unable negative roger behind landing departing
    boeing cessna deer ready stop say again correction via
"""
NAMES = (word for name in TELEPHONY.values() for word in name.split())
VOCABULARY = sorted({*OFTEN_SAID.split(), *LETTERS, *NAMES})


@settings(deadline=None, max_examples=300)
@given(st.lists(st.sampled_from(VOCABULARY), max_size=14))
def test_a_clearance_has_its_words_in_the_call(words: list[Any]) -> None:
    """Whatever the recogniser gives, there is no clearance without the words of one."""
    needed = {"land", "takeoff", "line", "cross", "crossing", "taxi", "approach"}
    if needed.isdisjoint(words):
        assert clearances(" ".join(words)) == []


@settings(deadline=None, max_examples=200)
@given(st.text(max_size=80))
def test_any_text_is_taken_apart(text: str) -> None:
    for each in parse_call(text, KNOWN).instructions:
        assert each.runway is None or 1 <= int(each.runway[:2]) <= 36


CLEARED = [
    "american one two three runway one niner cleared to land",
    "cleared for takeoff runway three three delta four five six",
    "american one two three wind three five zero at eight runway one niner cleared to land",
    "ops one cross runway three three hold short of runway zero one",
    "ops one proceed onto runway zero one at delta for inspection",
    "cessna one seven two sierra papa runway zero four cleared touch and go",
    "speedbird three eight taxi to runway one niner via alfa kilo hold short of runway one five",
]
CONDITIONED = (
    "delta four five six behind the landing cessna runway one five line up and wait behind"
)
NOT_CLEARED = [
    "american one two three hold short of runway one niner traffic landing runway one niner",
    "american one two three stop hold position",
    "american one two three go around climb and maintain three thousand",
    "tower american one two three on final runway one niner",
    "american one two three cancel takeoff clearance hold position",
    "american one two three climb and maintain flight level three three zero",
]


def test_words_that_are_lost_never_make_another_clearance(subtests: pytest.Subtests) -> None:
    """A runway that has lost a digit is asked for again: "one niner" may be all that is left."""
    for text in CLEARED:
        with subtests.test(text):
            words = text.split()
            whole = {(action, runway) for _, action, runway in acted_on(text)}
            for lost in [*combinations(range(len(words)), 1), *combinations(range(len(words)), 2)]:
                rest = " ".join(word for at, word in enumerate(words) if at not in lost)
                made = {(action, runway) for _, action, runway in acted_on(rest)}
                assert made <= whole, rest


def test_a_condition_outlives_any_word_that_is_lost() -> None:
    words = CONDITIONED.split()
    for at in range(len(words)):
        assert acted_on(" ".join([*words[:at], *words[at + 1 :]])) == set()


def test_words_that_are_lost_never_make_a_clearance(subtests: pytest.Subtests) -> None:
    for text in NOT_CLEARED:
        with subtests.test(text):
            words = text.split()
            for lost in [*combinations(range(len(words)), 1), *combinations(range(len(words)), 2)]:
                rest = " ".join(word for at, word in enumerate(words) if at not in lost)
                assert acted_on(rest) == set(), rest


@settings(deadline=None, max_examples=300)
@given(
    st.sampled_from(NOT_CLEARED),
    st.integers(0, 30),
    st.sampled_from(
        [word for word in VOCABULARY if word not in ("land", "cross", "crossing", "taxi")]
    ),
    st.booleans(),
)
def test_a_wrong_word_never_makes_a_clearance(text: str, at: int, word: str, instead: bool) -> None:
    words = text.split()
    at = at % len(words)
    changed = [*words[:at], word, *words[at + instead :]]
    assert acted_on(" ".join(changed)) == set()


@settings(deadline=None, max_examples=300)
@given(
    st.sampled_from(CLEARED),
    st.integers(0, 30),
    st.sampled_from([word for word in VOCABULARY if tokens(word) == [word] and word not in SOUNDS]),
)
def test_a_wrong_word_for_a_digit_of_a_runway_never_makes_another_runway(
    text: str, at: int, word: str
) -> None:
    words = text.split()
    digits = [i for i, each in enumerate(words) if "runway" in words[max(i - 2, 0) : i]]
    changed = list(words)
    changed[digits[at % len(digits)]] = word
    whole = {runway for _, _, runway in acted_on(text)}
    assert {runway for _, _, runway in acted_on(" ".join(changed))} <= whole | {None}
