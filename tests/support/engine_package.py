"""A package outside of AIRHILT that adds a member to a family by an entry point."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest


@contextmanager
def installed(
    folder: Path, patch: pytest.MonkeyPatch, group: str, name: str, source: str
) -> Iterator[str]:
    """Install a package with one module, whose ``ENGINE`` is the member, and yield its name."""
    package = f"outside_{name}"
    (folder / f"{package}.py").write_text(source)
    metadata = folder / f"{package}-1.0.dist-info"
    metadata.mkdir(exist_ok=True)
    (metadata / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(f"[{group}]\n{name} = {package}:ENGINE\n")
    patch.syspath_prepend(folder)
    try:
        yield package
    finally:
        sys.modules.pop(package, None)
