"""The tables of an experiment: a row a finished trial, and a row a reaction of its person."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet

from airhilt.errors import RunFolderError, first_line
from airhilt.files import replace_file
from airhilt.messages import NasaTlx
from airhilt.metrics.columns import OF_PEOPLE, OF_REACTIONS, OF_RUNS, Column
from airhilt.record import open_run
from airhilt.record.run import untold
from airhilt.report.unread import CANNOT_READ
from airhilt.station.experiment import Progress
from airhilt.station.plan import Plan

TRIALS, REACTIONS = "experiment", "reactions"
"""Names of the files of the two tables, without their ends."""
TYPES = {"string": pa.string(), "bool": pa.bool_(), "int64": pa.int64(), "float64": pa.float64()}

WRITERS = {"parquet": pa.parquet.write_table, "csv": pa.csv.write_csv}
"""Functions that write a table, by the end of its file's name."""


class _Rows(NamedTuple):
    """The row of a finished trial, and those of the reactions in it."""

    trial: dict[str, Any]
    reactions: list[dict[str, Any]]


class RowCounts(NamedTuple):
    """The numbers of rows of the two tables."""

    trials: int
    reactions: int


def write_tables(plan: Plan, folder: Path) -> RowCounts:
    """Write ``experiment`` and ``reactions``, each as ``.csv`` and as ``.parquet``.

    Raises
    ------
    RunFolderError
        The numbers of a trial are missing, or are not those that its run wrote. Or a table cannot
        be written.
    """
    found = [rows for name in plan.participants for rows in _rows(Progress(plan, folder, name))]
    trials = [rows.trial for rows in found]
    reactions = [row for rows in found for row in rows.reactions]
    identity = [pa.field(name, pa.string()) for name in ("participant", "trial", "scenario")]
    identity += [pa.field("position", pa.int64()), pa.field("run", pa.string())]
    identity += [pa.field(f"condition.{name}", pa.string()) for name in plan.conditions]
    ratings = [
        pa.field(f"nasa_tlx.{name}", pa.float64()) for name in (*NasaTlx.model_fields, "raw_tlx")
    ]
    people = _fields(OF_PEOPLE.columns, "person.")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _write(folder, TRIALS, trials, [*identity, *ratings, *people, *_fields(OF_RUNS.columns)])
        seat = pa.field("seat", pa.string())
        _write(folder, REACTIONS, reactions, [*identity, seat, *_fields(OF_REACTIONS.columns)])
    except OSError as error:
        raise RunFolderError(f"{folder}: cannot be written: {error.strerror}") from None
    return RowCounts(len(trials), len(reactions))


def _write(folder: Path, name: str, rows: list[dict[str, Any]], fields: list[pa.Field]) -> None:
    table = pa.Table.from_pylist(rows, schema=pa.schema(fields))
    for suffix, write in WRITERS.items():
        sink = pa.BufferOutputStream()
        write(table, sink)
        replace_file(folder / f"{name}.{suffix}", sink.getvalue().to_pybytes())


def _fields(columns: Sequence[Column], prefix: str = "") -> list[pa.Field]:
    return [pa.field(prefix + column.name, TYPES[column.type]) for column in columns]


def _rows(progress: Progress) -> Iterator[_Rows]:
    """Yield the rows of the finished trials of a participant."""
    for position, trial in enumerate(progress.trials, 1):
        name = progress.finished_run(trial)
        if name is None:
            continue
        answers = progress.answers(name)
        rated: dict[str, Any] = {} if answers is None else answers.model_dump()
        rated |= {} if answers is None else {"raw_tlx": answers.raw_tlx}
        identity = {
            "participant": progress.participant,
            "trial": trial.name,
            "scenario": trial.scenario,
            "position": position,
            "run": f"{progress.participant}/{name}",
            **{f"condition.{key}": _text(value) for key, value in trial.conditions.items()},
        }
        folder = progress.folder / name
        try:
            rows = _of_summary(open_run(folder, untold).summary())
        except CANNOT_READ as error:
            raise RunFolderError(
                f"{folder}: its numbers cannot be read ({first_line(error)}); expected them as a "
                "run writes them"
            ) from None
        ratings = {f"nasa_tlx.{key}": float(value) for key, value in rated.items()}
        yield _Rows(
            {**rows.trial, **identity, **ratings}, [{**row, **identity} for row in rows.reactions]
        )


def _of_summary(summary: Mapping[str, Any]) -> _Rows:
    """Return what the rows of a trial have of its summary; nothing of a person without a seat."""
    trial, reactions = OF_RUNS.values(summary), []
    for person in summary.get("people", ()):  # An experiment has one seat.
        trial |= {f"person.{key}": value for key, value in OF_PEOPLE.values(person).items()}
        for reaction in person["reactions"]:
            reactions.append({"seat": person["seat"], **OF_REACTIONS.values(reaction)})
    return _Rows(trial, reactions)


def _text(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value)
