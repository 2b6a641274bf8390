"""One word more, or in another place, decides what the words around it mean."""

from __future__ import annotations

import pytest

from airhilt.phraseology import Call, Instruction, parse_call, tokens
from airhilt.phraseology.bare_values import without_courtesies
from airhilt.phraseology.hits import NAME
from airhilt.phraseology.numbers import speak_group
from airhilt.phraseology.speakers import speaker_of
from airhilt.phraseology.vocabulary import has_unknown_side

KNOWN = ("DAL88", "AAL123", "OPS1")


def told(words: str) -> Call:
    return parse_call(f"delta eighty eight {words}", KNOWN)


def read_back(words: str) -> tuple[Instruction, ...]:
    return parse_call(f"{words} delta eighty eight", KNOWN).instructions


# --- levels, speeds and headings ------------------------------------------------------------


def test_only_a_level_right_behind_its_to_is_that_of_a_procedure() -> None:
    climb = told("climb via the capss one departure to flight level two zero zero")
    assert [(each.action, each.altitude_ft) for each in climb.instructions] == [
        ("climb_via", None), ("altitude", 20_000.0),
    ]  # fmt: skip
    joins = told("descend via capss one arrival to cirba at flight level two zero zero")
    assert [each.action for each in joins.instructions] == ["descend_via"]


def test_a_bare_number_of_feet_is_certain_and_one_with_knots_makes_no_sense() -> None:
    (feet,) = told("maintain thirty five hundred").instructions
    (knots,) = told("maintain thirty five hundred knots").instructions
    assert (feet.altitude_ft, feet.confidence) == (3_500.0, 1.0)
    assert knots.confidence < feet.confidence


def test_a_number_before_then_and_a_level_is_the_speed_that_comes_first() -> None:
    """FAA Order JO 7110.65, 5-7-2: a speed before a descent is told with "then"."""
    speed, level = read_back("one ninety then five thousand")
    assert (speed.action, speed.speed_kt, speed.condition) == ("speed", 190.0, None)
    assert (level.action, level.altitude_ft, level.condition) == ("altitude", 5_000.0, "then")


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("degrees", ["ten", "twenty", "thirty"])
def test_degrees_that_are_read_back_alone_turn_to_their_side(degrees: str, side: str) -> None:
    level, turn = read_back(f"five thousand {degrees} {side}")
    assert (turn.action, turn.turn) == ("turn_by", side)
    assert turn.turn_deg == {"ten": 10.0, "twenty": 20.0, "thirty": 30.0}[degrees]
    assert level.altitude_ft == 5_000.0


# --- conditions -----------------------------------------------------------------------------


@pytest.mark.parametrize("word", ["when", "until", "after"])
def test_a_single_word_at_the_end_is_no_condition(word: str) -> None:
    (direct,) = told(f"direct delta {word}").instructions
    assert (direct.action, direct.condition) == ("direct", None)


def test_what_waits_for_a_condition_right_before_it_has_it() -> None:
    (contact,) = told("when clear ground point niner").instructions
    assert (contact.condition, contact.frequency_khz) == ("when clear", 121_900)
    (at_once,) = told("contact ground point niner").instructions
    assert at_once.condition is None


def test_a_frequency_waits_for_the_departure_only_in_a_clearance_before_it() -> None:
    """FAA Order JO 7110.65, 4-3-2: the clearance has "as filed" or a code beside it."""
    told_on = "departure will be one two four six five"
    before = told(f"cleared to london as filed {told_on} squawk four two one three").instructions
    assert [each.condition for each in before if each.action == "contact"] == ["after departure"]
    (now,) = told(f"squawk three eight three zero {told_on}").instructions  # There is no such code.
    assert (now.action, now.frequency_khz, now.condition) == ("contact", 124_650, None)


# --- who is called --------------------------------------------------------------------------


def test_who_is_spoken_of_is_not_who_is_called(subtests: pytest.Subtests) -> None:
    for words, callsign in [
        ("delta eighty eight negative traffic behind", "DAL88"),
        ("delta eighty eight hold position traffic behind", "DAL88"),
        ("american one two three follow delta eighty eight", "AAL123"),
        ("behind delta eighty eight line up and wait runway one", None),
        ("taxi behind the delta eighty eight via alpha", None),
        ("vacating runway one we follow delta eighty eight", "DAL88"),
    ]:
        with subtests.test(words):
            assert parse_call(words, KNOWN).callsign == callsign


def test_a_name_with_other_numbers_may_be_a_known_one_the_more_the_more_alike() -> None:
    alike, unlike = (parse_call(f"delta {number}", KNOWN).match for number in ("eight", "two zero"))
    assert (alike.callsign, unlike.callsign) == (None, None)
    (likely,), (unlikely,) = alike.candidates, unlike.candidates
    assert likely.callsign == unlikely.callsign == "DAL88"
    assert 0.59 > likely.score > unlikely.score > 0.0


def test_a_holding_point_is_no_name_at_the_beginning_of_a_call() -> None:
    assert not parse_call("holding point alpha one", KNOWN).addressed_first


# --- words of readbacks ---------------------------------------------------------------------


def test_courtesies_are_left_out_and_sides_of_runways_kept(subtests: pytest.Subtests) -> None:
    for words, kept in [
        ("roger 270 thanks", "270"),
        ("270 thank you good day", "270"),
        ("24 right", "24 right"),
        ("24 right thanks bye", "24 right"),
        ("right 270", "right 270"),
        ("and 270 to", "270"),
        ("5 thousand have a good 1", "5 thousand"),
        ("roger wilco", ""),
    ]:
        with subtests.test(words):
            assert " ".join(without_courtesies(words.split())) == kept


def test_not_is_a_word_of_its_own(subtests: pytest.Subtests) -> None:
    for verb in ["do", "is", "could", "does", "would", "are", "had"]:
        with subtests.test(verb):
            assert tokens(f"{verb}n't") == [verb, "not"]


@pytest.mark.parametrize(
    ("words", "runway"),
    [
        ("runway two for left cleared to land", "24L"),
        ("runway two fore cleared to land", None),
        ("runway three for right line up and wait", "34R"),
    ],
)
def test_for_is_four_only_where_it_completes_a_runway(words: str, runway: str | None) -> None:
    found = {each.runway for each in told(words).instructions}
    assert runway is None or runway in found


def test_an_unknown_word_soon_after_a_runway_may_be_its_side(subtests: pytest.Subtests) -> None:
    for words, is_doubtful in [
        ("runway 15 rime", True),
        ("runway 15 rime turnout", False),
        ("runway 15 and the rime", True),
        ("runway 15 and the a rime", True),
        ("runway 15 and the a that rime", False),  # Five words on, it is the runway's no more.
        ("runway 15 cleared", False),
        ("runway 15 left cleared", False),
        ("runway 15 left", False),
        ("hold short of 15 right |", False),
        ("runway 15 and left turn", False),
    ]:
        with subtests.test(words):
            assert has_unknown_side(words, 0, len(words)) is is_doubtful


# --- numbers in groups ----------------------------------------------------------------------


def test_a_number_is_spoken_in_pairs(subtests: pytest.Subtests) -> None:
    """FAA Order JO 7110.65, 2-4-16: group form."""
    table = [
        (0, "zero"), (9, "niner"), (10, "ten"), (19, "nineteen"), (20, "twenty"),
        (21, "twenty one"), (90, "ninety"), (99, "ninety niner"), (100, "one hundred"),
        (101, "one zero one"), (110, "one ten"), (119, "one nineteen"), (199, "one ninety niner"),
        (1005, "ten zero five"), (1200, "twelve hundred"), (1234, "twelve thirty four"),
        (9999, "ninety niner ninety niner"),
    ]  # fmt: skip
    for number, spoken in table:
        with subtests.test(spoken):
            assert speak_group(number, "faa") == spoken


# --- who speaks -----------------------------------------------------------------------------


def odds(text: str) -> float:
    """Return the odds that it is a pilot."""
    speaker, confidence = speaker_of(text)
    assert 0.5 <= confidence <= 1.0
    share = confidence if speaker == "pilot" else 1.0 - confidence
    return share / (1.0 - share)


def test_each_sign_speaks_for_a_controller_or_for_a_pilot(subtests: pytest.Subtests) -> None:
    """ICAO Annex 10 volume II, 5.2.1.7.3.2.3 and 5.2.1.9.2.2; FAA AIM 4-2-3."""
    for controllers, pilots in [
        (f"{NAME} potomac approach good morning", f"{NAME} good morning to everybody there"),
        (f"{NAME} tower good morning", f"{NAME} good morning"),
        (f"{NAME} 270", "270"),
        ("270", f"270 {NAME}"),
        (f"{NAME} potomac tower", f"potomac tower {NAME}"),
        (f"{NAME} turn left", f"{NAME} turning left"),
        (f"{NAME} climb", f"climb {NAME}"),
        (f"{NAME} report the field in sight", f"{NAME} field in sight"),
        (f"{NAME} radar contact", f"{NAME} roger"),
        (f"{NAME} altimeter 2992", f"{NAME} 2992"),
        (f"{NAME} wind 280 at 8", f"{NAME} we copy"),
    ]:
        with subtests.test(controllers):
            assert odds(controllers) < odds(pilots)


def test_a_callsign_at_the_end_outweighs_one_word_of_a_controller_and_not_two() -> None:
    assert speaker_of(f"disregard {NAME}").speaker == "pilot"
    both = speaker_of(f"radar contact disregard {NAME}")
    assert both.speaker == "controller"
    assert both.confidence > 0.7
