"""Parquet files that anybody may have written: what they claim is bounded before they are read."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pyarrow as pa

LARGEST_BYTES = 2_000_000_000
"""Size of the largest file that is read, and of its columns before compression, in bytes."""
MOST_CELLS = 200_000_000
"""Greatest number of rows times columns."""
MOST_TEXT_BYTES = 1_000_000_000
"""Greatest size of all texts together; a text that many rows have is kept once in the file."""


def parse_table(data: bytes) -> pa.Table:
    """Return the table in a Parquet file.

    Raises
    ------
    ValueError
        It is damaged, is larger than that, or has a column of something else than numbers, truth
        values and texts.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    buffer = pa.py_buffer(data)
    try:
        with pq.ParquetFile(buffer) as file:
            schema = _flat(file.schema_arrow)
            _require_small(file.metadata)
        texts = [field.name for field in schema if _is_text(field.type)]
        with pq.ParquetFile(buffer, read_dictionary=texts) as file:
            table = file.read()
        if sum(map(_text_bytes, table.columns)) > MOST_TEXT_BYTES:
            raise ValueError(f"its texts have over {MOST_TEXT_BYTES:,} bytes; expected less")
        return table.cast(schema)
    except (pa.ArrowException, OSError) as error:
        raise ValueError(str(error)) from None


def _flat(schema: pa.Schema) -> pa.Schema:
    """Return a schema with texts themselves in the place of numbers of texts."""
    import pyarrow as pa

    fields = []
    for field in schema:
        kind = field.type
        if pa.types.is_dictionary(kind):
            kind = kind.value_type
        if not (pa.types.is_primitive(kind) or pa.types.is_null(kind) or _is_text(kind)):
            raise ValueError(f"column {field.name} has the type {kind}; expected numbers or texts")
        fields.append(field.with_type(kind))
    return pa.schema(fields, schema.metadata)


def _is_text(kind: pa.DataType) -> bool:
    import pyarrow as pa

    return bool(pa.types.is_string(kind) or pa.types.is_large_string(kind))


def _require_small(claimed: pa.parquet.FileMetaData) -> None:
    cells = claimed.num_rows * claimed.num_columns
    if cells > MOST_CELLS:
        raise ValueError(
            f"it has {claimed.num_rows:,} rows of {claimed.num_columns:,} columns; expected at "
            f"most {MOST_CELLS:,} cells"
        )
    groups = (claimed.row_group(index) for index in range(claimed.num_row_groups))
    size_bytes = sum(
        group.column(index).total_uncompressed_size
        for group in groups
        for index in range(group.num_columns)
    )
    if size_bytes > LARGEST_BYTES:
        raise ValueError(f"its columns have over {LARGEST_BYTES:,} bytes; expected less")


def _text_bytes(column: pa.ChunkedArray) -> int:
    """Return the size of the texts of a column, one of each row."""
    import pyarrow as pa
    import pyarrow.compute as pc

    if not pa.types.is_dictionary(column.type):
        return 0
    return sum(
        pc.sum(pc.binary_length(chunk.dictionary).take(chunk.indices).cast("int64")).as_py() or 0
        for chunk in column.chunks
    )
