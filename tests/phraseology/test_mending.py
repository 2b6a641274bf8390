"""Words that sound like others are mended where those fit, and never for certain."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.phraseology import CLEARANCES, TAU_ASR, parse_call, tokens
from airhilt.phraseology.mending import FITS, candidates, mend_by_sound
from airhilt.phraseology.sounds import likeness, sign_of, spelled_sounds

KNOWN = ("DAL456", "N172SP")


def test_a_word_that_sounds_like_the_one_that_fits_is_taken_for_it(
    subtests: pytest.Subtests,
) -> None:
    for said, meant in [
        ("turn left hitting two seven zero", "turn left heading two seven zero"),
        ("turn lift heading two seven zero", "turn left heading two seven zero"),
        (
            "conduct tower one one eight decimal three",
            "contact tower one one eight decimal three",
        ),
        ("runway two seven cleared to lend", "runway two seven cleared to land"),
        ("ronway two seven cleared to land", "runway two seven cleared to land"),
        ("squat four one two one", "squawk four one two one"),
        ("maintain two one zero nuts", "maintain two one zero knots"),
        ("climb and mainline five thousand", "climb and maintain five thousand"),
    ]:
        with subtests.test(said):
            heard = parse_call(f"delta four five six {said}", KNOWN)
            assert (
                heard.instructions == parse_call(f"delta four five six {meant}", KNOWN).instructions
            )
            assert heard.instructions
            assert heard.confidence < TAU_ASR


def test_where_no_other_fits_a_word_stays(subtests: pytest.Subtests) -> None:
    for said in [
        "the meeting is at ten",
        "reading you five",
        "cleared to lander",
        "cost of the runway",
        "a less busy runway",
        "conduct of flight",
        "squat",
        "hitting bumps",
    ]:
        with subtests.test(said):
            assert tokens(f"delta four five six {said}")[2:] == tokens(said)
            assert parse_call(f"delta four five six {said}", KNOWN).instructions == ()


def test_the_first_word_and_the_name_of_a_fix_may_sound_like_anything(
    subtests: pytest.Subtests,
) -> None:
    table = [("then", "", True), ("", "", False), ("", "by", False), ("direct", "", False),
     ("then", "by", True)]  # fmt: skip
    for before, after, is_mended in table:
        with subtests.test(str((before, after, is_mended))):
            words = [*before.split(), "clime", "flight", "level", "350", *after.split()]
            confidences = [1.0] * len(words)
            mend_by_sound(words, confidences)
            assert ("climb" in words) is is_mended
            assert (min(confidences) < 1.0) is is_mended


def test_words_of_the_phraseology_are_never_replaced() -> None:
    words = {word for fit in FITS for word in [fit.word]} | {"landing", "not", "climbed", "hundred"}
    assert [word for word in words if candidates(word)] == []


def test_words_without_phonemes_sound_as_they_are_spelled() -> None:
    assert spelled_sounds("hitting") == "hItIN"
    assert likeness("kebec", "quebec") > likeness("kebec", "tango")
    assert [sign_of(word) for word in ("minor", "gulf", "hero")] == ["9", "G", "0"]
    assert sign_of("maintain") is None


ORDINARY = """
    hitting reading meeting lend lent lamb plan ground crown hour power taller cleaned feared
    geared clean runaway ronway running climate claim dissent ascend defend mountain maintained
    lift laughed write bright tern churn sort shore hole cold told squat walk devil cows nuts
    coach poach reproach contract conduct tact a less isle else
"""
"""Words that people say too, and that sound like some of the phraseology."""
CALLS = (
    "delta four five six hold short of runway two seven",
    "delta four five six descend and maintain five thousand turn left heading two seven zero",
    "november one seven two sierra papa contact tower one one eight decimal three",
    "number two traffic is a boeing on final runway two seven delta four five six",
    "cancel takeoff clearance hold position november one seven two sierra papa",
)


@settings(deadline=None, max_examples=400)
@given(
    st.sampled_from(CALLS),
    st.lists(
        st.tuples(st.integers(0, 30), st.sampled_from(ORDINARY.split()), st.booleans()), max_size=3
    ),
)
def test_sound_alikes_never_make_a_clearance_that_was_not_given(
    text: str, changes: list[tuple[int, str, bool]]
) -> None:
    words = text.split()
    for at, word, is_instead in changes:
        place = at % len(words)
        words[place : place + is_instead] = [word]
    call = parse_call(" ".join(words), KNOWN)
    assert not [
        each
        for each in call.instructions
        if each.action in CLEARANCES and call.confidence >= TAU_ASR
    ]


def test_the_name_of_an_operator_before_its_number_stays() -> None:
    assert tokens("cargo king one zero zero, climb")[:3] == ["cargo", "king", "100"]
