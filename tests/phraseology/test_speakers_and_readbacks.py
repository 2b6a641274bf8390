"""The speaker is told by words and order, and a readback is compared item by item."""

from __future__ import annotations

import pytest

from airhilt.phraseology import Speaker, compare_readback, parse_call

KNOWN = ("AAL123", "DAL456")


@pytest.mark.parametrize(
    ("text", "speaker"),
    [
        ("Delta 456, turn left heading 270", "controller"),
        ("Delta 456, Potomac approach, radar contact", "controller"),
        ("Delta 456, traffic two o'clock five miles, report in sight", "controller"),
        ("Delta 456, runway 27, wind 280 at 8, cleared to land", "controller"),
        ("Left heading 270, Delta 456", "pilot"),
        ("Potomac approach, Delta 456, request descent", "pilot"),
        ("Delta 456, we have the field in sight", "pilot"),
        ("Climbing to flight level 330", "pilot"),
        ("Wilco, Delta 456", "pilot"),
        ("Mayday mayday mayday, Delta 456, engine failure", "pilot"),
    ],
)
def test_who_speaks_is_told_by_words_and_order(text: str, speaker: Speaker) -> None:
    said = parse_call(text, KNOWN).spoken
    assert said.speaker == speaker
    assert 0.5 < said.confidence <= 1.0


def test_what_either_could_say_tells_little() -> None:
    assert parse_call("Delta 456", KNOWN).spoken.confidence < 0.8


def outcomes(given: str, read: str) -> dict[tuple[str, str], str]:
    items = compare_readback(
        parse_call(f"Delta 456, {given}", KNOWN), parse_call(f"{read}, Delta 456", KNOWN)
    )
    return {(each.action, each.item): each.outcome for each in items}


def test_each_item_of_a_readback_is_right_wrong_or_missing() -> None:
    given = "turn left heading 270, descend and maintain 5000, contact tower 118.3"
    read = "left heading 280, down to 5000"
    assert outcomes(given, f"{read}, descend and maintain 5000") == {
        ("heading", "action"): "right",
        ("heading", "turn"): "right",
        ("heading", "heading_deg"): "wrong",
        ("altitude", "action"): "right",
        ("altitude", "sense"): "right",
        ("altitude", "altitude_ft"): "right",
        ("contact", "action"): "missing",
    }


def test_a_right_readback_has_no_wrong_and_no_missing_item() -> None:
    given = "runway 27 left, line up and wait"
    assert set(outcomes(given, given).values()) == {"right"}
    assert outcomes(given, "line up and wait")["line_up", "runway"] == "missing"
    assert outcomes(given, "runway 27 right, line up and wait")["line_up", "runway"] == "wrong"


def test_of_an_instruction_read_back_twice_the_right_one_counts() -> None:
    read = "climb and maintain flight level 310, climb and maintain flight level 330"
    items = outcomes("climb and maintain flight level 330", read)
    assert set(items.values()) == {"right"}
