"""A disk that takes no more is a named error, and what was written stays readable."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest

import airhilt.cosim.simulation
from airhilt import run
from airhilt.cosim.replay import replay
from airhilt.errors import RunFolderError
from airhilt.messages import Clock
from airhilt.record import LatencyLog, LogWriter, RunFolder, read_log
from airhilt.scenario import Scenario
from airhilt.sim import StepRecord

FULL = Path("/dev/full")

needs_full = pytest.mark.skipif(not FULL.exists(), reason="needs /dev/full")


@needs_full
def test_a_full_disk_is_named_by_the_latency_log() -> None:
    log = LatencyLog(FULL)
    log.step(StepRecord("w", 0, 0, 0, 0, 0.0, 0))
    with pytest.raises(RunFolderError, match=r"No space left.*make room"):
        log.flush()
    with pytest.raises(RunFolderError):
        log.close()


@needs_full
def test_a_full_disk_is_named_by_the_log() -> None:
    log = LogWriter(FULL)
    log.write("clock", "run", Clock, 0, b"{}")
    with pytest.raises(RunFolderError, match=r"No space left.*make room"):
        log.flush()
    with pytest.raises(RunFolderError):
        log.close()


def test_a_disk_that_fills_up_stops_the_run_and_keeps_what_it_has(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class FillsUp(LatencyLog):
        def step(self, record: StepRecord) -> None:
            if record.t_start_ns > 12e9:
                raise RunFolderError("latency.jsonl: cannot be written any more")
            super().step(record)

    monkeypatch.setattr(airhilt.cosim.simulation, "LatencyLog", FillsUp)
    with pytest.raises(RunFolderError, match="cannot be written any more"):
        run(encounter, out=tmp_path / "run", latency="fixed")
    monkeypatch.undo()
    folder = RunFolder(tmp_path / "run")
    assert max(logged.t_ns for logged in read_log(folder.log_path)) > 12e9
    assert replay(folder.path).identical


def test_a_run_that_is_killed_at_once_leaves_a_log_without_messages(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log, left = RunFolder(tmp_path / "run").log_path, tmp_path / "left.mcap"

    def end_at_once(*_: Any, **__: Any) -> None:
        shutil.copy(log, left)  # As it is on the disk, before anything is closed.
        raise RunFolderError("ended at once")

    monkeypatch.setattr(airhilt.cosim.simulation, "Simulation", end_at_once)
    with pytest.raises(RunFolderError, match="ended at once"):
        run(encounter, out=tmp_path / "run", latency="fixed")
    assert list(read_log(left)) == []
