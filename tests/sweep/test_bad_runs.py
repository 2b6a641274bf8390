"""Runs that hang, eat memory, crash or raise, in a whole sweep with real runners."""

from __future__ import annotations

from pathlib import Path

import pytest

from airhilt.sweep.engine import SweepObserver, sweep
from airhilt.sweep.runner_process import Limits
from airhilt.sweep.specification import specification_of
from airhilt.sweep.work import Work
from engine_package import installed

pytestmark = pytest.mark.slow

ASSISTANT = """
import os
import signal
import time

from airhilt.assistant.decision.engine import Decision
from airhilt.engines import Engine


class Bad:
    name, reads = "bad", ()

    def __init__(self, deed):
        self.deed = deed

    def receive(self, received):
        pass

    def decide(self, t_ns):
        if self.deed == "raises":
            raise RuntimeError("a mistake of its own")
        if self.deed == "dies":
            os.kill(os.getpid(), signal.SIGKILL)
        if self.deed == "eats":
            eaten = b"x" * 2_000_000_000
        time.sleep(3600.0)


ENGINE = Engine("bad", "does what is bad", Bad, argument="DEED")
"""


def test_each_bad_run_has_its_cause_and_the_others_are_done(
    encounter_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    specification = specification_of(
        {
            "scenarios": [str(encounter_file)],
            "seeds": [0],
            "options": {"speech": False, "latency": "fixed"},
            "axes": {"assistant": ["bad:dies", "bad:eats", "bad:hangs", "bad:raises", "none"]},
        },
        "test",
    )
    work = Work(tmp_path / "sweep", Limits(wall_s=20.0, memory_mb=1500.0), workers=1)
    with installed(tmp_path, monkeypatch, "airhilt.assistants", "bad", ASSISTANT):
        result = sweep(specification, work, SweepObserver())
    machine = {row["assistant"]: row for row in result.folder.machine().to_pylist()}
    status = {name: row["status"] for name, row in machine.items()}
    assert status == {
        "bad:dies": "crashed",
        "bad:eats": "over_memory",
        "bad:hangs": "over_time",
        "bad:raises": "failed",
        "none": "finished",
    }
    assert "signal 9" in machine["bad:dies"]["cause"]
    assert "1500 MB (--run-memory)" in machine["bad:eats"]["cause"]
    assert "20 s (--run-timeout)" in machine["bad:hangs"]["cause"]
    assert "a mistake of its own" in machine["bad:raises"]["cause"]
    table = {row["assistant"]: row["status"] for row in result.folder.table().to_pylist()}
    assert table == {"bad:raises": "failed", "none": "finished"}, "what any machine would give"
