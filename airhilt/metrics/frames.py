"""Tables of Arrow as data frames of pandas."""

from __future__ import annotations

from typing import TYPE_CHECKING

from airhilt.record.sweep_folder import SweepFolder

if TYPE_CHECKING:
    import pyarrow as pa
    from pandas import DataFrame


def frame_of(table: pa.Table) -> DataFrame:
    """Return a table as a data frame, in which whole numbers and truth values may be missing."""
    import pandas as pd
    import pyarrow as pa

    kinds = {pa.bool_(): pd.BooleanDtype(), pa.int64(): pd.Int64Dtype()}
    return table.to_pandas(types_mapper=kinds.get)


def read_frame(folder: SweepFolder, machine: bool = False) -> DataFrame:
    """Return the runs of a sweep as a data frame, a row a run.

    Its ``attrs`` have the ``units`` and the ``descriptions`` of the columns, by their names.

    Parameters
    ----------
    folder
        The sweep folder.
    machine
        True adds what depends on the machine, and with it the runs that a limit ended or that
        crashed; these have nothing but the columns of ``machine.parquet``.

    Raises
    ------
    AirhiltError
        A table is not there, or damaged.
    """
    table = folder.table()
    fields = {each.name: each for each in table.schema}
    frame = frame_of(table)
    if machine:
        costs = folder.machine()
        fields |= {each.name: each for each in costs.schema}
        both = [name for name in costs.column_names if name in frame.columns and name != "key"]
        frame = frame_of(costs).merge(frame.drop(columns=both), on="key", how="left")
        frame = frame[[name for name in fields if name in frame.columns]]
    for meaning, key in (("units", b"unit"), ("descriptions", b"description")):
        frame.attrs[meaning] = {
            name: (each.metadata or {}).get(key, b"").decode() for name, each in fields.items()
        }
    return frame
