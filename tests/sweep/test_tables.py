"""The tables of a sweep: one column for each name."""

from __future__ import annotations

from pydantic import JsonValue

from airhilt.sweep.cases import Case
from airhilt.sweep.tables import tables_of

DOCUMENT = {"name": "s02a_headon", "family": "S02A"}


def test_a_parameter_with_the_name_of_a_metric_has_a_column_beside_it() -> None:
    case = Case(DOCUMENT, {"assistant": "none"}, 0, {"duration_s": 240.0})
    row = {"key": "k", "status": "finished", "cause": "", "duration_s": 239.9, "lost": True}
    table, _ = tables_of({"k": case}, {"k": row})
    assert len(set(table.column_names)) == len(table.column_names)
    parameter = "parameter.duration_s"
    assert table.column_names.index(parameter) < table.column_names.index("status")
    assert table[parameter].to_pylist() == [240.0]
    assert table["duration_s"].to_pylist() == [239.9]
    assert table["lost"].to_pylist() == [True]


def test_rows_are_sorted_by_scenario_assistant_parameters_and_seed() -> None:
    values: list[JsonValue] = [None, -5.0, 0, 3.5, 20, [1, 2], "auto"]
    expected = [(value, seed) for value in values for seed in (0, 1, 10)]
    cases = {
        f"{100 - place:03d}": Case(DOCUMENT, {"assistant": "none"}, seed, {"any": value})
        for place, (value, seed) in enumerate(expected)
    }
    finished = {key: {"key": key, "status": "finished"} for key in cases}
    shuffled = dict(sorted(cases.items()))
    table, machine = tables_of(shuffled, finished)
    assert table["key"].to_pylist() == machine["key"].to_pylist() == list(cases)
