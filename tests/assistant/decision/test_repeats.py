"""Two calls that were heard alike are surer than one."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.assistant.decision.guard import Doubt, Slot
from airhilt.assistant.decision.repeats import Repeats
from airhilt.phraseology import Action, Instruction
from airhilt.units import SECOND_NS
from decisions import transcript

TAU = 0.8


def doubt(
    confidence: float,
    name: str = "first",
    *,
    callsign: str = "AAL123",
    slot: Slot = "runway",
    action: Action = "cleared_to_land",
    runway: str = "19",
    end_s: float = 20.0,
    heard: float | None = None,
) -> Doubt:
    """Return a doubt; ``heard`` is the confidence in the words, None if that makes the doubt."""
    said = Instruction(action, runway, details_heard=confidence if heard is None else heard)
    call = transcript(name, 119_100, 0, int(end_s * SECOND_NS), "Cleared to land.")
    return Doubt(callsign, slot, confidence, said, call, is_answered=True)


@given(st.floats(0.0, 0.79), st.floats(0.0, 0.79))
def test_a_value_heard_twice_is_wrong_only_if_both_calls_were_heard_wrongly(
    one: float, other: float
) -> None:
    repeats = Repeats(TAU)
    first = repeats.joined(doubt(one))
    assert first is not None
    assert first.confidence == pytest.approx(one)
    second = repeats.joined(doubt(other, "second"))
    both = 1.0 - (1.0 - one) * (1.0 - other)
    assert (second is None) == (both >= TAU)
    assert second is None or second.confidence == pytest.approx(both)


def test_no_more_than_two_calls_are_joined() -> None:
    repeats = Repeats(TAU)
    for number, expected in enumerate((0.4, 0.64, 0.64, 0.64)):
        found = repeats.joined(doubt(0.4, str(number)))
        assert found is not None
        assert found.confidence == pytest.approx(expected)


def test_a_call_does_not_confirm_itself() -> None:
    repeats = Repeats(TAU)
    again = [repeats.joined(doubt(0.7)) for _ in range(3)]
    assert [each and each.confidence for each in again] == [pytest.approx(0.7)] * 3


@pytest.mark.parametrize(
    "other",
    [
        doubt(0.7, "second", runway="01"),
        doubt(0.7, "second", callsign="DAL456"),
        doubt(0.7, "second", action="line_up"),
        doubt(0.7, "second", slot="action"),
        doubt(0.7, "second", end_s=20.0 + 121.0),
    ],
    ids=["runway", "callsign", "action", "slot", "two minutes later"],
)
def test_what_differs_from_it_does_not_confirm_a_call(other: Doubt) -> None:
    repeats = Repeats(TAU)
    repeats.joined(doubt(0.7))
    assert repeats.joined(other) == other


def test_two_minutes_later_it_still_counts() -> None:
    repeats = Repeats(TAU)
    repeats.joined(doubt(0.7))
    assert repeats.joined(doubt(0.7, "second", end_s=20.0 + 120.0)) is None


def test_another_value_in_between_begins_anew() -> None:
    repeats = Repeats(TAU)
    repeats.joined(doubt(0.7))
    repeats.joined(doubt(0.7, "second", runway="01"))
    assert repeats.joined(doubt(0.7, "third")) is not None


def test_what_makes_no_sense_makes_none_twice() -> None:
    repeats = Repeats(TAU)
    repeats.joined(doubt(0.6, heard=0.95))
    assert repeats.joined(doubt(0.6, "second", heard=0.95)) is not None


def test_what_made_no_sense_in_one_call_is_confirmed_by_one_that_was_only_heard_badly() -> None:
    repeats = Repeats(TAU)
    repeats.joined(doubt(0.6, heard=0.95))
    assert repeats.joined(doubt(0.6, "second")) is None


def test_callsigns_are_not_joined() -> None:
    repeats = Repeats(TAU)
    repeats.joined(doubt(0.7, slot="callsign"))
    assert repeats.joined(doubt(0.7, "second", slot="callsign")) is not None


def test_where_there_is_no_doubt_there_is_none_afterwards() -> None:
    assert Repeats(TAU).joined(None) is None
