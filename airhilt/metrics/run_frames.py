"""The messages and latencies of a run as data frames of pandas."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel, Field
from pydantic_core import from_json

from airhilt.errors import RunFolderError, first_line
from airhilt.messages import (
    ActorTruth,
    AdsbReport,
    Advisory,
    ConflictTruth,
    Detections,
    Event,
    Message,
    RunwayTruth,
    SpokenTruth,
    Transcript,
    bus_message,
)
from airhilt.metrics.columns import Column, FlatRow, Value, column_of
from airhilt.metrics.frames import frame_of, table_of
from airhilt.record import Run
from airhilt.record.latency import latency_lines
from airhilt.units import SECOND_NS

if TYPE_CHECKING:
    import pyarrow as pa
    from pandas import DataFrame

Json = dict[str, Any]

INDEX = "t_s"
"""Name of the index of every frame: time of the simulation, in s."""
NANOSECONDS = "_ns"
"""End of the names of times in messages; frames have them in s."""
MOST_ROWS = 20_000
"""Number of rows that are kept as Python objects before they become a part of a table."""
UNREADABLE = (TypeError, ValueError, LookupError, AttributeError)
"""Exceptions of JSON that is no message of this version."""


class _Found(BaseModel):
    """One object that a detector found in one picture."""

    camera: str
    seq: int = Field(description="number of the picture")
    t_frame_ns: int = Field(description="end of the exposure")
    label: str = Field(description="class")
    confidence: float
    left_px: float
    top_px: float
    right_px: float
    bottom_px: float
    track_id: int | None = Field(description="the same for one object in all pictures")
    hits: int = Field(description="number of pictures in which it was found so far")
    engine: str


class _Step(BaseModel):
    """One step of a worker, or its loss."""

    worker: str
    seq: int | None = Field(description="number of the step")
    t_in_ns: int | None = Field(description="the last of its inputs came")
    t_start_ns: int | None = Field(description="the worker began")
    latency_ns: int | None = Field(description="from the beginning to the result")
    compute_s: float | None = Field(description="wall time that it took on that machine")
    outputs: int | None = Field(description="number of messages that it published")
    finished: bool | None = Field(description="false: the run ended before")
    missed: str | None = Field(description="why there was no result for an input")
    lost: str | None = Field(description="why the worker was lost at this time")


class _Happening(BaseModel):
    """Something that happened in the world or in the run."""

    kind: str = Field(description="phase of a conflict, kind of an event, or runway")
    subject: str = Field(description="actors of a conflict, occupants of a runway, or of an event")
    horizontal_m: float | None = Field(description="distance of the actors of a conflict")
    vertical_m: float | None = Field(description="distance of the actors of a conflict")
    runway: str | None
    text: str | None = Field(description="text of an event")


def _found(content: Json) -> Iterator[Json]:
    for each in content["detections"]:
        left, top, right, bottom = each["box"]
        box = {"left_px": left, "top_px": top, "right_px": right, "bottom_px": bottom}
        yield {**content, **each, **box}


def _conflict(content: Json) -> Iterator[Json]:
    yield {**content, "kind": content["phase"], "subject": content["actors"]}


def _runway(content: Json) -> Iterator[Json]:
    yield {**content, "kind": "runway", "subject": content["occupants"]}


def _same(content: Json) -> Iterator[Json]:
    yield content


_Rows = Callable[[Json], Iterable[Json]]
"""Returns the rows that a message has in a frame."""


@dataclass(frozen=True)
class _Frame:
    """The columns of a frame, and which messages have rows in it."""

    row: FlatRow
    sources: Mapping[type[Message], _Rows]

    @cached_property
    def columns(self) -> tuple[Column, ...]:
        """The time and the columns of the row, with times in s."""
        index = column_of(INDEX, "float64", "time of the simulation")
        return (index, *map(_in_seconds, self.row.columns))

    def cells(self, t_ns: int, content: Json) -> dict[str, Value]:
        """Return the values of one row; it raises some of `UNREADABLE` for another content."""
        cells: dict[str, Value] = {INDEX: t_ns / SECOND_NS}
        values = self.row.values(content).values()
        for own, column, value in zip(self.row.columns, self.columns[1:], values, strict=True):
            is_time = own.name.endswith(NANOSECONDS) and value is not None
            cells[column.name] = value / SECOND_NS if is_time else value  # type: ignore[operator]
        return cells


def _in_seconds(column: Column) -> Column:
    """Return the column of a time with s in the place of ns, and any other column as it is."""
    if not column.name.endswith(NANOSECONDS):
        return column
    name = f"{column.name.removesuffix(NANOSECONDS)}_s"
    meaning = column.description.replace("nanoseconds since", "time since")
    return replace(column, name=name, type="float64", unit="s", description=meaning)


def _frame(row: type[BaseModel], sources: Mapping[type[Message], _Rows]) -> _Frame:
    return _Frame(FlatRow(row, left_out=("t_ns",)), sources)


LATENCIES = "latencies"
"""The frame whose rows are not in the log."""
FRAMES = {
    "states": _frame(ActorTruth, {ActorTruth: _same}),
    "advisories": _frame(Advisory, {Advisory: _same}),
    "calls": _frame(SpokenTruth, {SpokenTruth: _same}),
    "transcripts": _frame(Transcript, {Transcript: _same}),
    "detections": _frame(_Found, {Detections: _found}),
    "adsb": _frame(AdsbReport, {AdsbReport: _same}),
    LATENCIES: _frame(_Step, {}),
    "truth": _frame(_Happening, {ConflictTruth: _conflict, RunwayTruth: _runway, Event: _same}),
}
"""Frames of a run by their names."""


class _Table:
    """The rows of one frame, as they are read."""

    def __init__(self, frame: _Frame) -> None:
        self._frame = frame
        self._rows: list[dict[str, Value]] = []
        self._tables: list[pa.Table] = []

    def add(self, t_ns: int, content: Json) -> None:
        """Add a row; it raises some of `UNREADABLE` for another content."""
        self._rows.append(self._frame.cells(t_ns, content))
        if len(self._rows) == MOST_ROWS:
            self._pack()

    def frame(self) -> DataFrame:
        """Return the frame."""
        import pyarrow as pa

        self._pack()
        return frame_of(pa.concat_tables(self._tables)).set_index(INDEX)

    def _pack(self) -> None:
        self._tables.append(table_of(self._frame.columns, self._rows))
        self._rows.clear()


def read_frames(run: Run, names: Collection[str]) -> dict[str, DataFrame]:
    """Return frames of a run by their names, from one reading of its log.

    What is damaged is left out. It raises `RunFolderError` if the log cannot be read, or is of
    another version.
    """
    tables = {name: _Table(FRAMES[name]) for name in names}
    readers: dict[type[Message] | None, list[tuple[_Table, _Rows]]] = {}
    for name, table in tables.items():
        for model, rows in FRAMES[name].sources.items():
            readers.setdefault(model, []).append((table, rows))
    for logged in run.log() if readers else ():
        for table, rows in readers.get(bus_message(logged.key), ()):
            try:
                for row in rows(from_json(logged.data)):
                    table.add(logged.t_ns, row)
            except UNREADABLE as error:
                raise of_another_version(run, logged.key, error) from None
    if LATENCIES in tables:
        _read_latencies(run, tables[LATENCIES])
    return {name: table.frame() for name, table in tables.items()}


def of_another_version(run: Run, key: str, error: Exception) -> RunFolderError:
    """Return the error for a message that this version does not write."""
    return RunFolderError(
        f"{run.paths.log_path}: {key}: {first_line(error)}; expected a log of this version of "
        "AIRHILT"
    )


def _read_latencies(run: Run, table: _Table) -> None:
    """Add the lines of the latency log that can be read."""
    path = run.paths.latency_path
    try:
        for line in latency_lines(path):
            with suppress(*UNREADABLE):
                step = from_json(line)
                t_ns = step["t_ns"] if "lost" in step else step["t_start_ns"] + step["latency_ns"]
                table.add(t_ns, step)
    except OSError as error:
        raise RunFolderError(f"{path}: cannot be read: {error.strerror}") from None
