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
