"""The runners that a sweep keeps in a worker of Dask."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest
from distributed import Reschedule

from airhilt.errors import AirhiltError
from airhilt.sweep import dask_worker
from airhilt.sweep.dask_worker import RunnerPlugin
from airhilt.sweep.outcome import Outcome
from airhilt.sweep.runner_process import Limits
from runners import ENVIRONMENT, request, use_as_runner

LIMITS = Limits(wall_s=60.0, memory_mb=4000.0)


class FakeWorker:
    address = "tcp://w:1"

    def __init__(self) -> None:
        self.periodic_callbacks: dict[str, Any] = {}


@pytest.fixture
def worker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    use_as_runner(tmp_path, monkeypatch)
    return FakeWorker()


@pytest.fixture
def plugin(worker: Any) -> Iterator[RunnerPlugin]:
    made = RunnerPlugin("", LIMITS, ENVIRONMENT)
    asyncio.run(_set_up(made, worker))
    yield made
    if made.name in worker.periodic_callbacks:
        made.teardown(worker)


async def _set_up(plugin: RunnerPlugin, worker: Any) -> None:
    plugin.setup(worker)


def process_of(outcome: str) -> int:
    return Outcome.model_validate_json(outcome).machine.process


def test_a_runner_does_one_run_after_the_other(plugin: RunnerPlugin) -> None:
    assert process_of(plugin.run(request("a"))) == process_of(plugin.run(request("b")))


def test_a_worker_with_other_software_is_refused_by_name(worker: Any) -> None:
    other = ENVIRONMENT.model_copy(update={"versions": {"airhilt": "2"}})
    plugin = RunnerPlugin("", LIMITS, other)
    asyncio.run(_set_up(plugin, worker))
    with pytest.raises(AirhiltError, match="worker tcp://w:1: airhilt 1 instead of 2; expected"):
        plugin.run(request("a"))
    plugin.teardown(worker)


def test_a_worker_that_does_not_see_the_folder_is_refused_by_name(
    worker: Any, tmp_path: Path
) -> None:
    plugin = RunnerPlugin("", LIMITS, ENVIRONMENT, tmp_path / "runs" / ".probe")
    with pytest.raises(AirhiltError, match=r"worker tcp://w:1: does not see .*/runs, or cannot"):
        asyncio.run(_set_up(plugin, worker))
    plugin.teardown(worker)


def test_runners_end_with_the_sweep(plugin: RunnerPlugin, worker: Any) -> None:
    process = process_of(plugin.run(request("a")))
    plugin.teardown(worker)
    assert not psutil.pid_exists(process)


def test_a_run_in_hand_is_for_another_worker_if_this_one_ends(
    plugin: RunnerPlugin, worker: Any
) -> None:
    threading.Timer(0.5, plugin.teardown, [worker]).start()
    with pytest.raises(Reschedule):
        plugin.run(request("hangs"))


def test_a_crash_with_the_worker_itself_is_not_the_runs_own(
    plugin: RunnerPlugin, worker: Any
) -> None:
    threading.Timer(0.5, plugin.teardown, [worker]).start()
    with pytest.raises(Reschedule):
        plugin.run(request("dies"))


def test_a_crash_alone_is_the_runs_own(
    plugin: RunnerPlugin, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dask_worker, "GRACE_S", 0.0)
    assert Outcome.model_validate_json(plugin.run(request("dies"))).status == "crashed"


def test_runners_of_a_sweep_that_was_killed_end_after_a_while(
    plugin: RunnerPlugin, worker: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    process = process_of(plugin.run(request("a")))
    look = worker.periodic_callbacks[plugin.name].callback
    look()
    assert psutil.pid_exists(process)
    monkeypatch.setattr(dask_worker, "IDLE_S", -1.0)
    look()
    assert not psutil.pid_exists(process)
