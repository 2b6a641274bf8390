"""Fixtures for all tests."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from airhilt import load
from airhilt.scenario import Scenario
from airhilt.world.loading import load_text

Cli = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def encounter() -> Scenario:
    """Half a minute of a head-on encounter, without cameras, and with a warning after 2 s."""
    document = load("s02a_headon").model_dump(mode="json")
    for actor in document["actors"]:
        actor["initial"]["position"]["distance_nm"] = 13.0
    document |= {"name": "encounter", "duration_s": 30.0, "cameras": []}
    return load_text(json.dumps(document), "encounter")


@pytest.fixture
def encounter_file(encounter: Scenario, tmp_path: Path) -> Path:
    """The encounter as a file."""
    path = tmp_path / "encounter.json"
    path.write_text(encounter.model_dump_json())
    return path


@pytest.fixture
def airhilt_command(tmp_path: Path) -> Cli:
    """Runs the command line in an empty folder."""

    def call(*arguments: str | Path, timeout: float = 120.0) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "airhilt", *map(str, arguments)],
            capture_output=True,
            text=True,
            cwd=tmp_path,
            timeout=timeout,
            check=False,
        )

    return call
