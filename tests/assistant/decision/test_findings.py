"""What each finding says in a few words."""

from __future__ import annotations

from typing import get_args

import pytest

from airhilt.assistant.decision.findings import (
    Finding,
    Intruder,
    LevelMisread,
    LossOfSeparation,
    NotReadBack,
    Obstruction,
    Obstructs,
    RecipientUnclear,
    RunwayMisread,
    RunwayUse,
    Unclear,
)
from airhilt.phraseology import Instruction

CROSS, HOLD = Instruction("cross", "01"), Instruction("hold_short", "01")


@pytest.mark.parametrize(
    ("finding", "statement"),
    [
        (LossOfSeparation(("A", "B"), 59.6), "A and B lose separation in 60 s"),
        (LossOfSeparation(("A", "B"), None), "A and B lose separation in 0 s"),
        (
            LevelMisread("A", 31_000.4, 29_000.0, "B", ("1", "2")),
            "read back 31000 ft, cleared 29000 ft, traffic B",
        ),
        (
            RunwayMisread("A", "A", CROSS, Instruction("cross", "19"), "B"),
            "A read back cross runway 19, was told cross runway 01, traffic B",
        ),
        (
            RunwayMisread("A", "A", None, CROSS, "B"),
            "A read back cross runway 01, was told nothing of the kind, traffic B",
        ),
        (
            RunwayMisread("A", "C", CROSS, CROSS, "B"),
            "cross runway 01 for C was read back by A, traffic B",
        ),
        (NotReadBack("A", HOLD, "B"), "A has not read back hold short runway 01, traffic B"),
        (
            RecipientUnclear(("A", "B"), Instruction("line_up", None), "C"),
            "line up may be for A or B, traffic C",
        ),
        (
            Unclear("A", "altitude", Instruction("altitude", altitude_ft=31_000.0), 0.456, "B"),
            "altitude of A heard as 'altitude 31000 ft', 46% certain",
        ),
        (
            Unclear("A", "action", Instruction("visual_separation", None), 0.5, "B"),
            "action of A heard as 'visual separation', 50% certain",
        ),
        (Intruder("A", False, None, "ahead", 20.0), "traffic ahead, no transponder, closing"),
        (Intruder("A", True, None, "to the left", 20.0), "birds to the left, closing"),
        (Intruder("A", False, "B", "behind", 20.0), "traffic B behind, closing"),
    ],
)
def test_a_finding_says_what_is_wrong_and_with_whom(finding: Finding, statement: str) -> None:
    assert finding.statement() == statement


def test_whatever_is_in_the_way_is_named_with_where_it_is() -> None:
    said = [
        Obstruction("A", "arrival", "01", how, "B", "19").statement() for how in get_args(Obstructs)
    ]
    assert all("B" in each and "runway 19" in each for each in said)
    assert len(set(said)) == len(said)


def test_the_user_of_a_runway_is_named_with_what_it_does() -> None:
    said = {
        use: Obstruction("A", use, "01", "on", "B", "19").statement_of_use()
        for use in get_args(RunwayUse)
    }
    assert said == {
        "arrival": "A on final for runway 01",
        "departure": "A takes off from runway 01",
        "rollout": "A rolls out on runway 01",
    }
