"""The list of runs that a station can show."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from airhilt.station.debriefs import Debriefs


@pytest.mark.parametrize("content", [b"[" * 100_000, b"\xff", b"[]", b"{}", b""])
def test_a_run_whose_record_cannot_be_read_is_left_out(
    recorded_run: Path, tmp_path: Path, content: bytes
) -> None:
    shutil.copytree(recorded_run, tmp_path / "good")
    shutil.copytree(recorded_run, tmp_path / "bad")
    (tmp_path / "bad" / "run.json").write_bytes(content)
    (row,) = Debriefs(tmp_path).rows()
    assert row["name"] == "good"
    assert row["scenario"] == "encounter"
    assert row["phase"] == "finished"
    assert row["seats"] == []
