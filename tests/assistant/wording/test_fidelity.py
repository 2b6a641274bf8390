"""A reworded message says what the rule's message says, or it is refused."""

from __future__ import annotations

import pytest

from airhilt.assistant.wording.fidelity import change
from airhilt.messages import CONTROLLER, Severity

GO_AROUND = "AAL123 go around, UAL7 is on runway 19L, 12 s to go"
CLIMB = "AAL123 traffic UAL7, loss of separation in 31 s, climb to 5000 ft at 1500 ft/min"
CONTROLLER_S = "UAL7, AAL123 is on runway 19, 12 s to go; UAL7 go around; AAL123 hold position"
READBACK = "cleared to land runway 01 for UAL7 was read back by AAL123, traffic DAL9"
SILENCE = "AAL123 has not read back hold short runway 19, traffic UAL7"


def changed(rule: str, reworded: str, recipient: str = "AAL123") -> str:
    return change(rule, reworded, recipient, Severity.WARNING)


@pytest.mark.parametrize("rule", [GO_AROUND, CLIMB, READBACK, SILENCE])
def test_the_rule_s_own_message_changes_nothing(rule: str) -> None:
    assert not changed(rule, rule)
    assert not changed(CONTROLLER_S, CONTROLLER_S, CONTROLLER)


@pytest.mark.parametrize(
    ("rule", "reworded"),
    [
        (GO_AROUND, "AAL123, go around immediately, traffic UAL7 on runway 19L, 12 seconds"),
        (GO_AROUND, "AAL123, warning, go around now, UAL7 is on runway 19L in 12 s"),
        (GO_AROUND, "American one two three, go around, United seven is on runway one niner left, "
                    "twelve seconds to go"),
        (CLIMB, "AAL123, traffic UAL7, climb immediately to 5000 feet at 1500 feet per minute, "
                "you will lose separation in 31 seconds"),
    ],
)  # fmt: skip
def test_the_same_in_other_words_is_spoken(rule: str, reworded: str) -> None:
    assert not changed(rule, reworded)


@pytest.mark.parametrize(
    ("rule", "reworded", "why"),
    [
        (GO_AROUND, "AAL321 go around, UAL7 is on runway 19L, 12 s to go", "begins with"),
        (GO_AROUND, "UAL7 go around, AAL123 is on runway 19L, 12 s to go", "begins with"),
        (GO_AROUND, "AAL123 cleared to land, UAL7 is on runway 19L, 12 s to go", "actions"),
        (GO_AROUND, "AAL123 do not go around, UAL7 is on runway 19L, 12 s to go", "actions"),
        (GO_AROUND, "AAL123 when able go around, UAL7 is on runway 19L, 12 s to go", "actions"),
        (GO_AROUND, "AAL123 go around if you like, UAL7 is on runway 19L, 12 s to go", "actions"),
        (GO_AROUND, "AAL123 go around, UAL7 is on runway 19L, 12 s to go, disregard", "words"),
        (GO_AROUND, "AAL123 UAL7 is on runway 19L, 12 s to go, go around", "expected it with"),
        (GO_AROUND, "AAL123 go around {UAL7}", "characters"),
        (GO_AROUND, "", "characters"),
        (CLIMB, CLIMB.replace("5000", "4000"), "actions"),
        (CLIMB, CLIMB.replace("1500", "1200"), "actions"),
        (CLIMB, CLIMB.replace(", climb", ", UAL7 climb"), "callsigns"),
        (CLIMB, "AAL123 traffic UAL7 will climb to 5000 ft at 1500 ft/min, loss of separation in "
                "31 s", "actions: AAL123 UAL7"),
        (CLIMB, "AAL123 traffic UAL7, in 31 s climb to 5000 ft at 1500 ft/min", "31 second"),
        (GO_AROUND, "AAL123 go around in 12 s, UAL7 is on runway 19L", "actions"),
        (GO_AROUND, "AAL123 in 12 s go around, UAL7 is on runway 19L", "actions"),
        (READBACK, READBACK.replace("for", "x").replace("by", "for").replace("x", "by"),
         "callsigns"),
    ],
)  # fmt: skip
def test_a_message_that_says_something_else_is_refused(rule: str, reworded: str, why: str) -> None:
    assert why in changed(rule, reworded)


def test_an_address_stands_for_a_callsign_that_is_not_known() -> None:
    rule = "a1b2c3 traffic DAL456, loss of separation in 84 s, descend to 4000 ft at 1500 ft/min"
    assert not changed(rule, rule.replace("descend", "descend immediately"), "a1b2c3")
    other = rule.replace("a1b2c3", "a1b2c4")
    assert "begins with no callsign; expected ICAO1" in changed(rule, other, "a1b2c3")
    told = rule.replace(", descend", ", DAL456 descend")
    assert "callsigns" in changed(rule, told, "a1b2c3")


def test_who_is_told_what_is_not_swapped_for_the_controller() -> None:
    swapped = CONTROLLER_S.replace("go around", "x").replace("hold position", "go around")
    assert "actions" in changed(CONTROLLER_S, swapped.replace("x", "hold position"), CONTROLLER)


@pytest.mark.parametrize(
    ("rule", "reworded", "refusal"),
    [
        (GO_AROUND, GO_AROUND.removeprefix("AAL123 "), "begins with no callsign; expected AAL123"),
        (READBACK, f"AAL123 {READBACK}", "begins with AAL123; expected none"),
        (GO_AROUND, GO_AROUND.replace("19L", "19R"), "changes the runways: 19R; expected 19L"),
        (GO_AROUND, GO_AROUND.replace("on runway 19L", "ahead"),
         "changes the runways: none; expected 19L"),
        ("AAL123 traffic UAL7, 12 s to go", "AAL123 traffic UAL7, runway 19, 12 s to go",
         "changes the runways: 19; expected none"),
        (GO_AROUND, GO_AROUND.replace("UAL7", "traffic"),
         "changes the callsigns: AAL123; expected AAL123, UAL7"),
        (READBACK, READBACK.replace("for UAL7", "by UAL7"),
         "changes the callsigns: by UAL7, by AAL123, DAL9; expected for UAL7, by AAL123, DAL9"),
        (GO_AROUND, GO_AROUND.replace("go around", "hold position"),
         "changes the actions: AAL123 hold_position; expected AAL123 go_around"),
        (GO_AROUND, GO_AROUND.replace("go around, ", ""),
         "changes the actions: none; expected AAL123 go_around"),
        (CLIMB, CLIMB.replace("climb", "descend"),
         "AAL123 altitude descend 5000.0 1500 feet 5000 feet"),
        (GO_AROUND, GO_AROUND.replace("12 s", "120 s"),
         "changes the numbers: 120 second; expected 12 second"),
        (GO_AROUND, GO_AROUND.replace(", 12 s to go", ""),
         "changes the numbers: none; expected 12 second"),
        (GO_AROUND, f"{GO_AROUND}, caution, advisory",
         "changes the severity: advisory, caution; expected warning"),
        (GO_AROUND, f"{GO_AROUND}, we all very much hope it helps somehow",
         "words of its own: all, helps, hope, much, somehow; expected"),
        ("AAL123 has not read back, traffic UAL7", "AAL123 has read back, traffic UAL7",
         "another number of 'not' than the rule's message"),
    ],
)  # fmt: skip
def test_a_refusal_says_what_was_changed_and_what_was_expected(
    rule: str, reworded: str, refusal: str
) -> None:
    assert refusal in changed(rule, reworded)


@pytest.mark.parametrize(("length", "is_refused"), [(200, False), (201, True)])
def test_a_message_has_200_characters_at_most(length: int, is_refused: bool) -> None:
    reworded = GO_AROUND + "," * (length - len(GO_AROUND))
    assert ("more than 200" in changed(GO_AROUND, reworded)) is is_refused
