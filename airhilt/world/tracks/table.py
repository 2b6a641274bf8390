"""Tables of traffic, CSV or parquet: their columns, and their rows with the place of each."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pandas as pd

from airhilt.world.tracks.record import TracksError

PARQUET = b"PAR1"


def columns(path: Path, head: bytes) -> set[str]:
    """Return the names of the columns of a table; none for what is no table."""
    if head[:4] == PARQUET:
        import pyarrow.parquet as parquet

        return set(parquet.read_schema(path).names)
    if path.suffix == ".gz":
        return set(pd.read_csv(path, nrows=0).columns)
    line = head.split(b"\n", 1)[0].decode(errors="replace")
    return {name.strip().strip('"') for name in line.split(",")}


def rows(path: Path) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield place and values of the rows; empty cells are None."""
    with path.open("rb") as stream:
        is_parquet = stream.read(4) == PARQUET
    try:
        # An address such as 4060e2 would be read as a number.
        table = pd.read_parquet(path) if is_parquet else pd.read_csv(path, dtype=str)
    except (ValueError, OSError) as error:
        raise TracksError(f"{path}: cannot be read as a table: {error}") from None
    word, first = ("row", 0) if is_parquet else ("line", 2)
    table = table.astype(object).where(table.notna(), None)
    for number, values in enumerate(table.to_dict("records"), start=first):
        yield f"{word} {number}", {str(name): value for name, value in values.items()}


def seconds(value: Any) -> Any:
    """Return a time in s since 1970: a number, or a date and time, in UTC where it says no zone."""
    if value is None:
        return None
    try:
        return float(value)
    except (TypeError, ValueError):
        pass
    try:
        when = pd.Timestamp(value)
    except ValueError:
        return value
    return (when if when.tzinfo else when.tz_localize("UTC")).timestamp()


def flag(value: Any) -> bool:
    """Return whether a cell says true."""
    return str(value).strip().lower() in ("true", "1", "1.0", "t")
