"""The runner tells what is the run's own fault from what is the machine's."""

from __future__ import annotations

from pathlib import Path

import pytest

from airhilt.errors import AirhiltError, ScenarioError, disk_failed
from airhilt.sweep import runner
from airhilt.sweep.outcome import Request

FULL = OSError(28, "No space left on device")


@pytest.mark.parametrize(
    ("error", "status"),
    [
        (disk_failed("log.mcap", FULL), "crashed"),
        (FULL, "crashed"),
        (MemoryError(), "crashed"),
        (ScenarioError("a speed that nothing flies"), "failed"),
        (AirhiltError("an engine that is not there"), "failed"),
        (ZeroDivisionError(), "failed"),
    ],
)
def test_a_disk_or_memory_that_is_full_is_no_result_of_the_run(
    error: Exception, status: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(runner, "_summary", fail)
    request = Request(key="k", scenario={}, options={}, keep="none", folder=str(tmp_path / "run"))
    outcome = runner.run_request(request)
    assert outcome.status == status
    assert outcome.cause
    assert outcome.metrics == {}
