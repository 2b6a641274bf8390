"""The runners that a sweep keeps in a worker of Dask."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import psutil
import pytest
from distributed import Reschedule

from airhilt.errors import AirhiltError
from airhilt.sweep import dask_worker
from airhilt.sweep.dask_worker import RunnerPlugin
from airhilt.sweep.runner_process import Limits
from runners import ENVIRONMENT, request, use_as_runner

LIMITS = Limits(wall_s=60.0, memory_mb=4000.0)


@pytest.fixture
def worker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    use_as_runner(tmp_path, monkeypatch)
    return SimpleNamespace(address="tcp://w:1")


@pytest.fixture
def plugin(worker: Any) -> Iterator[RunnerPlugin]:
    made = RunnerPlugin("", LIMITS, ENVIRONMENT)
    made.setup(worker)
    yield made
    made.teardown(worker)


def test_a_runner_does_one_run_after_the_other(plugin: RunnerPlugin) -> None:
    first, second = (plugin.run(request(key)).machine for key in "ab")
    assert first.process == second.process


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"versions": {"airhilt": "2"}}, "airhilt 1 instead of 2; expected"),
        ({"code_sha256": "f" * 64}, "other code, models, aircraft or airports of AIRHILT"),
    ],
)
def test_a_worker_with_other_software_is_refused_by_name(
    worker: Any, changes: dict[str, Any], said: str
) -> None:
    plugin = RunnerPlugin("", LIMITS, ENVIRONMENT.model_copy(update=changes))
    plugin.setup(worker)
    with pytest.raises(AirhiltError, match=f"worker tcp://w:1: {said}"):
        plugin.run(request("a"))
    plugin.teardown(worker)


def test_a_worker_that_does_not_see_the_folder_is_refused_by_name(
    worker: Any, tmp_path: Path
) -> None:
    plugin = RunnerPlugin("", LIMITS, ENVIRONMENT, tmp_path / "runs" / ".probe")
    plugin.setup(worker)
    with pytest.raises(AirhiltError, match=r"worker tcp://w:1: does not see .*/runs, or cannot"):
        plugin.run(request("a"))
    plugin.teardown(worker)


def test_runners_end_with_the_sweep(plugin: RunnerPlugin, worker: Any) -> None:
    process = plugin.run(request("a")).machine.process
    plugin.teardown(worker)
    assert not psutil.pid_exists(process)


@pytest.mark.parametrize("key", ["hangs", "dies"])
def test_a_run_in_hand_or_one_that_crashes_is_for_another_worker_if_this_one_ends(
    plugin: RunnerPlugin, worker: Any, key: str
) -> None:
    plugin.run(request("a"))
    threading.Timer(0.5, plugin.teardown, [worker]).start()
    with pytest.raises(Reschedule):
        plugin.run(request(key))


def test_a_crash_alone_is_the_runs_own(
    plugin: RunnerPlugin, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dask_worker, "GRACE_S", 0.0)
    assert plugin.run(request("dies")).status == "crashed"
