"""The answer of `airhilt verify`."""

from __future__ import annotations

import json
import subprocess
from typing import Any


def verified(airhilt_command: Any, *arguments: object) -> tuple[int, dict[str, Any]]:
    """Return the exit code of `airhilt verify`, and what it says as JSON."""
    done: subprocess.CompletedProcess[str] = airhilt_command("verify", *arguments, "--json")
    assert done.stderr == ""
    return done.returncode, json.loads(done.stdout)
