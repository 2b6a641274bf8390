"""Members of families in installed packages: read once, and again when packages have changed."""

from __future__ import annotations

from dataclasses import replace
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

import pytest

from airhilt import plugins
from airhilt.plugins import Family
from engine_package import installed

PARROTS = Family("parrot", "airhilt.test_parrots", "airhilt.phraseology", "PARROT")


def test_a_package_that_comes_while_the_process_runs_is_found_and_one_that_goes_is_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    assert "polly" not in PARROTS.names()
    with installed(tmp_path, monkeypatch, PARROTS.group, "polly", ""):
        assert "polly" in PARROTS.names()
        assert PARROTS.origin("polly") == "outside_polly 1.0"
    for file in (metadata := tmp_path / "outside_polly-1.0.dist-info").iterdir():
        file.unlink()
    metadata.rmdir()
    assert "polly" not in PARROTS.names()


def test_the_metadata_of_packages_are_read_once_as_long_as_none_comes_or_goes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    read = []

    def counted() -> Any:
        read.append("all")
        return entry_points()

    monkeypatch.setattr(plugins, "entry_points", counted)
    monkeypatch.syspath_prepend(tmp_path)
    for family in (PARROTS, replace(PARROTS, group="airhilt.test_budgerigars"), PARROTS):
        family.names()
    assert read == ["all"]
