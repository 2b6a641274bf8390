"""The command line says in one line that memory ran out."""

from __future__ import annotations

import resource
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


@pytest.mark.parametrize("command", [["cosim", "--scenario", "s02a_headon"], ["list"]])
def test_an_address_space_in_which_libraries_hang_is_refused(command: list[str]) -> None:
    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (2 * 10**9, 2 * 10**9))

    done = subprocess.run(
        [sys.executable, "-m", "airhilt", *command],
        capture_output=True,
        text=True,
        preexec_fn=limit,
    )
    assert done.returncode == 2
    assert done.stderr == (
        "airhilt: the address space is limited to 2.00 GB (ulimit -v); expected at least 3 GB\n"
    )
