"""Two calls that were heard alike are surer than one."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.assistant.decision.guard import Doubt, RememberingGuard, call_of
from airhilt.messages import Transcript
from airhilt.units import SECOND_NS
from decisions import transcript

TAU = 0.8
ROSTER = ["AAL123", "DAL456"]
LANDING = "Cleared to land runway one? niner, American one two three."
CROSSING = "American one two three, cross? runway zero? one?."


def heard(text: str, confidence: float, name: str = "first", end_s: float = 20.0) -> Transcript:
    """Return a call in which the words before a question mark have a confidence."""
    return transcript(name, 119_100, 0, round(end_s * SECOND_NS), text, confidence)


def doubt(guard: RememberingGuard, transcript: Transcript) -> Doubt | None:
    call = call_of(transcript, ROSTER)
    (said,) = call.instructions
    return guard.doubt(call, said, transcript)


@pytest.fixture
def guard() -> RememberingGuard:
    return RememberingGuard(TAU)


@given(st.floats(0.0, 0.79), st.floats(0.0, 0.79))
def test_a_value_heard_twice_is_wrong_only_if_both_calls_were_heard_wrongly(
    one: float, other: float
) -> None:
    guard = RememberingGuard(TAU)
    first = doubt(guard, heard(LANDING, one))
    assert first is not None
    assert (first.slot, first.confidence) == ("runway", pytest.approx(one))
    second = doubt(guard, heard(LANDING, other, "second"))
    both = 1.0 - (1.0 - one) * (1.0 - other)
    assert (second is None) == (both >= TAU)
    assert second is None or second.confidence == pytest.approx(both)


def test_no_more_than_two_calls_are_joined(guard: RememberingGuard) -> None:
    for number, expected in enumerate((0.4, 0.64, 0.64, 0.64)):
        found = doubt(guard, heard(LANDING, 0.4, str(number)))
        assert found is not None
        assert found.confidence == pytest.approx(expected)


def test_a_call_does_not_confirm_itself(guard: RememberingGuard) -> None:
    again = [doubt(guard, heard(LANDING, 0.7)) for _ in range(3)]
    assert [each and each.confidence for each in again] == [pytest.approx(0.7)] * 3


def test_a_call_that_was_heard_well_confirms_one_that_was_not(guard: RememberingGuard) -> None:
    assert doubt(guard, heard(LANDING, 0.95)) is None
    assert doubt(guard, heard(LANDING, 0.3, "second")) is None


@pytest.mark.parametrize(
    "other",
    [
        "Cleared to land runway zero? one?, American one two three.",
        "Cleared to land runway one? niner, Delta four five six.",
        "Lining up runway one? niner, American one two three.",
        "American one two three, runway one? niner, cleared to land.",
    ],
    ids=["runway", "callsign", "action", "controller"],
)
def test_what_differs_from_it_does_not_confirm_a_call(guard: RememberingGuard, other: str) -> None:
    doubt(guard, heard(LANDING, 0.7))
    found = doubt(guard, heard(other, 0.7, "second"))
    assert found is not None
    assert found.confidence == pytest.approx(0.7)


@pytest.mark.parametrize(("end_s", "is_joined"), [(140.0, True), (140.1, False), (-100.1, False)])
def test_two_minutes_before_or_after_it_still_counts(
    guard: RememberingGuard, end_s: float, is_joined: bool
) -> None:
    doubt(guard, heard(LANDING, 0.7, end_s=20.0 + 200.0))
    found = doubt(guard, heard(LANDING, 0.7, "second", end_s=end_s + 200.0))
    assert (found is None) is is_joined


def test_another_value_in_between_begins_anew(guard: RememberingGuard) -> None:
    doubt(guard, heard(LANDING, 0.7))
    doubt(guard, heard("Cleared to land runway zero? one?, American one two three.", 0.7, "second"))
    assert doubt(guard, heard(LANDING, 0.7, "third")) is not None


def test_what_the_other_side_says_in_between_changes_nothing(guard: RememberingGuard) -> None:
    given = "American one two three, runway zero? one?, cleared to land."
    doubt(guard, heard(given, 0.7))
    doubt(guard, heard(LANDING, 0.7, "second"))
    assert doubt(guard, heard(given, 0.7, "third")) is None
    assert doubt(guard, heard(LANDING, 0.7, "fourth")) is None


def test_each_slot_is_joined_by_itself(guard: RememberingGuard) -> None:
    """The verb has 0.84 of both calls; the runway was heard with 0.3, and has 0.51."""
    words = heard(CROSSING, 0.6).words
    worse = tuple(
        each.model_copy(update={"confidence": 0.3}) if each.text in ("zero", "one.") else each
        for each in words
    )
    first, second = (
        heard(CROSSING, 0.6, name).model_copy(update={"words": worse}) for name in ("1", "2")
    )
    asked = doubt(guard, first)
    assert asked is not None
    assert (asked.slot, asked.confidence) == ("action", pytest.approx(0.6))
    asked = doubt(guard, second)
    assert asked is not None
    assert (asked.slot, asked.confidence) == ("runway", pytest.approx(0.51))


SENSELESS = "Climb? and maintain three four thousand, American one two three."


def test_what_makes_no_sense_makes_none_twice(guard: RememberingGuard) -> None:
    """Not if its verb is believed by then, either."""
    asked = [doubt(guard, heard(SENSELESS, 0.6, name)) for name in ("first", "second")]
    assert [each and each.slot for each in asked] == ["action", "altitude"]


def test_callsigns_are_not_joined(guard: RememberingGuard) -> None:
    text = "Cleared to land runway one? niner, American? one? two? three?."
    for name in ("first", "second"):
        found = doubt(guard, heard(text, 0.7, name))
        assert found is not None
        assert (found.slot, found.confidence) == ("callsign", pytest.approx(0.7))


def test_what_was_said_under_a_doubtful_callsign_confirms_nothing(guard: RememberingGuard) -> None:
    text = "Cleared to land runway one? niner, American? one? two? three?."
    doubt(guard, heard(text, 0.7))
    assert doubt(guard, heard(LANDING, 0.7, "second")) is not None
