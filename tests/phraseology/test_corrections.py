"""Corrections within a call: which value of which instruction they replace, and how sure that is.

"Correction" replaces what was said (ICAO Annex 10 volume II, 5.2.1.5.8); people say it in other
words, too.
"""

from __future__ import annotations

import pytest

from airhilt.phraseology import Instruction, parse_call
from listed_forms import KNOWN

MENDED = 0.9
"""Confidence of a value that replaces another one."""


def told(text: str) -> list[Instruction]:
    return list(parse_call(f"American 123, {text}", KNOWN).instructions)


def only(text: str) -> Instruction:
    (instruction,) = told(text)
    return instruction


def test_a_level_takes_the_place_of_a_level(subtests: pytest.Subtests) -> None:
    for text, altitude_ft in [
        ("climb flight level 350 correction 360", 36_000.0),
        ("climb flight level 350 correction flight level 360", 36_000.0),
        ("climb flight level 350 correction level 360", 36_000.0),
        ("climb flight level 90 correction one zero thousand", 10_000.0),
        ("climb one two thousand correction one three thousand", 13_000.0),
        ("climb one two thousand correction flight level 130", 13_000.0),
        ("descend three thousand five hundred correction three thousand", 3_000.0),
        ("climb flight level 350 make that 360", 36_000.0),
        ("climb flight level 350 no make that flight level 360", 36_000.0),
        ("climb flight level 350 sorry 360", 36_000.0),
        ("climb flight level 350 I mean 360", 36_000.0),
        ("climb flight level 350 no 360", 36_000.0),
        ("climb one two thousand no one three thousand", 13_000.0),
        ("climb flight level 350 correction 360 correction 370", 37_000.0),
    ]:
        with subtests.test(text):
            climb = only(text)
            assert (climb.action, climb.altitude_ft) == ("altitude", altitude_ft)
            assert climb.confidence == pytest.approx(MENDED)


def test_what_was_said_does_not_count_any_more_where_no_value_takes_its_place(
    subtests: pytest.Subtests,
) -> None:
    for text in [
        "climb flight level 350 correction 36",
        "climb flight level 350 correction 700",
        "climb flight level 350 correction",
        "turn left heading 210 correction 370",
        "turn left heading 210 correction 000",
        "turn left heading 210 correction heading",
        "contact tower 118.35 correction 250.0",
    ]:
        with subtests.test(text):
            for each in told(text):
                assert (each.altitude_ft, each.heading_deg, each.frequency_khz) == (
                    None,
                    None,
                    None,
                )
                assert each.confidence < 0.8


def test_a_value_takes_the_place_of_one_of_its_kind(subtests: pytest.Subtests) -> None:
    table = [
        ("turn left heading 210 correction 220",
         Instruction("heading", turn="left", heading_deg=220.0)),
        ("turn left heading 210 correction 360",
         Instruction("heading", turn="left", heading_deg=360.0)),
        ("turn left heading 210 no it's 220",
         Instruction("heading", turn="left", heading_deg=220.0)),
        ("reduce speed 210 knots correction 220 knots", Instruction("speed", speed_kt=220.0)),
        ("reduce speed 210 correction 220", Instruction("speed", speed_kt=220.0)),
        ("squawk 1234 correction 1235", Instruction("squawk", squawk="1235")),
        ("cleared to land runway 19 correction 01", Instruction("cleared_to_land", "01")),
        ("taxi via alpha bravo correction via alpha charlie",
         Instruction("taxi", via=("A", "C"))),
        ("taxi via alpha bravo correction via charlie", Instruction("taxi", via=("C",))),
        ("taxi to runway 01 via alpha bravo correction alpha charlie",
         Instruction("taxi", "01", via=("A", "C"))),
    ]  # fmt: skip
    for text, instruction in table:
        with subtests.test(text):
            assert only(text) == instruction
            assert only(text).confidence == pytest.approx(MENDED)


def test_an_instruction_that_is_said_anew_keeps_what_is_not_said_again(
    subtests: pytest.Subtests,
) -> None:
    table = [
        ("contact tower 118.35 correction 119.1",
         Instruction("contact", position="tower", frequency_khz=119_100)),
        ("contact tower 118.35 correction contact ground 121.9",
         Instruction("contact", position="ground", frequency_khz=121_900)),
        ("contact tower 118.35 correction ground 121.9",
         Instruction("contact", position="ground", frequency_khz=121_900)),
        ("turn left heading 210 correction heading 220",
         Instruction("heading", turn="left", heading_deg=220.0)),
        ("turn left heading 210 correction right 220",
         Instruction("heading", turn="right", heading_deg=220.0)),
        ("cleared to land runway 19 left correction runway 19 right",
         Instruction("cleared_to_land", "19R")),
        ("turn left on alpha correction right on bravo",
         Instruction("heading", turn="right", position="B")),
        ("turn left on alpha correction left on bravo",
         Instruction("heading", turn="left", position="B")),
        ("turn left actually make that turn right heading 090",
         Instruction("heading", turn="right", heading_deg=90.0)),
        ("cross runway 19 no sorry make that hold short of runway 19",
         Instruction("hold_short", "19")),
        ("line up and wait runway 19 negative scratch that hold position",
         Instruction("hold_position")),
        ("cleared to land runway 19, disregard the landing clearance, go around",
         Instruction("go_around")),
        ("cleared to land runway 19, disregard, go around", Instruction("go_around")),
    ]  # fmt: skip
    for text, instruction in table:
        with subtests.test(text):
            assert only(text) == instruction


def test_a_clearance_behind_a_bare_disregard_may_be_what_is_withdrawn() -> None:
    assert only("cleared to land runway 19, disregard, cleared to land runway 01").confidence < 0.8
    assert told("climb flight level 350, disregard, climb flight level 350") == []


def test_what_else_is_told_stays() -> None:
    taxi, hold = told("taxi via alpha bravo correction via alpha charlie hold short of runway 01")
    assert (taxi.via, taxi.confidence) == (("A", "C"), pytest.approx(MENDED))
    assert (hold.runway, hold.confidence) == ("01", 1.0)
    assert only("sorry, climb flight level 350").confidence == 1.0


def test_what_stands_behind_disregard_is_an_order() -> None:
    for words in ("disregard, hold position", "disregard my last, hold position"):
        call = parse_call(f"American 123, {words}", ("AAL123",))
        assert (call.kind, call.disregards) == ("disregard", True)
        assert call.instructions == (Instruction("hold_position"),)
    assert only("disregard, cross runway 01").confidence < 0.8


def test_only_what_calls_before_told_is_disregarded_by_a_call_that_has_nothing_before() -> None:
    for words, disregards in (
        ("disregard", True), ("disregard the go around", True),
        ("cross runway 15, disregard, hold short of runway 15", False), ("roger", False),
    ):  # fmt: skip
        assert parse_call(f"American 123, {words}", ("AAL123",)).disregards is disregards
