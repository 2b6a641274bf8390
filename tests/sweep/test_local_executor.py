"""Runners of this machine, which a sweep asks."""

from __future__ import annotations

from pathlib import Path

import psutil
import pytest

from airhilt.errors import AirhiltError
from airhilt.sweep.local_executor import LocalExecutor
from airhilt.sweep.runner_process import Limits
from runners import ENVIRONMENT, request, use_as_runner

LIMITS = Limits(wall_s=60.0, memory_mb=4000.0)


@pytest.fixture(autouse=True)
def runner(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    use_as_runner(tmp_path, monkeypatch)


def test_runners_stay_from_one_sweep_to_the_next_and_end_with_the_executor() -> None:
    with LocalExecutor("", LIMITS, ENVIRONMENT, 1) as executor:
        found = [
            outcome.machine.process
            for keys in ("ab", "c")
            for outcome in executor.outcomes([request(key) for key in keys], lambda: False)
        ]
        assert len(found) == 3
        assert len(set(found)) == 1
    assert not psutil.pid_exists(found[0])


def test_runs_in_hand_finish_and_no_more_are_begun() -> None:
    found: list[str] = []
    with LocalExecutor("", LIMITS, ENVIRONMENT, 2) as executor:
        asked = [request(str(number)) for number in range(9)]
        for outcome in executor.outcomes(asked, lambda: bool(found)):
            found.append(outcome.key)
    assert sorted(found) == ["0", "1"]


def test_a_run_that_dies_is_a_crash_and_the_rest_go_on() -> None:
    with LocalExecutor("", LIMITS, ENVIRONMENT, 1) as executor:
        found = list(executor.outcomes([request("dies"), request("a")], lambda: False))
    assert [outcome.status for outcome in found] == ["crashed", "finished"]


def test_what_is_in_hand_ends_with_the_executor() -> None:
    before = {each.pid for each in psutil.Process().children()}
    with LocalExecutor("", LIMITS, ENVIRONMENT, 2) as executor:
        first = next(executor.outcomes([request("a"), request("hangs")], lambda: False))
    assert first.key == "a"
    assert not [each for each in psutil.Process().children() if each.pid not in before]


def test_files_that_have_changed_since_the_sweep_began_are_told() -> None:
    other = ENVIRONMENT.model_copy(update={"code_sha256": "f" * 64})
    with (
        LocalExecutor("", LIMITS, other, 1) as executor,
        pytest.raises(AirhiltError, match="of this machine: other code"),
    ):
        list(executor.outcomes([request("a")], lambda: False))
