"""Words that are lost, misheard or put in never make a clearance that was not said.

The words that sound alike are those of the judge, which knows nothing of the parser.
"""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.phraseology import CLEARANCES, TAU_ASR, parse_call
from phraseology_judge.degrade import CONFUSIONS

KNOWN = ("AAL123", "DAL456", "N172SP", "BAW38")
NAME = "american one two three"
CLEARED = (
    f"{NAME} runway two seven left cleared to land wind two five zero at eight",
    f"{NAME} runway two seven left line up and wait traffic on a three mile final",
    f"{NAME} turn left heading two two zero runway three six cleared for takeoff",
    f"{NAME} cleared i l s zulu runway two seven left approach",
    f"{NAME} maintain three thousand until established cleared localizer runway one six approach",
    f"{NAME} cross deer park at or above five thousand cleared r nav runway two two approach",
    f"{NAME} runway one six right cleared for the option",
    f"{NAME} runway one niner taxi via alfa bravo two hold short of runway three three",
    f"{NAME} cross runway two seven right at bravo contact ground point niner",
)
NOT_CLEARED = (
    f"{NAME} expect i l s runway two seven left approach",
    f"{NAME} continue runway two seven left expect late landing clearance",
    f"{NAME} expect departure runway three six in two minutes",
    f"{NAME} be ready for immediate departure",
    f"{NAME} hold short of runway two seven left traffic on final",
    f"{NAME} are we cleared for takeoff runway three six",
    f"{NAME} confirm cleared to land runway two seven left",
    f"{NAME} inbound for landing runway two seven left",
    f"{NAME} ready for departure runway three six",
    f"{NAME} cancel approach clearance climb and maintain three thousand",
    f"{NAME} number two follow the airbus on short final",
    f"{NAME} traffic two o'clock five miles heavy boeing descending five thousand",
    f"{NAME} after departure turn left heading two seven zero climb and maintain five thousand",
    f"{NAME} descend via the deer park four arrival except maintain one zero thousand",
    f"{NAME} cross line creek at and maintain one one thousand proceed direct nine mile",
    f"{NAME} the line up at the coffee bar is long",
    f"{NAME} takeoff clearance will come from the tower",
    f"{NAME} company ahead of you landed runway two seven left",
)
LATER = (
    f"{NAME} behind the landing boeing line up and wait runway three six behind",
    f"{NAME} behind the airbus on short final cross runway two seven right behind",
    f"{NAME} after the boeing passes continue taxi via alfa bravo",
)
NOISE = ("uh", "um", "and", "the", "static", "krr", "blocked", "sir", "ma", "shh", "but", "well")
SIDES = ("left", "right")


def in_effect(text: str) -> set[Any]:
    """Return the clearances that a listener takes for given, to be used at once."""
    return {
        (each.action, each.runway)
        for each in parse_call(text, KNOWN).instructions
        if each.action in CLEARANCES and each.condition is None and each.confidence >= TAU_ASR
    }


def is_kept(words: list[str], at: int) -> bool:
    """Return whether nobody could tell that a word is lost: a side, or "confirm"."""
    return words[at] in (*SIDES, "confirm")


def test_a_lost_word_never_makes_a_clearance(subtests: pytest.Subtests) -> None:
    for text in CLEARED + NOT_CLEARED + LATER:
        with subtests.test(text):
            words = text.split()
            said = in_effect(text)
            for at in range(len(words)):
                if not is_kept(words, at):
                    rest = " ".join(words[:at] + words[at + 1 :])
                    assert in_effect(rest) <= said, rest


def test_a_word_that_sounds_alike_never_makes_a_clearance(subtests: pytest.Subtests) -> None:
    for text in CLEARED + NOT_CLEARED + LATER:
        with subtests.test(text):
            words = text.split()
            said = in_effect(text)
            for at, word in enumerate(words):
                for heard in CONFUSIONS.get(word, ()):
                    changed = " ".join([*words[:at], heard, *words[at + 1 :]])
                    assert in_effect(changed) <= said, changed


@settings(deadline=None, max_examples=200)
@given(
    st.sampled_from(CLEARED + NOT_CLEARED + LATER),
    st.lists(st.tuples(st.integers(0, 40), st.sampled_from(NOISE)), min_size=1, max_size=3),
)
def test_words_put_in_never_make_a_clearance(text: str, noise: list[tuple[int, str]]) -> None:
    said = in_effect(text)
    words = text.split()
    for at, word in noise:
        words.insert(at % (len(words) + 1), word)
    assert in_effect(" ".join(words)) <= said


def test_what_waits_for_an_event_is_never_in_effect(subtests: pytest.Subtests) -> None:
    for text in LATER:
        with subtests.test(text):
            assert in_effect(text) == set()
            assert all(each.is_conditional for each in parse_call(text, KNOWN).instructions)


def test_what_is_expected_asked_or_talked_about_is_no_clearance(subtests: pytest.Subtests) -> None:
    for text in NOT_CLEARED:
        with subtests.test(text):
            assert in_effect(text) == set()


def test_the_clearances_are_clear_as_they_are(subtests: pytest.Subtests) -> None:
    for text in CLEARED:
        with subtests.test(text):
            assert in_effect(text)
