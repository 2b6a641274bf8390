"""The command line says in one line that memory ran out."""

from __future__ import annotations

import subprocess
import sys

import pytest

RAISE = """
from importlib import import_module
command_line = import_module("airhilt.cli.main")
def fail(**_):
    raise {error}
command_line.cli.main = fail
command_line.main()
"""


@pytest.mark.parametrize(
    "error",
    [
        "MemoryError",
        'RuntimeError("can\'t start new thread")',
        "OSError(12, 'Cannot allocate memory')",
    ],
)
def test_memory_that_runs_out_is_said_in_one_line(error: str) -> None:
    command = [sys.executable, "-c", RAISE.format(error=error)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert line.startswith("airhilt: memory ran out (")
