"""A process can do one run after the other: nothing stays behind, and nothing changes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import airhilt
from airhilt.files import sha256
from airhilt.scenario import Scenario
from airhilt.world.loading import load_text
from resources import held, linux_only, resident_mb

WARM_UP = 20
"""Number of runs after which a process has all that it keeps: modules, caches, memory pools."""
MEMORY_MB = 50.0
"""Greatest growth of the memory of a process over 1,000 runs, in MB."""


@pytest.fixture
def brief(encounter: Scenario) -> Scenario:
    """Two seconds of the encounter."""
    document = encounter.model_dump(mode="json") | {"duration_s": 2.0}
    return load_text(json.dumps(document), "brief")


def run(scenario: Scenario, folder: Path, *, speech: bool = False) -> str:
    """Run a scenario without cameras and return the hash of its log."""
    airhilt.run(scenario, out=folder, overwrite=True, cameras=False, speech=speech, latency="fixed")
    return sha256(folder / "log.mcap")


@linux_only
def test_runs_leave_no_descriptors_and_no_shared_memory(brief: Scenario, tmp_path: Path) -> None:
    run(brief, tmp_path / "run")
    before = held()
    for _ in range(15):
        run(brief, tmp_path / "run")
    assert held() == before


@linux_only
@pytest.mark.slow
@pytest.mark.parametrize("speech", [False, True])
def test_the_thousandth_run_is_the_first(speech: bool, tmp_path: Path) -> None:
    scenario, folder = airhilt.load("s02a_headon"), tmp_path / "run"
    runs = 100 if speech else 1000
    first = run(scenario, folder, speech=speech)
    for _ in range(WARM_UP):
        run(scenario, folder, speech=speech)
    before, before_mb = held(), resident_mb()
    for number in range(runs - WARM_UP - 1):
        assert run(scenario, folder, speech=speech) == first, f"run {number}"
    assert held() == before
    assert resident_mb() - before_mb < MEMORY_MB
