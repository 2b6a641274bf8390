"""A sweep as its page shows it: both tables, what the columns mean, and what was asked for."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from airhilt.errors import AirhiltError
from airhilt.metrics.frames import frame_of
from airhilt.metrics.measures import MEASURES
from airhilt.record.sweep_folder import SweepFolder
from airhilt.report.sweeps.axes import Axis, axis_of

if TYPE_CHECKING:
    import pyarrow as pa
    from pandas import DataFrame, Series

Json = dict[str, Any]

BEFORE_PARAMETERS = ("key", "scenario", "family", "assistant", "seed")
AFTER_PARAMETERS = "status"
MEASURED = tuple(column for each in MEASURES for column in each.columns)
"""Columns that measures are made of."""
EXPOSURES_LEFT_OUT = "vision_exposures_left_out"
"""Column with the number of exposures that a run left out."""
OTHER_FAMILY = "other"
"""Name of the group of scenarios without a family."""
ALL_FAMILIES = "all"
"""Name of the group of all scenarios."""


@dataclass
class SweepData:
    """One sweep."""

    folder: SweepFolder
    info: Json
    """Content of ``sweep.json``."""
    runs: DataFrame
    """Rows of ``sweep.parquet``: runs that finished or failed."""
    machine: DataFrame
    """Rows of ``machine.parquet``: all runs."""
    columns: dict[str, dict[str, str]]
    """``unit`` and ``description`` of the columns of `runs`, by name."""
    parameters: tuple[str, ...]
    """Names of the columns that are parameters of the grid."""
    page: Path
    """File that the page will be."""
    notes: list[str] = field(default_factory=list)
    """Sentences on what cannot be shown."""

    @property
    def finished(self) -> DataFrame:
        """Rows of the runs that finished."""
        return self.runs[self.runs[AFTER_PARAMETERS] == "finished"]

    @property
    def assistants(self) -> list[str]:
        """Names of the assistants, sorted."""
        return sorted(self.runs["assistant"].dropna().unique())

    def axes(self) -> list[Axis]:
        """Return the parameters that have more than one value, and the assistant if it has."""
        names = ("assistant", *self.parameters)
        finished = self.finished
        found = [axis_of(name, finished[name], self.columns[name]["unit"]) for name in names]
        return [axis for axis in found if len(axis.levels) > 1]

    def families(self) -> list[tuple[str, DataFrame]]:
        """Return name and finished runs of each family; first of all of them if there are more.

        They have the columns that measures and axes are made of.
        """
        wanted = (*BEFORE_PARAMETERS, *self.parameters, *MEASURED)
        runs = self.finished[[name for name in dict.fromkeys(wanted) if name in self.columns]]
        groups = [(str(name), group) for name, group in runs.groupby(families_of(runs), sort=True)]
        return [(ALL_FAMILIES, runs), *groups] if len(groups) > 1 else groups

    def failed(self, family: str, assistant: str) -> int:
        """Return how many runs of an assistant failed, in a family or in all of them."""
        failed = self.runs[self.runs[AFTER_PARAMETERS] != "finished"]
        is_of_family = (families_of(failed) == family) | (family == ALL_FAMILIES)
        return int((is_of_family & (failed["assistant"] == assistant)).sum())

    def link_to(self, path: Path) -> str:
        """Return the address of a file in the sweep folder, as the page has to give it."""
        return Path(os.path.relpath(path, self.page.absolute().parent)).as_posix()


def families_of(runs: DataFrame) -> Series:
    """Return the family of each run, with a name for those that have none."""
    return runs["family"].fillna("").replace("", OTHER_FAMILY)


def read_sweep_data(folder: SweepFolder, page: Path) -> SweepData:
    """Return what the page of a sweep shows; `AirhiltError` if a table is not there or damaged."""
    table = folder.table()
    runs = frame_of(table)
    return SweepData(
        folder=folder,
        info=folder.info(),
        runs=runs,
        machine=frame_of(folder.machine()),
        columns={each.name: _meaning(each) for each in table.schema},
        parameters=parameters_of(table, str(folder.table_path)),
        page=page,
        notes=[*(f"Damaged: {line}." for line in folder.damage()), *_notes(runs)],
    )


def _notes(runs: DataFrame) -> list[str]:
    if EXPOSURES_LEFT_OUT not in runs or not (count := int((runs[EXPOSURES_LEFT_OUT] > 0).sum())):
        return []
    return [
        f"Cameras left exposures out in {count} of {len(runs)} runs (--camera-rate adaptive). "
        "Nuisance alerts are not counted there: what is really there decided on the exposures."
    ]


def parameters_of(table: pa.Table, origin: str) -> tuple[str, ...]:
    """Return the columns that are parameters; `AirhiltError` names what is no table of a sweep."""
    names: Sequence[str] = table.column_names
    first = len(BEFORE_PARAMETERS)
    if tuple(names[:first]) != BEFORE_PARAMETERS or AFTER_PARAMETERS not in names:
        raise AirhiltError(
            f"{origin}: no table of a sweep; expected columns {', '.join(BEFORE_PARAMETERS)}, the "
            f"parameters, and {AFTER_PARAMETERS}"
        )
    return tuple(names[first : names.index(AFTER_PARAMETERS)])


def _meaning(column: pa.Field) -> dict[str, str]:
    given = column.metadata or {}
    return {name: given.get(name.encode(), b"").decode() for name in ("description", "unit")}
