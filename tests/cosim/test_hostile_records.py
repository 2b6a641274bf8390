"""A record names no file that a command opens."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import airhilt
from airhilt.errors import RunFolderError
from airhilt.record import RunFolder

SECRET = '{"aws_secret_access_key": "hunter2"}'


@pytest.fixture
def stranger(tmp_path: Path) -> Path:
    """A run folder of somebody else."""
    return airhilt.run(
        "s02a_headon", out=tmp_path / "run", latency="fixed", speech=False, cameras=False,
        report=False,
    ).folder  # fmt: skip


def test_no_command_opens_a_file_that_a_record_names_as_configuration(
    stranger: Path, tmp_path: Path
) -> None:
    credentials, pipe = tmp_path / "credentials", tmp_path / "pipe"
    credentials.write_text(SECRET)
    os.mkfifo(pipe)
    record = json.loads((stranger / "run.json").read_text())
    for named in (credentials, pipe):
        record["options"]["assistant_config"] = str(named)
        (stranger / "run.json").write_text(json.dumps(record))
        with pytest.raises(RunFolderError, match="assistant_config") as refused:
            RunFolder(stranger).info()
        assert "hunter2" not in str(refused.value)
        for command in ("report", "replay", "view"):
            done = subprocess.run(
                [sys.executable, "-m", "airhilt", command, str(stranger)],
                capture_output=True, text=True, timeout=60, check=False,
            )  # fmt: skip
            assert done.returncode != 0
            assert "hunter2" not in done.stdout + done.stderr
    assert not (stranger / "report.html").exists()
