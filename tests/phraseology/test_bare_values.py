"""Values that are read back alone mean what they can only be, and nothing if that is not known."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import pytest

from airhilt.phraseology.bare_values import bare_values, without_courtesies

FULL = 0.75
"""Confidence of a value whose kind is clear though its word is left out."""
DOUBT = 0.6
"""Confidence of a value whose kind the rest of the call suggests."""


def read(text: str, *beside: Any, last: Any = None) -> list[dict[str, Any]]:
    """Return what is said of each instruction in words as they are read."""
    bare = bare_values(text.split(), set(beside), last)
    return [
        {
            name: value
            for name, value in asdict(each).items()
            if value not in (None, (), False) and not name.endswith("_heard")
        }
        for each in bare.instructions
    ]


def heading(degrees: float, sure: float, **more: Any) -> dict[str, Any]:
    return {"action": "heading", "heading_deg": degrees, "confidence": sure, **more}


def speed(knots: float, sure: float) -> dict[str, Any]:
    return {"action": "speed", "speed_kt": knots, "confidence": sure}


def level(feet: float, sure: float = FULL, **more: Any) -> dict[str, Any]:
    return {"action": "altitude", "altitude_ft": feet, "confidence": sure, **more}


def contact(khz: int, sure: float = FULL) -> dict[str, Any]:
    return {"action": "contact", "frequency_khz": khz, "confidence": sure}


def test_a_value_alone_is_what_its_digits_or_its_one_word_show(subtests: pytest.Subtests) -> None:
    """A heading with its side, a channel of the band from 118 to 137 MHz (ground has 121 MHz), a
    code of four digits up to 7, a level above the 360 degrees that a heading can be."""
    for text, meant in [
        ("left 270", heading(270.0, FULL, turn="left")),
        ("right 090", heading(90.0, FULL, turn="right")),
        ("left 360", heading(360.0, FULL, turn="left")),
        ("20 right", {"action": "turn_by", "turn": "right", "turn_deg": 20.0, "confidence": DOUBT}),
        ("45 left", {"action": "turn_by", "turn": "left", "turn_deg": 45.0, "confidence": DOUBT}),
        ("flight level 100", level(10_000.0)),
        ("121900", contact(121_900)),
        ("118300 for tower", contact(118_300)),
        ("18 decimal 7", contact(118_700)),
        ("32 decimal 475", contact(132_475)),
        ("decimal 9", contact(121_900)),
        ("2170", contact(121_700, DOUBT)),
        ("1187", contact(118_700)),
        ("4512", {"action": "squawk", "squawk": "4512", "confidence": FULL}),
        ("0412", {"action": "squawk", "squawk": "0412", "confidence": FULL}),
        ("365", level(36_500.0, DOUBT)),
    ]:
        with subtests.test(text):
            assert read(text) == [meant]


@pytest.mark.parametrize(("text", "khz"), [("1234", 123_400), ("1200", 120_000), ("2330", 123_300)])
def test_four_digits_up_to_7_that_a_channel_has_too_are_in_doubt(text: str, khz: int) -> None:
    assert read(text) == [contact(khz, DOUBT)]


def test_what_can_be_several_things_or_none_is_not_read(subtests: pytest.Subtests) -> None:
    for text in ["left 000", "left 361", "360", "270", "137000", "139900", "8123", "7788", "20 up"]:
        with subtests.test(text):
            assert read(text) == []


def test_three_digits_are_a_speed_beside_a_heading_and_a_heading_beside_a_level(
    subtests: pytest.Subtests,
) -> None:
    """Speeds are assigned in tens (FAA Order JO 7110.65, 5-7-2), headings in fives."""
    for number, beside, meant in [
        ("270", "altitude", heading(270.0, DOUBT)),
        ("275", "altitude", heading(275.0, DOUBT)),
        ("360", "altitude", heading(360.0, DOUBT)),
        ("270", "heading", speed(270.0, DOUBT)),
        ("120", "heading", speed(120.0, DOUBT)),
        ("350", "heading", speed(350.0, DOUBT)),
        ("275", "heading", None),
        ("110", "heading", None),
        ("360", "heading", None),
        ("000", "altitude", None),
        ("151", "altitude", None),
    ]:
        with subtests.test(str((number, beside, meant))):
            assert read(number, beside) == ([] if meant is None else [meant])


def test_before_then_and_a_level_three_digits_are_the_speed_that_comes_first() -> None:
    """FAA Order JO 7110.65, 5-7-2: "reduce speed to two five zero, then descend"."""
    descent = level(10_000.0, condition="then")
    for joint in ("then", "and then", "then and"):
        assert read(f"250 {joint} flight level 100") == [speed(250.0, DOUBT), descent]
    assert read("255 then flight level 100") == [heading(255.0, DOUBT), descent]
    assert read("250 and flight level 100") == [heading(250.0, DOUBT), level(10_000.0)]
    turn = heading(270.0, FULL, turn="left", condition="then")
    assert read("250 flight level 100 then left 270") == [
        heading(250.0, DOUBT), level(10_000.0), turn,
    ]  # fmt: skip


def test_values_follow_one_another_and_all_must_be_read() -> None:
    both = [heading(270.0, FULL, turn="left"), level(10_000.0)]
    assert read("left 270 flight level 100") == both
    assert read("left 270 and flight level 100") == both
    assert read("left 270 perhaps flight level 100") == []
    assert read("and left 270") == []
    assert read("left 270 and") == []


def test_a_setting_stands_behind_a_level_or_shows_by_its_digits(subtests: pytest.Subtests) -> None:
    """No code has an 8 or a 9, and no heading 995."""
    rows: list[Any] = [
        ("2992", None, 1013.2),
        ("flight level 100 1013", None, 1013.0),
        ("flight level 100 995", None, 995.0),
        ("1013", "cross_fix", 1013.0),
        ("1013", None, None),
        ("3012", None, None),
        ("flight level 100 3012", None, 1020.0),
        ("995 flight level 100", None, None),
    ]
    for text, last, hpa in rows:
        with subtests.test(str((text, last, hpa))):
            found = bare_values(text.split(), set(), last).pressure_hpa
            assert found == (None if hpa is None else pytest.approx(hpa, abs=0.05))


def test_a_fix_is_crossed_at_thousands_of_feet_or_at_a_level(subtests: pytest.Subtests) -> None:
    for text, feet, knots in [
        ("orbex at 9 250", 9_000.0, 250.0),
        ("orbex at 9 and 250", 9_000.0, 250.0),
        ("orbex at 12 and 210", 12_000.0, 210.0),
        ("orbex at flight level 100", 10_000.0, None),
        ("orbex at flight level 100 and 250", 10_000.0, 250.0),
    ]:
        with subtests.test(text):
            (crossing,) = read(text)
            assert (crossing["action"], crossing["position"]) == ("cross_fix", "orbex")
            assert (crossing["altitude_ft"], crossing.get("speed_kt")) == (feet, knots)


def test_a_word_of_the_grammar_is_no_fix() -> None:
    assert read("heading at 9 250") == []


@pytest.mark.parametrize(
    "text",
    [
        "left 270 expect further clearance at 1630", "left 270 expect further 30",
        "left 270 expect further clearance time 45",
    ],
)  # fmt: skip
def test_the_end_of_a_hold_is_no_value(text: str) -> None:
    assert read(text) == [heading(270.0, FULL, turn="left")]


def test_words_of_courtesy_are_left_out_at_both_ends(subtests: pytest.Subtests) -> None:
    """But "right" may be the side of a heading or of a runway, and "one" one of its digits."""
    for text, kept in [
        ("270 thank you good day", "270"),
        ("so copy 270 bye", "270"),
        ("right 270 bye", "right 270"),
        ("250 right", "250 right"),
        ("flight 250 to", "250"),
        ("250 one", "250 one"),
        ("have a good 1", ""),
        ("270 have a nice 1", "270"),
        ("right", "right"),
        ("", ""),
    ]:
        with subtests.test(text):
            assert " ".join(without_courtesies(text.split())) == kept
