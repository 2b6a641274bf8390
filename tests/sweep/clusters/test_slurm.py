"""The recipe for SLURM of docs/clusters.md, on a SLURM of its own."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

from dask_processes import wait_until
from paths import DOCS
from slurm_on_one_machine import missing, slurm

from .conftest import RUNS, SweepCommand

pytestmark = [
    pytest.mark.slow,
    pytest.mark.slurm,
    pytest.mark.skipif(bool(missing()) or os.geteuid() != 0, reason="SLURM's daemons, as root"),
]
OF_THIS_SLURM = {
    "queue: compute": "queue: main",
    "    account: my_project\n": "",
    "cores: 8": "cores: 1",
    "memory: 16 GB": "memory: 2 GB",
    "module load python/3.11": "true",
}
"""Settings of the recipe that this SLURM has otherwise."""


@pytest.fixture
def recipe(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The script of the guide, with the guide's configuration for this SLURM."""
    pytest.importorskip("dask_jobqueue")
    guide = (DOCS / "clusters.md").read_text()
    script, settings = (
        re.findall(rf"```{kind}\n(.*?)```", guide, re.DOTALL)[0] for kind in ("python", "yaml")
    )
    for theirs, ours in OF_THIS_SLURM.items():
        assert theirs in settings
        settings = settings.replace(theirs, ours)
    (tmp_path / "slurm.py").write_text(script)
    (tmp_path / "dask").mkdir()
    (tmp_path / "dask" / "jobqueue.yaml").write_text(settings)
    monkeypatch.setenv("DASK_CONFIG", str(tmp_path / "dask"))
    return tmp_path / "slurm.py"


def asked(environment: Mapping[str, str], *command: str) -> list[str]:
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return done.stdout.split()


def test_jobs_of_slurm_give_the_bytes_of_a_sweep_on_this_machine(
    recipe: Path, sweep_command: SweepCommand, table_bytes: bytes, tmp_path: Path
) -> None:
    out = tmp_path / "sweep"
    command = [sys.executable, str(recipe), *sweep_command(out, "--scheduler", "scheduler.json")]
    with (
        slurm() as environment,
        subprocess.Popen(
            command, cwd=tmp_path, env=environment, stderr=subprocess.PIPE, text=True
        ) as sweep,
    ):
        jobs = ("squeue", "--noheader", "--format=%i", "--states=RUNNING")
        wait_until(lambda: len(list(out.glob("parts/*.parquet"))) >= 2)
        first = asked(environment, *jobs)
        assert len(first) == 2
        subprocess.run(["scancel", first[0]], env=environment, check=True)
        told = sweep.communicate(timeout=300.0)[1]
        assert sweep.returncode == 0, told
        assert f"{RUNS} runs" in told
        assert "Traceback" not in told
        wait_until(lambda: not asked(environment, *jobs))
    assert (out / "sweep.parquet").read_bytes() == table_bytes
