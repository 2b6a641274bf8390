"""The tables of a sweep: one column for each name."""

from __future__ import annotations

from airhilt.sweep.cases import Case
from airhilt.sweep.tables import tables_of

DOCUMENT = {"name": "s02a_headon", "family": "S02A"}


def test_a_parameter_takes_the_place_of_the_metric_of_its_name() -> None:
    case = Case(DOCUMENT, {"assistant": "none"}, 0, {"duration_s": 240.0})
    row = {"key": "k", "status": "finished", "cause": "", "duration_s": 239.9, "lost": True}
    table, _ = tables_of({"k": case}, {"k": row})
    assert len(set(table.column_names)) == len(table.column_names)
    assert table.column_names.index("duration_s") < table.column_names.index("status")
    assert table["duration_s"].to_pylist() == [240.0]
    assert table["lost"].to_pylist() == [True]
