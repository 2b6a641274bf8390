"""What a call says: its kind, what is to be done, and the values of that."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.phraseology import DIGITS, Instruction, Wind, parse_call, tokens
from airhilt.phraseology.call import Call

KNOWN = ("AAL123", "DAL456", "AFR7", "ACA88", "N12")


def call_to(text: str, callsigns: tuple[str, ...] = KNOWN) -> Call:
    return parse_call(f"American one two three, {text}", callsigns)


def only(text: str) -> Instruction:
    (instruction,) = call_to(text).instructions
    return instruction


def test_spoken_digits_are_joined_to_numbers_and_a_comma_ends_one(
    subtests: pytest.Subtests,
) -> None:
    for text, words in [
        ("flight level three five zero", "flight level 350"),
        ("Flight Level THREE FIFE ZERO", "flight level 350"),
        ("one two three, climb", "123 climb"),
        ("one two three, three five zero", "123 350"),
        ("niner tree fower", "934"),
        ("level 3 5 0", "level 350"),
        ("one zero thousand", "10 thousand"),
        ("climb 330 5", "climb 330 5"),
        ("heading 2 70", "heading 270"),
        ("heading 270 25", "heading 270 25"),
        ("AAL123", "aal 123"),
        ("", ""),
    ]:
        with subtests.test(text):
            assert tokens(text) == words.split()


@settings(deadline=None)
@given(st.text(max_size=80))
def test_any_text_is_taken_apart(text: str) -> None:
    assert all(word and word == word.lower() for word in tokens(text))
    parse_call(text, KNOWN)


def test_a_level_is_read_only_where_the_words_say_one(subtests: pytest.Subtests) -> None:
    for text, feet in [
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
        ("descend to niner hundred feet", 900),
        ("climb flight level three three", None),
        ("descend to two four zero", 24_000),
        ("descend to flight", None),
        ("climb to thousand", None),
        ("level", None),
        ("", None),
    ]:
        with subtests.test(text):
            assert call_to(text).altitude_ft == feet


@settings(deadline=None, max_examples=100)
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
def test_words_without_digits_never_give_a_level(words: list[Any]) -> None:
    assert parse_call(" ".join(words), KNOWN).altitude_ft is None


@settings(deadline=None)
@given(st.integers(100, 600))
def test_any_flight_level_is_read_digit_by_digit(level: int) -> None:
    names = {"0": "zero", "1": "one", "2": "two", "3": "tree", "4": "fower", "5": "fife",
             "6": "six", "7": "seven", "8": "eight", "9": "niner"}  # fmt: skip
    spoken = " ".join(names[digit] for digit in str(level))
    call = parse_call(f"American one two three, climb flight level {spoken}", KNOWN)
    assert call.altitude_ft == level * 100.0


def test_the_sense_is_that_of_the_first_word_that_has_one(subtests: pytest.Subtests) -> None:
    for text, sense in [
        ("American one two three, climb and maintain FL330", "climb"),
        ("climbing FL330, American one two three", "climb"),
        ("American one two three, descend FL310", "descend"),
        ("descending FL310, American one two three", "descend"),
        ("American one two three, maintain FL310", "maintain"),
        ("American one two three, turn right heading zero niner zero", None),
    ]:
        with subtests.test(text):
            assert parse_call(text, KNOWN).sense == sense


def test_a_level_without_a_sense_is_no_instruction() -> None:
    call = parse_call("American one two three, traffic at flight level three five zero", KNOWN)
    assert (call.callsign, call.sense, call.altitude_ft) == ("AAL123", None, None)


def test_the_digits_of_the_callsign_are_not_those_of_the_level() -> None:
    call = parse_call("Descend flight level two niner zero American one two three", KNOWN)
    assert call.altitude_ft == 29_000
    assert call.callsign == "AAL123"


# --- at an airport --------------------------------------------------------------------------

AIRPORT = ("AAL123", "AAL132", "DAL456", "N172SP", "OPS1", "OPS2", "TUG2", "FIRE3", "PLOW4")


def said(text: str) -> list[Any]:
    return [(each.action, each.runway) for each in parse_call(text, AIRPORT).instructions]


def test_a_call_says_what_about_which_runway(subtests: pytest.Subtests) -> None:
    table = [
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
        ("runway three three, holding, Delta 456", [("hold_position", None)]),
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
         [("join", "01"), ("cleared_to_land", "01")]),
        ("continue holding, traffic landing runway zero one", [("hold_position", None)]),
        ("climb and maintain flight level three three zero", [("altitude", None)]),
        ("mayday, bird strike, engine failure", []),
        ("runway four zero, cleared to land", [("cleared_to_land", None)]),
    ]  # fmt: skip
    for text, meaning in table:
        with subtests.test(text):
            assert said(text) == meaning


def test_traffic_is_somebody_else(subtests: pytest.Subtests) -> None:
    for text in [
        "Delta 456, runway 01, line up and wait, traffic three mile final runway 33",
        "Delta 456, line up and wait runway 01, traffic crossing runway 33",
        "Delta 456, traffic is leaving the runway at echo, runway 01, line up and wait",
        "Delta 456, behind the landing American 123, line up runway 01",
    ]:
        with subtests.test(text):
            assert said(text) == [("line_up", "01")]
            assert parse_call(text, AIRPORT).callsign == "DAL456"


@settings(deadline=None)
@given(st.integers(1, 36), st.sampled_from(["", " left", " right", " centre"]))
def test_any_runway_is_read_digit_by_digit(number: int, side: str) -> None:
    names = ("zero", "one", "two", "tree", "fower", "fife", "six", "seven", "eight", "niner")
    spoken = " ".join(names[int(digit)] for digit in f"{number:02d}") + side
    ident = f"{number:02d}{side[1:2].upper()}"
    assert said(f"American one two three, runway {spoken}, cleared to land") == [
        ("cleared_to_land", ident)
    ]
    assert said(f"cross runway {spoken}, ops one") == [("cross", ident)]


def test_an_instruction_has_what_is_said_about_it(subtests: pytest.Subtests) -> None:
    table = [
        ("line up and wait runway 01 at bravo", Instruction("line_up", "01", "B")),
        ("behind the landing cessna line up and wait runway 01 behind",
         Instruction("line_up", "01", condition="behind the landing cessna")),
        ("after the departing airbus cross runway 33",
         Instruction("cross", "33", condition="after the departing airbus")),
        ("when able proceed direct dixie",
         Instruction("direct", position="dixie", condition="when able")),
        ("reduce speed to 180 knots until four mile final",
         Instruction("speed", speed_kt=180.0, until="until 4 mile final")),
        ("cleared for immediate takeoff runway 19",
         Instruction("cleared_for_takeoff", "19", immediate=True)),
        ("hold short of echo", Instruction("hold_short", hold_short="E")),
        ("hold short of bravo five", Instruction("hold_short", hold_short="B5")),
        ("taxi to runway one niner via alpha, kilo",
         Instruction("taxi", "19", via=("A", "K"))),
        ("drive to delta", Instruction("taxi", position="D")),
        ("vacate left at echo", Instruction("vacate", position="E", turn="left")),
        ("turn right heading zero niner zero",
         Instruction("heading", turn="right", heading_deg=90.0)),
        ("fly heading 360", Instruction("heading", heading_deg=360.0)),
        ("contact washington center one three four decimal three two five",
         Instruction("contact", position="washington centre", frequency_khz=134_325)),
        ("contact washington center one three four point three two",
         Instruction("contact", position="washington centre", frequency_khz=134_325)),
        ("over to tower 119.1",
         Instruction("contact", position="tower", frequency_khz=119_100)),
        ("contact ground point seven",
         Instruction("contact", position="ground", frequency_khz=121_700)),
        ("squawk four five one two", Instruction("squawk", squawk="4512")),
        ("cleared i l s runway two seven right approach",
         Instruction("cleared_approach", "27R", approach="ils")),
        ("maintain present heading", Instruction("heading", position="present heading")),
        ("after passing dixie climb now, maintain flight level 330",
         Instruction("altitude", sense="climb", altitude_ft=33_000.0, immediate=True,
                     condition="after passing dixie")),
        ("climb flight level one hundred twenty",
         Instruction("altitude", sense="climb", altitude_ft=12_000.0)),
        ("climb now, maintain flight level 330",
         Instruction("altitude", sense="climb", altitude_ft=33_000.0, immediate=True)),
    ]  # fmt: skip
    for text, meant in table:
        with subtests.test(text):
            assert only(text) == meant


def test_what_recognisers_write_means_what_was_said(subtests: pytest.Subtests) -> None:
    for text, as_written in [
        ("run way o one left clear to land", "runway 01L cleared to land"),
        ("runway zero 1 cleared two land", "runway 01 cleared to land"),
        ("uh hold um shore of runway zero one", "hold short of runway 01"),
        ("whole short runway 0 1", "hold short runway 01"),
        ("line up n wait runway one nine", "line up runway 19"),
        ("turn write heading 2 70", "turn right heading 270"),
        ("climb flight level tree three oh", "climb FL330"),
        ("climb for thousand", "climb 4,000"),
        ("climb one oh thousand", "climb 10,000"),
        ("descend two flight level two four zero", "descend FL240"),
        ("cleared for take off runway tree fife center", "cleared for takeoff runway 35C"),
        ("lineup and wait runway thirty three", "line up and wait runway 33"),
        ("contact tower one nineteen point one", "contact tower 119.1"),
    ]:
        with subtests.test(text):
            assert call_to(text).instructions == call_to(as_written).instructions != ()


def test_calls_are_of_kinds(subtests: pytest.Subtests) -> None:
    for text, kind in [
        ("American 123, hold position", "instruction"),
        ("Hold position, American 123", "readback"),
        ("Tower, American 123, holding short runway 01", "report"),
        ("American 123, passing flight level 210, climbing flight level 330", "report"),
        ("Tower, American 123, ready for departure runway 01", "request"),
        ("Ground, American 123 is at the gate already", "unknown"),
        ("American 123, requesting flight level 350", "request"),
        ("American 123, report ready", "instruction"),
        ("American 123, say again", "say_again"),
        ("Say again, American 123", "say_again"),
        ("American 123, I say again, hold position", "instruction"),
        ("American 123, negative, I say again, hold position", "correction"),
        ("American 123, disregard", "disregard"),
        ("Roger, American 123", "report"),
        ("American 123, unable", "report"),
        ("Mayday mayday mayday, American 123, engine failure", "report"),
        ("American 123, QNH 1013", "report"),
        ("American 123, whatever that was", "unknown"),
        ("", "unknown"),
    ]:
        with subtests.test(text):
            assert parse_call(text, KNOWN).kind == kind


def test_the_last_word_counts(subtests: pytest.Subtests) -> None:
    table = [
        ("climb FL330, correction, FL350",
         [Instruction("altitude", sense="climb", altitude_ft=35_000.0)]),
        ("climb FL330, correction, FL350, turn left heading 090",
         [Instruction("altitude", sense="climb", altitude_ft=35_000.0),
          Instruction("heading", turn="left", heading_deg=90.0)]),
        ("line up runway 19, correction, runway 01, cleared for takeoff",
         [Instruction("cleared_for_takeoff", "01")]),
        ("climb FL330, correction, turn left heading 090",
         [Instruction("heading", turn="left", heading_deg=90.0)]),
        ("cleared to land runway 19, correction, runway 01",
         [Instruction("cleared_to_land", "01")]),
        ("turn left, correction, right heading 090",
         [Instruction("heading", turn="right", heading_deg=90.0)]),
        ("cleared for takeoff runway 01, correction, line up and wait runway 01",
         [Instruction("line_up", "01")]),
        ("cleared to land runway 01, disregard", []),
        ("cross runway 15, disregard my last, hold short of runway 15",
         [Instruction("hold_short", "15")]),
        ("cleared for takeoff, I say again, cleared for takeoff runway 19",
         [Instruction("cleared_for_takeoff", "19")]),
    ]  # fmt: skip
    for text, meant in table:
        with subtests.test(text):
            assert list(call_to(text).instructions) == meant


def test_a_call_tells_more_than_instructions() -> None:
    call = call_to("wind 350 at 8 gusts 15, altimeter 2992, runway 01, cleared to land")
    assert call.wind == Wind(350.0, 8.0, 15.0)
    assert call.pressure_hpa == pytest.approx(1013.2, abs=0.1)
    call = call_to("traffic two o'clock five miles opposite direction")
    assert call.traffic == ("traffic 2 oclock 5 miles opposite direction",)
    call = parse_call("Tower, American 123, six mile final runway 19", KNOWN)
    assert call.position == "6 mile final"
    assert parse_call("Mayday mayday mayday, American 123", KNOWN).distress
    assert parse_call("Pan pan, pan pan, American 123", KNOWN).urgency
    assert parse_call("Unable, American 123", KNOWN).negative
    assert parse_call("Wilco, American 123", KNOWN).acknowledged


def test_words_may_be_asked_for_again(subtests: pytest.Subtests) -> None:
    """A call that gives an instruction asks for none."""
    for words, is_asked in [
        ("say again", True),
        ("confirm runway", True),
        ("confirm cleared to land runway 19", True),
        ("verify you are holding short", True),
        ("read back", True),
        ("read that back", True),
        ("readback correct", False),
        ("readback is correct", False),
        ("read back hold short runway 19", False),
        ("confirmed", False),
        ("cleared to land runway 19", False),
        ("wind calm", False),
    ]:
        with subtests.test(words):
            assert call_to(words).asks_again is is_asked


# --- confidence ------------------------------------------------------------------------------


def test_confidence_is_that_of_the_least_sure_part(subtests: pytest.Subtests) -> None:
    for text, confidence in [
        ("runway one niner, cleared to land", 1.0),
        ("cleared to land one niner", 0.85),
        ("cleared to land", 0.75),
        ("runway niner, cleared to land", 0.75),
        ("climb flight level niner zero", 0.75),
        ("turn left", 0.6),
        ("turn left at alfa", 1.0),
        ("turn left at one", 0.6),
        ("whole short of runway one niner", 0.9),
        ("line up and weight runway one niner", 0.9),
        ("climb flight level two two zero", 1.0),
        ("climb to one two thousand", 1.0),
        ("descend two thousand five hundred", 1.0),
        ("descend two two thousand", 0.6),
        ("descend two two thousand five hundred", 0.6),
        ("climb two four thousand", 0.6),
        ("climb and maintain two four thousand", 0.6),
        ("maintain 24,000 feet", 0.6),
        ("climb flight level three three zero, correction, two four thousand", 0.54),
        ("mumble mumble", 0.0),
    ]:
        with subtests.test(text):
            assert call_to(text).confidence == pytest.approx(confidence)


def test_words_that_the_recogniser_is_not_sure_of_count_where_they_matter() -> None:
    words = "american one two three good day climb flight level three three zero"
    sure = [1.0] * len(words.split())
    unsure = {name: list(sure) for name in ("callsign", "level", "greeting")}
    unsure["callsign"][2] = 0.4
    unsure["level"][-1] = 0.5
    unsure["greeting"][4] = 0.1
    confidence = {name: parse_call(words, KNOWN, each).confidence for name, each in unsure.items()}
    assert confidence == {"callsign": 0.4, "level": 0.5, "greeting": 1.0}


def test_words_without_which_an_action_means_the_same_need_not_be_heard_surely() -> None:
    words = "american one two three climb and maintain three thousand hold short of the runway"
    idle = [0.3 if word in ("and", "the") else 1.0 for word in words.split()]
    assert parse_call(words, KNOWN, idle) == parse_call(words, KNOWN)
    without_and = [0.3 if word == "maintain" else 1.0 for word in words.split()]
    assert parse_call(words, KNOWN, without_and).confidence == pytest.approx(0.3)


def test_confidences_of_other_words_are_an_error() -> None:
    with pytest.raises(ValueError, match="2 word confidences for 3 words"):
        parse_call("one two three", KNOWN, [1.0, 1.0])


@settings(deadline=None)
@given(
    st.lists(st.sampled_from(["american", "one", "two", "three", "runway", "01", "cleared", "to",
                              "land", "hold", "uh"]),
             max_size=12),
    st.floats(0.0, 1.0),
)  # fmt: skip
def test_confidence_is_within_zero_and_one_and_no_more_than_that_of_the_words(
    words: list[Any], sure: float
) -> None:
    call = parse_call(" ".join(words), KNOWN, [sure] * len(words))
    assert 0.0 <= call.confidence <= sure or not words


def test_the_pronunciations_of_icao_are_digits_in_every_value() -> None:
    known = ("DAL345", "N9345F")
    text = (
        "delta tree fower fife, descend to tree tousand fower hundred feet, turn right heading zero"
        " fower fife, squawk fower tree fife two, contact tower one one eight dayseemal tree fife,"
        " Q N H niner niner fife, runway tree fower left, wind tree fower zero degrees fife knots"
    )
    call = parse_call(text, known)
    assert call.callsign == "DAL345"
    found = {each.action: each for each in call.instructions}
    assert found["altitude"].altitude_ft == 3400.0
    assert found["heading"].heading_deg == 45.0
    assert found["squawk"].squawk == "4352"
    assert found["contact"].frequency_khz == 118_350
    assert call.pressure_hpa == 995.0
    assert call.wind == Wind(direction_deg=340.0, speed_kt=5.0)
    assert parse_call("november niner tree fower fife foxtrot", known).callsign == "N9345F"
