"""The tables of a sweep, as people read them in Python."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

import airhilt
from sweep_tables import sweep_row, write_sweep

ENDED = {"key": "f" * 64, "status": "over_time", "cause": "took more than 600 s"}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two runs that finished, and one that a limit ended."""
    rows = [sweep_row("s02a_headon", "none", seed, avoided=bool(seed)) for seed in range(2)]
    return write_sweep(tmp_path / "sweep", rows, [ENDED])


def test_a_table_is_read_for_pandas_and_for_arrow(folder: Path) -> None:
    frame = airhilt.read_sweep(folder)
    table = airhilt.read_sweep(folder, arrow=True)
    assert list(frame.columns) == table.column_names
    assert frame["avoided"].tolist() == table["avoided"].to_pylist()
    assert frame.attrs["units"]["duration_s"] == "s"
    assert table.schema.field("duration_s").metadata[b"unit"] == b"s"


@pytest.mark.parametrize("arrow", [False, True])
def test_with_the_machine_come_the_runs_that_have_no_row(folder: Path, arrow: bool) -> None:
    if arrow:
        rows = airhilt.read_sweep(folder, machine=True, arrow=True).to_pylist()
    else:
        rows = airhilt.read_sweep(folder, machine=True).to_dict("records")
    by_status = {row["status"]: row for row in rows}
    assert len(rows) == 3
    assert by_status["over_time"]["cause"] == "took more than 600 s"
    assert by_status["over_time"]["cpu_s"] == 2.0
    assert pd.isna(by_status["over_time"]["scenario"])
    assert by_status["finished"]["scenario"] == "s02a_headon"
    assert by_status["finished"]["duration_s"] == 120.0
