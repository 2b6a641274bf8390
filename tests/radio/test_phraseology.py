"""What a call says: callsign, level, instruction or readback."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.radio.phraseology import (
    DIGITS,
    TELEPHONY,
    altitude_ft,
    parse_call,
    spoken_forms,
    tokens,
)

KNOWN = ("AAL123", "DAL456", "AFR7", "ACA88", "N12")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("flight level three five zero", "flight level 350"),
        ("Flight Level THREE FIFE ZERO", "flight level 350"),
        ("one two three, climb", "123 climb"),
        ("one two three, three five zero", "123 350"),
        ("niner tree fower", "934"),
        ("level 3 5 0", "level 350"),
        ("one zero thousand", "10 thousand"),
        ("AAL123", "aal 123"),
        ("", ""),
    ],
)
def test_spoken_digits_are_joined_to_numbers_and_a_comma_ends_one(text, words):
    assert tokens(text) == words.split()


@settings(deadline=None)
@given(st.text(max_size=80))
def test_any_text_is_taken_apart(text):
    assert all(word and word == word.lower() for word in tokens(text))
    parse_call(text, KNOWN)


@pytest.mark.parametrize(
    ("text", "feet"),
    [
        ("climb and maintain flight level three three zero", 33_000),
        ("descend flight level niner zero", 9_000),
        ("climb FL350", 35_000),
        ("climb FL 350", 35_000),
        ("descend and maintain one zero thousand", 10_000),
        ("descend and maintain five thousand", 5_000),
        ("climb to one two thousand five hundred", 12_500),
        ("maintain 4500 feet", 4_500),
        ("descend to four five zero zero feet", 4_500),
        ("turn left heading three five zero", None),
        ("reduce speed two five zero knots", None),
        ("contact Washington Centre one three four decimal three", None),
        ("descend to flight", None),
        ("level", None),
        ("", None),
    ],
)
def test_a_level_is_read_only_where_the_words_say_one(text, feet):
    assert altitude_ft(tokens(text)) == feet


@settings(deadline=None, max_examples=300)
@given(
    st.lists(
        st.sampled_from(
            ["climb", "descend", "maintain", "to", "flight", "level", "fl", "thousand", "hundred",
             "feet", "american", "delta", "and", ",", "."]
        )
        | st.from_regex(r"\A[a-z]{1,9}\Z").filter(lambda word: word not in DIGITS),
        max_size=15,
    )
)  # fmt: skip
def test_words_without_digits_never_give_a_level(words):
    text = " ".join(words)
    assert altitude_ft(tokens(text)) is None
    assert parse_call(text, KNOWN).altitude_ft is None


@settings(deadline=None)
@given(st.integers(10, 600))
def test_any_flight_level_is_read_digit_by_digit(level):
    names = {"0": "zero", "1": "one", "2": "two", "3": "tree", "4": "fower", "5": "fife",
             "6": "six", "7": "seven", "8": "eight", "9": "niner"}  # fmt: skip
    spoken = " ".join(names[digit] for digit in str(level))
    call = parse_call(f"American one two three, climb flight level {spoken}", KNOWN)
    assert call.altitude_ft == level * 100.0


@pytest.mark.parametrize(
    ("text", "callsign", "addressed_first"),
    [
        (
            "American one two three, climb and maintain flight level three three zero.",
            "AAL123",
            True,
        ),
        (
            "Climb and maintain flight level three three zero, American one two three.",
            "AAL123",
            False,
        ),
        ("AAL123 climb FL330", "AAL123", True),
        ("climb FL330 AAL123", "AAL123", False),
        ("Air Canada eight eight, descend flight level two zero zero", "ACA88", True),
        ("Air France seven, climb FL200", "AFR7", True),
        ("November one two, climb FL200", None, False),
        ("N12, climb FL200", "N12", True),
        ("Delta four five, climb FL200", None, False),
        ("Delta four five six, traffic American one two three", "DAL456", True),
        ("climb flight level three three zero", None, False),
    ],
)
def test_an_instruction_begins_with_the_callsign_and_a_readback_ends_with_it(
    text, callsign, addressed_first
):
    call = parse_call(text, KNOWN)
    assert (call.callsign, call.addressed_first) == (callsign, addressed_first)


@pytest.mark.parametrize(
    ("text", "sense"),
    [
        ("American one two three, climb and maintain FL330", "climb"),
        ("climbing FL330, American one two three", "climb"),
        ("American one two three, descend FL310", "descend"),
        ("descending FL310, American one two three", "descend"),
        ("American one two three, maintain FL310", "maintain"),
        ("American one two three, turn right heading zero niner zero", None),
    ],
)
def test_the_sense_is_that_of_the_first_word_that_has_one(text, sense):
    assert parse_call(text, KNOWN).sense == sense


def test_a_level_without_a_sense_is_no_instruction():
    call = parse_call("American one two three, traffic at flight level three five zero", KNOWN)
    assert (call.callsign, call.sense, call.altitude_ft) == ("AAL123", None, None)


def test_the_digits_of_the_callsign_are_not_those_of_the_level():
    call = parse_call("Descend flight level two niner zero American one two three", KNOWN)
    assert call.altitude_ft == 29_000
    assert call.callsign == "AAL123"


def test_a_callsign_that_nobody_has_is_nobodys():
    assert parse_call("United five five, climb FL330", KNOWN).callsign is None


@settings(deadline=None)
@given(st.sampled_from(sorted(TELEPHONY)), st.integers(1, 9999))
def test_a_callsign_is_heard_as_written_and_by_its_telephony_designator(airline, number):
    callsign = f"{airline}{number}"
    for form in spoken_forms(callsign):
        call = parse_call(f"{' '.join(form)}, climb FL330", [callsign])
        assert (call.callsign, call.addressed_first) == (callsign, True)
        assert (call.sense, call.altitude_ft) == ("climb", 33_000)
