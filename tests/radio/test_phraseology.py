"""What a call says: callsign, level, instruction or readback."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.radio.phraseology import (
    DIGITS,
    TELEPHONY,
    altitude_ft,
    instructions,
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
        ("November one two, climb FL200", "N12", True),
        ("November one three, climb FL200", None, False),
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


# --- at an airport --------------------------------------------------------------------------

AIRPORT = ("AAL123", "AAL132", "DAL456", "N172SP", "OPS1", "OPS2", "TUG2", "FIRE3", "PLOW4")


def said(text):
    return [(each.action, each.runway) for each in parse_call(text, AIRPORT).instructions]


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        (
            "American one two three, runway zero one, cleared to land, wind three five zero at 8",
            [("cleared_to_land", "01")],
        ),
        ("Cleared to land runway one niner, American 123", [("cleared_to_land", "19")]),
        ("cleared to land one niner, American 123", [("cleared_to_land", "19")]),
        ("Runway 1L, cleared for takeoff", [("cleared_for_takeoff", "01L")]),
        ("cleared for immediate take-off runway 33", [("cleared_for_takeoff", "33")]),
        ("runway one eight centre, line up and wait", [("line_up", "18C")]),
        ("runway one eight center at bravo, line up and wait", [("line_up", "18C")]),
        ("lining up runway two seven right", [("line_up", "27R")]),
        ("hold short of runway zero one", [("hold_short", "01")]),
        ("holding short runway one five", [("hold_short", "15")]),
        ("hold position", [("hold_position", None)]),
        ("cross runway one five, hold short of runway zero one",
         [("cross", "15"), ("hold_short", "01")]),
        ("cross one five, hold short zero one", [("cross", "15"), ("hold_short", "01")]),
        ("proceed onto runway zero one at delta for inspection", [("proceed", "01")]),
        ("cancel takeoff clearance, hold position",
         [("cancel_takeoff", None), ("hold_position", None)]),
        ("go around, deer on the runway", [("go_around", None), ("wildlife", None)]),
        ("going around", [("go_around", None)]),
        ("wildlife report, two deer near runway one niner", [("wildlife", "19")]),
        ("the geese have left runway zero four", [("wildlife_gone", "04")]),
        ("right traffic runway zero one, cleared to land runway zero one",
         [("cleared_to_land", "01")]),
        ("continue holding, traffic landing runway zero one", []),
        ("climb and maintain flight level three three zero", []),
        ("mayday, bird strike, engine failure", []),
        ("runway four zero, cleared to land", [("cleared_to_land", None)]),
    ],
)  # fmt: skip
def test_a_call_says_what_about_which_runway(text, meaning):
    assert said(text) == meaning


@pytest.mark.parametrize(
    "text",
    [
        "Delta 456, runway 01, line up and wait, traffic three mile final runway 33",
        "Delta 456, line up and wait runway 01, traffic crossing runway 33",
        "Delta 456, traffic is leaving the runway at echo, runway 01, line up and wait",
        "Delta 456, behind the landing American 123, line up runway 01",
    ],
)
def test_traffic_is_somebody_else(text):
    assert said(text) == [("line_up", "01")]
    assert parse_call(text, AIRPORT).callsign == "DAL456"


@settings(deadline=None)
@given(st.integers(1, 36), st.sampled_from(["", " left", " right", " centre"]))
def test_any_runway_is_read_digit_by_digit(number, side):
    names = ("zero", "one", "two", "tree", "fower", "fife", "six", "seven", "eight", "niner")
    spoken = " ".join(names[int(digit)] for digit in f"{number:02d}") + side
    ident = f"{number:02d}{side[1:2].upper()}"
    assert said(f"American one two three, runway {spoken}, cleared to land") == [
        ("cleared_to_land", ident)
    ]
    assert said(f"cross runway {spoken}, ops one") == [("cross", ident)]


@settings(deadline=None)
@given(
    st.lists(
        st.sampled_from(
            ["cleared", "to land", "for", "takeoff", "line up", "hold", "short", "position",
             "cross", "runway", "proceed", "cancel", "go around", "deer", "has left", "zero",
             "one", "niner", "traffic", "right", "of", "american", "123"]
        ),
        max_size=14,
    )
)  # fmt: skip
def test_any_words_are_taken_apart(words):
    for each in instructions(tokens(" ".join(words))):
        assert each.runway is None or 1 <= int(each.runway[:2]) <= 36


@pytest.mark.parametrize(
    ("spoken", "callsign"),
    [
        ("ops one", "OPS1"),
        ("OPS 1", "OPS1"),
        ("tug two", "TUG2"),
        ("fire three", "FIRE3"),
        ("fire truck three", "FIRE3"),
        ("snow plow four", "PLOW4"),
        ("plow fower", "PLOW4"),
        ("Cessna one seven two sierra papa", "N172SP"),
        ("november 172 sierra papa", "N172SP"),
        ("American one three two", "AAL132"),
    ],
)
def test_vehicles_and_registrations_are_heard_as_they_are_spoken(spoken, callsign):
    call = parse_call(f"{spoken}, hold position", AIRPORT)
    assert (call.callsign, call.addressed_first) == (callsign, True)
    call = parse_call(f"holding position, {spoken}", AIRPORT)
    assert (call.callsign, call.addressed_first) == (callsign, False)


def test_who_ends_a_call_is_its_speaker_whoever_else_is_named():
    call = parse_call("Behind American 123, line up runway 01, Delta 456", AIRPORT)
    assert (call.callsign, call.addressed_first) == ("DAL456", False)
