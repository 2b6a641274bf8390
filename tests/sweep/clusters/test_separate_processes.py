"""Sweeps on a scheduler and workers that are processes of their own, some of which are killed."""

from __future__ import annotations

import shutil
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from dask_processes import Cluster, Machine, kill, machines, wait_until
from paths import ROOT

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


def test_a_sweep_without_workers_says_so_and_goes_on_when_one_comes(
    places: list[Machine], sweep_command: SweepCommand, tmp_path: Path
) -> None:
    log = tmp_path / "sweep.log"
    with Cluster(places, tmp_path) as cluster:
        cluster.start_scheduler()
        command = sweep_command(tmp_path / "sweep", "--scheduler", cluster.address, "--seeds", "1")
        sweep = started(places[0], command, tmp_path)
        wait_until(lambda: "has no workers; waiting for one" in log.read_text())
        cluster.start_worker(1)
        assert sweep.wait(120.0) == 0


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


def test_a_worker_that_does_not_see_the_folder_is_told_before_the_first_run(
    places: list[Machine], sweep_command: SweepCommand, tmp_path: Path
) -> None:
    out = tmp_path / "hidden" / "sweep"
    with Cluster(places, tmp_path) as cluster:
        cluster.start_scheduler()
        out.parent.mkdir()
        hide = f'mount -t tmpfs none {out.parent} && exec "$@"'
        cluster.start_worker(1, prefix=("unshare", "--mount", "sh", "-c", hide, "sh"))
        command = sweep_command(out, "--scheduler", cluster.address, "--keep", "all")
        sweep = started(places[0], command, tmp_path)
        assert sweep.wait(120.0) == 2
    told = (tmp_path / "sweep.log").read_text()
    assert f"does not see {out / 'runs'}" in told
    assert "Traceback" not in told
    assert parts(out) == 0


@pytest.fixture
def certificates(tmp_path: Path, places: list[Machine]) -> Path:
    """A folder with Dask's configuration of TLS, as docs/clusters.md has it."""
    folder = tmp_path / "dask"
    folder.mkdir()
    subject = ("-subj", "/CN=airhilt")
    subprocess.run(
        [
            *("openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "1", *subject),
            *("-keyout", folder / "key.pem", "-out", folder / "cert.pem"),
        ],
        check=True,
        capture_output=True,
    )
    own = f"\n          cert: {folder}/cert.pem\n          key: {folder}/key.pem"
    (folder / "tls.yaml").write_text(
        f"""
distributed:
  comm:
    require-encryption: true
    tls:
        ca-file: {folder}/cert.pem
        scheduler:{own}
        worker:{own}
        client:{own}
"""
    )
    return folder


def test_connections_are_encrypted_as_dask_is_configured(
    places: list[Machine],
    certificates: Path,
    sweep_command: SweepCommand,
    table_bytes: bytes,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    monkeypatch.setenv("DASK_CONFIG", str(certificates))
    out = tmp_path / "sweep"
    with Cluster(places, tmp_path, "tls") as cluster:
        cluster.start_scheduler()
        cluster.start_worker(1)
        command = sweep_command(out, "--scheduler", cluster.address)
        assert started(places[0], command, tmp_path).wait(300.0) == 0
        monkeypatch.delenv("DASK_CONFIG")
        without = started(places[0], sweep_command(tmp_path / "no", *command[-2:]), tmp_path)
        assert without.wait(60.0) == 2
    assert (out / "sweep.parquet").read_bytes() == table_bytes
    told = (tmp_path / "sweep.log").read_text()
    assert f"scheduler {cluster.address}: not there" in told
    assert "Traceback" not in told


def test_a_worker_with_other_code_is_refused_by_name(
    places: list[Machine], sweep_command: SweepCommand, tmp_path: Path
) -> None:
    other = tmp_path / "other"
    shutil.copytree(ROOT / "airhilt", other / "airhilt")
    for kind in ("aircraft", "airports", "scenarios", "bridges"):
        (other / kind).symlink_to(ROOT / kind)
    with (other / "airhilt" / "units.py").open("a") as module:
        module.write("# changed\n")
    with Cluster(places, tmp_path) as cluster:
        cluster.start_scheduler()
        cluster.start_worker(1, {"PYTHONPATH": str(other)})
        command = sweep_command(tmp_path / "sweep", "--scheduler", cluster.address)
        assert started(places[0], command, tmp_path).wait(120.0) == 2
    told = (tmp_path / "sweep.log").read_text()
    assert f"worker tcp://{places[1].address}:" in told
    assert "other code, models, aircraft or airports of AIRHILT" in told
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
        assert len(left) == 1, "until it has been idle for some minutes"

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
