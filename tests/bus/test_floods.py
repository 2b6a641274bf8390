"""A flood of large messages costs a run neither memory nor its terminal."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

import attack_bus
from airhilt.bus.session import free_endpoint
from airhilt.scenario import Scenario

COUNT = 600
"""Number of advisories of 1 MB: without limits a run takes over 600 MB for them."""
MOST_BYTES = 250_000_000
UNIT_BYTES = 1 if sys.platform == "darwin" else 1024
"""Unit in which the system tells the greatest memory of a process."""
MOST_STDERR_BYTES = 20_000
MEASURED = """
import resource, subprocess, sys
code = subprocess.call(sys.argv[1:], stdout=subprocess.DEVNULL)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
sys.exit(code)
"""
"""Runs a command from a small process: on Linux a child begins with the memory of its parent."""


@pytest.mark.slow
def test_a_flood_of_large_messages_is_dropped_and_counted(
    encounter: Scenario, tmp_path: Path
) -> None:
    endpoint, out, told = free_endpoint(), tmp_path / "run", tmp_path / "stderr"
    short = tmp_path / "short.json"
    short.write_text(encounter.model_copy(update={"duration_s": 15.0}).model_dump_json())
    measured = [sys.executable, "-c", MEASURED]
    command = [*measured, sys.executable, "-m", "airhilt", "cosim", "--scenario", str(short)]
    options = [
        "--out",
        str(out),
        "--pace",
        "realtime",
        "--latency",
        "fixed",
        "--no-cameras",
        "--no-speech",
    ]
    with told.open("wb") as stderr:
        run = subprocess.Popen(
            [*command, *options, "--endpoint", endpoint], stderr=stderr, stdout=subprocess.PIPE
        )
        attack = [sys.executable, attack_bus.__file__, endpoint, "large", "--count", str(COUNT)]
        subprocess.run(attack, check=True, stdout=subprocess.DEVNULL)
        used, _ = run.communicate()
    assert run.returncode == 0, told.read_text()
    dropped = json.loads((out / "summary.json").read_text())["messages_dropped"]
    assert 0 < dropped.get("advisory/*: size", 0) <= COUNT
    assert int(used) * UNIT_BYTES < MOST_BYTES
    assert told.stat().st_size < MOST_STDERR_BYTES
