"""A failure changes what it names, and nothing else."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import TypeAdapter

from airhilt import load
from airhilt.scenario.failures import apply_failures
from airhilt.scenario.models import Failure

SCENARIO = load("s01b_noncompliance")
FAILURES = TypeAdapter(tuple[Failure, ...])
HOLD = next(line for line in SCENARIO.radio.lines if line.id == "hold")


def effective(*failures: Any, line: str = "hold") -> Any:
    scenario = SCENARIO.model_copy(update={"failures": FAILURES.validate_python(failures)})
    lines = {each.declared.id: each for each in apply_failures(scenario)}
    others = [each for name, each in lines.items() if name != line]
    assert all(each.line is each.declared and not each.failures for each in others)
    return lines[line]


def test_without_failures_all_happens_as_it_is_written() -> None:
    hold = effective()
    assert hold.line is hold.declared
    assert (hold.late_s, hold.failures, hold.affected) == (0.0, (), frozenset())


@pytest.mark.parametrize("kind", ["not_received", "ignored"])
def test_who_does_not_hear_or_heed_a_line_does_nothing(kind: str) -> None:
    hold = effective({"type": kind, "line": "hold", "actor": "OPS1"})
    assert hold.line.commands == ()
    assert hold.line.text == HOLD.text
    assert hold.affected == {"OPS1"}


def test_a_line_taken_by_another_makes_the_other_act() -> None:
    hold = effective(
        {"type": "callsign_confused", "line": "hold", "meant": "OPS1", "taken_by": "OPS2"}
    )
    taken = HOLD.commands[0].model_copy(update={"actor": "OPS2"})
    assert hold.line == HOLD.model_copy(update={"commands": (taken,)})
    assert hold.affected == {"OPS1", "OPS2"}


def test_the_taker_may_act_otherwise_after_other_words() -> None:
    hold = effective(
        {"type": "callsign_confused", "line": "hold", "meant": "OPS1", "taken_by": "OPS2",
         "text": "Ops two, go on.",
         "commands": [{"actor": "OPS2", "command": {"action": "continue"}}]}
    )  # fmt: skip
    assert hold.line.text == "Ops two, go on."
    (told,) = hold.line.commands
    assert (told.actor, told.command.action) == ("OPS2", "continue")


def test_a_late_line_is_late_by_the_sum_of_its_delays() -> None:
    hold = effective(
        {"type": "delayed", "line": "hold", "by_s": 5.0},
        {"type": "delayed", "line": "hold", "by_s": 2.5},
    )
    assert hold.late_s == 7.5
    assert hold.line is hold.declared
    assert len(hold.failures) == 2


def test_a_dropped_line_is_never_said() -> None:
    hold = effective({"type": "dropped", "line": "hold"})
    assert hold.line is None
    assert hold.affected == {"OPS1"}


def test_a_wrong_readback_has_other_words_and_other_deeds() -> None:
    wrong = effective(
        {"type": "readback_wrong", "line": "hold_readback", "text": "Proceeding, Ops one.",
         "commands": [{"actor": "OPS1", "command": {"action": "continue"}}]},
        line="hold_readback",
    )  # fmt: skip
    assert wrong.line.text == "Proceeding, Ops one."
    assert [scripted.command.action for scripted in wrong.line.commands] == ["continue"]
    assert wrong.affected == {"OPS1"}


def test_an_engine_failure_is_no_matter_of_lines() -> None:
    failure = {
        "type": "engine_failure", "actor": "AAL123", "engine": 0,
        "when": {"type": "time", "at_s": 5.0},
    }  # fmt: skip
    assert effective(failure).failures == ()


def test_of_two_failures_of_a_line_the_second_acts_on_what_the_first_has_left() -> None:
    hold = effective(
        {"type": "callsign_confused", "line": "hold", "meant": "OPS1", "taken_by": "OPS2"},
        {"type": "not_received", "line": "hold", "actor": "OPS2"},
        {"type": "delayed", "line": "hold", "by_s": 3.0},
    )
    assert hold.line.commands == ()
    assert hold.late_s == 3.0
    assert hold.affected == {"OPS1", "OPS2"}
    assert [text.split()[0] for text in hold.failures] == ["OPS2", "OPS2", "it"]


@pytest.mark.parametrize("kind", ["not_received", "ignored"])
def test_of_two_that_a_line_tells_something_only_the_one_named_fails(kind: str) -> None:
    both = tuple(HOLD.commands[0].model_copy(update={"actor": actor}) for actor in ("OPS1", "OPS2"))
    line = HOLD.model_copy(update={"commands": both})
    radio = SCENARIO.radio.model_copy(update={"lines": (line,)})
    failures = FAILURES.validate_python([{"type": kind, "line": "hold", "actor": "OPS1"}])
    scenario = SCENARIO.model_copy(update={"radio": radio, "failures": failures})
    (hold,) = apply_failures(scenario)
    assert hold.line == line.model_copy(update={"commands": both[1:]})
    assert hold.affected == {"OPS1"}


def test_who_waits_for_a_late_clearance_acts_with_one_and_who_took_anothers_without() -> None:
    late = effective({"type": "delayed", "line": "hold", "by_s": 5.0})
    taken = effective(
        {"type": "callsign_confused", "line": "hold", "meant": "OPS1", "taken_by": "OPS2"}
    )
    assert late.affected == {"OPS1"}
    assert late.uncleared == set()
    assert taken.uncleared == {"OPS1", "OPS2"}
