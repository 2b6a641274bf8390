"""The controller's conflict alert: two minutes before, to nobody else, and without advice."""

from __future__ import annotations

import pytest

from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.engine_families import ASSISTANTS
from encounters import Encounter, head_on

LOST_S = (2.0 * 30.7 - 5.0) / 960.0 * 3600.0
"""Time at which the two of `head_on` are within 5 NM."""


def flown(encounter: Encounter) -> Encounter:
    encounter.worker = DecisionWorker(ASSISTANTS.create("conflict_alert"), Template())
    return encounter.fly()


def test_the_controller_alone_is_told_two_minutes_before_the_loss_and_not_what_to_do() -> None:
    told = flown(head_on(200.0)).told
    assert LOST_S - told[0][0] == pytest.approx(120.0, abs=2.5)
    assert {advisory.recipient for _, advisory in told} == {"ATC"}
    assert all(advisory.recommendation is None for _, advisory in told)


def test_a_passing_at_12_nm_is_no_alert() -> None:
    assert flown(head_on(250.0, offset_nm=12.0)).told == []
