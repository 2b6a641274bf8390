"""The speaker is told by words and order, and a readback is compared detail by detail."""

from __future__ import annotations

import pytest

from airhilt.phraseology import agree, differences, parse_call

KNOWN = ("AAL123", "DAL456")


def test_who_speaks_is_told_by_words_and_order(subtests: pytest.Subtests) -> None:
    for text, speaker in [
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
    ]:
        with subtests.test(text):
            said = parse_call(text, KNOWN).spoken
            assert said.speaker == speaker
            assert 0.5 < said.confidence <= 1.0


def test_what_either_could_say_tells_little() -> None:
    assert parse_call("Delta 456", KNOWN).spoken.confidence < 0.8


def differing(given: str, read: str) -> tuple[str, ...]:
    (told,) = parse_call(f"Delta 456, {given}", KNOWN).instructions
    (answer,) = parse_call(f"{read}, Delta 456", KNOWN).instructions
    return differences(told, answer)


def test_a_readback_differs_in_what_it_changes_and_not_in_what_it_leaves_out(
    subtests: pytest.Subtests,
) -> None:
    for given, read, differs in [
        ("turn left heading 270", "left heading 280", ("heading_deg",)),
        ("turn left heading 270", "right heading 280", ("turn", "heading_deg")),
        ("turn left heading 270", "heading 270", ()),
        ("climb and maintain flight level 330", "climb flight level 310", ("altitude_ft",)),
        ("runway 27 left, line up and wait", "runway 27 right, line up and wait", ("runway",)),
        ("runway 27 left, line up and wait", "line up and wait", ()),
        ("squawk 4621", "squawk 4612", ("squawk",)),
    ]:
        with subtests.test(str((given, read, differs))):
            assert differing(given, read) == differs


def test_instructions_agree_if_both_or_neither_wait_for_something() -> None:
    now, later = (
        parse_call(f"Delta 456, {text}", KNOWN).instructions[0]
        for text in ("line up and wait runway 27", "behind the landing Airbus line up runway 27")
    )
    assert agree(now, now)
    assert not agree(now, later)
