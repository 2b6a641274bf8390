"""What becomes of runs that hang, eat memory or crash."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import psutil
import pytest

from airhilt.sweep.runner_process import Limits, RunnerError, RunnerProcess
from runners import request, use_as_runner

LIMITS = Limits(wall_s=60.0, memory_mb=250.0)


@pytest.fixture(autouse=True)
def _program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    use_as_runner(tmp_path, monkeypatch)


@pytest.fixture
def runner() -> Iterator[RunnerProcess]:
    with closing(RunnerProcess("", LIMITS)) as made:
        yield made


@pytest.mark.parametrize(
    ("key", "limits", "status", "cause"),
    [
        ("hangs", Limits(0.2, 250.0), "over_time", "took longer than 0.2 s (--run-timeout)"),
        ("eats", LIMITS, "over_memory", "took more than 250 MB (--run-memory)"),
        ("dies", LIMITS, "crashed", "its process has ended (signal 9)"),
    ],
)
def test_a_run_that_ends_badly_has_its_cause_and_the_next_one_runs(
    key: str, limits: Limits, status: str, cause: str
) -> None:
    with closing(RunnerProcess("", limits)) as runner:
        outcome = runner.run(request(key))
        assert (outcome.status, outcome.cause) == (status, cause)
        after = runner.run(request("good"))
        assert after.status == "finished"
        assert after.machine.process != outcome.machine.process
        assert not psutil.pid_exists(outcome.machine.process)


def test_the_folder_of_a_run_that_a_limit_ended_stays_if_it_is_to(tmp_path: Path) -> None:
    folder = tmp_path / "runs" / "k"
    with closing(RunnerProcess("", Limits(0.2, 250.0))) as runner:
        assert runner.run(request("hangs", "failed", str(folder))).is_kept
    assert [each.name for each in folder.parent.iterdir()] == ["k"]


def test_a_runner_that_is_killed_leaves_no_temporary_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each run that a limit ends would leave its folder, until the disk is full."""
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(temporary))
    with closing(RunnerProcess("", Limits(0.2, 250.0))) as runner:
        assert not runner.run(request("hangs")).is_kept
        assert not list(temporary.iterdir())
        runner.run(request("good"))
        assert list(temporary.glob("*/good"))
    assert not list(temporary.iterdir())


def test_the_memory_of_a_run_is_told(runner: RunnerProcess) -> None:
    assert 1.0 < runner.run(request("good")).machine.peak_memory_mb < LIMITS.memory_mb


def test_a_runner_has_one_thread_and_its_own_memory_whoever_starts_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("MALLOC_TRIM_THRESHOLD_", "65536")
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "16")
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    with closing(RunnerProcess("", LIMITS)) as runner:
        environment = psutil.Process(runner.run(request("good")).machine.process).environ()
    assert "MALLOC_TRIM_THRESHOLD_" not in environment
    assert (environment["OPENBLAS_NUM_THREADS"], environment["OMP_NUM_THREADS"]) == ("1", "1")


def test_a_disk_on_which_no_runner_can_be_started_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("tempfile.TemporaryDirectory", full)
    with pytest.raises(RunnerError, match=r"on .* \(No space left on device\); expected .*TMPDIR"):
        RunnerProcess("", LIMITS)
