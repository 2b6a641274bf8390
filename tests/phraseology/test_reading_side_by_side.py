"""Values, clearances, conditions and callsigns that stand side by side in a call keep apart."""

from __future__ import annotations

import pytest

from airhilt.phraseology import TAU_ASR, Instruction, parse_call
from airhilt.phraseology.call import Call

KNOWN = ("AAL123", "DAL456")


def call_to(text: str) -> Call:
    return parse_call(f"delta four five six {text}", KNOWN)


def by(text: str) -> Call:
    return parse_call(f"{text} delta four five six", KNOWN)


# --- numbers that run together --------------------------------------------------------------


def test_of_two_numbers_that_run_together_only_the_first_is_in_doubt() -> None:
    heading, speed = call_to("turn left heading two seven zero one eight zero knots").instructions
    assert (heading.heading_deg, speed.speed_kt) == (270.0, 180.0)
    assert heading.action_heard < TAU_ASR
    assert speed.action_heard == speed.details_heard == 1.0


@pytest.mark.parametrize(
    ("text", "hpa"),
    [
        ("qnh niner niner eight ten degrees right", 998.0),
        ("qnh one zero one three ten degrees right", 1013.0),
        ("altimeter three zero zero two ten degrees right", 1016.6),
    ],
)
def test_a_pressure_ends_where_the_number_behind_it_begins(text: str, hpa: float) -> None:
    call = call_to(text)
    assert call.pressure_hpa == pytest.approx(hpa, abs=0.1)
    assert [each.turn_deg for each in call.instructions] == [10.0]


def test_a_hesitation_between_two_whole_numbers_keeps_them_apart() -> None:
    heading, speed = call_to("turn heading two twenty and uh two five zero knots").instructions
    assert (heading.heading_deg, speed.speed_kt) == (220.0, 250.0)


@pytest.mark.parametrize(
    "text", ["ten degrees right", "two hundred knots or less", "two seven left cleared to land"]
)
def test_a_value_right_behind_a_callsign_leaves_it_as_sure_as_one_acts_on(text: str) -> None:
    call = call_to(text)
    assert call.callsign == "DAL456"
    assert call.match.score >= TAU_ASR
    assert call.instructions


# --- instructions -------------------------------------------------------------------------------


def test_clearances_that_exclude_each_other_leave_the_rest_of_the_call_as_sure_as_it_was() -> None:
    call = call_to("runway 27 line up and wait, cleared to land, squawk four six two one")
    sure = {each.action: each.confidence >= TAU_ASR for each in call.instructions}
    assert sure == {"line_up": False, "cleared_to_land": False, "squawk": True}


def test_what_follows_own_navigation_waits_for_it_only_if_it_is_direct() -> None:
    climb = call_to("passing lander resume own navigation, climb to flight level 220")
    assert [each.condition for each in climb.instructions] == ["passing lander", None]
    direct = call_to("passing lander resume own navigation direct temax")
    assert {each.condition for each in direct.instructions} == {"passing lander"}


@pytest.mark.parametrize("word", ["snorble", "zorple"])
def test_a_word_that_nobody_knows_before_and_leaves_what_follows_in_doubt(word: str) -> None:
    """It may have been "when able"."""
    (doubted,) = call_to(f"{word} and climb four thousand").instructions
    assert doubted.altitude_ft == 4_000.0
    assert doubted.confidence < TAU_ASR
    (sure,) = call_to("climb four thousand").instructions
    assert sure.confidence >= TAU_ASR


@pytest.mark.parametrize(
    ("text", "runway"),
    [
        ("runway 27, cleared to land, and runway 19", "27"),
        ("runway 27 right line up and wait, then runway 27 left", "27R"),
        ("runway 27 cleared to land, wind 270 at 10, runway 19 is closed", "27"),
    ],
)
def test_a_clearance_with_its_runway_before_it_does_not_take_one_that_comes_later(
    text: str, runway: str
) -> None:
    assert [each.runway for each in call_to(text).instructions] == [runway]


@pytest.mark.parametrize(
    "text", ["at two five zero knots then five thousand", "at 250 knots flight level 210"]
)
def test_a_crossing_at_a_speed_is_at_no_level_that_comes_later(text: str) -> None:
    (crossing,) = call_to(f"cross lander {text}").instructions
    assert (crossing.speed_kt, crossing.altitude_ft) == (250.0, None)


def test_a_number_behind_the_level_of_a_crossing_is_no_speed_without_a_word_for_it() -> None:
    (crossing,) = call_to("cross lander at one zero thousand, one ninety").instructions
    assert (crossing.altitude_ft, crossing.speed_kt) == (10_000.0, None)
    assert crossing.confidence < TAU_ASR


# --- conditions -----------------------------------------------------------------------------


@pytest.mark.parametrize("condition", ["when able", "when ready"])
def test_a_route_that_is_read_back_without_a_verb_keeps_its_condition(condition: str) -> None:
    (route,) = by(f"{condition} via alfa bravo").instructions
    assert route == Instruction("taxi", via=("A", "B"), condition=condition)


def test_a_condition_may_end_right_before_the_callsign() -> None:
    (read,) = by("line up runway 27 after the boeing passes").instructions
    assert read == Instruction("line_up", "27", condition="after the boeing passes")


@pytest.mark.parametrize("text", ["hold short", "maintain one eight zero knots"])
def test_the_runway_of_a_final_belongs_to_the_limit(text: str) -> None:
    (read,) = call_to(f"{text} until four mile final of runway 19").instructions
    assert (read.until, read.runway) == ("until 4 mile final of runway 19", None)


# --- who speaks, and of whom ----------------------------------------------------------------


def test_a_readback_that_begins_like_the_name_of_another_keeps_its_words() -> None:
    call = by("american one three two then number two, cleared to land runway two seven")
    assert (call.callsign, call.kind) == ("DAL456", "readback")
    assert [(each.action, each.runway) for each in call.instructions] == [("cleared_to_land", "27")]


@pytest.mark.parametrize("text", ["runway two seven left", "line up and wait runway two seven"])
def test_who_begins_with_no_callsign_and_ends_with_none_is_a_pilot(text: str) -> None:
    """A unit begins with the callsign of whom it calls (Annex 10 volume II, 5.2.1.7.3.2.3)."""
    spoken = parse_call(text, KNOWN).spoken
    assert (spoken.speaker, spoken.confidence < TAU_ASR) == ("pilot", True)


@pytest.mark.parametrize("word", ["inbound", "airborne"])
def test_a_word_of_pilots_in_traffic_information_makes_no_pilot_of_the_controller(
    word: str,
) -> None:
    call = call_to(f"number two, a Cessna is {word} ahead")
    assert call.spoken.speaker == "controller"


# --- how sure it is -------------------------------------------------------------------------


@pytest.mark.parametrize("heard", [0.5, 0.9])
def test_details_are_as_sure_as_they_were_heard_and_as_they_make_sense(heard: float) -> None:
    """Details that make sense by 0.6 and were heard by 0.5 have 0.3, and their sense alone 0.6."""
    read = Instruction("line_up", confidence=0.6 * heard, action_heard=heard, details_heard=1.0)
    assert read.details_confidence == pytest.approx(0.6)
    clear = Instruction("line_up", confidence=heard, details_heard=heard)
    assert clear.details_confidence == pytest.approx(heard)
