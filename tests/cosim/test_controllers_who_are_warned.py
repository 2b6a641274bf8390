"""Runs in which the controller alone is warned: what it says decides how they end."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from airhilt.cosim.simulation import run
from airhilt.metrics.summary import Summary
from airhilt.options import Options
from airhilt.record import Logged, open_run
from airhilt.scenario.models import Controller
from nominal import nominal
from seats import contents

TOWER = "Washington Tower"


def told_alone(name: str, out: Path, **controller: Any) -> tuple[Summary, list[Logged]]:
    """Return how a run ends in which the tower alone is warned, and its log."""
    scenario = nominal(name).model_copy(
        update={"cameras": (), "controllers": {TOWER: Controller(**controller)}}
    )
    options = Options(out=out, latency="fixed", recipients="controller", report=False)
    return run(scenario, options).summary, list(open_run(out).log())


@pytest.mark.slow
def test_a_tower_that_is_told_of_a_wrong_readback_prevents_the_collision(tmp_path: Path) -> None:
    summary, log = told_alone("s01a_bad_readback", tmp_path / "run")
    assert summary.avoided is True
    spoken = [one["text"] for one in contents(log, "truth/radio/") if one["speaker"] == TOWER]
    assert any("negative, I say again" in text for text in spoken)
    assert {one["recipient"] for one in contents(log, "advisory/")} == {"ATC"}


@pytest.mark.slow
def test_a_tower_that_does_not_respond_lets_the_two_collide(tmp_path: Path) -> None:
    summary, log = told_alone("s01a_bad_readback", tmp_path / "run", compliance=0.0)
    assert summary.collision is True
    kinds = {one["kind"] for one in contents(log, "truth/event")}
    assert "controller_silent" in kinds
    assert "controller_reacts" not in kinds
