"""What is heard with too little confidence is neither believed nor ignored: it is asked for."""

from __future__ import annotations

import pytest

from airfield import NORTH, Airfield, Mover, lands, takes_off
from airhilt.assistant.decision.engines.reference import ReferenceConfig
from airhilt.assistant.decision.guard import call_of
from airhilt.messages import Advisory, Confirm, Transcript
from decisions import reference
from encounters import Encounter, Flight

CLEARED = (20.0, "American one two three, runway zero one, cleared to land.")
UNSURE_CLEARED = (20.0, "American one two three, runway zero? one?, cleared to land.")
RIGHT = (26.0, "Cleared to land runway zero one, American one two three.")
WRONG = (26.0, "Cleared to land runway one niner, American one two three.")
UNSURE_WRONG = (26.0, "Cleared to land runway one? niner, American one two three.")
UNSURE_NAME = (20.0, "American? one? two? three?, runway zero one, cleared to land.")


def field(*calls: tuple[float, str], tau_asr: float = 0.8, is_busy: bool = True) -> Airfield:
    """One is on final; another stands on the runway."""
    movers = [Mover("AAL123", NORTH, lands(160))]
    if is_busy:
        movers.append(Mover("DAL456", NORTH, takes_off(999.0)))
    worker = reference(ReferenceConfig(tau_asr=tau_asr))
    return Airfield(movers, list(calls), worker=worker, openings_are_heard=True)


def questions(airfield: Airfield | Encounter) -> list[tuple[float, str, str]]:
    return [
        (t_s, each.recommendation.callsign, each.recommendation.slot)
        for t_s, each in airfield.told
        if isinstance(each.recommendation, Confirm)
    ]


def mismatches(airfield: Airfield | Encounter) -> list[Advisory]:
    return [each for _, each in airfield.told if each.kind == "readback_mismatch"]


def test_a_readback_that_is_wrong_where_it_is_unsure_is_asked_for_and_not_told() -> None:
    airfield = field(CLEARED, UNSURE_WRONG).run(40)
    assert questions(airfield) == [(26.0, "AAL123", "runway")]
    assert mismatches(airfield) == []
    ((_, asked),) = airfield.told
    assert (asked.kind, asked.severity, asked.recipient) == ("clarification", "ADVISORY", "ATC")
    assert asked.evidence.radio_ids == ("1",)
    assert asked.message.startswith("confirm runway of AAL123")


def test_a_readback_that_differs_from_an_unsure_instruction_is_asked_for_and_not_told() -> None:
    airfield = field(UNSURE_CLEARED, WRONG).run(40)
    assert questions(airfield) == [(26.0, "AAL123", "runway")]
    assert mismatches(airfield) == []


def test_said_again_with_confidence_it_is_told() -> None:
    airfield = field(CLEARED, UNSURE_WRONG, (34.0, WRONG[1])).run(40)
    assert {each.t_ready_ns for each in mismatches(airfield)} == {34 * 10**9}
    assert len(questions(airfield)) == 1


def test_a_threshold_of_0_believes_every_word() -> None:
    airfield = field(CLEARED, UNSURE_WRONG, tau_asr=0.0).run(40)
    assert questions(airfield) == []
    assert len(mismatches(airfield)) == 2


@pytest.mark.parametrize("unsure", [UNSURE_CLEARED, UNSURE_NAME])
def test_what_is_read_back_as_it_was_heard_needs_no_question(unsure: tuple[float, str]) -> None:
    assert field(unsure, RIGHT).run(45).told == []


def test_an_instruction_of_which_only_the_name_is_unsure_is_not_misaddressed() -> None:
    other = (26.0, "Cleared to land runway zero one, Delta four five six.")
    airfield = field(UNSURE_NAME, other).run(40)
    assert questions(airfield) == [(26.0, "AAL123", "callsign")]
    assert mismatches(airfield) == []


def test_a_sure_readback_of_what_was_not_heard_is_asked_for_where_words_are_unsure() -> None:
    garbled = (20.0, "American one two three, hold position, lend? to the.")
    airfield = field(garbled, RIGHT).run(40)
    assert questions(airfield) == [(26.0, "AAL123", "action")]
    assert mismatches(airfield) == []


SAY_AGAIN = (32.0, "American one two three, say again.")
TWICE_IS_ENOUGH = 0.7
"""Threshold that one unsure word does not reach, and two that were heard alike do."""


def test_the_same_wrong_runway_heard_again_is_told_though_each_call_is_unsure() -> None:
    again = (36.0, UNSURE_WRONG[1])
    airfield = field(CLEARED, UNSURE_WRONG, SAY_AGAIN, again, tau_asr=TWICE_IS_ENOUGH).run(50)
    assert {each.t_ready_ns for each in mismatches(airfield)} == {36 * 10**9}
    assert questions(airfield) == [(26.0, "AAL123", "runway")]


@pytest.mark.parametrize("first", [UNSURE_CLEARED[1], CLEARED[1]], ids=["unsure", "sure"])
def test_an_instruction_that_was_heard_twice_alike_makes_its_readback_wrong(first: str) -> None:
    told = [(14.0, first), (20.0, UNSURE_CLEARED[1])]
    airfield = field(*told, WRONG, tau_asr=TWICE_IS_ENOUGH).run(40)
    assert {each.t_ready_ns for each in mismatches(airfield)} == {26 * 10**9}
    assert questions(airfield) == []


@pytest.mark.parametrize(
    "asking",
    ["say again", "confirm runway", "confirm cleared to land runway zero one", "verify runway",
     "read back runway"],
)  # fmt: skip
def test_a_readback_may_be_asked_for_again_in_several_words(asking: str) -> None:
    asked = (32.0, f"American one two three, {asking}.")
    right = field(CLEARED, UNSURE_WRONG, asked, (36.0, RIGHT[1])).run(60)
    assert mismatches(right) == []
    wrong = field(CLEARED, UNSURE_WRONG, asked, (55.0, WRONG[1])).run(60)
    assert "01" in mismatches(wrong)[0].message


@pytest.mark.parametrize("asked_s", [(32.0, 58.0), (58.0,)])
def test_each_time_it_is_asked_for_a_readback_has_half_a_minute(asked_s: tuple[float, ...]) -> None:
    asked = [(t_s, SAY_AGAIN[1]) for t_s in asked_s]
    airfield = field(CLEARED, UNSURE_WRONG, *asked, (80.0, WRONG[1])).run(90)
    assert {each.t_ready_ns for each in mismatches(airfield)} == {80 * 10**9}


HOLD = (20.0, "American one two three, hold short of runway zero one.")
HOLDS = (26.0, "Holding short of runway zero one, American one two three.")


LINES_UP = "Lining up runway zero one, American one two three."
INFORMATION = "American one two three, wind two seven zero at eight."


@pytest.mark.parametrize(
    ("since", "is_of_readback"),
    [
        ([], True),
        ([(38.0, "American one two three, roger.")], True),
        ([(38.0, "Roger, American one two three.")], True),
        ([(38.0, "American one two three.")], True),
        ([(38.0, "Tower, American one two three, request taxi via alpha.")], False),
        ([(38.0, INFORMATION)], False),
        ([(32.0, SAY_AGAIN[1]), (38.0, HOLDS[1])], True),
        ([(32.0, SAY_AGAIN[1]), (38.0, HOLDS[1]), (42.0, INFORMATION)], False),
    ],
    ids=["nothing", "roger", "roger of the crew", "a roger that is not heard", "a request",
         "information", "the readback again", "information after the readback again"],
)  # fmt: skip
def test_say_again_is_about_the_readback_only_if_nothing_was_said_since(
    since: list[tuple[float, str]], is_of_readback: bool
) -> None:
    """Another clearance after it is a wrong readback then, and otherwise none that is known."""
    calls = [HOLD, HOLDS, *since, (50.0, SAY_AGAIN[1]), (56.0, LINES_UP)]
    assert bool(mismatches(field(*calls).run(65))) is is_of_readback


@pytest.mark.parametrize(
    "between",
    [[], [(34.0, "American one two three, roger.")], [(34.0, "American one two three, four?.")]],
    ids=["nothing", "roger", "something"],
)
def test_a_readback_that_was_asked_for_again_belongs_to_the_instruction_before(
    between: list[tuple[float, str]],
) -> None:
    """It comes 35 s after the instruction, later than a readback by itself."""
    again = (55.0, WRONG[1])
    airfield = field(CLEARED, UNSURE_WRONG, SAY_AGAIN, *between, again).run(60)
    (told, *_) = mismatches(airfield)
    assert told.t_ready_ns == 55 * 10**9
    assert "01" in told.message


def test_after_a_new_instruction_a_readback_belongs_to_that() -> None:
    changed = (34.0, "American one two three, runway one niner, cleared to land.")
    airfield = field(CLEARED, UNSURE_WRONG, SAY_AGAIN, changed, (40.0, WRONG[1])).run(60)
    assert mismatches(airfield) == []


def test_with_nobody_else_at_the_runway_it_does_not_matter() -> None:
    assert field(CLEARED, UNSURE_WRONG, is_busy=False).run(40).told == []


@pytest.mark.parametrize("asking", ["Say again", "Confirm runway"])
def test_a_crew_that_asks_for_it_again_is_not_overtaken_by_the_question(asking: str) -> None:
    asked = (26.0, f"{asking}, American one two three.")
    assert questions(field(UNSURE_CLEARED, asked).run(45)) == []


def test_a_level_that_is_wrong_where_it_is_unsure_is_asked_for_and_not_told() -> None:
    flights = [
        Flight("AAL123", "a1b2c3", 90.0, 30.7, 31_000),
        Flight("DAL456", "a4d5e6", 270.0, 30.7, 34_000),
    ]
    calls = [
        (20.0, 25.0, "American one two three, climb and maintain flight level three three zero."),
        (26.0, 31.0, "Climb and maintain flight level three four? zero, American one two three."),
    ]
    encounter = Encounter(flights, 60.0, calls=calls).fly()
    assert questions(encounter) == [(31.0, "AAL123", "altitude")]
    assert mismatches(encounter) == []


def test_without_words_the_confidence_in_the_whole_stands_for_each() -> None:
    heard = Transcript(
        id="1", frequency_khz=119100, t_tx_ns=0, t_end_ns=1, confidence=0.3, engine="mine",
        text="American one two three, runway zero one, cleared to land.",
    )  # fmt: skip
    call = call_of(heard, ["AAL123"])
    assert call.match.score == call.instructions[0].confidence == 0.3
