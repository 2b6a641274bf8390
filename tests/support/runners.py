"""A program in the place of the runner: it answers at once, or does what a key says."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from airhilt.sweep import runner_process
from airhilt.sweep.environment import Environment
from airhilt.sweep.outcome import Keep, Request

ENVIRONMENT = Environment(versions={"airhilt": "1"}, code_sha256="0" * 64, renderer="")
SOURCE = f"""
import json, os, sys, time
questions, answers = os.fdopen(int(sys.argv[1])), os.fdopen(int(sys.argv[2]), "w")
for line in questions:
    asked = json.loads(line)
    if "renderer" in asked:
        print({ENVIRONMENT.model_dump_json()!r}, file=answers, flush=True)
        continue
    key = asked["key"]
    scratch = sys.argv[3] + "/" + key
    os.makedirs(scratch if asked["keep"] == "none" else asked["folder"] + ".partial")
    if key == "eats":
        eaten = b"x" * 200_000_000
    if key == "dies":
        os.kill(os.getpid(), 9)
    if key in ("hangs", "eats"):
        time.sleep(3600.0)
    machine = dict(wall_s=0.0, cpu_s=0.0, peak_memory_mb=0.0, host="h", process=os.getpid())
    print(json.dumps(dict(key=key, status="finished", machine=machine)), file=answers, flush=True)
"""


def use_as_runner(folder: Path, patch: pytest.MonkeyPatch) -> None:
    """Have this program started instead of the runner."""
    program = folder / "runner.py"
    program.write_text(SOURCE)
    patch.setattr(runner_process, "COMMAND", (sys.executable, "-S", str(program)))


def request(key: str, keep: Keep = "none", folder: str = "") -> Request:
    """Return a request of which this program looks at the key, and where a run folder goes."""
    return Request(key=key, scenario={}, options={}, keep=keep, folder=folder)
