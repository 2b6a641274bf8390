"""Fixtures for sweeps on clusters: a short scenario, and its sweep on this machine."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from airhilt.scenario import Scenario
from shortened import shortened

RUNS = 24
SweepCommand = Callable[..., list[str]]


@pytest.fixture(scope="session")
def short_file(encounter: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Six seconds of an encounter."""
    document = shortened(encounter.model_dump(mode="json"), 6.0) | {"name": "short"}
    path = tmp_path_factory.mktemp("scenario") / "short.json"
    path.write_text(json.dumps(document))
    return path


@pytest.fixture(scope="session")
def sweep_command(short_file: Path) -> SweepCommand:
    """Returns the command of a sweep of that scenario."""

    def command(out: Path, *more: str) -> list[str]:
        return [
            *(sys.executable, "-m", "airhilt", "sweep", "--scenario", str(short_file)),
            *("--seeds", str(RUNS), "--no-speech", "--latency", "fixed", "--out", str(out)),
            *more,
        ]

    return command


@pytest.fixture(scope="session")
def table_bytes(sweep_command: SweepCommand, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The table of the same sweep by two workers on this machine."""
    out = tmp_path_factory.mktemp("sweeps") / "local"
    subprocess.run(sweep_command(out, "--workers", "2", "--quiet"), check=True)
    return (out / "sweep.parquet").read_bytes()
