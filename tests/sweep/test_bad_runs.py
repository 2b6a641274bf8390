"""Runs that hang, eat memory or crash, in a whole sweep with real runners."""

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
from airhilt.messages import AdsbReport


class Bad:
    name, reads = "bad", (AdsbReport,)

    def __init__(self, deed):
        self.deed = deed

    def receive(self, received):
        pass

    def decide(self, t_ns):
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
            "axes": {"assistant": ["bad:dies", "bad:eats", "bad:hangs", "none"]},
        },
        "test",
    )
    work = Work(tmp_path / "sweep", Limits(wall_s=20.0, memory_mb=1500.0), workers=1)
    with installed(tmp_path, monkeypatch, "airhilt.assistants", "bad", ASSISTANT):
        result = sweep(specification, work, SweepObserver())
    causes = {row["status"]: row["cause"] for row in result.folder.machine().to_pylist()}
    assert causes.keys() == {"crashed", "over_memory", "over_time", "finished"}
    assert "signal 9" in causes["crashed"]
    assert "1500 MB (--run-memory)" in causes["over_memory"]
    assert "20 s (--run-timeout)" in causes["over_time"]
    (row,) = result.folder.table().to_pylist()
    assert (row["assistant"], row["status"]) == ("none", "finished"), "what any machine would give"
