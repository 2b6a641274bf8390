"""Instructions of flight: fixes, levels, speeds, approaches, and what is later or expected."""

from __future__ import annotations

import pytest

from airhilt.phraseology import Instruction, parse_call
from airhilt.phraseology.call import Call

KNOWN = ("AAL123", "DAL456", "N172SP")


def call_to(text: str) -> Call:
    return parse_call(f"american one two three {text}", KNOWN)


def only(text: str) -> Instruction:
    (instruction,) = call_to(text).instructions
    return instruction


def test_an_instruction_has_what_is_said_about_it(subtests: pytest.Subtests) -> None:
    table = [
        ("proceed direct deer park", Instruction("direct", position="deer park")),
        ("turn left direct line creek", Instruction("direct", position="line creek", turn="left")),
        ("cleared direct to cross city", Instruction("direct", position="cross city")),
        ("hold at deer park as published left turns",
         Instruction("hold_at", position="deer park", turn="left")),
        ("hold north of lander as published", Instruction("hold_at", position="lander")),
        ("turn two zero degrees left", Instruction("turn_by", turn="left", turn_deg=20.0)),
        ("stop turn heading two one zero", Instruction("heading", heading_deg=210.0)),
        ("cross camrn at or above flight level two one zero at two five zero knots",
         Instruction("cross_fix", position="camrn", bound="or_more", altitude_ft=21_000.0,
                     speed_kt=250.0)),
        ("cross nine mile at three thousand",
         Instruction("cross_fix", position="9 mile", altitude_ft=3_000.0)),
        ("climb via the deer park four departure",
         Instruction("climb_via", position="deer park 4")),
        ("descend via the hasty two arrival", Instruction("descend_via", position="hasty 2")),
        ("maintain v f r at or below three thousand five hundred",
         Instruction("altitude", sense="maintain", altitude_ft=3_500.0, bound="or_less")),
        ("maintain mach point seven eight or greater",
         Instruction("mach", mach=0.78, bound="or_more")),
        ("do not exceed two five zero knots",
         Instruction("speed", speed_kt=250.0, bound="or_less")),
        ("reduce to minimum approach speed", Instruction("speed", named="minimum approach")),
        ("resume normal speed", Instruction("resume_speed", named="normal")),
        ("no speed restrictions", Instruction("no_speed_restrictions")),
        ("cleared i l s zulu runway two seven left approach",
         Instruction("cleared_approach", "27L", approach="ils", variant="Z")),
        ("cleared localizer back course runway three one approach",
         Instruction("cleared_approach", "31", approach="localizer back course")),
        ("cleared n d b runway zero six approach",
         Instruction("cleared_approach", "06", approach="ndb")),
        ("circle to runway three five", Instruction("circle", "35")),
        ("cancel approach clearance", Instruction("cancel_approach")),
        ("execute missed approach", Instruction("missed_approach")),
        ("squawk ident", Instruction("ident")),
        ("maintain visual separation", Instruction("visual_separation")),
        ("two six left cleared for takeoff", Instruction("cleared_for_takeoff", "26L")),
        ("cleared across runway two seven", Instruction("cross", "27")),
        ("contact boston approach one two four five",
         Instruction("contact", position="boston approach", frequency_khz=124_500)),
        ("runway one niner taxi via alfa bravo two",
         Instruction("taxi", "19", via=("A", "B2"))),
    ]  # fmt: skip
    for text, meant in table:
        with subtests.test(text):
            assert only(text) == meant


def test_what_waits_for_an_event_is_conditional(subtests: pytest.Subtests) -> None:
    table = [
        ("when able proceed direct lander", "when able"),
        ("descend and maintain five thousand at pilot's discretion", "at pilot discretion"),
        ("when ready climb to flight level three one zero", "when ready"),
        ("at hector descend and maintain four thousand", "at hector"),
        ("passing temax contact center one two four point five", "passing temax"),
        ("two zero miles before sparta descend and maintain six thousand",
         "20 miles before sparta"),
        ("depart lanna heading two two zero", "depart lanna"),
        ("fly runway heading after departure", "after departure"),
        ("contact tower crossing the marker", "crossing the marker"),
        ("after the boeing passes continue taxi via alfa", "after the boeing passes"),
    ]  # fmt: skip
    for text, condition in table:
        with subtests.test(text):
            read = only(text)
            assert (read.condition, read.is_conditional) == (condition, True)


@pytest.mark.parametrize(
    ("text", "until"),
    [
        ("maintain two one zero knots until five mile final", "until 5 mile final"),
        ("maintain three thousand until established", "until established"),
    ],
)
def test_what_ends_at_an_event_is_in_effect_now(text: str, until: str) -> None:
    read = only(text)
    assert (read.until, read.is_conditional) == (until, False)


def test_what_is_expected_is_no_instruction(subtests: pytest.Subtests) -> None:
    table = [
        ("expect flight level three five zero ten minutes after departure",
         Instruction("altitude", altitude_ft=35_000.0, condition="after departure")),
        ("expect i l s runway two seven left approach",
         Instruction("cleared_approach", "27L", approach="ils")),
        ("expect vectors visual approach runway one niner",
         Instruction("cleared_approach", "19", approach="visual")),
        ("expect direct lander", Instruction("direct", position="lander")),
        ("expect holding at deer park", Instruction("hold_at", position="deer park")),
        ("expect departure runway three six", Instruction("cleared_for_takeoff", "36")),
    ]  # fmt: skip
    for text, expected in table:
        with subtests.test(text):
            call = call_to(text)
            assert (call.instructions, call.expected) == ((), (expected,))


def test_a_turn_given_with_the_takeoff_waits_for_it() -> None:
    turn, takeoff = call_to(
        "turn left heading two two zero runway three six cleared for takeoff"
    ).instructions
    assert (turn.condition, takeoff.condition) == ("when airborne", None)


def test_a_clearance_before_departure_is_for_after_it() -> None:
    call = call_to(
        "cleared to dulles airport hasty two departure then as filed climb to five thousand "
        "expect flight level three five zero ten minutes after departure "
        "departure frequency one two four point five squawk four five one two"
    )
    assert {each.action: each.condition for each in call.instructions} == {
        "altitude": "after departure", "contact": "after departure", "squawk": None
    }  # fmt: skip
    assert [each.altitude_ft for each in call.expected] == [35_000.0]


def test_everything_for_a_missed_approach_waits_for_one() -> None:
    text = (
        "in the event of missed approach fly heading two two zero climb and maintain four thousand"
    )
    assert all(each.is_conditional for each in call_to(text).instructions)


def test_then_puts_the_second_of_two_off() -> None:
    first, second = call_to(
        "reduce speed to two one zero then descend to four thousand"
    ).instructions
    assert (first.condition, second.condition) == (None, "then")


def test_words_about_other_things_are_no_instruction(subtests: pytest.Subtests) -> None:
    for text in [
        "traffic two o'clock five miles heavy boeing descending flight level three five zero",
        "stop squawk",
        "squawk standby",
        "maintain block flight level two zero zero through flight level two two zero",
        "deer park altimeter two niner niner two",
        "the aircraft ahead was assigned heading two one zero",
    ]:
        with subtests.test(text):
            assert call_to(text).instructions == ()


def test_what_makes_no_sense_or_lacks_a_word_is_doubtful(subtests: pytest.Subtests) -> None:
    for text in [
        "descend and maintain five five one zero",
        "descend two thousand seven hundred ten left",
        "climb and maintain one two twelve thousand",
        "reduce speed to one eight seven",
        "reduce speed to five zero zero knots",
        "reduce speed to two one zero feet",
        "maintain four thousand five hundred knots",
        "turn left heading three seven zero",
        "turn feet heading two one zero",
        "maintain three thousand above",
        "super able climb and maintain five thousand",
        "runway two seven rime cleared to land",
        "runway two seven line up and wait cleared to land",
        "taxi runway one six via alfa krr bravo",
    ]:
        with subtests.test(text):
            call = call_to(text)
            assert call.instructions
            assert min(each.confidence for each in call.instructions) < 0.8


def test_a_level_above_the_ceiling_of_the_aircraft_is_doubtful() -> None:
    text = "american one two three climb and maintain one six thousand"
    assert parse_call(text, KNOWN).confidence == 1.0
    assert parse_call(text, KNOWN, ceilings_ft={"AAL123": 14_000.0}).confidence < 0.8
    assert parse_call(text, KNOWN, ceilings_ft={"DAL456": 14_000.0}).confidence == 1.0


def test_numbers_that_run_together_are_told_apart_and_doubtful() -> None:
    text = "flight level three zero zero two eight zero knots american one two three"
    level, speed = parse_call(text, KNOWN).instructions
    assert (level.altitude_ft, speed.speed_kt) == (30_000.0, 280.0)
    assert max(level.confidence, speed.confidence) < 0.8


def test_a_slip_of_the_tongue_is_corrected_wherever_it_is() -> None:
    text = "turn left heading two one zero traffic at four thousand correction five thousand"
    assert only(text) == Instruction("heading", turn="left", heading_deg=210.0)
    assert (
        only("climb flight level three five zero correction three six zero").altitude_ft == 36_000
    )


def test_a_level_for_later_is_not_that_of_the_call() -> None:
    assert call_to("when ready climb to flight level three one zero").altitude is None
    assert call_to("climb to flight level three one zero").altitude_ft == 31_000.0


def test_a_frequency_may_lack_its_hundred_or_its_point_but_not_for_certain(
    subtests: pytest.Subtests,
) -> None:
    """The band begins with a 1 everywhere, and ground control has 121 MHz."""
    for text, station, khz, confidence in [
        ("contact tower one one eight decimal three", "tower", 118_300, 1.0),
        ("contact tower eighteen three", "tower", 118_300, 0.85),
        ("contact eighteen three", None, 118_300, 0.75),
        ("contact tower one eighteen three", "tower", 118_300, 0.85),
        ("monitor ground decimal nine", "ground", 121_900, 0.85),
        ("contact tower", "tower", None, 0.85),
    ]:
        with subtests.test(text):
            contact = only(text)
            assert (contact.position, contact.frequency_khz) == (station, khz)
            assert contact.confidence == pytest.approx(confidence)
