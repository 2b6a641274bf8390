"""A program in the place of the runner: it answers at once, or does what a key says."""

from __future__ import annotations

from pathlib import Path

import pytest

from airhilt.sweep import runner_process
from airhilt.sweep.environment import Environment
from airhilt.sweep.outcome import Keep, Request

ENVIRONMENT = Environment(versions={"airhilt": "1"}, code_sha256="0" * 64, renderer="")
SOURCE = f"""
import os, time
from airhilt.host.child_process import serve
from airhilt.sweep.environment import Environment
from airhilt.sweep.outcome import Machine, Outcome

class Runner:
    def environment(self, renderer):
        return Environment.model_validate_json({ENVIRONMENT.model_dump_json()!r})

    def run(self, request):
        key = request.key
        scratch = os.environ["TMPDIR"] + "/" + key
        os.makedirs(scratch if request.keep == "none" else request.folder + ".partial")
        if key == "eats":
            eaten = b"x" * 300_000_000
        if key == "dies":
            os.kill(os.getpid(), 9)
        if key in ("hangs", "eats"):
            time.sleep(3600.0)
        machine = Machine(wall_s=0.0, cpu_s=0.0, peak_memory_mb=0.0, host="h", process=os.getpid())
        return Outcome(key=key, status="finished", machine=machine)

serve(Runner())
"""


def use_as_runner(folder: Path, patch: pytest.MonkeyPatch) -> None:
    """Have this program started instead of the runner."""
    (folder / "runner_of_tests.py").write_text(SOURCE)
    patch.syspath_prepend(folder)
    patch.setattr(runner_process, "MODULE", "runner_of_tests")


def request(key: str, keep: Keep = "none", folder: str = "") -> Request:
    """Return a request of which this program looks at the key, and where a run folder goes."""
    return Request(key=key, scenario={}, options={}, keep=keep, folder=folder)
