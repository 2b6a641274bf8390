"""Words that are lost, misheard or put in never make a confident value that was not said.

The calls have an item of each kind with a value. What a listener acts upon may be less than what
was said, such as a heading without the side of its turn, but never another value. Names are not
compared: nobody knows whether a word before the name of a fix belongs to it.
"""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.phraseology import LETTERS, TAU_ASR, Instruction, parse_call
from airhilt.phraseology.content import SLOTS
from airhilt.phraseology.numbers import DIGITS, SOUNDS, TEENS, TENS
from phraseology_judge.degrade import CONFUSIONS

KNOWN = ("AAL123", "DAL456", "N172SP", "BAW38")
NAME = "american one two three"
CALLS = (
    f"{NAME} climb and maintain flight level two four zero",
    f"{NAME} descend and maintain one one thousand altimeter two niner niner two",
    f"{NAME} maintain six thousand until established cleared i l s runway two seven left approach",
    f"{NAME} cross lander at or above one zero thousand at two five zero knots",
    f"{NAME} descend via the deer park four arrival except maintain one zero thousand",
    f"{NAME} turn left heading two seven zero",
    f"{NAME} fly heading zero niner zero climb to flight level three one zero",
    f"{NAME} turn right two zero degrees",
    f"{NAME} turn left direct wavey",
    f"{NAME} proceed direct lander resume own navigation",
    f"{NAME} hold north of lander on the three six zero radial right turns",
    f"{NAME} reduce speed to two one zero knots",
    f"{NAME} maintain one eight zero knots or greater until five mile final",
    f"{NAME} maintain mach decimal seven eight",
    f"{NAME} resume published speed",
    f"{NAME} climb at two thousand feet per minute or greater",
    f"{NAME} contact departure one two four decimal six five",
    f"{NAME} monitor tower one one eight decimal three",
    f"{NAME} squawk four two zero one and ident",
    f"{NAME} runway two seven left at kilo line up and wait",
    f"{NAME} vacate left at bravo three contact ground one two one decimal niner",
    f"{NAME} hold short of runway two seven left at kilo",
    f"{NAME} taxi to runway two seven left via alfa bravo hold short of charlie",
    f"{NAME} backtrack runway two seven",
    f"{NAME} circle to runway one five",
    f"{NAME} report passing flight level one eight zero",
    f"{NAME} follow the cessna number two runway two seven left cleared to land",
)
NUMBERS = DIGITS.keys() | TEENS.keys() | TENS.keys() | SOUNDS.keys() | {"thousand", "hundred"}
NAMES = frozenset({"position", "until"})
"""Details in words, which may have any word: a fix, a unit, whom to follow, the end of a limit."""
VALUES = tuple(slot for slot in SLOTS if slot not in NAMES)
LOST_UNSEEN = NUMBERS | {*LETTERS} | {"left", "right", "and", "published", "decimal", "monitor"}
"""Words that are a part of a value, or tell two apart: nobody could tell that they are lost."""
HEARD_UNSEEN = NUMBERS | {*LETTERS}
NOISE = ("static", "krr", "blocked", "shh", "but", "that", "sir", "ma", "hmm", "uh")


def in_effect(text: str) -> list[Instruction]:
    """Return the instructions that a listener does at once."""
    return [
        each
        for each in parse_call(text, KNOWN).instructions
        if each.condition is None and each.confidence >= TAU_ASR
    ]


def is_said(read: Instruction, said: list[Instruction]) -> bool:
    """Return whether all that an instruction says was said."""
    return any(
        each.action == read.action
        and all(getattr(read, slot) in (None, (), False, getattr(each, slot)) for slot in VALUES)
        for each in said
    )


def untrue(text: str, said: list[Instruction]) -> list[Instruction]:
    """Return what a listener does that was not said."""
    return [each for each in in_effect(text) if not is_said(each, said)]


def test_a_lost_word_never_makes_a_value(subtests: pytest.Subtests) -> None:
    for text in CALLS:
        with subtests.test(text):
            words, said = text.split(), list(parse_call(text, KNOWN).instructions)
            for at, word in enumerate(words):
                if at >= 4 and word not in LOST_UNSEEN:
                    rest = " ".join(words[:at] + words[at + 1 :])
                    assert untrue(rest, said) == [], rest


def test_a_word_that_sounds_alike_never_makes_a_value(subtests: pytest.Subtests) -> None:
    for text in CALLS:
        with subtests.test(text):
            words, said = text.split(), list(parse_call(text, KNOWN).instructions)
            for at, word in enumerate(words):
                for heard in CONFUSIONS.get(word, ()):
                    if at >= 4 and heard not in HEARD_UNSEEN:
                        changed = " ".join([*words[:at], heard, *words[at + 1 :]])
                        assert untrue(changed, said) == [], changed


@settings(deadline=None, max_examples=300)
@given(
    st.sampled_from(CALLS),
    st.lists(st.tuples(st.integers(0, 40), st.sampled_from(NOISE)), min_size=1, max_size=3),
)
def test_words_put_in_never_make_a_value(text: str, noise: list[tuple[int, str]]) -> None:
    said = list(parse_call(text, KNOWN).instructions)
    words = text.split()
    for at, word in noise:
        words.insert(4 + at % (len(words) - 3), word)
    assert untrue(" ".join(words), said) == []


def test_the_calls_are_clear_as_they_are(subtests: pytest.Subtests) -> None:
    for text in CALLS:
        with subtests.test(text):
            assert in_effect(text)


def test_an_animal_before_an_unknown_word_may_be_of_a_name_and_is_not_sure() -> None:
    (told,) = parse_call(f"{NAME} via static the deer static park four arrival", KNOWN).instructions
    (seen,) = parse_call(f"{NAME} deer ahead", KNOWN).instructions
    assert (told.action, seen.action) == ("wildlife", "wildlife")
    assert told.confidence < TAU_ASR <= seen.confidence


@pytest.mark.parametrize("name", ["deer that park four", "deer but that sir park", "deer sir"])
def test_an_animal_in_the_name_of_a_procedure_is_not_sure(name: str) -> None:
    text = f"{NAME} descend via that the {name} arrival"
    assert not [each for each in in_effect(text) if each.action == "wildlife"]


def test_an_animal_is_sure_though_procedures_are_told_beside_it() -> None:
    for text in (
        "deer ahead contact departure",
        "taxi via alfa deer ahead contact departure",
        "taxi to runway one niner via alfa caution deer ahead expect departure in two minutes",
        "climb via the sid deer on the grass contact departure",
    ):
        assert "wildlife" in [each.action for each in in_effect(f"{NAME} {text}")]


def test_what_follows_a_lost_go_around_is_not_sure() -> None:
    whole = in_effect(f"{NAME} go around climb and maintain three thousand")
    assert [each.action for each in whole] == ["go_around", "altitude"]
    assert in_effect(f"{NAME} around climb and maintain three thousand") == []
