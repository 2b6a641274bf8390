"""The tables of a sweep: one with parameters and metrics, one with what depends on the machine."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pyarrow as pa

from airhilt.metrics.columns import Column, Kind, column_of, metric_columns
from airhilt.metrics.frames import table_of
from airhilt.sweep.cases import Case
from airhilt.sweep.outcome import OF_THE_MACHINE, Machine, Outcome

IDENTITY = (
    Column("key", "string", "", "SHA-256 of scenario, options, seed and software: what was run"),
    Column("scenario", "string", "", "name of the scenario"),
    Column("family", "string", "", "family of the scenario, such as s01a; empty if it has none"),
    Column("assistant", "string", "", "who decides"),
    Column("seed", "int64", "", "seed of the run"),
)
ENDING = (
    Column("status", "string", "", "finished, or failed: it raised an error"),
    Column("cause", "string", "", "the error in one line; empty if it finished"),
)


def _of_machine(name: str, kind: Kind, unit: str) -> Column:
    return Column(name, kind, unit, str(Machine.model_fields[name].description))


MACHINE = (
    Column("key", "string", "", "key of the run in sweep.parquet"),
    Column(
        "status",
        "string",
        "",
        "finished, failed (it raised an error), or without a row in sweep.parquet: over_time, "
        "over_memory, crashed",
    ),
    Column("cause", "string", "", "what ended it, in one line; empty if it finished"),
    _of_machine("wall_s", "float64", "s"),
    _of_machine("cpu_s", "float64", "s"),
    _of_machine("peak_memory_mb", "float64", "MB"),
    _of_machine("host", "string", ""),
    _of_machine("process", "int64", ""),
    Column("folder", "string", "", "run folder in the sweep folder; empty if it was not kept"),
)


def part_schema() -> pa.Schema:
    """Return names and types of the columns of a part."""
    return part_of([]).schema


def part_of(outcomes: Iterable[Outcome]) -> pa.Table:
    """Return a part of the store: machine columns and metrics of some runs that are finished."""
    rows = [
        {
            "key": outcome.key,
            "status": outcome.status,
            "cause": outcome.cause,
            **outcome.machine.model_dump(),
            "folder": f"runs/{folder_name(outcome.key)}" if outcome.is_kept else "",
            **outcome.metrics,
        }
        for outcome in outcomes
    ]
    return _table((*MACHINE, *metric_columns()), rows)


def tables_of(
    cases: Mapping[str, Case], finished: Mapping[str, Mapping[str, Any]]
) -> tuple[pa.Table, pa.Table]:
    """Return the table of results and the table of the machine.

    Both are sorted by scenario, assistant, parameters and seed.

    Parameters
    ----------
    finished
        Rows of the parts by their keys; rows of other runs are left out.
    """
    names = _column_names(cases.values())
    keys = sorted(
        (key for key in cases if key in finished), key=lambda key: _place(cases[key], names, key)
    )
    results = [
        {
            **finished[key],
            **{names[path]: value for path, value in case.parameters.items()},
            "key": key,
            "scenario": case.scenario,
            "family": case.family,
            "assistant": case.assistant,
            "seed": case.seed,
        }
        for key in keys
        if finished[key]["status"] not in OF_THE_MACHINE
        for case in (cases[key],)
    ]
    known = {column.name for column in IDENTITY}
    parameters = [
        column_of(
            name,
            _kind(case.parameters.get(path) for case in cases.values()),
            "parameter of the sweep",
        )
        for path, name in names.items()
        if name not in known
    ]
    columns = (*IDENTITY, *parameters, *ENDING, *metric_columns())
    return _table(columns, results), _table(MACHINE, [finished[key] for key in keys])


def _place(case: Case, names: Iterable[str], key: str) -> tuple[Any, ...]:
    """Return what a run is sorted by; a parameter may be null, a number, a text or a structure."""
    values = [_rank(case.parameters.get(path)) for path in names]
    return (case.scenario, case.assistant, values, case.seed, key)


def _rank(value: Any) -> tuple[int, Any]:
    if value is None:
        return 0, 0
    return (1, value) if isinstance(value, int | float) else (2, _text(value))


def grid_sha256(cases: Mapping[str, Case]) -> str:
    """Return the SHA-256 of the keys and parameters of a sweep, which identifies its tables."""
    digest = hashlib.sha256()
    for name in (*sorted(_column_names(cases.values()).values()), *sorted(cases)):
        digest.update(f"{name}\n".encode())
    return digest.hexdigest()


def folder_name(key: str) -> str:
    """Return the name of the run folder of a key, under ``runs``."""
    return key[:16]


def _column_names(cases: Iterable[Case]) -> dict[str, str]:
    """Return the column of each parameter: its path, or another name if a metric has that one."""
    measured = {column.name for column in metric_columns()}
    paths = dict.fromkeys(path for case in cases for path in case.parameters)
    return {path: f"parameter.{path}" if path in measured else path for path in paths}


def _kind(values: Iterable[Any]) -> Kind:
    """Return the type of a column of values."""
    kinds = {type(value) for value in values if value is not None}
    if kinds == {bool}:
        return "bool"
    if kinds == {int}:
        return "int64"
    return "float64" if kinds and kinds <= {int, float} else "string"


def _table(columns: Sequence[Column], rows: Sequence[Mapping[str, Any]]) -> pa.Table:
    """Return rows as a table, in which texts stand for the values of other types."""
    cells = ({each.name: _cell(row.get(each.name), each) for each in columns} for row in rows)
    return table_of(columns, cells)


def _cell(value: Any, column: Column) -> Any:
    """Return a value as its column has it: in a column of texts, other values as JSON."""
    return value if value is None or column.type != "string" else _text(value)


def _text(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value)
