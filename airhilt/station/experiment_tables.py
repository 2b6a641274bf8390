"""The tables of an experiment: a row a finished trial, and one a reaction and call in it.

Participants who had the seats of a trial together have rows of their own.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet

from airhilt.errors import RunFolderError, first_line
from airhilt.host.files import replace_file
from airhilt.messages import NasaTlx
from airhilt.metrics.columns import OF_CALLS, OF_PEOPLE, OF_REACTIONS, OF_RUNS, Column
from airhilt.record import open_run
from airhilt.record.damage import untold
from airhilt.report.unread import CANNOT_READ
from airhilt.station.participant_progress import Asked, Progress
from airhilt.station.plan import Plan
from airhilt.station.questionnaires import NASA_TLX, Questionnaire, Scale

TRIALS, REACTIONS, CALLS = "experiment", "reactions", "calls"
"""Names of the files of the tables, without their ends."""
TYPES = {"string": pa.string(), "bool": pa.bool_(), "int64": pa.int64(), "float64": pa.float64()}

WRITERS = {"parquet": pa.parquet.write_table, "csv": pa.csv.write_csv}
"""Functions that write a table, by the end of its file's name."""


class _Rows(NamedTuple):
    """The row of a participant's finished trial, and those of the reactions and calls in it."""

    trial: dict[str, Any]
    reactions: list[dict[str, Any]]
    calls: list[dict[str, Any]]


class RowCounts(NamedTuple):
    """The numbers of rows of the tables."""

    trials: int
    reactions: int
    calls: int


def write_tables(plan: Plan, folder: Path) -> RowCounts:
    """Write ``experiment``, ``reactions`` and ``calls``, each as ``.csv`` and as ``.parquet``.

    Raises
    ------
    RunFolderError
        The numbers of a trial are missing, or are not those that its run wrote, or are of other
        seats. Or a table cannot be written.
    """
    everybody = chain(*plan.teams)
    found = [rows for name in everybody for rows in _rows(Progress(plan, folder, name))]
    trials = [rows.trial for rows in found]
    reactions = [row for rows in found for row in rows.reactions]
    calls = [row for rows in found for row in rows.calls]
    identity = [pa.field(name, pa.string()) for name in ("participant", "trial", "scenario")]
    identity += [pa.field("position", pa.int64()), pa.field("run", pa.string())]
    identity += [pa.field(f"condition.{name}", pa.string()) for name in plan.conditions]
    identity.append(pa.field("seat", pa.string()))
    answers = [field for asked in _asked(plan) for field in _answer_fields(asked[0])]
    people = _fields(OF_PEOPLE.columns, "person.")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _write(folder, TRIALS, trials, [*identity, *answers, *people, *_fields(OF_RUNS.columns)])
        _write(folder, REACTIONS, reactions, [*identity, *_fields(OF_REACTIONS.columns)])
        _write(folder, CALLS, calls, [*identity, *_fields(OF_CALLS.columns)])
    except OSError as error:
        raise RunFolderError(f"{folder}: cannot be written: {error.strerror}") from None
    return RowCounts(len(trials), len(reactions), len(calls))


def _write(folder: Path, name: str, rows: list[dict[str, Any]], fields: list[pa.Field]) -> None:
    table = pa.Table.from_pylist(rows, schema=pa.schema(fields))
    for suffix, write in WRITERS.items():
        sink = pa.BufferOutputStream()
        write(table, sink)
        replace_file(folder / f"{name}.{suffix}", sink.getvalue().to_pybytes())


def _fields(columns: Sequence[Column], prefix: str = "") -> list[pa.Field]:
    return [pa.field(prefix + column.name, TYPES[column.type]) for column in columns]


def _asked(plan: Plan, run: str = "") -> list[Asked]:
    """Return what the row of a trial has answers to, in the order of the columns."""
    own = [Asked(one, run) for one in plan.after_trial() if one != NASA_TLX]
    return [Asked(NASA_TLX, run), Asked(plan.before()), *own, Asked(plan.end())]


def _answer_fields(questionnaire: Questionnaire) -> Iterator[pa.Field]:
    for item in questionnaire.items:
        kind = pa.float64() if isinstance(item, Scale) else pa.string()
        yield pa.field(f"{questionnaire.name}.{item.name}", kind)
    if questionnaire == NASA_TLX:
        yield pa.field("nasa_tlx.raw_tlx", pa.float64())


def _answers(progress: Progress, run: str) -> dict[str, Any]:
    """Return what the row of a trial has of the answers of its participant."""
    found: dict[str, Any] = {}
    for asked in _asked(progress.plan, run):
        answers: dict[str, Any] = dict(progress.answers(asked) or {})
        if asked.questionnaire == NASA_TLX and len(answers) == len(NASA_TLX.items):
            answers["raw_tlx"] = NasaTlx(**answers).raw_tlx
        found |= {f"{asked.questionnaire.name}.{name}": value for name, value in answers.items()}
    return found


def _rows(progress: Progress) -> Iterator[_Rows]:
    """Yield the rows of the finished trials of a participant."""
    for position, trial in enumerate(progress.trials, 1):
        name = progress.finished_run(trial)
        if name is None:
            continue
        identity = {
            "participant": progress.participant,
            "trial": trial.name,
            "scenario": trial.scenario,
            "position": position,
            "run": f"{progress.folder.name}/{name}",
            **{f"condition.{key}": _text(value) for key, value in trial.conditions.items()},
        }
        folder = progress.folder / name
        try:
            rows = _of_summary(open_run(folder, untold).numbers(), progress.seat(trial))
        except CANNOT_READ as error:
            raise RunFolderError(
                f"{folder}: its numbers cannot be read ({first_line(error)}); expected them as a "
                "run writes them"
            ) from None
        answers = _answers(progress, name)
        yield _Rows(
            {**rows.trial, **identity, **answers},
            [{**row, **identity} for row in rows.reactions],
            [{**row, **identity} for row in rows.calls],
        )


def _of_summary(summary: Mapping[str, Any], seat: str) -> _Rows:
    """Return what the rows of a trial have of its summary, and of the person at a seat."""
    rows = _Rows(OF_RUNS.values(summary), [], [])
    for person in (one for one in summary.get("people", ()) if one["seat"] == seat):
        at = {"seat": seat}
        own = {f"person.{name}": value for name, value in OF_PEOPLE.values(person).items()}
        rows.trial.update(at | own)
        rows.reactions.extend(at | OF_REACTIONS.values(one) for one in person["reactions"])
        rows.calls.extend(at | OF_CALLS.values(one) for one in person.get("calls", ()))
    return rows


def _text(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value)
