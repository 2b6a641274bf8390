"""Keys for the tests of the command line."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest


@pytest.fixture
def keys(airhilt_command: Any, tmp_path: Path) -> Path:
    """Return the file of a key that signs."""
    assert airhilt_command("keys", "sign", tmp_path / "lab.key").returncode == 0
    return tmp_path / "lab.key"
