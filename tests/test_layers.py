"""Packages import only what the layers in pyproject.toml allow."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from importlinter.cli import lint_imports

ROOT = Path(__file__).parents[1]


def test_no_import_breaks_a_layer() -> None:
    assert lint_imports(config_filename=str(ROOT / "pyproject.toml"), no_cache=True) == 0


@pytest.mark.parametrize(
    ("module", "unneeded"),
    [
        ("airhilt.scenario", "airhilt.world"),
        ("airhilt.cosim.world_loop", "airhilt.metrics"),
        ("airhilt.world.loading", "scipy"),
        ("airhilt.workers", "zenoh"),
    ],
)
def test_importing_a_module_does_not_load_what_it_does_not_need(module: str, unneeded: str) -> None:
    code = f"import sys, {module}; sys.exit({unneeded!r} in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_the_help_of_the_command_line_loads_no_large_library() -> None:
    """Each of them would make `airhilt --help` and completion several times as slow."""
    command = [sys.executable, "-X", "importtime", "-m", "airhilt", "--help"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    loaded = {line.rpartition("|")[2].strip().partition(".")[0] for line in _imports(done.stderr)}
    assert "click" in loaded
    assert not loaded & {"jsbsim", "numpy", "onnxruntime", "pydantic", "scipy", "zenoh"}


def _imports(stderr: str) -> list[str]:
    return [line for line in stderr.splitlines() if line.startswith("import time:")]
