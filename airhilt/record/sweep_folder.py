"""The folder of a sweep: its specification, the runs that are finished, and the tables of them.

Finished runs are kept in parts, Parquet files that appear all or nothing, so that nothing finished
is lost by a kill. The tables ``sweep.parquet`` and ``machine.parquet`` are made of them.
"""

from __future__ import annotations

import fcntl
import json
import os
import uuid
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter, ValidationError

from airhilt.errors import AirhiltError, first_problem
from airhilt.host import bounded_json
from airhilt.host.files import PARTIAL, make_folder, read_inside, replace_file
from airhilt.record.damage import Notice, tell_damage
from airhilt.record.folder import RunFolder, refuse_links
from airhilt.record.manifest import FileRecord, digest, digest_problem, manifest, problem_of

if TYPE_CHECKING:
    import pyarrow as pa

FORMAT = 1
MOST_PARTS = 64
"""Small parts from which they are put together into one."""
SMALL_BYTES = 1_000_000
"""Size up to which a part is small."""
LARGEST_BYTES = 2_000_000_000
"""Size of the largest Parquet file that is read, and of its columns before compression."""
MOST_CELLS = 200_000_000
"""Greatest number of rows times columns of a Parquet file."""
MOST_TEXT_BYTES = 1_000_000_000
"""Greatest size of all texts in it; a text that many rows have is kept once in the file."""
UNREADABLE = (OSError, ValueError)
"""Exceptions of a file that cannot be read."""
REQUIRED = ("key", "status")
"""Columns of a part that say which run a row is, and whether it counts."""
GRID = "grid_sha256"
"""Name, in ``sweep.json`` and in the metadata of both tables, of the hash of the sweep that they
are of."""
AGAIN = "give the command of the sweep again, it makes the tables from the runs that are finished"
"""Remedy in errors about tables."""
FILES = "files"
"""Name, in ``sweep.json``, of the manifest: both tables, and the ``run.json`` of each run folder
that was kept, which has the manifest of that run."""
MANIFEST = TypeAdapter(dict[str, FileRecord])
"""Shape of the manifest."""


class SweepFolderError(AirhiltError):
    """A sweep folder cannot be written, or does not hold what it must."""


class SweepFolder:
    """The paths in a sweep folder; reads and writes its parts and tables."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.info_path = path / "sweep.json"
        self.signature_path = path / "sweep.json.sig"
        self.next_info_path = path / "sweep.next.json"
        self.table_path = path / "sweep.parquet"
        self.machine_path = path / "machine.parquet"
        self.parts_path = path / "parts"
        self._lock_path = self.parts_path / ".lock"
        self.runs_path = path / "runs"
        self.figures_path = path / "figures"
        self.report_path = path / "report.html"

    @property
    def is_there(self) -> bool:
        """True if a sweep has been run here, or was begun."""
        return self.info_path.is_file() or self.next_info_path.is_file()

    @classmethod
    def open(cls, path: Path, notice: Notice | None = None) -> SweepFolder:
        """Return an existing sweep folder, and tell each line of its `damage`.

        Without a notice Python warns of it. It raises `SweepFolderError` if there is no sweep in
        the folder, or one that has no tables yet.
        """
        folder = cls(path)
        if not folder.info_path.is_file():
            if folder.is_there:
                raise SweepFolderError(f"{path}: no tables yet; {AGAIN}")
            raise SweepFolderError(f"{path}: no sweep here; expected a folder with a sweep.json")
        tell_damage(path, folder.damage(), notice)
        return folder

    def create(self) -> None:
        """Make the folder, or use that of a sweep again; `SweepFolderError` if it cannot be."""
        self.require_usable()
        with _writing(self.path):
            make_folder(self.parts_path)
            os.close(self._open_lock())

    def require_usable(self) -> None:
        """Refuse a folder that holds something else or leads elsewhere by a link, as `create`."""
        refuse_links(self.parts_path, self.runs_path, self.figures_path)
        if self._holds_something_else():
            raise SweepFolderError(
                f"{self.path}: holds files that are no sweep; choose another folder with --out"
            )

    def _holds_something_else(self) -> bool:
        """Return true for a folder that no sweep has made; a ``sweep.json`` may be a user's."""
        if not self.path.is_dir() or self._lock_path.is_file():
            return False
        if any(entry != self.parts_path for entry in self.path.iterdir()):
            return True
        return self.parts_path.is_dir() and any(self.parts_path.iterdir())

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Keep the folder for one process; the lock ends with it, however it ends.

        What a killed process left half-written is removed. It raises `SweepFolderError` if another
        process has the folder.
        """
        with _writing(self.path):
            stream = os.fdopen(self._open_lock(), "w")
        with stream:
            try:
                fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise SweepFolderError(
                    f"{self.path}: another sweep is writing here; wait for its end, or choose "
                    "another folder"
                ) from None
            for folder in (self.path, self.parts_path):
                for left in folder.glob(f"*{PARTIAL}"):
                    left.unlink(missing_ok=True)
            yield

    def _open_lock(self) -> int:
        flags = os.O_WRONLY | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK
        return os.open(self._lock_path, flags, 0o666)

    # --- what is run ------------------------------------------------------------------------

    def write_next_info(self, info: Mapping[str, Any]) -> None:
        """Write what is going to be ``sweep.json``, when its tables are there."""
        _write_info(self.next_info_path, info)

    def info(self) -> dict[str, Any]:
        """Return ``sweep.json``; `SweepFolderError` if it is damaged."""
        try:
            loaded = bounded_json.parse(self.read(self.info_path))
        except UNREADABLE as error:
            raise SweepFolderError(f"{self.info_path}: cannot be read: {_reason(error)}") from None
        if not isinstance(loaded, dict) or loaded.get("format") != FORMAT:
            raise SweepFolderError(f"{self.info_path}: expected a sweep.json of format {FORMAT}")
        return loaded

    def read(self, path: Path) -> bytes:
        """Return the content of a small file; it raises what `read_inside` does."""
        return read_inside(self.path, path, bounded_json.MOST_BYTES)

    def files(self) -> dict[str, FileRecord]:
        """Return the manifest in ``sweep.json``, empty if it has none; else as `info`."""
        try:
            return MANIFEST.validate_python(self.info().get(FILES, {}))
        except ValidationError as error:
            raise SweepFolderError(f"{self.info_path}: {FILES}: {first_problem(error)}") from None

    def damage(self) -> tuple[str, ...]:
        """Return a line for ``sweep.json`` and each table that was changed; else as `info`."""
        info, files = self.info(), self.files()
        problems = [digest_problem(self.info_path.name, info)]
        problems += [
            problem_of(self.path, table.name, files[table.name], self.info_path.name)
            for table in (self.table_path, self.machine_path)
            if table.name in files
        ]
        return tuple(filter(None, problems))

    # --- finished runs ----------------------------------------------------------------------

    def keep(self, runs: pa.Table) -> None:
        """Write finished runs as a new part; each row has at least what is `REQUIRED`."""
        self._write_part(runs)
        small = [part for part in self._parts() if part.stat().st_size <= SMALL_BYTES]
        if len(small) > MOST_PARTS:
            self._put_together(small, runs.schema)

    def finished(self, schema: pa.Schema, notice: Callable[[str], None] | None) -> pa.Table:
        """Return all finished runs in the columns of a schema; one finished twice has two rows.

        What a part of another version does not have is null. The runs of a part that is damaged, or
        whose columns cannot be those of the schema, are missing. The notice is told of each such
        part, which is set aside; None leaves the folder as it is, while another sweep writes.
        """
        import pyarrow as pa

        tables = [schema.empty_table()]
        for part in self._parts():
            try:
                tables.append(_cast(_read_part(part), schema))
            except UNREADABLE as error:
                if notice is not None:
                    aside = part.with_suffix(".damaged")
                    with _writing(part):
                        part.replace(aside)
                    notice(
                        f"{part} is damaged ({_reason(error)}): set aside as {aside.name}, its "
                        "runs are missing"
                    )
        return pa.concat_tables(tables)

    def _parts(self) -> list[Path]:
        return sorted(self.parts_path.glob("*.parquet"))

    def _write_part(self, runs: pa.Table) -> None:
        _write_table(runs, self.parts_path / f"{uuid.uuid4().hex}.parquet")

    def _put_together(self, parts: Sequence[Path], schema: pa.Schema) -> None:
        """Replace parts by one; a kill in between leaves runs twice, which have one key.

        Damaged ones stay, for `finished` to tell, and so do those of other versions.
        """
        import pyarrow as pa

        read: dict[Path, pa.Table] = {}
        for part in parts:
            with suppress(*UNREADABLE):
                table = _read_part(part)
                if table.schema.equals(schema):  # No column is to be lost.
                    read[part] = table
        self._write_part(pa.concat_tables(read.values()))
        for part in read:
            part.unlink(missing_ok=True)

    # --- tables -----------------------------------------------------------------------------

    def write_tables(self, table: pa.Table, machine: pa.Table, info: Mapping[str, Any]) -> None:
        """Write both tables and their ``sweep.json``, each all or nothing.

        After a kill in between, `table` and `machine` tell that they are not of one sweep. An
        earlier signature is deleted. The column ``folder`` of `machine` says which run folders were
        kept; `info` is the content of ``sweep.json`` but for the manifest, and its ``grid_sha256``
        goes into the tables.
        """
        with _writing(self.signature_path):
            self.signature_path.unlink(missing_ok=True)
        mark = {GRID: str(info[GRID])}
        _write_table(table.replace_schema_metadata(mark), self.table_path)
        _write_table(machine.replace_schema_metadata(mark), self.machine_path)
        _write_info(self.info_path, self._sealed(info, machine["folder"].to_pylist()))
        with _writing(self.next_info_path):
            self.next_info_path.unlink(missing_ok=True)

    def _sealed(self, info: Mapping[str, Any], kept: Iterable[str | None]) -> dict[str, Any]:
        runs = (self.runs_path / PurePosixPath(name).name for name in kept if name)
        files = (self.table_path, self.machine_path, *(RunFolder(run).info_path for run in runs))
        with _writing(self.path):
            records = manifest(self.path, files)
        sealed = {**info, FILES: {name: record.model_dump() for name, record in records.items()}}
        return sealed | {"digest": digest(sealed)}

    def table(self) -> pa.Table:
        """Return ``sweep.parquet``: parameters and metrics, a row a run.

        It raises `SweepFolderError` if it is not there, damaged, or not of the sweep in
        ``sweep.json``.
        """
        return self._of_this_sweep(self.table_path)

    def machine(self) -> pa.Table:
        """Return ``machine.parquet``: status, time and memory, a row a run; else as `table`."""
        return self._of_this_sweep(self.machine_path)

    def _of_this_sweep(self, path: Path) -> pa.Table:
        try:
            table = _parse(read_inside(self.path, path, LARGEST_BYTES))
        except FileNotFoundError:
            raise SweepFolderError(f"{path}: not there; {AGAIN}") from None
        except UNREADABLE as error:
            raise SweepFolderError(f"{path}: damaged ({_reason(error)}); {AGAIN}") from None
        found = (table.schema.metadata or {}).get(GRID.encode(), b"").decode()
        if found != self.info().get(GRID, ""):
            raise SweepFolderError(f"{path}: not of the sweep in {self.info_path.name}; {AGAIN}")
        return table


def is_sweep(path: Path) -> bool:
    """Return true for a sweep folder, false for a run folder; else raise `SweepFolderError`."""
    if SweepFolder(path).is_there:
        return True
    if RunFolder(path).info_path.is_file():
        return False
    raise SweepFolderError(
        f"{path}: neither a run nor a sweep; expected a folder with a run.json or a sweep.json"
    )


def _write_info(path: Path, info: Mapping[str, Any]) -> None:
    with _writing(path):
        replace_file(path, f"{json.dumps(info, indent=2)}\n".encode())


def _read_part(part: Path) -> pa.Table:
    table = _parse(read_inside(part.parents[1], part, LARGEST_BYTES))
    for name in REQUIRED:
        if name not in table.column_names:
            raise ValueError(f"it has no column {name}")
    return table


def _parse(data: bytes) -> pa.Table:
    """Return the table in a Parquet file; ValueError if it is damaged or claims too much."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    buffer = pa.py_buffer(data)
    try:
        with pq.ParquetFile(buffer) as file:
            rows, columns = file.metadata.num_rows, file.metadata.num_columns
            if rows * columns > MOST_CELLS:
                raise ValueError(
                    f"it has {rows:,} rows of {columns:,} columns; expected at most "
                    f"{MOST_CELLS:,} cells"
                )
            groups = map(file.metadata.row_group, range(file.metadata.num_row_groups))
            if sum(group.total_byte_size for group in groups) > LARGEST_BYTES:
                raise ValueError(f"its columns have over {LARGEST_BYTES:,} bytes; expected less")
            schema = _flat(file.schema_arrow)
        texts = [field.name for field in schema if _is_text(field.type)]
        with pq.ParquetFile(buffer, read_dictionary=texts) as file:
            table = file.read()
        if sum(map(_text_bytes, table.columns)) > MOST_TEXT_BYTES:
            raise ValueError(f"its texts have over {MOST_TEXT_BYTES:,} bytes; expected less")
        return table.cast(schema)
    except (pa.ArrowException, OSError) as error:
        raise ValueError(str(error)) from None


def _flat(schema: pa.Schema) -> pa.Schema:
    """Return a schema with texts in the place of numbers of texts; ValueError for lists."""
    import pyarrow as pa

    fields = []
    for field in schema:
        kind = field.type.value_type if pa.types.is_dictionary(field.type) else field.type
        if not (pa.types.is_primitive(kind) or pa.types.is_null(kind) or _is_text(kind)):
            raise ValueError(f"column {field.name} has the type {kind}; expected numbers or texts")
        fields.append(field.with_type(kind))
    return pa.schema(fields, schema.metadata)


def _is_text(kind: pa.DataType) -> bool:
    import pyarrow as pa

    return bool(pa.types.is_string(kind) or pa.types.is_large_string(kind))


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


def _cast(table: pa.Table, schema: pa.Schema) -> pa.Table:
    """Return a table with the columns of a schema; columns that it does not have are null."""
    import pyarrow as pa

    columns = []
    for field in schema:
        if field.name not in table.column_names:
            columns.append(pa.nulls(table.num_rows, field.type))
            continue
        try:
            columns.append(table[field.name].cast(field.type))
        except (pa.ArrowException, KeyError) as error:  # KeyError: two columns have that name.
            raise ValueError(f"column {field.name}: {_reason(error)}") from None
    return pa.table(columns, schema=schema)


def _write_table(table: pa.Table, path: Path) -> None:
    """Write a Parquet file, all or nothing; the same table gives the same bytes."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    sink = pa.BufferOutputStream()
    pq.write_table(table, sink, compression="zstd", store_schema=True)
    with _writing(path):
        replace_file(path, sink.getvalue().to_pybytes())


def _reason(error: Exception) -> str:
    """Return what is wrong in one line, without the path of an error of the system."""
    return str(getattr(error, "strerror", None) or error).partition("\n")[0]


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise SweepFolderError(
            f"{path}: cannot be written: {error.strerror}; what was finished before is kept; make "
            "room, or choose another folder with --out"
        ) from None
