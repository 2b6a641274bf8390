"""Sweeps on a scheduler and workers that are processes of their own, some of which are killed."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from dask_processes import Cluster, Machine, kill, machines, wait_until

from .conftest import RUNS, SweepCommand

pytestmark = pytest.mark.slow


@pytest.fixture
def places() -> Iterator[list[Machine]]:
    with machines(4) as found:
        yield found


def started(machine: Machine, command: list[str], folder: Path) -> psutil.Popen:
    return machine.start(*command, log=folder / "sweep.log")


def parts(out: Path) -> int:
    return len(list(out.glob("parts/*.parquet")))


def test_a_sweep_outlives_a_worker_and_goes_on_after_the_loss_of_the_scheduler(
    places: list[Machine],
    sweep_command: SweepCommand,
    table_bytes: bytes,
    tmp_path: Path,
) -> None:
    out, log = tmp_path / "sweep", tmp_path / "sweep.log"
    with Cluster(places, tmp_path) as cluster:
        cluster.start_scheduler()
        for index in (1, 2, 3):
            cluster.start_worker(index)
        command = sweep_command(out, "--scheduler", cluster.address)
        first = started(places[0], command, tmp_path)
        wait_until(lambda: parts(out) >= 2)
        cluster.kill("worker1")
        at_loss = parts(out)
        wait_until(lambda: parts(out) >= at_loss + 4)
        cluster.kill("scheduler")
        assert first.wait(60.0) == 2
        told = log.read_text()
        assert f"scheduler {cluster.address} is lost; what was finished is kept" in told
        assert "Traceback" not in told
        kept = parts(out)
        assert at_loss + 4 <= kept < RUNS
        for index in (2, 3):
            cluster.processes.pop(f"worker{index}").wait(60.0)

        cluster.start_scheduler()
        for index in (1, 2, 3):
            cluster.start_worker(index)
        second = started(places[0], command, tmp_path)
        assert second.wait(300.0) == 0
        assert f"{RUNS} runs, {kept} of them finished before" in log.read_text()
    assert (out / "sweep.parquet").read_bytes() == table_bytes


def test_a_worker_without_airhilt_is_told(
    places: list[Machine], sweep_command: SweepCommand, tmp_path: Path
) -> None:
    without = tmp_path / "without"
    without.mkdir()
    (without / "airhilt.py").write_text(
        "raise ModuleNotFoundError(\"No module named 'airhilt'\")\n"
    )
    with Cluster(places, tmp_path) as cluster:
        cluster.start_scheduler()
        cluster.start_worker(1, {"PYTHONPATH": str(without)})
        sweep = started(
            places[0], sweep_command(tmp_path / "sweep", "--scheduler", cluster.address), tmp_path
        )
        assert sweep.wait(120.0) == 2
    told = (tmp_path / "sweep.log").read_text()
    assert "No module named 'airhilt'" in told
    assert "expected AIRHILT to be installed there, as here" in told
    assert "Traceback" not in told


def test_a_sweep_that_stops_takes_its_runners_from_the_workers(
    places: list[Machine],
    sweep_command: SweepCommand,
    table_bytes: bytes,
    tmp_path: Path,
) -> None:
    out = tmp_path / "sweep"
    with Cluster(places, tmp_path) as cluster:
        cluster.start_scheduler()
        cluster.start_worker(1)
        command = sweep_command(out, "--scheduler", cluster.address)
        killed = started(places[0], command, tmp_path)
        wait_until(lambda: parts(out) >= 2)
        kill(killed)
        left = cluster.runners("worker1")
        assert len(left) == 1

        stopped = started(places[0], command, tmp_path)
        wait_until(lambda: parts(out) >= 6)
        stopped.send_signal(signal.SIGINT)
        wait_until(lambda: "once more stops at once" in (tmp_path / "sweep.log").read_text())
        stopped.send_signal(signal.SIGINT)
        assert stopped.wait(60.0) == 130
        wait_until(lambda: cluster.runners("worker1") == left)

        assert started(places[0], command, tmp_path).wait(300.0) == 0
    assert "Traceback" not in (tmp_path / "sweep.log").read_text()
    assert (out / "sweep.parquet").read_bytes() == table_bytes
