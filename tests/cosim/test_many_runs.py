"""A process can do one run after the other: nothing stays behind, and nothing changes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import airhilt
from airhilt.host.files import sha256
from airhilt.scenario import Scenario
from airhilt.world.loading import load_text
from resources import held, linux_only, resident_mb
from shortened import shortened

WARM_UP = 20
"""Number of runs after which a process has all that it keeps: modules, caches, memory pools."""
MEMORY_MB = 50.0
"""Greatest growth of the memory of a process over 1,000 runs, in MB."""


@pytest.fixture
def brief(encounter: Scenario) -> Scenario:
    """Two seconds of the encounter."""
    document = shortened(encounter.model_dump(mode="json"), 2.0)
    return load_text(json.dumps(document), "brief")


def run(scenario: Scenario, folder: Path, *, speech: bool = False) -> tuple[str, dict[str, Any]]:
    """Run a scenario without cameras; return the hash of its log, and its summary."""
    done = airhilt.run(
        scenario, out=folder, overwrite=True, cameras=False, speech=speech, latency="fixed"
    )
    summary = done.summary.model_dump(exclude={"cpu_s", "real_time_factor"})
    return sha256(folder / "log.mcap"), summary


@pytest.mark.slow
@linux_only
def test_runs_are_alike_and_leave_no_descriptors_and_no_shared_memory(
    brief: Scenario, tmp_path: Path
) -> None:
    first = run(brief, tmp_path / "run")
    before = held()
    for _ in range(12):
        assert run(brief, tmp_path / "run") == first
    assert held() == before


@linux_only
@pytest.mark.slow
@pytest.mark.parametrize(("runs", "speech"), [(1000, False), (100, True)])
def test_the_last_of_many_runs_is_as_the_first(runs: int, speech: bool, tmp_path: Path) -> None:
    scenario, folder = airhilt.load("s02a_headon"), tmp_path / "run"
    first = run(scenario, folder, speech=speech)
    for _ in range(WARM_UP):
        run(scenario, folder, speech=speech)
    before, before_mb = held(), resident_mb()
    for number in range(WARM_UP + 1, runs):
        assert run(scenario, folder, speech=speech) == first, f"run {number}"
    assert held() == before
    assert resident_mb() - before_mb < MEMORY_MB
