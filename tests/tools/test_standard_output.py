"""Tools whose output somebody stops reading."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

TOOLS = Path(__file__).parents[2] / "tools"


def test_a_tool_ends_quietly_when_its_reader_has_gone() -> None:
    code = "import standard_output; standard_output.run(lambda: print('line\\n' * 100_000))"
    with subprocess.Popen(
        [sys.executable, "-c", code],
        env={**os.environ, "PYTHONPATH": str(TOOLS)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as tool:
        assert tool.stdout is not None
        assert tool.stderr is not None
        assert tool.stdout.readline() == b"line\n"
        tool.stdout.close()
        assert tool.stderr.read() == b""
    assert tool.returncode == 1
