"""Tables of Arrow, and the same as data frames of pandas."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from airhilt.metrics.columns import Column, Value
from airhilt.record.sweep_folder import SweepFolder

if TYPE_CHECKING:
    import pyarrow as pa
    from pandas import DataFrame


def table_of(columns: Sequence[Column], rows: Iterable[Mapping[str, Value]]) -> pa.Table:
    """Return rows as a table whose fields say their units and meanings."""
    import pyarrow as pa

    schema = pa.schema(
        [
            pa.field(
                column.name,
                pa.type_for_alias(column.type),
                metadata={"unit": column.unit, "description": column.description},
            )
            for column in columns
        ]
    )
    return pa.Table.from_pylist(list(rows), schema=schema)


def frame_of(table: pa.Table) -> DataFrame:
    """Return a table as a data frame, in which whole numbers and truth values may be missing.

    Its ``attrs`` have the ``units`` and the ``descriptions`` of the columns, by their names.
    """
    import pandas as pd
    import pyarrow as pa

    kinds = {pa.bool_(): pd.BooleanDtype(), pa.int64(): pd.Int64Dtype()}
    frame = table.to_pandas(types_mapper=kinds.get)
    for meaning, key in (("units", b"unit"), ("descriptions", b"description")):
        frame.attrs[meaning] = {
            each.name: (each.metadata or {}).get(key, b"").decode() for each in table.schema
        }
    return frame


def read_table(folder: SweepFolder, machine: bool) -> pa.Table:
    """Return the runs of a sweep as a table of Arrow, a row a run.

    `machine` adds what depends on the machine, and with it the runs that a limit ended or that
    crashed; these have nothing but the columns of ``machine.parquet``. It raises what
    `SweepFolder.table` does.
    """
    import pyarrow as pa
    import pyarrow.compute as pc

    table = folder.table()
    if not machine:
        return table
    costs = folder.machine()
    both = {each.name: each for each in (*table.schema, *costs.schema)}
    rows = table.take(pc.index_in(costs["key"], value_set=table["key"]))
    columns = [(costs if name in costs.column_names else rows)[name] for name in both]
    return pa.table(columns, schema=pa.schema(both.values()))


def read_frame(folder: SweepFolder, machine: bool) -> DataFrame:
    """Return the runs of a sweep as a data frame, a row a run; else as `read_table`."""
    return frame_of(read_table(folder, machine))
