"""Sweeps on a SLURM of their own."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Mapping
from pathlib import Path

import pytest

from dask_processes import wait_until
from slurm_on_one_machine import missing, slurm

from .conftest import RUNS, SweepCommand

pytestmark = [
    pytest.mark.slow,
    pytest.mark.slurm,
    pytest.mark.skipif(bool(missing()) or os.geteuid() != 0, reason="SLURM's daemons, as root"),
]


def asked(environment: Mapping[str, str], *command: str) -> list[str]:
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return done.stdout.split()


def test_jobs_of_slurm_give_the_bytes_of_a_sweep_on_this_machine(
    sweep_command: SweepCommand, table_bytes: bytes, tmp_path: Path
) -> None:
    pytest.importorskip("dask_jobqueue")
    out, settings = tmp_path / "sweep", tmp_path / "slurm.json"
    settings.write_text(
        json.dumps({"queue": "main", "walltime": "00:20:00", "log_directory": str(tmp_path)})
    )
    options = ("--scheduler", "slurm", "--scheduler-config", str(settings), "--workers", "2")
    with slurm() as environment:
        command = sweep_command(out, *options)
        with subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True) as sweep:
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
