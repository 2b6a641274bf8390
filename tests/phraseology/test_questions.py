"""Questions are read as such: what they are about is no order."""

from __future__ import annotations

import pytest

from airhilt.phraseology import parse_call

KNOWN = ("AAL123", "N172SP")


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("say heading and altitude", ("heading", "altitude")),
        ("say altitude, heading, airspeed", ("altitude", "heading", "airspeed")),
        ("say fuel remaining and number of souls on board", ("fuel remaining", "souls on board")),
        ("say type aircraft and intentions", ("type", "intentions")),
        ("what is your heading", ("heading",)),
        ("confirm altitude", ("altitude",)),
        ("say flap setting", ("flap setting",)),
    ],
)
def test_each_thing_to_be_said_is_an_instruction(words: str, told: tuple[str, ...]) -> None:
    call = parse_call(f"American 123, {words}", KNOWN)
    assert [each.action for each in call.instructions] == ["say"] * len(told)
    assert tuple(each.position for each in call.instructions) == told


@pytest.mark.parametrize(
    ("words", "about"),
    [
        ("can you accept runway three three", ("cleared_to_land", "33")),
        ("are you able to maintain one six zero knots", ("speed", 160.0)),
        ("advise if able to climb to flight level two five zero", ("altitude", 25_000.0)),
        ("say able to turn left heading two seven zero", ("heading", 270.0)),
        ("turn left heading two seven zero, are you able", ("heading", 270.0)),
        ("could you hold short of runway four", ("hold_short", "04")),
        ("would you take the visual approach to runway one", ("cleared_approach", "01")),
        ("will you be able to make golf", ("vacate", "G")),
    ],
)
def test_what_somebody_is_asked_to_be_able_to_do_is_no_order(
    words: str, about: tuple[str, object]
) -> None:
    call = parse_call(f"American 123, {words}?", KNOWN)
    (question,) = call.asked
    action, value = about
    assert call.instructions == ()
    assert (call.kind, question.asks, question.about.action) == ("question", "able", action)
    told = question.about
    assert value in (
        told.runway, told.position, told.speed_kt, told.altitude_ft, told.heading_deg
    )  # fmt: skip


@pytest.mark.parametrize(
    "words",
    [
        "can you climb to flight level two five zero, turn left heading two seven zero",
        "are you able to turn left heading two seven zero and descend to four thousand",
        "can you make a right three sixty or cross runway one",
    ],
)
def test_a_question_goes_on_with_the_next_action(words: str) -> None:
    call = parse_call(f"American 123, {words}", KNOWN)
    assert call.instructions == ()
    assert len(call.asked) == 2


def test_an_order_before_a_question_is_an_order() -> None:
    call = parse_call(
        "American 123, maintain eight thousand, can you turn left heading two seven zero", KNOWN
    )
    assert [each.action for each in call.instructions] == ["altitude"]
    assert [each.about.action for each in call.asked] == ["heading"]


def test_going_around_is_an_order_behind_a_question_too() -> None:
    call = parse_call("American 123, can you accept runway three three, go around", KNOWN)
    assert [each.action for each in call.instructions] == ["go_around"]


def test_if_able_gives_an_order_a_condition() -> None:
    call = parse_call("American 123, if able turn left heading two seven zero", KNOWN)
    assert [each.condition for each in call.instructions] == ["if able"]
    assert call.asked == ()


@pytest.mark.parametrize(
    "words", ["radio check", "Washington Tower, radio check, how do you read", "how do you hear"]
)
def test_a_radio_check_is_a_kind_of_call(words: str) -> None:
    assert parse_call(f"American 123, {words}?", KNOWN).kind == "radio_check"
