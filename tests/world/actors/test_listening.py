"""A listener understands a call: whether it is addressed, and what it commands."""

from __future__ import annotations

import dataclasses
from typing import Any

import pytest

from airhilt.phraseology import TAU_ASR, parse_call
from airhilt.world.actors import listening
from airhilt.world.actors.listening import Listener, Understanding

ON_FREQUENCY = ("AAL123", "DAL456")
SAID = "American one two three, climb and maintain flight level three three zero."
LISTENER = Listener(ON_FREQUENCY)


def sense(
    heard: str, said: str = SAID, known_by: tuple[str] = ("AAL123",), **more: Any
) -> Understanding:
    return LISTENER.understand(heard, said, known_by, **more)


def test_the_same_words_mean_the_same_however_they_are_written() -> None:
    heard = "american ONE two three climb and maintain flight level three three zero"
    assert sense(heard).kind == "as_said"


@pytest.mark.parametrize(
    "heard",
    [
        "american 123 climb and maintain flight level 330",
        "American one two three climb maintain flight level tree tree zero",
    ],
)
def test_other_words_that_mean_the_same_do_too(heard: str) -> None:
    assert sense(heard).kind == "as_said"


def test_another_level_is_flown_as_it_was_heard() -> None:
    taken = sense("american one two three climb and maintain flight level three five zero")
    assert taken.kind == "otherwise"
    assert taken.call is not None
    assert taken.call.altitude_ft == 35_000


def test_a_call_with_another_callsign_is_for_another() -> None:
    heard = "delta four five six climb and maintain flight level three three zero"
    assert sense(heard).kind == "not_for_me"


def test_unintelligible_words_are_for_nobody() -> None:
    assert sense("mumble mumble").kind == "not_for_me"


def test_a_call_that_could_be_for_two_is_asked_for_again(monkeypatch: pytest.MonkeyPatch) -> None:
    match = dataclasses.replace(parse_call(SAID, ("AAL123",)).match, ambiguous=True)
    ambiguous = dataclasses.replace(parse_call(SAID, ("AAL123",)), match=match)
    monkeypatch.setattr(listening, "parse_call", lambda *_: ambiguous)
    listener = Listener(("AAL123", "AAL132"))
    assert listener.understand("something like it", SAID, ("AAL123",)).kind == "unclear"


@pytest.mark.parametrize(("confidence", "kind"), [(TAU_ASR - 0.01, "unclear"), (1.0, "as_said")])
def test_a_listener_asks_again_for_what_is_uncertain(
    confidence: float, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    call = dataclasses.replace(parse_call(SAID, ON_FREQUENCY), confidence=confidence)
    monkeypatch.setattr(listening, "parse_call", lambda *_: call)
    assert Listener(ON_FREQUENCY).understand("nearly that", SAID, ("AAL123",)).kind == kind


def read(text: str, confidence: float, said: str | None = None) -> str:
    return sense(text, said or text, word_confidences=[confidence] * len(text.split())).kind


def test_who_reads_the_right_words_and_cannot_be_sure_of_them_asks_again() -> None:
    assert read(SAID, 0.7) == "unclear"
    assert read(SAID, 0.9) == "as_said"


def test_who_reads_a_runway_that_may_be_the_rest_of_another_asks_and_who_hears_it_does_not() -> (
    None
):
    said = "American one two three, cleared to land runway one."
    assert read(said, 1.0) == "unclear"
    assert sense(said, said).kind == "as_said"


def test_who_reads_a_callsign_that_may_be_two_asks_again_though_the_words_are_right(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    call = parse_call(SAID, ("AAL123",))
    match = dataclasses.replace(call.match, ambiguous=True)
    ambiguous = dataclasses.replace(call, match=match)
    monkeypatch.setattr(listening, "parse_call", lambda *_: ambiguous)
    listener = Listener(ON_FREQUENCY)
    sure = [1.0] * len(SAID.split())
    assert listener.understand(SAID, SAID, ("AAL123",), sure).kind == "unclear"


def test_nobody_asks_for_a_call_again_that_orders_and_asks_nothing() -> None:
    roger = "American one two three, roger."
    assert read(roger, 0.3) == "as_said"
    assert read("american one two three good day", 0.3, roger) == "as_said"
    assert read(roger, 0.3, SAID) == "unclear"
    assert read(SAID, 0.3, roger) == "unclear"
    question = "American one two three, say again."
    assert read(question, 0.3) == "unclear"
    assert read("american one two three again", 0.3, question) == "unclear"


def test_the_right_words_are_for_their_addressee_even_without_a_callsign() -> None:
    assert read("Roger, thank you.", 1.0) == "as_said"


BEHIND = "American one two three, behind the landing Delta line up runway one niner behind."
AT_ONCE = "American one two three, line up runway one niner."


def orders_in(taken: Understanding) -> list[str]:
    assert taken.call is not None
    orders = LISTENER.orders_of(taken.call.instructions, None, "AAL123")
    return [order.command.action for order in orders if order.command is not None]


def test_a_condition_that_is_lost_is_not_waited_for() -> None:
    taken = sense(AT_ONCE, BEHIND)
    assert taken.kind == "otherwise"
    assert orders_in(taken) == ["line_up"]


def test_a_condition_that_was_not_said_is() -> None:
    taken = sense(BEHIND, AT_ONCE)
    assert taken.kind == "otherwise"
    assert orders_in(taken) == ["behind"]


def test_a_condition_in_other_words_is_the_same() -> None:
    other = "American one two three, behind landing Delta traffic line up runway one niner behind."
    assert sense(other, BEHIND).kind == "as_said"


@pytest.mark.parametrize(("read_back", "said"), [(AT_ONCE, BEHIND), (BEHIND, AT_ONCE)])
def test_a_readback_with_a_condition_lost_or_invented_differs(read_back: str, said: str) -> None:
    assert LISTENER.differs(read_back, said)
    assert not LISTENER.differs(said, said)


def test_a_callsign_without_an_instruction_is_asked_for_again() -> None:
    assert sense("american one two three climb and").kind == "unclear"


def test_a_crew_takes_an_overheard_call_with_its_own_callsign() -> None:
    heard = "delta four five six climb and maintain flight level three three zero"
    taken = LISTENER.overhear(heard, SAID, "DAL456")
    assert taken.call is not None
    assert taken.call.altitude_ft == 33_000
    assert LISTENER.overhear(SAID, SAID, "DAL456").kind == "not_for_me"


def test_a_readback_that_says_less_is_no_mistake_and_one_that_says_otherwise_is() -> None:
    right = "Climb and maintain flight level three three zero, American one two three."
    wrong = "Climb and maintain flight level three five zero, American one two three."
    assert not LISTENER.differs(right, SAID)
    assert not LISTENER.differs("Roger, American one two three.", SAID)
    assert LISTENER.differs(wrong, SAID)


def test_a_readback_of_another_clearance_differs() -> None:
    said = "Delta four five six, runway three three, continue holding, traffic landing."
    read = "Runway three three, cleared for takeoff, Delta four five six."
    assert LISTENER.differs(read, said)


@pytest.mark.parametrize(
    ("said", "kind"),
    [
        ("make s-turns for spacing", "unclear"),
        ("taxi back for another departure", "unclear"),
        ("go around, make left traffic", "as_said"),
        ("have a nice day", "as_said"),
        ("runway one, cleared to land", "as_said"),
    ],
)
def test_an_order_that_nobody_can_make_out_is_asked_about(said: str, kind: str) -> None:
    call = f"American one two three, {said}"
    assert LISTENER.as_said(call).kind == sense(call, call).kind == kind
