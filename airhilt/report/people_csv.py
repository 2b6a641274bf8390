"""The people of a run as a table: their actions, reactions, workload and calls."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from airhilt.errors import RunFolderError, first_line, writing_to_run
from airhilt.host.files import replace_file
from airhilt.messages import NasaTlx
from airhilt.metrics.summary import IsaRating, PersonCall, PersonReaction, PersonSummary
from airhilt.record import Run
from airhilt.report.unread import CANNOT_READ

PARTS = ("seat", "calls", "reactions", "workload")
"""Fields of a person that are no totals: other rows, or columns of their own, have them."""
TOTALS = tuple(name for name in PersonSummary.model_fields if name not in PARTS)
COLUMNS = tuple(dict.fromkeys((
    "run", "seat", "row", *TOTALS, "isa_mean", "raw_tlx", *NasaTlx.model_fields,
    *PersonReaction.model_fields, *IsaRating.model_fields, *PersonCall.model_fields,
)))  # fmt: skip
"""Columns; rows of several kinds have a field of the same name in the same column."""


def write_people_csv(run: Run, path: Path) -> None:
    """Write the people of a run; without any, the file has its head alone.

    Each seat has a row ``total``, a row ``reaction`` for each advisory, a row ``isa`` for each
    question, and a row ``call`` for each call. It raises `RunFolderError` if there is no summary,
    or not the one that the run wrote, or the file cannot be written.
    """
    summary, folder = run.numbers(), run.paths
    table = io.StringIO(newline="")
    writer = csv.DictWriter(table, COLUMNS, extrasaction="ignore")
    writer.writeheader()
    try:
        for person in summary.get("people", ()):
            for row in _rows(person):
                writer.writerow({"run": folder.path.name, "seat": person["seat"], **row})
    except CANNOT_READ as error:
        raise RunFolderError(
            f"{folder.summary_path}: its people cannot be read ({first_line(error)}); expected "
            "them as a run writes them"
        ) from None
    with writing_to_run(path):
        replace_file(path, table.getvalue().encode())


def _rows(person: dict[str, Any]) -> Iterator[dict[str, Any]]:
    workload = person.get("workload") or {}
    yield {"row": "total", **person, **workload, **(workload.get("nasa_tlx") or {})}
    for reaction in person["reactions"]:
        yield {"row": "reaction", **reaction}
    for question in workload.get("isa", ()):
        yield {"row": "isa", **question}
    for call in person.get("calls", ()):
        yield {"row": "call", **call}
