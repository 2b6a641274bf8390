"""Which packages know of which."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import airhilt

PACKAGE = Path(airhilt.__file__).parent


@pytest.mark.parametrize(
    ("package", "unknown"),
    [("record", "metrics"), ("record", "workers"), ("metrics", "workers.vision")],
)
def test_a_package_does_not_know_of_another(package: str, unknown: str) -> None:
    files = list((PACKAGE / package).rglob("*.py"))
    assert files
    for file in files:
        named = [name for name in imports(file) if f"{name}.".startswith(f"airhilt.{unknown}.")]
        assert not named, f"{file.name} imports {', '.join(named)}"


def imports(file: Path) -> list[str]:
    """Return the modules that a file imports, wherever in it."""
    found: list[str] = []
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            found.append(node.module or "")
        elif isinstance(node, ast.Import):
            found += [each.name for each in node.names]
    return found
